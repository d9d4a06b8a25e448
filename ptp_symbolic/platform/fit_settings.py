"""What a platform file says about the fit: the length of the windows that runs are cut into."""

from ptp_symbolic.errors import InputError
from ptp_symbolic.platform import fields
from ptp_symbolic.platform.units import to_si


def window_of(given: object, where: str) -> float | None:
    """Return the length in s of the windows of a `[fit]` table; None where it says nothing.

    Raises InputError for other keys and for what is no time above zero, such as "0.5 s".
    """
    entry = fields.table(given, where, ("window",))
    return duration(entry["window"], f"{where}.window") if "window" in entry else None


def duration(given: object, where: str) -> float:
    """Return a time such as "0.5 s" or "20 ms" in s.

    Raises InputError where it is not a number above zero with a unit of time.
    """
    wrong = InputError(
        f'{where}: {fields.shown(given)} is not a time above zero; write "0.5 s" or "500 ms".'
    )
    number, _, unit = given.strip().partition(" ") if isinstance(given, str) else ("", "", "")
    try:
        factor, si = to_si(unit.strip())
        value = float(number) * factor
    except (InputError, ValueError) as error:
        raise wrong from error
    if si != "s" or not 0.0 < value < float("inf"):
        raise wrong
    return value
