"""Write equations of motion as sums of state functions times coefficients of parameters.

The state functions are products of powers of the rates and, per angle, of its sine, its cosine,
``half_sin_2<place>`` = sin cos and ``half_cos_2<place>`` = 1/2 - sin^2, where at most one of the
first three appears, once. Such products are linearly independent functions of the state: the even
ones are powers of cos(2q), alone or times sin(2q); the odd ones change sign under a half turn.
"""

from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from math import comb

import sympy as sp

from ptp_symbolic.derivation.trigonometry import TrigonometricRing

Exponents = tuple[int, ...]
Coefficient = dict[Exponents, sp.Rational]
PER_ANGLE = ("sin", "cos", "sin_2", "cos_2")


def place_of(coordinate: sp.Symbol) -> str:
    """The place in the name of a coordinate: 'pan' for theta_pan."""
    return str(coordinate).removeprefix("theta_")


@dataclass(frozen=True)
class StateFunction:
    """A product of rates and functions of angles, given by exponents.

    `rates` [n] belong to the rates, `angles` [n][4] to the functions of each angle in the order of
    PER_ANGLE.
    """

    rates: Exponents
    angles: tuple[Exponents, ...]

    def name(self, coordinates: Sequence[sp.Symbol]) -> str:
        """Words for the functions of angles, such as ``sin_pan_cos_2tilt``; empty for one."""
        words = []
        for coordinate, powers in zip(coordinates, self.angles, strict=True):
            for word, power in zip(PER_ANGLE, powers, strict=True):
                joint = "" if word.endswith("2") else "_"
                words += [f"{word}{joint}{place_of(coordinate)}"] * power
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
    circular = [(places.get(sp.sin(q)), places.get(sp.cos(q))) for q in coordinates]
    moving = [places.get(rate) for rate in rates]
    state = {i for i in (*moving, *(i for pair in circular for i in pair)) if i is not None}
    fixed = [i for i in range(len(ring.generators)) if i not in state]
    parameters = tuple(ring.generators[i] for i in fixed)
    if any(set(coordinates) & parameter.free_symbols for parameter in parameters):
        raise ValueError("An angle appears outside of its own sine and cosine.")
    rows = []
    for expression in expressions:
        row: dict[StateFunction, Coefficient] = defaultdict(lambda: defaultdict(lambda: sp.Integer(0)))
        for monomial, value in ring.reduced(expression).items():
            powers = tuple(0 if i is None else monomial[i] for i in moving)
            of_parameters = tuple(monomial[i] for i in fixed)
            for factor, angles in _double_angles(monomial, circular):
                row[StateFunction(powers, angles)][of_parameters] += factor * value
        rows.append(_without_zeros(row))
    return Regression(parameters, tuple(rows))


def _double_angles(
    monomial: Exponents, circular: Sequence[tuple[int | None, int | None]]
) -> list[tuple[sp.Rational, tuple[Exponents, ...]]]:
    """Write sin^a cos^b of every angle (b at most 1) with sine and cosine of the double angle."""
    products: list[tuple[sp.Rational, tuple[Exponents, ...]]] = [(sp.Integer(1), ())]
    for sin_at, cos_at in circular:
        squares, sine = divmod(0 if sin_at is None else monomial[sin_at], 2)
        cosine = 0 if cos_at is None else monomial[cos_at]
        both = sine * cosine
        single = (sine - both, cosine - both, both)
        expanded = [
            (comb(squares, k) * sp.Rational((-1) ** k, 2 ** (squares - k)), (*single, k))
            for k in range(squares + 1)
        ]
        products = [(p * q, (*left, right)) for p, left in products for q, right in expanded]
    return products


def _without_zeros(
    row: dict[StateFunction, Coefficient],
) -> dict[StateFunction, Coefficient]:
    kept = {f: {m: v for m, v in c.items() if v != 0} for f, c in row.items()}
    return {f: c for f, c in sorted(kept.items(), key=lambda item: _order(item[0])) if c}


def _order(function: StateFunction) -> tuple:
    """Constants first, then double angles, cosines and sines; gravity before rates."""
    powers = tuple(power for angle in function.angles for power in reversed(angle))
    return (sum(function.rates), sum(powers), tuple(-p for p in function.rates + powers))
