"""Signals that are logged late or act late: put on one clock, that of the motion.

Outputs that share a delay keep their samples, which move on the time axis as they are; others are
interpolated. Inputs that are held keep the steps at which they really change, and are averaged from
sample to sample of that clock beside; those that are measured have straight lines between samples.

What a signal was between its samples: by cubics, not over lost samples, and not over jumps.

Averages of an input between given times: of its steps, or of the lines between its samples.

Angles that wrap at a turn or at the end of a counter, made continuous; gaps in the sampling.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import maximum_filter

from ptp_symbolic.errors import InputError
from ptp_symbolic.platform import SignalDeclaration

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.intp]


TURN = 2.0 * np.pi  # rad
COUNTER_BITS = (12, 14, 15, 16, 24, 32)  # of registers that count an encoder
LONG_PAUSE = 10.0  # sampling periods between two samples: what happens meanwhile is unknown
FEWEST = 10  # samples in a part between gaps
MEDIAN_TO_SIGMA = 1.4826  # of normal numbers: standard deviation over median deviation
BESIDE = 5  # samples before and after a jump
LONE = 20.0  # times what is beside it: what no machine does within a sample
BACK = 0.4  # of a change of the rate that the next one does not take back, at most
FASTER = 3.0  # times the largest rate elsewhere, which a machine does not reach for one sample
STILL = 3.0  # counts from one sample to the next, of a machine that rests
LOST = 0.5  # sampling periods later than usual, halfway to the next: a sample is missing
JITTERS = 4.0  # standard deviations of the sampling period that jitter seldom reaches
LONGEST_STEP = 0.5 * np.pi  # rad from one sample to the next: beyond it a wrap is ambiguous


@dataclass(frozen=True)
class Wraps:
    """How often an angle wrapped, and by how much in rad."""

    column: str
    count: int
    span: float


def unwrapped(values: FloatArray, signal: SignalDeclaration) -> tuple[FloatArray, Wraps | None]:
    """`values` [n] of an angle in rad without the steps of a turn, or of a counter that ran over.

    A step of more than half a turn is taken for a wrap where one span (a turn, or 2^k counts)
    leaves less than a quarter of a turn of every such step; else the values stay as they are.
    """
    step = np.diff(values)
    large = np.abs(step) > 0.5 * TURN
    if signal.unit != "rad" or not large.any():
        return values, None
    spans = [TURN]
    if signal.counts_per_revolution:
        spans += [2.0**bits * TURN / signal.counts_per_revolution for bits in COUNTER_BITS]
    for span in spans:
        turns = np.where(large, np.rint(step / span), 0.0)
        rest = step - span * turns
        if np.all(np.abs(turns[large]) == 1.0) and np.all(np.abs(rest[large]) < LONGEST_STEP):
            whole = values.copy()
            whole[1:] -= span * np.cumsum(turns)
            return whole, Wraps(signal.column, int(large.sum()), span)
    return values, None


def pauses(time: FloatArray) -> IntArray:
    """Samples before which nothing was logged for long, in `time` [n] in s."""
    step = np.diff(time)
    return np.flatnonzero(step > LONG_PAUSE * np.median(step)) + 1


def after_lost(time: FloatArray) -> IntArray:
    """Samples before which others are missing in `time` [n] in s: they come later than usual by
    more than jitter may explain, which is taken from the median deviation of the sampling period.
    """
    step = np.diff(time) / np.median(np.diff(time))
    jitter = MEDIAN_TO_SIGMA * np.median(np.abs(step - 1.0))
    return np.flatnonzero(step > 1.0 + max(LOST, JITTERS * jitter)) + 1


def jumps(values: FloatArray, time: FloatArray, count: float) -> IntArray:
    """Samples at which an angle `values` [n] at `time` [n] in s jumps and goes on as before: its
    encoder was set anew, or a sample is wrong. `count` is its resolution.

    The rate changes and changes back at once, far more than beside it, to more than the machine
    reaches elsewhere; an impact changes it once. One that rests elsewhere may slip.
    """
    rate, period = np.diff(values) / np.diff(time), float(np.median(np.diff(time)))
    change = np.diff(rate) * period
    if len(change) <= 2 * BESIDE:
        return np.zeros(0, dtype=np.intp)
    here, after = change[:-1], change[1:]
    apart = np.r_[np.ones(BESIDE), np.zeros(4), np.ones(BESIDE)] > 0.0
    around = maximum_filter(np.abs(change), footprint=apart, mode="constant", origin=-1)[:-1]
    size = 0.5 * np.abs(here - after)
    is_back = np.abs(here + after) <= BACK * np.abs(here - after)
    lone = np.flatnonzero(is_back & (size > LONE * np.maximum(around, count)))
    usual = np.ones(len(rate), dtype=bool)
    for k in range(-1, 4):
        usual[np.clip(lone + k, 0, len(rate) - 1)] = False
    farthest = float(np.max(np.abs(rate[usual]), initial=0.0)) * period
    if farthest <= STILL * count:
        return np.zeros(0, dtype=np.intp)
    return lone[size[lone] > FASTER * farthest] + 2


def parted(time: FloatArray, gaps: IntArray) -> list[slice]:
    """Parts of `time` [n] that begin at `gaps`, without those of a few samples; all of it where
    every part is as short.
    """
    edges = [0, *gaps, len(time)]
    parts = [slice(int(a), int(b)) for a, b in pairwise(edges) if b - a >= FEWEST]
    return parts or [slice(0, len(time))]


def input_averages(
    time: FloatArray, values: FloatArray, edges: FloatArray, interpolation: str = "hold"
) -> FloatArray:
    """Averages [m] between neighbouring `edges` [m + 1] in s of the input that has the `values` [n]
    at `time` [n] in s, and by its `interpolation` ("hold" or "linear") between them; before the
    first sample and after the last it is constant.
    """
    period, is_linear = np.diff(time), interpolation == "linear" and len(time) > 1
    middle = 0.5 * (values[:-1] + values[1:]) if is_linear else values[:-1]
    integral = np.concatenate([[0.0], np.cumsum(middle * period)])
    at = np.interp(edges, time, integral)
    if is_linear:
        inside = np.clip(edges, time[0], time[-1])
        k = np.clip(np.searchsorted(time, inside, side="right") - 1, 0, len(time) - 2)
        since, slope = inside - time[k], np.diff(values)[k] / period[k]
        at += 0.5 * slope * since * (since - period[k])
    at += np.where(edges < time[0], (edges - time[0]) * values[0], 0.0)
    at += np.where(edges > time[-1], (edges - time[-1]) * values[-1], 0.0)
    return np.asarray(np.diff(at) / np.diff(edges))


SAME_TIME = 1e-6  # of a sampling period: what rounding may leave between equal times
NEXT, OVER_NEXT = (-1, 0, 1, 2), (-3, -1, 1, 3)  # the samples around a time, around a sample
MOST_SCATTER = 1.1  # of a cubic over that of samples; at the ends of parts it is up to 1.09
NOISY = 5.0  # standard deviations that noise seldom reaches
WIDER = 2.0  # sampling periods between the samples that foretell one


@dataclass(frozen=True, eq=False)
class Samples:
    """`values` [n] at `time` [n] in s; those of an encoder have the resolution `count`."""

    time: FloatArray
    values: FloatArray
    count: float | None = None

    @cached_property
    def part(self) -> IntArray:
        """The number [n] of the part of every sample: parts begin after lost samples and jumps."""
        breaks = after_lost(self.time)
        if self.count is not None:
            breaks = np.union1d(breaks, jumps(self.values, self.time, self.count))
        begins = np.zeros(len(self.time), dtype=np.intp)
        begins[breaks] = 1
        return np.cumsum(begins)

    def places(self, clock: FloatArray) -> IntArray | None:
        """Index of the sample at every time of `clock` [k], None where one lies between samples."""
        nearest = self._nearest(clock)
        return nearest if bool(np.all(self._is_at(nearest, clock))) else None

    def is_known(self, clock: FloatArray) -> NDArray[np.bool_]:
        """Whether there is a sample at every time of `clock` [k], or on either side in one part."""
        after = np.clip(np.searchsorted(self.time, clock), 1, len(self.time) - 1)
        is_inside = (clock >= self.time[0]) & (clock <= self.time[-1])
        same = self.part[after - 1] == self.part[after]
        return self._is_at(self._nearest(clock), clock) | (is_inside & same)

    def at(self, clock: FloatArray) -> FloatArray:
        """The values at the times of `clock` [k], each of which `is_known`.

        Of the samples themselves where there is one at each time, else of the cubics through four
        samples around (Lagrange); of straight lines where a cubic would scatter more than samples
        do, next to one that came early or late, and in parts of less than four. At a sampling
        period h a cubic is off by h^4/43 of the fourth derivative at most, at the ends of parts by
        h^4/24; where an acceleration jumps, as friction turns, by h^2/28 of the jump.
        """
        at = self.places(clock)
        if at is not None:
            return self.values[at]
        before = np.clip(np.searchsorted(self.time, clock, side="right") - 1, 0, len(self.time) - 2)
        first = np.searchsorted(self.part, self.part[before], side="left")
        last = np.searchsorted(self.part, self.part[before], side="right") - 1
        is_long = last - first >= len(NEXT) - 1
        middle = np.minimum(np.maximum(before, first + 1), last - 2)
        middle = np.clip(middle, 1, len(self.time) - 3)
        found, scatter = self._cubics(middle, NEXT, clock)
        straight = np.interp(clock, self.time, self.values)
        return np.where(is_long & (scatter <= MOST_SCATTER), found, straight)

    @cached_property
    def uncertainty(self) -> float:
        """How far cubics are off where the motion changes suddenly, beyond noise, to a factor of a
        few: half of how far each sample is off a cubic through those one and three periods away.
        These are twice as far apart, which doubles the error where a rate jumps, and quadruples it
        where an acceleration does.
        """
        own = np.arange(-OVER_NEXT[0], len(self.time) - OVER_NEXT[-1])
        own = own[self.part[own + OVER_NEXT[0]] == self.part[own + OVER_NEXT[-1]]]
        found, scatter = self._cubics(own, OVER_NEXT, self.time[own])
        off = np.abs(found - self.values[own])[scatter <= MOST_SCATTER]
        if not len(off):
            return 0.0
        noise = NOISY * MEDIAN_TO_SIGMA * float(np.median(off))
        return max(float(off.max()) - noise, 0.0) / WIDER

    def _cubics(
        self, middle: IntArray, around: tuple[int, ...], clock: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Values [k] at the times of `clock` [k] of the cubics through the samples `around` each of
        `middle` [k], and how much more they scatter than samples that do so independently.
        """
        nodes = middle[:, None] + np.array(around)
        times = self.time[nodes]
        weights = np.ones(times.shape)
        for own in range(len(around)):
            for other in range(len(around)):
                if other != own:
                    weights[:, own] *= clock - times[:, other]
                    weights[:, own] /= times[:, own] - times[:, other]
        values = np.sum(weights * self.values[nodes], axis=1)
        return values, np.sqrt(np.sum(weights**2, axis=1))

    def _nearest(self, clock: FloatArray) -> IntArray:
        return np.searchsorted(0.5 * (self.time[1:] + self.time[:-1]), clock)

    def _is_at(self, nearest: IntArray, clock: FloatArray) -> NDArray[np.bool_]:
        rounding = SAME_TIME * float(np.median(np.diff(self.time)))
        return np.abs(self.time[nearest] - clock) <= rounding


Steps = tuple[FloatArray, FloatArray]  # times in s, and the values that hold from them on
Series = tuple[FloatArray, FloatArray]  # times [n] in s, and what was logged at them [n]

SLOWER = 1.5  # times the period of another: a clock of its own, not the same one


@dataclass(frozen=True, eq=False)
class Clocked:
    """All signals at one clock: the times [k] in s at which the outputs were measured, `values`
    [k, nu + ny] at them, and the `steps` of the inputs (samples of those with lines between).
    `interpolated` are the columns of outputs between samples, each with how far it may be off where
    the motion changes suddenly; `thinned` those of which samples are left out, each with how many
    times as fast it was logged.
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
    ones that of the first; an input that is held acts from the time at which it was logged to the
    next.

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
    `series` of inputs that are held from sample to sample, and what acts at it of others. The first
    acts from ever.
    """
    edges = np.append(clock, 2.0 * clock[-1] - clock[-2])
    moved = []
    for signal, (time, column) in zip(inputs, series, strict=True):
        acts = time + signal.delay
        at = _all_at(acts, clock)
        if at is None and signal.between_samples == "linear":
            moved.append(np.interp(clock, acts, column))
        elif at is None:
            at = np.maximum(np.searchsorted(acts, edges, side="right") - 1, 0)
            changes = column[at[1:]] != column[at[:-1]]
            averages = input_averages(acts, column, edges)
            moved.append(np.where(changes | (np.diff(at) > 1), averages, column[at[:-1]]))
        else:
            moved.append(column[at])
    return np.column_stack([np.empty((len(clock), 0)), *moved])
