"""Polynomials in sines and cosines: a sure and fast normal form.

Every expression that a rigid platform produces is a polynomial with rational coefficients in
parameters, rates and the sines and cosines of angles. Replacing each squared cosine by one minus
the squared sine leaves a form that is unique, so two expressions are equal exactly when their
difference becomes zero. `simplify` has no such guarantee and takes a thousand times longer.
"""

from collections import defaultdict
from collections.abc import Iterable

import sympy as sp
from sympy.polys.rings import PolyRing

from ptp_symbolic.symbolic.symbols import ZERO

Monomial = tuple[int, ...]
Terms = dict[Monomial, sp.Rational]


class TrigonometricRing:
    """Polynomials over the rationals in the symbols, sines and cosines of given expressions.

    `generators` lists them in a fixed order; sine and cosine of each angle both appear, even if an
    expression uses one alone, and `pairs` holds their places (sine, cosine) in the list.
    """

    def __init__(self, expressions: Iterable[sp.Expr]) -> None:
        expressions = [_of_single_angles(expression) for expression in expressions]
        functions = {f for e in expressions for f in e.atoms(sp.sin, sp.cos)}
        angles = sorted({f.args[0] for f in functions}, key=sp.default_sort_key)
        opaque = {f: sp.Dummy() for f in functions}
        symbols = {s for e in expressions for s in e.xreplace(opaque).free_symbols}
        plain = sorted(symbols - set(opaque.values()), key=str)
        circular = [f(a) for a in angles for f in (sp.sin, sp.cos)]
        self.generators: tuple[sp.Expr, ...] = (*plain, *circular)
        places = [sp.Symbol(f"generator_{i}") for i in range(len(self.generators))]
        self._plain = dict(zip(plain, places, strict=False))
        self._functions = dict(zip(circular, places[len(plain) :], strict=True))
        self._ring = PolyRing(places, sp.QQ)
        self.pairs = [(len(plain) + 2 * i, len(plain) + 2 * i + 1) for i in range(len(angles))]

    def terms(self, expression: sp.Expr) -> Terms:
        """`expression` multiplied out: coefficient by exponents of `generators`.

        Raises ValueError when the expression is no polynomial in the generators, or holds floats.
        """
        if expression.has(sp.Float):
            raise ValueError(f"{expression} holds a float; write a Rational.")
        opaque = _of_single_angles(expression).xreplace(self._functions)
        polynomial = self._ring.from_expr(opaque.xreplace(self._plain))
        return {m: sp.Rational(c.numerator, c.denominator) for m, c in polynomial.items()}

    def reduced(self, expression: sp.Expr) -> Terms:
        """Normal form of `expression`: `terms` without squared cosines."""
        terms = self.terms(expression)
        for sin_at, cos_at in self.pairs:
            terms = without_squares(terms, cos_at, sin_at)
        return terms

    def product(self, monomial: Monomial) -> sp.Expr:
        """The product of powers of generators that `monomial` stands for."""
        factors = zip(self.generators, monomial, strict=True)
        return sp.Mul(*(generator**power for generator, power in factors if power))

    def expression(self, terms: Terms) -> sp.Expr:
        """The sum that `terms` stands for."""
        return sp.Add(*(value * self.product(monomial) for monomial, value in terms.items()))


def _of_single_angles(expression: sp.Expr) -> sp.Expr:
    """Write sines and cosines of sums and multiples of angles with those of the angles."""
    functions = expression.atoms(sp.sin, sp.cos)
    compound = [f for f in functions if not f.args[0].is_Symbol]
    if not compound:
        return expression
    expression = expression.xreplace({f: sp.expand_trig(f) for f in compound})
    for function in expression.atoms(sp.sin, sp.cos):
        if not _is_angle(function.args[0]):
            raise ValueError(f"{function} is not the function of a sum or multiple of angles.")
    return expression


def _is_angle(argument: sp.Expr) -> bool:
    """Whether `argument` is a symbol or a product of symbols and pi, such as pi f t."""
    factors = sp.Mul.make_args(argument)
    return all(factor.is_Symbol or factor is sp.pi for factor in factors)


def without_squares(terms: Terms, square_at: int, other_at: int) -> Terms:
    """Replace the square of one generator by one minus the square of the other."""
    result: Terms = defaultdict(lambda: ZERO)
    pending = list(terms.items())
    while pending:
        monomial, value = pending.pop()
        if monomial[square_at] < 2:
            result[monomial] += value
            continue
        lowered = list(monomial)
        lowered[square_at] -= 2
        pending.append((tuple(lowered), value))
        lowered[other_at] += 2
        pending.append((tuple(lowered), -value))
    return {monomial: value for monomial, value in result.items() if value != 0}


def normal_form(expression: sp.Expr) -> sp.Expr:
    """The unique form without squared cosines, multiplied out.

    Raises ValueError when `expression` is no polynomial in symbols, sines and cosines.
    """
    ring = TrigonometricRing([expression])
    return ring.expression(ring.reduced(expression))
