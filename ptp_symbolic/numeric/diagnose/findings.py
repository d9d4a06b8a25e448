"""What a search finds: the chosen set, what its members gain, and whether that is enough."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from weakref import WeakSet

import numpy as np

from ptp_symbolic.numeric.diagnose.candidates import Candidate
from ptp_symbolic.numeric.diagnose.gain import Gain, gain, p_value
from ptp_symbolic.numeric.diagnose.left_over import Carried
from ptp_symbolic.numeric.diagnose.proposals import Proposals
from ptp_symbolic.numeric.diagnose.trial import (
    Task,
    Trial,
    is_near,
    ranked,
)
from ptp_symbolic.numeric.identify.constants import FALSE_ALARM
from ptp_symbolic.numeric.identify.evaluate import Evaluation
from ptp_symbolic.numeric.identify.evidence import Deferred


@dataclass(frozen=True, eq=False)
class Tried:
    """Trials that are not chosen, `others`; those fitted to their end; and by the forms of its
    candidates (see `forms_of`) where every set ends that was begun anew from the rows.
    """

    others: list[Trial] = field(default_factory=list)
    at_end: WeakSet[Trial] = field(default_factory=WeakSet)
    anew: dict[tuple[tuple[str, int], ...], Trial] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class Step:
    """A candidate of a set, what it gains, how likely it is found where it is not (see `p_value`),
    and the trial without it.
    """

    candidate: Candidate
    gain: Gain
    p_value: float
    without: Trial


@dataclass(frozen=True, eq=False)
class Search:
    """What the search found: the declared model, the chosen set (the same where nothing is added),
    what every member of it gains, all that was tried, and the noise of the inputs as the best model
    so far carries it to the outputs. `task` has the candidates with a frequency where a line was
    found, and without those that have none. The search `is_cut_short` where its time was over at
    its end: some moves may not have been tried. The declared model `is_led` where windows have led
    it too, and `is_taken_over` where it was found from the end of a set, not from its own starts.
    """

    task: Task
    declared: Trial
    chosen: Trial
    members: tuple[Step, ...]
    tried: Tried
    proposals: Proposals
    carried: Carried
    is_cut_short: bool
    is_led: bool = True
    is_taken_over: bool = False


@dataclass(frozen=True, eq=False)
class Refusals:
    """Why candidates that gained are not named, by key, and the keys of those whose torque goes
    with the speed in another way than their law.
    """

    why: dict[str, str] = field(default_factory=dict)
    lawless: set[str] = field(default_factory=set)

    def note(self, key: str, why: str, breaks_law: bool = False) -> None:
        """Note the last reason: in another set a candidate may be refused for another one."""
        self.why[key] = why
        if breaks_law:
            self.lawless.add(key)
        else:
            self.lawless.discard(key)


def step_of(trial: Trial, candidate: Candidate, without: Trial) -> Step:
    """What `candidate` gains in `trial` over the trial `without` it."""
    return Step(candidate, gain(trial, without), p_value(trial, candidate.vanishing), without)


def looked_at(candidates: Sequence[Candidate], added: Sequence[Candidate]) -> int:
    """How many tests were made before some were `added`: one for every candidate, and one for every
    frequency that those were scanned over.
    """
    return len(candidates) * math.prod(c.frequencies_compared for c in added)


def is_earned(earned: Gain, p: float, tests: int, material: float) -> bool:
    """Whether a gain is at least the share `material`, and clear over so many `tests` by the values
    of its parameters (see `p_value`), or by how much better it predicts blocks, or by how many
    (Bonferroni): parameters that trade for each other may each be anything while their effect is
    beyond doubt.
    """
    chance = 3.0 * min(p, earned.chance, earned.by_rank)
    return earned.share >= material and earned.lower > 0.0 and chance < FALSE_ALARM / max(tests, 1)


def worth_keeping(trials: Sequence[Trial], best: Trial) -> list[Trial]:
    """The best trial of every set. Of those that are far behind `best` (see `is_near`) only tables
    still ask what they gain: single precision is enough for their Jacobians.
    """
    return [t if is_near(t, [best]) else _lighter(t) for t in ranked(trials)]


def _lighter(trial: Trial) -> Trial:
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
