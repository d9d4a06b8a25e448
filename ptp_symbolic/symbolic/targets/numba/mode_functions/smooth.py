"""What is asked of modes in a model that has none.

The text is copied into emitted modules from the mark on; names above the mark stand for what a
module brings along.
"""

from numba import njit


def mode_derivative(t, x, u, p, m, dx):
    """Stand for the one of the module."""


# copied from here on


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def initial_modes(t, x, u, p, m):
    """Leave m alone: this model has no modes."""
    return


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def state_derivative(t, x, u, p, dx):
    """Write the time derivative of the state into dx."""
    mode_derivative(t, x, u, p, (), dx)
