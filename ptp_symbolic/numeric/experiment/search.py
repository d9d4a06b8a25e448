"""Search for the input that is worth most: points spread over all families, then evolution.

The first third of the tries is a Latin hypercube in every family; differential evolution (Storn and
Price, 1997) goes on from the best points of the two families that promise most.
"""

from collections.abc import Callable
from concurrent.futures import Executor
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import differential_evolution
from scipy.stats import qmc

from ptp_symbolic.numeric.experiment.families import FAMILIES, Family, with_rests

FloatArray = NDArray[np.float64]

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
