"""Refits of a set by simulation: over short windows first, then whole runs, at last to the end."""

from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.diagnose.candidates import Candidate
from ptp_symbolic.diagnose.floor import carried_noise, leaves_white_noise, left_over
from ptp_symbolic.diagnose.linear import effect_of, outside, stacked
from ptp_symbolic.diagnose.proposals import Proposals, declared_start
from ptp_symbolic.diagnose.trial import (
    Task,
    Trial,
    continued,
    fitted,
    halving,
    is_alike,
    mean_squares,
    ranked,
)
from ptp_symbolic.identify.constants import (
    AT_BOUND,
    CYCLES,
    ITERATIONS,
    LAST_RUNG,
    NEARBY,
    POLISH,
    ROUGH,
    SHARP,
    STEP,
    WIDE_STEP,
)
from ptp_symbolic.identify.coordinates import limits, to_search
from ptp_symbolic.identify.fit import Fit
from ptp_symbolic.identify.gap_places import gears_in_place
from ptp_symbolic.identify.windows import without_chaos

FloatArray = NDArray[np.float64]


def fit_declared(task: Task, proposals: Proposals) -> Trial:
    """The declared model, from where windows lead from the rows' start and from the declared one,
    and from those two themselves.
    """
    starts = [proposals.start, declared_start(task)]
    begun = over_windows(task, (), starts, task.executor)
    begun += [fitted(task, (), values, None) for values in starts]
    best = halving(task, begun, LAST_RUNG) or begun[-1:]
    return polished(task, best[0], carried_noise(task, best[0].fit))


def refitted_without_chaos(task: Task, declared: Trial) -> tuple[Task, Trial]:
    """The task with runs cut into windows where the fitted model carries the noise of the inputs
    further than the noise of the outputs (see `without_chaos`), and the declared model refitted.
    """
    model, noise = task.model, task.input_noise
    p = model.parameter_vector(declared.values)
    left = np.sqrt(mean_squares(declared.fit.evaluations, task.train))
    train = without_chaos(model, task.train, declared.fit.z, left, p, noise)
    if len(train) == len(task.train):
        return task, declared
    task.progress("refitting, runs that multiply the noise of their inputs in windows")
    starts = [run.guess for run in task.validate]
    any_left = np.zeros((len(starts), left.shape[1]))
    validate = without_chaos(model, task.validate, starts, any_left, p, noise)
    task = replace(task, train=train, validate=validate)
    begun = fitted(task, (), declared.values, None)
    return task, polished(task, begun, carried_noise(task, begun.fit))


def unbiased(trial: Trial) -> Trial:
    """The trial with nothing known of which derivatives mislead: they are looked for anew."""
    return replace(trial, fit=replace(trial.fit, misleading=None))


def over_windows(
    task: Task,
    candidates: Sequence[Candidate],
    starts: Sequence[Mapping[str, float]],
    executor: Executor | None = None,
) -> list[Trial]:
    """The trial that begins where fits over ever longer windows lead from the best of `starts`: a
    whole run that sticks where the machine slid leads a fit astray, windows do not (multiple
    shooting: Bock, 1983). None where the runs are windows already, or no fit succeeds.
    """
    trials: list[Trial] = []
    for windows in task.windows:
        part = replace(task, train=windows)
        trials = [
            fitted(part, candidates, values, None, ITERATIONS, executor=executor)
            for values in ([t.values for t in trials] or starts)
        ]
        trials = [settled(part, ranked(trials)[0], executor)]
        if trials[0].fit.failed:
            return []
    return [fitted(task, candidates, t.values, None) for t in trials]


def settled(task: Task, trial: Trial, executor: Executor | None) -> Trial:
    """The trial fitted on until some iterations more change next to nothing, the gears put in their
    places anew each time: a window that began on the wrong side of a gap holds the others back.
    """
    for _ in range(CYCLES):
        fit = trial.fit
        z = gears_in_place(fit.model, fit.runs, fit.values, fit.z, fit.tolerance, executor)
        begun = replace(trial, fit=replace(fit, z=tuple(z)))
        better = continued(task, begun, ITERATIONS, executor=executor)
        if is_alike(better, trial):
            break
        trial = better
    return trial


def polished(task: Task, trial: Trial, carried: FloatArray) -> Trial:
    """The trial fitted to its end, and from there with starts of its runs that are looked for anew
    where that end is near the floor.
    """
    trial = _to_its_end(task, trial, carried)
    near = bool(np.all(left_over(trial.fit) <= NEARBY))
    return started_anew(task, trial, carried) if near else trial


def started_anew(task: Task, trial: Trial, carried: FloatArray) -> Trial:
    """The trial, or a better end from elsewhere: with declared parameters that ended at a bound
    back at their starts, and with starts of the runs looked for anew. A bound lets no step tell
    what lies inside, and places in a gap that have followed the parameters keep these in place.
    """
    unsure = any(u.contact is not None or u.instead for run in task.train for u in run.unknowns)
    if not unsure:
        return trial
    bound = at_bounds(trial.fit)
    inside = {n: f.start for f in task.free if f.name in bound for n in f.names}
    ways = [({**trial.values, **inside}, trial.fit.z)] if inside else []
    for values, z in (*ways, (trial.values, None)):
        if leaves_white_noise(trial, carried):
            break
        again = fitted(task, trial.candidates, values, z, parent=trial.fit)
        trial = ranked([trial, _to_its_end(task, again, carried)])[0]
    return trial


def at_bounds(fit: Fit) -> set[str]:
    """The free parameters that ended where one step may reach a bound."""
    phi, (lower, upper) = to_search(fit.free, fit.values), limits(fit.free)
    near = np.minimum(phi - lower, upper - phi) <= AT_BOUND
    return {f.name for f, ended in zip(fit.free, near, strict=True) if ended}


def _to_its_end(task: Task, trial: Trial, carried: FloatArray) -> Trial:
    """The trial fitted with derivatives where the motion is smooth, with finite differences where
    friction makes it a staircase, in turn.
    """
    for _ in range(CYCLES):
        smooth = continued(task, trial, POLISH, executor=task.executor)
        if leaves_white_noise(smooth, carried):
            return smooth
        trial = continued(task, unbiased(smooth), POLISH, ROUGH, WIDE_STEP, task.executor)
        if is_alike(trial, smooth):
            break
    return trial


def sharpened(task: Task, trial: Trial, carried: FloatArray) -> Trial:
    """A polished trial fitted on with sharp simulations, where little but noise is left."""
    if trial.fit.failed or not leaves_white_noise(trial, carried):
        return trial
    trial = continued(task, trial, POLISH, SHARP, executor=task.executor)
    return continued(task, unbiased(trial), POLISH, SHARP, STEP, task.executor)


def expected_gain(trial: Trial, vanishing: Mapping[str, float]) -> float:
    """The share of the squared residual with the parameters in `vanishing` at their values there
    that those at the fit take away, predicted from the derivatives.
    """
    fit = trial.fit
    residual = stacked(fit, [e.residual[:, None] for e in fit.evaluations])[:, 0]
    columns = stacked(fit, [e.by_parameter for e in fit.evaluations])
    others = [k for k, f in enumerate(fit.free) if f.name not in vanishing]
    effect = outside(effect_of(fit, vanishing, columns)[:, None], columns[:, others])[:, 0]
    taken = float(effect @ effect)
    return taken / max(taken + float(residual @ residual), 1e-300)


def forms(task: Task, candidate: Candidate) -> list[Candidate]:
    """All forms of a candidate, a scanned frequency where it was found."""
    starts = {f.name: f for f in candidate.free}
    return [
        replace(c, free=tuple(starts.get(f.name, f) for f in c.free))
        for c in task.candidates
        if c.key == candidate.key
    ]


def fullest(task: Task, candidate: Candidate) -> Candidate:
    """The form of a candidate with the most parameters."""
    best = max(forms(task, candidate), key=lambda c: len(c.free))
    return best if len(best.free) > len(candidate.free) else candidate
