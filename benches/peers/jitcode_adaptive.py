"""JiTCODE: equations as symbols, compiled as C with its own flags (-Ofast -march=native), adaptive.

Integrated by dopri5, or dop853 where the tolerance is strict. Counts model time / 0.01 as steps.
Large networks are compiled in pieces, as its manual advises; compilation is not part of the time.
"""

from importlib.metadata import version

import numpy as np
from jitcode import jitcode, y

from peer import CURRENT, R, S, run_adaptive

# Model time from one call of the integrator to the next: dopri5 takes bursts for stiffness and gives
# up when a call needs more than a thousand steps.
INTERVAL = 5.0


def method(control):
    return "dop853" if control.is_strict() else "dopri5"


def make(fixture, control):
    n_nodes, epsilon = fixture.n_nodes, float(fixture.epsilon[0])

    def flow():
        for i in range(n_nodes):
            entries = range(fixture.starts[i], fixture.starts[i + 1])
            coupling = sum(
                float(fixture.weights[k]) * y(3 * int(fixture.columns[k])) for k in entries
            )
            x, u, z = y(3 * i), y(3 * i + 1), y(3 * i + 2)
            yield u + x * x * (3 - x) - z + CURRENT + epsilon * coupling
            yield 1 - 5 * x * x - u
            yield R * (S * (x + 1.6) - z)

    system = jitcode(flow, n=3 * n_nodes, verbose=False)
    system.generate_f_C(simplify=False, chunk_size=100)
    system.compile_C()
    system.set_integrator(method(control), nsteps=10**8, **control.options())
    system.set_initial_value(fixture.states[0].T.ravel(), 0.0)

    def advance(duration):
        start = system.t
        for part in range(round(duration / min(duration, INTERVAL))):
            system.integrate(start + min(duration, INTERVAL) * (part + 1))

    return advance, lambda: np.asarray(system.y)[None, 0::3]


if __name__ == "__main__":
    name = lambda control: f"JiTCODE {version('jitcode')} {method(control)}"
    run_adaptive(name, make, single=True)
