"""Angles that wrap at a turn or at the end of a counter, made continuous; gaps in the sampling."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.platform import SignalDeclaration

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.intp]

TURN = 2.0 * np.pi  # rad
COUNTER_BITS = (12, 14, 15, 16, 24, 32)  # of registers that count an encoder
LONG_PAUSE = 10.0  # sampling periods between two samples: what happens meanwhile is unknown
FEWEST = 10  # samples in a part between gaps
MEDIAN_TO_SIGMA = 1.4826  # of normal numbers: standard deviation over median deviation
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


def uninterrupted(time: FloatArray) -> list[slice]:
    """Parts of a log between gaps in its `time` [n] in s, without those of a few samples; all of it
    where every part is as short.
    """
    step = np.diff(time)
    return parted(time, np.flatnonzero(step > LONG_PAUSE * np.median(step)) + 1)


def after_lost(time: FloatArray) -> IntArray:
    """Samples before which others are missing in `time` [n] in s: they come later than usual by
    more than jitter may explain, which is taken from the median deviation of the sampling period.
    """
    step = np.diff(time) / np.median(np.diff(time))
    jitter = MEDIAN_TO_SIGMA * np.median(np.abs(step - 1.0))
    return np.flatnonzero(step > 1.0 + max(LOST, JITTERS * jitter)) + 1


def parted(time: FloatArray, gaps: IntArray) -> list[slice]:
    """Parts of `time` [n] that begin at `gaps`, without those of a few samples; all of it where
    every part is as short.
    """
    edges = [0, *gaps, len(time)]
    parts = [slice(int(a), int(b)) for a, b in pairwise(edges) if b - a >= FEWEST]
    return parts or [slice(0, len(time))]
