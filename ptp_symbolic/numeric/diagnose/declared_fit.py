"""The declared model fitted to the training runs: to whole ones, or led there over windows.

The declared model and the sets that contain it: neither is stuck where the other shows a way.

A set fits no worse than the declared model, which it contains, and what it gains is only worth a
name where the declared model had the same chance.
"""

from dataclasses import replace

import numpy as np

from ptp_symbolic.numeric.diagnose.cut_runs import (
    growing,
    in_windows,
    in_windows_of,
    led_through,
    parted_task,
    settled,
    takes_away_most,
    validation_in_windows,
)
from ptp_symbolic.numeric.diagnose.declared_rows import declared_start
from ptp_symbolic.numeric.diagnose.findings import Search, step_of
from ptp_symbolic.numeric.diagnose.floor import leaves_white_noise
from ptp_symbolic.numeric.diagnose.gain import gain
from ptp_symbolic.numeric.diagnose.left_over import (
    Carried,
    carried_noise,
    left_over,
    with_fewer_samples,
)
from ptp_symbolic.numeric.diagnose.proposals import Proposals
from ptp_symbolic.numeric.diagnose.refits import (
    begun_anew,
    has_rough_starts,
    is_near_floor,
    over_windows,
    polished,
    refitted_in,
    strayed_from_start,
)
from ptp_symbolic.numeric.diagnose.starts import far_starts, taken_over
from ptp_symbolic.numeric.diagnose.trial import Task, Trial, fitted, halving, is_near, ranked
from ptp_symbolic.numeric.identify.constants import ABOVE_NOISE, SCREENED


def beside_declared(task: Task, trial: Trial, declared: Trial, carried: Carried) -> Trial:
    """A trial that fits worse than the declared model, begun anew beside that, its effects as they
    are or at their vanishing values; `carried` as in `Search`.
    """
    own = {name: trial.values[name] for c in trial.candidates for name in c.names}
    off = {n: c.vanishing[f.name] for c in trial.candidates for f in c.defining for n in f.names}
    begun = [
        fitted(task, trial.candidates, values, declared.fit.z, 0, declared.fit)
        for values in (declared.values | own, declared.values | own | off)
    ]
    left = halving(task, begun, 1)
    return ranked([trial, *(polished(task, t, carried) for t in left)])[0]


def declared_from(task: Task, trial: Trial, declared: Trial, carried: Carried) -> Trial | None:
    """The declared model fitted from where a trial ended, as it is and where it takes over what the
    effects did; None unless that is materially better than `declared`, which was in a local minimum
    then.
    """
    left = halving(task, taken_over(task, (), trial), 1)
    again = [polished(task, t, carried) for t in left if is_near(t, [declared])]
    best = ranked([declared, *again])[0]
    return best if gain(best, declared).share >= task.material else None


def fit_declared(task: Task, proposals: Proposals) -> tuple[Task, Trial]:
    """The declared model fitted to whole runs, and over windows where that leaves more than white
    noise; and the task with windows for runs that ask for them.
    """
    if not task.windows:
        return led_over_windows(task, proposals)
    part, trial = over_whole_runs(task, proposals)
    if leaves_white_noise(trial, carried_noise(part, trial.fit)):
        return part, trial
    part, led = led_over_windows(task, proposals)
    return part, better_over_same_runs(trial, led)


def better_over_same_runs(before: Trial, led: Trial) -> Trial:
    """The declared model where windows have `led` it, or where it was before if that is better:
    what begins better does not always end so. What leaves other runs cannot be compared.
    """
    names = [[run.name for run in trial.fit.runs] for trial in (before, led)]
    return ranked([before, led])[0] if names[0] == names[1] else led


def as_fitted_alone(found: Search) -> Search:
    """The search with its declared model led over windows too, as `fit_declared` would, where it
    ended before that and leaves more than white noise: what a set gains is told over the best fit
    of the declared model.
    """
    task = found.task
    if found.is_led or not task.windows or leaves_white_noise(found.declared, found.carried):
        return found
    task.progress("fitting the declared model over windows")
    part, led = led_over_windows(replace(task, candidates=()), found.proposals)
    if [run.name for run in part.train] != [run.name for run in task.train]:
        led = refitted_in(task, led)
    best = better_over_same_runs(found.declared, led)
    if best is found.declared:
        return replace(found, is_led=True)
    chosen = found.chosen if found.chosen.candidates else best
    if chosen.candidates:
        chosen = beside_declared(task, chosen, best, found.carried)
    members = tuple(
        step_of(chosen, s.candidate, s.without if s.without.candidates else best)
        for s in found.members
    )
    return replace(
        found, declared=best, chosen=chosen, members=members, is_led=True, is_taken_over=False
    )


def over_whole_runs(task: Task, proposals: Proposals) -> tuple[Task, Trial]:
    """The declared model fitted to whole runs from the rows' start and from the declared one; the
    task as in `led_over_windows`.
    """
    starts = [proposals.start, declared_start(task)]
    run = task.executor
    begun = [fitted(task, (), values, None, executor=run) for values in starts]
    best = halving(task, begun, 1) or begun[-1:]
    return _in_windows_of_its_own(task, polished(task, best[0], carried_noise(task, best[0].fit)))


def led_over_windows(task: Task, proposals: Proposals) -> tuple[Task, Trial]:
    """The declared model, from where windows lead from the rows' start and from the declared one,
    and from those two themselves; where runs are windows already, from starts far off too, and from
    where shorter ones lead. And the task with windows for runs that multiply small errors (see
    `in_windows`), which would lead the fit astray.
    """
    starts = [proposals.start, declared_start(task)]
    spread = far_starts(task.free, proposals.start) if has_rough_starts(task) else []
    begun = over_windows(task, (), starts, spread)
    if begun:
        part = in_windows(task, begun[0])
        if part is not task:
            task, led = part, fitted(part, (), begun[0].values, None)
            begun = [settled(task, led, task.executor)]
    begun += [fitted(task, (), values, None, executor=task.executor) for values in starts]
    if not task.windows:
        far = [fitted(task, (), values, None, executor=task.executor) for values in spread]
        begun += halving(task, far, SCREENED)
        begun.append(fitted(task, (), led_through(growing(task), (), proposals.start), None))
    best = halving(task, begun, 1) or begun[-1:]
    return _in_windows_of_its_own(task, polished(task, best[0], carried_noise(task, best[0].fit)))


def _in_windows_of_its_own(task: Task, trial: Trial) -> tuple[Task, Trial]:
    """The task with its runs parted and cut where the declared model asks for it, and the trial
    refitted there. The length of windows was chosen at the start values, which may multiply fewer
    errors than the fitted ones: what these leave may seem to be noise of the inputs, which can push
    a simulation to the other side of a rest.
    """
    task, trial = _where_most_goes(parted_task(task, trial), task, trial)
    part = in_windows(task, trial)
    if part is not task:
        short = refitted_in(part, trial)
        if np.all(left_over(short.fit) <= left_over(trial.fit)):
            task, trial = part, short
    if not task.windows and np.any(left_over(trial.fit) > ABOVE_NOISE):
        part = in_windows_of(task, trial)
        if part is not task:
            part = with_fewer_samples(part, trial.values)
            task, trial = _where_most_goes(part, task, trial)
    trial = _led_back(task, trial)
    return validation_in_windows(task, trial), trial


def _led_back(task: Task, trial: Trial) -> Trial:
    """The declared model, or a better end from where parameters that have strayed are back where a
    start may be (see `begun_anew`), if some iterations gain materially: one that went where it does
    nothing has no derivative that leads back, and what makes up for it is no effect.
    """
    strayed = strayed_from_start(task, trial.values)
    if not strayed or (is_near_floor(trial) and not trial.fit.failed):
        return trial
    left = halving(task, begun_anew(task, trial), 1)
    if not left or not (trial.fit.failed or gain(left[0], trial).share >= task.material):
        return trial
    return polished(task, left[0], carried_noise(task, left[0].fit))


def _where_most_goes(part: Task, task: Task, trial: Trial) -> tuple[Task, Trial]:
    """The task in parts and the trial refitted there, if that takes away most of what is left."""
    if part is task:
        return task, trial
    short = refitted_in(part, trial)
    return (part, short) if takes_away_most(short, trial) else (task, trial)
