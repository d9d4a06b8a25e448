"""Modes that a state implies where rigid bodies meet.

The text is copied into emitted modules from the mark on; names above the mark stand for what a
module brings along.
"""

import numpy as np
from numba import njit

RIGID_CONTACTS = np.zeros((0, 3), dtype=np.int64)
FRICTION_RATES = np.zeros(0, dtype=np.int64)
MODE_NAMES: tuple[str, ...] = ()


def guards(t, x, u, p, m, g):
    """Stand for the one of the module."""


def mode_derivative(t, x, u, p, m, dx):
    """Stand for the one of the module."""


# copied from here on


FACE_WIDTH, SAME_SPEED = 1e-9, 1e-9  # rad, rad/s: what counts as lasting contact


@njit(cache=True, error_model="numpy", nogil=True)
def initial_modes(t, x, u, p, m):
    """Find the modes of a state: contact from the separation, sticking from the holding torque."""
    frictions = len(FRICTION_RATES)
    contacts = (len(m) - frictions) // 2
    g = np.empty(3 * frictions + 4 * contacts)
    m[:] = 0.0
    guards(t, x, u, p, m, g)
    for k in range(contacts):
        gear, joint, rule = RIGID_CONTACTS[k]
        at, where = 3 * frictions + 4 * k, frictions + 2 * k
        side = 1.0 if g[at] > 0.0 else -1.0
        within = 0.0 if rule == 0 else FACE_WIDTH
        if side * g[at] > g[at + 1] - within:
            torque = g[at + 2] if side > 0.0 else g[at + 3]
            m[where] = side
            m[where + 1] = 1.0 if side * torque > 0.0 else 0.0
            if rule > 0:
                m[where + 1] = 1.0 if abs(x[gear] - x[joint]) <= SAME_SPEED else 0.0
    for k in range(frictions):
        m[k] = np.sign(x[FRICTION_RATES[k]])
    guards(t, x, u, p, m, g)
    for k in range(contacts):
        at, where = 3 * frictions + 4 * k, frictions + 2 * k
        if RIGID_CONTACTS[k, 2] > 0 and m[where + 1] > 0.0:
            push = m[where] * (g[at + 2] if m[where] > 0.0 else g[at + 3])
            m[where + 1] = 1.0 if push >= 0.0 else 0.0
    guards(t, x, u, p, m, g)
    for k in range(frictions):
        if m[k] == 0.0 and g[3 * k] > g[3 * k + 1]:
            m[k] = 1.0
        elif m[k] == 0.0 and -g[3 * k] > g[3 * k + 2]:
            m[k] = -1.0


@njit(cache=True, error_model="numpy", nogil=True)
def state_derivative(t, x, u, p, dx):
    """Write the time derivative of the state into dx, in the modes that the state implies."""
    m = np.empty(len(MODE_NAMES))
    initial_modes(t, x, u, p, m)
    mode_derivative(t, x, u, p, m, dx)
