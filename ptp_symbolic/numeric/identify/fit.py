"""Fit the free parameters of a model to several runs at once, and the initial states of the runs.

The place of a gear in its gap at the start of a run is measured by no sensor. The gear stays ahead
of where it was thought to be by the same angle ever after, and the joint follows it: the median of
the residual of its angle falls with the place, almost in a straight line. The sum of squares is
rough in it, for bounces and rests change with the place, which is therefore the root of the median
(Brent, 1973), not a least square.

The initial state of a window is the end of the simulated window before it. Guessed from the angles
around, 18 of 129 windows of 1 s on three drives that rattle, at their true parameters, ended on the
wrong side of the gap (five of them from where the one before ended), which parameters compensate.
"""

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from ptp_symbolic.numeric.identify.constants import (
    ABOVE_NOISE,
    BINS,
    FAR,
    ITERATIONS,
    MATERIAL,
    NOTHING,
    ROUGH,
)
from ptp_symbolic.numeric.identify.coordinates import (
    FreeParameter,
    nearest_possible,
    slopes,
    to_search,
)
from ptp_symbolic.numeric.identify.evaluate import (
    Evaluation,
    Tolerance,
    mean_squares,
    residual_of,
)
from ptp_symbolic.numeric.identify.evidence import Deferred, is_recording, key_of, recorded, stored
from ptp_symbolic.numeric.identify.least_squares import (
    DEFAULT_TOLERANCE,
    Effort,
    Optimum,
    Problem,
    Shift,
    Simulations,
    all_values,
    cost_of,
    minimise,
    problem_of,
    simulations_of,
)
from ptp_symbolic.numeric.identify.run import Run
from ptp_symbolic.numeric.identify.start import start_state
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.lanes import in_portions

FloatArray = NDArray[np.float64]

Residual = Callable[[FloatArray], FloatArray | None]


def gears_in_place(
    model: Model,
    runs: Sequence[Run],
    values: Mapping[str, float],
    z: Sequence[FloatArray],
    tolerance: Tolerance,
    executor: Executor | None,
) -> list[FloatArray]:
    """The start unknowns `z`, each [nz], of every run with the gears where `with_gap_places` finds
    them for the parameter `values`. Raises InputError for values out of bounds.
    """
    simulated = partial(residual_of, model, model.parameter_vector(values), tolerance)

    def one(pair: tuple[Run, FloatArray]) -> FloatArray:
        run, start = pair
        return with_gap_places(run, start, partial(simulated, run))

    return in_portions(one, list(zip(runs, z, strict=True)), executor)


def with_gap_places(run: Run, z: FloatArray, residual: Residual) -> FloatArray:
    """The start unknowns `z` [nz] of `run` with the place in every gap at the root of the median of
    the `residual` [k * ny], in units of the noise; as they are where that fits no better, or where
    simulations fail.
    """
    for index, unknown in enumerate(run.unknowns):
        if unknown.contact is not None and unknown.column is not None:
            z = _Gap(run, z, index, unknown.column, residual).filled()
    return z


class _NotSimulatedError(Exception):
    """A simulation on the way failed."""


@dataclass(frozen=True, eq=False)
class _Gap:
    """A gap whose place is entry `index` of `z` and moves the signal `column`; `squares` and
    `medians` by the places that were simulated.
    """

    run: Run
    z: FloatArray
    index: int
    column: int
    residual: Residual
    squares: dict[float, float] = field(default_factory=dict)
    medians: dict[float, float] = field(default_factory=dict)

    def filled(self) -> FloatArray:
        """`z` with the place that fits best of those looked at on the way to the root."""
        try:
            self._look()
        except _NotSimulatedError:
            return self.z
        return self._at(min(self.squares, key=lambda place: self.squares[place]))

    def _look(self) -> None:
        """Go to the root from where `z` is, unless only noise is to be gained."""
        here = float(self.z[self.index])
        median = self._median(here)
        end = 1.0 if median > 0.0 else -1.0
        if abs(median) <= 1.0 or (end - here) * median <= 0.0:
            return
        other = self._median(end)
        if other * median < 0.0:
            one_sigma = abs((end - here) / (other - median))
            brentq(self._median, here, end, xtol=one_sigma, disp=False)

    def _at(self, place: float) -> FloatArray:
        shifted = self.z.copy()
        shifted[self.index] = place
        return shifted

    def _median(self, place: float) -> float:
        """Median of the residual of the joint's angle in units of its noise."""
        if place not in self.medians:
            found = self.residual(self._at(place))
            if found is None:
                raise _NotSimulatedError
            self.squares[place] = float(found @ found)
            signal = found.reshape(self.run.measured.shape)[:, self.column]
            self.medians[place] = float(np.median(signal))
        return self.medians[place]


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
    with the gears in place, and of the end of the window before it; and from the next, unless the
    residual is within noise or the `usual` mean square of all runs, or the search is `brief`.
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
        of a series whose residual is larger is started at other places in its gaps too.
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
    gap in which no sensor shows the place, together; all others alone.
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
        elif unknown.name.startswith(("omega_gear_", "theta_gear_")):
            gear = states.index(unknown.name)
            joint = states.index(unknown.name.replace("_gear_", "_", 1))
            ahead = (end[gear] - end[joint]) - (run.start[gear] - run.start[joint])
            z[index] = min(max(float(ahead), unknown.lower), unknown.upper)
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


@dataclass(frozen=True, eq=False)
class Fit:
    """A fit: parameter `values` (all of the model), start unknowns `z` and evaluations per run.

    `by_input_noise` are, per run, changes [k * ny, replays] of the residual by noise of the inputs,
    without what the start unknowns can take up; none where they were not looked for.
    """

    model: Model
    runs: tuple[Run, ...]
    free: tuple[FreeParameter, ...]
    values: Mapping[str, float]
    z: tuple[FloatArray, ...]
    cost: float
    evaluations: Sequence[Evaluation]
    failed: str | None = None
    tolerance: Tolerance = DEFAULT_TOLERANCE
    misleading: tuple[Shift, ...] | None = None
    by_input_noise: Sequence[FloatArray] = ()

    def rms_counts(self) -> float:
        """Root mean square of the residual of all encoder signals, in counts (see `run_counts`)."""
        squares = np.concatenate([run_counts(r, e) for r, e in self.pairs()])
        return float(np.sqrt(np.mean(squares**2)))

    def pairs(self) -> list[tuple[Run, Evaluation]]:
        """Runs with their evaluations."""
        return list(zip(self.runs, self.evaluations, strict=True))


def run_counts(run: Run, evaluation: Evaluation) -> FloatArray:
    """Residuals [k * ne] of the encoder signals in counts; without one, of all in sigmas."""
    residual = evaluation.residual.reshape(run.measured.shape)
    in_counts = residual / run.weight / run.counts
    encoders = np.isfinite(run.counts)
    return (in_counts[:, encoders] if encoders.any() else residual).ravel()


def fit_parameters(
    model: Model,
    runs: Sequence[Run],
    free: Sequence[FreeParameter],
    fixed: Mapping[str, float],
    z: Sequence[FloatArray] | None = None,
    effort: Effort | None = None,
    executor: Executor | None = None,
    misleading: Sequence[Shift] | None = None,
    earlier: Fit | None = None,
) -> Fit:
    """Fit `free` from their starts; all other parameters stay at `fixed`. Derivatives known to be
    `misleading` from an earlier fit of the same parameters are replaced from the first step on.
    Where this fit begins at the end of an `earlier` one, that is not simulated again.

    With no free parameter only the start unknowns of every run are fitted, which is how validation
    runs are judged. Places in a gap are looked for where no starts `z`, each [nz], are given.
    Raises InputError for `fixed` values out of bounds.
    """
    effort = effort or Effort()
    given = _Given(model, tuple(runs), tuple(free), fixed, z, effort, executor, misleading, earlier)
    if not is_recording():
        return given.ended().fit
    before = None if earlier is None else earlier.evaluations
    key = key_of("fit", model, given.runs, given.free, fixed, z, effort, misleading, before)
    found = stored(key, given.ended, _End.light)
    kept, make = found.light, None
    if found.made is not None:
        fit = found.made.fit
    else:
        fit, make = given.of_light(kept)
    evaluations = Deferred(key, len(runs), make, kept["squares"], fit.evaluations)
    return replace(fit, evaluations=evaluations)


@dataclass(frozen=True, eq=False)
class _End:
    """A fit, the search coordinates phi [nf] where it ended, and whether it is `unmoved`: it has
    the evaluations of the earlier fit from whose end it began.
    """

    fit: Fit
    phi: FloatArray
    unmoved: bool = False

    def light(self) -> dict[str, Any]:
        """What is recorded of it: no evaluations but their mean squares."""
        fit = self.fit
        return {
            "phi": self.phi,
            "unmoved": self.unmoved,
            "z": fit.z,
            "cost": fit.cost,
            "failed": fit.failed,
            "misleading": fit.misleading,
            "squares": mean_squares(fit.evaluations, fit.runs),
        }


@dataclass(frozen=True, eq=False)
class _Given:
    """The arguments of `fit_parameters`."""

    model: Model
    runs: tuple[Run, ...]
    free: tuple[FreeParameter, ...]
    fixed: Mapping[str, float]
    z: Sequence[FloatArray] | None
    effort: Effort
    executor: Executor | None
    misleading: Sequence[Shift] | None
    earlier: Fit | None

    def fit(
        self,
        values: Mapping[str, float],
        z: Sequence[FloatArray],
        cost: float,
        evaluations: Sequence[Evaluation],
        failed: str | None,
    ) -> Fit:
        """A fit that ended at `values` and `z`."""
        given, tolerance = (self.model, self.runs, self.free), self.effort.tolerance
        return Fit(*given, values, tuple(z), cost, evaluations, failed, tolerance)

    def of_light(self, kept: Mapping[str, Any]) -> tuple[Fit, Callable[[], Sequence[Evaluation]]]:
        """The fit of which `_End.light` was recorded, and what makes its evaluations."""
        model, runs, free, fixed = self.model, self.runs, self.free, self.fixed
        values = {**fixed, **all_values(free, kept["phi"])} if free else dict(fixed)

        def evaluations() -> Sequence[Evaluation]:
            if kept["unmoved"] and self.earlier is not None:
                return _by_coordinates(self.earlier, free)
            base = fixed if free else values
            simulations = simulations_of(model, runs, free, base, self.effort, self.executor)
            return simulations.evaluate(kept["phi"], kept["z"], True)

        fit = self.fit(values, kept["z"], kept["cost"], (), kept["failed"])
        return replace(fit, misleading=kept["misleading"]), evaluations

    def ended(self) -> _End:
        """The fit, made now."""
        model, runs, free, fixed, z = self.model, self.runs, self.free, self.fixed, self.z
        effort, executor = self.effort, self.executor
        if not free:
            known = [[]] * len(runs) if z is None else [[start] for start in z]
            starts = fitted_starts(model, runs, fixed, known, effort, executor)
            cost = float(sum(s.cost for s in starts))
            failed = next((s.failed for s in starts if s.failed), None)
            evaluations = tuple(s.evaluations[0] for s in starts)
            fit = self.fit(dict(fixed), [s.z[0] for s in starts], cost, evaluations, failed)
            return _End(fit, np.zeros(0))
        simulations = simulations_of(model, runs, free, fixed, effort, executor)
        problem = problem_of(simulations, effort)
        if problem.refine is not None and self.misleading is not None:
            problem.refine.chosen = list(self.misleading)
        phi = to_search(free, {f.name: f.start for f in free})
        phi = nearest_possible(model, free, simulations.parameters, phi)
        values = {**fixed, **all_values(free, phi)}
        if z is None:
            guesses, tolerance = [run.guess for run in runs], effort.tolerance
            z = starts_in_place(model, runs, values, guesses, tolerance, executor, brief=True)
        begun = None
        if self.earlier is not None and _ends_at(self.earlier, simulations, values, z):
            begun = _by_coordinates(self.earlier, free)
        best = minimise(problem, phi, z, effort.iterations, effort.gain, effort.rejections, begun)
        values = {**fixed, **all_values(free, best.phi)}
        fit = self.fit(values, best.z, best.cost, tuple(best.evaluations), best.failed)
        if problem.refine is not None and problem.refine.chosen is not None:
            fit = replace(fit, misleading=tuple(problem.refine.chosen))
        return _End(fit, best.phi, begun is not None and best.evaluations[0] is begun[0])


def _ends_at(
    fit: Fit, simulations: Simulations, values: Mapping[str, float], z: Sequence[FloatArray]
) -> bool:
    """Whether a fit ends at the parameter `values` and the starts z, each [nz], and has simulated
    there, by the same parameters, what `simulations` would.
    """
    return (
        not fit.failed
        and fit.tolerance == simulations.tolerance
        and [f.name for f in fit.free] == [f.name for f in simulations.free]
        and len(fit.runs) == len(simulations.runs)
        and all(a is b for a, b in zip(fit.runs, simulations.runs, strict=True))
        and all(np.array_equal(a, b) for a, b in zip(fit.z, z, strict=True))
        and all(abs(values[n] - v) <= NOTHING * abs(v) for n, v in fit.values.items())
    )


def _by_coordinates(fit: Fit, free: Sequence[FreeParameter]) -> list[Evaluation]:
    """The evaluations of a fit with Jacobians by the coordinates of `free`, its own parameters."""
    own, new = (slopes(f, to_search(f, fit.values)) for f in (fit.free, free))
    return [replace(e, by_parameter=e.by_parameter * (new / own)) for e in fit.evaluations]
