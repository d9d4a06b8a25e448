"""Derivatives of expressions whose value is real, whatever SymPy can prove of their parts."""

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


def derivative(expression: sp.Expr, variable: sp.Symbol) -> sp.Expr:
    """Partial derivative of a real `expression` by `variable`."""
    if not expression.has(sp.Abs, sp.sign):
        return sp.diff(expression, variable)
    real = expression.replace(sp.Abs, _Magnitude).replace(sp.sign, _Sign)
    return sp.diff(real, variable).replace(_Magnitude, sp.Abs).replace(_Sign, sp.sign)
