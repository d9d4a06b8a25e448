"""What a file holds, before any number of it is read: parts with columns of known size."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

MOST_ROWS = 10_000_000
MOST_COLUMNS = 1000
MOST_NUMBERS = 20_000_000  # in the columns that are read: 160 MB
WIDEST = 100  # columns of a matrix, numbers in a field of a message: more are no signals
NUMERIC = "iufb"  # kinds of NumPy types that are numbers


@dataclass(frozen=True)
class Column:
    """A column of `size` numbers; None where only reading them tells how many there are."""

    name: str
    unit: str | None
    size: int | None


@dataclass(frozen=True)
class Part:
    """Columns with one clock: a file, a group or a topic of it. `load` returns the columns of the
    given names one after the other; `note` says what else there is and cannot be read.
    """

    name: str
    columns: Sequence[Column]
    load: Callable[[Sequence[str]], Iterator[NDArray[Any]]]
    note: str = ""


def one_by_one(
    load: Callable[[str], NDArray[Any]],
) -> Callable[[Sequence[str]], Iterator[NDArray[Any]]]:
    """How a part loads its columns where each is read by itself."""
    return lambda names: (load(name) for name in names)


def seconds(values: NDArray[Any]) -> NDArray[np.float64]:
    """Seconds of dates and durations, dates from the first one on; NaN where there is none."""
    if values.dtype.kind == "M":
        known = values[~np.isnat(values)]
        values = values - (known.min() if len(known) else values[:1])
    step = np.timedelta64(1, "ns")
    return np.where(np.isnat(values), np.nan, 1e-9 * (values / step))


def in_a_line(error: Exception) -> str:
    """The message of an error in one line, without the dot at its end."""
    text = " ".join(str(error).split()).rstrip(".") or type(error).__name__
    return text if len(text) <= 200 else text[:197] + "..."


def lacking(path: object, kind: str, package: str, extra: str) -> str:
    """What to do where the library that reads a kind of file is not installed."""
    return (
        f"{path}: a {kind} file needs {package}; run pip install 'ptp-symbolic[{extra}]', or save"
        " the log as CSV."
    )
