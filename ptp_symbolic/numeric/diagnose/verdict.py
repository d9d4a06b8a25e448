"""The verdict: which effects are confirmed, which cannot be told apart, and what is left."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ptp_symbolic.numeric.diagnose.confirm import answers_to_inputs, at_bound, why_unconfirmed
from ptp_symbolic.numeric.diagnose.fewer_samples import fitted_to_every_sample
from ptp_symbolic.numeric.diagnose.findings import Search, Step, step_of
from ptp_symbolic.numeric.diagnose.floor import Floor, carried_noise, floor_of, leaves_noise_alone
from ptp_symbolic.numeric.diagnose.gain import Gain, gain, gain_in_innovations
from ptp_symbolic.numeric.diagnose.groups import Rival, confusable, overtaking, rivals
from ptp_symbolic.numeric.diagnose.held_out import (
    held_out_fit,
    held_out_gain,
    is_quiet,
    is_taken_back,
)
from ptp_symbolic.numeric.diagnose.refits import expected_gain, forms
from ptp_symbolic.numeric.diagnose.seeker import Seeker
from ptp_symbolic.numeric.diagnose.trial import Task, Trial, ranked
from ptp_symbolic.numeric.identify.constants import MATERIAL, MOST
from ptp_symbolic.numeric.identify.finite_differences import with_finite_differences
from ptp_symbolic.numeric.identify.fit import Fit

NOTHING_MISSING = "nothing_missing"
EXPLAINED = "explained"
UP_TO_GROUP = "explained_up_to_group"
PARTLY = "partly_explained"
UNEXPLAINED = "unexplained"


@dataclass(frozen=True, eq=False)
class Verdict:
    """What the logs say.

    `final` is the declared model with what is confirmed, fitted to every sample, its derivatives
    those of `with_finite_differences`, `compared` the same as the search compared it with others,
    and `declared` the declared model fitted to every sample; `members` what each of its effects
    gains, `confusable` the keys that may stand in the place of each; `closest` the best set where
    nothing is confirmed. `refused` tells why candidates that gained were not named. `floor` is that
    of `final`; `before` and `after` are the validation runs by the declared and by the final model.
    """

    word: str
    final: Trial
    compared: Trial
    declared: Trial
    members: tuple[Step, ...]
    confusable: Mapping[str, tuple[str, ...]]
    rivals: tuple[Rival, ...]
    closest: Trial | None
    refused: Mapping[str, str]
    floor: Floor
    before: Fit
    after: Fit
    held_out: Gain | None

    @property
    def leaves_more(self) -> bool:
        """Whether more than noise is left."""
        return self.word in (PARTLY, UNEXPLAINED)


def decide(found: Search) -> Verdict:
    """Confirm the chosen set, find what it cannot be told from, and judge the validation runs."""
    task = found.task
    refused: dict[str, str] = {}
    seeker = Seeker(task, found.declared, found.proposals, found.carried)
    seeker.others = list(found.others)
    trial, steps, fit = _confirmed(seeker, found.chosen, list(found.members), refused)
    alike: list[Rival] = []
    while trial.candidates:
        alike = rivals(seeker, trial, fit)
        better = overtaking(trial, alike)
        if better is not None:
            seeker.others.append(trial)
            trial, steps, fit = _confirmed(
                seeker, *_shortened(seeker, seeker.restarted(better)), refused
            )
            alike = []
            continue
        leaner = _leaner(seeker, trial, alike)
        if leaner is not None:
            seeker.others.append(trial)
            trial, steps, fit = _confirmed(seeker, *_shortened(seeker, leaner), refused)
            alike = []
            continue
        trial, steps, fit, alike = _simplest(seeker, trial, steps, fit, alike)
        floor = floor_of(task, trial, seeker.carried)
        step = doubtful(trial, steps, confusable(trial, alike), floor)
        if step is None:
            break
        refused[step.candidate.key] = "others predict as well, and more than noise is left"
        trial, steps, fit = _confirmed(seeker, *_shortened(seeker, step.without), refused)
        alike = []
    task.progress("fitting every sample, and simulating the validation runs")
    known = [found.declared, trial] if trial.candidates else [found.declared]
    declared, *rest = fitted_to_every_sample(task, known)
    final = rest[0] if rest else declared
    before = held_out_fit(task, declared)
    after = held_out_fit(task, final) if trial.candidates else before
    held_out = held_out_gain(after, before) if trial.candidates else None
    closest = None if trial.candidates else _closest(found)
    floor, quiet = _floor_and_quiet(task, final, after)
    if held_out is not None and is_taken_back(held_out, quiet):
        for key in trial.keys:
            refused[key] = "takes away too little of the error of the validation runs"
        closest, trial, steps, after, held_out, alike = trial, found.declared, [], before, None, []
        final = declared
        floor, quiet = _floor_and_quiet(task, final, after)
    named = confusable(trial, alike)
    word = word_of(trial, named, quiet and leaves_noise_alone(final, floor))
    return Verdict(
        word,
        replace(final, fit=with_finite_differences(final.fit, task.executor)),
        trial,
        declared,
        tuple(steps),
        named,
        tuple(alike),
        None if word == NOTHING_MISSING else closest,
        refused,
        floor,
        before,
        after,
        held_out,
    )


def _floor_and_quiet(task: Task, final: Trial, after: Fit) -> tuple[Floor, bool]:
    """The floor of the final model, and whether its validation runs `after` leave no more."""
    floor = floor_of(task, final, carried_noise(task, final.fit))
    return floor, is_quiet(after, replace(floor, carried=carried_noise(task, after)), final.fit)


def _confirmed(
    seeker: Seeker, trial: Trial, steps: list[Step], refused: dict[str, str]
) -> tuple[Trial, list[Step], Fit]:
    """What is left of a trial when all that cannot be confirmed is taken out, noted in `refused`
    with the reason; its steps, and its fit with derivatives that are not blind.
    """
    fit = with_finite_differences(trial.fit, seeker.task.executor)
    while trial.candidates:
        simpler = _off_bounds(seeker, trial, fit)
        weakness = _weakness(seeker, trial, steps, fit) if simpler is None else None
        if simpler is not None:
            trial, steps = _shortened(seeker, simpler)
        elif weakness is not None:
            step, reason = weakness
            refused[step.candidate.key] = reason
            trial, steps = _shortened(seeker, step.without)
        else:
            break
        fit = with_finite_differences(trial.fit, seeker.task.executor)
    return trial, steps, fit


def _shortened(seeker: Seeker, trial: Trial) -> tuple[Trial, list[Step]]:
    """A trial that lacks something now, fitted sharply, and what its candidates gain."""
    trial = seeker.sharpened(trial)
    return trial, [seeker.step(trial, c) for c in trial.candidates]


def _leaner(seeker: Seeker, trial: Trial, alike: Sequence[Rival]) -> Trial | None:
    """Where the trial leaves noise alone, one of those that it cannot be told from, without a
    candidate that is of no use there, if that leaves noise alone too; None where there is none.
    """
    if not seeker.is_at_noise(trial):
        return None
    for rival in alike:
        for candidate in rival.trial.candidates:
            if expected_gain(rival.trial, candidate.vanishing) < MATERIAL:
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


def _simplest(
    seeker: Seeker, chosen: Trial, steps: list[Step], chosen_fit: Fit, alike: list[Rival]
) -> tuple[Trial, list[Step], Fit, list[Rival]]:
    """Of one effect and what cannot be told from it, the one with the fewest parameters, if
    that is confirmed too; with its fit from `with_finite_differences`, `chosen_fit` of the first.
    """
    unchanged = chosen, steps, chosen_fit, alike
    best = min(alike, key=lambda r: len(r.trial.fit.free), default=None)
    if len(steps) != 1 or best is None or len(best.trial.fit.free) >= len(chosen.fit.free):
        return unchanged
    if len(best.trial.candidates) != 1:
        return unchanged
    (candidate,) = best.trial.candidates
    fit = with_finite_differences(best.trial.fit, seeker.task.executor)
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
            return seeker.simplified(seeker.in_form(trial, candidate, fullest))
    return None


def _weakness(seeker: Seeker, trial: Trial, steps: list[Step], fit: Fit) -> tuple[Step, str] | None:
    """The candidate of a trial that gains least of those that are not confirmed, and why not; None
    where all are. What is known of the others may change once it is out.
    """
    quiet = leaves_noise_alone(trial, floor_of(seeker.task, trial, seeker.carried))
    by_gain = sorted(steps, key=lambda s: s.gain.share)
    for step in by_gain:
        if not seeker.is_needed(step):
            return step, _too_little(step.gain)
        reason = why_unconfirmed(fit, step.candidate, quiet)
        if reason is not None:
            return step, reason
        if not quiet:
            doubt = _doubt_beside_a_remainder(trial, step)
            if doubt is not None:
                return step, doubt
    if not answers_to_inputs(seeker.task, trial):
        return by_gain[0], "with it the model no longer answers to its inputs"
    return None


def _doubt_beside_a_remainder(trial: Trial, step: Step) -> str | None:
    """Why a step cannot be named where more than noise is left, which a wrong effect may imitate:
    it takes away less than is left, or nothing but slow drift.
    """
    if step.gain.share < MOST:
        share = f"{100.0 * step.gain.share:.0f} %"
        return f"takes away {share} of the error, too little where more than noise is left"
    if gain_in_innovations(trial, step.without).share < MATERIAL:
        return "takes away slow drift alone, which other effects left out may have caused as well"
    return None


def _too_little(earned: Gain) -> str:
    """Why a gain earns no name."""
    if earned.share <= 0.0:
        return "predicts blocks that were left out no better"
    share = f"{100.0 * earned.share:.0f} %"
    if earned.share < MATERIAL:
        return f"takes away only {share} of the error"
    return f"takes away {share} of the error, which may be chance"


def _closest(found: Search) -> Trial | None:
    """The best trial with any candidate."""
    trials = [t for t in (found.chosen, *found.others) if t.candidates]
    best = ranked([found.declared, *trials])
    return next((t for t in best if t.candidates and np.isfinite(t.fit.cost)), None)


def word_of(trial: Trial, named: Mapping[str, tuple[str, ...]], quiet: bool) -> str:
    """The word for a confirmed set that leaves noise alone, or not (`quiet`), in any run."""
    if not trial.candidates:
        return NOTHING_MISSING if quiet else UNEXPLAINED
    if not quiet:
        return PARTLY
    return UP_TO_GROUP if any(named.values()) else EXPLAINED
