"""A trial: the declared model with a set of candidates, fitted to the training runs by simulation;
fits run side by side, in threads of their own that share out their simulations.
"""

import os
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, field, replace
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.diagnose.candidates import Candidate
from ptp_symbolic.numeric.identify.blocks import huber_loss, weighted_median
from ptp_symbolic.numeric.identify.constants import (
    ITERATIONS,
    LITTLE,
    MATERIAL,
    NEARBY,
    ROUGH,
    TUNING,
    WIDE_STEP,
)
from ptp_symbolic.numeric.identify.coordinates import FreeParameter
from ptp_symbolic.numeric.identify.evaluate import Evaluation, Tolerance, evaluate, mean_squares
from ptp_symbolic.numeric.identify.evidence import (
    Allowance,
    Deferred,
    Threads,
    in_turn,
    is_recording,
    key_of,
    simulates,
    stored,
)
from ptp_symbolic.numeric.identify.fit import Fit, fit_parameters
from ptp_symbolic.numeric.identify.least_squares import Effort
from ptp_symbolic.numeric.identify.run import Run, sizes
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.lanes import in_portions

FloatArray = NDArray[np.float64]

Item = TypeVar("Item")
Result = TypeVar("Result")


def usable_cores() -> int:
    """Cores that the process may use."""
    affinity = getattr(os, "sched_getaffinity", None)  # Linux alone has one
    return len(affinity(0)) if affinity else os.cpu_count() or 1


def side_by_side(work: Callable[[Item], Result], items: Sequence[Item]) -> list[Result]:
    """What `work` makes of every item, in their order.

    Simulations that it hands to an executor of one worker per core go on while another piece is
    between two of its own, so that the last of three fits for two cores keeps both at work. One
    piece more than cores is enough for that.
    """
    if len(items) <= 1 or not simulates():
        return in_turn(work, items)
    with Threads(min(len(items), 1 + usable_cores())) as threads:
        return list(threads.map(work, items))


SHARP = MATERIAL * ROUGH  # error of simulations over the noise, at last: beside ROUGH it is none
Progress = Callable[[str], None]


@dataclass(frozen=True, eq=False)
class SearchProblem:
    """What stays the same through a diagnosis.

    `whole` are the training runs as they were logged, `every_sample` the same or their windows, and
    `train` these with as many samples as the search needs (see `with_fewer_samples`); `windows`
    some short and some longer ones (none where `train` are windows already), `few` those windows by
    which sets are compared first, `validate` the runs that are never fitted. `free` are the
    declared free parameters, `fixed` the values of all others (candidates vanish). `input_noise` is
    the declared noise (rms) of every input [nu] in its unit (None: as the logs show it),
    `declared_noise` names the outputs whose noise is declared, `resolution` is the noise of the
    finest angle in rad, `robust_below` that of `robust_tuning`, `material` the share of the sum of
    squares that a name requires; noise counts as `white`, or with its autocorrelation. When its
    `allowance` is over, a search tries nothing new.
    """

    model: Model
    whole: tuple[Run, ...]
    every_sample: tuple[Run, ...]
    train: tuple[Run, ...]
    windows: tuple[tuple[Run, ...], ...]
    few: tuple[Run, ...]
    validate: tuple[Run, ...]
    free: tuple[FreeParameter, ...]
    fixed: Mapping[str, float]
    candidates: tuple[Candidate, ...]
    executor: Executor
    progress: Progress
    input_noise: tuple[float | None, ...]
    declared_noise: frozenset[str]
    resolution: float
    robust_below: float = NEARBY
    material: float = MATERIAL
    white: bool = False
    allowance: Allowance = field(default_factory=Allowance)

    @property
    def evidence_parts(self) -> tuple[Any, ...]:
        """What recorded evaluations of a problem depend on, unless they are given more."""
        runs = self.train, self.every_sample
        noise = self.input_noise, self.declared_noise
        return self.model, runs, self.fixed, noise, self.resolution, self.robust_below

    @property
    def is_over(self) -> bool:
        """Whether the allowance for the search is used up."""
        return self.allowance.is_over


@dataclass(frozen=True, eq=False)
class FittedModel:
    """A set of candidates and the fit with their parameters free."""

    candidates: tuple[Candidate, ...]
    fit: Fit

    @property
    def keys(self) -> tuple[str, ...]:
        """Keys of the candidates, sorted."""
        return keys_of(self.candidates)

    @property
    def values(self) -> dict[str, float]:
        """Values of all parameters of the model."""
        return dict(self.fit.values)


def keys_of(candidates: Sequence[Candidate]) -> tuple[str, ...]:
    """Keys of candidates, sorted: equal for equal sets."""
    return tuple(sorted(c.key for c in candidates))


def forms_of(candidates: Sequence[Candidate]) -> tuple[tuple[str, int], ...]:
    """Keys and forms of candidates, sorted: equal for equal sets in equal forms."""
    return tuple(sorted((c.key, c.member) for c in candidates))


def all_free(
    problem: SearchProblem, candidates: Sequence[Candidate], values: Mapping[str, float]
) -> tuple[FreeParameter, ...]:
    """The declared free parameters and those of `candidates`, started at `values`."""
    every = (*problem.free, *(f for c in candidates for f in c.free))
    return tuple(restarted(f, values[f.name]) for f in every)


def restarted(free: FreeParameter, value: float) -> FreeParameter:
    """The parameter started at `value`; its scale stays where the value is next to nothing."""
    inside = float(np.clip(value, free.lower, free.upper))
    if free.logarithmic:
        return replace(free, start=max(inside, free.lower))
    return replace(free, start=inside, scale=max(abs(inside), free.scale))


def fitted(
    problem: SearchProblem,
    candidates: Sequence[Candidate],
    values: Mapping[str, float],
    z: Sequence[FloatArray] | None,
    iterations: int = 0,
    parent: Fit | None = None,
    share: float = ROUGH,
    secants: float | None = None,
    block: float = np.inf,
    executor: Executor | None = None,
    earlier: Fit | None = None,
) -> FittedModel:
    """Fit from `values` (all parameters of the model) and the starts `z`, each [nz], of the runs.

    `secants` is the step of the differences that replace derivatives which mislead; those that
    misled the parent are known to. `share` is that of `tolerance_for`: a finer one than `ROUGH`
    ends a fit, with straight steps. The robust loss weighs blocks of `block` s. Values out of
    bounds are projected; an `earlier` fit that ended where this begins is not simulated again.
    """
    free = all_free(problem, candidates, values)
    names = {name for f in free for name in f.names}
    fixed = {name: value for name, value in problem.fixed.items() if name not in names}
    tolerance = tolerance_for(problem, share)
    effort = Effort(
        iterations,
        MATERIAL * share,
        tolerance,
        secants,
        block,
        problem.robust_below,
        straight=share < ROUGH,
    )
    known = None if secants is None else _inherited(parent, free)
    fit = fit_parameters(
        problem.model, problem.train, free, fixed, z, effort, executor, known, earlier
    )
    return FittedModel(tuple(candidates), fit)


def _inherited(parent: Fit | None, free: Sequence[FreeParameter]) -> list[tuple[int, int]] | None:
    """The derivatives (run, column) that misled the parent, as columns of `free`; None: not
    known.
    """
    if parent is None or parent.misleading is None:
        return None
    own = {f.name: k for k, f in enumerate(free)}
    names = [f.name for f in parent.free]
    found = [(run, own[names[c]]) for run, c in parent.misleading if names[c] in own]
    fresh = [k for name, k in own.items() if name not in names]
    return found + [(run, k) for run in range(len(parent.runs)) for k in fresh]


def tolerance_for(problem: SearchProblem, share: float) -> Tolerance:
    """Integration tolerance that keeps angles good to a `share` of their noise: a coarser one makes
    the deviance jump wherever friction breaks away a sample later.
    """
    return Tolerance.for_resolution(problem.resolution, share)


def continued(
    problem: SearchProblem,
    trial: FittedModel,
    iterations: int,
    share: float = ROUGH,
    secants: float | None = None,
    executor: Executor | None = None,
    z: Sequence[FloatArray] | None = None,
) -> FittedModel:
    """Fit a trial on, from other starts `z` of its runs if given; a worse end is not taken."""
    new = fitted(
        problem,
        trial.candidates,
        trial.values,
        trial.fit.z if z is None else z,
        iterations,
        trial.fit,
        share,
        secants,
        executor=executor,
        earlier=trial.fit,
    )
    if new.fit.misleading is None and trial.fit.misleading is not None:
        new = replace(new, fit=replace(new.fit, misleading=trial.fit.misleading))
    before, after = deviances([trial, new])
    return trial if new.fit.failed or after > before else new


def simulated(
    problem: SearchProblem, fit: Fit, values: Mapping[str, float], executor: Executor | None
) -> list[Evaluation]:
    """All runs of `fit` with `values` in place of its own, without Jacobians. Raises InputError for
    values out of bounds.
    """
    p, none = problem.model.parameter_vector({**fit.values, **values}), np.zeros(0, dtype=np.int64)
    tolerance = tolerance_for(problem, ROUGH)

    def one(pair: tuple[Run, FloatArray]) -> Evaluation:
        return evaluate(problem.model, pair[0], p, pair[1], none, False, tolerance)

    return in_portions(one, list(zip(fit.runs, fit.z, strict=True)), executor)


def simulated_at(
    problem: SearchProblem, fit: Fit, values: Mapping[str, float]
) -> Sequence[Evaluation]:
    """See `simulated`: of which the mean squares are recorded."""

    def made() -> list[Evaluation]:
        return simulated(problem, fit, values, problem.executor)

    if not is_recording():
        return made()
    key = key_of("simulated", problem, fit, values)
    found = stored(key, made, lambda every: mean_squares(every, fit.runs))
    if found.made is None:
        return Deferred(key, len(fit.runs), made, found.light)
    return Deferred(key, len(fit.runs), None, found.light, found.made)


def deviances(trials: Sequence[FittedModel]) -> list[float]:
    """One number per trial to rank them by: n log(mean square), summed over the signals, so that no
    signal outweighs another by its unit (likelihood with unknown variances: Bard, 1974, 4.9).
    Residuals are known to no better than the error of simulations (`ROUGH`).

    Runs or windows far worse than usual count only linearly (Huber's loss); "usual" is that of the
    best trial.
    """
    squares = [mean_squares(t.fit.evaluations, t.fit.runs) for t in trials]
    size = sizes(trials[0].fit.runs)
    usual = np.min([weighted_median(s, size) for s in squares], axis=0)
    result = []
    for square in squares:
        if not np.all(np.isfinite(square)):
            result.append(np.inf)
            continue
        bounded = huber_loss(square, TUNING**2 * np.maximum(usual, 1.0))
        mean = size @ bounded / size.sum()
        result.append(float(size.sum() * np.sum(np.log(np.maximum(mean, ROUGH**2)))))
    return result


def ranked(trials: Sequence[FittedModel]) -> list[FittedModel]:
    """Trials, the best fit first; of equal sets the best alone."""
    if not trials:
        return []
    cost = deviances(trials)
    order = sorted(range(len(trials)), key=lambda k: cost[k])
    best: dict[tuple[tuple[str, int], ...], FittedModel] = {}
    for k in order:
        best.setdefault(forms_of(trials[k].candidates), trials[k])
    return list(best.values())


def is_near(trial: FittedModel, others: Sequence[FittedModel]) -> bool:
    """Whether the mean square residual of a trial is at most e times that of the best of others."""
    cost = deviances([trial, *others])
    return cost[0] - min(cost) <= sum(run.size for run in trial.fit.runs)


def is_same_end(trial: FittedModel, other: FittedModel) -> bool:
    """Whether two trials of one set have the same deviance, so that they ended at one optimum."""
    cost = deviances([trial, other])
    return abs(cost[0] - cost[1]) < LITTLE * sum(run.size for run in trial.fit.runs)


def halving(
    problem: SearchProblem,
    trials: Sequence[FittedModel],
    *rungs: int,
    seen: list[FittedModel] | None = None,
    iterations: int = ITERATIONS,
) -> list[FittedModel]:
    """Successive halving (Jamieson and Talwalkar, 2016): every rung gives the trials that are left
    some iterations, side by side, and keeps so many of them; the others end up in `seen`.
    """
    left = list(trials)

    def go_on(trial: FittedModel) -> FittedModel:
        secants = None if trial.fit.misleading is None else WIDE_STEP
        return continued(problem, trial, iterations, secants=secants, executor=problem.executor)

    for kept in rungs:
        further = side_by_side(go_on, left)
        left = [t for t in ranked(further) if np.isfinite(t.fit.cost)]
        if seen is not None:
            seen += left[kept:]
        left = left[:kept]
    return left
