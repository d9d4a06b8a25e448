"""Refits of a set by simulation: over short windows first, then whole runs, at last to the end."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.diagnose.candidates import FAR_OFF, Candidate
from ptp_symbolic.numeric.diagnose.cut_runs import settled, shares_of_usual, starts_of
from ptp_symbolic.numeric.diagnose.floor import leaves_white_noise
from ptp_symbolic.numeric.diagnose.left_over import Carried, carried_noise, left_over
from ptp_symbolic.numeric.diagnose.linear import (
    effect_of,
    projected_off,
    stacked_jacobian,
    stacked_residual,
)
from ptp_symbolic.numeric.diagnose.trial import (
    SHARP,
    Task,
    Trial,
    continued,
    fitted,
    halving,
    is_alike,
    ranked,
)
from ptp_symbolic.numeric.identify.constants import (
    ABOVE_NOISE,
    CYCLES,
    FORGOTTEN,
    NEARBY,
    ROUGH,
    STEP,
    TRIED,
    TUNING,
    WIDE_STEP,
)
from ptp_symbolic.numeric.identify.coordinates import FreeParameter
from ptp_symbolic.numeric.identify.evidence import recorded
from ptp_symbolic.numeric.identify.fit import Fit
from ptp_symbolic.numeric.identify.run_starts import has_linked
from ptp_symbolic.numeric.identify.simulations import POLISH

FloatArray = NDArray[np.float64]


def refitted_in(part: Task, trial: Trial) -> Trial:
    """A trial fitted to its end to runs in parts, whose starts are begun at their guesses."""
    begun = fitted(part, trial.candidates, trial.values, None)
    return polished(part, begun, carried_noise(part, begun.fit))


def without_misleading(trial: Trial) -> Trial:
    """The trial with its record of misleading derivatives cleared: they are looked for anew."""
    return replace(trial, fit=replace(trial.fit, misleading=None))


def over_windows(
    task: Task,
    candidates: Sequence[Candidate],
    starts: Sequence[Mapping[str, float]],
    spread: Sequence[Mapping[str, float]] = (),
) -> list[Trial]:
    """The trial that begins where fits over ever longer windows lead from the best of `starts`, and
    of those `spread` further off where these leave more than white noise: a whole run that sticks
    where the machine slid leads a fit astray, windows do not (multiple shooting: Bock, 1983). None
    where the runs are windows already, or no fit succeeds.

    Whatever they leave, windows that leave far more than usual hardly count: they are many, and
    only lead the way.
    """
    best: Trial | None = None
    for windows in task.windows:
        part = replace(task, train=windows, robust_below=np.inf)

        def begin(
            values: Mapping[str, float],
            z: Sequence[FloatArray] | None = None,
            part: Task = part,
        ) -> Trial:
            return fitted(part, candidates, values, z, executor=task.executor)

        near = starts if best is None else [best.values]
        begun = halving(part, [begin(values) for values in near], 1)
        if best is None and not (begun and np.all(left_over(begun[0].fit) <= ABOVE_NOISE)):
            known = begun[0].fit.z if begun else None
            far = halving(part, [begin(values, known) for values in spread], TRIED, iterations=1)
            begun = ranked([*begun, *halving(part, far, 1)])
        if not begun:
            return []
        best = settled(part, begun[0], task.executor, brief=bool(candidates))
    return [fitted(task, candidates, best.values, None, executor=task.executor)] if best else []


def polished(task: Task, trial: Trial, carried: Carried) -> Trial:
    """The trial fitted to its end, and begun anew where that is near the floor."""
    trial = to_its_end(task, trial, carried)
    if not is_near_floor(trial):
        return trial
    return started_anew(task, _in_time(task, trial, carried), carried)


def is_near_floor(trial: Trial) -> bool:
    """Whether a trial leaves at most NEARBY times the noise of every signal."""
    return bool(np.all(left_over(trial.fit) <= NEARBY))


def _in_time(task: Task, trial: Trial, carried: Carried) -> Trial:
    """The trial, or a better end past valleys in which friction lets go a sample late somewhere: a
    drive soon forgets it, so that blocks of runs tell it from the parameters, where the sum of all
    squares pays for it with parameters that are wrong everywhere (see `identify.robust_loss`).
    Where runs are windows, these are such blocks.
    """
    for _ in range(CYCLES if task.windows else 0):
        if leaves_white_noise(trial, carried):
            return trial
        candidates, z, run = trial.candidates, trial.fit.z, task.executor
        eased = fitted(task, candidates, trial.values, z, POLISH, block=FORGOTTEN, executor=run)
        if eased.fit.failed:
            return trial
        before, trial = trial, ranked([trial, to_its_end(task, eased, carried)])[0]
        if is_alike(trial, before):
            break
    return trial


def started_anew(task: Task, trial: Trial, carried: Carried) -> Trial:
    """The trial, or a better end from elsewhere: with starts of the runs looked for anew, and with
    declared parameters that have strayed back at their starts or as far off as a start may be.

    Places in a gap that have followed the parameters keep these in place, and a parameter that the
    others' errors drove to where it does nothing has no derivative that leads back.
    """
    if leaves_white_noise(trial, carried):
        return trial
    left = halving(task, begun_anew(task, trial), 1)
    return ranked([trial, *(to_its_end(task, t, carried) for t in left)])[0]


def begun_anew(task: Task, trial: Trial) -> list[Trial]:
    """Where `started_anew` begins; nowhere where every run has a single place to start from."""
    if not has_rough_starts(task):
        return []
    here = fitted(
        task, trial.candidates, trial.values, None, parent=trial.fit, executor=task.executor
    )
    return [here, *strayed_back(task, trial)]


def strayed_back(task: Task, trial: Trial) -> list[Trial]:
    """The trial with declared parameters that have strayed back at their starts, and as far off as
    a start may be, not yet fitted; none where none has.
    """
    run, strayed = task.executor, strayed_from_start(task, trial.values)
    begun: list[Trial] = []
    for factor in (1.0, FAR_OFF, 1.0 / FAR_OFF) if strayed else ():
        back = {n: inside(f, factor * f.start) for f in strayed for n in f.names}
        values = trial.values | back
        z, parent = trial.fit.z, trial.fit
        begun.append(fitted(task, trial.candidates, values, z, parent=parent, executor=run))
    return begun


def has_rough_starts(task: Task) -> bool:
    """Whether runs may begin at several places, in a gap or at rest: the misfit is rough then."""
    return any(u.contact is not None or u.instead for run in task.train for u in run.unknowns)


def strayed_from_start(task: Task, values: Mapping[str, float]) -> list[FreeParameter]:
    """Declared parameters further from where they started than a start may be off."""
    return [
        f
        for f in task.free
        if f.start > 0.0 and not f.start / FAR_OFF <= values[f.name] <= FAR_OFF * f.start
    ]


def inside(free: FreeParameter, value: float) -> float:
    """The value, or the bound of a parameter that it exceeds."""
    return float(np.clip(value, free.lower, free.upper))


def to_its_end(task: Task, trial: Trial, carried: Carried) -> Trial:
    """The trial fitted with derivatives where the motion is smooth, with finite differences where
    friction makes it a staircase, in turn; windows are begun anew where the one before ends.
    """
    for _ in range(CYCLES):
        if has_linked(task.train):
            z = starts_of(trial, task.executor)
            begun = fitted(task, trial.candidates, trial.values, z, executor=task.executor)
            trial = ranked([trial, begun])[0]
        smooth = continued(task, trial, POLISH, executor=task.executor)
        if leaves_white_noise(smooth, carried):
            return _with_strays_begun_anew(task, smooth)
        trial = continued(task, without_misleading(smooth), POLISH, ROUGH, WIDE_STEP, task.executor)
        if is_alike(trial, smooth):
            break
    return trial


def _with_strays_begun_anew(task: Task, trial: Trial) -> Trial:
    """The trial, or a better end with its windows begun where the one before ends, if one of them
    leaves so much that it hardly counts: its start went astray then while the parameters moved.
    """
    if not has_linked(task.train) or np.all(shares_of_usual(trial) <= TUNING**2):
        return trial
    z = starts_of(trial, task.executor)
    return continued(task, trial, POLISH, executor=task.executor, z=z)


def sharpened(task: Task, trial: Trial, carried: Carried) -> Trial:
    """A polished trial fitted on with sharp simulations, where little but noise is left."""
    if trial.fit.failed or not leaves_white_noise(trial, carried):
        return trial
    trial = continued(task, trial, POLISH, SHARP, executor=task.executor)
    return continued(task, without_misleading(trial), POLISH, SHARP, STEP, task.executor)


def without_run(task: Task, trial: Trial, name: str) -> Fit:
    """The trial fitted on without the run, or the windows, of a log."""
    kept = [k for k, run in enumerate(trial.fit.runs) if run.source != name]
    part = replace(task, train=tuple(trial.fit.runs[k] for k in kept))
    z = [trial.fit.z[k] for k in kept]
    run = task.executor
    return fitted(part, trial.candidates, trial.values, z, POLISH, executor=run).fit


@recorded()
def expected_gain(trial: Trial, vanishing: Mapping[str, float]) -> float:
    """The share of the squared residual with the parameters in `vanishing` at their values there
    that those at the fit take away, by linear prediction from the Jacobian.
    """
    fit = trial.fit
    residual = stacked_residual(fit)
    columns = stacked_jacobian(fit)
    others = [k for k, f in enumerate(fit.free) if f.name not in vanishing]
    effect = projected_off(effect_of(fit, vanishing, columns)[:, None], columns[:, others])[:, 0]
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
