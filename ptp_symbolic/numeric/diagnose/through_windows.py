"""Effects that act as friction lets go, led to where they fit through ever longer windows."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.diagnose.candidates import Candidate, with_what_it_brings
from ptp_symbolic.numeric.diagnose.cut_runs import growing, led, led_through, settled
from ptp_symbolic.numeric.diagnose.floor import leaves_white_noise, most_hidden
from ptp_symbolic.numeric.diagnose.left_over import Carried
from ptp_symbolic.numeric.diagnose.refits import to_its_end
from ptp_symbolic.numeric.diagnose.trial import (
    Task,
    Trial,
    fitted,
    misfits,
    ranked,
    simulated,
)
from ptp_symbolic.numeric.identify.constants import (
    ABOVE_NOISE,
    AMOUNTS,
    CYCLES,
    SCREENED,
)
from ptp_symbolic.numeric.identify.evaluate import mean_squares
from ptp_symbolic.numeric.identify.evidence import recorded
from ptp_symbolic.numeric.identify.fit import Fit

FloatArray = NDArray[np.float64]


def each_through_windows(
    task: Task,
    parent: Trial,
    candidates: Sequence[Candidate],
    carried: Carried,
    *,
    is_white: bool,
) -> list[Trial]:
    """The parent with each of `candidates` but declared values, where windows lead to it (see
    `through_windows`); those alone that are reached in time.
    """
    wanted = {c.key: c for c in candidates if not c.is_declared_value}
    led = [
        through_windows(task, parent, c, carried, is_white=is_white)
        for c in wanted.values()
        if not task.is_over
    ]
    return [t for t in led if t is not None]


def through_windows(
    task: Task, parent: Trial, candidate: Candidate, carried: Carried, *, is_white: bool
) -> Trial | None:
    """The parent with a candidate, fitted to whole runs from where windows lead it, and again as
    long as that is a better place; None where it does not gain materially in a few windows.
    `carried` is that of `leaves_white_noise`; `is_white`: the noise is known to be, since another
    set leaves no more than that.
    """
    few = growing(task, few=True)
    hidden = 1.0 if is_white else most_hidden(task)
    most = ABOVE_NOISE * np.hypot(hidden, carried.most)
    candidates = with_what_it_brings(parent.candidates, candidate, task.candidates)
    values = _first_lead(few, parent, candidates, most) if few else None
    if values is None:
        return None
    trial = to_its_end(task, fitted(task, candidates, values, None), carried)
    parts = growing(task)
    for _ in range(CYCLES):
        if leaves_white_noise(trial, carried):
            break
        values = led_through(parts, candidates, trial.values)
        again = to_its_end(task, fitted(task, candidates, values, None), carried)
        if ranked([trial, again])[0] is trial:
            break
        trial = again
    return trial


def _first_lead(
    parts: Sequence[Task], parent: Trial, candidates: Sequence[Candidate], most: FloatArray
) -> Mapping[str, float] | None:
    """Values where windows lead the last of `candidates`, with those that it brings along; None
    where windows that it leaves as they are hold more than `most` [ny] times their noise, and where
    it does not gain materially in the longest: each begins by itself, so that short ones leave
    little of an effect that acts late.

    It begins at the amount of its start, to which all others follow first: from where they make up
    for it a search does not find back. And in every part at the best of several amounts, all others
    as they are without it.
    """
    shortest, run = parts[0], parts[0].executor
    alone = led(shortest, parent.candidates, parent.values)
    added = candidates[len(parent.candidates) :]
    shapes = added[-1].shapes
    starts = [{**_amounts(added, 1.0), **shape} for shape in shapes]
    if not any(_may_be_all(shortest, alone, start, most) for start in starts):
        return None

    def followed(start: Mapping[str, float]) -> Trial:
        part = replace(shortest, fixed={**shortest.fixed, **start})
        others = settled(
            part, fitted(part, parent.candidates, {**alone.values, **start}, None), None, brief=True
        )
        return led(shortest, candidates, others.values)

    with_it: list[Trial] = []
    for part in parts:
        if part is shortest:
            jobs = [run.submit(followed, start) for start in starts]
        else:
            alone = led(part, parent.candidates, alone.values)
            jobs = [run.submit(led, part, candidates, t.values) for t in with_it]
        jobs += [run.submit(_scanned, part, alone, added, s) for s in shapes]
        found = [job.result() for job in jobs]
        with_it = [found[k] for k in np.argsort(misfits(found))[:SCREENED]]
    cost = misfits([alone, with_it[0]])
    least_change = sum(r.size for r in alone.fit.runs) * np.log(1.0 - shortest.material)
    return with_it[0].values if cost[1] <= cost[0] + least_change else None


def _scanned(
    part: Task, alone: Trial, added: Sequence[Candidate], shape: Mapping[str, float]
) -> Trial:
    """A trial with the best of several amounts of what is added, of some `shape`, fitted on."""
    candidates = (*alone.candidates, *added)
    values = [{**alone.values, **_amounts(added, k), **shape} for k in AMOUNTS]
    begun = [fitted(part, candidates, v, alone.fit.z) for v in values]
    return led(part, candidates, ranked(begun)[0].values)


def _amounts(candidates: Sequence[Candidate], factor: float) -> dict[str, float]:
    """What switches candidates on, each at its start times a factor."""
    return {
        n: float(np.clip(factor * f.start, f.lower, f.upper))
        for candidate in candidates
        for f in candidate.defining
        for n in f.names
    }


def _may_be_all(part: Task, alone: Trial, amounts: Mapping[str, float], most: FloatArray) -> bool:
    """Whether a candidate at some `amounts` changes some windows, and those that it leaves as they
    are hold no more than may be noise, at `most` [ny]: else they lack something besides.
    """
    changed = _changed(part, alone.fit, amounts)
    fit = alone.fit
    left = mean_squares(fit.evaluations, fit.runs)[np.logical_not(changed)]
    usual = np.median(left, axis=0) if len(left) else np.zeros(left.shape[1])
    return any(changed) and bool(np.all(np.sqrt(usual) <= most))


@recorded()
def _changed(part: Task, fit: Fit, amounts: Mapping[str, float]) -> list[bool]:
    """Which windows of a fit a candidate changes at some `amounts`."""
    return [
        e.failed is not None or not np.array_equal(e.residual, before.residual)
        for e, before in zip(simulated(part, fit, amounts, None), fit.evaluations, strict=True)
    ]
