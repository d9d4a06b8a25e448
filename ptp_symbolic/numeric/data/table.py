"""Tables of numbers with named columns, whatever file holds them."""

import re
from abc import ABC, abstractmethod
from collections.abc import Sequence
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
