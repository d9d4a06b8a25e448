"""Tables of files that a library reads: MATLAB, Parquet, TDMS, ROS bags and MCAP."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.data.table import Table, checked_headings, heading, is_unit
from ptp_symbolic.numeric.files.content import Column
from ptp_symbolic.numeric.files.outside import ForeignFile

_MAX_BYTES = 1_000_000_000
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
    if kind != BAG and stored.st_size > _MAX_BYTES:
        raise InputError(f"{path}: is larger than 1 GB, the most for a log; split it.")
