"""Signals that are logged late or act late: put on one clock, that of the motion.

Outputs that share a delay keep their samples, which move on the time axis as they are; others are
interpolated. Inputs keep the steps at which they really change, and are averaged from sample to
sample of that clock beside.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.data.between_samples import SAME_TIME, IntArray, Samples
from ptp_symbolic.numeric.data.zero_order_hold import held_averages
from ptp_symbolic.platform import SignalDeclaration

FloatArray = NDArray[np.float64]
Steps = tuple[FloatArray, FloatArray]  # times in s, and the values that hold from them on
Series = tuple[FloatArray, FloatArray]  # times [n] in s, and what was logged at them [n]

SLOWER = 1.5  # times the period of another: a clock of its own, not the same one


@dataclass(frozen=True, eq=False)
class Clocked:
    """All signals at one clock: the times [k] in s at which the outputs were measured, `values`
    [k, nu + ny] at them, and the `steps` of the inputs. `interpolated` are the columns of outputs
    between samples, each with how far it may be off where the motion changes suddenly; `thinned`
    those of which samples are left out, each with how many times as fast it was logged.
    """

    time: FloatArray
    values: FloatArray
    steps: tuple[Steps, ...] = ()
    interpolated: dict[str, float] = field(default_factory=dict)
    thinned: dict[str, float] = field(default_factory=dict)


def on_one_clock(
    path: Path,
    series: Sequence[Series],
    inputs: Sequence[SignalDeclaration],
    outputs: Sequence[SignalDeclaration],
) -> Clocked:
    """Put the `series` of every signal on the clock of the slowest encoder, of about equally fast
    ones that of the first; an input acts from the time at which it was logged to the next.

    Samples for which a signal is not there yet, or no more, are left out, and those at which one
    that is interpolated lacks samples, or jumps. Raises InputError where less than two are left.
    """
    given, measured = series[: len(inputs)], series[len(inputs) :]
    leader = _leading(outputs, measured)
    time = measured[leader][0]
    is_shared = all(own is time for own, _ in series)
    if is_shared and not any(s.delay for s in (*inputs, *outputs)):
        return Clocked(time, np.column_stack([column for _, column in series]))
    seen = [
        Samples(own - s.delay, column, s.count)
        for s, (own, column) in zip(outputs, measured, strict=True)
    ]
    acting = [own + s.delay for s, (own, _) in zip(inputs, given, strict=True)]
    clock = _common(path, acting, seen, seen[leader].time, is_shared)
    moved = delayed_inputs(given, inputs, clock)
    steps = tuple(
        (acts, column) if _all_at(acts, clock) is None else (clock, at_clock)
        for acts, (_, column), at_clock in zip(acting, given, moved.T, strict=True)
    )
    return Clocked(
        clock,
        np.column_stack([moved, *(samples.at(clock) for samples in seen)]),
        steps,
        {
            s.column: samples.uncertainty
            for s, samples in zip(outputs, seen, strict=True)
            if samples.places(clock) is None
        },
        {
            s.column: _usual(clock) / _usual(samples.time)
            for s, samples in zip(outputs, seen, strict=True)
            if _usual(clock) > SLOWER * _usual(samples.time)
        },
    )


def _leading(outputs: Sequence[SignalDeclaration], measured: Sequence[Series]) -> int:
    """The output whose clock is kept: the first of the slowest encoders, else the first."""
    encoders = [k for k, s in enumerate(outputs) if s.count is not None] or [0]
    period = {k: _usual(measured[k][0]) for k in encoders}
    return next(k for k in encoders if SLOWER * period[k] > max(period.values()))


def _common(
    path: Path,
    acting: Sequence[FloatArray],
    seen: Sequence[Samples],
    clock: FloatArray,
    is_shared: bool,
) -> FloatArray:
    """The times of `clock` at which every input acts, since `acting`, and every output is known;
    `is_shared` tells whether all were logged at the same times.
    """
    period = _usual(clock)
    begin = max(times[0] for times in (*acting, *(s.time for s in seen)))
    end = min(s.time[-1] for s in seen)
    for times in acting:  # the last value holds as long as the others
        end = min(end, times[-1] + max(_usual(times) - period, 0.0))
    there = (clock >= begin - SAME_TIME * period) & (clock <= end + SAME_TIME * period)
    known = there & np.all([samples.is_known(clock) for samples in seen], axis=0)
    if there.sum() < 2:
        raise InputError(
            f"{path}: is shorter than the delays of its signals; give a longer log."
            if is_shared
            else f"{path}: there is no time at which all signals are logged; give parts of one run"
            " with one clock."
        )
    if known.sum() < 2:
        raise InputError(
            f"{path}: samples are missing or jump wherever its signals, measured at different"
            " times, are put on one clock; give a log without gaps."
        )
    return np.ascontiguousarray(clock[known])


def _usual(time: FloatArray) -> float:
    """The sampling period in s."""
    return float(np.median(np.diff(time)))


def _all_at(acts: FloatArray, clock: FloatArray) -> IntArray | None:
    """Which of the times `acts` [n] every time of `clock` [k] is; None where one is none of them,
    and where one of them lies between.
    """
    at = Samples(acts, acts).places(clock)
    return None if at is None or bool(np.any(np.diff(at) > 1)) else at


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
        at = _all_at(acts, clock)
        if at is None:
            at = np.maximum(np.searchsorted(acts, edges, side="right") - 1, 0)
            changes = column[at[1:]] != column[at[:-1]]
            averages = held_averages(acts, column, edges)
            moved.append(np.where(changes | (np.diff(at) > 1), averages, column[at[:-1]]))
        else:
            moved.append(column[at])
    return np.column_stack([np.empty((len(clock), 0)), *moved])
