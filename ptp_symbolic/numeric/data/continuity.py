"""Angles that wrap at a turn or at the end of a counter, made continuous; gaps in the sampling."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import maximum_filter

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
