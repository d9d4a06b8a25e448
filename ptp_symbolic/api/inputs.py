"""Inputs as a program gives them: numbers, texts, functions, samples, tables and logs."""

import inspect
import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ptp_symbolic.errors import InputError, unknown, wrong_type
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.inputs import (
    PROFILES,
    InputSignal,
    constant,
    function,
    parse_profile,
    table,
)
from ptp_symbolic.platform import interpolation_of
from ptp_symbolic.platform.units import quantity

FloatArray = NDArray[np.float64]
Input = InputSignal | float | str | Path | Callable[[float], float] | ArrayLike | tuple[Any, ...]
Inputs = Mapping[str, Input] | str | Path | Any

LOG_FILES = (".csv", ".tsv", ".txt", ".mat", ".parquet", ".bag", ".mcap", ".db3")
TIME_COLUMNS = ("time", "t", "time [s]", "t [s]")


def whole_duration(model: Model, given: Inputs) -> float | None:
    """The time in s that inputs which bring their own times last; None where none does."""
    if given is None or isinstance(given, Mapping):
        return None
    time, _ = _columns(model, given)
    return float(time[-1] - time[0])


def input_signals(model: Model, given: Inputs | None, times: FloatArray) -> dict[str, InputSignal]:
    """The inputs `given` to a run of `model` over `times` [k] in s, as signals by name.

    All inputs at once are a log (a `Log`, or the path of one) or a DataFrame; by name each is one
    of what `input_signal` takes. Raises InputError for unknown names and as `input_signal` does.
    """
    if given is None:
        return {}
    if not isinstance(given, Mapping):
        time, columns = _columns(model, given)
        return {
            name: table(time - time[0], values, _between(model, name))
            for name, values in columns.items()
        }
    for name in given:
        if name not in model.input_names:
            raise unknown("input", name, model.input_names)
    return {name: input_signal(model, name, value, times) for name, value in given.items()}


def input_signal(model: Model, name: str, given: Input, times: FloatArray) -> InputSignal:
    """The input `name` of `model` over a run at `times` [k] in s.

    `given` is a number in SI, a text ("3 V", or a profile such as "step:24@0.5"), a function of
    the time in s, samples [k] at `times`, a pair (times, samples), or a log or a DataFrame with a
    column of that name. Samples hold until the next (zero-order hold); those of rates and
    accelerations, and of signals that say so, are joined by lines. Raises InputError for anything
    else.
    """
    between = _between(model, name)
    what, unit = f"Input '{name}'", model.units[name]
    start, end = float(times[0]), float(times[-1])
    if isinstance(given, InputSignal):
        return given
    if isinstance(given, str) and _is_meant_as_profile(given):
        try:
            return parse_profile(given, end - start)
        except InputError as error:
            raise InputError(f"{what}: {error}") from error
    if _is_whole(given):
        time, columns = _columns(model, given)
        if name not in columns:
            raise InputError(f"{what}: the table has {', '.join(columns)}, and no such column.")
        return table(time - time[0], columns[name], between)
    if isinstance(given, str):
        return constant(quantity(given, unit, what))
    if callable(given):
        refuse_other_arguments(given, f"{what}: the function", "one argument, the time in s", 1)
        try:
            return function(given, start, end)
        except InputError as error:
            raise InputError(f"{what}: {error}") from error
    if isinstance(given, tuple) and len(given) == 2 and np.ndim(given[0]) == 1:
        return _samples(what, _numbers(given[0], what), _numbers(given[1], what), between)
    samples = _numbers(given, what)
    if samples.ndim == 0:
        return constant(quantity(float(samples), unit, what))
    if samples.shape != times.shape:
        raise InputError(
            f"{what} has shape {samples.shape}, and there are {len(times)} output times; give as"
            " many samples, or a pair (times, samples)."
        )
    return _samples(what, times, samples, between)


def _samples(what: str, times: FloatArray, values: FloatArray, between: str) -> InputSignal:
    try:
        return table(times, values, between)
    except InputError as error:
        raise InputError(f"{what}: {error}") from error


def refuse_other_arguments(given: Callable[..., Any], what: str, wanted: str, count: int) -> None:
    """Raise InputError where a function that is `given` cannot be called with `count` arguments,
    `wanted` in words.
    """
    try:
        inspect.signature(given).bind(*[0.0] * count)
    except TypeError as error:
        raise InputError(f"{what} must take {wanted}, but: {error}; change it.") from error
    except ValueError:  # of a function in C, which does not tell
        return


def _between(model: Model, name: str) -> str:
    """What samples of the input `name` are joined by: as its signal says, or as its unit does."""
    signals = () if model.platform is None else model.platform.signals
    declared = (s.between_samples for s in signals if s.role == "input" and s.signal == name)
    return next(declared, interpolation_of(model.units[name]))


def _numbers(given: object, what: str) -> FloatArray:
    try:
        return np.asarray(float if given is None else given, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise wrong_type(
            what,
            given,
            "a number, a text such as '3 V' or 'step:24@0.5', a function of time, samples, a pair"
            " (times, samples), a log or a DataFrame",
        ) from error


def _is_meant_as_profile(text: str) -> bool:
    """Whether a text begins with the kind of a profile, or with a word in its place."""
    kind, colon, _ = text.strip().partition(":")
    return kind in PROFILES or (bool(colon) and kind.isalpha() and len(kind) > 1)


def _is_whole(given: object) -> bool:
    """Whether `given` is a table of several columns: a log, its path, or a DataFrame."""
    if isinstance(given, Path) or _is_log(given) or is_frame(given):
        return True
    return isinstance(given, str) and given.lower().endswith(LOG_FILES)


def _is_log(given: object) -> bool:
    logs = sys.modules.get("ptp_symbolic.numeric.data")  # reading logs takes imports of its own
    return logs is not None and isinstance(given, logs.Log)


def is_frame(given: object) -> bool:
    """Whether `given` is a pandas DataFrame."""
    pandas = sys.modules.get("pandas")
    return pandas is not None and isinstance(given, pandas.DataFrame)


def _columns(model: Model, given: Any) -> tuple[FloatArray, dict[str, FloatArray]]:
    """Times [m] in s, and the inputs [m] by name that a log, its path or a DataFrame holds."""
    if is_frame(given):
        return _columns_of_frame(model, given)
    platform = model.platform
    if not (isinstance(given, str | Path) or _is_log(given)):
        raise wrong_type("`inputs`", given, "inputs by name, or a log, its path or a DataFrame")
    if platform is None:
        raise InputError("The model does not know its platform, which names the columns of a log.")
    names = [s.signal for s in platform.signals if s.role == "input"]
    if _is_log(given):
        time, values = given.time, given.inputs
    else:
        from ptp_symbolic.numeric.data import read_inputs

        time, values = read_inputs(Path(given), platform)
    return time, dict(zip(names, values.T, strict=True))


def _columns_of_frame(model: Model, frame: Any) -> tuple[FloatArray, dict[str, FloatArray]]:
    names = [name for name in model.input_names if name in frame.columns]
    if not names:
        raise InputError(
            f"The DataFrame has the columns {', '.join(map(str, frame.columns))}; name those of the"
            f" inputs {', '.join(model.input_names)}."
        )
    return columns_of_frame(frame, names)


def columns_of_frame(frame: Any, names: Sequence[str]) -> tuple[FloatArray, dict[str, FloatArray]]:
    """Times [m] in s of a DataFrame, from its column of times or its index, and the columns [m]
    `names`. Raises InputError for what is no number.
    """
    clock = next((c for c in TIME_COLUMNS if c in frame.columns), None)
    time = frame.index if clock is None else frame[clock]
    columns = {name: _numbers(frame[name], f"Column '{name}'") for name in names}
    return _numbers(time, "Time of the DataFrame"), columns
