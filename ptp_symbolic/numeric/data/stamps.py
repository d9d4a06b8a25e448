"""Times written as dates with times of day, as times of day alone, or as durations."""

import re
from datetime import UTC, datetime

from ptp_symbolic.errors import InputError
from ptp_symbolic.platform.units import to_si

FORMS = "0.005 sec, 00:00:00.005, 2026-11-26T12:00:00.005Z or 11/26/2026 12:00:00.005 PM"
_ISO = re.compile(
    r"[0-9]{4}-[0-9]{2}-[0-9]{2}[T ][0-9]{2}:[0-9]{2}:[0-9]{2}(?:[.,][0-9]{1,9})?"
    r"(?:Z|[+-][0-9]{2}:?[0-9]{2})?"
)
_CLOCK = r"(?P<clock>[0-9:.,]+)(?: ?(?P<half>[AaPp][Mm]))?"
_DATED = re.compile(
    r"(?:(?P<american>[0-9]{1,2}/[0-9]{1,2}/[0-9]{4})|(?P<day>[0-9]{1,2}-[A-Za-z]{3}-[0-9]{4})"
    r"|(?P<year>[0-9]{4}[-/][0-9]{2}[-/][0-9]{2}))[ T]" + _CLOCK
)
_OF_DAY = re.compile(_CLOCK)
_PARTS = re.compile(
    r"(?:(?P<d>[0-9]{1,4}):(?=[0-9]+:[0-9]+:))?(?:(?P<h>[0-9]{1,5}):(?=[0-9]{2}:))?"
    r"(?P<m>[0-9]{1,2}):(?P<s>[0-9]{2}(?:[.,][0-9]{1,9})?)"
)
_DURATION = re.compile(r"([+-]?[0-9]*\.?[0-9]+(?:[eE][+-]?[0-9]+)?) ([a-z]+)")
_UNITS = {"sec": "s", "secs": "s", "hr": "h", "hrs": "h", "days": "day"}  # as MATLAB writes them
_BEGIN = datetime(2020, 1, 1, tzinfo=UTC)  # near, so that a double holds microseconds


def seconds_of(cell: str) -> float | None:
    """Seconds of a time, to the microsecond; None for what is no time.

    A date with a time of day (ISO 8601, or as spreadsheets and MATLAB write it, months before days)
    counts from the beginning of 2020, in universal time where it names no zone; a time of day, in
    24 hours or 12, counts from midnight; a duration is such as `0.005 sec` or `00:00:00.005`.
    """
    text = cell.strip().strip('"')
    if not text[:1].isdigit() and text[:1] not in ("+", "-", "."):
        return None
    if _ISO.fullmatch(text):
        return _since(text.replace(",", "."), "%Y-%m-%dT")
    if dated := _DATED.fullmatch(text):
        of_day = _of_day(dated["clock"], dated["half"])
        form = "%m/%d/%Y" if dated["american"] else "%d-%b-%Y" if dated["day"] else "%Y-%m-%d"
        date = dated["american"] or dated["day"] or dated["year"].replace("/", "-")
        begin = _since(date, form)
        return None if begin is None or of_day is None else begin + of_day
    if clock := _OF_DAY.fullmatch(text):
        return _of_day(clock["clock"], clock["half"])
    duration = _DURATION.fullmatch(text)
    return None if duration is None else _duration(duration[1], duration[2])


def _since(date: str, form: str) -> float | None:
    try:
        is_iso = form.endswith("T")
        stamp = datetime.fromisoformat(date) if is_iso else datetime.strptime(date, form)
    except ValueError:  # the 13th month
        return None
    stamp = stamp if stamp.tzinfo else stamp.replace(tzinfo=UTC)
    return (stamp - _BEGIN).total_seconds()


def _of_day(clock: str, half: str | None) -> float | None:
    """Seconds of days, hours, minutes and seconds, or of minutes and seconds with decimals."""
    parts = _PARTS.fullmatch(clock)
    if parts is None or (parts["h"] is None and not re.search("[.,]", parts["s"])):
        return None
    hours = int(parts["h"] or 0)
    seconds = float(parts["s"].replace(",", "."))
    if int(parts["m"]) > 59 or seconds >= 60.0 or (half and not 1 <= hours <= 12):
        return None
    if half:
        hours = hours % 12 + (12 if half.lower() == "pm" else 0)
    return 86400.0 * int(parts["d"] or 0) + 3600.0 * hours + 60.0 * int(parts["m"]) + seconds


def _duration(number: str, unit: str) -> float | None:
    try:
        factor, si = to_si(_UNITS.get(unit, unit))
    except InputError:
        return None
    return factor * float(number) if si == "s" else None
