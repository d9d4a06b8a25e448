"""The validation runs: held to their own noise, and whether they bear out what was named."""

from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from ptp_symbolic.numeric.diagnose.floor import Floor
from ptp_symbolic.numeric.diagnose.gain import Gain, compared
from ptp_symbolic.numeric.diagnose.trial import (
    Task,
    Trial,
    huber_loss,
    mean_squares,
    tolerance_for,
)
from ptp_symbolic.numeric.identify.constants import (
    ABOVE_NOISE,
    BIGGEST,
    GAIN,
    MANY_RUNS,
    MOST,
    POLISH,
    ROUGH,
    SHARP,
    TEST_ALARM,
    TUNING,
    UNALIKE,
)
from ptp_symbolic.numeric.identify.finite_differences import with_finite_differences
from ptp_symbolic.numeric.identify.fit import Fit, fit_parameters
from ptp_symbolic.numeric.identify.intervals import covariance_of, project_out, reaches
from ptp_symbolic.numeric.identify.robust_loss import weighted_median
from ptp_symbolic.numeric.identify.run import Run
from ptp_symbolic.numeric.identify.run_groups import sizes
from ptp_symbolic.numeric.identify.simulations import Effort

FloatArray = NDArray[np.float64]


def is_taken_back(held_out: Gain, quiet: bool, material: float) -> bool:
    """Whether the validation runs do not bear out what the training runs named. Where they show
    more than noise (not `quiet`), a wrong effect may imitate what is missing, so that it has to
    take away more than it leaves, as on training runs; else a `material` share.
    """
    return held_out.share < (material if quiet else MOST)


def left_by_values(after: Fit, estimated: Fit, executor: Executor | None = None) -> FloatArray:
    """The most [runs, ny] at 99 % that errors of the `estimated` values leave in validation runs
    `after`, as a mean square in units of the noise: their covariance carried there by the
    derivatives of the runs, a sum of squares of few normal numbers (its first two moments:
    Satterthwaite, 1946).
    """
    signals = after.runs[0].measured.shape[1]
    if not estimated.free or after.failed:
        return np.zeros((len(after.runs), signals))
    covariance, degrees, _ = covariance_of(estimated)
    wider = stats.t.ppf(0.975, degrees) / stats.norm.ppf(0.975)
    covariance = covariance * np.outer(wider, wider)
    moved = replace(after, free=estimated.free)
    moved = with_finite_differences(moved, executor, reaches(estimated))
    found = np.zeros((len(after.runs), signals))
    for number, (run, e) in enumerate(moved.pairs()):
        columns = project_out(e.by_parameter, e.by_start)
        for signal in range(signals):
            own = columns[signal::signals]
            carried = own.T @ own @ covariance / len(run.time)
            mean, square = np.trace(carried), np.trace(carried @ carried)
            if mean > 0.0:
                freedom = mean**2 / square
                most = stats.chi2.ppf(1.0 - TEST_ALARM, freedom) / freedom
                found[number, signal] = mean * most
    return found


def is_quiet(after: Fit, floor: Floor, by_values: FloatArray, trained: Fit) -> bool:
    """Whether validation runs show no more than noise, and what errors of the values leave
    (`by_values` [runs, ny], see `left_by_values`). The median of the samples counts, for a run that
    sticks at another sample than it did is off by counts. Of many windows it sees half: beside it
    they may not leave more than the windows of the training runs (Mann and Whitney, 1947).
    """
    squares = mean_squares(after.evaluations, after.runs)
    size = sizes(after.runs)
    allowed = (ABOVE_NOISE * floor.most) ** 2 + by_values
    if not np.all(weighted_median(squares / allowed, size) <= 1.0):
        return False
    own = mean_squares(trained.evaluations, trained.runs)
    if min(len(squares), len(own)) < MANY_RUNS:
        return True
    return bool(np.all(stats.mannwhitneyu(squares, own, alternative="greater").pvalue > UNALIKE))


def held_out_fit(task: Task, trial: Trial) -> Fit:
    """The validation runs by the model of a trial, nothing but their start unknowns fitted."""
    return simulated_freely(task, task.validate, trial.values)


def simulated_freely(task: Task, runs: Sequence[Run], values: Mapping[str, float]) -> Fit:
    """Runs simulated with `values` of all parameters, nothing but their start unknowns fitted."""
    effort = Effort(POLISH, GAIN * ROUGH, tolerance_for(task, SHARP))
    return fit_parameters(task.model, runs, (), dict(values), None, effort, task.executor)


def held_out_gain(after: Fit, before: Fit) -> Gain:
    """The share of the mean square error of validation runs or windows that is taken away (Huber's
    loss: those far worse than usual count linearly).
    """
    size = sizes(after.runs)
    squares = [mean_squares(fit.evaluations, fit.runs) for fit in (after, before)]
    usual = np.min([weighted_median(s, size) for s in squares], axis=0)
    tuning = TUNING**2 * np.maximum(usual, 1.0)
    losses = [size * huber_loss(np.minimum(s, BIGGEST), tuning).sum(axis=1) for s in squares]
    return compared(losses[0], losses[1])
