"""RK4 in loops compiled by numba: compressed rows, and the replicas as the innermost loop.

`fastmath` lets LLVM contract and reorder as it likes. With one replica the loops are scalar; with
sixteen, arrays are [component][node][replica], and LLVM makes vector instructions of the innermost
loops, whose length is a constant when they are compiled.
"""

import numba
import numpy as np

from peer import CURRENT, STEP, R, S, run, steps


def kernel(n_replicas):
    """The compiled loop, for so many replicas."""
    compiled = numba.njit(fastmath=True, error_model="numpy", boundscheck=False)

    @compiled
    def add_inputs(starts, columns, weights, x, sums):
        for i in range(len(starts) - 1):
            if n_replicas == 1:
                total = 0.0
                for entry in range(starts[i], starts[i + 1]):
                    total += weights[entry] * x[columns[entry], 0]
                sums[i, 0] = total
            else:
                row = sums[i]
                for m in range(n_replicas):
                    row[m] = 0.0
                for entry in range(starts[i], starts[i + 1]):
                    w, other = weights[entry], x[columns[entry]]
                    for m in range(n_replicas):
                        row[m] += w * other[m]

    @compiled
    def stage(epsilon, sums, state, at, ahead, total, weight, distance):
        for i in range(sums.shape[0]):
            for m in range(n_replicas):
                x, y, z = at[0, i, m], at[1, i, m], at[2, i, m]
                x2 = x * x
                dx = y + x2 * (3.0 - x) - z + CURRENT + epsilon[m] * sums[i, m]
                dy = 1.0 - 5.0 * x2 - y
                dz = R * (S * (x + 1.6) - z)
                total[0, i, m] += weight * dx
                total[1, i, m] += weight * dy
                total[2, i, m] += weight * dz
                ahead[0, i, m] = state[0, i, m] + distance * dx
                ahead[1, i, m] = state[1, i, m] + distance * dy
                ahead[2, i, m] = state[2, i, m] + distance * dz

    @compiled
    def advance(n_steps, starts, columns, weights, epsilon, state):
        h = STEP
        total, ahead = state.copy(), state.copy()
        sums = np.empty_like(state[0])
        stages = ((h / 6, h / 2), (h / 3, h / 2), (h / 3, h), (h / 6, 0.0))
        for _ in range(n_steps):
            ahead[:] = state
            total[:] = state
            for weight, distance in stages:
                add_inputs(starts, columns, weights, ahead[0], sums)
                stage(epsilon, sums, state, ahead, ahead, total, weight, distance)
            state[:] = total

    return advance


def make(fixture):
    state = np.ascontiguousarray(fixture.states.transpose(1, 2, 0))
    compiled = kernel(len(fixture.epsilon))
    matrix = fixture.starts, fixture.columns, fixture.weights

    def advance(duration):
        compiled(steps(duration), *matrix, fixture.epsilon, state)

    return advance, lambda: state[0].T


if __name__ == "__main__":
    run(f"numba {numba.__version__} RK4", make)
