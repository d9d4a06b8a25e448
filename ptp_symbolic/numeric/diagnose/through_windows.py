"""Effects that act as friction lets go, led to where they fit through ever longer windows.

The misfit of whole runs is a staircase there: one start of motion a sample late moves all that
follows. A window that holds a single one tells smoothly how late it is, and longer ones tell the
parameters apart (multiple shooting: Bock, 1983).
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.diagnose.candidates import Candidate
from ptp_symbolic.numeric.diagnose.floor import leaves_white_noise
from ptp_symbolic.numeric.diagnose.refits import settled, to_its_end
from ptp_symbolic.numeric.diagnose.responses import response_columns
from ptp_symbolic.numeric.diagnose.trial import Task, Trial, continued, fitted, misfits, ranked
from ptp_symbolic.numeric.identify.constants import (
    CYCLES,
    LENGTHS,
    MATERIAL,
    POLISH,
    SEARCH_PERIOD,
    WIDE_STEP,
)
from ptp_symbolic.numeric.identify.sample_averages import samples_within, thinned
from ptp_symbolic.numeric.identify.windows import cut

FloatArray = NDArray[np.float64]


def through_windows(
    task: Task, parent: Trial, candidate: Candidate, carried: FloatArray
) -> Trial | None:
    """The parent with a candidate, fitted to whole runs from where windows lead it, and again as
    long as that is a better place; None where it does not gain materially in windows. `carried`
    [ny] is that of `leaves_white_noise`.
    """
    parts = _growing(task)
    values = _first_lead(parts, parent, candidate) if parts else None
    if values is None:
        return None
    candidates = (*parent.candidates, candidate)
    trial = to_its_end(task, fitted(task, candidates, values, None), carried)
    for _ in range(CYCLES):
        if leaves_white_noise(trial, carried):
            break
        values = trial.values
        for part in parts:
            values = _led(part, candidates, values).values
        again = to_its_end(task, fitted(task, candidates, values, None), carried)
        before, trial = trial, ranked([trial, again])[0]
        if trial is before:
            break
    return trial


def _first_lead(
    parts: Sequence[Task], parent: Trial, candidate: Candidate
) -> Mapping[str, float] | None:
    """Values where the best shape of a candidate leads through all windows; None where it does not
    gain materially in the longest.

    The others follow the candidate first, at the amount of its start: from where they make up for
    it, a search does not find back.
    """
    shortest = parts[0]
    alone = _led(shortest, parent.candidates, parent.values)
    shapes = candidate.shapes
    if not any(response_columns(shortest, alone, candidate, shape, np.inf) for shape in shapes):
        return None
    candidates = (*parent.candidates, candidate)
    amounts = {n: f.start for f in candidate.defining for n in f.names}

    def first(shape: Mapping[str, float]) -> Trial:
        held = {**amounts, **shape}
        part = replace(shortest, fixed={**shortest.fixed, **held})
        return _led(
            shortest, candidates, _led(part, parent.candidates, {**alone.values, **held}).values
        )

    run = shortest.executor
    led = list(run.map(first, shapes))
    for part in parts[1:]:
        jobs = [run.submit(_led, part, t.candidates, t.values) for t in (alone, *led)]
        alone, *led = (job.result() for job in jobs)
    best = ranked(led)[0]
    cost = misfits([alone, best])
    size = sum(r.size for r in best.fit.runs)
    return best.values if cost[1] <= cost[0] + size * np.log(1.0 - MATERIAL) else None


def _led(part: Task, candidates: Sequence[Candidate], values: Mapping[str, float]) -> Trial:
    """A set fitted to windows from `values`."""
    trial = settled(part, fitted(part, candidates, values, None), None)
    return continued(part, trial, POLISH, secants=WIDE_STEP)


def _growing(task: Task) -> list[Task]:
    """The task over windows of the three shortest LENGTHS, the shortest first, as long as they are
    shorter than the runs.
    """
    few = [thinned(run, samples_within(run, SEARCH_PERIOD)) for run in task.whole]
    longest = max(float(run.time[-1] - run.time[0]) for run in task.train)
    lengths = [x for x in sorted(LENGTHS)[:3] if x < longest]
    return [replace(task, train=cut(task.model, few, x), robust_below=np.inf) for x in lengths]
