"""The verdict: which effects are confirmed, which cannot be told apart, and what is left."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ptp_symbolic.numeric.diagnose.along_rows import grown_along_motion
from ptp_symbolic.numeric.diagnose.confirmation import (
    confirmed,
    doubtful,
    leaner_rival,
    shortened,
    simplest_alike,
)
from ptp_symbolic.numeric.diagnose.fewer_samples import fitted_to_every_sample
from ptp_symbolic.numeric.diagnose.findings import Search, Step
from ptp_symbolic.numeric.diagnose.floor import Floor, carried_noise, floor_of, leaves_noise_alone
from ptp_symbolic.numeric.diagnose.gain import Gain
from ptp_symbolic.numeric.diagnose.groups import Rival, confusable, overtaking, rivals
from ptp_symbolic.numeric.diagnose.held_out import (
    held_out_fit,
    held_out_gain,
    is_quiet,
    is_taken_back,
)
from ptp_symbolic.numeric.diagnose.seeker import Seeker
from ptp_symbolic.numeric.diagnose.trial import Task, Trial, fitted, ranked
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

    `final` is the declared model with what is confirmed, fitted to every sample, or simulated with
    the values of the rows; `estimated` is the fit that these are of, with its intervals, its
    derivatives those of `with_finite_differences`. `compared` is the same set as the search
    compared it with others, and `declared` the declared model fitted to every sample; `members`
    what each of its effects gains, `confusable` the keys that may stand in the place of each;
    `closest` the best set where nothing is confirmed. `refused` tells why candidates that gained
    were not named. `floor` is that
    of `final`; `before` and `after` are the validation runs by the declared and by the final model.
    """

    word: str
    final: Trial
    estimated: Fit
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
    trial, steps, fit = confirmed(seeker, found.chosen, list(found.members), refused)
    alike: list[Rival] = []
    while trial.candidates:
        alike = rivals(seeker, trial, fit)
        better = overtaking(trial, alike)
        if better is not None:
            seeker.others.append(trial)
            trial, steps, fit = confirmed(
                seeker, *shortened(seeker, seeker.restarted(better)), refused
            )
            alike = []
            continue
        leaner = leaner_rival(seeker, trial, alike)
        if leaner is not None:
            seeker.others.append(trial)
            trial, steps, fit = confirmed(seeker, *shortened(seeker, leaner), refused)
            alike = []
            continue
        trial, steps, fit, alike = simplest_alike(seeker, trial, steps, fit, alike)
        floor = floor_of(task, trial, seeker.carried)
        step = doubtful(trial, steps, confusable(trial, alike), floor)
        if step is None:
            break
        refused[step.candidate.key] = "others predict as well, and more than noise is left"
        trial, steps, fit = confirmed(seeker, *shortened(seeker, step.without), refused)
        alike = []
    task.progress("fitting every sample, and simulating the validation runs")
    known = [found.declared, trial] if trial.candidates else [found.declared]
    declared, *rest = fitted_to_every_sample(task, known)
    before = held_out_fit(task, declared)
    ends = _along_motion(seeker, trial, alike)
    if trial.candidates:
        ends.append(_End(trial, rest[0], None, tuple(steps), confusable(trial, alike)))
    nothing = _End(found.declared, declared, None, (), {})
    for end in (*ends, nothing):
        final = end.final
        after = held_out_fit(task, final) if final.candidates else before
        held_out = held_out_gain(after, before) if final.candidates else None
        floor, quiet = _floor_and_quiet(task, final, after)
        if held_out is None or not is_taken_back(held_out, quiet):
            break
        for key in final.keys:
            refused[key] = "takes away too little of the error of the validation runs"
    word = word_of(final, end.confusable, quiet and leaves_noise_alone(final, floor))
    closest = None
    if not final.candidates and word != NOTHING_MISSING:
        closest = ends[-1].compared if ends else _closest(found)
    return Verdict(
        word,
        final,
        end.estimated or with_finite_differences(final.fit, task.executor),
        end.compared,
        declared,
        end.members,
        end.confusable,
        tuple(alike) if trial.candidates and final.candidates else (),
        closest,
        {key: why for key, why in refused.items() if key not in final.keys},
        floor,
        before,
        after,
        held_out,
    )


@dataclass(frozen=True, eq=False)
class _End:
    """A set that may be the final one; `estimated` is the fit that its values are of, if that is
    not the one of `final`, and the others are as in `Verdict`.
    """

    compared: Trial
    final: Trial
    estimated: Fit | None
    members: tuple[Step, ...]
    confusable: Mapping[str, tuple[str, ...]]


def _along_motion(seeker: Seeker, trial: Trial, alike: Sequence[Rival]) -> list[_End]:
    """Where a trial leaves more than noise, the set that it grows to along the measured motion."""
    task = seeker.task
    if leaves_noise_alone(trial, floor_of(task, trial, seeker.carried)):
        return []
    found = grown_along_motion(task, seeker.proposals, trial)
    if found is None:
        return []
    final = found.trial
    compared = fitted(task, final.candidates, final.values, final.fit.z, executor=task.executor)
    pairs = zip(final.candidates, found.gains, strict=True)
    steps = tuple(Step(c, g, g.chance, seeker.declared) for c, g in pairs)
    named = confusable(trial, alike)
    both = {k: tuple(sorted({*named.get(k, ()), *found.alike[k]})) for k in final.keys}
    return [_End(compared, final, found.fit, steps, both)]


def _floor_and_quiet(task: Task, final: Trial, after: Fit) -> tuple[Floor, bool]:
    """The floor of the final model, and whether its validation runs `after` leave no more."""
    floor = floor_of(task, final, carried_noise(task, final.fit))
    return floor, is_quiet(after, replace(floor, carried=carried_noise(task, after)), final.fit)


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
