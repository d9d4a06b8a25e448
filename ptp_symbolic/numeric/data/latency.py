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

SAME_TIME = 1e-6  # of a sampling period: what rounding may leave between equal times


def on_one_clock(
    path: Path,
    time: FloatArray,
    values: FloatArray,
    inputs: Sequence[SignalDeclaration],
    outputs: Sequence[SignalDeclaration],
) -> tuple[FloatArray, FloatArray, tuple[Steps, ...]]:
    """Return the times [k] in s at which the outputs were measured, all signals [k, nu + ny] at
    them, and the steps of the inputs, from the `values` [n, nu + ny] that are logged at `time` [n].

    Samples for which a signal is not there yet, or no more, are left out. Raises InputError for an
    encoder that would be interpolated.
    """
    signals = (*inputs, *outputs)
    if not any(s.delay for s in signals):
        return time, values, ()
    leader = next((s for s in outputs if s.counts_per_revolution), outputs[0])
    late = [s.delay for s in inputs] + [-s.delay for s in outputs]
    rounding = SAME_TIME * float(np.median(np.diff(time)))
    clock = time - leader.delay
    there = clock >= time[0] + max(late) - rounding
    there &= clock <= time[-1] + min(late) + rounding
    clock = np.ascontiguousarray(clock[there])
    if len(clock) < 2:
        raise InputError(f"{path}: is shorter than the delays of its signals; give a longer log.")
    moved = delayed_inputs(time, values[:, : len(inputs)], inputs, clock)
    seen = [
        _output(path, time - s.delay, column, s, leader, clock)
        for s, column in zip(outputs, values[:, len(inputs) :].T, strict=True)
    ]
    steps = [
        (time + s.delay, column) if _samples_at(time + s.delay, clock) is None else (clock, acting)
        for s, column, acting in zip(inputs, values.T, moved.T, strict=False)
    ]
    return clock, np.column_stack([moved, *seen]), tuple(steps)


def delayed_inputs(
    time: FloatArray, values: FloatArray, inputs: Sequence[SignalDeclaration], clock: FloatArray
) -> FloatArray:
    """Return what acts on the machine from every time of `clock` [k] to the next, [k, nu], of the
    input `values` [n, nu] that are logged at `time` [n] in s and held. The first acts from ever.
    """
    edges = np.append(clock, 2.0 * clock[-1] - clock[-2])
    moved = []
    for signal, column in zip(inputs, values.T, strict=True):
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
    measured: FloatArray,
    column: FloatArray,
    signal: SignalDeclaration,
    leader: SignalDeclaration,
    clock: FloatArray,
) -> FloatArray:
    """An output at the times of `clock` [k], from its values at the times `measured` [n]."""
    at = _samples_at(measured, clock)
    if at is not None:
        return column[at]
    if signal.counts_per_revolution is not None:
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
