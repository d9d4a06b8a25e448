"""What is left of a set when all that cannot be confirmed is taken out, or made simpler."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import NamedTuple

from ptp_symbolic.numeric.diagnose.candidates import with_what_needs_it
from ptp_symbolic.numeric.diagnose.confirm import (
    answers_to_inputs,
    at_bound,
    breaks_its_law,
    why_unconfirmed,
)
from ptp_symbolic.numeric.diagnose.findings import Refusals, Step, step_of
from ptp_symbolic.numeric.diagnose.floor import (
    Floor,
    floor_of,
    leaves_noise_alone,
    leaves_noise_of_inputs,
)
from ptp_symbolic.numeric.diagnose.gain import Gain, gain, gain_in_innovations
from ptp_symbolic.numeric.diagnose.groups import Rival
from ptp_symbolic.numeric.diagnose.held_out import held_out_fit, held_out_gain
from ptp_symbolic.numeric.diagnose.refits import expected_gain, forms, without_run
from ptp_symbolic.numeric.diagnose.seeker import Seeker, begun_in_form, simplified
from ptp_symbolic.numeric.diagnose.trial import Task, Trial
from ptp_symbolic.numeric.identify.fit import Fit
from ptp_symbolic.numeric.identify.replays import estimable, with_finite_differences


class Weakness(NamedTuple):
    """A candidate that is not confirmed, and why not."""

    step: Step
    reason: str
    breaks_law: bool = False


def confirmed(
    seeker: Seeker, trial: Trial, steps: list[Step], refused: Refusals
) -> tuple[Trial, list[Step], Fit]:
    """What is left of a trial when all that cannot be confirmed is taken out, noted in `refused`
    with the reason; its steps, and its fit with all that is asked of it (see `_examined`).
    """
    fit = _examined(seeker, trial)
    while trial.candidates:
        simpler = _off_bounds(seeker, trial, fit)
        weakness = _weakness(seeker, trial, steps, fit) if simpler is None else None
        if simpler is not None:
            trial, steps = shortened(seeker, simpler)
        elif weakness is not None:
            key = weakness.step.candidate.key
            refused.note(key, weakness.reason, weakness.breaks_law)
            trial, steps = shortened(seeker, weakness.step.without)
        else:
            break
        fit = _examined(seeker, trial)
    return trial, steps, fit


def _examined(seeker: Seeker, trial: Trial) -> Fit:
    """The fit of a trial with derivatives that are not blind; where more than noise is left, so
    that amounts must be known, with what the noise of the inputs changes as well.
    """
    task = seeker.task
    if leaves_noise_alone(trial, floor_of(task, trial, seeker.carried)):
        return with_finite_differences(trial.fit, task.executor)
    return estimable(trial.fit, task.input_noise, task.executor)


def shortened(seeker: Seeker, trial: Trial) -> tuple[Trial, list[Step]]:
    """A trial that lacks something now, fitted sharply, and what its candidates gain."""
    trial = seeker.sharpened(trial)
    return trial, [seeker.step(trial, c) for c in trial.candidates]


def leaner_rival(seeker: Seeker, trial: Trial, alike: Sequence[Rival]) -> Trial | None:
    """Where the trial leaves noise alone, one of those that it cannot be told from, without a
    candidate that is of no use there, if that leaves noise alone too; None where there is none.
    """
    if not seeker.is_at_noise(trial):
        return None
    for rival in alike:
        for candidate in rival.trial.candidates:
            if expected_gain(rival.trial, candidate.vanishing) < seeker.task.material:
                smaller = seeker.without(rival.trial, candidate)
                if seeker.is_at_noise(smaller) and len(smaller.candidates) < len(trial.candidates):
                    return smaller
    return None


def doubtful(
    trial: Trial, steps: Sequence[Step], named: Mapping[str, tuple[str, ...]], floor: Floor
) -> Step | None:
    """A declared value in whose place others may stand (`named`), where more than noise is left;
    None if there is none. It is known, after all: that it is wrong is the answer only where nothing
    else is.
    """
    if leaves_noise_alone(trial, floor):
        return None
    known = [s for s in steps if s.candidate.is_declared_value]
    return next((s for s in known if named[s.candidate.key]), None)


def denied(task: Task, trial: Trial, steps: Sequence[Step]) -> Step | None:
    """The candidate of a set that the validation runs deny most: without it, the others clearly
    leave less of their error, at 5 % over all of the set; None if there is none.
    """
    if len(steps) < 2:
        return None
    after = held_out_fit(task, trial)
    gains = [held_out_gain(held_out_fit(task, s.without), after) for s in steps]
    worst = min(range(len(steps)), key=lambda k: gains[k].chance)
    return steps[worst] if gains[worst].is_clear(len(steps)) else None


def simplest_alike(
    seeker: Seeker, chosen: Trial, steps: list[Step], chosen_fit: Fit, alike: list[Rival]
) -> tuple[Trial, list[Step], Fit, list[Rival]]:
    """Of one effect and what predicts as well as it, the one with the fewest parameters, if
    that is confirmed too; with its fit from `_examined`, `chosen_fit` of the first.
    """
    unchanged = chosen, steps, chosen_fit, alike
    as_good = [r for r in alike if not r.excused]
    best = min(as_good, key=lambda r: len(r.trial.fit.free), default=None)
    if len(steps) != 1 or best is None or len(best.trial.fit.free) >= len(chosen.fit.free):
        return unchanged
    if len(best.trial.candidates) != 1:
        return unchanged
    (candidate,) = best.trial.candidates
    fit = _examined(seeker, best.trial)
    step = step_of(best.trial, candidate, steps[0].without)
    if _weakness(seeker, best.trial, [step], fit) is not None:
        return unchanged
    others = [chosen, *(r.trial for r in alike if r is not best)]
    return best.trial, [step], fit, [Rival(other, gain(best.trial, other)) for other in others]


def _off_bounds(seeker: Seeker, trial: Trial, fit: Fit) -> Trial | None:
    """The trial with a candidate in the fullest form that lacks a parameter which ends at its
    bound; None where none does, or where no form lacks it.
    """
    for candidate in trial.candidates:
        bound = at_bound(fit, candidate)
        kept = {f.name for f in candidate.free if f.name != bound}
        lacking = [f for f in forms(seeker.task, candidate) if {p.name for p in f.free} <= kept]
        if bound is not None and lacking:
            fullest = max(lacking, key=lambda form: len(form.free))
            full = seeker.polished(begun_in_form(seeker, trial, candidate, fullest))
            return simplified(seeker, full)
    return None


def _weakness(seeker: Seeker, trial: Trial, steps: list[Step], fit: Fit) -> Weakness | None:
    """The candidate of a trial that gains least of those that are not confirmed, and why not; None
    where all are. What is known of the others may change once it is out.
    """
    floor = floor_of(seeker.task, trial, seeker.carried)
    quiet = leaves_noise_alone(trial, floor)
    excused = replace(floor, carried=seeker.excusing(trial))
    by_gain = sorted(steps, key=lambda s: s.gain.share)
    refit = partial(without_run, seeker.task, trial)
    for step in by_gain:
        if not seeker.is_needed(step):
            return Weakness(step, _too_little(step.gain, seeker.task.material))
        if leaves_noise_of_inputs(step.without, excused):
            return Weakness(step, "without it the residual is within the noise of the inputs")
        member = with_what_needs_it(step.candidate, trial.candidates)
        reason = why_unconfirmed(fit, member, quiet, refit)
        if reason is not None:
            return Weakness(step, reason)
        space = seeker.proposals.space
        if space is not None and breaks_its_law(
            seeker.task, space, trial.candidates, trial.values, step.candidate
        ):
            return Weakness(
                step, "its torque depends on the speed in another way than its law", breaks_law=True
            )
        if not quiet:
            doubt = _doubt_beside_a_remainder(seeker.task, trial, step)
            if doubt is not None:
                return Weakness(step, doubt)
    if not answers_to_inputs(seeker.task, trial):
        return Weakness(by_gain[0], "with it the simulated motion no longer depends on the inputs")
    return None


def _doubt_beside_a_remainder(task: Task, trial: Trial, step: Step) -> str | None:
    """Why a step cannot be named where more than noise is left, which a wrong effect may imitate:
    it does not surely take away more than is left, or no material share but of slow drift.
    """
    if not step.gain.is_most:
        share, least = (100.0 * max(x, 0.0) for x in (step.gain.share, step.gain.lower))
        return (
            f"reduces the sum of squares by {share:.0f} % (lower 95 % limit {least:.0f} %), "
            "too little while the residual exceeds the noise"
        )
    if gain_in_innovations(trial, step.without).share < task.material:
        return "reduces slow drift alone, which other missing effects can cause as well"
    return None


def _too_little(earned: Gain, material: float) -> str:
    """Why a gain earns no name, which asks for a `material` share."""
    if earned.share <= 0.0:
        return "does not improve the prediction of blocks left out"
    share = f"{100.0 * earned.share:.0f} %"
    if earned.share < material:
        return f"reduces the sum of squares by {share} only; {100.0 * material:g} % are required"
    return f"reduces the sum of squares by {share}, which is not significant"
