"""Fit the free parameters of a model to several runs at once."""

from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.identify.constants import ABOVE_NOISE, NEARBY
from ptp_symbolic.numeric.identify.coordinates import (
    FreeParameter,
    limits,
    slopes,
    to_search,
    to_values,
)
from ptp_symbolic.numeric.identify.evaluate import Evaluation, Tolerance, evaluate
from ptp_symbolic.numeric.identify.gap_places import gears_in_place, residual_of, with_gap_places
from ptp_symbolic.numeric.identify.least_squares import Optimum, Problem, cost_of, minimise
from ptp_symbolic.numeric.identify.requirements import keep_possible, nearest_possible
from ptp_symbolic.numeric.identify.robust_loss import blocks_of
from ptp_symbolic.numeric.identify.run import Run
from ptp_symbolic.numeric.identify.secants import Secants, Shift
from ptp_symbolic.numeric.runtime.model import Model

FloatArray = NDArray[np.float64]

DEFAULT_TOLERANCE = Tolerance()


@dataclass(frozen=True)
class Effort:
    """How to search: iterations, relative gain at which to stop, simulation tolerance, and how many
    steps in a row may be rejected.

    `secants` is the step, in search coordinates, of the finite differences that replace derivatives
    which mislead (see `identify.secants`); None: none are replaced. The robust loss weighs blocks
    of `block` s, whole runs unless given; `robust_below` is that of `robust_tuning`.
    """

    iterations: int = 30
    gain: float = 1e-5
    tolerance: Tolerance = DEFAULT_TOLERANCE
    secants: float | None = None
    rejections: int = 5
    block: float = np.inf
    robust_below: float = NEARBY


@dataclass(frozen=True, eq=False)
class Fit:
    """A fit: parameter `values` (all of the model), start unknowns `z` and evaluations per run.

    `shaken` are, per run, changes [k * ny, replays] of the residual by noise of the inputs, without
    what the start unknowns can take up; none where they were not looked for.
    """

    model: Model
    runs: tuple[Run, ...]
    free: tuple[FreeParameter, ...]
    values: Mapping[str, float]
    z: tuple[FloatArray, ...]
    cost: float
    evaluations: tuple[Evaluation, ...]
    failed: str | None = None
    tolerance: Tolerance = DEFAULT_TOLERANCE
    misleading: tuple[Shift, ...] | None = None
    shaken: tuple[FloatArray, ...] = ()

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
) -> Fit:
    """Fit `free` from their starts; all other parameters stay at `fixed`. Derivatives known to be
    `misleading` from an earlier fit of the same parameters are replaced from the first step on.

    With no free parameter only the start unknowns of every run are fitted, which is how validation
    runs are judged. Places in a gap are looked for where no starts `z`, each [nz], are given.
    Raises InputError for `fixed` values out of bounds.
    """
    effort = effort or Effort()
    if not free:
        return _fit_starts(model, runs, fixed, z, effort, executor)
    simulations = simulations_of(model, runs, free, fixed, effort, executor)
    problem = problem_of(simulations, effort)
    if problem.refine is not None and misleading is not None:
        problem.refine.chosen = list(misleading)
    phi = to_search(free, {f.name: f.start for f in free})
    phi = nearest_possible(model, free, simulations.parameters, phi)
    values = {**fixed, **all_values(free, phi)}
    if z is None:
        guesses = [run.guess for run in runs]
        z = gears_in_place(model, runs, values, guesses, effort.tolerance, executor)
    best = minimise(problem, phi, z, effort.iterations, effort.gain, effort.rejections)
    values = {**fixed, **all_values(free, best.phi)}
    chosen = None if problem.refine is None else problem.refine.chosen
    return Fit(
        model,
        tuple(runs),
        tuple(free),
        values,
        tuple(best.z),
        best.cost,
        tuple(best.evaluations),
        best.failed,
        effort.tolerance,
        None if chosen is None else tuple(chosen),
    )


def all_values(free: Sequence[FreeParameter], phi: FloatArray) -> dict[str, float]:
    """Values of the free parameters at phi [nf], and of those tied to them."""
    own = to_values(free, phi)
    return own | {name: own[f.name] for f in free for name in f.tied}


def all_values_at_start(free: Sequence[FreeParameter]) -> dict[str, float]:
    """Start values of the free parameters and of those tied to them."""
    return {name: f.start for f in free for name in f.names}


@dataclass(frozen=True, eq=False)
class Simulations:
    """All runs as functions of the search coordinates phi [nf] and the start unknowns z.

    `owner` is the coordinate of every parameter in `columns`: tied ones share theirs.
    """

    model: Model
    runs: Sequence[Run]
    free: Sequence[FreeParameter]
    base: FloatArray
    columns: NDArray[np.int64]
    owner: NDArray[np.int64]
    tolerance: Tolerance
    executor: Executor | None

    def parameters(self, phi: FloatArray) -> FloatArray:
        """All parameters [np]."""
        p, names = self.base.copy(), self.model.parameter_names
        for name, value in all_values(self.free, phi).items():
            p[names.index(name)] = value
        return p

    def residual(self, index: int, phi: FloatArray, z: FloatArray) -> FloatArray | None:
        """Residual of one run; None where the simulation fails."""
        run = self.runs[index]
        return residual_of(self.model, self.parameters(phi), self.tolerance, run, z)

    def evaluate(
        self,
        phi: FloatArray,
        z: Sequence[FloatArray],
        tangents: bool,
        only: Sequence[int] | None = None,
    ) -> list[Evaluation]:
        """Evaluations of the runs `only`, all unless given, their Jacobians by phi."""
        p = self.parameters(phi)
        by_phi = np.zeros((len(self.columns), len(self.free)))
        if len(self.free):
            by_phi[np.arange(len(self.columns)), self.owner] = slopes(self.free, phi)[self.owner]

        def one(pair: tuple[Run, FloatArray]) -> Evaluation:
            run, start = pair
            e = evaluate(self.model, run, p, start, self.columns, tangents, self.tolerance)
            return replace(e, by_parameter=e.by_parameter @ by_phi) if tangents else e

        pairs = list(zip(self.runs, z, strict=True))
        pairs = pairs if only is None else [pairs[k] for k in only]
        return list(self.executor.map(one, pairs)) if self.executor else [one(a) for a in pairs]


def simulations_of(
    model: Model,
    runs: Sequence[Run],
    free: Sequence[FreeParameter],
    fixed: Mapping[str, float],
    effort: Effort,
    executor: Executor | None,
) -> Simulations:
    """`runs` as functions of `free`, all other parameters at `fixed`. Raises InputError for values
    out of bounds.
    """
    names = list(model.parameter_names)
    owned = [(i, names.index(name)) for i, f in enumerate(free) for name in f.names]
    owner, columns = np.array(owned, dtype=np.int64).reshape(-1, 2).T
    return Simulations(
        model,
        runs,
        free,
        model.parameter_vector(dict(fixed)),
        columns.copy(),
        owner.copy(),
        effort.tolerance,
        executor,
    )


def problem_of(simulations: Simulations, effort: Effort) -> Problem:
    """Least squares over the runs of `simulations`, within the bounds of its parameters."""
    free, runs, length = simulations.free, simulations.runs, effort.block
    lower, upper = limits(free)
    blocks = [blocks_of(r.time, len(r.signals), length) for r in runs] if length < np.inf else None
    return Problem(
        simulations.evaluate,
        lower,
        upper,
        [np.array([u.lower for u in run.unknowns]) for run in runs],
        [np.array([u.upper for u in run.unknowns]) for run in runs],
        [np.array([u.sigma for u in run.unknowns]) for run in runs],
        np.zeros(len(free)),
        np.zeros(len(free)),
        None
        if effort.secants is None
        else Secants(simulations.residual, upper, simulations.executor, step=effort.secants),
        keep_possible(simulations.model, free, simulations.parameters),
        blocks,
        effort.robust_below,
    )


def _fit_starts(
    model: Model,
    runs: Sequence[Run],
    fixed: Mapping[str, float],
    z: Sequence[FloatArray] | None,
    effort: Effort,
    executor: Executor | None,
) -> Fit:
    """Runs that share no free parameter are independent: fit the start of each by itself.

    The search begins at the best of what is known, with the gear in its place, at rest and turning
    back, and then at the next, unless nothing but rounding is left.
    """
    nothing = np.zeros(0)
    simulated = partial(residual_of, model, model.parameter_vector(fixed), effort.tolerance)

    def one(run: Run, known: Sequence[FloatArray]) -> Optimum:
        problem = problem_of(simulations_of(model, [run], (), fixed, effort, None), effort)
        starts = [with_gap_places(run, s, partial(simulated, run)) for s in run.guesses]
        starts += known
        costs = [cost_of(problem, problem.evaluate(nothing, [s], False), [s]) for s in starts]
        found: list[Optimum] = []
        for index in np.argsort(costs, kind="stable"):
            begin = [starts[index]]
            found.append(minimise(problem, nothing, begin, effort.iterations, effort.gain))
            if found[-1].cost <= ABOVE_NOISE * run.size:
                break
        return min(found, key=lambda optimum: optimum.cost)

    known = [[]] * len(runs) if z is None else [[start] for start in z]
    order = sorted(range(len(runs)), key=lambda k: -runs[k].size)  # the longest would end last
    found = (executor.map if executor else map)(lambda k: one(runs[k], known[k]), order)
    by_run = dict(zip(order, found, strict=True))
    best = [by_run[k] for k in range(len(runs))]
    return Fit(
        model,
        tuple(runs),
        (),
        dict(fixed),
        tuple(b.z[0] for b in best),
        float(sum(b.cost for b in best)),
        tuple(b.evaluations[0] for b in best),
        next((b.failed for b in best if b.failed), None),
        effort.tolerance,
    )
