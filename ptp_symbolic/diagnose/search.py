"""Search the missing effect: refit every candidate, keep the best, judge on held-out runs.

The score test orders nothing away: an effect inside a gap has no usable gradient where it vanishes.
Poor candidates are dropped after a few iterations, in rounds that do not depend on which thread is
faster.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.diagnose.candidates import Candidate
from ptp_symbolic.diagnose.escape import escape
from ptp_symbolic.diagnose.scores import Score, score, share_left
from ptp_symbolic.diagnose.starts import first_round
from ptp_symbolic.diagnose.trial import (
    COARSE,
    FINE,
    LAST,
    NEARBY_COUNTS,
    NEXT,
    SMOOTH,
    Task,
    Trial,
    continue_fits,
    held_out_cost,
    refit,
    restarted,
    simulated,
    start_afresh,
)
from ptp_symbolic.identify.coordinates import FreeParameter
from ptp_symbolic.identify.evaluate import evaluate
from ptp_symbolic.identify.fit import Effort, all_values_at_start, fit_parameters, unblinded
from ptp_symbolic.identify.run import Run

FloatArray = NDArray[np.float64]

FIRST = Effort(5, 3e-3, COARSE, 0.3, secants=True)
DECLARED = Effort(8, 1e-2, COARSE, 0.3)
MENDED = Effort(10, 2e-3, COARSE, secants=True)
HELD_OUT = Effort(10, 1e-4, FINE)
DROP_FACTOR, CLOSE_FACTOR, CLOSE_COST = 25.0, 1.5, 4.0
PURSUED, FINISHED, BEAM = 3, 3, 3
VISIBLE_SHARE = 0.03


def fit_declared(task: Task) -> Trial:
    """Fit the declared model, from the table start and from a start a factor of 2 away."""
    task.progress("fitting the declared model")
    fits = [
        fit_parameters(task.model, task.train, free, task.fixed, None, DECLARED, task.executor)
        for free in (task.free, tuple(_shifted(f) for f in task.free))
    ]
    trials = _best([Trial((), fit) for fit in fits], len(fits), CLOSE_COST)
    trial = continue_fits(task, trials, MENDED)[0]
    if trial.train.rms_counts() < NEARBY_COUNTS:
        trial = continue_fits(task, [trial], LAST)[0]
    task.progress(f"the declared model leaves {trial.train.rms_counts():.3f} counts rms")
    return judge(task, escape(task, trial))


def _shifted(free: FreeParameter) -> FreeParameter:
    """The same parameter started elsewhere: half the value where it can only be positive."""
    value = 0.5 * free.start if free.logarithmic else free.start
    return replace(free, start=float(np.clip(value, free.lower, free.upper)))


def judge(task: Task, trial: Trial) -> Trial:
    """Fit only the starts of the held-out runs with the parameters of `trial`, and let it see what
    its intervals need.
    """
    held_out = fit_parameters(
        task.model, task.validate, (), trial.train.values, None, HELD_OUT, task.executor
    )
    return replace(trial, train=unblinded(trial.train, task.executor), validate=held_out)


def try_candidates(
    task: Task, bases: Sequence[Trial], candidates: Sequence[Candidate]
) -> list[Trial]:
    """Refit every base with each candidate added; the best are polished and judged, best first.

    Of several effects at once more are pursued: in their flat valleys the order is late to show.
    """
    effects = len(bases[0].candidates) + 1
    groups, left = first_round(task, bases, candidates)
    second = [freed for group in groups for freed in _freed(task, group)]
    third = _distinct(
        [
            trial
            for group in second
            for trial in continue_fits(task, _best(group, PURSUED * effects, DROP_FACTOR), NEXT)
        ]
    )
    task.progress("polishing the best candidates")
    chosen = _best(third, FINISHED * effects, CLOSE_FACTOR**effects)
    polished = continue_fits(task, chosen, LAST)
    best = continue_fits(task, polished[:FINISHED], SMOOTH)
    best[:1] = [escape(task, trial) for trial in best[:1]]
    judged = [judge(task, trial) for trial in (*best, *polished[FINISHED:])]
    for trial in sorted(judged, key=held_out_cost):
        error = np.sqrt(held_out_cost(trial))
        task.progress(f"{' + '.join(trial.keys)}: {error:.3f} counts rms on held-out runs")
    dropped = [
        replace(t, train=t.train.lightened())
        for t in (*third, *(t for group in second for t in group))
        if t.keys not in {j.keys for j in judged}
    ]
    unique = {t.keys: t for t in reversed(dropped)}
    ordered = sorted(unique.values(), key=lambda t: t.train.cost)
    return sorted(judged, key=held_out_cost) + ordered + left


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


def visible_candidates(
    task: Task, base: Trial, candidates: Sequence[Candidate], scored: Mapping[str, Score]
) -> list[Candidate]:
    """Candidates that the declared parameters cannot absorb.

    Where the score says absorbed, the response to a start of finite size decides: the derivative of
    an effect that only moves breakaways or bounces tells nothing where the effect vanishes.
    """

    def is_visible(candidate: Candidate) -> bool:
        if scored[candidate.key].share_left >= VISIBLE_SHARE:
            return True
        changed = simulated(task, base.train, all_values_at_start(candidate.starts[0]))
        if any(e.failed for e in changed):
            return True
        return share_left(base.train, [e.residual for e in changed]) >= VISIBLE_SHARE

    return [c for c in candidates if is_visible(c)]


def _freed(task: Task, group: Sequence[Trial]) -> list[list[Trial]]:
    """Free the declared parameters of a group; several effects at once are also started afresh."""
    freed = [continue_fits(task, group, FIRST)]
    several = [t for t in group if len(t.candidates) > 1]
    return freed + ([[start_afresh(task, t, FIRST) for t in several]] if several else [])


def _distinct(trials: Sequence[Trial]) -> list[Trial]:
    """The best trial of every set of effects."""
    best: dict[tuple[str, ...], Trial] = {}
    for trial in sorted(trials, key=lambda trial: trial.train.cost):
        best.setdefault(trial.keys, trial)
    return list(best.values())


def _best(trials: Sequence[Trial], count: int, factor: float) -> list[Trial]:
    """At most `count` trials, none above `factor` times the cost of the best."""
    ordered = sorted(trials, key=lambda trial: trial.train.cost)
    return [t for t in ordered[:count] if t.train.cost <= factor * ordered[0].train.cost]


def without(task: Task, trial: Trial, idle: Candidate, effort: Effort) -> Trial:
    """Refit of a trial with one of its candidates taken out, from the optimum found."""
    kept = tuple(c for c in trial.candidates if c is not idle)
    free = tuple(f for f in restarted(trial.train) if f.name not in idle.parameters)
    return Trial(kept, refit(task, free, trial.train.z, effort))
