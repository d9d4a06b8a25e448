"""Commands of the runs: voltages over time, and angles for a servo to track."""

import math

import numpy as np

from tests.benchmark.machine import Floats

TONES = (0.1, 0.23, 0.47, 0.81, 1.7, 3.1)  # Hz
ARC_TONES = (0.47, 0.81, 1.3, 1.7, 2.4, 3.1)  # Hz, where the arc is short


def times(duration: float, period: float) -> Floats:
    """Sample times [n] in s."""
    return np.arange(round(duration / period)) * period


def through(t: Floats, *points: tuple[float, float]) -> Floats:
    """Straight lines through (time in s, value); the last value goes on."""
    return np.interp(t, *np.array(points).T)


def multisine(t: Floats, rng: np.random.Generator, peak: float, short: bool = False) -> Floats:
    """Six tones of equal size that stay within `peak`, faded in over 0.3 s."""
    tones = np.array(ARC_TONES if short else TONES) * rng.uniform(0.95, 1.05, len(TONES))
    angles = 2 * math.pi * np.outer(t, tones) + rng.uniform(0, 2 * math.pi, len(TONES))
    wave = np.sin(angles).sum(axis=1)
    return np.minimum(t / 0.3, 1.0) * peak * wave / np.max(np.abs(wave))


def crawl(t: Floats, half: float, slow: float, fast: float) -> Floats:
    """Trapezoids of alternating sign, `half` s each, between the levels `slow` and `fast`."""
    number = (t // half).astype(int)
    inside = t - number * half
    level = slow + (fast - slow) * (number // 2 % 3) / 2
    sign = np.where(number % 2 == 0, 1.0, -1.0)
    return sign * level * np.clip(np.minimum(inside, half - inside) / 0.6, 0.0, 1.0)


def staircase(t: Floats, levels: tuple[float, ...], hold: float) -> Floats:
    """Levels of `hold` s each, from the start again after the last."""
    return np.array(levels)[(t // hold).astype(int) % len(levels)]


def slow_ramps(t: Floats, peak: float) -> Floats:
    """Ramps of different steepness one way, with rests of 0.1 to 1.6 s between them."""
    return through(
        t,
        *((0.0, 0.0), (0.3, 0.0), (1.8, 0.5 * peak), (1.81, 0.0), (2.6, 0.0), (3.2, 0.4 * peak)),
        *((3.21, 0.0), (3.3, 0.0), (4.6, peak), (6.0, peak), (6.01, 0.0), (7.6, 0.0)),
        *((7.9, 0.3 * peak), (8.4, 0.3 * peak), (8.41, 0.0)),
    )


def short_ramps(t: Floats, peak: float) -> Floats:
    """Ramps of both signs that stay on a short arc, with rests between them."""
    sign = np.where((t // 1.4).astype(int) % 2 == 0, 1.0, -1.0)
    inside = t % 1.4
    rest = 0.1 + 0.2 * ((t // 1.4).astype(int) % 4)
    return sign * peak * np.clip(inside - rest, 0.0, None) * (inside < 1.1)


def steps(t: Floats, peak: float) -> Floats:
    """A long step up, a rest, a shorter and lower step back."""
    return through(
        t,
        *((0.0, 0.0), (0.3, 0.0), (0.301, peak), (4.9, peak), (4.901, 0.0), (5.3, 0.0)),
        *((5.301, -0.5 * peak), (5.9, -0.5 * peak), (5.901, 0.0)),
    )


def short_steps(t: Floats, peak: float) -> Floats:
    """Steps of 0.25 s to both sides with rests between them."""
    number = (t // 0.6).astype(int)
    sign = np.where(number % 2 == 0, 1.0, -1.0)
    return sign * peak * ((t % 0.6) < 0.25) * (1.0 - 0.25 * (number // 2 % 3))


def trapezoids(t: Floats, peak: float) -> Floats:
    """A slow trapezoid forward and a fast one back."""
    return through(
        t,
        *((0.0, 0.0), (0.4, 0.0), (1.4, peak), (2.6, peak), (3.0, 0.0), (3.5, 0.0)),
        *((3.7, -0.8 * peak), (6.0, -0.8 * peak), (6.1, 0.0)),
    )
