"""The reference that every implementation must agree with: RK4 of one replica, as in a textbook; and a
fixed step of Dormand-Prince 8(5,3), with the coefficients that SciPy has, for the errors of that.

Slow on purpose. W is a dense matrix, and each line is a line of the equations.
"""

import numpy as np
from scipy.integrate._ivp import dop853_coefficients as coefficients

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


def rk4(rate, state, h):
    """One step of RK4."""
    k1 = rate(state)
    k2 = rate(state + h / 2 * k1)
    k3 = rate(state + h / 2 * k2)
    k4 = rate(state + h * k3)
    return state + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)


def dop853(rate, state, h):
    """One step of order eight."""
    slopes = []
    for row in coefficients.A[: coefficients.N_STAGES]:
        ahead = sum((a * k for a, k in zip(row, slopes) if a != 0), start=np.zeros_like(state))
        slopes.append(rate(state + h * ahead))
    return state + h * sum(b * k for b, k in zip(coefficients.B, slopes))


def orbit(fixture, replica, n_steps, h=STEP, step=rk4):
    """x after each of `n_steps` steps h, shape (n_steps, N)."""
    matrix = fixture.sparse_matrix().toarray()
    state, epsilon = fixture.states[replica].copy(), fixture.epsilon[replica]
    orbit = []
    for _ in range(n_steps):
        state = step(lambda x: flow(x, matrix, epsilon), state, h)
        orbit.append(state[0])
    return np.array(orbit)
