"""The symbols of the equations, all of them real, and their zero."""

import sympy as sp

ZERO = sp.Integer(0)


def real(name: str) -> sp.Symbol:
    """The real symbol `name`; two of one name are one symbol."""
    return sp.Symbol(name, real=True)
