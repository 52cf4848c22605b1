"""heyoka: adaptive Taylor series, compiled by LLVM, in batch mode for ensembles.

Counts model time / 0.01 as steps. A batch is as many replicas as one vector register holds, the size
heyoka recommends; an ensemble is advanced batch by batch. Compilation is not part of the time.
"""

import copy

import heyoka as hy
import numpy as np

from peer import CURRENT, R, S, run_adaptive


def equations(fixture):
    """The system with epsilon as its parameter 0, node by node."""
    names = [f"{letter}{i}" for i in range(fixture.n_nodes) for letter in "xyz"]
    variables = hy.make_vars(*names)
    system = []
    for i in range(fixture.n_nodes):
        x, y, z = variables[3 * i : 3 * i + 3]
        entries = range(fixture.starts[i], fixture.starts[i + 1])
        terms = [float(fixture.weights[k]) * variables[3 * fixture.columns[k]] for k in entries]
        x2 = x * x
        system += [
            (x, y + x2 * (3.0 - x) - z + CURRENT + hy.par[0] * hy.sum(terms)),
            (y, 1.0 - 5.0 * x2 - y),
            (z, R * (S * (x + 1.6) - z)),
        ]
    return system


def make(fixture, control):
    n_replicas, system = len(fixture.epsilon), equations(fixture)
    states = fixture.states.transpose(2, 1, 0).reshape(3 * fixture.n_nodes, n_replicas)
    options = {"tol": control.tolerance, "compact_mode": True}
    if n_replicas == 1:
        single = hy.taylor_adaptive(system, states[:, 0], pars=fixture.epsilon, **options)
        return single.propagate_for, lambda: single.state[None, 0::3]

    width = min(hy.recommended_simd_size(), n_replicas)
    part = lambda array, batch: np.ascontiguousarray(array[:, width * batch : width * (batch + 1)])
    parts = [
        (part(states, batch), part(fixture.epsilon[None], batch))
        for batch in range(n_replicas // width)
    ]
    first = hy.taylor_adaptive_batch(system, parts[0][0], pars=parts[0][1], **options)
    batches = [first, *(clone(first, *part) for part in parts[1:])]

    def advance(duration):
        for batch in batches:
            batch.propagate_for(duration)

    return advance, lambda: np.hstack([batch.state[0::3] for batch in batches]).T


def clone(integrator, state, parameters):
    """A copy that shares the compiled code and stands elsewhere."""
    copied = copy.deepcopy(integrator)
    copied.state[:] = state
    copied.pars[:] = parameters
    return copied


if __name__ == "__main__":
    run_adaptive(lambda _: f"heyoka {hy.__version__} Taylor", make)
