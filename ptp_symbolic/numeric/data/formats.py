"""Which reader a file needs, by the end of its name.

Tables of files that a library reads: MATLAB, Parquet, TDMS, ROS bags and MCAP.

Read a CSV of numbers with a header row `name [unit]`, or refuse it with file and line.

Times written as dates with times of day, as times of day alone, or as durations.
"""

import csv
import io
import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from glob import glob
from itertools import islice
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.data.table import (
    LONGEST_LINE,
    Table,
    checked_headings,
    heading,
    is_unit,
    plain_text,
)
from ptp_symbolic.numeric.files.content import MOST_ROWS, Column, ForeignFile, in_a_line
from ptp_symbolic.platform import Clock
from ptp_symbolic.platform.fields import shown
from ptp_symbolic.platform.text_file import read_text_bytes
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


_MAX_BYTES = 200_000_000
_CHUNK = 1 << 22
NEW_LINE = b"\n"
_PLAIN = b"0123456789+-.eE, \t\n"
MISSING = ("", "nan")  # cells without a value, as spreadsheets and MATLAB write them
MANY = 100  # rows that show whether a column holds numbers
NO_TEXT = {  # how files begin: what they are, and what to do
    b"PK\x03\x04": ("a zip archive, such as an Excel file", "name it .xlsx if that is what it is"),
    b"\xd0\xcf\x11\xe0": ("an Excel file of before 2007 (.xls)", "save it as .xlsx"),
    b"\x89HDF": ("an HDF5 file", "name it .mat if MATLAB has written it"),
    b"MATLAB 5.0 MAT": ("a MATLAB file", "name it .mat"),
    b"PAR1": ("a Parquet file", "name it .parquet"),
    b"TDSm": ("a TDMS file of LabVIEW", "name it .tdms"),
    b"#ROSBAG": ("a ROS bag", "name it .bag"),
    b"\x89MCAP": ("an MCAP file", "name it .mcap"),
    b"MDF     ": ("an MDF file (ASAM)", "export it as .mat or Parquet"),
    b"\x93NUMPY": ("a NumPy file", "write it with numpy.savetxt"),
    b"\x1f\x8b": ("compressed with gzip", "unpack it"),
}
_NUMBER = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")


@dataclass(frozen=True)
class CsvTable(Table):
    """The text of a CSV in the plain form; its rows, not parsed yet, begin in `first_line`."""

    body: bytes
    first_line: int
    head_line: int

    @property
    def head(self) -> str:
        """Where the headings stand."""
        return f"{self.path}:{self.head_line}"

    def row(self, number: int) -> str:
        """Where row `number`, counted from zero, stands."""
        return f"{self.path}:{self.first_line + number}"

    def clock(self, declared: Clock) -> tuple[int, str | None] | None:
        """Index and unit of the column of times, seconds where it holds stamps; None where there is
        none.
        """
        found = super().clock(declared)
        end = self.body.find(NEW_LINE)
        cells = self.body[: end if end >= 0 else len(self.body)].decode().split(",")
        if found is None or found[0] >= len(cells) or seconds_of(cells[found[0]]) is None:
            return found
        return found[0], "s"

    def numbers(self, columns: Sequence[int]) -> NDArray[np.float64]:
        """The given columns as [n, len(columns)]; the first may hold stamps (see `seconds_of`).

        A cell that is empty, or nan, is NaN, but for the first column. Raises InputError with the
        line for a row with too few or too many cells and for a cell of these columns that is not a
        finite decimal number, and for more than ten million rows or a truncated last number. Other
        columns may hold anything.
        """
        return _parse(self, columns)

    def lost(self, row: int, column: int) -> InputError:
        """The refusal of a row, counted from zero, without a value in a column."""
        line = next(islice(_lines(self.body), row, None)).decode()
        where = self.row(row)
        return self.odd(_cells(line, where)[column], column, where)

    def odd(self, cell: str, column: int, where: str) -> InputError:
        """The refusal of a cell that is no finite number."""
        name = self.headings[column][0]
        if not cell.strip():
            return InputError(f"{where}: '{name}' is missing; every row needs a value.")
        first = [_cells(line.decode(), where) for line in islice(_lines(self.body), MANY)]
        own = [row[column] for row in first if len(row) > column]
        if len(own) > 1 and not any(_is_number(text) or seconds_of(text) for text in own):
            return InputError(
                f"{where}: '{name}' is {shown(cell.strip())}, and no row has a number there; write"
                f" numbers, or times as {FORMS}."
            )
        return InputError(
            f"{where}: '{name}' is {shown(cell.strip())}, not a finite decimal number; correct it"
            " or remove the row (time stamps may have gaps, an input holds across them)."
        )


def read_csv(path: Path) -> CsvTable:
    """Read a CSV and its header row; semicolons, tabs, decimal commas, comments above the header
    and a row of units are understood (see `plain_text`), and other encodings than UTF-8 (see
    `read_text_bytes`).

    Raises InputError for a file that is missing, larger than 200 MB, empty or not text, and for a
    header with a column twice, over 1000 columns or a malformed heading.
    """
    _refuse_other_formats(path)
    return _table(path, read_text_bytes(path, _MAX_BYTES, "a CSV log", of_instruments=True))


def _refuse_other_formats(path: Path) -> None:
    """Raise InputError for a file that begins as one of a known format that is no text."""
    if not path.is_file():
        return
    try:
        with path.open("rb") as file:
            begin = file.read(max(map(len, NO_TEXT)))
    except OSError:
        return  # which says why when it is read as text
    for mark, (kind, advice) in NO_TEXT.items():
        if begin.startswith(mark):
            raise InputError(f"{path}: is {kind}; {advice}, or save the log as CSV.")


def _table(path: Path, content: bytes) -> CsvTable:
    if not content.strip():
        raise InputError(f"{path}: is empty; give a CSV with a header row such as 'time [s],...'.")
    text = plain_text(path, content)
    where = f"{path}:{text.head_line}"
    cells = zip(text.headings, text.units, strict=True)
    headings = checked_headings(where, [heading(where, cell, unit) for cell, unit in cells])
    return CsvTable(path, headings, text.body, text.first_line, text.head_line)


def read_excel(path: Path) -> CsvTable:
    """Read the first sheet of an Excel file that has some cells, as `read_csv` reads its text.

    Raises InputError as `read_csv` does, and where the library that reads it is not installed.
    """
    refuse_no_file(path, "Excel")
    return _table(path, ForeignFile(path, "Excel", (path,)).text())


def _parse(table: CsvTable, columns: Sequence[int]) -> NDArray[np.float64]:
    body = table.body.rstrip(b"\n \t")
    cut_off = body if len(body) == len(table.body) else b""
    if body.count(b"\n") >= MOST_ROWS:
        raise InputError(f"{table.path}: has more than {MOST_ROWS} rows; split the log.")
    blocks = []
    start, line = 0, table.first_line
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


def _cells(line: str, where: str) -> list[str]:
    if len(line) > LONGEST_LINE:
        raise InputError(f"{where}: line has more than {LONGEST_LINE} characters; is this a CSV?")
    try:
        return next(csv.reader([line])) if '"' in line else line.split(",")
    except (csv.Error, StopIteration) as error:
        raise InputError(f"{where}: is not a row of a CSV ({in_a_line(error)}).") from error


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
    table: CsvTable, chunk: bytes, columns: Sequence[int], first_line: int
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
        stamp = seconds_of(cells[columns[0]])
        first = columns if stamp is None else columns[1:]
        numbers = [_number(table, cells, k, where, k != columns[0]) for k in first]
        rows.append(numbers if stamp is None else [stamp, *numbers])
    return np.array(rows, dtype=np.float64).reshape(len(rows), len(columns))


def _number(
    table: CsvTable, cells: Sequence[str], column: int, where: str, may_lack: bool
) -> float:
    cell = cells[column].strip()
    if may_lack and cell.lower() in MISSING:
        return math.nan
    if not _is_number(cell):
        raise table.odd(cell, column, where)
    return float(cell)


def _is_number(cell: str) -> bool:
    return bool(_NUMBER.fullmatch(cell.strip())) and math.isfinite(float(cell))


def _refuse_cut_number(table: CsvTable, body: bytes) -> None:
    """Refuse a file without a last line end whose last number is shorter than all before it.

    A file cut inside its last number has the right number of cells and a wrong value. With a fixed
    number of decimals, as loggers write, the cut shows.
    """
    before, _, row = body.rpartition(NEW_LINE)
    last, usual = _decimals(row), _decimals(body.partition(NEW_LINE)[0])
    is_there = not row.endswith(b",")
    if is_there and usual > last and all(_decimals(row) == usual for row in _lines(before)):
        raise InputError(
            f"{table.row(body.count(NEW_LINE))}: the last number has {last} decimals where all"
            f" others have {usual}, and no line end follows; the file is truncated, copy it again."
        )


def _decimals(row: bytes) -> int:
    """Decimals of the last number in a row."""
    return len(row.rpartition(b",")[2].partition(b".")[2])


def _lines(body: bytes) -> Iterator[bytes]:
    """One after another: all of ten million at once take a gigabyte."""
    start = 0
    while (end := body.find(NEW_LINE, start)) >= 0:
        yield body[start:end]
        start = end + 1
    yield body[start:]


_MOST_OF_FOREIGN = 1_000_000_000
BAG = "bag"


@dataclass(frozen=True)
class ForeignTable(Table):
    """One of the parts of a file, whose numbers are read when they are asked for."""

    file: ForeignFile
    part: int
    name: str
    columns: tuple[Column, ...]
    note: str

    @property
    def head(self) -> str:
        """The file, and the part where it has a name."""
        word = "topic" if self.file.kind == BAG else "group"
        return f"{self.path}: {word} {self.name}" if self.name else str(self.path)

    def row(self, number: int) -> str:
        """The row, or message, `number`, counted from zero."""
        word = "message" if self.file.kind == BAG else "row"
        return f"{self.head}: {word} {number + 1}"

    def numbers(self, columns: Sequence[int]) -> NDArray[np.float64]:
        """The given columns as [n, len(columns)], NaN where there is no value.

        Raises InputError for infinite numbers, and as `ForeignFile.numbers` does.
        """
        values = self.file.numbers(self.part, [self.columns[k] for k in columns])
        for place, index in enumerate(columns):
            wrong = np.flatnonzero(np.isinf(values[:, place]))
            if len(wrong):
                raise InputError(
                    f"{self.row(int(wrong[0]))}: '{self.headings[index][0]}' is"
                    f" {values[wrong[0], place]}, not a finite number; correct it or remove the"
                    " row."
                )
        return values


def foreign_tables(path: Path, kind: str, paths: Sequence[Path] = ()) -> list[ForeignTable]:
    """The tables of a file; of several `paths` (parts of one bag) together, called `path`.

    Names are `name [unit]` or `name`; the platform file gives the unit where there is none. Raises
    InputError for a file that is missing, damaged, over 1 GB, and where the library that reads it
    is not installed.
    """
    paths = tuple(paths) or (path,)
    for own in paths:
        refuse_no_file(own, kind)
    file = ForeignFile(path, kind, tuple(paths))
    tables = []
    for number, (name, columns, note) in enumerate(file.parts()):
        where = f"{path}: {name}" if name else str(path)
        found = [_heading(where, kind, column) for column in columns]
        headings = checked_headings(where, found)
        tables.append(ForeignTable(path, headings, file, number, name, tuple(columns), note))
    if not tables:
        raise InputError(f"{path}: holds no column of numbers; give the file of a run.")
    return tables


def _heading(where: str, kind: str, column: Column) -> tuple[str, str | None]:
    unit = column.unit if column.unit and is_unit(column.unit) else None
    # names of fields of a bag may hold any character, and never a unit
    return (column.name, unit) if kind == BAG else heading(where, column.name, unit)


def refuse_no_file(path: Path, kind: str) -> None:
    """Raise InputError where there is no file of at most 1 GB; a bag may be a folder."""
    try:
        stored = path.stat()
        is_folder = path.is_dir()
        if not is_folder:
            with path.open("rb"):
                pass
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise InputError(f"{path}: {reason}; give the path of a log.") from error
    if is_folder and kind != BAG:
        raise InputError(f"{path}: is a folder; give a {kind} file.")
    if not (is_folder or path.is_file()):
        raise InputError(f"{path}: is not a plain file; give a {kind} file.")
    if kind != BAG and stored.st_size > _MOST_OF_FOREIGN:
        raise InputError(f"{path}: is larger than 1 GB, the most for a log; split it.")


FOREIGN: Mapping[str, str] = {".mat": "MATLAB", ".parquet": "Parquet", ".tdms": "TDMS"}
EXCEL = (".xlsx", ".xlsm")
BAGS = (".bag", ".mcap")  # a .db3 needs the folder that it is in
STORED_IN = (*BAGS, ".db3")
METADATA = "metadata.yaml"  # what makes a folder a bag of ROS 2
IN_FOLDERS = (
    ".csv",
    *FOREIGN,
    ".lvm",
    ".xlsx",
    *BAGS,
)  # taken from a folder; others may be anything
PATTERN = "*?["  # what makes a path a pattern of several
AND = "+"  # between files that hold one run together


def read_table(path: Path) -> Table:
    """Read the one table of a file. Raises InputError for several, and as the readers do."""
    tables = read_tables(path)
    if len(tables) > 1:
        names = ", ".join(table.head for table in tables[:5])
        raise InputError(f"{path}: holds {len(tables)} tables ({names}); save one alone, as CSV.")
    return tables[0]


def read_tables(path: Path) -> Sequence[Table]:
    """The tables of a log: one of most files, several of a bag, of groups of channels, and of files
    with a plus between them. A file whose name has an unknown end is read as a CSV.

    Raises InputError as the readers do.
    """
    parts = parts_of(path)
    bags = [part for part in parts if is_bag(part)]
    topics = foreign_tables(path, BAG, bags) if bags else []
    return [*(t for part in parts if part not in bags for t in _tables_of(part)), *topics]


def _tables_of(path: Path) -> Sequence[Table]:
    suffix = path.suffix.lower()
    if suffix in FOREIGN:
        return foreign_tables(path, FOREIGN[suffix])
    return [read_excel(path) if suffix in EXCEL else read_csv(path)]


def is_bag(path: Path) -> bool:
    """Whether a path is a bag: a file by the end of its name, or a folder with its metadata."""
    return path.suffix.lower() in STORED_IN or (path / METADATA).is_file()


def parts_of(path: Path) -> list[Path]:
    """The files that are given with a plus between them; a file of that very name is one."""
    if AND not in str(path) or path.exists():
        return [path]
    return [Path(part) for part in str(path).split(AND)]


def name_of(path: Path) -> str:
    """The name of a log, those of its files with a plus between them."""
    return AND.join(part.stem for part in parts_of(path))


def stored_at(path: Path) -> list[Path]:
    """The files in which a log is stored."""
    stored = []
    for part in parts_of(path):
        inside = sorted(part.iterdir()) if part.is_dir() else [part]
        stored += [p for p in inside if p is part or p.suffix in STORED_IN or p.name == METADATA]
    return stored


def files_at(path: Path) -> list[Path]:
    """The logs at `path`: itself, those of a folder, or where there is no such file, those that a
    pattern like runs/*.csv matches. Raises InputError where there is none.
    """
    if not path.is_dir() or is_bag(path):
        if not set(str(path)) & set(PATTERN) or path.exists():
            return [path]
        matching = [Path(found) for found in sorted(glob(str(path), recursive=True))]
        if not matching:
            raise InputError(f"{path}: no file has such a name; give the path of a log.")
        return [file for found in matching for file in files_at(found)]
    files = [f for f in path.iterdir() if f.suffix.lower() in IN_FOLDERS or is_bag(f)]
    files = sorted(file for file in files if not file.name.startswith("."))
    if not files:
        kinds = ", ".join(f"*{suffix}" for suffix in IN_FOLDERS)
        raise InputError(f"{path}: the folder has no logs ({kinds}); name the folder of the logs.")
    return files
