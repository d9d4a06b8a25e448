"""Expressions in every language: one printer, and per language what it calls the operations.

Sums, products, quotients and whole powers are written alike everywhere, in SymPy's order, so that
languages with the same arithmetic compute the same bits.
"""

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import reduce
from typing import Any

import sympy as sp
from sympy.printing.precedence import PRECEDENCE
from sympy.printing.pycode import PythonCodePrinter

LARGEST_PRODUCT = 4  # powers up to this one are products
# The operations beside + - * / of all effects. A test holds every language to have all of them.
OPERATIONS = (
    "pow",
    "sqrt",
    "inverse sqrt",
    "exp",
    "log",
    "sin",
    "cos",
    "acos",
    "Abs",
    "floor",
    "sign",
    "Min",
    "Max",
    "Heaviside",
    "NearestCount",
    "choice",
    "And",
    "Or",
    "pi",
)
PAIRWISE = ("Min", "Max", "And", "Or")


@dataclass(frozen=True)
class Language:
    """How a language writes operations: templates of their arguments {0}, {1}, {2} (in a choice
    the condition comes first; {all} are any number); how it writes a `number`, {0} being its digits
    in double precision; and `words` that no name may be.
    """

    name: str
    operations: Mapping[str, str]
    number: str = "{0}"
    words: frozenset[str] = frozenset()

    @property
    def single(self) -> bool:
        """Whether numbers are marked as of single precision."""
        return self.number != "{0}"

    def numeral(self, value: float) -> str:
        """Source of a number, its sign first; whole ones have as many digits as they need."""
        digits = f"{abs(value)}.0" if isinstance(value, int) else repr(abs(value))
        sign = "-" if math.copysign(1.0, value) < 0.0 else ""
        return sign + self.number.format(digits)

    def identifier(self, name: str) -> str:
        """`name`, with an underscore more where it is a word, or a word with underscores."""
        return f"{name}_" if name.rstrip("_") in self.words else name

    def expression(self, expression: sp.Expr) -> str:
        """Source of an expression."""
        text = str(Printer(self).doprint(expression))
        return text[1:-1] if _end_of_parentheses(text, 0) == len(text) else text


class Printer(PythonCodePrinter):
    """Prints expressions in a language; what it does not name is written as in Python."""

    def __init__(self, language: Language) -> None:
        super().__init__({"fully_qualified_modules": True, "precision": 17})
        self.language = language

    def _print(self, expr: Any, **given: Any) -> str:
        """Operations by their template, all else as the printer of Python does."""
        template = self.language.operations.get(type(expr).__name__)
        if template is None:
            return str(super()._print(expr, **given))
        if "{all}" in template:
            return template.format(all=", ".join(self._print(a) for a in expr.args))
        if type(expr).__name__ in PAIRWISE:
            return reduce(template.format, [self._print(a) for a in expr.args])
        first, *others = expr.args or [None]
        atoms = [self.parenthesize(a, PRECEDENCE["Func"], strict=True) for a in others]
        return template.format(self._print(first) if expr.args else "", *atoms)

    def _print_Rational(self, expr: sp.Rational) -> str:
        return self.language.numeral(float(expr))

    def _print_Integer(self, expr: sp.Integer) -> str:
        return self.language.numeral(int(expr))

    def _print_Float(self, expr: sp.Float) -> str:
        return self.language.numeral(float(expr))

    def _print_NumberSymbol(self, expr: sp.NumberSymbol) -> str:
        return self.language.numeral(float(expr))

    def _print_Symbol(self, expr: sp.Symbol) -> str:
        return self.language.identifier(str(super()._print_Symbol(expr)))

    def _print_Pi(self, expr: sp.Expr) -> str:
        return self.language.operations["pi"]

    def _print_Pow(self, expr: sp.Pow, rational: bool = False) -> str:
        base, exponent = expr.as_base_exp()
        operations, one = self.language.operations, self.language.numeral(1)
        if abs(exponent) == sp.Rational(1, 2):
            root = "sqrt" if exponent > 0 else "inverse sqrt"
            return operations[root].format(self._print(base))
        if exponent.is_Integer and 0 < abs(int(exponent)) <= LARGEST_PRODUCT:
            factor = self._atom(base)
            product = " * ".join([factor] * abs(int(exponent)))
            if exponent > 0:
                return product if exponent == 1 else f"({product})"
            return f"{one} / {product}" if exponent == -1 else f"{one} / ({product})"
        pair = [self.parenthesize(e, PRECEDENCE["Pow"], strict=False) for e in (base, exponent)]
        return operations["pow"].format(*pair)

    def _print_Piecewise(self, expr: sp.Piecewise) -> str:
        if "choice" not in self.language.operations:
            return str(super()._print_Piecewise(expr))
        (value, condition), *others = expr.args
        if condition == sp.true:
            return self._print(value)
        other = sp.Piecewise(*others) if others else sp.nan
        choice = self.language.operations["choice"]
        return choice.format(*(self._print(e) for e in (condition, value, other)))

    def _print_Mul(self, expr: sp.Mul) -> str:
        negative, above, below = self.quotient(expr)
        text = " * ".join(above) + (f" / {below}" if below else "")
        return f"-{text}" if negative else text

    def quotient(self, expr: sp.Mul) -> tuple[bool, list[str], str | None]:
        """Whether a product is negative, the factors above its one division, and what is below it.

        Exponentials stay above the division, where they cannot overflow.
        """
        coefficient, product = expr.as_coeff_Mul()
        factors = product.as_ordered_factors()
        under = [f for f in factors if f.is_Pow and f.exp.is_Integer and f.exp.is_negative]
        above = [self._factor(f) for f in factors if f not in under]
        if abs(coefficient) != 1 or not above:
            above.insert(0, self.doprint(abs(coefficient)))
        divisor = sp.Mul(*[1 / f for f in under])
        below = self._atom(divisor) if under else None
        return bool(coefficient.is_negative), above, below

    def _atom(self, expression: sp.Expr) -> str:
        """An expression, in parentheses unless it is a name, a call or in them already."""
        text = self._print(expression)
        called = expression.is_Function and re.match(r"[\w.]+\(", text)
        closed = "(" in text and _end_of_parentheses(text, text.index("(")) == len(text)
        enclosed = closed and (called or text.startswith("("))
        return text if expression.is_Atom or enclosed else f"({text})"

    def _factor(self, expression: sp.Expr) -> str:
        """A factor, in parentheses where a product needs them."""
        if expression.is_Rational and expression.is_nonnegative:
            return str(self.doprint(expression))
        return str(self.parenthesize(expression, PRECEDENCE["Mul"], strict=True))


def _end_of_parentheses(text: str, start: int) -> int:
    """The place behind the parenthesis that closes the one at `start`; -1 without one."""
    depth = 0
    for place in range(start, len(text)):
        depth += (text[place] == "(") - (text[place] == ")")
        if depth == 0:
            return place + 1 if place > start else -1
    return -1
