"""Polynomials in sines and cosines: a sure and fast normal form.

Every expression that a rigid platform produces is a polynomial with rational coefficients in
parameters, rates and the sines and cosines of angles. Replacing each squared cosine by one minus
the squared sine leaves a form that is unique, so two expressions are equal exactly when their
difference becomes zero. `simplify` has no such guarantee and takes a thousand times longer.
"""

from collections import defaultdict
from collections.abc import Iterable

import sympy as sp
from sympy.polys.rings import PolyElement, PolyRing

Monomial = tuple[int, ...]


class TrigonometricRing:
    """Polynomials over the rationals in the symbols, sines and cosines of given expressions.

    `generators` lists them in a fixed order; sine and cosine of each angle both appear, even if an
    expression uses one alone.
    """

    def __init__(self, expressions: Iterable[sp.Expr]) -> None:
        expressions = [sp.sympify(expression) for expression in expressions]
        functions = {f for e in expressions for f in e.atoms(sp.sin, sp.cos)}
        angles = sorted({f.args[0] for f in functions}, key=sp.default_sort_key)
        opaque = {f: sp.Dummy() for f in functions}
        symbols = {s for e in expressions for s in e.xreplace(opaque).free_symbols}
        plain = sorted(symbols - set(opaque.values()), key=str)
        circular = [f(a) for a in angles for f in (sp.sin, sp.cos)]
        self.generators: tuple[sp.Expr, ...] = (*plain, *circular)
        self._places = {g: sp.Symbol(f"generator_{i}") for i, g in enumerate(self.generators)}
        self._ring = PolyRing(list(self._places.values()), sp.QQ)
        self._pairs = [(len(plain) + 2 * i, len(plain) + 2 * i + 1) for i in range(len(angles))]

    def polynomial(self, expression: sp.Expr) -> PolyElement:
        """`expression` multiplied out, trigonometric identities not yet applied.

        Raises ValueError when the expression is no polynomial in the generators.
        """
        places = {g: p for g, p in self._places.items() if not g.is_Symbol}
        plain = {g: p for g, p in self._places.items() if g.is_Symbol}
        return self._ring.from_expr(sp.sympify(expression).xreplace(places).xreplace(plain))

    def reduced(self, expression: sp.Expr) -> dict[Monomial, sp.Rational]:
        """Normal form of `expression`: coefficient by exponents of `generators`."""
        terms = dict(self.polynomial(expression))
        for sin_at, cos_at in self._pairs:
            terms = _without_squares(terms, cos_at, sin_at)
        return {m: sp.Rational(c.numerator, c.denominator) for m, c in terms.items()}

    def product(self, monomial: Monomial) -> sp.Expr:
        """The product of powers of generators that `monomial` stands for."""
        factors = zip(self.generators, monomial, strict=True)
        return sp.Mul(*(generator**power for generator, power in factors if power))

    def expression(self, terms: dict[Monomial, sp.Rational]) -> sp.Expr:
        """The sum that `terms` stands for."""
        return sp.Add(*(value * self.product(monomial) for monomial, value in terms.items()))


def _without_squares(terms: dict, square_at: int, other_at: int) -> dict:
    """Replace the square of one generator by one minus the square of the other."""
    result: dict = defaultdict(int)
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
    return {monomial: value for monomial, value in result.items() if value}


def normal_form(expression: sp.Expr) -> sp.Expr:
    """The unique form without squared cosines, multiplied out.

    Raises ValueError when `expression` is no polynomial in symbols, sines and cosines.
    """
    ring = TrigonometricRing([expression])
    return ring.expression(ring.reduced(expression))
