"""Fits over ever longer windows, which lead to where whole runs, or longer windows, fit.

The misfit of long runs is a staircase where friction lets go: one start of motion a sample late
moves all that follows. A window that holds a single one tells smoothly how late it is, and longer
ones tell the parameters apart (multiple shooting: Bock, 1983).
"""

from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.diagnose.candidates import Candidate
from ptp_symbolic.numeric.diagnose.leading_windows import leading
from ptp_symbolic.numeric.diagnose.trial import (
    Task,
    Trial,
    continued,
    fitted,
    is_alike,
    mean_squares,
)
from ptp_symbolic.numeric.identify.constants import (
    CYCLES,
    ITERATIONS,
    LENGTHS,
    SEARCH_PERIOD,
    WIDE_STEP,
)
from ptp_symbolic.numeric.identify.robust_loss import weighted_median
from ptp_symbolic.numeric.identify.run_groups import sizes
from ptp_symbolic.numeric.identify.run_starts import starts_in_place
from ptp_symbolic.numeric.identify.sample_averages import samples_within, thinned
from ptp_symbolic.numeric.identify.simulations import POLISH
from ptp_symbolic.numeric.identify.windows import cut

FloatArray = NDArray[np.float64]


def growing(task: Task, *, few: bool = False) -> list[Task]:
    """The task over windows of doubled lengths, up to 2 s, that are shorter than its runs; over all
    of them, or a `few` that tell what is usual, in pairs where one tells how the other begins.
    """
    runs = [thinned(run, samples_within(run, SEARCH_PERIOD)) for run in task.whole]
    longest = max(float(run.time[-1] - run.time[0]) for run in task.train)
    every = {x: cut(task.model, runs, x) for x in LENGTHS[:1:-1] if x < longest}
    windows = [leading(w, x, 2.0 * x) if few else w for x, w in every.items()]
    return [replace(task, train=w, robust_below=np.inf) for w in windows]


def led_through(
    parts: Sequence[Task], candidates: Sequence[Candidate], values: Mapping[str, float]
) -> Mapping[str, float]:
    """Values to which windows lead a set from `values`, through one of `parts` after the other."""
    for part in parts:
        values = led(part, candidates, values).values
    return values


def led(part: Task, candidates: Sequence[Candidate], values: Mapping[str, float]) -> Trial:
    """A set fitted to windows from `values`."""
    trial = settled(part, fitted(part, candidates, values, None), None, brief=True)
    return continued(part, trial, POLISH, secants=WIDE_STEP)


def settled(task: Task, trial: Trial, executor: Executor | None, *, brief: bool = False) -> Trial:
    """The trial fitted on until some iterations more change next to nothing, the gears put in their
    places anew each time: a window that began on the wrong side of a gap holds the others back.
    `brief` is that of `starts_in_place`.
    """
    for _ in range(CYCLES):
        z = starts_of(trial, executor, brief=brief)
        better = continued(task, trial, ITERATIONS, executor=executor, z=z)
        if is_alike(better, trial):
            break
        trial = better
    return trial


def starts_of(trial: Trial, executor: Executor | None, *, brief: bool = False) -> list[FloatArray]:
    """Start unknowns, each [nz], of the runs of a trial with what is hidden at their start in place
    (see `starts_in_place`).
    """
    fit = trial.fit
    usual = _usual_square(trial, _squares(trial))
    return starts_in_place(
        fit.model, fit.runs, fit.values, fit.z, fit.tolerance, executor, brief=brief, usual=usual
    )


def shares_of_usual(trial: Trial) -> FloatArray:
    """Mean square [n] that every run of a trial leaves, in those of the usual one."""
    square = _squares(trial)
    return square / max(_usual_square(trial, square), 1e-300)


def _squares(trial: Trial) -> FloatArray:
    fit = trial.fit
    return np.asarray(mean_squares(fit.evaluations, fit.runs).mean(axis=1), dtype=np.float64)


def _usual_square(trial: Trial, square: FloatArray) -> float:
    return float(weighted_median(square[:, None], sizes(trial.fit.runs))[0])
