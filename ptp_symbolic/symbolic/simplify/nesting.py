"""Write sums over state functions with few operations: nested, factored, shared between rows."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import sympy as sp

from ptp_symbolic.symbolic.mechanics.kinematics import place_of
from ptp_symbolic.symbolic.simplify.operations import Line
from ptp_symbolic.symbolic.simplify.regressors import Exponents, StateFunction
from ptp_symbolic.symbolic.symbols import ZERO, real

Combination = dict[sp.Expr, sp.Rational]
Row = dict[StateFunction, Combination]
AngleRow = dict[tuple[Exponents, ...], Combination]


@dataclass(frozen=True)
class _Quadratic:
    """An inertia a + sin(q) t with t = sine sin(q) + cosine cos(q), named `symbol`.

    Its slope is 2 cos(q) t - cosine: the same t serves the inertia and the Coriolis torques.
    """

    place: int
    symbol: sp.Symbol
    sine: Combination
    cosine: Combination


class AngleSums:
    """Writes sums over functions of the joint angles, and names what several of them use.

    `lines` holds the names given so far with their meaning, in order of use; none is in `taken`.
    """

    def __init__(self, coordinates: Sequence[sp.Symbol], taken: Iterable[str]) -> None:
        self.coordinates = tuple(coordinates)
        self.lines: list[Line] = []
        self._taken = set(taken)
        self._quadratics: list[_Quadratic] = []

    def write_inertia(self, title: str, row: Row) -> sp.Expr:
        """The entry `title` of the mass matrix, which holds no rates."""
        terms = {function.angles: combination for function, combination in row.items()}
        place = self._only_angle(terms)
        if place is None or max(sum(angles[place]) for angles in terms) != 2:
            return self.write(terms)
        powers = {angles[place]: combination for angles, combination in terms.items()}
        joint, angle = place_of(self.coordinates[place]), self.coordinates[place]
        cosine, sine = powers.pop((1, 1), {}), powers.pop((2, 0), {})
        factor = _linear(sine) * sp.sin(angle) + _linear(cosine) * sp.cos(angle)
        symbol = self.named(f"{title}_per_sin_{joint}", factor)
        self._quadratics.append(_Quadratic(place, symbol, sine, cosine))
        rest = {angles: c for angles, c in terms.items() if angles[place] in powers}
        return self.write(rest) + sp.sin(angle) * symbol

    def named(self, name: str, meaning: sp.Expr) -> sp.Symbol:
        """Add a line that gives `meaning` the name `name`, or a like one, and return its symbol."""
        symbol = real(unused_name(name, self._taken))
        self._taken.add(str(symbol))
        self.lines.append((symbol, meaning))
        return symbol

    def write(self, terms: AngleRow) -> sp.Expr:
        """The sum of `terms`, by way of a named factor where that fits."""
        place = self._only_angle(terms)
        if place is None or any(sum(angles[place]) not in (0, 2) for angles in terms):
            return self._nested(list(terms.items()), 0)
        powers = {angles[place]: combination for angles, combination in terms.items()}
        for quadratic in self._quadratics:
            scale = _ratio(powers, quadratic) if quadratic.place == place else None
            if scale is not None:
                offset = powers.get((0, 0), {})
                rest = plus(offset, quadratic.cosine, -scale)
                turned = sp.cos(self.coordinates[place]) * quadratic.symbol
                return scale * turned + _linear(rest)
        return self._nested(list(terms.items()), 0)

    def _only_angle(self, terms: AngleRow) -> int | None:
        """The one angle on which `terms` depend; None if there is no such angle."""
        places = {i for angles in terms for i, powers in enumerate(angles) if any(powers)}
        return places.pop() if len(places) == 1 else None

    def _nested(
        self, terms: list[tuple[tuple[Exponents, ...], Combination]], depth: int
    ) -> sp.Expr:
        """Horner's rule in the sine of one angle, then in the next angle."""
        if depth == len(self.coordinates):
            return sp.Add(*(_linear(combination) for _, combination in terms))
        angle = self.coordinates[depth]
        total = ZERO
        for cosine in (0, 1):
            here = [term for term in terms if term[0][depth] == (0, cosine)]
            total += sp.cos(angle) ** cosine * self._nested(here, depth + 1)
        higher = [
            ((*a[:depth], (a[depth][0] - 1, a[depth][1]), *a[depth + 1 :]), combination)
            for a, combination in terms
            if a[depth][0] > 0
        ]
        return total + sp.sin(angle) * self._nested(higher, depth) if higher else total


def _linear(combination: Combination) -> sp.Expr:
    return sp.Add(*(value * symbol for symbol, value in combination.items()))


def _ratio(powers: dict[Exponents, Combination], quadratic: _Quadratic) -> sp.Rational | None:
    """Return x where `powers` is x cos(q) t but for a constant; None where there is no such x."""
    both, square = powers.get((1, 1), {}), powers.get((2, 0), {})
    sample = next(iter(quadratic.sine), None)
    if sample is not None:
        scale = both.get(sample, ZERO) / quadratic.sine[sample]
    else:
        sample = next(iter(quadratic.cosine))
        scale = -square.get(sample, ZERO) / quadratic.cosine[sample]
    fits = not plus(both, quadratic.sine, -scale) and not plus(square, quadratic.cosine, scale)
    return scale if fits and scale else None


def plus(left: dict, right: dict, factor: sp.Rational | int) -> dict:
    """Left + factor right, without the entries that cancel."""
    total = {key: left.get(key, 0) + factor * right.get(key, 0) for key in {**left, **right}}
    return {key: value for key, value in total.items() if value != 0}


@dataclass(frozen=True)
class _RateTerm:
    """In row `row`: `scale` times powers of the rates times a sum over functions of the angles."""

    row: int
    scale: sp.Rational
    powers: Exponents
    sum: AngleRow

    @property
    def key(self) -> frozenset:
        """Equal for terms whose sums are equal."""
        return frozenset((angles, frozenset(c.items())) for angles, c in self.sum.items())


def write_forcing(
    rows: Sequence[Row], rates: Sequence[sp.Symbol], sums: AngleSums
) -> list[sp.Expr]:
    """Return the forcing [n]; what its rows share is named in `sums`.

    A sum that appears with rates in several places (the slope of an inertia in the Coriolis and in
    the centrifugal torque) is shared together with the rates that its places have in common.
    """
    terms = [term for i, row in enumerate(rows) for term in _rate_terms(i, row)]
    groups: dict[frozenset, list[_RateTerm]] = {}
    for term in terms:
        groups.setdefault(term.key, []).append(term)
    factors: dict[frozenset, tuple[sp.Expr, Exponents]] = {}
    for key, group in groups.items():
        total = sums.write(group[0].sum)
        common = _common([term.powers for term in group])
        if len(group) == 1:
            factors[key] = (total, (0,) * len(rates))
            continue
        factors[key] = (sums.named("coriolis", _product(rates, common) * total), common)
    written = []
    for i, row in enumerate(rows):
        gravity = {f.angles: c for f, c in row.items() if not any(f.rates)}
        own = [(term, *factors[term.key]) for term in terms if term.row == i]
        written.append(_factored(own, rates) + sums.write(gravity))
    return written


def _rate_terms(index: int, row: Row) -> list[_RateTerm]:
    groups: dict[Exponents, AngleRow] = {}
    for function, combination in row.items():
        if any(function.rates):
            groups.setdefault(function.rates, {})[function.angles] = combination
    terms = []
    for powers, sums in groups.items():
        scale = _content([value for c in sums.values() for value in c.values()])
        primitive = {a: {s: v / scale for s, v in c.items()} for a, c in sums.items()}
        terms.append(_RateTerm(index, scale, powers, primitive))
    return terms


def _content(values: Sequence[sp.Rational]) -> sp.Rational:
    """Greatest common divisor of `values`, negative where most of them are (the first of two)."""
    divisor = ZERO
    for value in values:
        divisor = divisor.gcd(value)
    balance = sum(sp.sign(value) for value in values) or sp.sign(values[0])
    return divisor if balance > 0 else -divisor


def _factored(
    terms: Sequence[tuple[_RateTerm, sp.Expr, Exponents]], rates: Sequence[sp.Symbol]
) -> sp.Expr:
    """Sum of scale times rates times factor, with the common rates and sign in front."""
    if not terms:
        return ZERO
    left = [tuple(p - q for p, q in zip(t.powers, used, strict=True)) for t, _, used in terms]
    common = _common(left)
    sign = -1 if all(term.scale < 0 for term, _, _ in terms) else 1
    inner = sp.Add(
        *(
            sign
            * term.scale
            * _product(rates, tuple(p - q for p, q in zip(powers, common, strict=True)))
            * factor
            for (term, factor, _), powers in zip(terms, left, strict=True)
        )
    )
    return sp.Mul(sign, _product(rates, common), inner)


def _common(powers: Sequence[Exponents]) -> Exponents:
    return tuple(min(column) for column in zip(*powers, strict=True))


def _product(symbols: Sequence[sp.Symbol], powers: Exponents) -> sp.Expr:
    return sp.Mul(*(symbol**power for symbol, power in zip(symbols, powers, strict=True)))


def unused_name(name: str, taken: set[str]) -> str:
    """`name`, with a number behind it when it is taken."""
    number, free = 1, name
    while free in taken:
        number += 1
        free = f"{name}_{number}"
    return free
