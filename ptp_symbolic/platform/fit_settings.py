"""What a platform file says of its logs beside their signals: the clock, and windows of a fit."""

from ptp_symbolic.errors import InputError
from ptp_symbolic.platform import fields
from ptp_symbolic.platform.declaration import Clock
from ptp_symbolic.platform.units import compatible


def window_of(given: object, where: str) -> float | None:
    """Return the length in s of the windows of a `[fit]` table; None where it says nothing.

    Raises InputError for other keys and for what is no time above zero, such as "0.5 s".
    """
    entry = fields.table(given, where, ("window",))
    return fields.time(entry["window"], f"{where}.window", 0.0) if "window" in entry else None


def clock_of(given: object, where: str) -> Clock:
    """Return what a `[log]` table says of the times: `time`, their column, and `time_unit`.

    Raises InputError for other keys and for a unit that is none of time.
    """
    entry = fields.table(given, where, ("time", "time_unit"))
    column = fields.text(entry["time"], f"{where}.time") if "time" in entry else None
    if "time_unit" not in entry:
        return Clock(column)
    unit = fields.text(entry["time_unit"], f"{where}.time_unit")
    try:
        fits = compatible(unit, "s")
    except InputError as error:
        raise InputError(f"{where}.time_unit: {error}") from error
    if not fits:
        raise InputError(f'{where}.time_unit: {unit} is no unit of time; write "s" or "ms".')
    return Clock(column, unit)
