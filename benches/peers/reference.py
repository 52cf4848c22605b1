"""The reference that every implementation must agree with: RK4 of one replica, as in a textbook.

Slow on purpose. W is a dense matrix, and each line is a line of the equations.
"""

import numpy as np

from peer import CURRENT, STEP, R, S


def flow(state, matrix, epsilon):
    """dx/dt of all nodes, (3, N)."""
    x, y, z = state
    return np.array(
        [
            y + x**2 * (3 - x) - z + CURRENT + epsilon * (matrix @ x),
            1 - 5 * x**2 - y,
            R * (S * (x + 1.6) - z),
        ]
    )


def orbit(fixture, replica, n_steps, h=STEP):
    """x after each of `n_steps` steps h, shape (n_steps, N)."""
    matrix = fixture.sparse_matrix().toarray()
    state, epsilon = fixture.states[replica].copy(), fixture.epsilon[replica]
    orbit = []
    for _ in range(n_steps):
        k1 = flow(state, matrix, epsilon)
        k2 = flow(state + h / 2 * k1, matrix, epsilon)
        k3 = flow(state + h / 2 * k2, matrix, epsilon)
        k4 = flow(state + h * k3, matrix, epsilon)
        state = state + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
        orbit.append(state[0])
    return np.array(orbit)
