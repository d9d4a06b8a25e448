"""The samples that a search needs: simulations end a step at each, which is most of their cost.

A search compares sets over runs with fewer samples, as long as the simulated signals at these stay
the same within the noise; what was found is fitted to every sample at last.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from ptp_symbolic.numeric.diagnose.trial import (
    SHARP,
    Task,
    Trial,
    continued,
    fitted,
    simulated,
    tolerance_for,
)
from ptp_symbolic.numeric.identify.constants import LITTLE, ROUGH, SEARCH_PERIOD, STEP
from ptp_symbolic.numeric.identify.evaluate import Evaluation, evaluate, simulated_signals
from ptp_symbolic.numeric.identify.fit import Fit
from ptp_symbolic.numeric.identify.run import Run
from ptp_symbolic.numeric.identify.sample_averages import samples_within, thinned
from ptp_symbolic.numeric.identify.simulations import POLISH


def with_fewer_samples(task: Task, values: Mapping[str, float]) -> Task:
    """The task with training runs of fewer samples, as far as these change none of their signals by
    more than LITTLE of the squared noise, as the model simulates them with `values` of all
    parameters. Inputs between two samples count by their average: a current that follows them at
    once shows the difference, and keeps its samples.
    """
    p, tolerance = task.model.parameter_vector(dict(values)), tolerance_for(task, ROUGH)
    none = np.zeros(0, dtype=np.int64)

    def of(run: Run) -> Evaluation:
        return evaluate(task.model, run, p, run.guess, none, False, tolerance)

    def fewer(run: Run) -> Run:
        every = samples_within(run, SEARCH_PERIOD)
        if every == 1 or (whole := of(run)).failed:
            return run
        while every > 1:
            part = thinned(run, every)
            e = of(part)
            change = simulated_signals(part, e) - simulated_signals(run, whole)[::every]
            if not e.failed and np.all(np.mean((change * run.weight) ** 2, axis=0) <= LITTLE):
                return part
            every //= 2
        return run

    return replace(task, train=tuple(task.executor.map(fewer, task.every_sample)))


def is_thinned(task: Task, fit: Fit) -> bool:
    """Whether `fit` is of training runs with fewer samples than they have."""
    return fit.runs == task.train and task.train != task.every_sample


def with_every_residual(task: Task, fit: Fit) -> Fit:
    """`fit` with the residuals of every sample of the training runs, without Jacobians."""
    if not is_thinned(task, fit):
        return fit
    whole = replace(fit, runs=task.every_sample)
    return replace(whole, evaluations=tuple(simulated(task, whole, {}, task.executor)))


def fitted_to_every_sample(task: Task, trials: Sequence[Trial]) -> list[Trial]:
    """Trials of the search fitted on to every sample of the training runs, sharply at last; all of
    them as they are where no run has fewer samples, or where one trial cannot be simulated.
    """
    whole, run = replace(task, train=task.every_sample), task.executor
    begun = [
        fitted(whole, t.candidates, t.values, t.fit.z, executor=run)
        for t in trials
        if is_thinned(task, t.fit)
    ]
    if len(begun) < len(trials) or any(t.fit.failed for t in begun):
        return list(trials)
    rough = [continued(whole, t, POLISH, executor=run) for t in begun]
    return [continued(whole, t, POLISH, SHARP, STEP, run) for t in rough]
