"""The search: sets that the equation space proposes, refitted by simulation, the best pruned and
grown by one candidate at a time.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ptp_symbolic.diagnose.candidates import Candidate
from ptp_symbolic.diagnose.gain import Gain, gain
from ptp_symbolic.diagnose.proposals import Proposals, declared_start, propose
from ptp_symbolic.diagnose.responses import responses
from ptp_symbolic.diagnose.trial import (
    ROUGH,
    SHARP,
    Task,
    Trial,
    continued,
    fitted,
    halving,
    mean_squares,
    ranked,
)

MATERIAL = 0.1  # share of the predictive loss below which a candidate is not worth a name
DECLARED_RUNGS = ((4, 2), (8, 1))
PROPOSED_RUNGS = ((2, 4), (3, 2), (5, 1))
ADDED_RUNGS = ((3, 2), (5, 1))
POLISH = 12
REMOVED = 4
ADDED = 4
ROUNDS = 3
AT_NOISE = 1.1


@dataclass(frozen=True, eq=False)
class Step:
    """A candidate that was added to or taken from a set, with what it gains."""

    candidate: Candidate
    gain: Gain


@dataclass(frozen=True, eq=False)
class Search:
    """What the search found: the declared model, the chosen set (the same where nothing is added),
    what every member of it gains, and all other trials.
    """

    declared: Trial
    chosen: Trial
    members: tuple[Step, ...]
    others: tuple[Trial, ...]
    proposals: Proposals


def search(task: Task) -> Search:
    """Find the set of candidates that the training runs ask for."""
    task.progress("comparing all sets of effects along the measured motion")
    proposals = propose(task)
    task.progress("fitting the declared model")
    declared = fit_declared(task, proposals)
    others: list[Trial] = []
    best = declared
    if not is_at_noise(declared):
        task.progress(f"refitting {len(proposals.sets)} proposed sets")
        begun = [fitted(task, s.candidates, s.values, None, 0) for s in proposals.sets]
        found = halving(task, begun, PROPOSED_RUNGS)
        others += begun
        if found:
            best = ranked([declared, polished(task, found[0])])[0]
    best, members, removed = prune(task, best, declared)
    others += removed
    for _ in range(ROUNDS):
        grown = grow(task, best, proposals)
        if grown is None:
            break
        others.append(best)
        best, members, removed = prune(task, grown, declared)
        others += removed
        if best.keys == others[-1].keys:
            break
    return Search(declared, best, tuple(members), tuple(others), proposals)


def fit_declared(task: Task, proposals: Proposals) -> Trial:
    """The declared model, from the start that the rows give and from the declared one."""
    starts = [proposals.start, declared_start(task)]
    begun = [fitted(task, (), values, None, 0) for values in starts]
    return polished(task, halving(task, begun, DECLARED_RUNGS)[0])


def polished(task: Task, trial: Trial) -> Trial:
    """The trial fitted to its end; with sharp simulations where only noise is left."""
    trial = continued(task, trial, POLISH, ROUGH, task.executor)
    if is_at_noise(trial):
        trial = continued(task, trial, POLISH, SHARP, task.executor)
    return trial


def is_at_noise(trial: Trial) -> bool:
    """Whether a trial leaves little more than noise in every signal."""
    squares = mean_squares(trial.fit.evaluations, trial.fit.runs)
    size = np.array([len(run.time) for run in trial.fit.runs], dtype=np.float64)
    return bool(np.all(size @ squares / size.sum() <= AT_NOISE**2))


def without(task: Task, trial: Trial, candidate: Candidate) -> Trial:
    """The trial refitted without one of its candidates, and without what needs it."""
    kept = tuple(
        c for c in trial.candidates if c is not candidate and candidate.key not in c.brings
    )
    values = trial.values | {
        name: task.fixed[name] for c in trial.candidates if c not in kept
        for f in c.free for name in (f.name, *f.tied)
    }  # fmt: skip
    begun = fitted(task, kept, values, trial.fit.z, REMOVED, ROUGH, task.executor)
    return polished(task, begun)


def prune(
    task: Task, trial: Trial, declared: Trial
) -> tuple[Trial, list[Step], list[Trial]]:
    """Take every candidate out in turn, the one that gains least first, until each that is left
    gains clearly and materially.
    """
    removed: list[Trial] = []
    while trial.candidates:
        steps = []
        for candidate in trial.candidates:
            smaller = without(task, trial, candidate)
            if not smaller.candidates:
                smaller = ranked([smaller, declared])[0]
            removed.append(smaller)
            steps.append((Step(candidate, gain(trial, smaller)), smaller))
        weakest, smaller = min(steps, key=lambda s: s[0].gain.share)
        tests = len(task.candidates)
        if weakest.gain.share >= MATERIAL and weakest.gain.is_clear(tests):
            return trial, [s for s, _ in steps], removed
        trial = smaller
    return trial, [], removed


def grow(task: Task, trial: Trial, proposals: Proposals) -> Trial | None:
    """The trial with one more candidate that gains clearly and materially; None where none does."""
    if is_at_noise(trial):
        candidates: Sequence[Candidate] = proposals.unseen
    else:
        candidates = task.candidates
    found = [r for r in responses(task, trial, candidates) if r.left < 1.0 - MATERIAL]
    if not found:
        return None
    task.progress(f"adding one of {len(found)} candidates to {' + '.join(trial.keys) or 'none'}")
    begun = [
        fitted(task, r.proposal.candidates, r.proposal.values, trial.fit.z, 0)
        for r in found[:ADDED]
    ]
    left = halving(task, begun, ADDED_RUNGS)
    if not left:
        return None
    best = polished(task, left[0])
    earned = gain(best, trial)
    clear = earned.share >= MATERIAL and earned.is_clear(len(task.candidates))
    return best if clear else None
