"""How a CSV is written: separator, decimal mark, comments, units; made into the plain form.

The plain form has commas between columns, points in numbers, and the header in its first line.
"""

import csv
import io
import re
from dataclasses import dataclass

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.data.table import is_unit

LONGEST_LINE = 100_000
COMMENTS = (b"#", b"%", b"//")
SEPARATORS = (b";", b"\t", b",")  # tried in this order: commas may be decimal marks
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

    The separator is a semicolon, a tab or a comma, whichever is in the header and the first row.
    Lines above that begin with ``#``, ``%`` or ``//`` are comments; the last of them is the header
    where no other line names the columns. A row of units may follow the header. Raises InputError
    for a file without a header.
    """
    comment, commented, position, line = b"", 1, 0, 1
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
    rest = content[position:]
    first, _, after = rest.partition(b"\n")
    if len(first) > LONGEST_LINE:
        raise InputError(
            f"{path}:{line}: line has more than {LONGEST_LINE} characters; is this a CSV?"
        )
    row = after.partition(b"\n")[0]
    separator = _separator(first, row)
    if row.strip() and separator in first and separator not in row:
        called = {b";": "semicolons", b"\t": "tabs", b",": "commas"}[separator]
        raise InputError(
            f"{path}:{line}: the header has {called} between columns and the row below has not;"
            " write both alike."
        )
    if _is_numbers(first, separator):
        if first.count(separator) != comment.count(separator):
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


def _separator(head: bytes, row: bytes) -> bytes:
    """The first of SEPARATORS that is as often in the header as in the first row, and at all."""
    for mark in SEPARATORS:
        if head.count(mark) and (head.count(mark) == row.count(mark) or mark == b","):
            return mark
    return max(SEPARATORS, key=head.count)


def _cells(row: bytes, separator: bytes) -> tuple[str, ...]:
    text = row.decode()
    if '"' in text:
        return tuple(next(csv.reader([text], delimiter=separator.decode())))
    return tuple(text.split(separator.decode()))


def _is_numbers(row: bytes, separator: bytes) -> bool:
    cells = row.split(separator)
    return bool(row.strip()) and all(_NUMBER.fullmatch(cell) for cell in cells)


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
    if b'"' in body:
        rows = csv.reader(io.StringIO(body.decode()), delimiter=separator.decode())
        cells = ([cell.replace(",", ".") for cell in row] for row in rows)
        return "\n".join(",".join(row) for row in cells).encode()
    return body.replace(b",", b".").replace(separator, b",")
