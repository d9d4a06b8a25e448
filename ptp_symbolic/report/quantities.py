"""How numbers, units, intervals and angles are written in a report."""

import math
from collections.abc import Mapping
from typing import Any

NOTHING = "–"
_RAISED = str.maketrans("0123456789-", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻")


def number(value: float | None, digits: int = 3) -> str:
    """A number with `digits` significant digits; a dash for None, NaN and infinity."""
    if value is None or not math.isfinite(value):
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


def unit(text: str | None) -> str:
    """A unit as people write it: `N m/rad^3` becomes `N m/rad³`; empty for none."""
    if text is None or text in ("", "1"):
        return ""
    base, *powers = text.split("^")
    return base + "".join(p[:1].translate(_RAISED) + p[1:] for p in powers)


def _digits(quantity: Mapping[str, Any]) -> int:
    """As many digits as the interval deserves: two of its half width."""
    value, bounds = quantity.get("value"), quantity.get("ci95")
    if not value or not bounds or not all(_usable(b) for b in bounds) or bounds[0] == bounds[1]:
        return 4
    half_width = abs(bounds[1] - bounds[0]) / 2.0
    more = math.floor(math.log10(abs(value))) - math.floor(math.log10(half_width))
    return min(max(more + 2, 2), 7)


def _usable(value: float | None) -> bool:
    return value is not None and math.isfinite(value)


def estimate(quantity: Mapping[str, Any] | None) -> str:
    """The value of {value, ci95, unit}, with no more digits than its interval supports."""
    if not quantity:
        return NOTHING
    return number(quantity.get("value"), _digits(quantity))


def interval(quantity: Mapping[str, Any] | None) -> str:
    """The 95 % interval of {value, ci95, unit} as `low to high`; a dash when there is none."""
    bounds = (quantity or {}).get("ci95")
    if not quantity or not bounds or not all(_usable(bound) for bound in bounds):
        return NOTHING
    value = abs(quantity.get("value") or 0.0)
    digits = _digits(quantity)
    texts = []
    for bound in bounds:
        # the same number of decimals as the value, whatever the size of the bound
        larger = math.log10(abs(bound) / value) if bound and value else 0.0
        texts.append(number(bound, min(max(digits + math.floor(larger + 1e-9), 2), 8)))
    return f"{texts[0]} to {texts[1]}"


def in_degrees(quantity: Mapping[str, Any] | None) -> str:
    """The value in degrees when its unit is rad, else nothing."""
    if not quantity or quantity.get("unit") != "rad" or not _usable(quantity.get("value")):
        return ""
    return f"{number(math.degrees(quantity['value']), _digits(quantity))}°"
