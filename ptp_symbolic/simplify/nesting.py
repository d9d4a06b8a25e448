"""Write sums over state functions with few operations: factored, nested, shared between rows."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import sympy as sp

from ptp_symbolic.derivation.bodies import RigidEquations
from ptp_symbolic.simplify.operations import Line
from ptp_symbolic.simplify.regressors import Exponents, StateFunction, place_of

Combination = dict[sp.Expr, sp.Rational]
Row = dict[StateFunction, Combination]
AngleRow = dict[tuple[Exponents, ...], Combination]


class AngleTerms:
    """Products of functions of the joint angles, with names for half the double-angle functions.

    `lines` holds the names used so far, in order of their first use.
    """

    def __init__(self, coordinates: Sequence[sp.Symbol]) -> None:
        self.coordinates = tuple(coordinates)
        self.lines: dict[sp.Symbol, sp.Expr] = {}

    def nested(self, row: AngleRow) -> sp.Expr:
        """The sum of `row`, grouped by the functions of one angle after the other."""
        terms = [
            (angles, sp.Add(*(value * symbol for symbol, value in combination.items())))
            for angles, combination in row.items()
        ]
        return self._nested(terms, 0)

    def _nested(self, terms: list[tuple[tuple[Exponents, ...], sp.Expr]], depth: int) -> sp.Expr:
        if depth == len(self.coordinates):
            return sp.Add(*(coefficient for _, coefficient in terms))
        powers = list(dict.fromkeys(angles[depth] for angles, _ in terms))
        return sp.Add(
            *(
                self._function(depth, power)
                * self._nested([term for term in terms if term[0][depth] == power], depth + 1)
                for power in powers
            )
        )

    def _function(self, place: int, powers: Exponents) -> sp.Expr:
        angle = self.coordinates[place]
        joint = place_of(angle)
        half_sin = sp.Symbol(f"half_sin_2{joint}", real=True)
        half_cos = sp.Symbol(f"half_cos_2{joint}", real=True)
        sine, cosine, both, double = powers
        if both:
            self.lines[half_sin] = sp.sin(angle) * sp.cos(angle)
        if double:
            self.lines[half_cos] = sp.Rational(1, 2) - sp.sin(angle) ** 2
        return sp.sin(angle) ** sine * sp.cos(angle) ** cosine * half_sin**both * half_cos**double


def write_sum(row: Row, angles: AngleTerms) -> sp.Expr:
    """The sum of `row`, an entry of the mass matrix, which holds no rates."""
    return angles.nested({function.angles: c for function, c in row.items()})


@dataclass(frozen=True)
class _RateTerm:
    """`scale` times powers of the rates times a sum over functions of the angles."""

    row: int
    scale: sp.Rational
    powers: Exponents
    sum: AngleRow

    @property
    def key(self) -> frozenset:
        """Equal for terms whose sums are equal."""
        return frozenset((angles, frozenset(c.items())) for angles, c in self.sum.items())


def write_forcing(
    rows: Sequence[Row], rigid: RigidEquations, angles: AngleTerms, taken: Iterable[str]
) -> tuple[list[sp.Expr], list[Line]]:
    """Return the forcing [n] and the terms that its rows share.

    A sum that appears with rates in several places (the slope of an inertia in the Coriolis and in
    the centrifugal torque) is shared together with the rates that its places have in common.
    """
    terms = [term for i, row in enumerate(rows) for term in _rate_terms(i, row)]
    places: dict[frozenset, list[_RateTerm]] = {}
    for term in terms:
        places.setdefault(term.key, []).append(term)
    factors: dict[frozenset, tuple[sp.Expr, Exponents]] = {}
    shared: list[Line] = []
    still = (0,) * len(rigid.rates)
    for key, group in places.items():
        total = angles.nested(group[0].sum)
        factors[key] = (total, still)
        common = _common([term.powers for term in group])
        if len(group) > 1:
            name = unused_name("coriolis", {*taken, *(str(symbol) for symbol, _ in shared)})
            symbol = sp.Symbol(name, real=True)
            shared.append((symbol, _product(rigid.rates, common) * total))
            factors[key] = (symbol, common)
    written = []
    for i, row in enumerate(rows):
        gravity = {f.angles: c for f, c in row.items() if not any(f.rates)}
        own = [(term, *factors[term.key]) for term in terms if term.row == i]
        written.append(_factored(own, rigid.rates) + angles.nested(gravity))
    return written, shared


def _rate_terms(index: int, row: Row) -> list[_RateTerm]:
    groups: dict[Exponents, AngleRow] = {}
    for function, combination in row.items():
        if any(function.rates):
            groups.setdefault(function.rates, {})[function.angles] = combination
    terms = []
    for powers, angle_row in groups.items():
        scale = _content([value for c in angle_row.values() for value in c.values()])
        primitive = {a: {s: v / scale for s, v in c.items()} for a, c in angle_row.items()}
        terms.append(_RateTerm(index, scale, powers, primitive))
    return terms


def _content(values: Sequence[sp.Rational]) -> sp.Rational:
    """Greatest common divisor of `values`, negative where most of them are (the first of two)."""
    divisor = sp.Integer(0)
    for value in values:
        divisor = divisor.gcd(value)
    balance = sum(sp.sign(value) for value in values) or sp.sign(values[0])
    return divisor if balance > 0 else -divisor


def _factored(
    terms: Sequence[tuple[_RateTerm, sp.Expr, Exponents]], rates: Sequence[sp.Symbol]
) -> sp.Expr:
    """Sum of scale times rates times factor, with the common rates and sign in front."""
    if not terms:
        return sp.Integer(0)
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
