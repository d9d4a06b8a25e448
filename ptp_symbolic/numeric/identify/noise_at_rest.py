"""Whether slow noise of a signal is there where the machine rests.

Noise of a sensor does not know what the machine does: where the model rests, the signal shows it
alone. What a model lacks is slow, too, but stands still there.
"""

from collections.abc import Sequence
from math import comb

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from ptp_symbolic.numeric.identify.constants import ORDER, SAME, SEGMENT, TEST_ALARM
from ptp_symbolic.numeric.identify.noise import POLES, differences, hidden_from_differences

FloatArray = NDArray[np.float64]


def is_missed_at_rest(
    series: Sequence[FloatArray], simulated: Sequence[FloatArray], slow: float, pole: float
) -> bool:
    """Whether residual `series` [n] hold less slow noise where the `simulated` signals [n], in the
    same unit, stand still than they would if noise of the standard deviation `slow`, as an
    autoregression with `pole` has it, went on there; False where they hardly stand still.

    Their squares about the mean of each stretch, less those of white noise by its differences (in
    which a part of the slow noise is), are compared with what would go on at the largest pole that
    is tried. That varies as n (1 - a^2) / (1 + a^2) - 1 independent normal numbers (Bartlett,
    1946), and the squares of white noise miss those of its differences by what `_spread` says: both
    are allowed for at 99 %.
    """
    seen = (slow / hidden_from_differences(pole)) ** 2
    slowest, found, expected, degrees, variance = POLES[-1], 0.0, 0.0, 0.0, 0.0
    for residual, signal in zip(series, simulated, strict=True):
        for first, last in stretches_at_rest(signal):
            rest = residual[first:last]
            n, white = len(rest), max(float(np.mean(differences(rest) ** 2)) - seen, 0.0)
            found += float(np.sum((rest - rest.mean()) ** 2)) - (n - 1) * white
            variance += n * max(white, float(np.var(rest))) ** 2
            expected += slow**2 * n * (1.0 - _kept_in_mean(slowest, n))
            degrees += max(n * (1.0 - slowest**2) / (1.0 + slowest**2) - 1.0, 0.0)
    if degrees == 0.0:
        return False
    least = expected * float(stats.chi2.ppf(TEST_ALARM, degrees)) / degrees
    least -= float(stats.norm.isf(TEST_ALARM)) * np.sqrt(_spread() * variance)
    return least > 0.0 and found < least


def _spread() -> float:
    """Variance, per sample, of the sum of squares of white noise of 1 less that of its differences:
    twice the sum of squares of the autocorrelation of these, less 2.
    """
    lag = [comb(2 * ORDER, ORDER - k) / comb(2 * ORDER, ORDER) for k in range(1, ORDER + 1)]
    return 4.0 * float(np.sum(np.square(lag)))


def stretches_at_rest(signal: FloatArray) -> list[tuple[int, int]]:
    """First sample, and the one after the last, of all stretches of at least SEGMENT in which a
    simulated `signal` [n], in units of its noise, does not move.
    """
    still = np.concatenate([[False], np.abs(np.diff(signal)) <= SAME / SEGMENT, [False]])
    edges = np.flatnonzero(np.diff(still.astype(np.int8)))
    return [
        (int(first), int(last) + 1)
        for first, last in edges.reshape(-1, 2)
        if last + 1 - first >= SEGMENT
    ]


def _kept_in_mean(pole: float, length: int) -> float:
    """Variance of the mean of an autoregression of variance 1 over a stretch."""
    lag = np.arange(1, length)
    return float((1.0 + 2.0 * np.sum((1.0 - lag / length) * pole**lag)) / length)
