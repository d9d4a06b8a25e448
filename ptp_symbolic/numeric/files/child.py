"""The process that reads a file with a library; it may die of what the file holds.

Run as `python -m ptp_symbolic.numeric.files.child`, with a `Request` in JSON as its argument. It
answers on its standard output with one line of JSON, followed by numbers or text.

Excel files (.xlsx), read with openpyxl as the text of a CSV.

Parquet files, read with pyarrow.

TDMS files of LabVIEW, read with npTDMS: every group is a part.
"""

import csv
import io
import json
import os
import sys
from collections.abc import Iterator, Sequence
from datetime import date, datetime, time, timedelta
from pathlib import Path
from typing import Any, BinaryIO
from zipfile import ZipFile

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.files import bags, matlab
from ptp_symbolic.numeric.files.content import (
    MOST_COLUMNS,
    MOST_NUMBERS,
    NUMERIC,
    Column,
    Part,
    in_a_line,
    lacking,
    one_by_one,
    seconds,
)


def parquet_parts(path: Path) -> Sequence[Part]:
    """The numeric columns; dates and durations are in s.

    Raises InputError where pyarrow is not installed, and whatever pyarrow raises.
    """
    try:
        import pyarrow
        from pyarrow import parquet, types
    except ImportError as error:
        raise InputError(lacking(path, "Parquet", "pyarrow", "parquet")) from error
    pyarrow.set_memory_pool(pyarrow.system_memory_pool())
    file = parquet.ParquetFile(path)
    rows = file.metadata.num_rows
    columns = []
    for field in file.schema_arrow:
        if types.is_timestamp(field.type) or types.is_duration(field.type):
            columns.append(Column(field.name, "s", rows))
        elif any(
            kind(field.type) for kind in (types.is_integer, types.is_floating, types.is_boolean)
        ):
            columns.append(Column(field.name, None, rows))

    def load(name: str) -> NDArray[Any]:
        table = parquet.read_table(path, columns=[name], use_threads=False, memory_map=False)
        values = np.asarray(table.column(name).to_numpy())
        return seconds(values) if values.dtype.kind in "mM" else values.astype(np.float64)

    return [Part("", columns, one_by_one(load))]


MOST_BYTES = 400_000_000  # of all that is compressed within a file
SMALL_BYTES = 20_000_000  # of a part that may be compressed as well as it will
MOST_TIMES = 100  # that a larger part is longer than it is compressed; sheets of numbers reach 20
MOST_TAGS = 20_000_000  # of XML, four to a cell: a million rows of four columns have 18 million
SHEET_ROWS = 1_048_576  # of Excel itself
CHUNK = 1_000_000  # bytes unfolded at a time


def excel_text(path: Path) -> str:
    """The rows of the first sheet that has some, as the text of a CSV.

    Raises InputError for a file that unfolds into over 400 MB, into a hundred times its size, or
    into more cells than a log has, and where openpyxl is not installed, and whatever openpyxl
    raises. What a sheet says of its own size is not used: some programs write it wrong.
    """
    try:
        from openpyxl import load_workbook
    except ImportError as error:
        raise InputError(lacking(path, "Excel", "openpyxl", "excel")) from error
    _refuse_unfolding(path)
    book = load_workbook(path, read_only=True, data_only=True, keep_links=False)
    for sheet in book.worksheets:
        sheet.reset_dimensions()
        text = io.StringIO()
        write = csv.writer(text, lineterminator="\n").writerow
        cells = 0
        for number, row in enumerate(sheet.iter_rows(values_only=True), 1):
            cells += len(row)
            if number > SHEET_ROWS or len(row) > MOST_COLUMNS or cells > MOST_NUMBERS:
                raise InputError(
                    f"{path}: its sheet '{sheet.title}' has a cell in row {number}, column"
                    f" {len(row)}, and {SHEET_ROWS} rows, {MOST_COLUMNS} columns and"
                    f" {MOST_NUMBERS} cells in all are read; delete what is no log, or save the log"
                    " as CSV."
                )
            write([_cell(value) for value in row])
        if text.getvalue().strip(",\n"):
            return _trimmed(text.getvalue())
    return ""


def _refuse_unfolding(path: Path) -> None:
    """Raise InputError for a file too large to be read in seconds: by the list of its parts, then
    by a count of the tags in them, which is a hundred times faster than to read them.
    """
    with ZipFile(path) as archive:
        parts = archive.infolist()
        unfolded = sum(part.file_size for part in parts)
        if unfolded > MOST_BYTES:
            raise InputError(
                f"{path}: unfolds into {unfolded / 1e6:.0f} MB, and {MOST_BYTES / 1e6:.0f} MB are"
                " allowed; save the log as CSV."
            )
        for part in parts:
            if part.file_size > max(SMALL_BYTES, MOST_TIMES * part.compress_size):
                times = part.file_size / max(part.compress_size, 1)
                raise InputError(
                    f"{path}: its part {part.filename} unfolds into {times:.0f} times its size, and"
                    f" {MOST_TIMES} times are allowed; save the log as CSV."
                )
        tags = 0
        for part in parts:
            with archive.open(part) as file:
                while chunk := file.read(CHUNK):
                    tags += chunk.count(b"<")
                    if tags > MOST_TAGS:
                        raise InputError(
                            f"{path}: has more than {MOST_TAGS // 4} cells, too many for an Excel"
                            " file to be read; save the log as CSV."
                        )


def _cell(value: Any) -> str:
    if value is None:
        return ""
    if isinstance(value, bool):
        return str(int(value))
    if isinstance(value, timedelta):
        return f"{value.total_seconds()!r} s"
    if isinstance(value, datetime | date | time):
        return value.isoformat()
    return " ".join(str(value).split())


def _trimmed(text: str) -> str:
    """Without rows and columns at the ends that have no values."""
    rows = list(csv.reader(io.StringIO(text)))
    while rows and not any(rows[-1]):
        rows.pop()
    width = max((k + 1 for row in rows for k, cell in enumerate(row) if cell), default=0)
    trimmed = io.StringIO()
    csv.writer(trimmed, lineterminator="\n").writerows(row[:width] for row in rows)
    return trimmed.getvalue()


TIME = "time"  # of channels that have a sampling period and no channel of times
START, PERIOD = "wf_start_offset", "wf_increment"  # properties of a waveform, in s


def tdms_parts(path: Path) -> Sequence[Part]:
    """The groups, channels of another sampling than others of theirs as parts of their own.

    Times are the channel `time` or those of the waveforms. Raises InputError where npTDMS is not
    installed, and whatever npTDMS raises.
    """
    try:
        from nptdms import TdmsFile
    except ImportError as error:
        raise InputError(lacking(path, "TDMS", "npTDMS", "tdms")) from error
    file = TdmsFile.open(path)
    found = []
    for group in file.groups():
        alike: dict[Any, list[Any]] = {}
        for channel in group.channels():
            if channel.dtype.kind in NUMERIC + "M" and len(channel) > 1:
                properties = channel.properties
                sampling = len(channel), properties.get(PERIOD), properties.get(START)
                alike.setdefault(sampling, []).append(channel)
        found += [_part(group.name, channels) for channels in alike.values()]
    return found


def _part(group: str, channels: Sequence[Any]) -> Part:
    known = {channel.name: channel for channel in channels}
    columns = [Column(name, _unit(channel), len(channel)) for name, channel in known.items()]
    first = channels[0]
    has_clock = any(
        name.lower().split("[")[0].split("(")[0].strip() in ("time", "t") for name in known
    )
    is_waveform = float(first.properties.get(PERIOD) or 0.0) > 0.0
    if is_waveform and not has_clock:
        columns.insert(0, Column(TIME, "s", len(first)))

    def load(names: Sequence[str]) -> Iterator[NDArray[Any]]:
        for name in names:
            if name in known:
                values = np.asarray(known[name][:])
                yield seconds(values) if values.dtype.kind == "M" else values
            else:
                start = float(first.properties.get(START) or 0.0)
                yield start + float(first.properties[PERIOD]) * np.arange(len(first))

    return Part(group, columns, load)


def _unit(channel: Any) -> str | None:
    if channel.dtype.kind == "M":
        return "s"
    unit = channel.properties.get("unit_string") or channel.properties.get("NI_UnitDescription")
    return str(unit).strip() or None if unit else None


KINDS = {"MATLAB": matlab.parts, "Parquet": parquet_parts, "TDMS": tdms_parts}
EXCEL, BAG = "Excel", "bag"
ROOM = 500_000_000  # bytes that reading may take, beside three times the size of the file


def main() -> None:
    """Answer the request that is the argument."""
    request = json.loads(sys.argv[1])
    answer = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what a library prints is no answer
    _limit_memory([Path(path) for path in request["paths"]])
    answer_to(request, answer)


def answer_to(request: dict[str, Any], answer: BinaryIO) -> None:
    """Write what is asked for to `answer`, or why the file is refused."""
    name, kind = request["name"], request["kind"]
    try:
        _answer(answer, request)
    except InputError as error:
        _refuse(answer, str(error))
    except MemoryError:
        _refuse(
            answer,
            f"{name}: unfolds into more than {ROOM // 10**6} MB; save the columns that are needed"
            " alone, or as CSV.",
        )
    except Exception as error:  # a library raises whatever a damaged byte leads to
        _refuse(answer, f"{name}: is not a {kind} file that can be read: {in_a_line(error)}.")


def _answer(answer: BinaryIO, request: dict[str, Any]) -> None:
    paths = [Path(path) for path in request["paths"]]
    if request["kind"] == EXCEL:
        content = excel_text(paths[0]).encode()
        _line(answer, {"bytes": len(content)})
        answer.write(content)
        answer.flush()
        return
    if request["kind"] == BAG:
        parts: Sequence[Part] = bags.parts(Path(request["name"]), paths)
    else:
        parts = KINDS[request["kind"]](paths[0])
    if request["part"] is None:
        listed = [
            [part.name, [_listed(c) for c in part.columns[: MOST_COLUMNS + 1]], part.note]
            for part in parts[: MOST_COLUMNS + 1]
        ]
        _line(answer, {"parts": listed})
        return
    part = parts[request["part"]]
    arrays = part.load(request["columns"])
    first = np.asarray(next(arrays), dtype=np.float64).ravel()
    _line(answer, {"rows": len(first)})
    first.tofile(answer)
    del first
    for values in arrays:
        np.asarray(values, dtype=np.float64).ravel().tofile(answer)
    answer.flush()


def _listed(column: Any) -> list[Any]:
    name = column.name.encode(errors="replace").decode()
    return [" ".join(name.split()), column.unit, column.size]


def _line(answer: BinaryIO, content: dict[str, Any]) -> None:
    answer.write(json.dumps(content).encode() + b"\n")
    answer.flush()


def _refuse(answer: BinaryIO, message: str) -> None:
    _line(answer, {"refused": message})


def _limit_memory(paths: Sequence[Path]) -> None:
    """Let the system refuse memory beyond what reading may take, where it can (not on Windows)."""
    try:
        import resource
    except ImportError:
        return
    stored = sum(path.stat().st_size for path in paths if path.is_file())
    most = ROOM + 3 * stored
    try:
        resource.setrlimit(resource.RLIMIT_DATA, (most, most))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    except (ValueError, OSError):
        return


if __name__ == "__main__":
    main()
