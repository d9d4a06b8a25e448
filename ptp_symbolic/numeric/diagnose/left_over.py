"""What a fit leaves of its runs, in one number per signal, and what noise of the inputs leaves."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import special, stats
from scipy.optimize import brentq

from ptp_symbolic.numeric.diagnose.fewer_samples import is_thinned
from ptp_symbolic.numeric.diagnose.trial import Task, mean_squares
from ptp_symbolic.numeric.identify.constants import (
    FALSE_ALARM,
    MATERIAL,
    NOTHING,
    TEST_ALARM,
    TUNING,
)
from ptp_symbolic.numeric.identify.fit import Fit
from ptp_symbolic.numeric.identify.replays import replayed_squares
from ptp_symbolic.numeric.identify.robust_loss import (
    MANY_RUNS,
    huber_loss,
    trimmed_mean,
    weighted_median,
)
from ptp_symbolic.numeric.identify.run_groups import sizes

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
