"""Effects that act as friction lets go, led to where they fit through ever longer windows."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.diagnose.candidates import Candidate
from ptp_symbolic.numeric.diagnose.floor import leaves_white_noise, most_hidden
from ptp_symbolic.numeric.diagnose.growing_windows import growing, led, led_through
from ptp_symbolic.numeric.diagnose.refits import to_its_end
from ptp_symbolic.numeric.diagnose.trial import (
    Task,
    Trial,
    fitted,
    mean_squares,
    misfits,
    ranked,
    simulated,
)
from ptp_symbolic.numeric.identify.constants import (
    ABOVE_NOISE,
    CYCLES,
    MATERIAL,
)

FloatArray = NDArray[np.float64]


def through_windows(
    task: Task, parent: Trial, candidate: Candidate, carried: FloatArray
) -> Trial | None:
    """The parent with a candidate, fitted to whole runs from where windows lead it, and again as
    long as that is a better place; None where it does not gain materially in windows. `carried`
    [ny] is that of `leaves_white_noise`.
    """
    parts = growing(task)
    values = _first_lead(parts, parent, candidate, carried) if parts else None
    if values is None:
        return None
    candidates = (*parent.candidates, candidate)
    trial = to_its_end(task, fitted(task, candidates, values, None), carried)
    for _ in range(CYCLES):
        if leaves_white_noise(trial, carried):
            break
        values = led_through(parts, candidates, trial.values)
        again = to_its_end(task, fitted(task, candidates, values, None), carried)
        before, trial = trial, ranked([trial, again])[0]
        if trial is before:
            break
    return trial


def _first_lead(
    parts: Sequence[Task], parent: Trial, candidate: Candidate, carried: FloatArray
) -> Mapping[str, float] | None:
    """Values where the best shape of a candidate leads through all windows; None where it does not
    gain materially in the longest.

    The others follow the candidate first, at the amount of its start: from where they make up for
    it, a search does not find back.
    """
    shortest = parts[0]
    alone = led(shortest, parent.candidates, parent.values)
    amounts = {n: f.start for f in candidate.defining for n in f.names}
    shapes = candidate.shapes
    if not any(_may_be_all(shortest, alone, {**amounts, **shape}, carried) for shape in shapes):
        return None
    candidates = (*parent.candidates, candidate)

    def first(shape: Mapping[str, float]) -> Trial:
        held = {**amounts, **shape}
        part = replace(shortest, fixed={**shortest.fixed, **held})
        others = led(part, parent.candidates, {**alone.values, **held})
        return led(shortest, candidates, others.values)

    run = shortest.executor
    with_it = list(run.map(first, shapes))
    for part in parts[1:]:
        jobs = [run.submit(led, part, t.candidates, t.values) for t in (alone, *with_it)]
        alone, *with_it = (job.result() for job in jobs)
    best = ranked(with_it)[0]
    cost = misfits([alone, best])
    size = sum(r.size for r in best.fit.runs)
    return best.values if cost[1] <= cost[0] + size * np.log(1.0 - MATERIAL) else None


def _may_be_all(
    part: Task, alone: Trial, amounts: Mapping[str, float], carried: FloatArray
) -> bool:
    """Whether a candidate at some `amounts` changes some windows, and those that it leaves as they
    are hold no more than may be noise: else they lack something besides.
    """
    fit = alone.fit
    changed = [
        e.failed is not None or not np.array_equal(e.residual, before.residual)
        for e, before in zip(simulated(part, fit, amounts, None), fit.evaluations, strict=True)
    ]
    left = mean_squares(fit.evaluations, fit.runs)[np.logical_not(changed)]
    usual = np.median(left, axis=0) if len(left) else np.zeros(len(carried))
    most = ABOVE_NOISE * np.hypot(most_hidden(part), carried)
    return any(changed) and bool(np.all(np.sqrt(usual) <= most))
