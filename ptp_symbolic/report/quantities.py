"""How numbers, units, intervals and angles are written in a report."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

NOTHING = "–"
TOGETHER = "\u00a0"  # between a number and its sign, where no line breaks
_RAISED = str.maketrans("0123456789-", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻")


def number(value: Any, digits: int = 3) -> str:
    """A number with `digits` significant digits; a dash for NaN, infinity and what is none."""
    if not _usable(value):
        return NOTHING
    if value == 0.0:
        return "0"
    mantissa, _, power = f"{value:.{digits - 1}e}".partition("e")
    exponent = int(power)
    if -4 <= exponent < 6:
        text = f"{value:.{max(0, digits - 1 - exponent)}f}"
    else:
        text = f"{mantissa} × 10{str(exponent).translate(_RAISED)}"
    return text.replace("-", "−")


@dataclass(frozen=True)
class JointWords:
    """What the coordinate of a joint, its rate and what acts on it are called, and the unit of the
    coordinate.
    """

    angle: str
    rate: str
    torque: str
    unit: str


ROTARY = JointWords("angle", "rate", "torque", "rad")
LINEAR = JointWords("position", "speed", "force", "m")


def joint_words(curve: Mapping[str, Any], axis: str) -> JointWords:
    """The words of the joint of `axis`, which is rotary unless the `curve` says m."""
    return LINEAR if (curve.get("angle_unit") or {}).get(axis) == "m" else ROTARY


def unit(text: str | None) -> str:
    """A unit as people write it: `N m/rad^3` becomes `N m/rad³`; empty for none."""
    if text is None or text in ("", "1"):
        return ""
    base, *powers = text.split("^")
    return base + "".join(p[:1].translate(_RAISED) + p[1:] for p in powers)


def _usable(value: Any) -> bool:
    return isinstance(value, int | float) and math.isfinite(value)


def _digits(quantity: Mapping[str, Any]) -> int:
    """As many digits as the interval deserves: two of its half width."""
    value, bounds = quantity.get("value"), quantity.get("ci95") or ()
    if not _usable(value) or not value or not bounds or not all(map(_usable, bounds)):
        return 4
    half_width = abs(bounds[1] - bounds[0]) / 2.0
    if not half_width:
        return 4
    more = math.floor(math.log10(abs(value))) - math.floor(math.log10(half_width))
    return min(max(more + 2, 2), 7)


def estimate(quantity: Mapping[str, Any] | None) -> str:
    """The value of {value, ci95, unit}, with no more digits than its interval supports."""
    if not quantity:
        return NOTHING
    return number(quantity.get("value"), _digits(quantity))


def interval(quantity: Mapping[str, Any] | None) -> str:
    """The 95 % interval of {value, ci95, unit} as `low to high`; a dash when there is none."""
    bounds = (quantity or {}).get("ci95") or ()
    if not quantity or not bounds or not all(map(_usable, bounds)):
        return NOTHING
    # the last decimal of the value, whatever the size of the bound
    size, digits = _exponent(quantity.get("value")), _digits(quantity)
    texts = [number(b, max(digits + _exponent(b) - size, 2) if b else digits) for b in bounds]
    return f"{texts[0]} to {texts[1]}"


def gain(earned: Mapping[str, Any] | None) -> str:
    """A gain {share, ci95} in percent with its 95 % interval; a dash when there is none."""
    if not earned or not _usable(earned.get("share")):
        return NOTHING
    bounds = earned.get("ci95") or ()
    known = bounds and all(map(_usable, bounds))
    within = f" ({' to '.join(map(_percent, bounds))}{TOGETHER}%)" if known else ""
    return f"{_percent(earned['share'])}{TOGETHER}%{within}"


def _percent(share: float) -> str:
    """Tenths of a percent; of a share far outside -1 to 1 three digits."""
    percent = 100.0 * share
    if abs(percent) >= 1000.0:
        return number(percent)
    return f"{round(percent, 1) + 0.0:.1f}".replace("-", "−")  # no sign of what rounds to zero


def _exponent(value: Any) -> int:
    return math.floor(math.log10(abs(value))) if _usable(value) and value else 0


def travel(error: Mapping[str, Any]) -> str:
    """The rms of angles in degrees, of positions in m; a dash where there is none."""
    rms = error.get("rmse")
    if rms is None or not _usable(rms):
        return NOTHING
    return f"{number(rms)} m" if error.get("unit") == "m" else f"{number(math.degrees(rms))}°"


def in_degrees(quantity: Mapping[str, Any] | None) -> str:
    """The value in degrees when its unit is rad, else nothing."""
    if not quantity or quantity.get("unit") != "rad" or not _usable(quantity.get("value")):
        return ""
    return f"{number(math.degrees(quantity['value']), _digits(quantity))}°"
