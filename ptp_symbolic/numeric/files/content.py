"""What a file holds, before any number of it is read: parts with columns of known size.

Ask a process of its own what a file holds, which a damaged file may take down.
"""

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.errors import InputError

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


PATIENCE = 120.0  # s that a file may take, beside a second per MB
_CHILD = "ptp_symbolic.numeric.files.child"
_ROOT = Path(__file__).resolve().parents[3]  # the folder that the package is in
_ONE_THREAD = {name: "1" for name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")}


@dataclass(frozen=True)
class ForeignFile:
    """A file of a kind that a library reads, or several that are one; messages call them `name`."""

    name: Path
    kind: str
    paths: tuple[Path, ...]

    def parts(self) -> list[tuple[str, list[Column], str]]:
        """Name, columns and note of every part. Raises InputError for a file that cannot be read,
        and where the library that reads it is not installed.
        """
        with self._answer(None, []) as (head, _):
            return [
                (name, [Column(*column) for column in columns], note)
                for name, columns, note in head["parts"]
            ]

    def numbers(self, part: int, columns: Sequence[Column]) -> NDArray[np.float64]:
        """The columns [n, len(columns)] of a part.

        Raises InputError as `parts` does, for columns of different lengths, and for more than ten
        million rows or twenty million numbers.
        """
        self._refuse_sizes(columns)
        with self._answer(part, [column.name for column in columns]) as (head, file):
            values = np.fromfile(file, dtype=np.float64)
        if len(values) != head["rows"] * len(columns):
            raise InputError(f"{self.name}: its columns differ in length; save them alike.")
        return values.reshape(len(columns), -1).T

    def text(self) -> bytes:
        """The text of a file that is read as a CSV. Raises InputError as `parts` does."""
        with self._answer(None, []) as (_, file):
            return file.read()

    def _refuse_sizes(self, columns: Sequence[Column]) -> None:
        sizes = [(column.size, column.name) for column in columns if column.size is not None]
        for size, name in sizes:
            if size > MOST_ROWS:
                raise InputError(
                    f"{self.name}: '{name}' has {size} rows, more than {MOST_ROWS}; split the log."
                )
            if size != sizes[0][0]:
                raise InputError(
                    f"{self.name}: '{name}' has {size} numbers where '{sizes[0][1]}' has"
                    f" {sizes[0][0]}; give columns of one length."
                )
        total = sum(size for size, _ in sizes)
        if total > MOST_NUMBERS:
            raise InputError(
                f"{self.name}: its {len(sizes)} columns hold {total} numbers, more than"
                f" {MOST_NUMBERS}; split the log."
            )

    @contextmanager
    def _answer(self, part: int | None, columns: Sequence[str]) -> Any:
        """The first line of an answer, and the file that holds the rest of it."""
        request = {
            "name": str(self.name),
            "kind": self.kind,
            "paths": [str(path) for path in self.paths],
            "part": part,
            "columns": list(columns),
        }
        command = [sys.executable, "-P", "-m", _CHILD, json.dumps(request)]
        with tempfile.TemporaryFile() as file:
            code = _run(command, file, self._patience())
            file.seek(0)
            head = _head(file)
            if code is None or not head:
                raise InputError(self._died(code))
            if "refused" in head:
                raise InputError(head["refused"])
            if code != 0:
                raise InputError(self._died(code))
            yield head, file

    def _patience(self) -> float:
        return PATIENCE + sum(p.stat().st_size for p in self.paths if p.is_file()) / 1e6

    def _died(self, code: int | None) -> str:
        how = "did not end" if code is None else f"ended the process that read it (code {code})"
        return (
            f"{self.name}: is damaged: reading this {self.kind} file {how}; export it once more, or"
            " save the log as CSV."
        )


def _run(command: Sequence[str], output: IO[bytes], patience: float) -> int | None:
    """The exit code of a command, None where its time was over."""
    path = os.pathsep.join(filter(None, (str(_ROOT), os.environ.get("PYTHONPATH"))))
    environment = {**os.environ, **_ONE_THREAD, "PYTHONPATH": path}
    try:
        return subprocess.run(
            command,
            stdin=subprocess.DEVNULL,
            stdout=output,
            stderr=subprocess.DEVNULL,
            env=environment,
            timeout=patience,
            check=False,
        ).returncode
    except subprocess.TimeoutExpired:
        return None


def _head(file: IO[bytes]) -> dict[str, Any]:
    try:
        head = json.loads(file.readline())
    except ValueError:
        return {}
    return head if isinstance(head, dict) else {}
