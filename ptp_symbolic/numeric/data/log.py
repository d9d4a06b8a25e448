"""Logs of a machine: the columns that its platform names, in SI units.

One run in several tables: files cut one after the other, groups of signals, topics of a bag.

Training and validation logs: no run may be in both, whole or in part.

Columns of a log made into signals: units converted, raw numbers scaled, zeros taken off.
"""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.data.formats import files_at, name_of, parts_of, read_tables
from ptp_symbolic.numeric.data.latency import (
    Series,
    Steps,
    Wraps,
    delayed_inputs,
    on_one_clock,
    unwrapped,
)
from ptp_symbolic.numeric.data.table import Table
from ptp_symbolic.platform import Clock, Platform, SignalDeclaration, naming_file
from ptp_symbolic.platform.units import compatible, to_si

FloatArray = NDArray[np.float64]


def factor_of(where: str, signal: SignalDeclaration, unit: str | None) -> float:
    """Return by what a number of the column is multiplied: its unit in SI, or the declared scale.

    `unit` is that of the heading, if it has one; `where` begins a refusal. With a scale the numbers
    are taken as they stand, whatever unit the heading gives them. A heading without a unit has that
    of the platform file. Raises InputError for a wrong unit, and for a scale that contradicts the
    unit of the heading.
    """
    if signal.scale is None:
        given = unit or signal.column_unit or signal.unit
        return unit_factor(where, signal.column, signal.signal, signal.unit, given)
    if unit and _fits(unit, signal.unit):
        factor = to_si(unit)[0]
        if factor != 1.0 and abs(math.log(abs(signal.scale))) < abs(
            math.log(abs(signal.scale / factor))
        ):
            raise InputError(
                f"{where} is in {unit}, of which its scale makes {signal.scale:g} {signal.unit}"
                f' each; write unit = "{unit}" beside the scale, which then multiplies them.'
            )
    return signal.scale


def unit_factor(where: str, column: str, signal: str, wanted: str, unit: str | None) -> float:
    """Return the factor from the `unit` of a heading to the `wanted` SI unit of the signal.

    Raises InputError, begun by `where`, for no unit and for one that does not fit.
    """
    if not unit:
        raise InputError(f"{where} has no unit; write '{column} [{wanted}]'.")
    try:
        fits = compatible(unit, wanted)
        factor = to_si(unit)[0]
    except InputError as error:
        raise InputError(f"{where}: {error}") from error
    if not fits:
        raise InputError(
            f"{where} is in {unit}, but {signal} is in {wanted}; correct the header "
            "or the platform."
        )
    return factor


def calibrated(
    numbers: FloatArray, signals: Sequence[SignalDeclaration], factors: Sequence[float]
) -> FloatArray:
    """Return the signals [n, s] in SI whose columns hold `numbers` [n, s], see `factor_of`."""
    values = np.ascontiguousarray(numbers)
    raw = np.array([0.0 if s.scale is None else s.offset for s in signals])
    zero = np.array([s.offset if s.scale is None else 0.0 for s in signals])
    if any(factor != 1.0 for factor in factors) or any(s.offset for s in signals):
        values = (values - raw) * np.array(factors) - zero
    return values


def raw_numbers(signal: SignalDeclaration, values: FloatArray) -> FloatArray:
    """Return the numbers [n] of the column that says that the signal has the `values` [n] in SI:
    in SI themselves, unless the signal has a scale.
    """
    if signal.scale is None:
        return values + signal.offset
    return values / signal.scale + signal.offset


def _fits(unit: str, wanted: str) -> bool:
    try:
        return compatible(unit, wanted)
    except InputError:  # degC, or a word such as counts: numbers as they stand
        return False


Part = tuple[Table, FloatArray, FloatArray]  # with times [n] in s and values [n, s]


def groups_of(
    path: Path, tables: Sequence[Table], columns: Sequence[str]
) -> dict[tuple[str, ...], list[Table]]:
    """The tables that hold some of the `columns`, by the columns that they hold.

    Raises InputError for a column in none of them, and for one in tables that hold others beside.
    """
    groups: dict[tuple[str, ...], list[Table]] = {}
    for table in tables:
        own = tuple(column for column in columns if table.place(column) is not None)
        if own:
            groups.setdefault(own, []).append(table)
    for column in columns:
        found = [tables[0] for own, tables in groups.items() if column in own]
        if not found:
            held = ", ".join(name for table in tables for name, _ in table.headings)
            held = held if len(held) <= 300 else held[:297] + "..."
            raise InputError(f"{path}: signal '{column}' is missing; the log has {held}.")
        if len(found) > 1:
            raise InputError(
                f"{path}: '{column}' is in {found[0].head} and in {found[1].head}, with other"
                " signals beside it; leave it in one of them."
            )
    return groups


def one_after_the_other(parts: Sequence[Part]) -> tuple[FloatArray, FloatArray]:
    """Times [n] in s and values [n, s] of parts with the same signals, in the order of time.

    Raises InputError for parts whose times overlap.
    """
    ordered = sorted(parts, key=lambda part: float(part[1][0]))
    for (first, before, _), (second, after, _) in pairwise(ordered):
        if after[0] <= before[-1]:
            raise InputError(
                f"{second.head}: its times from {after[0]:.6g} s to {after[-1]:.6g} s overlap those"
                f" of {first.head}, {before[0]:.6g} s to {before[-1]:.6g} s; parts of one run need"
                " one clock: give runs of their own as logs of their own."
            )
    return np.concatenate([p[1] for p in ordered]), np.concatenate([p[2] for p in ordered])


MIN_ROWS = 10
STEADY = {"rate", "torque"}  # columns of points at steady rates
OWN_SAMPLES = 0.25  # share of the rows that lack a column which has samples of its own
SLOWEST = 5.0  # Hz; samples at most as often show no drive that lets go


@dataclass(frozen=True, eq=False)
class Log:
    """One run: `time` [n] in s, strictly increasing; `inputs` [n, nu]; `outputs` [n, ny].

    Columns are in the order of the platform's signals of that role and in their units (SI), scales,
    offsets and delays of the signals applied. The sampling may be irregular; between samples an
    input is what its signal says (see `SignalDeclaration.between_samples`). Where zero-order holds
    change between samples, being delayed, `inputs` are averages from sample to sample, and `steps`
    the times in s and values [m] of every input (empty: as `inputs` say).
    `wraps` tells of which angles turns, or ends of a counter, were taken out; `interpolated` which
    columns have values between their samples, and how far these may be off where the motion changes
    suddenly; `thinned` which were logged faster than `time`, and how many times as fast.
    """

    name: str
    time: NDArray[np.float64]
    inputs: NDArray[np.float64]
    outputs: NDArray[np.float64]
    steps: tuple[Steps, ...] = ()
    wraps: tuple[Wraps, ...] = ()
    interpolated: Mapping[str, float] = field(default_factory=dict)
    thinned: Mapping[str, float] = field(default_factory=dict)


def read_log(path: Path | str, platform: Platform) -> Log:
    """Read one log (see `read_table`) with the signals that `platform` declares.

    Raises InputError, with the line where there is one, for a file that is missing, not text or
    truncated, a missing signal or a wrong unit, cells that are no finite numbers, time stamps that
    do not increase, fewer than 10 rows, and a platform without output signals.
    """
    path = Path(path)
    inputs = [signal for signal in platform.signals if signal.role == "input"]
    outputs = [signal for signal in platform.signals if signal.role == "output"]
    if not outputs:
        measured = next((s.signal for s in inputs if s.is_position), None)
        advice = (
            "add one, such as [signals.theta_pan]"
            if measured is None
            else f"'{measured}' is measured: write role = \"output\" there"
        )
        with naming_file(platform):
            raise InputError(
                f"Platform '{platform.name}' has no output signal to compare with {path}; {advice}."
            )
    read = _read_signals(path, [*inputs, *outputs], platform.clock)
    whole = [unwrapped(c, s) for (_, c), s in zip(read, [*inputs, *outputs], strict=True)]
    series = [(clock, column) for (clock, _), (column, _) in zip(read, whole, strict=True)]
    clocked = on_one_clock(path, series, inputs, outputs)
    _refuse_short(path, clocked.time)
    split = len(inputs)
    return Log(
        name_of(path),
        clocked.time,
        np.ascontiguousarray(clocked.values[:, :split]),
        np.ascontiguousarray(clocked.values[:, split:]),
        clocked.steps,
        tuple(wraps for _, wraps in whole if wraps is not None),
        clocked.interpolated,
        clocked.thinned,
    )


def read_inputs(
    path: Path | str, platform: Platform
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Read only time [n] in s and inputs [n, nu] in SI of a CSV, to drive a simulation with.

    Raises InputError as `read_log` does, and for a platform without input signals.
    """
    inputs = [signal for signal in platform.signals if signal.role == "input"]
    if not inputs:
        with naming_file(platform):
            raise InputError(
                f"Platform '{platform.name}' has no input signal to read from {path}; add one, "
                "such as [signals.u_pan]."
            )
    series = _read_signals(Path(path), inputs, platform.clock)
    time = series[0][0]
    return time, delayed_inputs(series, inputs, time)


def read_logs(paths: Iterable[Path | str], platform: Platform) -> tuple[Log, ...]:
    """Read logs from files and folders; a folder stands for all logs in it, sorted by name.

    Logs of the same file name are told apart by their folders (`train/crawl`). Raises InputError as
    `read_log` does, for a folder without logs, and for a log that is given twice.
    """
    files = log_files(paths)
    places = [file.resolve() for file in files]
    for file, place in zip(files, places, strict=True):
        if places.count(place) > 1:
            raise InputError(f"{file}: is given twice; name each log once.")
    named = zip(files, _names(files), strict=True)
    return tuple(replace(read_log(file, platform), name=name) for file, name in named)


def _names(files: Sequence[Path]) -> list[str]:
    """Names of logs, those of the same file name with as many folders as tell them apart."""
    own = [name_of(file) for file in files]
    folders = [parts_of(file)[0].resolve().parent.parts for file in files]
    alike = [own.count(name) > 1 for name in own]
    names = own
    for depth in range(1, max(map(len, folders), default=0)):
        names = [
            "/".join([*folder[-depth:], name]) if several else name
            for name, folder, several in zip(own, folders, alike, strict=True)
        ]
        if len(set(names)) == len(names):
            break
    return names


def log_files(paths: Iterable[Path | str]) -> list[Path]:
    """The files of logs given as files and folders. Raises InputError where there are none."""
    files = [file for path in paths for file in files_at(Path(path))]
    if not files:
        raise InputError("No log is given; name at least one log or a folder of them.")
    return files


def _read_signals(
    path: Path, signals: Sequence[SignalDeclaration], declared: Clock
) -> list[Series]:
    """Return times [n] in s and values [n] in SI of every signal; those of one table share their
    times.
    """
    tables = read_tables(path)
    if len(tables) == 1:
        time, values = _read_table(tables[0], signals, declared)
        return _own_samples([(time, column) for column in values.T])
    found: dict[str, Series] = {}
    by_column = {signal.column: signal for signal in signals}
    for columns, parts in groups_of(path, tables, list(by_column)).items():
        own = [by_column[column] for column in columns]
        time, values = one_after_the_other([(t, *_read_table(t, own, declared)) for t in parts])
        same = [known for known, _ in found.values() if np.array_equal(known, time)]
        found |= {c: (same[0] if same else time, v) for c, v in zip(columns, values.T, strict=True)}
    return _own_samples([found[signal.column] for signal in signals])


def _own_samples(series: Sequence[Series]) -> list[Series]:
    """Every signal at the times at which it has a value; those with the same share their times."""
    own: list[Series] = []
    clocks: dict[bytes, NDArray[np.float64]] = {}
    for time, values in series:
        missing = np.isnan(values)
        if missing.any():
            kept = ~missing
            key = np.packbits(kept).tobytes()
            time, values = clocks.setdefault(key, time[kept]), values[kept]
        own.append((time, values))
    return own


def _read_table(
    table: Table, signals: Sequence[SignalDeclaration], declared: Clock
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return time [n] and the signals [n, len(signals)] in SI, NaN where one has no sample."""
    clock = table.clock(declared)
    if clock is None:
        steady = STEADY.issubset(name for name, _ in table.headings)
        advice = "; steady points of rate and torque are for friction-map" if steady else ""
        raise InputError(
            f"{table.head}: column '{declared.column or 'time'} [s]' is missing;"
            f" {_listing(table)}{advice}."
        )
    places = {signal.column: table.place(signal.column) for signal in signals}
    missing = [column for column, place in places.items() if place is None]
    if missing:
        raise InputError(
            f"{table.head}: signal {', '.join(repr(name) for name in missing)} is missing; "
            f"{_listing(table)}."
        )
    found = [place for place in places.values() if place is not None]
    factors = [
        factor_of(f"{table.head}: column '{s.column}'", s, unit)
        for s, (_, unit) in zip(signals, found, strict=True)
    ]
    columns = [clock[0], *(index for index, _ in found)]
    numbers = table.numbers(columns)
    _refuse_short(table.path, numbers)
    _refuse_lost(table, columns, np.isnan(numbers))
    time = np.ascontiguousarray(numbers[:, 0])
    for k, signal in enumerate(signals):
        sampled = np.flatnonzero(~np.isnan(numbers[:, 1 + k]))
        _refuse_short(table.path, sampled, signal)
        if k == 0 or len(sampled) < len(time):
            _check_time(table, time, clock[1], sampled)
    second = unit_factor(f"{table.head}: column 'time'", "time", "time", "s", clock[1])
    if second != 1.0:
        time *= second
    for k, signal in enumerate(signals):
        if signal.role == "output":
            _refuse_slow(table, time[~np.isnan(numbers[:, 1 + k])])
    return time, calibrated(numbers[:, 1:], signals, factors)


def _refuse_lost(table: Table, columns: Sequence[int], missing: NDArray[np.bool_]) -> None:
    """Raise InputError for a value that is missing here and there.

    Where a column lacks many, it has samples of its own, as in the outer join of logs of several
    rates; rows that hold none of the `columns` but the time are of others.
    """
    table.refuse_missing(columns[:1], missing[:, :1])
    lost = missing & ~missing[:, 1:].all(axis=1, keepdims=True)
    if lost.any() and lost.mean(axis=0).max() < OWN_SAMPLES:
        table.refuse_missing(columns, lost)


def _refuse_short(path: Path, rows: NDArray[Any], signal: SignalDeclaration | None = None) -> None:
    if len(rows) < MIN_ROWS:
        of = "" if signal is None or not len(rows) else f" with '{signal.column}'"
        raise InputError(
            f"{path}: has {len(rows)} rows of numbers{of}; a log needs at least {MIN_ROWS}."
        )


def _listing(table: Table) -> str:
    if not table.headings:
        return f"the file holds no column of numbers{table.note}"
    columns = [name if unit is None else f"{name} [{unit}]" for name, unit in table.headings]
    text = ", ".join(columns)
    return "the header has " + (text if len(text) <= 300 else text[:297] + "...") + table.note


def _refuse_slow(table: Table, time: NDArray[np.float64]) -> None:
    period = float(np.median(np.diff(time)))
    if SLOWEST * period >= 1.0:
        raise InputError(
            f"{table.head}: one sample every {period:.6g} s, and more than {SLOWEST:g} per second"
            " are needed: if the times are in ms, write 'time [ms]', else log faster."
        )


def _check_time(
    table: Table, stamps: NDArray[np.float64], unit: str | None, rows: NDArray[np.intp]
) -> None:
    """Refuse times of the `rows` that do not increase, and such without a unit."""
    time = stamps[rows]
    if unit is None:
        step = float(np.median(np.diff(time)))
        raise InputError(
            f"{table.head}: column 'time' has no unit, and mostly steps of {step:.6g}; write"
            f" 'time [s]' where that is {step:.6g} s, 'time [ms]' where it is {step:.6g} ms, or"
            " give [log] time_unit in the platform file."
        )
    wrong = np.flatnonzero(np.diff(time) <= 0)
    if len(wrong):
        row = int(wrong[0]) + 1
        what = "repeats" if time[row] == time[row - 1] else "goes back from"
        raise InputError(
            f"{table.row(int(rows[row]))}: time {float(time[row])!r} {unit} {what}"
            f" {float(time[row - 1])!r} {unit} of the line before; time stamps must increase."
        )


EXCERPT = 50  # samples in a row
CHANGES = 10  # of them differ from the one before, or they say little


def read_split_logs(
    train: Iterable[Path | str], validate: Iterable[Path | str], platform: Platform
) -> tuple[tuple[Log, ...], tuple[Log, ...]]:
    """Read the training logs and the validation logs, which must be other runs.

    Raises InputError as `read_logs` does, and for a run that is in both, under whatever name, whole
    or in part. A part that was resampled is not noticed.
    """
    places = [log_files(paths) for paths in (train, validate)]
    fitted, judging = (read_logs(files, platform) for files in places)
    seen = [_excerpts(log) for log in fitted]
    for file, log in zip(places[1], judging, strict=True):
        own = _excerpts(log)
        for other, known, excerpts in zip(places[0], fitted, seen, strict=True):
            whole = _same_run(log, known)
            if whole or own & excerpts:
                raise InputError(
                    f"{file}: holds {'the same run as' if whole else 'samples of'} {other}, which"
                    " is given to be fitted; a fit is judged by runs that it has never seen: give"
                    " others to `validate`."
                )
    return fitted, judging


def _same_run(log: Log, other: Log) -> bool:
    """Whether both hold the same samples, wherever their clocks started."""
    return (
        np.array_equal(log.outputs, other.outputs)
        and np.array_equal(log.inputs, other.inputs)
        and np.allclose(log.time - log.time[0], other.time - other.time[0])
    )


def _excerpts(log: Log) -> set[int]:
    """Hashes of all EXCERPT samples in a row that hold some motion."""
    rows = np.hstack([log.inputs, log.outputs])
    if len(rows) < EXCERPT:
        return set()
    changed = np.any(np.diff(rows, axis=0) != 0.0, axis=1)
    moving = np.convolve(changed, np.ones(EXCERPT - 1), "valid") >= CHANGES
    windows = sliding_window_view(rows, EXCERPT, axis=0)
    return {hash(window.tobytes()) for window in windows[moving]}
