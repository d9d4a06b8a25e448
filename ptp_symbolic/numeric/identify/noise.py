"""The noise of a measured signal: how large, and how it is coloured.

Differences of high order of a signal remove its smooth motion and keep its white noise, which gives
a first size. What a model leaves shows the colour: its spectrum above the frequencies of the motion
is that of a first-order autoregression plus white noise, whose likelihood (Whittle, 1953) gives the
whole variance, also below.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from math import comb

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from ptp_symbolic.numeric.identify.constants import (
    FAR,
    LOWEST,
    ORDER,
    OVERLAP_CORRELATION,
    PIECE,
    POLES,
    SCORINGS,
    SEGMENT,
)

FloatArray = NDArray[np.float64]


def white_noise(signal: FloatArray) -> float:
    """Standard deviation of the white noise of a smooth `signal` [n], also of its rounding, in its
    unit.

    Squared differences of order 5, without those that are clipped; zero where the signal is too
    short.
    """
    if len(signal) < 4 * ORDER:
        return 0.0
    square = np.diff(signal, ORDER) ** 2 / float(comb(2 * ORDER, ORDER))
    pieces = np.array_split(square, max(1, len(square) // PIECE))
    return float(np.sqrt(np.median([_clipped_mean(piece) for piece in pieces])))


def _clipped_mean(square: FloatArray) -> float:
    """Mean of the squares of normal numbers, begun at their median, until no more are clipped."""
    mean = float(np.median(square)) / float(stats.chi2.median(1))
    for _ in range(len(square)):
        kept = square[square <= FAR**2 * mean]
        if not kept.size or float(kept.mean()) == mean:
            break
        mean = float(kept.mean())
    return mean


@dataclass(frozen=True)
class Noise:
    """Noise with the standard deviation `rms` of which a part is an autoregression with `pole` at
    one sample; `most` is the largest standard deviation that the spectrum allows at 95 %.
    """

    rms: float
    pole: float
    most: float


def coloured_noise(series: Sequence[FloatArray], least: float) -> Noise:
    """The noise in residual `series` [n] (evenly sampled, any lengths), at least `least` of it
    white.

    Whittle's likelihood over the bins that lie above the motion, profiled over the pole.
    """
    power, count = _spectrum(series)
    if count == 0:
        return Noise(least, 0.0, least)
    power = power[LOWEST:]
    degrees = 2.0 * count / OVERLAP_CORRELATION
    fits = [_profiled(power, pole, least**2, degrees) for pole in POLES]
    likelihood = np.array([f[0] for f in fits])
    best = int(np.argmax(likelihood))
    allowed = likelihood >= likelihood[best] - 0.5 * float(stats.chi2.ppf(0.95, 1))
    most = max(f[1] for f, ok in zip(fits, allowed, strict=True) if ok)
    return Noise(float(np.sqrt(fits[best][1])), float(POLES[best]), float(np.sqrt(most)))


def hidden_from_differences(pole: float) -> float:
    """Standard deviation of an autoregression with `pole` that adds as much to the differences of
    order ORDER as white noise of standard deviation 1 does: `white_noise` sees no more of it.
    """
    weights = np.array([(-1.0) ** k * comb(ORDER, k) for k in range(ORDER + 1)])
    lags = np.abs(np.subtract.outer(np.arange(ORDER + 1), np.arange(ORDER + 1)))
    return float(np.sqrt(comb(2 * ORDER, ORDER) / (weights @ pole**lags @ weights)))


def _spectrum(series: Sequence[FloatArray]) -> tuple[FloatArray, int]:
    """Mean periodogram [SEGMENT/2 + 1] per sample of Hann windows that overlap by half (Welch,
    1967), scaled so that white noise of variance 1 has power 1, and the number of windows.
    """
    taper = np.hanning(SEGMENT + 1)[:-1]
    total, count = np.zeros(SEGMENT // 2 + 1), 0
    for values in series:
        for first in range(0, len(values) - SEGMENT + 1, SEGMENT // 2):
            part = values[first : first + SEGMENT]
            total += np.abs(np.fft.rfft((part - part.mean()) * taper)) ** 2
            count += 1
    return total / max(count, 1) / float(np.sum(taper**2)), count


@lru_cache(maxsize=64)
def _expected(pole: float) -> FloatArray:
    """Expected periodogram [SEGMENT/2 + 1] under the window of an autoregression with innovations
    of variance 1: the window smears a steep spectrum far beyond its corner (Sykulski et al., 2019).
    """
    taper = np.hanning(SEGMENT + 1)[:-1]
    overlap = np.correlate(taper, taper, "full")[SEGMENT - 1 :] / np.sum(taper**2)
    lags = np.arange(SEGMENT)
    covariance = overlap * pole**lags / (1.0 - pole**2)
    omega = 2.0 * np.pi * np.arange(SEGMENT // 2 + 1) / SEGMENT
    sums = np.cos(np.outer(omega, lags)) @ covariance
    return np.asarray(2.0 * sums - covariance[0])


def _profiled(power: FloatArray, pole: float, least: float, degrees: float) -> tuple[float, float]:
    """Largest log likelihood at `pole`, and the variance there: white noise of at least `least`,
    and an autoregression, both by reweighted least squares (the scoring of a gamma model).
    """
    if pole == 0.0:
        white = max(float(np.mean(power)), least)
        return _likelihood(power, np.full_like(power, white), degrees), white
    shape = _expected(pole)[LOWEST:]
    white, innovation = least, max(float(np.mean(power / shape)), 1e-300)
    for _ in range(SCORINGS):
        weight = 1.0 / (white + innovation * shape) ** 2
        ww, ws, ss = weight.sum(), weight @ shape, weight @ shape**2
        pw, ps = weight @ power, weight @ (power * shape)
        white = (pw * ss - ps * ws) / max(ww * ss - ws**2, 1e-300)
        white = max(float(white), least)
        innovation = max(float((ps - white * ws) / ss), 0.0)
        if innovation == 0.0:
            white = max(float(pw / ww), least)
    likelihood = _likelihood(power, white + innovation * shape, degrees)
    return likelihood, white + innovation / (1.0 - pole**2)


def _likelihood(power: FloatArray, model: FloatArray, degrees: float) -> float:
    """Whittle's log likelihood of a mean periodogram with so many `degrees` of freedom."""
    return -0.5 * degrees * float(np.sum(np.log(model) + power / model))
