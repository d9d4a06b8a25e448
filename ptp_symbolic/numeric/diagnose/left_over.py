"""What a fit leaves of its runs, in one number per signal, and what noise of the inputs leaves."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy import special, stats
from scipy.optimize import brentq

from ptp_symbolic.numeric.diagnose.trial import (
    SHARP,
    Task,
    Trial,
    continued,
    fitted,
    simulated,
    tolerance_for,
)
from ptp_symbolic.numeric.identify.constants import (
    FALSE_ALARM,
    LITTLE,
    MATERIAL,
    NOTHING,
    ROUGH,
    SEARCH_PERIOD,
    STEP,
    TEST_ALARM,
    TUNING,
)
from ptp_symbolic.numeric.identify.evaluate import (
    Evaluation,
    Tolerance,
    evaluate,
    mean_squares,
    simulated_signals,
)
from ptp_symbolic.numeric.identify.evidence import recorded
from ptp_symbolic.numeric.identify.fit import Fit
from ptp_symbolic.numeric.identify.replays import replayed_squares
from ptp_symbolic.numeric.identify.robust_loss import (
    MANY_RUNS,
    huber_loss,
    trimmed_mean,
    weighted_median,
)
from ptp_symbolic.numeric.identify.run import Run, sizes
from ptp_symbolic.numeric.identify.sample_averages import samples_within, thinned
from ptp_symbolic.numeric.identify.simulations import POLISH
from ptp_symbolic.numeric.runtime.model import Model

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Carried:
    """What the noise of the inputs leaves in every signal [ny], over its noise: as a root mean
    square that is `usual`, one that is exceeded at FALSE_ALARM (`seldom`), and the `most` of it, at
    TEST_ALARM (see `bound_of`).
    """

    usual: FloatArray
    seldom: FloatArray
    most: FloatArray


def left_over(fit: Fit) -> FloatArray:
    """Robust root mean square [ny] of the residual of a fit in every signal, over its noise."""
    return np.sqrt(_robust_mean(mean_squares(fit.evaluations, fit.runs), sizes(fit.runs)))


def _robust_mean(squares: FloatArray, size: FloatArray) -> FloatArray:
    """One mean square per signal [ny] of those of all runs [runs, ny], with so many samples [runs].

    Of many windows the worst are left out, a MATERIAL share of the samples, for one in twenty
    begins on the wrong side of a rest; of few runs, those far worse than usual count linearly.
    """
    if not np.all(np.isfinite(squares)):
        return np.full(squares.shape[1], np.inf)
    if len(squares) >= MANY_RUNS:
        return trimmed_mean(squares, size, MATERIAL)
    usual = weighted_median(squares, size)
    bounded = huber_loss(squares, TUNING**2 * np.maximum(usual, 1.0))
    return np.asarray(size @ bounded / size.sum())


@recorded(Carried)
def carried_noise(task: Task, fit: Fit) -> Carried:
    """What the noise of the inputs leaves, by the model of `fit`.

    All runs are replayed some times, and what is left of them beyond noise of their signals is
    summed up as a fit is; the median counts as usual. A replay that cannot be simulated leaves what
    the others of its run leave, and a run without any tells nothing.
    """
    p = task.model.parameter_vector(dict(fit.values))
    runs = task.every_sample if is_thinned(task, fit) else fit.runs
    every = replayed_squares(task.model, runs, fit.z, p, task.input_noise, task.executor)
    simulated, size = _simulated(every, sizes(runs))
    left = np.array([_robust_mean(1.0 + squares, size) - 1.0 for squares in simulated])
    left = np.maximum(left, NOTHING)
    bounds = [[bound_of(c, chance) for c in left.T] for chance in (FALSE_ALARM, TEST_ALARM)]
    return Carried(np.sqrt(np.median(left, axis=0)), *np.sqrt(bounds))


def _simulated(squares: FloatArray, size: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Mean squares [replays, told, ny] of the runs of which any replay was simulated, from those of
    all runs [replays, runs, ny], nan where one was not; and their `size` [told].
    """
    known = np.ma.masked_invalid(squares)
    medians = np.ma.median(known, axis=0)
    told = ~np.any(np.ma.getmaskarray(medians), axis=1)
    if not told.any():
        return np.zeros_like(squares), size
    filled = np.where(np.ma.getmaskarray(known), np.ma.getdata(medians), squares)
    return filled[:, told], size[told]


def bound_of(squares: FloatArray, chance: float) -> float:
    """The bound that a mean square exceeds with a `chance`, from some [n] that are like it; 99 %
    bounds from eight, which tell the scale only roughly, were exceeded by 2 to 3 %.

    It is a sum of squares of one normal number or more: the variance of its logarithm tells how
    many, the mean of that its scale (Bartlett and Kendall, 1946), and both are known from n alone.
    A replay that sticks elsewhere counts little in a logarithm.
    """

    def spread(log_freedom: float) -> float:
        return float(special.polygamma(1, 0.5 * np.exp(log_freedom)))

    logarithms, many = np.log(squares), np.log(1.0 / NOTHING)
    variance = float(np.clip(np.var(logarithms, ddof=1), spread(many), spread(0.0)))
    freedom = np.exp(brentq(lambda log: spread(log) - variance, 0.0, many))
    scale = np.exp(np.mean(logarithms) - special.digamma(0.5 * freedom)) * 0.5 * freedom
    return float(scale * stats.f.isf(chance, freedom, len(squares) * freedom))


def with_fewer_samples(task: Task, values: Mapping[str, float]) -> Task:
    """The task with training runs of fewer samples, as far as these change none of their signals by
    more than LITTLE of the squared noise, as the model simulates them with `values` of all
    parameters. Inputs between two samples count by their average: a current that follows them at
    once shows the difference, and keeps its samples.
    """
    p, tolerance = task.model.parameter_vector(dict(values)), tolerance_for(task, ROUGH)

    def fewer(run: Run) -> Run:
        every = _samples_apart(task.model, run, p, tolerance)
        return run if every == 1 else thinned(run, every)

    return replace(task, train=tuple(task.executor.map(fewer, task.every_sample)))


@recorded()
def _samples_apart(model: Model, run: Run, p: FloatArray, tolerance: Tolerance) -> int:
    """Every which sample of a run is enough for `with_fewer_samples`, at p [np]."""
    none = np.zeros(0, dtype=np.int64)

    def of(run: Run) -> Evaluation:
        return evaluate(model, run, p, run.guess, none, False, tolerance)

    every = samples_within(run, SEARCH_PERIOD)
    if every == 1 or (whole := of(run)).failed:
        return 1
    while every > 1:
        part = thinned(run, every)
        e = of(part)
        change = simulated_signals(part, e) - simulated_signals(run, whole)[::every]
        if not e.failed and np.all(np.mean((change * run.weight) ** 2, axis=0) <= LITTLE):
            return every
        every //= 2
    return 1


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
