"""Whether a candidate is needed: what it gains, and how likely that is where it is not there."""

from dataclasses import dataclass

from ptp_symbolic.diagnose.candidates import Candidate
from ptp_symbolic.diagnose.gain import Gain, gain, p_value
from ptp_symbolic.diagnose.trial import Trial

MATERIAL = 0.1  # share of the predictive loss below which a candidate is not worth a name
FALSE_ALARM = 0.05  # over all candidates that a search looks at


@dataclass(frozen=True, eq=False)
class Step:
    """A candidate of a set, what it gains, how likely it is found where it is not (see `p_value`),
    and the trial without it.
    """

    candidate: Candidate
    gain: Gain
    p_value: float
    without: Trial


def step_of(trial: Trial, candidate: Candidate, without: Trial) -> Step:
    """What `candidate` gains in `trial` over the trial `without` it."""
    return Step(candidate, gain(trial, without), p_value(trial, candidate.vanishing), without)


def is_earned(earned: Gain, p: float, tests: int) -> bool:
    """Whether a gain is material, and clear over so many `tests` (Bonferroni)."""
    return earned.share >= MATERIAL and earned.lower > 0.0 and p < FALSE_ALARM / max(tests, 1)
