"""SciPy's `solve_ivp`, adaptive, all replicas stacked into one system, W from scipy.sparse.

RK45, its default, or DOP853 where the tolerance is strict. Counts model time / 0.01 as steps.
"""

import numpy as np
import scipy
from scipy.integrate import solve_ivp

from peer import CURRENT, R, S, run_adaptive


def method(control):
    return "DOP853" if control.is_strict() else "RK45"


def make(fixture, control):
    matrix, epsilon = fixture.sparse_matrix(), fixture.epsilon
    n_nodes, n_replicas = fixture.n_nodes, len(epsilon)
    options = {"method": method(control), **control.options()}
    state = fixture.states.transpose(1, 2, 0).ravel()  # [component][node][replica]

    def flow(_, state):
        x, y, z = state.reshape(3, n_nodes, n_replicas)
        slope = np.empty((3, n_nodes, n_replicas))
        x2 = x * x
        slope[0] = y + x2 * (3.0 - x) - z + CURRENT + epsilon * (matrix @ x)
        slope[1] = 1.0 - 5.0 * x2 - y
        slope[2] = R * (S * (x + 1.6) - z)
        return slope.ravel()

    def advance(duration):
        nonlocal state
        solution = solve_ivp(flow, (0.0, duration), state, t_eval=[duration], **options)
        if not solution.success:
            raise RuntimeError(solution.message)
        state = solution.y[:, -1]

    return advance, lambda: state.reshape(3, n_nodes, n_replicas)[0].T


if __name__ == "__main__":
    run_adaptive(lambda control: f"SciPy {scipy.__version__} {method(control)}", make)
