"""Runs that nothing predicts to their end: cut into windows with starts of their own."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.diagnose.leading_windows import spread_over
from ptp_symbolic.numeric.diagnose.left_over import left_over
from ptp_symbolic.numeric.diagnose.trial import Task, Trial, mean_squares
from ptp_symbolic.numeric.identify.constants import MOST, SHORT
from ptp_symbolic.numeric.identify.lost_samples import parted_at_lost_samples
from ptp_symbolic.numeric.identify.run import Run
from ptp_symbolic.numeric.identify.windows import (
    cut_where_errors_grow,
    multiplies_errors,
    split_run,
)

FloatArray = NDArray[np.float64]

CUT = "runs that multiply small errors are cut into windows"


def in_windows(task: Task, declared: Trial) -> Task:
    """The task with runs cut into windows where the fitted model amplifies errors until nothing can
    be predicted (see `cut_where_errors_grow`).
    """
    model, noise = task.model, task.input_noise
    p = model.parameter_vector(declared.values)
    left = np.sqrt(mean_squares(declared.fit.evaluations, task.train))
    train = cut_where_errors_grow(
        model, task.every_sample, declared.fit.z, left, p, noise, task.executor
    )
    if len(train) == len(task.train):
        return task
    fewer = dict(zip(task.every_sample, task.train, strict=True))
    task.progress(CUT)
    return replace(task, every_sample=train, train=tuple(fewer.get(run, run) for run in train))


def validation_in_windows(task: Task, declared: Trial) -> Task:
    """The task with its validation runs cut where training runs would be, whatever they leave."""
    model, runs = task.model, task.validate
    p, starts = model.parameter_vector(declared.values), [run.guess for run in runs]
    left = np.zeros((len(runs), len(task.train[0].signals)))
    cut = cut_where_errors_grow(model, runs, starts, left, p, task.input_noise, task.executor)
    return replace(task, validate=cut)


def parted_task(task: Task, trial: Trial) -> Task:
    """The task with training and validation runs parted where samples are missing, and the signals
    depend on what the inputs did meanwhile (see `parted_at_lost_samples`), at the values of a
    trial.
    """
    p = task.model.parameter_vector(trial.values)

    def parts_of(run: Run, z: FloatArray) -> tuple[Run, ...]:
        return parted_at_lost_samples(task.model, run, p)

    return _in_parts(task, trial, parts_of, "runs are parted where samples are missing")


def takes_away_most(short: Trial, trial: Trial) -> bool:
    """Whether a trial in windows leaves less than half of the mean square of one over whole runs:
    where it does not, something else is missing, which windows hide.
    """
    left, whole = (float(np.sum(left_over(t.fit) ** 2)) for t in (short, trial))
    return left <= (1.0 - MOST) * whole


def in_windows_of(task: Task, trial: Trial) -> Task:
    """The task with training and validation runs cut into windows where the model of a trial
    multiplies an error of the start tenfold (see `window_length`, which asks the same of the
    declared model): a machine that cogs, or leans, runs on from the edge of a valley into one or
    the other, and its fit has an end for each of them.
    """
    p = task.model.parameter_vector(trial.values)

    def windows_of(run: Run, z: FloatArray) -> tuple[Run, ...]:
        multiplies = multiplies_errors(task.model, run, p, z)
        return split_run(task.model, run, SHORT) if multiplies else (run,)

    return _in_parts(task, trial, windows_of, CUT)


def _in_parts(
    task: Task,
    trial: Trial,
    parts_of: Callable[[Run, FloatArray], tuple[Run, ...]],
    said: str,
) -> Task:
    """The task with the parts of every run, by the run and its start; as it is where all training
    runs stay whole, else that is `said`.
    """
    every = list(task.executor.map(parts_of, task.every_sample, trial.fit.z))
    if all(len(parts) == 1 for parts in every):
        return task
    task.progress(said)
    fewer = [
        (run,) if len(parts) == 1 else parts for run, parts in zip(task.train, every, strict=True)
    ]
    starts = [run.guess for run in task.validate]
    validate = task.executor.map(parts_of, task.validate, starts)
    train = tuple(part for parts in fewer for part in parts)
    return replace(
        task,
        every_sample=tuple(part for parts in every for part in parts),
        train=train,
        few=task.few if task.windows else spread_over(train, SHORT),
        validate=tuple(part for parts in validate for part in parts),
    )
