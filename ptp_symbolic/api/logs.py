"""A measured log as an object: signals by name, a table and a plot."""

import csv
import itertools
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, fields
from functools import cached_property
from pathlib import Path
from tempfile import TemporaryDirectory
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.api.display import Displayed, Table
from ptp_symbolic.api.extras import extra_library
from ptp_symbolic.api.inputs import columns_of_frame, is_frame
from ptp_symbolic.api.machine import Source, platform_of
from ptp_symbolic.errors import InputError, path_of, unknown, wrong_type
from ptp_symbolic.numeric import data
from ptp_symbolic.numeric.data.log import raw_numbers
from ptp_symbolic.platform import Platform, SignalDeclaration

if TYPE_CHECKING:
    from matplotlib.figure import Figure

FloatArray = NDArray[np.float64]
WANTED = "the path of a file or a folder, a log of `read_log`, a DataFrame, or several of them"


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class Log(Displayed, data.Log):
    """A log of a machine: `time` [n] in s, `inputs` [n, nu] and `outputs` [n, ny] in SI, columns in
    the order of the declared `signals`; `log[name]` is one of them [n].

    `path` is the file that it was read from. Logs pickle, drive simulations, and are what `fit` and
    `diagnose` take.
    """

    signals: tuple[SignalDeclaration, ...]
    path: Path

    @cached_property
    def columns(self) -> Mapping[str, FloatArray]:
        """The signals [n] by name, inputs first."""
        names = [s.signal for role in ("input", "output") for s in self.signals if s.role == role]
        values = (*self.inputs.T, *self.outputs.T)
        return MappingProxyType(dict(zip(names, values, strict=True)))

    @property
    def units(self) -> dict[str, str]:
        """The SI unit of every signal, by name."""
        return {s.signal: s.unit for s in self.signals}

    def __getitem__(self, name: str) -> FloatArray:
        """The signal `name` [n] in SI. Raises KeyError, which lists the names, for another."""
        if name not in self.columns:
            raise KeyError(str(unknown("signal", name, self.columns)))
        return self.columns[name]

    def to_pandas(self) -> Any:
        """A pandas DataFrame: a column per signal, the time in s as index; the units stand in
        `attrs["units"]`. Raises InputError where pandas is not installed.
        """
        pandas = extra_library("pandas")
        frame = pandas.DataFrame(dict(self.columns), index=pandas.Index(self.time, name="time"))
        frame.attrs["units"] = self.units
        return frame

    def plot(self, *names: str) -> "Figure":
        """A matplotlib figure of the signals `names` (none: all), a panel per unit.

        Raises KeyError for another name.
        """
        from ptp_symbolic.api.plots import panels_by_unit

        signals = {name: self[name] for name in names or self.columns}
        return panels_by_unit(self.time, signals, self.units)

    def __getstate__(self) -> dict[str, Any]:
        return {field.name: getattr(self, field.name) for field in fields(self)}

    def _heading(self) -> str:
        period = float(np.median(np.diff(self.time)))
        duration = self.time[-1] - self.time[0]
        rate = f"{len(self.time)} samples over {duration:.4g} s, {1 / period:.4g} Hz"
        return f"Log '{self.name}': {rate}"

    def _tables(self) -> tuple[Table, ...]:
        roles = {s.signal: s.role for s in self.signals}
        rows = [
            (n, roles[n], self.units[n], float(v.min()), float(v.max()))
            for n, v in self.columns.items()
        ]
        return (Table("Signal", ("signal", "role", "unit", "lowest", "highest"), tuple(rows)),)


def read_log(path: Path | str, platform: Source) -> Log:
    """Read a log with the signals that `platform` declares, in SI units.

    `platform` is what `load` takes. Raises InputError, with the line where there is one, for a file
    that is missing or truncated, a missing signal or a wrong unit, cells that are no finite
    numbers, and time stamps that do not increase.

    >>> import ptp_symbolic as ptp
    >>> folder = ptp.sample("tilted_base")
    >>> log = ptp.read_log(next((folder / "train").glob("*.csv")), folder / "platform.toml")
    >>> log.time.shape == log["theta_pan"].shape
    True
    """
    place, declared = path_of(path, "A log", "the path of a file"), platform_of(platform)
    found = data.read_log(place, declared)
    return Log(**vars(found), signals=declared.signals, path=place)


@contextmanager
def log_paths(platform: Platform, *several: Any) -> Iterator[list[list[Path | str]]]:
    """For each argument its files or folders: one or several paths, logs that were read, or
    DataFrames, which are files as long as the context lasts.

    Raises InputError for what is none of these.
    """
    with TemporaryDirectory() as folder:
        count = itertools.count(1)

        def path(log: Any) -> Path | str:
            if isinstance(log, Log):
                return log.path
            if is_frame(log):
                return _written(log, platform, Path(folder) / f"frame_{next(count)}.csv")
            return path_of(log, "A log", WANTED)

        yield [[path(log) for log in _each(logs)] for logs in several]


def _each(logs: Any) -> Iterable[Any]:
    if isinstance(logs, str | Path | Log) or is_frame(logs):
        return [logs]
    if not isinstance(logs, Iterable):
        raise wrong_type("A log", logs, WANTED)
    return logs


def _written(frame: Any, platform: Platform, path: Path) -> Path:
    """`path`, at which a DataFrame stands as a log of `platform`."""
    lacking = [s.signal for s in platform.signals if s.signal not in frame.columns]
    if lacking:
        raise InputError(
            f"The DataFrame has the columns {', '.join(map(str, frame.columns))}; name columns in"
            f" SI {', '.join(lacking)} too."
        )
    time, columns = columns_of_frame(frame, [s.signal for s in platform.signals])
    table = {f"{platform.clock.column or 'time'} [s]": time} | {
        f"{s.column} [{'1' if s.scale else s.unit}]": raw_numbers(s, columns[s.signal])
        for s in platform.signals
    }
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(table)
        writer.writerows(np.column_stack(tuple(table.values())).tolist())
    return path


def sample(name: str) -> Path:
    """The folder of a packaged example: a platform.toml, and logs in `train` and `validate`.

    Raises InputError for an unknown name.

    >>> import ptp_symbolic as ptp
    >>> sorted(path.name for path in ptp.sample("tilted_base").iterdir() if path.suffix != ".py")
    ['platform.toml', 'train', 'validate']
    """
    folder = Path(__file__).parents[1] / "samples"
    known = sorted(p.name for p in folder.iterdir() if (p / "platform.toml").is_file())
    if name not in known:
        raise unknown("sample", name, known)
    return folder / name
