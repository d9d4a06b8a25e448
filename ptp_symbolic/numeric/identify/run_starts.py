"""The start unknowns of runs at given parameters: there no run depends on another, but for windows.

What no sensor shows at the start of a window, where a gear stands in its gap and how fast it turns,
the window before it tells: its simulation ends there. Guessed from the angles around, 18 of 129
windows of 1 s on three drives that rattle, at their true parameters, ended on the wrong side of the
gap (five of them from where the one before ended), and parameters pay for that.
"""

from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.identify.constants import (
    ABOVE_NOISE,
    BINS,
    FAR,
    ITERATIONS,
    MATERIAL,
    ROUGH,
)
from ptp_symbolic.numeric.identify.evaluate import Tolerance, start_state
from ptp_symbolic.numeric.identify.evidence import recorded
from ptp_symbolic.numeric.identify.gap_places import gears_in_place, residual_of, with_gap_places
from ptp_symbolic.numeric.identify.least_squares import Optimum, Problem, cost_of, minimise
from ptp_symbolic.numeric.identify.run import Run
from ptp_symbolic.numeric.identify.simulations import Effort, problem_of, simulations_of
from ptp_symbolic.numeric.runtime.model import Model

FloatArray = NDArray[np.float64]


@recorded()
def starts_in_place(
    model: Model,
    runs: Sequence[Run],
    values: Mapping[str, float],
    z: Sequence[FloatArray],
    tolerance: Tolerance,
    executor: Executor | None,
    *,
    brief: bool = False,
    usual: float = 1.0,
) -> list[FloatArray]:
    """The start unknowns `z`, each [nz], of every run with what its sensors do not show in place
    for the parameter `values`: the gears of a whole run in their gaps, and windows that follow one
    another begun where the one before ended; of these the first few iterations of a fit as well,
    one if `brief`. `usual` is that of `fitted_starts`. Raises InputError for values out of bounds.
    """
    if not has_linked(runs):
        return gears_in_place(model, runs, values, z, tolerance, executor)
    effort = Effort(1 if brief else ITERATIONS, MATERIAL * ROUGH, tolerance)
    known = [[start] for start in z]
    found = fitted_starts(model, runs, values, known, effort, executor, brief=brief, usual=usual)
    return [optimum.z[0] for optimum in found]


def fitted_starts(
    model: Model,
    runs: Sequence[Run],
    values: Mapping[str, float],
    known: Sequence[Sequence[FloatArray]],
    effort: Effort,
    executor: Executor | None,
    *,
    brief: bool = False,
    usual: float = 1.0,
) -> list[Optimum]:
    """The start of every run fitted by itself, from the best of those `known` of it, of its guesses
    with the gears in place, and of the end of the window before it; and from the next, unless no
    more is left than noise or than the `usual` mean square of all runs, or the search is `brief`.
    Raises InputError for values out of bounds.
    """
    most = ABOVE_NOISE * max(1.0, usual)
    search = _Starts(model, values, model.parameter_vector(dict(values)), effort, most, brief)

    def one_after_the_other(series: Sequence[int]) -> list[Optimum]:
        found: list[Optimum] = []
        for k in series:
            before = found[-1] if found else None
            found.append(search.fitted(runs[k], known[k], before, in_series=len(series) > 1))
        return found

    order = sorted(linked(runs), key=lambda series: -sum(runs[k].size for k in series))
    every = (executor.map if executor else map)(one_after_the_other, order)
    by_run = {
        k: optimum
        for series, optima in zip(order, every, strict=True)
        for k, optimum in zip(series, optima, strict=True)
    }
    return [by_run[k] for k in range(len(runs))]


@dataclass(frozen=True, eq=False)
class _Starts:
    """A search for the starts of runs at the parameters `values`, as a vector `p` [np]; `most` is
    the mean square of a run at which no other start of it is tried.
    """

    model: Model
    values: Mapping[str, float]
    p: FloatArray
    effort: Effort
    most: float
    brief: bool

    def fitted(
        self,
        run: Run,
        known: Sequence[FloatArray],
        before: Optimum | None,
        *,
        in_series: bool,
    ) -> Optimum:
        """The best fit of a run's start; `before` is that of the window before it. The first window
        of a series that leaves more than that is begun at other places in its gaps too.
        """
        simulations = simulations_of(self.model, [run], (), self.values, self.effort, None)
        problem = problem_of(simulations, self.effort)
        most = self.most * run.size
        found: list[Optimum] = []
        if before is not None and before.evaluations[0].end is not None:
            end = before.evaluations[0].end
            found.append(self._from(problem, carried_start(self.model, run, self.p, end)))
            if found[-1].cost <= most:
                return found[-1]
        simulated = partial(residual_of, self.model, self.p, self.effort.tolerance, run)
        guesses = run.guesses[:1] if found and self.brief else run.guesses
        starts = _by_cost(problem, [*(with_gap_places(run, s, simulated) for s in guesses), *known])
        if in_series and not found and not self.brief and starts[0][0] > most:
            starts = [*_elsewhere(run, problem, *starts[0]), *starts]
        for _, start in starts[:1] if self.brief else starts:
            found.append(self._from(problem, start))
            if found[-1].cost <= most:
                break
        return min(found, key=lambda optimum: optimum.cost)

    def _from(self, problem: Problem, start: FloatArray) -> Optimum:
        return minimise(problem, np.zeros(0), [start], self.effort.iterations, self.effort.gain)


def _by_cost(problem: Problem, starts: Sequence[FloatArray]) -> list[tuple[float, FloatArray]]:
    """`starts`, each [nz], with their costs, the least first."""

    def cost(start: FloatArray) -> float:
        return cost_of(problem, problem.evaluate(np.zeros(0), [start], False), [start])

    return sorted(((cost(start), start) for start in starts), key=lambda pair: pair[0])


def _elsewhere(
    run: Run, problem: Problem, cost: float, best: FloatArray
) -> list[tuple[float, FloatArray]]:
    """A start with the gear at the best of many places in its gap, one gap after the other, with
    its cost, from a start of some `cost`; none where no other place is better.
    """
    found: list[tuple[float, FloatArray]] = []
    for index, unknown in enumerate(run.unknowns):
        if unknown.contact is not None:
            places = [best.copy() for _ in range(2 * BINS + 1)]
            for start, place in zip(places, np.linspace(-1.0, 1.0, len(places)), strict=True):
                start[index] = place
            other = _by_cost(problem, places)[0]
            if other[0] < cost:
                cost, best = other
                found = [other]
    return found


def linked(runs: Sequence[Run]) -> list[list[int]]:
    """Indices of the runs: windows that begin with the last sample of the one before, and have a
    gap of which no sensor tells the place, together; all others alone.
    """
    series: list[list[int]] = []
    for index, run in enumerate(runs):
        if series and _follows(run, runs[series[-1][-1]]):
            series[-1].append(index)
        else:
            series.append([index])
    return series


def has_linked(runs: Sequence[Run]) -> bool:
    """Whether any run is a window that follows another (see `linked`)."""
    return len(linked(runs)) < len(runs)


def _follows(run: Run, before: Run) -> bool:
    return (
        run.source == before.source
        and run.time[0] == before.time[-1]
        and any(unknown.contact is not None for unknown in run.unknowns)
    )


def carried_start(model: Model, run: Run, p: FloatArray, end: FloatArray) -> FloatArray:
    """Start unknowns [nz] of a window, at p [np], with all that is hidden as it was in the state
    `end` [n] of the one before. What sensors show is as it was too, as far as the noise of the
    guess allows: a joint that came to rest rests.
    """
    states, z = list(model.state_names), run.guess
    for index, unknown in enumerate(run.unknowns):
        if unknown.contact is not None:
            z[index] = 0.0
            z[index] = _place(model, run, p, z, index, unknown.contact, end)
        elif unknown.name.startswith("omega_gear_"):
            gear = states.index(unknown.name)
            joint = states.index(unknown.name.replace("omega_gear_", "omega_"))
            z[index] = (end[gear] - end[joint]) - (run.start[gear] - run.start[joint])
        else:
            state = states.index(unknown.name)
            moved = float(end[state] - run.start[state])
            z[index] = moved if abs(moved) <= FAR * unknown.sigma else 0.0
    return z


def _place(
    model: Model,
    run: Run,
    p: FloatArray,
    z: FloatArray,
    index: int,
    contact: int,
    end: FloatArray,
) -> float:
    """Place in the gap of a `contact`, unknown `index` of z, at which the gear is as far ahead of
    its joint as at the `end`; the middle of a gap that has no width. `z` has the gear in the
    middle, and all unknowns of its joint.
    """
    unknown = run.unknowns[index]
    gear, joint = model.module.CONTACT_ANGLES[contact]
    x, tangents = start_state(model, run, p, z, np.zeros(0, dtype=np.int64))
    ahead = (end[gear] - end[joint]) - (x[gear] - x[joint])
    half = tangents[gear, index]
    return float(np.clip(ahead / half, unknown.lower, unknown.upper)) if half > 0.0 else 0.0
