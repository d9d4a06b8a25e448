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
from ptp_symbolic.diagnose.floor import floor_counts
from ptp_symbolic.diagnose.scores import Score, mean_square, score
from ptp_symbolic.identify.coordinates import FreeParameter
from ptp_symbolic.identify.evaluate import Tolerance, evaluate
from ptp_symbolic.identify.fit import Effort, Fit, all_values_at_start, fit_parameters, run_counts
from ptp_symbolic.identify.run import Run
from ptp_symbolic.runtime.model import Model

FloatArray = NDArray[np.float64]
Progress = Callable[[str], None]

COARSE, FINE = Tolerance(1e-4, 1e-6), Tolerance(1e-5, 1e-7)
EFFECT_ONLY = Effort(6, 1e-2, COARSE)
FIRST = Effort(5, 3e-3, COARSE, 0.3)
DECLARED = Effort(8, 1e-2, COARSE, 0.3)
NEXT = Effort(14, 1e-3, COARSE, 0.5)
LAST = Effort(20, 1e-4, FINE)
SHIFTED = Effort(3, 1e-3, COARSE)
HELD_OUT = Effort(10, 1e-4, FINE)
DROP_FACTOR = 25.0
KEPT_AFTER_FIRST, POLISHED, BEAM = 6, 4, 3
UNEVEN, NEAR, FAR = 1.12, 3.0, 30.0
SHIFTS = (0.9, 1.1, 0.6, 1.6)
VISIBLE_SHARE = 0.03


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
    input_noise: tuple[float | None, ...]


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
        fit_parameters(task.model, task.train, free, task.fixed, None, DECLARED, task.executor)
        for free in (task.free, tuple(_shifted(f) for f in task.free))
    ]
    best = min(fits, key=lambda fit: fit.cost)
    last = fit_parameters(
        task.model, task.train, _restarted(best), task.fixed, best.z, LAST, task.executor
    )
    return judge(task, escape(task, Trial((), min(best, last, key=lambda fit: fit.cost))))


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


def try_candidates(
    task: Task, bases: Sequence[Trial], candidates: Sequence[Candidate]
) -> list[Trial]:
    """Refit every base with each candidate added; the best are polished and judged, best first."""
    first = _first_round(task, bases, candidates)
    second = _continue(task, _best(first, KEPT_AFTER_FIRST), FIRST)
    third = _continue(task, _best(second, POLISHED), NEXT)
    task.progress("polishing the best candidates")
    polished = _continue(task, _best(third, POLISHED), LAST)
    polished = [escape(task, t) if t is polished[0] else t for t in polished]
    judged = [judge(task, trial) for trial in polished]
    dropped = [t for t in (*third, *second, *first) if t.keys not in {j.keys for j in judged}]
    unique = {t.keys: t for t in reversed(dropped)}
    return sorted(judged, key=held_out_cost) + sorted(unique.values(), key=lambda t: t.train.cost)


def scores(task: Task, base: Trial, candidates: Sequence[Candidate]) -> dict[str, Score]:
    """Score of every candidate at the optimum of `base`."""
    names = list(task.model.parameter_names)
    wanted = sorted({name for c in candidates for name in c.parameters})
    columns = np.array([names.index(name) for name in wanted], dtype=np.int64)
    p = task.model.parameter_vector(dict(base.train.values))

    def derivatives(pair: tuple[Run, FloatArray]) -> FloatArray:
        return evaluate(task.model, pair[0], p, pair[1], columns, True, COARSE).by_parameter

    pairs = list(zip(base.train.runs, base.train.z, strict=True))
    by_run = list(task.executor.map(derivatives, pairs))
    return {
        c.key: score(base.train, [d[:, [wanted.index(n) for n in c.parameters]] for d in by_run])
        for c in candidates
    }


def held_out_cost(trial: Trial) -> float:
    """Mean square of the held-out residuals; infinite when not judged."""
    if trial.validate is None or trial.validate.failed:
        return np.inf
    return mean_square(trial.validate.pairs())


def _first_round(
    task: Task, bases: Sequence[Trial], candidates: Sequence[Candidate]
) -> list[Trial]:
    """The best start of every candidate after a few coarse iterations.

    The parameters of the candidate move alone first, so that the declared ones are not bent to
    stand in for an effect that is still far from its place.
    """
    jobs = [
        (base, candidate, start, values, z)
        for base in bases
        for candidate in candidates
        if candidate.key not in base.keys
        for values, z in _origins(task, base, candidate)
        for start in candidate.starts
    ]
    task.progress(f"trying {len(candidates)} candidates from {len(jobs)} starts")

    best: dict[tuple[str, ...], Trial] = {}
    for base, candidate, start, values, z in jobs:
        fit = fit_parameters(task.model, task.train, start, values, z, EFFECT_ONLY, task.executor)
        trial = Trial((*base.candidates, candidate), _all_free(base, fit))
        if trial.keys not in best or fit.cost < best[trial.keys].train.cost:
            best[trial.keys] = trial
    return list(best.values())


def _origins(
    task: Task, base: Trial, candidate: Candidate
) -> list[tuple[dict[str, float], list[FloatArray]]]:
    """Where searches begin: the optimum of `base`; for the first effect also the table start."""
    optimum = (dict(base.train.values), list(base.train.z))
    if base.candidates or candidate.is_declared_value:
        return [optimum]
    rest = [np.zeros(len(run.unknowns)) for run in task.train]
    return [({**base.train.values, **all_values_at_start(task.free)}, rest), optimum]


def _all_free(base: Trial, fit: Fit) -> Fit:
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


def _best(trials: Sequence[Trial], count: int) -> list[Trial]:
    """At most `count` trials, none far worse than the best."""
    ordered = sorted(trials, key=lambda trial: trial.train.cost)
    return [t for t in ordered[:count] if t.train.cost <= DROP_FACTOR * ordered[0].train.cost]


def _continue(task: Task, trials: Sequence[Trial], effort: Effort) -> list[Trial]:
    continued = []
    for trial in trials:
        free = _restarted(trial.train)
        fit = fit_parameters(
            task.model, task.train, free, _fixed(task, free), trial.train.z, effort, task.executor
        )
        kept = fit if fit.cost <= 1.02 * trial.train.cost else trial.train
        continued.append(replace(trial, train=kept))
    return sorted(continued, key=lambda trial: trial.train.cost)


def escape(task: Task, trial: Trial) -> Trial:
    """Leave a local minimum near the floor: some run is worse than rounding alone explains.

    Bounces in a gap make the cost piecewise smooth, with minima that differ by a few per cent in
    one parameter; each parameter in turn is shifted and the fit continued from there.
    """
    best = _from_table(task, trial)
    for shift in SHIFTS:
        for index in range(len(trial.train.free)):
            if not _is_uneven(best.train):
                return best
            free = list(_restarted(best.train))
            start = float(np.clip(shift * free[index].start, free[index].lower, free[index].upper))
            free[index] = replace(free[index], start=start)
            z = best.train.z
            fit = fit_parameters(
                task.model, task.train, free, _fixed(task, free), z, SHIFTED, task.executor
            )
            if fit.cost < 0.998 * best.train.cost:
                task.progress(f"escaped by {free[index].name}: {fit.rms_counts():.3f} counts rms")
                best = _continue(task, [replace(best, train=fit)], LAST)[0]
    return best


def _from_table(task: Task, trial: Trial) -> Trial:
    """Refit with the declared parameters back at their table start, the effect kept."""
    if not trial.candidates or not _is_uneven(trial.train, FAR):
        return trial
    free = tuple(
        f if f.table is None else replace(f, start=f.table) for f in _restarted(trial.train)
    )
    fixed, z = _fixed(task, free), trial.train.z
    fit = fit_parameters(task.model, task.train, free, fixed, z, NEXT, task.executor)
    if fit.cost >= 0.998 * trial.train.cost:
        return trial
    return _continue(task, [replace(trial, train=fit)], LAST)[0]


def without_idle(task: Task, trial: Trial) -> list[Trial]:
    """Refits of a trial of several candidates with each one taken out, from the optimum found."""
    smaller = []
    for idle in trial.candidates if len(trial.candidates) > 1 else ():
        kept = tuple(c for c in trial.candidates if c is not idle)
        free = tuple(f for f in _restarted(trial.train) if f.name not in idle.parameters)
        fixed, z = _fixed(task, free), trial.train.z
        fit = fit_parameters(task.model, task.train, free, fixed, z, LAST, task.executor)
        smaller.append(judge(task, Trial(kept, fit)))
    return smaller


def _is_uneven(fit: Fit, near: float = NEAR) -> bool:
    """Near the floor in total, but not in every run."""
    floor = floor_counts(fit.pairs())
    if fit.rms_counts() > near * floor:
        return False
    worst = max(float(np.sqrt(np.mean(run_counts(r, e) ** 2))) for r, e in fit.pairs())
    return worst > UNEVEN * floor
