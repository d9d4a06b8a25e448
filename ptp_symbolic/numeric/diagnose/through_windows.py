"""Effects that act as friction lets go, led to where they fit through ever longer windows.

The misfit of whole runs is a staircase there: one start of motion a sample late moves all that
follows. A window that holds a single one tells smoothly how late it is, and longer ones tell the
parameters apart (multiple shooting: Bock, 1983).
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from ptp_symbolic.numeric.diagnose.candidates import Candidate
from ptp_symbolic.numeric.diagnose.refits import settled
from ptp_symbolic.numeric.diagnose.responses import response_columns
from ptp_symbolic.numeric.diagnose.trial import Task, Trial, continued, fitted, misfits, ranked
from ptp_symbolic.numeric.identify.constants import (
    LENGTHS,
    MATERIAL,
    POLISH,
    SEARCH_PERIOD,
    WIDE_STEP,
)
from ptp_symbolic.numeric.identify.sample_averages import samples_within, thinned
from ptp_symbolic.numeric.identify.windows import cut


def through_windows(task: Task, parent: Trial, candidate: Candidate) -> Trial | None:
    """The parent with a candidate, begun where the best of its shapes leads through ever longer
    windows; None where it does not gain materially in the longest.
    """
    parts = _growing(task)
    shapes = candidate.shapes
    if not parts:
        return None
    alone = _led(parts[0], parent.candidates, parent.values)
    if not any(response_columns(parts[0], alone, candidate, shape, np.inf) for shape in shapes):
        return None
    candidates = (*parent.candidates, candidate)
    amounts = {n: f.start for f in candidate.defining for n in f.names}

    def first(shape: Mapping[str, float]) -> Trial:
        held = replace(parts[0], fixed={**task.fixed, **amounts, **shape})
        values = _led(held, parent.candidates, {**alone.values, **amounts, **shape}).values
        return _led(parts[0], candidates, values)

    led = list(task.executor.map(first, shapes))
    for part in parts[1:]:
        jobs = [task.executor.submit(_led, part, t.candidates, t.values) for t in (alone, *led)]
        alone, *led = (job.result() for job in jobs)
        led = ranked(led)
    size = sum(run.size for run in parts[-1].train)
    cost = misfits([alone, led[0]])
    if cost[0] - cost[1] < -size * np.log(1.0 - MATERIAL):
        return None
    return fitted(task, candidates, led[0].values, None)


def _led(part: Task, candidates: Sequence[Candidate], values: Mapping[str, float]) -> Trial:
    """A set fitted to windows from `values`."""
    trial = settled(part, fitted(part, candidates, values, None), None)
    return continued(part, trial, POLISH, secants=WIDE_STEP)


def _growing(task: Task) -> list[Task]:
    """The task over windows of lengths from LENGTHS, the shortest first, as long as they are
    shorter than the runs.
    """
    few = [thinned(run, samples_within(run, SEARCH_PERIOD)) for run in task.whole]
    longest = max(float(run.time[-1] - run.time[0]) for run in task.train)
    lengths = [x for x in sorted(LENGTHS)[:3] if x < longest]
    return [replace(task, train=cut(task.model, few, x), robust_below=np.inf) for x in lengths]
