"""Errors of a fit under noise that has the same colour everywhere.

What few samples tell, as those about one breakaway, no block of time can be left out to judge. The
covariance of the residual over all samples says how far such a sum scatters.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy import signal

from ptp_symbolic.numeric.identify.blocks import autocovariance

FloatArray = NDArray[np.float64]


def coloured_variances(
    residuals: Sequence[FloatArray], influences: Sequence[FloatArray]
) -> FloatArray:
    """Variances [nf] of sums of the samples of `residuals` [n, ny], by log, each sample times its
    `influences` [n * ny, nf], where every signal is stationary: w' R w, summed over logs and
    signals, with w a column of influences and R the matrix of `autocovariance` by distance in time.
    """
    ny = residuals[0].shape[1]
    total = np.zeros(influences[0].shape[1])
    for column in range(ny):
        half = autocovariance([log[:, column] for log in residuals])
        kernel = np.concatenate([half[:0:-1], half])[:, None]
        for influence in influences:
            own = influence[column::ny]
            total += np.sum(own * signal.oaconvolve(own, kernel, "same", axes=0), axis=0)
    return total
