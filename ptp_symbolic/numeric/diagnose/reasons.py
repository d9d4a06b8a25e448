"""Why a verdict came out: the rules that decided it, each with the number it was held to."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from ptp_symbolic.numeric.diagnose.candidates import Candidate
from ptp_symbolic.numeric.diagnose.findings import Search, looked_at
from ptp_symbolic.numeric.diagnose.gain import Gain, p_value
from ptp_symbolic.numeric.diagnose.left_over import left_over
from ptp_symbolic.numeric.diagnose.trial import Trial
from ptp_symbolic.numeric.diagnose.verdict import Verdict
from ptp_symbolic.numeric.identify.constants import ABOVE_NOISE, FALSE_ALARM, MOST

SHARE = "share by which the sum of squares on blocks left out falls"
CERTAIN = "lower end of the 95 % interval of that share"
CHANCE = "chance of finding it where it is not"
VALIDATED = "share by which the sum of squares of the validation runs falls"
TRAINING = "residual of {signal} on the training runs, over the largest that noise may leave"
VALIDATION = "residual of {signal} on the validation runs, over the largest that noise may leave"
ALIKE = "other effects that do as well in its place"


def reasons(found: Search, verdict: Verdict, compared: int) -> list[dict[str, Any]]:
    """A row for every rule and what it was asked `about` (the key of an effect; None: the whole
    model): the `value`, whether it has to be `at_least` or `at_most` the `limit`, and whether it
    `holds`. `compared` is the number of structures that were fitted.
    """
    rows = []
    for candidate in verdict.final.candidates:
        tests = _tests(found, verdict.compared, candidate, compared)
        rows += _of_effect(found, verdict, candidate, tests)
    if verdict.held_out is not None:
        least = MOST if verdict.leaves_more else found.task.material
        rows.append(_row(None, VALIDATED, verdict.held_out.share, "at_least", least))
    most = verdict.floor.most
    for text, fit in ((TRAINING, verdict.final.fit), (VALIDATION, verdict.after)):
        for signal, ratio in zip(fit.runs[0].signals, left_over(fit) / most, strict=True):
            rows.append(_row(None, text.format(signal=signal), ratio, "at_most", ABOVE_NOISE))
    return rows


def _of_effect(
    found: Search, verdict: Verdict, candidate: Candidate, tests: int
) -> list[dict[str, Any]]:
    key, gain = candidate.key, verdict.gains[candidate.key]
    least = MOST if verdict.leaves_more else 0.0
    chance = _chance(gain, verdict.compared, candidate.vanishing)
    return [
        _row(key, SHARE, gain.share, "at_least", found.task.material),
        _row(key, CERTAIN, gain.lower, "at_least", least),
        _row(key, CHANCE, chance, "at_most", FALSE_ALARM / tests),
        _row(key, ALIKE, len(verdict.confusable[key]), "at_most", 0),
    ]


def _chance(gain: Gain, trial: Trial, vanishing: Mapping[str, float]) -> float:
    """The smallest chance of three tests, times three."""
    by_values = p_value(trial, vanishing) if vanishing else 1.0
    return min(1.0, 3.0 * min(by_values, gain.chance, gain.by_rank))


def _tests(found: Search, trial: Trial, candidate: Candidate, compared: int) -> int:
    """How many were looked at: structures have no value at which they vanish."""
    if not candidate.vanishing:
        return max(compared, 1)
    return max(looked_at(found.task.candidates, [candidate]), 1)


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
