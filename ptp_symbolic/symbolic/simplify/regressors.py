"""Write equations of motion as sums of state functions times coefficients of parameters.

The state functions are products of powers of the rates and of the sines of the angles, times the
cosine of each angle at most once. Such products are linearly independent functions of the state:
they are the monomials of the trigonometric normal form.
"""

from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import sympy as sp

from ptp_symbolic.symbolic.derivation.trigonometry import TrigonometricRing
from ptp_symbolic.symbolic.mechanics.kinematics import place_of

Exponents = tuple[int, ...]
Coefficient = dict[Exponents, sp.Rational]


@dataclass(frozen=True)
class StateFunction:
    """A product of rates, sines and cosines, given by exponents.

    `rates` [n] belong to the rates, `angles` [n][2] to sine and cosine of each angle.
    """

    rates: Exponents
    angles: tuple[Exponents, ...]

    def name(self, coordinates: Sequence[sp.Symbol]) -> str:
        """Words for the functions of angles, such as ``sin_pan_cos_tilt``; empty for one."""
        words = []
        for coordinate, (sine, cosine) in zip(coordinates, self.angles, strict=True):
            words += ["sin"] * (sine > 0) + ["sq" if sine == 2 else str(sine)] * (sine > 1)
            words += ["cos"] * cosine + [place_of(coordinate)] * (sine + cosine > 0)
        return "_".join(words)


@dataclass(frozen=True)
class Regression:
    """Expressions as sums: per expression, the coefficient of every state function in it.

    A coefficient is a polynomial in `parameters` (symbols, or sines and cosines of symbols), given
    by exponents.
    """

    parameters: tuple[sp.Expr, ...]
    rows: tuple[dict[StateFunction, Coefficient], ...]

    def parameter_expression(self, coefficient: Coefficient) -> sp.Expr:
        """The polynomial in the parameters that `coefficient` stands for."""
        return sp.Add(
            *(
                value * sp.Mul(*(g**k for g, k in zip(self.parameters, powers, strict=True)))
                for powers, value in coefficient.items()
            )
        )


def regress(
    expressions: Iterable[sp.Expr], coordinates: Sequence[sp.Symbol], rates: Sequence[sp.Symbol]
) -> Regression:
    """Split `expressions` into state functions and coefficients, exactly.

    Raises ValueError when one is no polynomial in parameters, rates and sines and cosines of the
    coordinates.
    """
    expressions = list(expressions)
    ring = TrigonometricRing(expressions)
    places = {generator: index for index, generator in enumerate(ring.generators)}
    angle_at = [(places.get(sp.sin(q)), places.get(sp.cos(q))) for q in coordinates]
    rate_at = [places.get(rate) for rate in rates]
    state = {*rate_at, *(index for pair in angle_at for index in pair)}
    fixed = [index for index in range(len(ring.generators)) if index not in state]
    parameters = tuple(ring.generators[index] for index in fixed)
    if any(set(coordinates) & parameter.free_symbols for parameter in parameters):
        raise ValueError("An angle appears outside of its own sine and cosine.")
    rows = []
    for expression in expressions:
        row: dict[StateFunction, Coefficient] = defaultdict(dict)
        for monomial, value in ring.reduced(expression).items():
            function = StateFunction(
                _pick(monomial, rate_at), tuple(_pick(monomial, pair) for pair in angle_at)
            )
            row[function][_pick(monomial, fixed)] = value
        rows.append(dict(sorted(row.items(), key=_order)))
    return Regression(parameters, tuple(rows))


def _pick(monomial: Exponents, places: Iterable[int | None]) -> Exponents:
    return tuple(0 if place is None else monomial[place] for place in places)


def _order(item: tuple[StateFunction, Coefficient]) -> tuple[int, int, Exponents]:
    """Constants first, then by degree; the sine of the first angle before the others."""
    function, _ = item
    angles = tuple(-power for angle in function.angles for power in angle)
    rates = tuple(-power for power in function.rates)
    return (sum(function.rates), -sum(angles), (*rates, *angles))
