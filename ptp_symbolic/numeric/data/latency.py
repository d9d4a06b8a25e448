"""Signals that are logged late or act late: put on one clock, that of the motion.

Outputs that share a delay keep their samples, which move on the time axis as they are; others are
interpolated by cubics. Inputs keep the steps at which they really change, and are averaged from
sample to sample of that clock beside.
"""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.data.continuity import LOST
from ptp_symbolic.numeric.data.zero_order_hold import held_averages
from ptp_symbolic.platform import SignalDeclaration

FloatArray = NDArray[np.float64]
Steps = tuple[FloatArray, FloatArray]  # times in s, and the values that hold from them on
Series = tuple[FloatArray, FloatArray]  # times [n] in s, and what was logged at them [n]

SAME_TIME = 1e-6  # of a sampling period: what rounding may leave between equal times
AROUND = (-1, 0, 1, 2)  # the samples of a cubic, from the last one before its time on


def on_one_clock(
    path: Path,
    series: Sequence[Series],
    inputs: Sequence[SignalDeclaration],
    outputs: Sequence[SignalDeclaration],
) -> tuple[FloatArray, FloatArray, tuple[Steps, ...], tuple[str, ...]]:
    """Return the times [k] in s at which the outputs were measured, all signals [k, nu + ny] at
    them, the steps of the inputs, and the columns that were interpolated, from the `series` of
    every signal. The clock is that of the slowest encoder, of equally fast ones that of the first;
    an input acts from the time at which it was logged to the next.

    Samples for which a signal is not there yet, or no more, are left out, and those between which
    one that is interpolated was lost. Raises InputError where no sample is left.
    """
    signals = (*inputs, *outputs)
    given, measured = series[: len(inputs)], series[len(inputs) :]
    encoders = [k for k, s in enumerate(outputs) if s.count is not None]
    usual = {k: float(np.median(np.diff(measured[k][0]))) for k in encoders or [0]}
    at = next(k for k, own in usual.items() if (1.0 + LOST) * own > max(usual.values()))
    time, leader = measured[at][0], outputs[at]
    if not any(s.delay for s in signals) and all(own is time for own, _ in series):
        return time, np.column_stack([column for _, column in series]), (), ()
    late = [s.delay for s in inputs] + [-s.delay for s in outputs]
    period = usual[at]
    begin = max(own[0] + d for (own, _), d in zip(series, late, strict=True))
    end = min(own[-1] + d for (own, _), d in zip(measured, late[len(inputs) :], strict=True))
    for (own, _), d in zip(given, late, strict=False):
        held = max(float(np.median(np.diff(own))) - period, 0.0)  # the last value holds as long
        end = min(end, own[-1] + d + held)
    clock = time - leader.delay
    there = (clock >= begin - SAME_TIME * period) & (clock <= end + SAME_TIME * period)
    for (own, _), d in zip(measured, late[len(inputs) :], strict=True):
        there &= _between_neighbours(own + d, clock)
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
        interpolated(own - s.delay, column, clock)
        for s, (own, column) in zip(outputs, measured, strict=True)
    ]
    steps = [
        (own + s.delay, column) if _samples_at(own + s.delay, clock) is None else (clock, acting)
        for s, (own, column), acting in zip(inputs, given, moved.T, strict=True)
    ]
    between = tuple(
        s.column
        for s, (own, _) in zip(outputs, measured, strict=True)
        if _samples_at(own - s.delay, clock) is None
    )
    return clock, np.column_stack([moved, *seen]), tuple(steps), between


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


def interpolated(time: FloatArray, values: FloatArray, clock: FloatArray) -> FloatArray:
    """`values` [n], measured at `time` [n], at the times of `clock` [k]: the samples themselves
    where there is one at each, else of the cubics through four samples around (Lagrange).

    A cubic is off by h^4/43 of the fourth derivative at most, h the sampling period; where an
    acceleration jumps, as where friction turns, by h^2/28 of the jump. Rounding to counts is
    averaged: it leaves less than in the samples.
    """
    at = _samples_at(time, clock)
    if at is not None:
        return values[at]
    if len(time) < len(AROUND):
        return np.interp(clock, time, values)
    before = np.clip(np.searchsorted(time, clock, side="right") - 1, 1, len(time) - 3)
    nodes = [time[before + k] for k in AROUND]
    found = np.zeros(len(clock))
    for k, node in zip(AROUND, nodes, strict=True):
        others = [other for other in nodes if other is not node]
        weight = np.prod([(clock - other) / (node - other) for other in others], axis=0)
        found += weight * values[before + k]
    return found


def _between_neighbours(time: FloatArray, clock: FloatArray) -> NDArray[np.bool_]:
    """Whether no sample of `time` [n] was lost where each of `clock` [k] lies."""
    after = np.clip(np.searchsorted(time, clock), 1, len(time) - 1)
    step = np.diff(time)
    usual = (1.0 + LOST) * float(np.median(step))
    at_one = np.isclose(clock, time[after], rtol=0.0, atol=SAME_TIME * usual)
    at_one |= np.isclose(clock, time[after - 1], rtol=0.0, atol=SAME_TIME * usual)
    return at_one | (step[after - 1] <= usual)


def _samples_at(time: FloatArray, clock: FloatArray) -> NDArray[np.int64] | None:
    """Index of the sample at every time of `clock` [k], None where one lies between samples."""
    middle = 0.5 * (time[1:] + time[:-1])
    nearest = np.searchsorted(middle, clock)
    rounding = SAME_TIME * float(np.median(np.diff(time)))
    same = np.abs(time[nearest] - clock) <= rounding
    return nearest if bool(np.all(same)) else None
