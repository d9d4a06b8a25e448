"""Leave local minima and flat valleys.

Breakaways and bounces in a gap make the cost piecewise smooth, and two effects at once can nearly
stand in for one another: a search that gained little in two steps may still be far from its end.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ptp_symbolic.diagnose.floor import floor_counts
from ptp_symbolic.diagnose.trial import (
    FINE,
    LAST,
    NEARBY_COUNTS,
    NEXT,
    SMOOTH,
    Task,
    Trial,
    continue_fits,
    moved,
    refit,
    restarted,
    start_afresh,
)
from ptp_symbolic.diagnose.verdict import AT_FLOOR
from ptp_symbolic.identify.coordinates import FreeParameter
from ptp_symbolic.identify.fit import Effort, Fit, fit_parameters, run_counts

AGAIN, ROUNDS, SETTLED = Effort(8, 1e-3, FINE, secants=True), 4, 0.97
PLACES = Effort(10, 1e-4, FINE)
UNEVEN, NEAR, FAR = 1.2, 3.0, 30.0
HOP, HOPS = 0.05, 6


def escape(task: Task, trial: Trial) -> Trial:
    """Go on until nothing is gained: by derivatives over finite steps too for several effects, and
    where a run is worse than rounding alone explains.
    """
    best = _from_table(task, trial)
    if best.train.rms_counts() > NEARBY_COUNTS:
        return best
    for index in range(ROUNDS * max(len(trial.candidates), 1)):
        before = best.train.cost
        if _is_open(best):
            best = _with_new_places(task, best)
        best = continue_fits(task, [best], SMOOTH)[0]
        if _is_open(best):
            best = continue_fits(task, [best], AGAIN)[0]
            task.progress(f"leaving a local minimum: {best.train.rms_counts():.3f} counts rms")
        if best.train.cost > SETTLED * before and best.candidates and _is_uneven(best.train):
            best = _elsewhere(task, best, index + 1)
        if best.train.cost > SETTLED * before:
            break
    return best


def _is_open(trial: Trial) -> bool:
    """Whether there may be more to gain."""
    return len(trial.candidates) > 1 or _is_uneven(trial.train)


def _elsewhere(task: Task, trial: Trial, seed: int) -> Trial:
    """`trial` refitted from elsewhere, or itself if nothing clearly better is found.

    Two effects can share a valley so flat that where it was entered decides where the search ends:
    each in turn begins again at its own starts. One breakaway at the wrong sample is a minimum of
    its own; which way leads out, nobody knows: every parameter begins a little way off.
    """
    if len(trial.candidates) > 1:
        starts = [start for candidate in trial.candidates for start in candidate.starts]
        looks = [_refitted(task, trial, _restarted_at(trial.train, s), NEXT) for s in starts]
        best = continue_fits(task, [min(looks, key=lambda look: look.train.cost)], LAST)[0]
        if best.train.cost < SETTLED * trial.train.cost:
            return best
    chance = np.random.default_rng(seed)
    for _ in range(HOPS):
        begun = moved(trial.train, HOP * chance.choice([-1.0, 1.0], len(trial.train.free)))
        hopped = _refitted(task, trial, begun, LAST)
        if hopped.train.cost < SETTLED * trial.train.cost:
            return hopped
    return trial


def _restarted_at(fit: Fit, start: Sequence[FreeParameter]) -> list[FreeParameter]:
    """The free parameters of `fit`, those of `start` begun there and the others where it ended."""
    elsewhere = {f.name: f.start for f in start}
    return [replace(f, start=elsewhere.get(f.name, f.start)) for f in restarted(fit)]


def _refitted(task: Task, trial: Trial, begun: Sequence[FreeParameter], effort: Effort) -> Trial:
    """`trial` fitted anew, its parameters begun as given."""
    return replace(trial, train=refit(task, begun, trial.train.z, effort))


def _from_table(task: Task, trial: Trial) -> Trial:
    """Refit with the declared parameters back at their table start, the effect kept."""
    if not trial.candidates or not _is_uneven(trial.train, FAR):
        return trial
    again = start_afresh(task, trial, NEXT)
    if again.train.cost >= SETTLED * trial.train.cost:
        return trial
    return continue_fits(task, [again], LAST)[0]


def _with_new_places(task: Task, trial: Trial) -> Trial:
    """`trial` with every run begun where that run alone fits best, its place in a gap sought anew:
    one that suited earlier parameters holds the others back.
    """
    fit = trial.train
    alone = fit_parameters(task.model, task.train, (), fit.values, fit.z, PLACES, task.executor)
    if alone.failed or alone.cost >= fit.cost:
        return trial
    return replace(trial, train=replace(fit, z=alone.z))


def _is_uneven(fit: Fit, near: float = NEAR) -> bool:
    """Near the floor in total, but not on it in every run."""
    floor = floor_counts(fit.pairs())
    if fit.rms_counts() > near * floor:
        return False
    if fit.rms_counts() > AT_FLOOR * floor:
        return True
    worst = max(float(np.sqrt(np.mean(run_counts(r, e) ** 2))) for r, e in fit.pairs())
    return worst > UNEVEN * floor
