"""Inputs that seem to act the other way round: a motor, or a sensor, wired with its sign turned."""

from dataclasses import replace

import numpy as np

from ptp_symbolic.numeric.diagnose.cut_runs import takes_away_most
from ptp_symbolic.numeric.diagnose.declared_rows import declared_start, equation_space, first_fit
from ptp_symbolic.numeric.diagnose.refits import is_near_floor
from ptp_symbolic.numeric.diagnose.trial import Task, Trial, fitted
from ptp_symbolic.numeric.identify.run import Run
from ptp_symbolic.numeric.identify.run_inputs import with_inputs
from ptp_symbolic.numeric.identify.simulations import POLISH

DRIVING = ("V", "N m", "N", "A")  # units of inputs that drive an axis


def turned_inputs(task: Task, declared: Trial) -> tuple[str, ...]:
    """A sentence for every driving input with which, its sign turned, the declared model fits the
    training runs so much better that most of what the fit `declared` leaves is gone.
    """
    if is_near_floor(declared):
        return ()
    found = []
    for k, name in enumerate(task.model.input_names):
        if task.model.units[name] in DRIVING and takes_away_most(_turned(task, k), declared):
            found.append(
                f"The declared model fits far better with the sign of '{name}' inverted: one of"
                " motor and sensor is wired the other way round; give one of their signals a"
                " negative scale."
            )
    return tuple(found)


def _turned(task: Task, number: int) -> Trial:
    """The declared model fitted to the training runs with an input turned, begun at its rows."""

    def turned(run: Run) -> Run:
        sign = np.ones(run.held_inputs.shape[1])
        sign[number] = -1.0
        return with_inputs(run, sign * run.held_inputs)

    train, whole = tuple(map(turned, task.train)), tuple(map(turned, task.whole))
    part = replace(task, train=train, every_sample=train, whole=whole)
    start = declared_start(part)
    space = equation_space(part, start)
    values = start if space is None else first_fit(part, space, start)
    return fitted(part, (), values, None, POLISH, executor=part.executor)
