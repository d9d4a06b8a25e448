"""Search the missing effect: refit every candidate, keep the best, judge on held-out runs.

The score test orders nothing away: an effect inside a gap has no usable gradient where it vanishes.
Every candidate is refitted from a grid of starts, with the declared parameters at their table start
and at the declared optimum; poor ones are dropped after a few iterations, in rounds that do not
depend on which thread is faster.
"""

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.diagnose.candidates import Candidate
from ptp_symbolic.identify.coordinates import FreeParameter
from ptp_symbolic.identify.evaluate import Tolerance
from ptp_symbolic.identify.fit import Effort, Fit, all_values_at_start, fit_parameters
from ptp_symbolic.identify.run import Run
from ptp_symbolic.runtime.model import Model

FloatArray = NDArray[np.float64]
Progress = Callable[[str], None]

COARSE, FINE = Tolerance(1e-4, 1e-6), Tolerance(1e-5, 1e-7)
EFFECT_ONLY = Effort(6, 1e-2, COARSE)
FIRST = Effort(5, 3e-3, COARSE)
NEXT = Effort(14, 1e-3, COARSE)
LAST = Effort(20, 1e-5, FINE)
HELD_OUT = Effort(10, 1e-4, FINE)
DROP_FACTOR = 25.0
POLISHED = 4


@dataclass(frozen=True, eq=False)
class Task:
    """What stays the same through a diagnosis."""

    model: Model
    train: tuple[Run, ...]
    validate: tuple[Run, ...]
    free: tuple[FreeParameter, ...]
    fixed: Mapping[str, float]
    executor: Executor
    progress: Progress


@dataclass(frozen=True, eq=False)
class Trial:
    """One set of candidates with its fit, and the held-out runs once it was judged."""

    candidates: tuple[Candidate, ...]
    train: Fit
    validate: Fit | None = None

    @property
    def keys(self) -> tuple[str, ...]:
        """Keys of the candidates, sorted."""
        return tuple(sorted(c.key for c in self.candidates))


def fit_declared(task: Task) -> Trial:
    """Fit the declared model, from the table start and from a start a factor of 2 away."""
    task.progress("fitting the declared model")
    fits = [
        fit_parameters(task.model, task.train, free, task.fixed, None, NEXT, task.executor)
        for free in (task.free, tuple(_shifted(f) for f in task.free))
    ]
    best = min(fits, key=lambda fit: fit.cost)
    last = fit_parameters(
        task.model, task.train, _restarted(best), task.fixed, best.z, LAST, task.executor
    )
    return judge(task, Trial((), min(best, last, key=lambda fit: fit.cost)))


def _shifted(free: FreeParameter) -> FreeParameter:
    """The same parameter started elsewhere: half the value where it can only be positive."""
    value = 0.5 * free.start if free.logarithmic else free.start
    return replace(free, start=float(np.clip(value, free.lower, free.upper)))


def judge(task: Task, trial: Trial) -> Trial:
    """Fit only the starts of the held-out runs with the parameters of `trial`."""
    held_out = fit_parameters(
        task.model, task.validate, (), trial.train.values, None, HELD_OUT, task.executor
    )
    return replace(trial, validate=held_out)


def try_candidates(task: Task, base: Trial, candidates: Sequence[Candidate]) -> list[Trial]:
    """Refit `base` with each candidate added; the best are polished and judged, best first."""
    first = _first_round(task, base, candidates)
    task.progress(f"refining {len(first)} candidates")
    second = _continue(task, _worth_it(first), NEXT)
    second.sort(key=lambda trial: trial.train.cost)
    task.progress("polishing the best candidates")
    polished = _continue(task, _worth_it(second[:POLISHED]), LAST)
    judged = [judge(task, trial) for trial in polished]
    dropped = [t for t in first if t.keys not in {j.keys for j in judged}]
    return sorted(judged, key=held_out_cost) + sorted(dropped, key=lambda t: t.train.cost)


def held_out_cost(trial: Trial) -> float:
    """Mean square of the held-out residuals; infinite when not judged."""
    if trial.validate is None or trial.validate.failed:
        return np.inf
    return trial.validate.rms_counts() ** 2


def _first_round(task: Task, base: Trial, candidates: Sequence[Candidate]) -> list[Trial]:
    """The best start of every candidate after a few coarse iterations.

    The parameters of the candidate move alone first, so that the declared ones are not bent to
    stand in for an effect that is still far from its place.
    """
    origins = _origins(task, base)
    jobs = [
        (candidate, start, values, z)
        for candidate in candidates
        for values, z in origins
        for start in candidate.starts
    ]
    task.progress(f"trying {len(candidates)} candidates from {len(jobs)} starts")

    def alone(job: tuple[Candidate, tuple[FreeParameter, ...], dict, list]) -> Fit:
        _, start, values, z = job
        return fit_parameters(task.model, task.train, start, values, z, EFFECT_ONLY)

    best: dict[str, tuple[Candidate, Fit]] = {}
    for job, fit in zip(jobs, task.executor.map(alone, jobs), strict=True):
        key = job[0].key
        if key not in best or fit.cost < best[key][1].cost:
            best[key] = (job[0], fit)
    trials = [
        Trial((*base.candidates, candidate), _all_free(task, base, fit))
        for candidate, fit in best.values()
    ]
    return _continue(task, trials, FIRST)


def _origins(task: Task, base: Trial) -> list[tuple[dict[str, float], list[FloatArray]]]:
    """Where searches begin: the table start of the declared parameters, and their optimum."""
    rest = [np.zeros(len(run.unknowns)) for run in task.train]
    table = {**base.train.values, **all_values_at_start(task.free)}
    return [(table, rest), (dict(base.train.values), list(base.train.z))]


def _all_free(task: Task, base: Trial, fit: Fit) -> Fit:
    """`fit` with the parameters of `base` freed as well."""
    own = {f.name for f in fit.free}
    return replace(fit, free=(*(f for f in base.train.free if f.name not in own), *fit.free))


def _restarted(fit: Fit) -> tuple[FreeParameter, ...]:
    """The free parameters of `fit`, started where it ended."""
    return tuple(
        replace(f, start=max(fit.values[f.name], 1e-6 * f.start) if f.logarithmic else
                float(np.clip(fit.values[f.name], f.lower, f.upper)))
        for f in fit.free
    )  # fmt: skip


def _fixed(task: Task, free: Sequence[FreeParameter]) -> dict[str, float]:
    names = {name for f in free for name in (f.name, *f.tied)}
    return {name: value for name, value in task.fixed.items() if name not in names}


def _worth_it(trials: Sequence[Trial]) -> list[Trial]:
    best = min(trial.train.cost for trial in trials)
    return [trial for trial in trials if trial.train.cost <= DROP_FACTOR * best]


def _continue(
    task: Task, trials: Sequence[Trial], effort: Effort
) -> list[Trial]:
    def run(trial: Trial) -> Trial:
        free = _restarted(trial.train)
        fit = fit_parameters(
            task.model, task.train, free, _fixed(task, free), trial.train.z, effort
        )
        kept = fit if fit.cost <= 1.02 * trial.train.cost else trial.train
        return replace(trial, train=kept)

    return list(task.executor.map(run, trials))
