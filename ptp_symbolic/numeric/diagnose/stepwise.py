"""The moves of a stepwise search: sets are completed, pruned, grown and simplified by
refits; what they have found, and what was tried.

Candidates are compared over a few short windows first. Windows forget: neither a rest nor a bounce
in a gap that ends a sample late misleads a fit there, so that a few iterations show the worth of a
candidate, and at which values.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from weakref import WeakSet

import numpy as np

from ptp_symbolic.numeric.diagnose.candidates import (
    Candidate,
    with_all_they_need,
    with_what_it_brings,
    without_member,
)
from ptp_symbolic.numeric.diagnose.fitted_model import (
    FittedModel,
    SearchProblem,
    continued,
    fitted,
    forms_of,
    halving,
    is_near,
    is_same_end,
    ranked,
)
from ptp_symbolic.numeric.diagnose.gain import Gain, gain, p_value
from ptp_symbolic.numeric.diagnose.noise_floor import (
    PropagatedNoise,
    leaves_white_noise,
    propagated_input_noise,
)
from ptp_symbolic.numeric.diagnose.proposals import ProposedSets, start_for
from ptp_symbolic.numeric.diagnose.refits import (
    along,
    beside_declared,
    forms,
    from_rows,
    fullest,
    polished,
    sharpened,
    taken_over,
    to_its_end,
)
from ptp_symbolic.numeric.diagnose.responses import expected_gain, responses
from ptp_symbolic.numeric.identify.constants import (
    FALSE_ALARM,
    ITERATIONS,
    LITTLE,
    MOST,
    SCREENED,
    TRIED,
)
from ptp_symbolic.numeric.identify.evaluate import Evaluation
from ptp_symbolic.numeric.identify.evidence import Deferred


@dataclass(frozen=True, eq=False)
class Tried:
    """Trials that were passed by, `others`; those fitted to their end; and by the forms of its
    candidates (see `forms_of`) the end of every set that was restarted from the rows.
    """

    others: list[FittedModel] = field(default_factory=list)
    at_end: WeakSet[FittedModel] = field(default_factory=WeakSet)
    anew: dict[tuple[tuple[str, int], ...], FittedModel] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class Step:
    """A candidate of a set, what it gains, how likely it is found where it is not (see `p_value`),
    and the trial without it.
    """

    candidate: Candidate
    gain: Gain
    p_value: float
    without: FittedModel


@dataclass(frozen=True, eq=False)
class Search:
    """What the search found: the declared model, the chosen set (the same where nothing is added),
    what every member of it gains, all that was tried, and the noise of the inputs as the best model
    so far propagates it to the outputs. `problem` has the candidates with a frequency where a line
    was found, and without those that have none. The search `is_cut_short` where its time was over
    at its end: some moves may not have been tried. The declared model `is_over_windows` where it
    was fitted over windows too, and `is_taken_over` where it was found from the end of a set, not
    from its own starts. A search that `is_brief` can be `continued`.
    """

    problem: SearchProblem
    declared: FittedModel
    chosen: FittedModel
    members: tuple[Step, ...]
    tried: Tried
    proposals: ProposedSets
    propagated: PropagatedNoise
    is_cut_short: bool
    is_over_windows: bool = True
    is_taken_over: bool = False
    is_brief: bool = False


@dataclass(frozen=True, eq=False)
class Refusals:
    """Why candidates that gained are not named, by key, and the keys of those whose torque goes
    with the speed in another way than their law.
    """

    why: dict[str, str] = field(default_factory=dict)
    contradicting: set[str] = field(default_factory=set)

    def note(self, key: str, why: str, breaks_law: bool = False) -> None:
        """Note the last reason: in another set a candidate may be refused for another one."""
        self.why[key] = why
        if breaks_law:
            self.contradicting.add(key)
        else:
            self.contradicting.discard(key)


def step_of(trial: FittedModel, candidate: Candidate, without: FittedModel) -> Step:
    """What `candidate` gains in `trial` over the trial `without` it."""
    return Step(candidate, gain(trial, without), p_value(trial, candidate.vanishing), without)


def looked_at(candidates: Sequence[Candidate], added: Sequence[Candidate]) -> int:
    """How many tests were made before some were `added`: one for every candidate, and one for every
    frequency that those were scanned over.
    """
    return len(candidates) * math.prod(c.frequencies_compared for c in added)


def is_significant(earned: Gain, p: float, tests: int) -> bool:
    """Whether a gain is above zero, and significant over so many `tests` by the values of its
    parameters (see `p_value`), or by how much better it predicts blocks, or by how many
    (Bonferroni): parameters that trade for each other may each be anything while their effect is
    beyond doubt.
    """
    return earned.lower > 0.0 and earned.smallest_chance(p) < FALSE_ALARM / max(tests, 1)


def is_earned(earned: Gain, p: float, tests: int, material: float) -> bool:
    """Whether a gain is at least the share `material`, and significant (see `is_significant`)."""
    return earned.share >= material and is_significant(earned, p, tests)


def best_of_each_set(trials: Sequence[FittedModel], best: FittedModel) -> list[FittedModel]:
    """The best trial of every set. Of those that are far behind `best` (see `is_near`) only tables
    still show their gain: single precision is enough for their Jacobians.
    """
    return [t if is_near(t, [best]) else _lighter(t) for t in ranked(trials)]


def _lighter(trial: FittedModel) -> FittedModel:
    whole = trial.fit.evaluations
    if isinstance(whole, Deferred):
        if whole.is_single:
            return trial
        return replace(trial, fit=replace(trial.fit, evaluations=whole.as_single(_in_single)))
    if all(e.by_parameter.dtype == np.float32 for e in whole):
        return trial
    return replace(trial, fit=replace(trial.fit, evaluations=_in_single(whole)))


def _in_single(evaluations: Sequence[Evaluation]) -> tuple[Evaluation, ...]:
    """Evaluations with Jacobians in single precision."""
    return tuple(
        replace(
            e,
            by_parameter=e.by_parameter.astype(np.float32),
            by_start=e.by_start.astype(np.float32),
        )
        for e in evaluations
    )


def screened(
    problem: SearchProblem,
    found: ProposedSets,
    kept: Sequence[Candidate],
    wanted: Sequence[Candidate],
    values: Mapping[str, float],
) -> list[FittedModel]:
    """The set `kept` with those of the candidates `wanted`, and with what they bring along, that
    fit a few windows of the problem best, the best first. A candidate is tried in its simplest and
    in its fullest form. A fit starts where the rows start the set, or at `values` and the
    candidate's own start, whichever is better, and the windows where they begin without it; after
    every iteration half of the fits go on.
    """
    part = replace(problem, train=problem.few)
    z = fitted(part, kept, values, None, executor=problem.executor).fit.z
    have = {c.key for c in kept}

    def begun(candidate: Candidate) -> FittedModel:
        candidates = with_what_it_brings(kept, candidate, problem.candidates)
        added = candidates[len(kept) :]
        own = {name: f.start for c in added for f in c.free for name in f.names}
        whole = {**values, **own, **candidate.shapes[0]}
        starts = [whole, start_for(problem, found, candidates, whole, linear=True)]
        return ranked([fitted(part, candidates, start, z) for start in starts])[0]

    own: dict[str, list[Candidate]] = {}
    for c in sorted(wanted, key=lambda c: len(c.free)):
        if c.key not in have:
            own.setdefault(c.key, []).append(c)
    ends = [c for forms in own.values() for c in (forms[0], *forms[1:][-1:])]
    trials = list(problem.executor.map(begun, ends))
    rungs = [max(len(trials) >> k, TRIED) for k in range(1, ITERATIONS + 1)]
    best: dict[tuple[str, ...], FittedModel] = {}
    for trial in halving(part, trials, *rungs, iterations=1):
        best.setdefault(trial.keys, trial)
    return list(best.values())


@dataclass(eq=False)
class StepwiseSearch:
    """A search, with what was `tried`; `propagated` is that of the trial that was `followed` last.

    Once the problem `is_over`, its moves begin nothing new: they return what they were given, or
    nothing.
    """

    problem: SearchProblem
    declared: FittedModel
    proposals: ProposedSets
    propagated: PropagatedNoise
    tried: Tried = field(default_factory=Tried)
    followed: FittedModel | None = None

    def among(self, candidates: tuple[Candidate, ...]) -> "StepwiseSearch":
        """The search among other candidates, which knows what was tried so far. One that needs
        another that is not among them has nothing to act on.
        """
        problem = replace(self.problem, candidates=with_all_they_need(candidates))
        return StepwiseSearch(problem, self.declared, self.proposals, self.propagated, self.tried)

    def without_influence(self, trial: FittedModel) -> list[FittedModel]:
        """The trial with each candidate without influence on the rows, started at its response in
        the outputs and part of the way there.
        """
        found = (
            []
            if self.problem.is_over
            else responses(self.problem, trial, self.proposals.without_influence)
        )
        return [t for r in found[:TRIED] for t in along(self.problem, self.proposals, r, trial)]

    def follow(self, trial: FittedModel) -> None:
        """Propagate the noise of the inputs through a trial from now on: a model that rests shows
        none.
        """
        if trial.candidates and trial is not self.followed:
            self.followed, self.propagated = trial, propagated_input_noise(self.problem, trial.fit)

    def input_noise_for(self, trial: FittedModel) -> PropagatedNoise:
        """The propagated noise of the inputs with which the residual of a trial, and of its
        alternatives, is compared. Declared noise is propagated by the trial itself, which may
        amplify it more than others; what differences of the samples show may be no noise.
        """
        noise = self.problem.input_noise
        if None in noise or not any(noise) or trial is self.followed:
            return self.propagated
        return propagated_input_noise(self.problem, trial.fit)

    def is_white(self, trial: FittedModel) -> bool:
        """Whether the residual of a trial is white noise alone."""
        return leaves_white_noise(trial, self.propagated)

    def have_answer(self, *trials: FittedModel) -> bool:
        """Whether the residual of any of them is white noise alone, with one candidate at most: no
        other set fits better, and its alternatives are compared with it later.
        """
        return any(len(t.candidates) < 2 and self.is_white(t) for t in trials)

    def polished(self, trial: FittedModel) -> FittedModel:
        """The trial fitted to its end; one that was is not fitted again."""
        if trial not in self.tried.at_end:
            trial = polished(self.problem, trial, self.propagated)
            self.tried.at_end.add(trial)
        return trial

    def sharpened(self, trial: FittedModel) -> FittedModel:
        """A polished trial fitted with sharp simulations, where the residual is white."""
        return sharpened(self.problem, trial, self.propagated)

    def restarted(self, trial: FittedModel) -> FittedModel:
        """A polished trial, or a better end from where the rows start its set, and from there over
        short windows: friction makes the deviance of whole runs a staircase. A set that was
        restarted so is not again, unless it starts with values without influence on the rows.
        """
        if not trial.candidates or self.problem.is_over or self.is_white(trial):
            return trial
        known = self.tried.anew.get(forms_of(trial.candidates))
        without_influence = {c.key for c in self.proposals.without_influence}
        if known is not None and (known is trial or without_influence.isdisjoint(trial.keys)):
            return ranked([trial, known])[0]
        begun = from_rows(self.problem, self.proposals, trial.candidates, trial.values)
        left = halving(self.problem, begun, 1)
        fresh = [t for t in left if is_near(t, [trial]) and not is_same_end(t, trial)]
        best = ranked([trial, *(self.polished(t) for t in fresh)])[0]
        self.tried.anew[forms_of(best.candidates)] = best
        return best

    def completed(self, trial: FittedModel) -> FittedModel:
        """The trial polished, each of its candidates in its fullest form: an effect is allowed all
        that it can do before another is called.
        """
        full = tuple(fullest(self.problem, c) for c in trial.candidates)
        if full != trial.candidates:
            trial = fitted(self.problem, full, trial.values, trial.fit.z, 0, trial.fit)
        return self.polished(trial)

    def without(
        self, trial: FittedModel, candidate: Candidate, *, briefly: bool = False
    ) -> FittedModel:
        """The trial refitted without one of its candidates, and without what needs it; or an
        earlier fit of that set, if it is better: a candidate gains no more than what it adds to the
        best fit without it. One that gains next to nothing after a few iterations gains no more at
        their end, and one that gains most still does: these fits are not brought there.
        `briefly` it is not restarted either.
        """
        kept = without_member(trial.candidates, candidate)
        if not kept:
            return self.declared
        begun = ranked(taken_over(self.problem, kept, trial))[0]
        smaller = continued(self.problem, begun, ITERATIONS, executor=self.problem.executor)
        if self.is_decided_at_end_of(smaller, trial):
            smaller = self.polished(smaller)
            smaller = smaller if briefly else self.restarted(smaller)
        same = [t for t in self.tried.others if forms_of(t.candidates) == forms_of(kept)]
        known = ranked([smaller, *same])[0]
        if not is_same_end(known, smaller):
            smaller = self.polished(known)
        if ranked([smaller, self.declared])[0] is self.declared:
            smaller = beside_declared(self.problem, smaller, self.declared, self.propagated)
        self.tried.others.append(smaller)
        return smaller

    def is_decided_at_end_of(self, smaller: FittedModel, trial: FittedModel) -> bool:
        """Whether the gain of the trial over a `smaller` set is material so far, but below one
        half, or the smaller set explains most already: a fit that is not at its end may change
        that.
        """
        share, least = gain(trial, smaller).share, self.problem.material
        return share >= least and (share < MOST or gain(smaller, self.declared).share >= MOST)

    def step(self, trial: FittedModel, candidate: Candidate, *, briefly: bool = False) -> Step:
        """What a candidate gains; `briefly` is that of `without`."""
        return step_of(trial, candidate, self.without(trial, candidate, briefly=briefly))

    def is_needed(self, step: Step) -> bool:
        """Whether what a candidate gains is earned."""
        return self.is_earned(step.gain, step.p_value, [step.candidate])

    def is_kept(self, trial: FittedModel, step: Step) -> bool:
        """Whether a candidate stays in the set while the search goes on. Where the residual exceeds
        the noise, which hides whether a gain is significant, a material one is enough; a name
        requires both.
        """
        if self.is_white(trial):
            return self.is_needed(step)
        return step.gain.share >= self.problem.material

    def is_earned(self, earned: Gain, p: float, added: Sequence[Candidate]) -> bool:
        """Whether the gain of what is `added` is material, and significant over all that was
        compared.
        """
        return is_earned(
            earned, p, looked_at(self.problem.candidates, added), self.problem.material
        )

    def pruned(self, trial: FittedModel) -> tuple[FittedModel, list[Step]]:
        """Drop candidates until every remaining one is needed, with its gains: of those that are
        not needed the one without which the rest fits best, for of two aliased ones each can be
        dropped while the other is there. Those are refitted first that seem to gain little; without
        those that seem to gain most, no set is restarted. A set that gains little over the declared
        model holds no candidate that gains more.
        """
        while trial.candidates:
            if gain(trial, self.declared).share < self.problem.material:
                return self.declared, []
            steps: list[Step] = []
            briefly = not self.is_white(trial)
            every = trial.candidates
            little = [c for c in every if expected_gain(trial, c.vanishing) < MOST]
            most = [c for c in every if c not in little]
            for part, brief in ((little, briefly), (most, True)):
                fresh = [self.step(trial, c, briefly=brief) for c in part]
                unneeded = [step.without for step in fresh if not self.is_kept(trial, step)]
                steps += fresh
                if unneeded:
                    trial = ranked(unneeded)[0]
                    trial = self.polished(trial) if trial.candidates else trial
                    break
            else:
                return trial, steps
        return trial, []

    def grown(self, trial: FittedModel, *, briefly: bool = False) -> FittedModel | None:
        """The trial with one more candidate of a material and significant gain; None if there is
        none. `briefly`, with one that more than halves the sum of squares, by its response alone.

        Where the residual is white, those are tried that have no influence on the rows. One that
        promises far more than all others is tried before them.
        """
        if self.problem.is_over:
            return None
        problem = self.problem
        least = MOST if briefly else LITTLE
        wanted = self.proposals.without_influence if self.is_white(trial) else problem.candidates
        found = [r for r in responses(problem, trial, wanted) if r.left < 1.0 - problem.material]
        if not found:
            return None
        names = " + ".join(trial.keys) or "the declared model"
        problem.progress(f"adding one of {len(found)} candidates to {names}")
        if len(found) == 1 or found[0].left < MOST * found[1].left:
            best = self.best_earning(along(problem, self.proposals, found[0], trial), trial, least)
            if best is not None:
                return best
        begun = [t for r in found[:TRIED] for t in along(problem, self.proposals, r, trial)]
        if not briefly:
            close = screened(problem, self.proposals, trial.candidates, wanted, trial.values)
            begun += [fitted(problem, t.candidates, t.values, None) for t in close[:SCREENED]]
        return self.best_earning(begun, trial, least)

    def simplest(self, trials: Sequence[FittedModel]) -> FittedModel:
        """The best of trials; of those with a white residual that of fewest parameters."""
        quiet = [t for t in trials if self.is_white(t)]
        return min(quiet, key=lambda t: len(t.fit.free)) if quiet else ranked(trials)[0]

    def best_earning(
        self, begun: Sequence[FittedModel], trial: FittedModel, least: float
    ) -> FittedModel | None:
        """The best of trials `begun`, polished, in which what they have more than `trial` has a
        material and significant gain, of the share `least`; None if there is none. A simpler form
        may be significant where one that fits better, with parameters that trade for each other, is
        not.
        """
        left = halving(self.problem, begun, SCREENED, seen=self.tried.others)
        found = ranked(
            [to_its_end(self.problem, t, self.propagated) for t in left if is_near(t, left)]
        )
        have = {f.name for c in trial.candidates for f in c.free}
        for number, near in enumerate(found):
            if gain(near, trial).share < least:
                continue
            best = self.polished(near)
            if number == 0 and gain(best, trial).share < MOST:
                best = self.restarted(best)
            added = {n: v for c in best.candidates for n, v in c.vanishing.items() if n not in have}
            new = [c for c in best.candidates if c.key not in trial.keys]
            if self.is_earned(gain(best, trial), p_value(best, added), new):
                return best
        return None


def simplified(stepwise: StepwiseSearch, trial: FittedModel) -> FittedModel:
    """Every candidate in the simplest of its forms that loses nothing material and significant. A
    form is not fitted where linear prediction loses most, and not to its end where that foresees a
    material loss and most is lost after some iterations.
    """
    for key in trial.keys:
        candidate = next(c for c in trial.candidates if c.key == key)
        simpler = sorted(
            (c for c in forms(stepwise.problem, candidate) if len(c.free) < len(candidate.free)),
            key=lambda c: len(c.free),
        )
        for form in simpler:
            names = {f.name for f in form.free}
            lost = {n: v for n, v in candidate.vanishing.items() if n not in names}
            foreseen = expected_gain(trial, lost)
            if foreseen > MOST:
                continue
            smaller = begun_in_form(stepwise, trial, candidate, form)
            if foreseen >= stepwise.problem.material and gain(trial, smaller).share >= MOST:
                continue
            smaller = stepwise.polished(smaller)
            if not stepwise.is_earned(gain(trial, smaller), p_value(trial, lost), ()):
                trial = smaller
                break
    return trial


def begun_in_form(
    stepwise: StepwiseSearch, trial: FittedModel, candidate: Candidate, form: Candidate
) -> FittedModel:
    """The trial refitted, by some iterations, with a candidate in another form."""
    dropped = set(candidate.parameters) - set(form.parameters)
    values = trial.values | {name: stepwise.problem.fixed[name] for name in dropped}
    candidates = tuple(form if c is candidate else c for c in trial.candidates)
    problem, run = stepwise.problem, stepwise.problem.executor
    return fitted(problem, candidates, values, trial.fit.z, ITERATIONS, trial.fit, executor=run)
