"""Signals that are logged late or act late: put on one clock, that of the motion.

Outputs that share a delay keep their samples, which move on the time axis as they are. Inputs keep
the steps at which they really change, and are averaged from sample to sample of that clock beside.
"""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.data.zero_order_hold import held_averages
from ptp_symbolic.platform import SignalDeclaration

FloatArray = NDArray[np.float64]
Steps = tuple[FloatArray, FloatArray]  # times in s, and the values that hold from them on
Series = tuple[FloatArray, FloatArray]  # times [n] in s, and what was logged at them [n]

SAME_TIME = 1e-6  # of a sampling period: what rounding may leave between equal times


def on_one_clock(
    path: Path,
    series: Sequence[Series],
    inputs: Sequence[SignalDeclaration],
    outputs: Sequence[SignalDeclaration],
) -> tuple[FloatArray, FloatArray, tuple[Steps, ...]]:
    """Return the times [k] in s at which the outputs were measured, all signals [k, nu + ny] at
    them, and the steps of the inputs, from the `series` of every signal. Of several clocks that of
    the first encoder leads; an input acts from the time at which it was logged to the next.

    Samples for which a signal is not there yet, or no more, are left out. Raises InputError for an
    encoder that would be interpolated.
    """
    signals = (*inputs, *outputs)
    given, measured = series[: len(inputs)], series[len(inputs) :]
    at, leader = next(
        ((k, s) for k, s in enumerate(outputs) if s.count is not None), (0, outputs[0])
    )
    time = measured[at][0]
    if not any(s.delay for s in signals) and all(own is time for own, _ in series):
        return time, np.column_stack([column for _, column in series]), ()
    late = [s.delay for s in inputs] + [-s.delay for s in outputs]
    period = float(np.median(np.diff(time)))
    begin = max(own[0] + d for (own, _), d in zip(series, late, strict=True))
    end = min(own[-1] + d for (own, _), d in zip(measured, late[len(inputs) :], strict=True))
    for (own, _), d in zip(given, late, strict=False):
        held = max(float(np.median(np.diff(own))) - period, 0.0)  # the last value holds as long
        end = min(end, own[-1] + d + held)
    clock = time - leader.delay
    there = (clock >= begin - SAME_TIME * period) & (clock <= end + SAME_TIME * period)
    clock = np.ascontiguousarray(clock[there])
    if len(clock) < 2:
        raise InputError(
            f"{path}: is shorter than the delays of its signals; give a longer log."
            if all(own is time for own, _ in series)
            else f"{path}: there is no time at which all signals are logged; give parts of one run"
            " with one clock."
        )
    moved = delayed_inputs(given, inputs, clock)
    seen = [
        _output(path, (own - s.delay, column), s, leader, clock, own is time)
        for s, (own, column) in zip(outputs, measured, strict=True)
    ]
    steps = [
        (own + s.delay, column) if _samples_at(own + s.delay, clock) is None else (clock, acting)
        for s, (own, column), acting in zip(inputs, given, moved.T, strict=True)
    ]
    return clock, np.column_stack([moved, *seen]), tuple(steps)


def delayed_inputs(
    series: Sequence[Series], inputs: Sequence[SignalDeclaration], clock: FloatArray
) -> FloatArray:
    """Return what acts on the machine from every time of `clock` [k] to the next, [k, nu], of the
    `series` of every input, which are held from sample to sample. The first acts from ever.
    """
    edges = np.append(clock, 2.0 * clock[-1] - clock[-2])
    moved = []
    for signal, (time, column) in zip(inputs, series, strict=True):
        acts = time + signal.delay
        at = _samples_at(acts, clock)
        if at is None:
            at = np.maximum(np.searchsorted(acts, edges, side="right") - 1, 0)
            changes = column[at[1:]] != column[at[:-1]]
            averages = held_averages(acts, column, edges)
            moved.append(np.where(changes | (np.diff(at) > 1), averages, column[at[:-1]]))
        else:
            moved.append(column[at])
    return np.column_stack([np.empty((len(clock), 0)), *moved])


def _output(
    path: Path,
    series: Series,
    signal: SignalDeclaration,
    leader: SignalDeclaration,
    clock: FloatArray,
    is_shared: bool,
) -> FloatArray:
    """An output at the times of `clock` [k], from the `series` of when it was measured; `is_shared`
    tells whether it is logged at the times of the leader.
    """
    measured, column = series
    at = _samples_at(measured, clock)
    if at is not None:
        return column[at]
    if signal.count is not None and not is_shared:
        raise InputError(
            f"{path}: the encoders '{leader.column}' and '{signal.column}' are logged at different"
            " times, and interpolation would blur their counts; log both together, or give the"
            " second a noise in place of its counts."
        )
    if signal.count is not None:
        raise InputError(
            f"{path}: the delays of the encoders '{leader.column}' and '{signal.column}' differ by"
            f" {1e3 * abs(leader.delay - signal.delay):g} ms, no whole number of samples, and"
            " interpolation would blur their counts; give both the same delay."
        )
    return np.interp(clock, measured, column)


def _samples_at(time: FloatArray, clock: FloatArray) -> NDArray[np.int64] | None:
    """Index of the sample at every time of `clock` [k], None where one lies between samples."""
    middle = 0.5 * (time[1:] + time[:-1])
    nearest = np.searchsorted(middle, clock)
    rounding = SAME_TIME * float(np.median(np.diff(time)))
    same = np.abs(time[nearest] - clock) <= rounding
    return nearest if bool(np.all(same)) else None
