"""A number with a unit in a platform TOML, in SI."""

import math
from typing import Any

from ptp_symbolic.errors import InputError
from ptp_symbolic.platform import fields
from ptp_symbolic.platform.units import to_si


def unit_of(entry: dict[str, Any], where: str) -> tuple[float, str]:
    """Return (factor, SI unit) of the `unit` of a table.

    Raises InputError where it is not a unit.
    """
    text = fields.text(entry["unit"], f"{where}.unit")
    try:
        return to_si(text)
    except InputError as error:
        raise InputError(f"{where}.unit: {error}") from error


def scaled(value: object, factor: float, where: str) -> float:
    """Return `factor` times `value`, a number in SI.

    Raises InputError where it is not a finite number.
    """
    result = fields.number(value, where) * factor
    if not math.isfinite(result):
        raise InputError(f"{where}: {fields.shown(value)} is too large in SI units.")
    return result
