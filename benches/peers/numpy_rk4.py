"""A loop of RK4 steps in NumPy over arrays [component][node][replica], nothing allocated on the way.

What careful people write. W x is whichever was faster at start: a dense product (BLAS) or the
product of scipy.sparse.
"""

import time

import numpy as np

from peer import CURRENT, STEP, R, S, run, steps

def faster_product(fixture, x):
    """W, dense or sparse, whichever of the two products is faster at x."""
    sparse = fixture.sparse_matrix()
    timings = []
    for matrix in [sparse, sparse.toarray()]:
        spent = []
        for _ in range(20):
            started = time.process_time()
            matrix @ x
            spent.append(time.process_time() - started)
        timings.append((min(spent), matrix))
    return min(timings, key=lambda timing: timing[0])[1]


def make(fixture):
    epsilon = fixture.epsilon
    state = np.ascontiguousarray(fixture.states.transpose(1, 2, 0))
    matrix = faster_product(fixture, state[0])
    slope, ahead, total = np.empty_like(state), np.empty_like(state), np.empty_like(state)
    work = np.empty_like(state[0])
    stages = [(STEP / 6, STEP / 2), (STEP / 3, STEP / 2), (STEP / 3, STEP), (STEP / 6, None)]

    def flow(at):
        """Writes dx/dt at `at` into `slope`."""
        x, y, z = at
        dx, dy, dz = slope
        np.multiply(matrix @ x, epsilon, out=dx)
        dx += y
        dx -= z
        dx += CURRENT
        np.multiply(x, x, out=work)
        np.multiply(work, -5.0, out=dy)
        dy += 1.0
        dy -= y
        np.subtract(3.0, x, out=dz)
        dz *= work
        dx += dz
        np.add(x, 1.6, out=dz)
        dz *= S
        dz -= z
        dz *= R

    def advance(duration):
        for _ in range(steps(duration)):
            total[:] = state
            at = state
            for weight, distance in stages:
                flow(at)
                if distance is not None:
                    np.multiply(slope, distance, out=ahead)
                    np.add(ahead, state, out=ahead)
                    at = ahead
                np.multiply(slope, weight, out=slope)
                np.add(total, slope, out=total)
            state[:] = total

    return advance, lambda: state[0].T


if __name__ == "__main__":
    run(f"NumPy {np.__version__} RK4", make)
