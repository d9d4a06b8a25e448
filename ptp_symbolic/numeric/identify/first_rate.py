"""The rate of a joint at the first sample of a run or window, from the angles around it."""

import itertools
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.identify.constants import (
    DEVIATIONS,
    LEAST_START,
    ROUNDING,
    START_SPAN,
)

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Around:
    """The whole log of a window: time [n] in s and measured [n, ny], and its `first` sample; of a
    run the log is the run itself.
    """

    time: FloatArray
    measured: FloatArray
    first: int


def first_rate(around: Around, column: int, sigma: float, count: float) -> tuple[float, float]:
    """Rate at the first sample and its standard deviation (rad/s or m/s), from an angle whose noise
    is `sigma`, rounding of a `count` (nan: none) included.

    A local parabola gives it, over the longest span up to a tenth of a second that agrees with all
    shorter ones: where friction lets go, a longer one bends the wrong way (intersection of
    confidence intervals: Goldenshluger and Nemirovski, 1997). Its error is that of the noise, and
    what a cubic tells otherwise.
    """
    time = around.time - around.time[around.first]
    low, high, found = -np.inf, np.inf, (0.0, np.inf)
    for part in _spans(time, around.first):
        values = around.measured[part, column]
        rate, noise = _rate_over(time[part], values, 2, sigma, count)
        other, _ = _rate_over(time[part], values, 3, sigma, count)
        error = float(np.hypot(noise, other - rate))
        low = max(low, rate - DEVIATIONS * error)
        high = min(high, rate + DEVIATIONS * error)
        if low > high:
            break
        found = rate, error
    return found


def _spans(time: FloatArray, first: int) -> list[slice]:
    """Samples around the first one, or after it where nothing comes before; each span is twice as
    long as the one before it, the last one START_SPAN.
    """
    ahead = int(np.searchsorted(time, START_SPAN if first == 0 else 0.5 * START_SPAN)) - first
    least = LEAST_START if first == 0 else LEAST_START // 2
    doubled = itertools.takewhile(lambda n: n < ahead, (least * 2**k for k in itertools.count()))
    lengths = [*doubled, max(least, ahead)]
    if first == 0:
        return [slice(0, n) for n in lengths]
    return [slice(max(0, first - n), first + n + 1) for n in lengths]


def _rate_over(
    time: FloatArray, values: FloatArray, degree: int, sigma: float, count: float
) -> tuple[float, float]:
    """Rate at time zero by a polynomial, and its standard deviation: noise as if white, rounding as
    if it were the same in half of the samples.
    """
    longest = float(np.max(np.abs(time)))
    columns = np.vander(time / longest, degree + 1, increasing=True)
    inverse = np.linalg.pinv(columns)
    rate = float(inverse[1] @ values) / longest
    rounding = float(np.nan_to_num(count)) * ROUNDING
    white = np.sqrt(max(sigma**2 - rounding**2, 0.0)) * float(np.linalg.norm(inverse[1]))
    return rate, float(np.hypot(white, 2.0 * rounding)) / longest
