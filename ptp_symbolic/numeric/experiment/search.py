"""Search for the input that is worth most: points spread over all families, then evolution.

The first third of the tries is a Latin hypercube in every family; differential evolution (Storn and
Price, 1997) goes on from the best points of the two families that promise most.

Shapes of inputs that a machine can play: functions of a point of the unit cube.
"""

from collections.abc import Callable
from concurrent.futures import Executor
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import differential_evolution
from scipy.stats import qmc

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


FINALISTS = 4  # inputs that are looked at closely
LEAST_POPULATION = 5  # members that differential evolution needs
LARGEST_POPULATION = 12  # members: generations gain more than members here
KINDS = 2  # families that are searched to the end


@dataclass(frozen=True, eq=False)
class Found:
    """An input that was tried: its family, its wave [k, nu], and what it is worth."""

    family: str
    wave: FloatArray
    worth: float


def wave_of(family: Family, point: FloatArray, t: FloatArray, inputs: int) -> FloatArray:
    """Wave [k, nu] of a point [nu * size] of the unit cube, at rest at both ends."""
    parts = point.reshape(inputs, family.size)
    return np.column_stack([with_rests(family.shape(part, t), t) for part in parts])


def search(
    worth: Callable[[FloatArray], float],
    t: FloatArray,
    inputs: int,
    tries: int,
    seed: int,
    executor: Executor,
    progress: Callable[[int, Found], None],
) -> list[Found]:
    """Inputs at sample times `t` [k] in s, the best first, of so many `tries` (at least 60).

    `worth` of a wave [k, inputs] is -inf where it cannot be played. `progress` is told the number
    of inputs tried and the best so far.
    """
    rng = np.random.default_rng(seed)
    every: list[Found] = []
    best: dict[str, list[tuple[FloatArray, Found]]] = {}

    def tried(family: Family, points: FloatArray) -> list[Found]:
        waves = [wave_of(family, point, t, inputs) for point in points]
        values = executor.map(worth, waves)
        found = [Found(family.name, w, v) for w, v in zip(waves, values, strict=True)]
        every.extend(found)
        progress(len(every), max(every, key=lambda f: f.worth))
        return found

    first = max(LEAST_POPULATION, tries // (3 * len(FAMILIES)))
    for family in FAMILIES:
        points = qmc.LatinHypercube(family.size * inputs, seed=rng).random(first)
        pairs = list(zip(points, tried(family, points), strict=True))
        best[family.name] = sorted(pairs, key=lambda pair: -pair[1].worth)
    ranked = sorted(FAMILIES, key=lambda family: -best[family.name][0][1].worth)
    each = (tries - len(every)) // KINDS
    population = min(max(LEAST_POPULATION, first // 2), LARGEST_POPULATION)
    for family in ranked[:KINDS]:
        begin = np.array([point for point, _ in best[family.name][:population]])

        def loss(points: FloatArray, family: Family = family) -> FloatArray:
            return -np.array([f.worth for f in tried(family, points.T)])

        differential_evolution(
            loss,
            [(0.0, 1.0)] * (family.size * inputs),
            init=begin,
            maxiter=max(1, each // population - 1),
            tol=0.0,
            polish=False,
            vectorized=True,
            updating="deferred",
            seed=rng,
        )
    return sorted(every, key=lambda f: -f.worth)[:FINALISTS]
