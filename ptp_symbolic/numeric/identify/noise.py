"""The noise of a measured signal: how large, and how it is coloured.

Differences of high order of a signal remove its smooth motion and keep its white noise, which gives
a first size. What a model leaves shows the colour: its spectrum above the frequencies of the motion
is that of a first-order autoregression plus white noise, whose likelihood (Whittle, 1953) gives the
whole variance, also below. Before any fit, only the upper half of the spectrum is free of motion.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from math import comb

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray
from scipy import optimize, stats

from ptp_symbolic.numeric.identify.constants import (
    DEVIATIONS,
    FAR,
    LEAST_CYCLES,
    ORDER,
    ROUNDS,
    SEGMENT,
    TEST_ALARM,
)
from ptp_symbolic.numeric.identify.steady_noise import is_steady

FloatArray = NDArray[np.float64]


def _poles() -> tuple[float, ...]:
    """Zero, and from the smallest correlation that a SEGMENT tells from none to a time constant of
    half a SEGMENT, in steps of at most half the error that a SEGMENT leaves: 1 / sqrt(SEGMENT) in
    the inverse hyperbolic tangent of a correlation, wherever it is (Fisher, 1915).
    """
    error = 1.0 / np.sqrt(SEGMENT)
    first, last = DEVIATIONS * error, np.arctanh(1.0 - 2.0 / SEGMENT)
    count = 1 + int(np.ceil((last - first) / (0.5 * error)))
    return 0.0, *np.tanh(np.linspace(first, last, count)).tolist()


POLES = _poles()  # of autoregressions that are tried as noise


def white_noise(signal: FloatArray, time: FloatArray | None = None) -> float:
    """Standard deviation of the white noise of a smooth `signal` [n], also of its rounding, in its
    unit; sampled evenly, or at `time` [n].

    Squared differences of order 5, without those that are clipped, over pieces of four SEGMENTs,
    each good to 8 %; zero where the signal is too short.
    """
    if len(signal) < 4 * ORDER:
        return 0.0
    square = differences(signal, time) ** 2
    pieces = np.array_split(square, max(1, len(square) // (4 * SEGMENT)))
    return float(np.sqrt(np.median([_clipped_mean(piece) for piece in pieces])))


def differences(signal: FloatArray, time: FloatArray | None = None) -> FloatArray:
    """Differences [n - ORDER] of order ORDER of a `signal` [n], scaled so that they hold as much of
    white noise as the signal does.

    Of samples at uneven `time` [n] they are divided differences: these too leave nothing of any
    polynomial of lower order (Newton's form of interpolation), where a motion would else be seen in
    the jitter of the samples.
    """
    if time is None:
        return np.diff(signal, ORDER) / np.sqrt(float(comb(2 * ORDER, ORDER)))
    points = sliding_window_view(time / np.median(np.diff(time)), ORDER + 1)
    apart = points[:, :, None] - points[:, None, :] + np.eye(ORDER + 1)
    weights = 1.0 / np.prod(apart, axis=2)
    weights /= np.linalg.norm(weights, axis=1)[:, None]
    return np.sum(weights * sliding_window_view(signal, ORDER + 1), axis=1)


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
    one sample; `most` is the largest standard deviation that the spectrum allows at 95 %. It is not
    `steady` where the series scatters more from stretch to stretch than any such noise (see
    `steady_noise`).
    """

    rms: float
    pole: float
    most: float
    steady: bool = True


def coloured_noise(series: Sequence[FloatArray], least: float) -> Noise:
    """The noise in residual `series` [n] (evenly sampled, any lengths), at least `least` of it
    white.

    Whittle's likelihood over the bins that lie above the motion, profiled over the pole.
    """
    power, count = _spectrum(series)
    if count == 0:
        return Noise(least, 0.0, least)
    power = power[LEAST_CYCLES:]
    degrees = 2.0 * count / _mixed()
    fits = [_profiled(power, pole, least**2, degrees) for pole in POLES]
    likelihood = np.array([f[0] for f in fits])
    best = int(np.argmax(likelihood))
    allowed = likelihood >= likelihood[best] - 0.5 * float(stats.chi2.ppf(0.95, 1))
    most = max(f[1] for f, ok in zip(fits, allowed, strict=True) if ok)
    steady = any(
        is_steady(series, POLES[k], 1.0 - least**2 / fits[k][1], least)
        for k in np.flatnonzero(allowed)
    )
    rms = float(np.sqrt(fits[best][1]))
    return Noise(rms, POLES[best], float(np.sqrt(most)), steady)


def most_in_quietest(runs: Sequence[Sequence[FloatArray]]) -> float:
    """The largest standard deviation, at 99 %, that noise of any colour may have which all of
    `runs`, each in residual series [n], have in common: none of them can leave less.

    Mean squares of an autoregression with pole a vary as those of n (1 - a^2) / (1 + a^2) normal
    numbers that are independent (Bartlett, 1946); a is the largest that is tried.
    """
    pole, chance = POLES[-1], TEST_ALARM / max(len(runs), 1)
    found = [np.inf]
    for parts in runs:
        values = np.concatenate(list(parts))
        degrees = max(1.0, len(values) * (1.0 - pole**2) / (1.0 + pole**2))
        least = float(stats.chi2.ppf(chance, degrees)) / degrees
        found.append(float(np.mean(values**2)) / least)
    return float(np.sqrt(min(found)))


@dataclass(frozen=True)
class Correlation:
    """Correlation of noise from one sample to the next, and its 95 % interval."""

    value: float
    least: float
    most: float


def neighbour_correlation(signal: FloatArray, time: FloatArray | None = None) -> Correlation | None:
    """How the noise of a smooth `signal` [n], sampled evenly or nearly so at `time` [n], is
    correlated from sample to sample, were it an autoregression: by what its differences hold above
    a quarter of the sampling rate.

    Whittle's likelihood of the median periodogram, which a few kinks of the motion do not change.
    Stretches that do not change at all are left out; None where too few others remain.
    """
    parts = [part for part in _segments(differences(signal, time)) if np.any(part)]
    if len(parts) < 2 * LEAST_CYCLES:
        return None
    # At half the rate the taper mixes a bin with its mirror.
    upper = slice(SEGMENT // 4, -LEAST_CYCLES)
    power = np.median([_periodogram(part)[upper] for part in parts], axis=0) / np.log(2.0)
    power /= np.mean(power)
    efficiency = np.log(2.0) ** 2  # of the median of exponential numbers beside their mean
    degrees = 2.0 * efficiency * len(parts) / _mixed()

    def likelihood(pole: float) -> float:
        shape = _windowed(_differenced(pole))[upper]
        return _likelihood(power, shape * np.mean(power / shape), degrees)

    last = POLES[-1]
    best = optimize.minimize_scalar(lambda pole: -likelihood(pole), bounds=(0.0, last))
    allowed = -float(best.fun) - 0.5 * float(stats.chi2.ppf(0.95, 1))

    def bound(end: float) -> float:
        inside = likelihood(end) >= allowed
        return end if inside else _root(lambda pole: likelihood(pole) - allowed, best.x, end)

    return Correlation(float(best.x), bound(0.0), bound(last))


def _root(function: Callable[[float], float], one: float, other: float) -> float:
    return float(optimize.brentq(function, one, other))


def _differenced(pole: float) -> FloatArray:
    """Autocovariance [SEGMENT] of the differences of order ORDER of an autoregression."""
    weights = np.array([(-1.0) ** k * comb(ORDER, k) for k in range(ORDER + 1)])
    product = np.convolve(weights, weights[::-1])
    lags = np.abs(np.arange(SEGMENT)[:, None] + np.arange(-ORDER, ORDER + 1))
    return np.asarray(pole**lags @ product, dtype=np.float64)


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
    found = [_periodogram(part) for values in series for part in _segments(values)]
    return np.sum(found, axis=0) / max(len(found), 1), len(found)


def _segments(values: FloatArray) -> list[FloatArray]:
    """Stretches [SEGMENT] of `values` [n] that overlap by half."""
    last = len(values) - SEGMENT
    return [values[first : first + SEGMENT] for first in range(0, last + 1, SEGMENT // 2)]


def _periodogram(part: FloatArray) -> FloatArray:
    """Periodogram [SEGMENT/2 + 1] per sample of a stretch [SEGMENT] under a Hann window."""
    taper = _taper()
    power = np.abs(np.fft.rfft((part - part.mean()) * taper)) ** 2
    return np.asarray(power / np.sum(taper**2))


def _taper() -> FloatArray:
    return np.hanning(SEGMENT + 1)[:-1]


def _mixed() -> float:
    """How many bins of many periodograms count as one: the taper mixes those beside each other, and
    stretches that overlap by half are like each other (1 + 2 r^2: Welch, 1967).
    """
    square, half = _taper() ** 2, SEGMENT // 2
    alike = float(_taper()[:half] @ _taper()[half:] / np.sum(square))
    return float((1.0 + 2.0 * alike**2) * SEGMENT * np.sum(square**2) / np.sum(square) ** 2)


@lru_cache(maxsize=64)
def _expected(pole: float) -> FloatArray:
    """Expected periodogram [SEGMENT/2 + 1] under the window of an autoregression with innovations
    of variance 1: the window smears a steep spectrum far beyond its corner (Sykulski et al., 2019).
    """
    return _windowed(np.asarray(pole ** np.arange(SEGMENT) / (1.0 - pole**2), dtype=np.float64))


def _windowed(autocovariance: FloatArray) -> FloatArray:
    """Expected periodogram [SEGMENT/2 + 1] under the window, by the `autocovariance` [SEGMENT]."""
    taper = _taper()
    overlap = np.correlate(taper, taper, "full")[SEGMENT - 1 :] / np.sum(taper**2)
    covariance = overlap * autocovariance
    omega = 2.0 * np.pi * np.arange(SEGMENT // 2 + 1) / SEGMENT
    sums = np.cos(np.outer(omega, np.arange(SEGMENT))) @ covariance
    return np.asarray(2.0 * sums - covariance[0])


def _profiled(power: FloatArray, pole: float, least: float, degrees: float) -> tuple[float, float]:
    """Largest log likelihood at `pole`, and the variance there: white noise of at least `least`,
    and an autoregression, both by reweighted least squares (the scoring of a gamma model).
    """
    if pole == 0.0:
        white = max(float(np.mean(power)), least)
        return _likelihood(power, np.full_like(power, white), degrees), white
    shape = _expected(pole)[LEAST_CYCLES:]
    white, innovation = least, max(float(np.mean(power / shape)), 1e-300)
    before = np.inf
    for _ in range(ROUNDS):
        weight = 1.0 / (white + innovation * shape) ** 2
        ww, ws, ss = weight.sum(), weight @ shape, weight @ shape**2
        pw, ps = weight @ power, weight @ (power * shape)
        white = (pw * ss - ps * ws) / max(ww * ss - ws**2, 1e-300)
        white = max(float(white), least)
        innovation = max(float((ps - white * ws) / ss), 0.0)
        if innovation == 0.0:
            white = max(float(pw / ww), least)
        variance = white + innovation / (1.0 - pole**2)
        if abs(variance - before) <= np.sqrt(np.finfo(float).eps) * variance:
            break
        before = variance
    return _likelihood(power, white + innovation * shape, degrees), variance


def _likelihood(power: FloatArray, model: FloatArray, degrees: float) -> float:
    """Whittle's log likelihood of a mean periodogram with so many `degrees` of freedom."""
    return -0.5 * degrees * float(np.sum(np.log(model) + power / model))
