"""What an experiment is predicted to show: separation of every pair, intervals, curves.

What an experiment is worth: the separation of rival models, or the precision of parameters.

Separation: one model is taken for the machine, the other is fitted to what it would show, with all
that the logs so far know of it; by how much more it leaves than the first tells them apart
(T-optimality: Atkinson and Fedorov, 1975). Blocks of time with far more than noise count linearly,
as in a diagnosis: a run that tells by a few bounces alone tells little. Precision: the information
about parameters (D- and c-optimality).

Search for the input that is worth most: points spread over all families, then evolution.

The first third of the tries is a Latin hypercube in every family; differential evolution (Storn and
Price, 1997) goes on from the best points of the two families that promise most.

Shapes of inputs that a machine can play: functions of a point of the unit cube.
"""

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import asdict, dataclass
from itertools import combinations, permutations
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import differential_evolution
from scipy.stats import qmc

from ptp_symbolic.numeric.experiment.machine import (
    SCENARIOS,
    Conditions,
    Contender,
    Refit,
    Scenario,
    as_it_is,
    information,
    log_information,
    logged,
    play,
    refitted,
    spreads,
)
from ptp_symbolic.numeric.identify.blocks import huber_loss
from ptp_symbolic.numeric.identify.constants import TUNING
from ptp_symbolic.numeric.identify.coordinates import slopes
from ptp_symbolic.numeric.identify.evaluate import Evaluation
from ptp_symbolic.numeric.identify.least_squares import POLISH
from ptp_symbolic.numeric.identify.run import Run

FloatArray = NDArray[np.float64]


Worth = Callable[[FloatArray], float]

BLOCK = 0.5  # s; of time that is looked at as one
SEARCHING = 3  # iterations of a refit while inputs are searched for


@dataclass(frozen=True, eq=False)
class Comparison:
    """A `run` of one model as it would be logged, the `refit` of another to it, and by how much
    that leaves more, in squared sigmas: in the run and in the logs so far.
    """

    run: Run
    refit: Refit | None
    more: float


def compared(
    machine: Contender,
    other: Contender,
    conditions: Conditions,
    wave: FloatArray,
    how: Scenario,
    iterations: int,
) -> Comparison | None:
    """`other`, refitted to what `machine` shows along `wave` [k, nu] in a scenario and to the logs
    so far, against the machine itself; None where the limits are not kept.
    """
    true = how.machine(machine)
    played = play(true, conditions, wave, how.place)
    if played is None:
        return None
    run = logged(true, conditions, played, how.seed)
    own, found = as_it_is(true, run, how.place), refitted(other, run, how.place, iterations)
    if own is None or found is None:
        return Comparison(run, found, 0.0)
    left = robust_square(found.evaluation, run) + found.logs
    return Comparison(run, found, max(0.0, left - robust_square(own, run)))


def robust_square(evaluation: Evaluation, run: Run) -> float:
    """Expected sum of squares in squared sigmas, that of the noise included, of residuals that are
    predicted without it (Huber's loss of the mean squares of blocks of time).
    """
    table = evaluation.residual.reshape(run.measured.shape)
    blocks = max(1, round(float(run.time[-1] - run.time[0]) / BLOCK))
    total = 0.0
    for part in np.array_split(table, blocks):
        squares = 1.0 + np.mean(part**2, axis=0)
        total += len(part) * float(np.sum(huber_loss(squares, np.full(len(squares), TUNING**2))))
    return total


def least_separation(
    contenders: Sequence[Contender],
    conditions: Conditions,
    wave: FloatArray,
    iterations: int = SEARCHING,
    thorough: bool = False,
) -> float:
    """Sigmas by which the nearest two contenders are apart after the run `wave` [k, nu], those of
    the logs so far not counted, in the scenario that tells least; -inf where it does not keep to
    the limits.

    The earlier of two is taken for the machine, in two scenarios; to be `thorough` each in turn, in
    all.
    """
    pairs = permutations if thorough else combinations
    least = np.inf
    for machine, other in pairs(contenders, 2):
        for how in SCENARIOS if thorough else SCENARIOS[:2]:
            found = compared(machine, other, conditions, wave, how, iterations)
            if found is None:
                return -np.inf
            least = min(least, float(np.sqrt(found.more)))
    return least


def precision(
    machine: Contender, wanted: Sequence[str], conditions: Conditions, wave: FloatArray
) -> float:
    """Mean logarithm of the precision (1/sd in search coordinates) of the parameters `wanted`
    after the run `wave` [k, nu] and the logs so far; -inf where it does not keep to the limits.
    """
    played = play(machine, conditions, wave)
    if played is None:
        return -np.inf
    known = information(machine, logged(machine, conditions, played), 0.0)
    if known is None:
        return -np.inf
    names = [f.name for f in machine.free]
    return 0.5 * log_information(known, [names.index(name) for name in wanted]) / len(wanted)


@dataclass(frozen=True)
class Pair:
    """How far `other` is from what `machine` shows, in sigmas: on the logs so far (`before`), by
    the new run (`run`), and on both (`after`); and the shares of the squared error of `other` that
    `machine` takes away on the logs so far and on both; in the scenario that tells least. Zero
    where the logs so far speak for `other`.
    """

    machine: str
    other: str
    before: float
    run: float
    after: float
    share_before: float
    share_after: float

    def as_dict(self) -> dict[str, Any]:
        """As plain data."""
        return asdict(self)


def predicted_pairs(
    contenders: Sequence[Contender], conditions: Conditions, wave: FloatArray
) -> list[Pair]:
    """Every ordered pair after the run `wave` [k, nu]."""
    pairs = []
    for machine, other in permutations(contenders, 2):
        tried = [compared(machine, other, conditions, wave, how, POLISH) for how in SCENARIOS]
        runs = [found for found in tried if found is not None]
        if not runs:
            continue
        found = min(runs, key=lambda each: each.more)
        before = other.left - machine.left
        after = max(0.0, before + found.more)
        left = machine.left + found.run.size
        pairs.append(
            Pair(
                machine.name,
                other.name,
                float(np.sqrt(max(0.0, before))),
                float(np.sqrt(found.more)),
                float(np.sqrt(after)),
                max(0.0, before) / max(machine.left + before, 1.0),
                after / (left + after),
            )
        )
    return pairs


def predicted_spreads(
    contender: Contender, conditions: Conditions, wave: FloatArray
) -> dict[str, dict[str, Any]]:
    """Value, unit and standard deviation before and after the run `wave` [k, nu] of every free
    parameter of a contender; None where nothing is known.
    """
    before = spreads(contender, contender.memory.T @ contender.memory)
    played = play(contender, conditions, wave)
    known = (
        None
        if played is None
        else information(contender, logged(contender, conditions, played), 0.0)
    )
    after = before if known is None else spreads(contender, known)
    return {
        f.name: {
            "value": contender.values[f.name],
            "unit": contender.model.units[f.name],
            "sd_before": _finite(before[f.name]),
            "sd_after": _finite(after[f.name]),
        }
        for f in contender.free
    }


def _finite(value: float) -> float | None:
    return value if np.isfinite(value) else None


def predicted_curves(
    contenders: Sequence[Contender],
    wanted: Sequence[str],
    conditions: Conditions,
    wave: FloatArray,
) -> dict[str, Any]:
    """Time, inputs and outputs along `wave` [k, nu], and by output what tells: how far the second
    contender, refitted, is from the first; or the change by a tenth of each parameter `wanted`. In
    sigmas of the noise.
    """
    first = contenders[0]
    played = play(first, conditions, wave)
    assert played is not None
    run = logged(first, conditions, played)
    lines: Mapping[str, FloatArray]
    if wanted:
        lines = _changes(first, wanted, run)
    else:
        found = refitted(contenders[1], run, 0.0, POLISH)
        shape = run.measured.shape
        difference = np.zeros(shape) if found is None else found.evaluation.residual.reshape(shape)
        lines = {f"{first.name} minus {contenders[1].name}": difference}
    units = first.model.units
    return {
        "time": conditions.t,
        "inputs": {
            n: (units[n], c) for n, c in zip(first.model.input_names, played.inputs.T, strict=True)
        },
        "outputs": {n: (units[n], c) for n, c in zip(run.signals, run.measured.T, strict=True)},
        "tells": {
            name: {label: table[:, k] for label, table in lines.items()}
            for k, name in enumerate(run.signals)
        },
    }


def _changes(contender: Contender, wanted: Sequence[str], run: Run) -> dict[str, FloatArray]:
    """By name the change [k, ny], in sigmas, of what is measured by a tenth of a parameter."""
    found = as_it_is(contender, run, 0.0)
    assert found is not None
    units = np.abs(slopes(contender.free, contender.phi))
    changes = {}
    for k, f in enumerate(contender.free):
        if f.name in wanted:
            tenth = 0.1 * contender.values[f.name] / units[k]
            column = -tenth * found.by_parameter[:, k]
            changes[f"10 % of {f.name}"] = column.reshape(run.measured.shape)
    return changes


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
