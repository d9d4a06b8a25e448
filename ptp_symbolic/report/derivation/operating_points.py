"""At which operating points the derivation report linearises."""

import math
import re
from collections.abc import Sequence

from ptp_symbolic.errors import InputError, unknown
from ptp_symbolic.platform.units import compatible, to_si
from ptp_symbolic.symbolic.derivation.equations import Equations
from ptp_symbolic.symbolic.derivation.linearisation import OperatingPoint
from ptp_symbolic.symbolic.mechanics import kinematics

TILTS = tuple(map(math.radians, (0.0, -45.0, 45.0)))
SLIDING_RATE = 0.1  # rad/s (m/s of a linear joint) at which dry friction is linearised


def usual_points(equations: Equations) -> tuple[OperatingPoint, ...]:
    """At rest, dry friction left out, at several tilt angles where these matter and can be had; and
    where there is dry friction, sliding forwards at SLIDING_RATE.
    """
    tilts = [tilt for tilt in TILTS if _within(equations, tilt)] if _depends(equations) else []
    points = [OperatingPoint({"tilt": tilt}, {}) for tilt in tilts or [0.0]]
    sliding = {
        kinematics.place_of(f.rate).rpartition("_")[2]: SLIDING_RATE for f in equations.frictions
    }
    if sliding:
        points.append(OperatingPoint({}, sliding, sliding=True))
    return tuple(points)


def _depends(equations: Equations) -> bool:
    """Whether the tilt angle matters."""
    tilt = kinematics.angle("tilt")
    found = [*equations.mass_matrix, *equations.forcing, *(t for _, t in equations.terms)]
    return any(tilt in expression.free_symbols for expression in found)


def _within(equations: Equations, tilt: float) -> bool:
    """Whether linkages allow the tilt angle."""
    return all(lower < tilt < upper for lower, upper, _ in _bounds(equations, "tilt"))


def _bounds(equations: Equations, axis: str) -> list[tuple[float, float, str]]:
    """Between which angles of `axis` the equations hold, and what ends there."""
    values = {p.symbol: p.default for p in equations.parameters}
    return [
        (float(limit.lower.xreplace(values)), float(limit.upper.xreplace(values)), limit.meaning)
        for limit in equations.limits
        if limit.state in (kinematics.angle(axis), kinematics.gear_angle(axis))
    ]


def read_points(equations: Equations, texts: Sequence[str]) -> tuple[OperatingPoint, ...]:
    """Operating points of texts such as ``theta_tilt=30deg,omega_pan=0.2``; SI without a unit.

    Dry friction slides where every axis that has it turns forwards, and is left out at rest.
    Raises InputError for what is no joint angle or rate, no number, of another unit, or out of
    reach.
    """
    return tuple(_read(equations, text) for text in texts)


def _read(equations: Equations, text: str) -> OperatingPoint:
    angles, rates = (
        {str(of(a)): a for a in equations.axes} for of in (kinematics.angle, kinematics.rate)
    )
    found: dict[str, float] = {}
    for part in text.split(","):
        name, _, value = (word.strip() for word in part.partition("="))
        if name not in (*angles, *rates):
            raise unknown("joint angle or rate", name, (*angles, *rates))
        unit = equations.unit("rad" if name in angles else "rad/s")
        found[name] = _number(part.strip(), value, unit)
    point_rates = {axis: found[name] for name, axis in rates.items() if name in found}
    rubbing = {kinematics.place_of(f.rate).rpartition("_")[2] for f in equations.frictions}
    turning = {axis for axis, rate in point_rates.items() if rate}
    backwards = [axis for axis in rubbing & turning if point_rates[axis] < 0.0]
    if backwards or (rubbing & turning and rubbing - turning):
        raise InputError(
            f"Operating point '{text}': dry friction on {' and '.join(sorted(rubbing))} is"
            " linearised sliding forwards; give each a rate above 0, or none a rate."
        )
    given = {axis: found[name] for name, axis in angles.items() if name in found}
    for axis, angle in given.items():
        for lower, upper, end in _bounds(equations, axis):
            if not lower < angle < upper:
                raise InputError(
                    f"Operating point '{text}': an angle of {angle:.4g} rad is beyond the {end};"
                    f" give one within [{lower:.4g}, {upper:.4g}] rad."
                )
    return OperatingPoint(given, point_rates, bool(rubbing & turning))


def _number(part: str, value: str, unit: str) -> float:
    """The number of `value` in `unit`, whatever unit it has."""
    form = re.fullmatch(r"([-+]?[\d.]+(?:[eE][-+]?\d+)?)\s*(.*)", value)
    if form is None or form[1].strip("+-.") == "":
        raise InputError(f"Operating point '{part}': give NAME=VALUE, a number in {unit}.")
    factor = 1.0
    if form[2]:
        if not compatible(form[2], unit):
            raise InputError(f"Operating point '{part}': unit '{form[2]}'; give it in {unit}.")
        factor = to_si(form[2])[0]
    return float(form[1]) * factor
