"""Innovations: what is left of residuals that are correlated in time once each is predicted from
those before it.

Where a model leaves more than noise, its residuals are coloured, and least squares credits an
effect with whatever slow drift it can follow. In the innovations of what is left every frequency
counts by how well it is known: generalized least squares (Aitken, 1935), with the colour of an
autoregression (Yule, 1927; Walker, 1931), its order by Akaike's criterion (1974).
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy import linalg, signal

from ptp_symbolic.numeric.identify.constants import FEWEST_BLOCKS, LAGS, NOTHING

FloatArray = NDArray[np.float64]


def prediction_error_filter(series: Sequence[FloatArray]) -> FloatArray:
    """Coefficients [order + 1], the first 1, whose product with a sample and those before it leaves
    its innovation, for stationary `series` [n] of one kind and of mean zero; those too short for
    the longest filter tell nothing.
    """
    most = min(LAGS, max(len(s) for s in series) // FEWEST_BLOCKS)
    series = [s for s in series if len(s) > most]
    n = sum(len(s) for s in series)
    covariance = np.array(
        [sum(float(s[k:] @ s[: len(s) - k]) for s in series) / n for k in range(most + 1)]
    )
    covariance[0] *= 1.0 + NOTHING
    best, found = np.inf, np.ones(1)
    for order in range(most + 1 if covariance[0] > 0.0 else 0):
        before = covariance[1 : order + 1]
        weights = linalg.solve_toeplitz(covariance[:order], before) if order else np.zeros(0)
        left = float(covariance[0] - weights @ before)
        criterion = n * np.log(max(left, NOTHING * covariance[0])) + 2.0 * order
        if criterion < best:
            best, found = criterion, np.concatenate([[1.0], -weights])
    return found


def innovations(columns: FloatArray, filters: Sequence[FloatArray]) -> FloatArray:
    """Residuals or derivatives `columns` [k * ny, c] of a run, those of each signal through its
    filter of `filters`; zero in the first samples, which the longest of them needs.
    """
    table = columns.reshape(-1, len(filters), columns.shape[1])
    found = np.zeros_like(table)
    first = max(len(f) for f in filters) - 1
    for k, coefficients in enumerate(filters):
        found[first:, k] = signal.lfilter(coefficients, [1.0], table[:, k], axis=0)[first:]
    return found.reshape(columns.shape)
