"""Read a CSV of numbers with a header row `name [unit]`, or refuse it with file and line."""

import csv
import io
import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.errors import InputError
from ptp_symbolic.platform.fields import shown
from ptp_symbolic.platform.text_file import read_text_bytes

_MAX_BYTES = 200_000_000
_MAX_ROWS = 10_000_000
_MAX_COLUMNS = 1000
_MAX_LINE = 100_000
_CHUNK = 1 << 22
NEW_LINE = b"\n"
_PLAIN = b"0123456789+-.eE, \t\n"
_HEADING = re.compile(r"([^\[\]]*?)\s*(?:\[([^\[\]]*)\])?")
_NUMBER = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")


@dataclass(frozen=True)
class Table:
    """The text of a CSV: headings as (name, unit or None), and the rows, not parsed yet."""

    path: Path
    headings: tuple[tuple[str, str | None], ...]
    body: bytes


def read_table(path: Path) -> Table:
    """Read a CSV and its header row.

    Raises InputError for a file that is missing, larger than 200 MB, empty or not text, and for a
    header with a column twice, over 1000 columns, another separator or a malformed heading.
    """
    content = read_text_bytes(path, _MAX_BYTES, "a CSV log")
    head, _, body = content.partition(b"\n")
    if not content.strip():
        raise InputError(f"{path}: is empty; give a CSV with a header row such as 'time [s],...'.")
    for mark, called in ((b";", "semicolons"), (b"\t", "tabs")):
        if head.count(mark) > head.count(b","):
            raise InputError(
                f"{path}:1: the columns are separated by {called}; save the file with commas"
                " between columns and a point in decimal numbers."
            )
    headings = tuple(_heading(path, cell) for cell in _cells(head.decode(), f"{path}:1"))
    if len(headings) > _MAX_COLUMNS:
        raise InputError(f"{path}:1: has more than {_MAX_COLUMNS} columns; leave out some.")
    names = [name for name, _ in headings]
    for name in names:
        if name and names.count(name) > 1:
            raise InputError(f"{path}:1: column {shown(name)} is there twice; remove one.")
    return Table(path, headings, body)


def read_numbers(table: Table, columns: Sequence[int]) -> NDArray[np.float64]:
    """Parse the rows of `table`; return the given columns as [n, len(columns)].

    Raises InputError with the line for a row with too few or too many cells and for a cell of these
    columns that is empty or not a finite decimal number, and for more than ten million rows or a
    truncated last number. Other columns may hold anything.
    """
    body = table.body.rstrip(b"\n \t")
    cut_off = body if len(body) == len(table.body) else b""
    if body.count(b"\n") >= _MAX_ROWS:
        raise InputError(f"{table.path}: has more than {_MAX_ROWS} rows; split the log.")
    blocks = []
    start, line = 0, 2
    while start < len(body):
        end = body.find(b"\n", start + _CHUNK)
        chunk = body[start : len(body) if end < 0 else end]
        block = _parse_plain(chunk, len(table.headings), columns)
        if block is None:
            block = _parse_rows(table, chunk, columns, line)
        blocks.append(block)
        start += len(chunk) + 1
        line += len(block)
    _refuse_cut_number(table, cut_off)
    return np.concatenate(blocks) if blocks else np.empty((0, len(columns)))


def _heading(path: Path, cell: str) -> tuple[str, str | None]:
    match = _HEADING.fullmatch(cell.strip())
    if not match:
        raise InputError(f"{path}:1: heading {shown(cell)} is not of the form 'name [unit]'.")
    return match[1], match[2]


def _cells(line: str, where: str) -> list[str]:
    if len(line) > _MAX_LINE:
        raise InputError(f"{where}: line has more than {_MAX_LINE} characters; is this a CSV?")
    try:
        return next(csv.reader([line])) if '"' in line else line.split(",")
    except csv.Error as error:
        raise InputError(f"{where}: is not a row of a CSV ({error}).") from error


def _parse_plain(chunk: bytes, width: int, columns: Sequence[int]) -> NDArray[np.float64] | None:
    """Parse rows that hold decimal numbers only; None if anything at all is odd."""
    # numpy would take nan, and skip empty lines.
    if chunk.translate(None, _PLAIN) or b"\n\n" in chunk or chunk.startswith(b"\n"):
        return None
    rows = chunk.count(b"\n") + 1
    if chunk.count(b",") != rows * (width - 1):
        return None
    try:
        block = np.loadtxt(io.BytesIO(chunk), delimiter=",", comments=None, ndmin=2)
    except ValueError:
        return None
    if block.shape != (rows, width):
        return None
    block = block[:, columns]
    return block if np.isfinite(block).all() else None


def _parse_rows(
    table: Table, chunk: bytes, columns: Sequence[int], first_line: int
) -> NDArray[np.float64]:
    """Parse row by row, to find the line of an error or to step over columns that are text."""
    width = len(table.headings)
    rows = []
    for line, row in enumerate(chunk.decode().split("\n"), start=first_line):
        where = f"{table.path}:{line}"
        cells = _cells(row, where)
        if len(cells) != width:
            raise InputError(
                f"{where}: has {len(cells)} cells where the header has {width}; the row is "
                "truncated or a comma is wrong."
            )
        rows.append([_number(cells[k], table.headings[k][0], where) for k in columns])
    return np.array(rows, dtype=np.float64).reshape(len(rows), len(columns))


def _number(cell: str, name: str, where: str) -> float:
    cell = cell.strip()
    if not cell:
        raise InputError(f"{where}: '{name}' is missing; every row needs a value.")
    if not _NUMBER.fullmatch(cell) or not math.isfinite(float(cell)):
        raise InputError(
            f"{where}: '{name}' is {shown(cell)}, not a finite decimal number; correct it or remove"
            " the row (time stamps may have gaps, an input holds across them)."
        )
    return float(cell)


def _refuse_cut_number(table: Table, body: bytes) -> None:
    """Refuse a file without a last line end whose last number is shorter than all before it.

    A file cut inside its last number has the right number of cells and a wrong value. With a fixed
    number of decimals, as loggers write, the cut shows.
    """
    last = _decimals(body[body.rfind(b"\n") + 1 :])
    usual = _decimals(body.partition(b"\n")[0])
    if usual > last and all(_decimals(row) == usual for row in _rows_but_last(body)):
        raise InputError(
            f"{table.path}:{body.count(NEW_LINE) + 2}: the last number has {last} decimals where"
            f" all others have {usual}, and no line end follows; the file is truncated, copy it"
            " again."
        )


def _decimals(row: bytes) -> int:
    """Decimals of the last number in a row."""
    return len(row.rpartition(b",")[2].partition(b".")[2])


def _rows_but_last(body: bytes) -> Iterator[bytes]:
    """One after another: all of ten million at once take a gigabyte."""
    start = 0
    while (end := body.find(NEW_LINE, start)) >= 0:
        yield body[start:end]
        start = end + 1
