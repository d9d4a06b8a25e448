"""Where refits by simulation begin: at what the rows or the outputs ask for, and beside it."""

import math
from collections.abc import Mapping, Sequence, Set
from dataclasses import replace

import numpy as np

from ptp_symbolic.numeric.diagnose.candidates import FAR_OFF, Candidate
from ptp_symbolic.numeric.diagnose.declared_rows import declared_start
from ptp_symbolic.numeric.diagnose.linear import made_up_for, stacked_jacobian
from ptp_symbolic.numeric.diagnose.proposals import Proposal, Proposals, start_for
from ptp_symbolic.numeric.diagnose.refits import inside, over_windows, strayed_back
from ptp_symbolic.numeric.diagnose.regression import untold
from ptp_symbolic.numeric.diagnose.responses import Response
from ptp_symbolic.numeric.diagnose.trial import (
    Task,
    Trial,
    all_free,
    continued,
    fitted,
    misfits,
    ranked,
    side_by_side,
    simulated_at,
)
from ptp_symbolic.numeric.identify.constants import ITERATIONS, MOST, TRIED, WIDE_STEP
from ptp_symbolic.numeric.identify.coordinates import FreeParameter
from ptp_symbolic.numeric.identify.evidence import recorded
from ptp_symbolic.numeric.identify.fit import Fit


def started(task: Task, declared: Trial, sets: Sequence[Proposal]) -> list[Trial]:
    """The proposed sets that do best over short windows, each at the better of two starts: where
    the windows lead, and beside the declared model.
    """
    part = replace(task, train=task.few)

    def short_fit(proposal: Proposal) -> Trial:
        values, run = proposal.values, task.executor
        return fitted(part, proposal.candidates, values, None, ITERATIONS, executor=run)

    def at_better_start(short: Trial) -> Trial:
        own = {name for c in short.candidates for name in c.names}
        beside = declared.values | {name: short.values[name] for name in own}
        starts = [
            _begun(task, short.candidates, short.values, None),
            _begun(task, short.candidates, beside, declared.fit),
        ]
        return ranked(starts)[0]

    return side_by_side(at_better_start, ranked(side_by_side(short_fit, sets))[:TRIED])


def along(task: Task, proposals: Proposals, found: Response, parent: Trial) -> list[Trial]:
    """Refits begun where a response in the outputs leads from `parent`, and part of the way there.
    What the motion does not show has derivatives that mislead: they are looked for at once.
    """
    proposal = found.proposal
    origin = parent.values | dict(found.shape)
    begun = []
    for part in (1.0, MOST):
        values = {n: origin[n] + part * (v - origin[n]) for n, v in proposal.values.items()}
        begun.append(_begun(task, proposal.candidates, values, parent.fit))
    if found.candidate.key not in {c.key for c in proposals.unseen}:
        return [ranked(begun)[0]]
    return [continued(task, t, 1, secants=WIDE_STEP, executor=task.executor) for t in begun]


def from_rows(
    task: Task, proposals: Proposals, candidates: Sequence[Candidate], values: Mapping[str, float]
) -> list[Trial]:
    """A set where the rows start it (what they do not show stays at `values`), and where windows
    lead from there and from the declared start.
    """
    start = start_for(task, proposals, candidates, values)
    own = {name: start[name] for c in candidates for name in c.names}
    begun = over_windows(task, candidates, [start, declared_start(task) | own])
    return [*begun, _begun(task, candidates, start, None)]


def taken_over(task: Task, kept: Sequence[Candidate], trial: Trial) -> list[Trial]:
    """The declared model with some candidates `kept` of a trial, without the others: as they are,
    and where they take over what the others did, by linear prediction; a limit is switched
    off too far away for that.
    """
    dropped = [c for c in trial.candidates if c not in kept]
    off = {name: task.fixed[name] for c in dropped for name in c.names}
    values = trial.values | off
    others = {f.name for f in all_free(task, kept, values)}
    linear = [f for c in dropped for f in c.defining if not c.is_limit(f)]
    vanishing = {f.name: off[f.name] for f in linear}
    taken = _taken(trial.fit, vanishing, others) | off
    starts = [values] if taken == values else [values, taken]
    return side_by_side(lambda start: _begun(task, kept, start, trial.fit), starts)


@recorded()
def _taken(fit: Fit, vanishing: Mapping[str, float], others: Set[str]) -> dict[str, float]:
    """See `made_up_for`."""
    return made_up_for(fit, vanishing, others, stacked_jacobian(fit))


def in_place(
    task: Task, proposals: Proposals, candidates: Sequence[Candidate], trial: Trial
) -> list[Trial]:
    """A set like that of `trial`, where the rows start it, and where they start its candidates
    alone.
    """
    start = start_for(task, proposals, candidates, trial.values)
    beside = trial.values | {name: start[name] for c in candidates for name in c.names}
    return [_begun(task, candidates, values, None) for values in (start, beside)]


def far_starts(
    free: Sequence[FreeParameter], values: Mapping[str, float]
) -> list[dict[str, float]]:
    """`values` with one of the parameters `free` after the other that begin above zero as far from
    its start as that may be off: rows tell an inertia behind a gear by its share in the whole
    alone, and fits that begin with a gap and too little of it end with none.
    """
    return [
        {**values, **dict.fromkeys(f.names, inside(f, factor * f.start))}
        for f in free
        for factor in (FAR_OFF, 1.0 / FAR_OFF)
        if f.start > 0.0
    ]


def from_far_off(task: Task, proposals: Proposals, trial: Trial) -> list[Trial]:
    """A trial with one declared parameter that the rows do not tell far off, each of them in turn
    (see `far_starts`), and in other valleys over it, the best first, not yet fitted: how a shaft
    damps shows only as a gear bounces, and the misfit is rough in it. And with those that strayed
    back where a start may be: noise alone may be left in these runs where they hardly matter.
    """
    rows = proposals.regression
    free = [] if rows is None else [f for f in untold(rows) if f.start > 0.0]
    valleys = [t for f in free for t in _valleys(task, trial, f)]
    order = np.argsort(misfits([trial, *valleys])[1:])[:TRIED]
    starts = [*(valleys[k].values for k in order), *far_starts(free, trial.values)]
    begun = [_begun(task, trial.candidates, values, trial.fit) for values in starts]
    return begun + strayed_back(task, trial)


def _valleys(task: Task, trial: Trial, free: FreeParameter) -> list[Trial]:
    """The trial, not fitted, where it leaves less at a value of one parameter, all others as they
    are, than at the values beside it: half as much more at every step, at least as far from its
    start as that may be off. Its own value is among the values, and not returned.
    """
    own, steps = trial.values[free.name], math.ceil(math.log(FAR_OFF) / math.log(1.0 + MOST))
    spread = free.start * (1.0 + MOST) ** np.arange(-steps, steps + 1)
    amounts = sorted({own, *(inside(free, a) for a in spread)})
    scanned = [trial if a == own else _moved(task, trial, free, a) for a in amounts]
    cost = [np.inf, *misfits(scanned), np.inf]
    return [
        place
        for place, before, here, after in zip(scanned, cost, cost[1:], cost[2:], strict=False)
        if place is not trial and here < min(before, after)
    ]


def _moved(task: Task, trial: Trial, free: FreeParameter, amount: float) -> Trial:
    """The trial with one parameter at another amount, not fitted, and without new Jacobians."""
    values = trial.values | dict.fromkeys(free.names, amount)
    evaluations = simulated_at(task, trial.fit, values)
    return replace(trial, fit=replace(trial.fit, values=values, evaluations=evaluations))


def _begun(
    task: Task,
    candidates: Sequence[Candidate],
    values: Mapping[str, float],
    parent: Fit | None,
) -> Trial:
    """A set at some values, not yet fitted; its runs begin where those of the parent did, or else
    at their guesses.
    """
    z = None if parent is None else parent.z
    return fitted(task, candidates, values, z, 0, parent, executor=task.executor)
