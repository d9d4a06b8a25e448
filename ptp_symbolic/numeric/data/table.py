"""Tables of numbers with named columns, whatever file holds them.

How a CSV is written: separator, decimal mark, comments, units; made into the plain form.

The plain form has commas between columns, points in numbers, and the header in its first line.

LabVIEW measurement files (.lvm): text with headers that end in lines of their own.

Source: National Instruments, Specification for the LabVIEW Measurement File (.lvm).
"""

import csv
import io
import re
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.files.content import MOST_COLUMNS
from ptp_symbolic.platform import Clock
from ptp_symbolic.platform.fields import shown
from ptp_symbolic.platform.units import to_si

CLOCKS = ("time", "t", "tout", "x_value")  # names of the column of times, in any case
_COMMENT = "%#/ "  # what may mark a header as a comment, and is no part of a name
_HEADING = re.compile(r"([^\[\]]*?)\s*(?:\[([^\[\]]*)\])?")
_ROUND = re.compile(r"(.*\S)\s*\(([^()]*)\)")


@dataclass(frozen=True)
class Table(ABC):
    """The columns of a file: headings as (name, unit or None)."""

    path: Path
    headings: tuple[tuple[str, str | None], ...]

    note = ""  # what else the file holds, and cannot be read

    @property
    def head(self) -> str:
        """Where the headings stand, for messages."""
        return str(self.path)

    def row(self, number: int) -> str:
        """Where row `number`, counted from zero, stands, for messages."""
        return f"{self.path}: row {number + 1}"

    def place(self, column: str) -> tuple[int, str | None] | None:
        """Index and unit of a column; None where there is none of that name.

        A unit may stand in round brackets too, where they hold one.
        """
        for index, (name, unit) in enumerate(self.headings):
            if name == column:
                return index, unit
        for index, (name, _) in enumerate(self.headings):
            found = _ROUND.fullmatch(name)
            if found and found[1] == column and is_unit(found[2]):
                return index, found[2]
        return None

    def clock(self, declared: Clock) -> tuple[int, str | None] | None:
        """Index and unit of the column of times; None where there is none."""
        if declared.column is not None:
            found = self.place(declared.column) or self.place(declared.column.lstrip(_COMMENT))
        else:
            found = self._usual_clock()
        return None if found is None else (found[0], found[1] or declared.unit)

    def _usual_clock(self) -> tuple[int, str | None] | None:
        names = [name for name, _ in self.headings]
        plain = [found[1] for found in map(_ROUND.fullmatch, names) if found]
        for wanted in CLOCKS:
            for name in (*names, *plain):
                if name.lower() == wanted:
                    return self.place(name)
        return None

    @abstractmethod
    def numbers(self, columns: Sequence[int]) -> NDArray[np.float64]:
        """The given columns as [n, len(columns)], NaN where there is no value.

        Raises InputError, with the line where there is one, for cells of these columns that are no
        finite numbers, and for more than ten million rows.
        """

    def complete(self, columns: Sequence[int]) -> NDArray[np.float64]:
        """`numbers`, each of which is there. Raises InputError for one that is missing, too."""
        values = self.numbers(columns)
        self.refuse_missing(columns, np.isnan(values))
        return values

    def refuse_missing(self, columns: Sequence[int], missing: NDArray[np.bool_]) -> None:
        """Raise InputError for the first of the `missing` values [n, len(columns)]."""
        if missing.any():
            row, place = (int(k) for k in np.argwhere(missing)[0])
            raise self.lost(row, columns[place])

    def lost(self, row: int, column: int) -> InputError:
        """The refusal of a row, counted from zero, without a value in a column."""
        name = self.headings[column][0]
        return InputError(f"{self.row(row)}: '{name}' is missing; every row needs a value.")


def heading(where: str, cell: str, unit: str | None = None) -> tuple[str, str | None]:
    """Name and unit of a heading `name [unit]`; `unit` is that of a row of units, if there is one.

    Raises InputError, begun by `where`, for another form.
    """
    match = _HEADING.fullmatch(cell.strip())
    if not match:
        raise InputError(f"{where}: heading {shown(cell)} is not of the form 'name [unit]'.")
    return match[1], match[2] or unit


def checked_headings(
    where: str, headings: Sequence[tuple[str, str | None]]
) -> tuple[tuple[str, str | None], ...]:
    """`headings` as they are. Raises InputError for over 1000 columns and a name that is twice."""
    if len(headings) > MOST_COLUMNS:
        raise InputError(f"{where}: has more than {MOST_COLUMNS} columns; leave out some.")
    names = [name for name, _ in headings]
    for name in names:
        if name and names.count(name) > 1:
            raise InputError(f"{where}: column {shown(name)} is there twice; remove one.")
    return tuple(headings)


def is_unit(text: str) -> bool:
    """Whether a text is a unit that converts to SI."""
    try:
        to_si(text)
    except InputError:
        return False
    return True


LABVIEW = b"LabVIEW Measurement"
_LABVIEW_END = b"***End_of_Header***"
_LABVIEW_CHANNELS = "Channels"  # begins the header of a segment
MOST_LISTED = 6  # segments in a message
_LABVIEW_SEPARATORS = {"Tab": b"\t", "Comma": b","}
_LABVIEW_COMMENT = "Comment"


@dataclass(frozen=True)
class Measurement:
    """The channels of a measurement, their units, the separator, and the rows from `first_line`."""

    headings: tuple[str, ...]
    units: tuple[str | None, ...]
    separator: bytes
    body: bytes
    first_line: int


def measurement(path: object, content: bytes) -> Measurement:
    """Read the headers of a measurement whose text begins with `LABVIEW`.

    Times are its one column of X values, or follow from X0 and Delta_X. Raises InputError for
    several segments in a file, for an X column of every channel, and for a damaged header.
    """
    first = content.find(_LABVIEW_END)
    header, rest = content[: max(first, 0)], content[first:].partition(b"\n")[2]
    if first < 0 or rest.count(_LABVIEW_END) != 1:
        raise InputError(_which_segment(path, content.decode().split("\n")))
    channels, _, rows = rest.partition(_LABVIEW_END)
    facts = _facts(header)
    separator = _LABVIEW_SEPARATORS.get(facts.get("Separator", "Tab"), b"\t")
    if facts.get("X_Columns") == "Multi":
        raise InputError(
            f"{path}: every channel of this LabVIEW measurement has an X column of its own; save it"
            " with one X column."
        )
    below = rows.partition(b"\n")[2]
    names, _, body = below.partition(b"\n")
    headings = [cell.strip() for cell in names.decode().split(separator.decode())]
    width = body.partition(b"\n")[0].count(separator) + 1
    if len(headings) > width and headings[-1] == _LABVIEW_COMMENT:
        headings.pop()
    first_line = content.count(b"\n", 0, len(content) - len(body)) + 1
    units = ["s", *_row(channels, separator, "Y_Unit_Label")]
    units = [*units, *[None] * len(headings)][: len(headings)]
    if facts.get("X_Columns") == "No":
        body = _with_times(path, body, separator, channels)
    return Measurement(tuple(headings), tuple(units), separator, body, first_line)


def _which_segment(path: object, lines: Sequence[str]) -> str:
    """What to do about a file that has not one segment: one header of channels with its rows."""
    ends = [k for k, line in enumerate(lines) if line.startswith(_LABVIEW_END.decode())]
    begins = [k for k, line in enumerate(lines) if line.startswith(_LABVIEW_CHANNELS)]
    others = [k for k, line in enumerate(lines) if line.startswith(LABVIEW.decode())]
    found = []
    for begin in begins:
        names = next((end + 1 for end in ends if end > begin), len(lines))
        last = min((k for k in (*begins, *others) if k > begin), default=len(lines))
        rows = [k for k in range(names + 1, last) if lines[k].strip()]
        if rows:
            found.append((begin + 1, rows[-1] + 1, len(rows), lines[names].split()))
    if not found:
        return (
            f"{path}: a LabVIEW measurement has one header of its own and one of its channels, and"
            " this file 0 of channels; save one measurement into each file."
        )
    listed = [f"lines {a} to {b} ({n} rows of {', '.join(names)})" for a, b, n, names in found]
    a, b, _, _ = max(found, key=lambda segment: segment[2])
    more = f" and {len(listed) - MOST_LISTED} more" if len(listed) > MOST_LISTED else ""
    return (
        f"{path}: this LabVIEW measurement has {len(listed)} segments:"
        f" {'; '.join(listed[:MOST_LISTED])}{more}. Keep lines 1 to {found[0][0] - 1} and those of"
        f" one segment, {a} to {b} for the longest, or save one measurement into each file."
    )


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


LONGEST_LINE = 100_000
COMMENTS = (b"#", b"%", b"//")
SEPARATORS = (b";", b"\t", b"|", b",")  # tried in this order: commas may be decimal marks
CALLED = {b";": "semicolons", b"\t": "tabs", b"|": "bars", b",": "commas"}
SPACES = b" "  # one or more
_NAMED = re.compile(rb"\"?sep=([;,|\t])\"?[;,|\t]*\n")  # the first line that Excel understands
_SPACED = re.compile(r"\S+(?: *\[[^\[\]]*\])?")  # a name, and its unit
_BESIDE = re.compile(rb"^[ \t]+|[ \t]+$", re.MULTILINE)
_BETWEEN = re.compile(rb"[ \t]+")
_NUMBER = re.compile(rb"\s*[+-]?(?:[0-9]+[.,]?[0-9]*|[.,][0-9]+)(?:[eE][+-]?[0-9]+)?\s*")


@dataclass(frozen=True)
class PlainText:
    """The header as cells, units of the columns that a row of their own gives (else empty), the
    rows as plain CSV, and the lines of the file with the header and with the first row.
    """

    headings: tuple[str, ...]
    units: tuple[str | None, ...]
    body: bytes
    first_line: int
    head_line: int


def plain_text(path: object, content: bytes) -> PlainText:
    """Return the text of a CSV in the plain form.

    The separator is that which a first line such as `sep=;` names, else a semicolon, a tab, a
    bar or a comma, whichever is in the header and the first row, else spaces. Lines above that
    begin with ``#``, ``%`` or ``//`` are comments; the last of them is the header where no other
    line names the columns. A row of units may follow the header. Raises InputError for a file
    without one.
    """
    if content.startswith(LABVIEW):
        found = measurement(path, content)
        body = _with_commas(found.body, found.separator)
        return PlainText(found.headings, found.units, body, found.first_line, found.first_line - 1)
    named = _NAMED.match(content)
    position, line = (named.end(), 2) if named else (0, 1)
    comment, commented, position, line = _comments(content, position, line)
    rest = content[position:]
    first, _, after = rest.partition(b"\n")
    if len(first) > LONGEST_LINE:
        raise InputError(
            f"{path}:{line}: line has more than {LONGEST_LINE} characters; is this a CSV?"
        )
    row = after.partition(b"\n")[0]
    separator = named[1] if named else _separator(first, row)
    if separator != SPACES and row.strip() and separator in first and separator not in row:
        called = CALLED[separator]
        raise InputError(
            f"{path}:{line}: the header has {called} between columns and the row below has not;"
            " write both alike."
        )
    names = _cells(comment, separator)
    if _is_row(first, separator, len(names)):
        if not comment or len(_cells(first, separator)) != len(names):
            raise InputError(
                f"{path}:{line}: begins with numbers; give a header row such as 'time [s],...'"
                " above them."
            )
        head, body, head_line = comment, rest, commented
    else:
        head, body, head_line, line = first, after, line, line + 1
    headings = _cells(head, separator)
    units: tuple[str | None, ...] = (None,) * len(headings)
    row, _, below = body.partition(b"\n")
    if _is_units(row, separator, len(headings)):
        units = tuple(_unit_cell(cell) for cell in _cells(row, separator))
        body, line = below, line + 1
    return PlainText(headings, units, _with_commas(body, separator), line, head_line)


def _comments(content: bytes, position: int, line: int) -> tuple[bytes, int, int, int]:
    """The last comment above the rows and its line, and place and line of what follows."""
    comment, commented = b"", 1
    while position < len(content):
        end = content.find(b"\n", position)
        end = len(content) if end < 0 else end
        text = content[position:end].strip()
        mark = next((m for m in COMMENTS if text.startswith(m)), None)
        if text and mark is None:
            break
        if mark is not None:
            comment, commented = text[len(mark) :].strip(), line
        position, line = end + 1, line + 1
    return comment, commented, position, line


def _separator(head: bytes, row: bytes) -> bytes:
    """The first of SEPARATORS that is as often in the header as in the first row, and at all; of
    rows that have none of them, spaces.
    """
    for mark in SEPARATORS:
        if head.count(mark) and (head.count(mark) == row.count(mark) or mark == b","):
            return mark
    found = max(SEPARATORS, key=head.count)
    is_spaced = found not in head and b" " in head.strip()
    return SPACES if is_spaced else found


def _cells(row: bytes, separator: bytes) -> tuple[str, ...]:
    text = row.decode()
    if separator == SPACES:
        return tuple(_SPACED.findall(text))
    if '"' in text:
        return next((tuple(r) for r in csv.reader([text], delimiter=separator.decode())), ())
    return tuple(text.split(separator.decode()))


def _is_row(row: bytes, separator: bytes, width: int) -> bool:
    """Whether a line is a row of numbers, no header; of text too, below a comment with a name for
    each of its cells.
    """
    cells = row.split() if separator == SPACES else row.split(separator)
    are_numbers = [bool(_NUMBER.fullmatch(cell)) for cell in cells]
    if not row.strip():
        return False
    return all(are_numbers) or (len(cells) == width > 1 and any(are_numbers))


def _is_units(row: bytes, separator: bytes, width: int) -> bool:
    """Whether a row names a unit in some cells, and holds no number in any."""
    if not row.strip():
        return False
    units = [_unit_cell(cell) for cell in _cells(row, separator)]
    if len(units) != width or not any(units) or all(unit == "1" for unit in units if unit):
        return False
    return all(unit is None or is_unit(unit) for unit in units)


def _unit_cell(cell: str) -> str | None:
    unit = cell.strip().strip("[]()")
    return None if unit in ("", "-") else unit


def _with_commas(body: bytes, separator: bytes) -> bytes:
    """Rows with commas between columns and points in numbers."""
    if separator == b",":
        return body
    if separator == SPACES:
        body = _BESIDE.sub(b"", body.replace(b",", b"."))
        return _BETWEEN.sub(b",", body)
    if b'"' in body:
        rows = csv.reader(io.StringIO(body.decode()), delimiter=separator.decode())
        cells = ([cell.replace(",", ".") for cell in row] for row in rows)
        return "\n".join(",".join(row) for row in cells).encode()
    return body.replace(b",", b".").replace(separator, b",")
