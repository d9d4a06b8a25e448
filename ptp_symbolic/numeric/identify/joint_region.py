"""The joint confidence region of the values of a fit, and the values in it that suit other runs."""

import numpy as np
from numpy.typing import NDArray
from scipy import optimize, stats

from ptp_symbolic.numeric.identify.constants import TEST_ALARM
from ptp_symbolic.numeric.identify.fit import Fit
from ptp_symbolic.numeric.identify.intervals import covariance_of

FloatArray = NDArray[np.float64]


def joint_region(fit: Fit) -> FloatArray:
    """The ellipsoid [nf, nf] that holds the true search coordinates of a finished fit with a chance
    of 99 %: the fitted ones plus this matrix times any vector of length one at most (Scheffe,
    1953). It is wider by Student's t where few blocks tell of a coordinate. Coordinates that the
    data do not see stay as they are.
    """
    covariance, degrees, _ = covariance_of(fit)
    wider = stats.t.ppf(0.975, degrees) / stats.norm.ppf(0.975)
    variances, directions = np.linalg.eigh(covariance * np.outer(wider, wider))
    radius = np.sqrt(stats.chi2.ppf(1.0 - TEST_ALARM, len(fit.free)))
    return np.asarray(radius * directions * np.sqrt(np.maximum(variances, 0.0)))


def closest_in_ball(matrix: FloatArray, target: FloatArray) -> FloatArray:
    """The vector [n] of length one at most whose image by `matrix` [k, n] is closest to `target`
    [k]: least squares with a quadratic constraint (Golub and Van Loan, 2013, 6.2.1).
    """
    left, sizes, right = np.linalg.svd(matrix, full_matrices=False)
    seen = sizes > 1e-14 * max(sizes.max(initial=0.0), 1e-300)
    sizes, along, right = sizes[seen], (left.T @ target)[seen], right[seen]

    def solution(multiplier: float) -> FloatArray:
        return sizes * along / (sizes**2 + multiplier)

    def excess(multiplier: float) -> float:
        return float(np.linalg.norm(solution(multiplier))) - 1.0

    multiplier = 0.0
    if seen.any() and excess(0.0) > 0.0:
        enough = float(np.linalg.norm(sizes * along))  # the length is below one from here on
        multiplier = float(optimize.brentq(excess, 0.0, enough, rtol=1e-12))
    return np.asarray(right.T @ solution(multiplier))
