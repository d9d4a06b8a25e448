"""The rounds of a diagnosis: one missing effect, then two, from the best few of the first round."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ptp_symbolic.diagnose.candidates import Candidate
from ptp_symbolic.diagnose.escape import escape
from ptp_symbolic.diagnose.scores import Score
from ptp_symbolic.diagnose.search import (
    BEAM,
    fit_declared,
    judge,
    scores,
    try_candidates,
    visible_candidates,
    without,
)
from ptp_symbolic.diagnose.trial import COARSE, LAST, Task, Trial, continue_fits, held_out_cost
from ptp_symbolic.diagnose.verdict import Verdict, decide, is_settled
from ptp_symbolic.identify.fit import Effort

BASES, PAIR_ROUNDS, BETTER = 3, 2, 0.9
GLANCE = Effort(3, 1e-2, COARSE)


@dataclass(frozen=True, eq=False)
class Diagnosis:
    """Everything that a diagnosis found: base fit, every trial, scores, what cannot be seen."""

    base: Trial
    trials: tuple[Trial, ...]
    scores: dict[str, Score]
    invisible: tuple[Candidate, ...]
    verdict: Verdict


def _better_base(task: Task, base: Trial, verdict: Verdict) -> Trial | None:
    """The declared model begun where the accepted effect led, if it does better without the effect:
    then `base` ended in a local minimum, and the effect has earned nothing yet.
    """
    best = verdict.accepted or next(iter(verdict.rivals), None)
    if best is None or len(best.candidates) != 1:
        return None
    alone = without(task, best, best.candidates[0], GLANCE)
    if alone.train.failed or alone.train.cost > BETTER * base.train.cost:
        return None
    found = judge(task, escape(task, continue_fits(task, [alone], LAST)[0]))
    task.progress(f"the declared model alone leaves {found.train.rms_counts():.3f} counts rms")
    return found


def _members(task: Task, trials: Sequence[Trial]) -> list[Trial]:
    """Each effect of the best pair alone, from where the pair led it: where the other has earned
    nothing, and often a better place than its own search found.
    """
    pairs = [t for t in trials if len(t.candidates) > 1 and np.isfinite(held_out_cost(t))]
    best = sorted(pairs, key=held_out_cost)[:1]
    alone = [judge(task, without(task, pair, c, LAST)) for pair in best for c in pair.candidates]
    return sorted(alone, key=held_out_cost)


def diagnose(task: Task, candidates: Sequence[Candidate]) -> Diagnosis:
    """Find what the declared model lacks; at most two effects at once."""
    base, better = fit_declared(task), None
    for _ in range(BASES):
        base = better or base
        scored = scores(task, base, candidates)
        visible = visible_candidates(task, base, candidates, scored)
        trials = try_candidates(task, [base], visible)
        verdict = decide(task, base, trials)
        better = _better_base(task, base, verdict)
        if better is None:
            break
    invisible = tuple(c for c in candidates if c not in visible)
    beam = [t for t in trials if np.isfinite(held_out_cost(t))][:BEAM]
    effects = [c for c in visible if not c.is_declared_value]
    for _ in range(PAIR_ROUNDS):
        if is_settled(verdict) or not beam:
            break
        trials += try_candidates(task, beam, effects)
        alone, before = _members(task, trials), held_out_cost(beam[0])
        trials += alone
        verdict = decide(task, base, trials)
        beam = [t for t in alone if held_out_cost(t) < BETTER * before][:1]
    ordered = sorted(trials, key=lambda t: (held_out_cost(t), t.train.cost))
    unique = {t.keys: t for t in reversed(ordered)}
    kept = sorted(unique.values(), key=lambda t: (held_out_cost(t), t.train.cost))
    return Diagnosis(base, tuple(kept), scored, invisible, verdict)
