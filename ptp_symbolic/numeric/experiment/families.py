"""Shapes of inputs that a machine can play: functions of a point of the unit cube."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

TONES = 6  # of a multisine
LEVELS = 12  # of a staircase, and corners of ramps
HIGHEST = 0.05  # of the sampling rate; highest tone: 20 samples per period
REST = 0.2  # s; at both ends, so that the start is known and the machine stops


@dataclass(frozen=True)
class Family:
    """Inputs of one kind: `shape(point [size], t [k] in s)` is in -1 to 1 of the limits."""

    name: str
    size: int
    shape: Callable[[FloatArray, FloatArray], FloatArray]


def multisine(point: FloatArray, t: FloatArray) -> FloatArray:
    """Tones of any frequency, size (squared: a few rule) and phase; the last coordinate is the size
    of the whole.
    """
    frequency, size, phase = point[:-1].reshape(3, TONES)
    period, duration = t[1] - t[0], t[-1] - t[0]
    low, high = np.log(1.0 / duration), np.log(max(HIGHEST / period, 2.0 / duration))
    angles = np.outer(t, np.exp(low + frequency * (high - low))) + phase
    wave = np.sin(2.0 * np.pi * angles) @ size**2
    return _scaled(wave, point[-1])


def staircase(point: FloatArray, t: FloatArray) -> FloatArray:
    """Levels, each held for the same time."""
    number = (t - t[0]) / (t[-1] - t[0]) * LEVELS
    return 2.0 * point[np.minimum(number.astype(np.int64), LEVELS - 1)] - 1.0


def ramps(point: FloatArray, t: FloatArray) -> FloatArray:
    """Straight lines through corners that are equally far apart."""
    return 2.0 * np.interp(t, np.linspace(t[0], t[-1], LEVELS), point) - 1.0


def reversals(point: FloatArray, t: FloatArray) -> FloatArray:
    """Trapezoids of alternating sign that become faster or slower, larger or smaller.

    Coordinates: periods and sizes at both ends, share of the slopes, offset.
    """
    part = (t - t[0]) / (t[-1] - t[0])
    duration = t[-1] - t[0]
    longest, shortest = np.log(duration), np.log(min(0.2, 0.1 * duration))
    ends = longest + point[:2] * (shortest - longest)
    rate = np.exp(-(ends[0] + part * (ends[1] - ends[0])))
    angle = np.concatenate([[0.0], np.cumsum(0.5 * (rate[1:] + rate[:-1]) * np.diff(t))])
    triangle = 2.0 / np.pi * np.arcsin(np.sin(2.0 * np.pi * angle))
    wave = np.clip(triangle / max(point[4], 0.02), -1.0, 1.0)
    size = point[2] + part * (point[3] - point[2])
    return np.asarray(np.clip(wave * size + 0.5 * (2.0 * point[5] - 1.0), -1.0, 1.0))


FAMILIES = (
    Family("multisine", 3 * TONES + 1, multisine),
    Family("staircase", LEVELS, staircase),
    Family("ramps", LEVELS, ramps),
    Family("reversals", 6, reversals),
)


def with_rests(wave: FloatArray, t: FloatArray) -> FloatArray:
    """`wave` [k] at zero for a moment at both ends."""
    rest = min(REST, 0.1 * float(t[-1] - t[0]))
    inside = (t - t[0] >= rest) & (t[-1] - t >= rest)
    return np.asarray(np.where(inside, wave, 0.0))


def _scaled(wave: FloatArray, size: float) -> FloatArray:
    return np.asarray(size * wave / max(float(np.max(np.abs(wave))), 1e-300))
