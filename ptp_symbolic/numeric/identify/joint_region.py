"""The joint confidence region of the values of a fit, and the values in it that suit other runs."""

import numpy as np
from numpy.typing import NDArray
from scipy import optimize, stats

from ptp_symbolic.numeric.identify.constants import TEST_ALARM
from ptp_symbolic.numeric.identify.fit import Fit
from ptp_symbolic.numeric.identify.intervals import axes_of

FloatArray = NDArray[np.float64]


def joint_region(fit: Fit) -> FloatArray:
    """The ellipsoid [nf, seen] that holds the true search coordinates of a finished fit with a
    chance of 99 %: the fitted ones plus this matrix times any vector of length one at most
    (Scheffe, 1953). An axis of which few blocks tell is widened as Student's t is at 99 %.
    Directions that the data do not see are left out.

    Axes count as uncorrelated, as they are beside white noise. Were all k of them the same normal
    number z, as where one slow mode is left that all follow, the truth would be held where k z^2
    is below the 99 % quantile of chi squared with k degrees: in 97 % for two, in 87 % for ten.
    """
    axes, variances, degrees = axes_of(fit)
    tail = 0.5 * TEST_ALARM
    wider = stats.t.isf(tail, degrees) / stats.norm.isf(tail)
    radius = np.sqrt(stats.chi2.isf(TEST_ALARM, max(axes.shape[1], 1)))
    return np.asarray(radius * axes * wider * np.sqrt(variances))


def closest_in_ball(matrix: FloatArray, target: FloatArray) -> FloatArray:
    """The vector [n] of length one at most whose image by `matrix` [k, n] is closest to `target`
    [k]: least squares with a quadratic constraint (Golub and Van Loan, 2013, 6.2.1).
    """
    left, sizes, right = np.linalg.svd(matrix, full_matrices=False)
    largest = max(sizes.max(initial=0.0), 1e-300)
    seen = sizes > 1e-14 * largest  # below is the rounding of equal columns
    along, right = (left.T @ target)[seen] / largest, right[seen]
    sizes = sizes[seen] / largest

    def solution(multiplier: float) -> FloatArray:
        return sizes * along / (sizes**2 + multiplier)

    def excess(multiplier: float) -> float:
        return float(np.linalg.norm(solution(multiplier))) - 1.0

    multiplier = 0.0
    if seen.any() and excess(0.0) > 0.0:
        enough = 2.0 * float(np.linalg.norm(sizes * along))  # the length is below one half there
        multiplier = float(optimize.brentq(excess, 0.0, enough, xtol=1e-300, rtol=1e-12))
    return np.asarray(right.T @ solution(multiplier))
