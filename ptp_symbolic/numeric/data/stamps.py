"""Times written as dates with times of day, such as 2026-11-26T12:00:00.005Z (ISO 8601)."""

import re
from datetime import UTC, datetime

_STAMP = re.compile(
    r"[0-9]{4}-[0-9]{2}-[0-9]{2}[T ][0-9]{2}:[0-9]{2}:[0-9]{2}(?:[.,][0-9]{1,9})?"
    r"(?:Z|[+-][0-9]{2}:?[0-9]{2})?"
)
_BEGIN = datetime(2020, 1, 1, tzinfo=UTC)  # near, so that a double holds microseconds


def seconds_of(cell: str) -> float | None:
    """Seconds from the beginning of 2020 to a stamp, to the microsecond, in universal time where it
    names no zone; None for what is no stamp.
    """
    text = cell.strip().strip('"')
    if not _STAMP.fullmatch(text):
        return None
    try:
        stamp = datetime.fromisoformat(text.replace(",", "."))
    except ValueError:  # the 13th month
        return None
    stamp = stamp if stamp.tzinfo else stamp.replace(tzinfo=UTC)
    return (stamp - _BEGIN).total_seconds()
