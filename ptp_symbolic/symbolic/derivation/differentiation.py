"""Derivatives of expressions whose value is real, whatever SymPy can prove of their parts."""

from functools import lru_cache

import sympy as sp

from ptp_symbolic.symbolic.symbols import ZERO


class _Sign(sp.Function):
    """The sign of a real number: constant wherever it has a derivative."""

    nargs = 1

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        return ZERO


class _Magnitude(sp.Function):
    """The size of a real number; SymPy's `Abs` differentiates as for a complex one unless it can
    prove its argument real, which a logarithm or a quotient of parameters prevents.
    """

    nargs = 1

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        return _Sign(self.args[0])


KEPT = 4096  # expressions: those of one machine, each differentiated by all of its symbols


@lru_cache(maxsize=KEPT)
def symbols_of(expression: sp.Expr) -> frozenset[sp.Symbol]:
    """The symbols in `expression`, found once for all variables that it is differentiated by."""
    return frozenset(expression.free_symbols)


def derivative(expression: sp.Expr, variable: sp.Symbol) -> sp.Expr:
    """Partial derivative of a real `expression` by `variable`."""
    if variable not in symbols_of(expression):
        return ZERO
    real = _differentiable(expression)
    if real is expression:
        return sp.diff(expression, variable)
    return sp.diff(real, variable).replace(_Magnitude, sp.Abs).replace(_Sign, sp.sign)


@lru_cache(maxsize=KEPT)
def _differentiable(expression: sp.Expr) -> sp.Expr:
    """`expression` with magnitudes and signs that differentiate as those of a real number."""
    if not expression.has(sp.Abs, sp.sign):
        return expression
    return expression.replace(sp.Abs, _Magnitude).replace(sp.sign, _Sign)
