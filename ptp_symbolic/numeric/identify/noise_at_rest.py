"""Whether slow noise of a signal is there where the machine rests.

Noise of a sensor does not know what the machine does: where the model rests, the signal shows it
alone. What a model lacks is slow, too, but stands still there.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from ptp_symbolic.numeric.identify.constants import ORDER, POLES, SAME, SEGMENT, TEST_ALARM
from ptp_symbolic.numeric.identify.noise import differences, hidden_from_differences

FloatArray = NDArray[np.float64]


def is_missed_at_rest(
    series: Sequence[FloatArray], simulated: Sequence[FloatArray], slow: float, pole: float
) -> bool:
    """Whether, at 99 %, residual `series` [n] hold less slow noise where the `simulated` signals
    [n], in the same unit, stand still than an autoregression with `pole` and the standard deviation
    `slow` would leave there; False where they hardly stand still.

    The squares about the mean of each stretch, less those of its white noise by its differences, in
    which a part of the slow one is; beside those of an autoregression with the largest pole that is
    tried. They vary as those of n (1 - a^2) / (1 + a^2) - 1 normal numbers that are independent
    (Bartlett, 1946).
    """
    seen = (slow / hidden_from_differences(pole)) ** 2
    pole, found, expected, degrees = float(max(POLES)), 0.0, 0.0, 0.0
    for residual, signal in zip(series, simulated, strict=True):
        for first, last in stretches_at_rest(signal):
            rest = residual[first:last]
            white = max(float(np.mean(differences(rest) ** 2)) - seen, 0.0)
            found += float(np.sum((rest - rest.mean()) ** 2)) - (len(rest) - 1) * white
            expected += slow**2 * len(rest) * (1.0 - _kept_in_mean(pole, len(rest)))
            degrees += max(len(rest) * (1.0 - pole**2) / (1.0 + pole**2) - 1.0, 0.0)
    if degrees == 0.0:
        return False
    return found < expected * float(stats.chi2.ppf(TEST_ALARM, degrees)) / degrees


def stretches_at_rest(signal: FloatArray) -> list[tuple[int, int]]:
    """First sample, and the one after the last, of all stretches of at least SEGMENT in which a
    simulated `signal` [n], in units of its noise, does not move.
    """
    still = np.concatenate([[False], np.abs(np.diff(signal)) <= SAME / SEGMENT, [False]])
    edges = np.flatnonzero(np.diff(still.astype(np.int8)))
    return [
        (int(first), int(last) + 1)
        for first, last in edges.reshape(-1, 2)
        if last + 1 - first >= max(SEGMENT, 2 * ORDER)
    ]


def _kept_in_mean(pole: float, length: int) -> float:
    """Variance of the mean of an autoregression of variance 1 over a stretch."""
    lag = np.arange(1, length)
    return float((1.0 + 2.0 * np.sum((1.0 - lag / length) * pole**lag)) / length)
