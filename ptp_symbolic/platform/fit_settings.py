"""What a platform file says of its logs beside their signals: the clock, and windows of a fit."""

from ptp_symbolic.errors import InputError
from ptp_symbolic.platform import fields
from ptp_symbolic.platform.declaration import Clock
from ptp_symbolic.platform.units import compatible


def fit_settings(given: object, where: str) -> tuple[float | None, float | None]:
    """Return what a `[fit]` table says: the length in s of its windows, and the share of the error
    that an effect has to take away for a name; None where it says nothing.

    Raises InputError for other keys, for what is no time above zero, such as "0.5 s", and for what
    is no share.
    """
    entry = fields.table(given, where, ("window", "material"))
    window = fields.time(entry["window"], f"{where}.window", 0.0) if "window" in entry else None
    if "material" not in entry:
        return window, None
    share = fields.number(entry["material"], f"{where}.material")
    if not 0.0 < share < 1.0:
        raise InputError(
            f"{where}.material: {share:g} is no share of the error; give a number between 0 and 1,"
            " such as 0.05 for 5 %."
        )
    return window, share


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
