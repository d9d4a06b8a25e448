"""The symbols of the equations: all of them real."""

import sympy as sp


def real(name: str) -> sp.Symbol:
    """The real symbol `name`; two of one name are one symbol."""
    return sp.Symbol(name, real=True)
