"""LabVIEW measurement files (.lvm): text with headers that end in lines of their own.

Source: National Instruments, Specification for the LabVIEW Measurement File (.lvm).
"""

from collections.abc import Mapping
from dataclasses import dataclass

from ptp_symbolic.errors import InputError

BEGIN = b"LabVIEW Measurement"
_END = b"***End_of_Header***"
_SEPARATORS = {"Tab": b"\t", "Comma": b","}
_COMMENT = "Comment"


@dataclass(frozen=True)
class Measurement:
    """The channels of a measurement, their units, the separator, and the rows from `first_line`."""

    headings: tuple[str, ...]
    units: tuple[str | None, ...]
    separator: bytes
    body: bytes
    first_line: int


def measurement(path: object, content: bytes) -> Measurement:
    """Read the headers of a measurement whose text begins with `BEGIN`.

    Times are its one column of X values, or follow from X0 and Delta_X. Raises InputError for
    several measurements in a file, for an X column of every channel, and for a damaged header.
    """
    first = content.find(_END)
    header, rest = content[: max(first, 0)], content[first:].partition(b"\n")[2]
    if first < 0 or rest.count(_END) != 1:
        raise InputError(
            f"{path}: a LabVIEW measurement has one header of its own and one of its channels, and"
            f" this file {rest.count(_END) if first >= 0 else 0} of channels; save one measurement"
            " into each file."
        )
    channels, _, rows = rest.partition(_END)
    facts = _facts(header)
    separator = _SEPARATORS.get(facts.get("Separator", "Tab"), b"\t")
    if facts.get("X_Columns") == "Multi":
        raise InputError(
            f"{path}: every channel of this LabVIEW measurement has an X column of its own; save it"
            " with one X column."
        )
    below = rows.partition(b"\n")[2]
    names, _, body = below.partition(b"\n")
    headings = [cell.strip() for cell in names.decode().split(separator.decode())]
    width = body.partition(b"\n")[0].count(separator) + 1
    if len(headings) > width and headings[-1] == _COMMENT:
        headings.pop()
    first_line = content.count(b"\n", 0, len(content) - len(body)) + 1
    units = ["s", *_row(channels, separator, "Y_Unit_Label")]
    units = [*units, *[None] * len(headings)][: len(headings)]
    if facts.get("X_Columns") == "No":
        body = _with_times(path, body, separator, channels)
    return Measurement(tuple(headings), tuple(units), separator, body, first_line)


def _facts(header: bytes) -> Mapping[str, str]:
    rows = (line.split("\t" if "\t" in line else ",") for line in header.decode().split("\n"))
    return {row[0].strip(): row[1].strip() for row in rows if len(row) > 1}


def _row(channels: bytes, separator: bytes, name: str) -> list[str | None]:
    """The cells of a fact of every channel."""
    for line in channels.decode().split("\n"):
        cells = line.split(separator.decode())
        if cells[0].strip() == name:
            return [cell.strip() or None for cell in cells[1:]]
    return []


def _with_times(path: object, body: bytes, separator: bytes, channels: bytes) -> bytes:
    """The rows with the times in their first cell, which is empty."""
    starts, steps = (_row(channels, separator, name) for name in ("X0", "Delta_X"))
    try:
        start, step = (float((of[0] or "").replace(",", ".")) for of in (starts, steps))
    except (IndexError, ValueError) as error:
        raise InputError(
            f"{path}: this LabVIEW measurement has no X column, and no X0 and Delta_X; save it with"
            " one X column."
        ) from error
    rows = body.rstrip(b"\n").split(b"\n")
    if not all(row.startswith(separator) for row in rows):
        rows = [separator + row for row in rows]
    return b"\n".join(b"%.9f" % (start + k * step) + row for k, row in enumerate(rows)) + b"\n"
