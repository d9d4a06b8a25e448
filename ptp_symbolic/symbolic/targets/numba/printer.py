"""Print expressions as Python that numba compiles: exact constants, powers as products."""

import sympy as sp
from sympy.printing.pycode import PythonCodePrinter


class KernelPrinter(PythonCodePrinter):
    """Printer for kernels: `math` functions, floats with all digits that matter."""

    def __init__(self) -> None:
        super().__init__({"fully_qualified_modules": True, "precision": 17})

    def _print_Rational(self, expr: sp.Rational) -> str:
        return repr(float(expr))

    def _print_Integer(self, expr: sp.Integer) -> str:
        return f"{int(expr)}.0"

    def _print_Float(self, expr: sp.Float) -> str:
        return repr(float(expr))

    def _print_NumberSymbol(self, expr: sp.NumberSymbol) -> str:
        return repr(float(expr))

    def _print_Pow(self, expr: sp.Pow, rational: bool = False) -> str:
        base, exponent = expr.as_base_exp()
        if exponent == sp.Rational(1, 2):
            return f"math.sqrt({self._print(base)})"
        if exponent.is_Integer and 0 < abs(int(exponent)) <= 4:
            factor = self.parenthesize(base, sp.printing.precedence.PRECEDENCE["Atom"], strict=True)
            product = " * ".join([factor] * abs(int(exponent)))
            if exponent > 0:
                return product if exponent == 1 else f"({product})"
            return f"1.0 / {product}" if exponent == -1 else f"1.0 / ({product})"
        return super()._print_Pow(expr, rational=rational)

    def _print_Heaviside(self, expr: sp.Heaviside) -> str:
        return f"(1.0 if {self._print(expr.args[0])} > 0.0 else 0.0)"

    def _print_Mul(self, expr: sp.Mul) -> str:
        negative, above, below = quotient(expr)
        text = " * ".join(above) + (f" / {below}" if below else "")
        return f"-{text}" if negative else text


def quotient(expr: sp.Mul) -> tuple[bool, list[str], str | None]:
    """Whether a product is negative, the factors above its one division, and what is below it.

    Exponentials stay above the division, where they cannot overflow.
    """
    printer, atom = KernelPrinter(), sp.printing.precedence.PRECEDENCE["Atom"]
    coefficient, product = expr.as_coeff_Mul()
    factors = product.as_ordered_factors()
    under = [f for f in factors if f.is_Pow and f.exp.is_Integer and f.exp.is_negative]
    above = [print_factor(f) for f in factors if f not in under]
    if abs(coefficient) != 1 or not above:
        above.insert(0, printer.doprint(abs(coefficient)))
    divisor = sp.Mul(*[1 / f for f in under])
    below = printer.parenthesize(divisor, atom, strict=True) if under else None
    return bool(coefficient.is_negative), above, below


def print_factor(expression: sp.Expr) -> str:
    """Return Python source of `expression`, in parentheses where a product needs them."""
    printer, level = KernelPrinter(), sp.printing.precedence.PRECEDENCE["Mul"]
    if expression.is_Rational and expression.is_nonnegative:
        return printer.doprint(expression)
    return printer.parenthesize(expression, level, strict=True)


def print_expression(expression: sp.Expr) -> str:
    """Return Python source of `expression`."""
    return KernelPrinter().doprint(expression)
