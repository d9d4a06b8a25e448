"""The verdict: which effects are confirmed, which are indistinguishable, whether the residual is
noise; and the rules that decided it, each with the number that it was compared with.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.diagnose.along_rows import extended_along_motion
from ptp_symbolic.numeric.diagnose.candidates import Candidate
from ptp_symbolic.numeric.diagnose.confirm import (
    ambiguous_value,
    confirmed,
    rejected_on_validation,
    shortened,
    simplest_alternative,
    smaller_alternative,
)
from ptp_symbolic.numeric.diagnose.fitted_model import (
    FittedModel,
    SearchProblem,
    fitted,
    halving,
    ranked,
)
from ptp_symbolic.numeric.diagnose.gain import (
    Gain,
    held_out_fit,
    held_out_gain,
    is_noise_alone,
    is_validated,
    left_by_best_values,
    must_gain_clearly,
    p_value,
    usual_residual,
)
from ptp_symbolic.numeric.diagnose.groups import (
    Alternative,
    better_alternative,
    confusable,
    refitted_alternatives,
)
from ptp_symbolic.numeric.diagnose.noise_floor import (
    NoiseFloor,
    exceeds_usual_noise,
    fitted_to_every_sample,
    leaves_noise_alone,
    leaves_white_noise,
    noise_floor_of,
    normalised_residual,
    propagated_input_noise,
)
from ptp_symbolic.numeric.diagnose.refits import (
    beside_declared,
    better_over_same_runs,
    fitted_over_windows,
    is_near_noise_floor,
    refitted_in,
)
from ptp_symbolic.numeric.diagnose.stepwise import (
    Refusals,
    Search,
    Step,
    StepwiseSearch,
    looked_at,
    step_of,
)
from ptp_symbolic.numeric.identify.constants import ABOVE_NOISE, FALSE_ALARM, MOST
from ptp_symbolic.numeric.identify.fit import Fit
from ptp_symbolic.numeric.identify.run import sizes
from ptp_symbolic.numeric.identify.windows import estimable

FloatArray = NDArray[np.float64]

NOTHING_MISSING = "nothing_missing"
EXPLAINED = "explained"
UP_TO_GROUP = "explained_up_to_group"
PARTLY = "partly_explained"
UNEXPLAINED = "unexplained"


@dataclass(frozen=True, eq=False)
class Verdict:
    """What the logs say.

    `declared` is the declared model fitted to every sample, and `final` the one with what is
    confirmed; the values of that are those of `estimated`: the same fit with what its intervals
    need, or one to the torques along the motion. `compared` is its set as the search compared it
    with others. By key, `gains` is what each of its effects gains, and `confusable` are the
    alternatives of each; `alternatives` are sets with them. `closest` is the best set where nothing
    is confirmed, `refused` says why candidates that gained were not named. `floor` is that of
    `final`; `before` and `after` are the validation runs by the declared and by the final model,
    `usual` [ny] is the residual of the latter that decides, over the largest noise (see
    `usual_residual`). The model `is_trained_to_noise` where training runs show noise alone, and
    `is_quiet` where the validation runs do.
    """

    word: str
    final: FittedModel
    estimated: Fit
    compared: FittedModel
    declared: FittedModel
    gains: Mapping[str, Gain]
    confusable: Mapping[str, tuple[str, ...]]
    alternatives: tuple[Alternative, ...]
    closest: FittedModel | None
    refused: Mapping[str, str]
    floor: NoiseFloor
    before: Fit
    after: Fit
    usual: FloatArray
    held_out: Gain | None
    is_trained_to_noise: bool
    is_quiet: bool

    @property
    def is_along_motion(self) -> bool:
        """Whether the values of the final model are those of the torques along the motion."""
        return self.estimated.runs != self.final.fit.runs

    @property
    def leaves_more(self) -> bool:
        """Whether the residual exceeds the noise."""
        return self.word in (PARTLY, UNEXPLAINED)


def decide(found: Search) -> Verdict:
    """Confirm the chosen set, find its alternatives, and judge the validation runs.

    Where the residual of training runs may be autocorrelated noise, and that of validation runs
    exceeds it, it was no noise: everything is decided again with residuals compared with white
    noise.
    """
    found = with_declared_over_windows(found)
    verdict = _decided(found)
    quiet = leaves_noise_alone(verdict.final, verdict.floor)
    if verdict.word != PARTLY or not quiet or not np.any(verdict.floor.largest > 1.0):
        return verdict
    return _decided(replace(found, problem=replace(found.problem, white=True)))


def _decided(found: Search) -> Verdict:
    """The verdict, with noise as white as the problem of the search says."""
    problem = found.problem
    refused = Refusals()
    stepwise = StepwiseSearch(
        problem, found.declared, found.proposals, found.propagated, found.tried
    )
    stepwise.follow(found.chosen)
    trial, steps, alternatives = _settled(stepwise, found.chosen, list(found.members), refused)
    problem.progress("fitting every sample, and simulating the validation runs")
    declared, *final = _to_every_sample(found, trial)
    sets = _along_motion(stepwise, trial, declared, sorted(refused.contradicting))
    near = _near_floor(stepwise, sets)
    if near is not None:
        trial, steps, alternatives = _settled(stepwise, *shortened(stepwise, near), refused)
        declared, *final = _to_every_sample(found, trial)
        sets = []
    if trial.candidates:
        gains = {s.candidate.key: s.gain for s in steps}
        sets.append(
            _Set(trial, final[0], None, gains, confusable(trial, alternatives), tuple(alternatives))
        )
    return _judged(found, declared, sets, refused)


def _to_every_sample(found: Search, trial: FittedModel) -> list[FittedModel]:
    """The declared model, and a trial with candidates, fitted to every sample."""
    known = [found.declared, trial] if trial.candidates else [found.declared]
    return fitted_to_every_sample(found.problem, known)


def _settled(
    stepwise: StepwiseSearch, chosen: FittedModel, members: list[Step], refused: Refusals
) -> tuple[FittedModel, list[Step], list[Alternative]]:
    """What is confirmed of a chosen set, or of one that predicts better, or as well and is simpler,
    without what the validation runs reject; its steps, and its alternatives. Everything else is
    noted in `refused` with the reason.
    """
    trial, steps, fit = confirmed(stepwise, chosen, members, refused)
    alternatives: list[Alternative] = []
    while trial.candidates:
        alternatives = refitted_alternatives(stepwise, trial, fit)
        better = better_alternative(trial, alternatives, stepwise.problem.material)
        other = smaller_alternative(stepwise, trial, alternatives) if better is None else None
        other = other if better is None else stepwise.restarted(better)
        if other is not None:
            stepwise.tried.others.append(trial)
        else:
            trial, steps, fit, alternatives = simplest_alternative(
                stepwise, trial, steps, fit, alternatives
            )
            rejected = _rejected(stepwise, trial, steps, alternatives)
            if rejected is None:
                break
            step, why = rejected
            refused.note(step.candidate.key, why)
            other = step.without
        trial, steps, fit = confirmed(stepwise, *shortened(stepwise, other), refused)
        alternatives = []
    return trial, steps, alternatives


def _rejected(
    stepwise: StepwiseSearch,
    trial: FittedModel,
    steps: Sequence[Step],
    alternatives: Sequence[Alternative],
) -> tuple[Step, str] | None:
    """A member that its alternatives or the validation runs speak against, and why; or None."""
    floor = noise_floor_of(stepwise.problem, trial, stepwise.propagated)
    step = ambiguous_value(trial, steps, confusable(trial, alternatives), floor)
    if step is not None:
        return step, "alternatives predict as well, and the residual exceeds the noise"
    step = rejected_on_validation(stepwise.problem, trial, steps)
    why = "the validation runs are predicted significantly better without it"
    return None if step is None else (step, why)


@dataclass(frozen=True, eq=False)
class _Set:
    """A set that may be the final one, as in `Verdict`; `estimated` is None where its values are
    those of `final`.
    """

    compared: FittedModel
    final: FittedModel
    estimated: Fit | None
    gains: Mapping[str, Gain]
    confusable: Mapping[str, tuple[str, ...]]
    alternatives: tuple[Alternative, ...]


def _along_motion(
    stepwise: StepwiseSearch,
    trial: FittedModel,
    declared: FittedModel,
    contradicting: Sequence[str],
) -> list[_Set]:
    """Where the residual of a trial exceeds the noise, the set to which it is extended along the
    measured motion; `contradicting` as in `extended_along_motion`.
    """
    problem = stepwise.problem
    if leaves_noise_alone(trial, noise_floor_of(problem, trial, stepwise.propagated)):
        return []
    found = extended_along_motion(
        problem, stepwise.proposals, trial, declared.fit.runs, contradicting
    )
    if found is None:
        return []
    final = found.trial
    compared = fitted(problem, final.candidates, final.values, None, executor=problem.executor)
    return [_Set(compared, final, found.fit, found.gains, found.alternatives, ())]


def _near_floor(stepwise: StepwiseSearch, sets: Sequence[_Set]) -> FittedModel | None:
    """A set found along the motion, fitted to the outputs from there, where their residual comes
    near the noise floor: the outputs then determine its values better than the torque does, and it
    is judged by them as any other set. None where it does not.
    """
    begun = [fitted(stepwise.problem, s.final.candidates, s.final.values, None) for s in sets]
    near = [t for t in halving(stepwise.problem, begun, 1) if is_near_noise_floor(t)]
    return stepwise.polished(near[0]) if near else None


def _judged(
    found: Search, declared: FittedModel, sets: Sequence[_Set], refused: Refusals
) -> Verdict:
    """The verdict for the first of `sets` that the validation runs bear out, or for none."""
    problem = found.problem
    before = held_out_fit(problem, declared)
    for one in (*sets, _Set(found.declared, declared, None, {}, {}, ())):
        final = one.final
        after = held_out_fit(problem, final) if final.candidates else before
        held_out = held_out_gain(after, before) if final.candidates else None
        estimated = one.estimated or estimable(final.fit, problem.input_noise, problem.executor)
        floor, quiet, usual = _floor_and_quiet(problem, final, after, estimated)
        at_noise = leaves_noise_alone(final, floor)
        unusual = at_noise and exceeds_usual_noise(final, floor)
        if held_out is None or is_validated(held_out, quiet, unusual, problem.material):
            break
        why = "reduces the error of the validation runs too little, or not significantly"
        for key in final.keys:
            refused.note(key, why)
    word = word_of(final, one.confusable, quiet and at_noise)
    simulated = [s.compared for s in sets if s.estimated is None]
    return Verdict(
        word,
        final,
        estimated,
        one.compared,
        declared,
        one.gains,
        one.confusable,
        one.alternatives,
        next(iter(simulated), _closest(found)) if word == UNEXPLAINED else None,
        {key: why for key, why in refused.why.items() if key not in final.keys},
        floor,
        before,
        after,
        usual,
        held_out,
        at_noise,
        quiet,
    )


def _floor_and_quiet(
    problem: SearchProblem, final: FittedModel, after: Fit, estimated: Fit
) -> tuple[NoiseFloor, bool, FloatArray]:
    """The floor of the final model, and whether its validation runs `after` show noise alone, with
    some values in the joint confidence region of the `estimated` ones; and their usual residual
    [ny] with these, over the largest noise.
    """
    floor = noise_floor_of(problem, final, propagated_input_noise(problem, final.fit))
    here = replace(floor, propagated=propagated_input_noise(problem, after))
    left = left_by_best_values(after, estimated, here.level, problem.executor)
    size = sizes(after.runs)
    usual = usual_residual(left, size) / here.most
    return floor, is_noise_alone(left, size, here, final.fit), usual


def _closest(found: Search) -> FittedModel | None:
    """The best trial with any candidate."""
    trials = [t for t in (found.chosen, *found.tried.others) if t.candidates]
    best = ranked([found.declared, *trials])
    return next((t for t in best if t.candidates and np.isfinite(t.fit.cost)), None)


def word_of(trial: FittedModel, named: Mapping[str, tuple[str, ...]], quiet: bool) -> str:
    """The word for a confirmed set whose residual is noise alone (`quiet`) in all runs, or not."""
    if not trial.candidates:
        return NOTHING_MISSING if quiet else UNEXPLAINED
    if not quiet:
        return PARTLY
    return UP_TO_GROUP if any(named.values()) else EXPLAINED


SHARE = "share by which the sum of squares on blocks left out falls"
LOWER_END = "lower end of the 95 % interval of that share"
CHANCE = "chance of finding it where it is not"
VALIDATED = "share by which the sum of squares of the validation runs falls"
VALIDATED_BY_CHANCE = "chance that the validation runs gain so much from what is not there"
TRAINING = "residual of {signal} on the training runs, over the largest noise that is plausible"
VALIDATION = (
    "residual of {signal} on the usual validation run (the median one), with values within their"
    " joint confidence region, over that noise"
)
ALIKE = "alternatives that predict as well in its place"
BESIDE = ", with what was found beside it"
COMPARED_ALONE = ", as they were before the search for terms"


def reasons(found: Search, verdict: Verdict, compared: int) -> list[dict[str, Any]]:
    """A row for every test with a number, and what it is `about` (the key of an effect, named
    or of the chosen set; None: the whole model): the `value`, whether it has to be `at_least` or
    `at_most` the `limit`, and whether it `holds`. `compared` is the number of structures that were
    fitted.
    """
    rows = []
    for candidate in verdict.final.candidates:
        tests = _tests(found, candidate, compared)
        rows += _of_effect(found, verdict, candidate, tests)
    for step in found.members:
        if step.candidate.key not in verdict.final.keys:
            tests = _tests(found, step.candidate, compared)
            rows += _of_gain(found, verdict, step.candidate.key, step.gain, step.p_value, tests)
    if verdict.held_out is not None:
        least = found.problem.material if verdict.is_quiet else MOST
        rows.append(_row(None, VALIDATED, verdict.held_out.share, "at_least", least))
        unusual = exceeds_usual_noise(verdict.final, verdict.floor)
        if verdict.is_quiet and must_gain_clearly(verdict.held_out, unusual):
            chance = verdict.held_out.smallest_chance(1.0)
            rows.append(_row(None, VALIDATED_BY_CHANCE, chance, "at_most", FALSE_ALARM))
    trained = normalised_residual(verdict.final.fit) / verdict.floor.most
    signals = verdict.after.runs[0].signals
    for text, ratios in ((TRAINING, trained), (VALIDATION, verdict.usual)):
        for signal, ratio in zip(signals, ratios, strict=True):
            rows.append(_row(None, text.format(signal=signal), ratio, "at_most", ABOVE_NOISE))
    return rows


def _of_effect(
    found: Search, verdict: Verdict, candidate: Candidate, tests: int
) -> list[dict[str, Any]]:
    key, gain = candidate.key, verdict.gains[candidate.key]
    has_terms = not candidate.vanishing and any(c.vanishing for c in verdict.final.candidates)
    alone = COMPARED_ALONE if has_terms else ""
    alike = _row(key, f"{ALIKE}{alone}", len(verdict.confusable[key]), "at_most", 0)
    if verdict.is_along_motion:  # there it is decided by the regression of the torque
        return [
            _row(key, SHARE, gain.share, "at_least", found.problem.material),
            _row(key, CHANCE, gain.chance, "at_most", FALSE_ALARM / tests),
            alike,
        ]
    by_values = p_value(verdict.compared, candidate.vanishing) if candidate.vanishing else 1.0
    share, *others = _of_gain(found, verdict, key, gain, by_values, tests)
    return [share | {"rule": f"{SHARE}{BESIDE if has_terms else ''}"}, *others, alike]


def _of_gain(
    found: Search, verdict: Verdict, key: str, gain: Gain, by_values: float, tests: int
) -> list[dict[str, Any]]:
    least = 0.0 if verdict.is_trained_to_noise else MOST
    return [
        _row(key, SHARE, gain.share, "at_least", found.problem.material),
        _row(key, LOWER_END, gain.lower, "at_least", least),
        _row(key, CHANCE, gain.smallest_chance(by_values), "at_most", FALSE_ALARM / tests),
    ]


def _tests(found: Search, candidate: Candidate, compared: int) -> int:
    """How many were looked at: structures have no value at which they vanish."""
    if not candidate.vanishing:
        return max(compared, 1)
    return max(looked_at(found.problem.candidates, [candidate]), 1)


def _row(about: str | None, rule: str, value: float, side: str, limit: float) -> dict[str, Any]:
    holds = value >= limit if side == "at_least" else value <= limit
    number = float(value) if np.isfinite(value) else None
    return {
        "about": about,
        "rule": rule,
        "value": number,
        side: float(limit),
        "holds": bool(holds),
    }


def with_declared_over_windows(found: Search) -> Search:
    """The search with its declared model fitted over windows too, as by `fit_declared`, where it
    ended before that and its residual exceeds white noise: gains are those over the best fit of the
    declared model.
    """
    problem = found.problem
    if (
        found.is_over_windows
        or not problem.windows
        or leaves_white_noise(found.declared, found.propagated)
    ):
        return found
    problem.progress("fitting the declared model over windows")
    part, after = fitted_over_windows(replace(problem, candidates=()), found.proposals)
    if [run.name for run in part.train] != [run.name for run in problem.train]:
        after = refitted_in(problem, after)
    best = better_over_same_runs(found.declared, after)
    if best is found.declared:
        return replace(found, is_over_windows=True)
    chosen = found.chosen if found.chosen.candidates else best
    if chosen.candidates:
        chosen = beside_declared(problem, chosen, best, found.propagated)
    members = tuple(
        step_of(chosen, s.candidate, s.without if s.without.candidates else best)
        for s in found.members
    )
    return replace(
        found,
        declared=best,
        chosen=chosen,
        members=members,
        is_over_windows=True,
        is_taken_over=False,
    )
