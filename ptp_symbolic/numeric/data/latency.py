"""Signals that are logged late or act late: put on one clock, that of the motion.

Outputs that share a delay keep their samples, which move on the time axis as they are. Inputs are
averaged from sample to sample of that clock, or moved where the delay is a whole number of samples.
"""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.data.zero_order_hold import held_averages
from ptp_symbolic.platform import SignalDeclaration

FloatArray = NDArray[np.float64]

SAME_TIME = 1e-6  # of a sampling period: what rounding may leave between equal times


def on_one_clock(
    path: Path,
    time: FloatArray,
    values: FloatArray,
    inputs: Sequence[SignalDeclaration],
    outputs: Sequence[SignalDeclaration],
) -> tuple[FloatArray, FloatArray]:
    """Return the times [k] in s at which the outputs were measured, and all signals [k, nu + ny]
    at them, from the `values` [n, nu + ny] that are logged at `time` [n].

    Samples for which a signal is not there yet, or no more, are left out. Raises InputError for an
    encoder that would be interpolated.
    """
    signals = (*inputs, *outputs)
    if not any(s.delay for s in signals):
        return time, values
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
    return clock, np.column_stack([moved, *seen])


def delayed_inputs(
    time: FloatArray, values: FloatArray, inputs: Sequence[SignalDeclaration], clock: FloatArray
) -> FloatArray:
    """Return what acts on the machine from every time of `clock` [k] to the next, [k, nu], of the
    input `values` [n, nu] that are logged at `time` [n] in s and held. The first acts from ever.
    """
    edges = np.append(clock, 2.0 * clock[-1] - clock[-2])
    moved = []
    for signal, column in zip(inputs, values.T, strict=True):
        at = _samples_at(time + signal.delay, clock)
        moved.append(
            held_averages(time + signal.delay, column, edges) if at is None else column[at]
        )
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
