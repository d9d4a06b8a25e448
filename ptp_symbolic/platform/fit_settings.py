"""What a platform file says about the fit: the length of the windows that runs are cut into."""

from ptp_symbolic.platform import fields


def window_of(given: object, where: str) -> float | None:
    """Return the length in s of the windows of a `[fit]` table; None where it says nothing.

    Raises InputError for other keys and for what is no time above zero, such as "0.5 s".
    """
    entry = fields.table(given, where, ("window",))
    return fields.time(entry["window"], f"{where}.window", 0.0) if "window" in entry else None
