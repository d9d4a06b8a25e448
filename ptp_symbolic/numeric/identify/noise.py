"""The noise of a measured signal: how large, and how it is correlated in time.

Differences of high order of a signal remove its smooth motion and keep its white noise, which gives
a first size. The residual of a model shows the autocorrelation: its spectrum above the frequencies
of the motion is that of a first-order autoregression plus white noise, whose likelihood (Whittle,
1953) gives the whole variance, also below.

Three tests separate noise from model error. Noise of a sensor is of one size, a model error small
where the machine rests: mean squares of stretches scatter as those of a stationary series do
(Bartlett, 1946). Slow noise goes on where the model rests, a slow model error stands still there.
And runs with equal inputs differ by noise, and by all that the machine does not repeat: a noise
floor that needs no model.

Where the residual exceeds the noise, it is autocorrelated, and least squares credits an effect with
whatever slow drift it can follow. In the innovations every frequency counts by how well it is
known: generalized least squares (Aitken, 1935), with the correlation of an autoregression (Yule,
1927; Walker, 1931), its order by Akaike's criterion (1974).
"""

import itertools
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from math import comb

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray
from scipy import linalg, optimize, signal, stats

from ptp_symbolic.numeric.identify.constants import (
    ABOVE_NOISE,
    DEVIATIONS,
    FAR,
    FEWEST_BLOCKS,
    LAGS,
    LEAST_CYCLES,
    MATERIAL,
    NOTHING,
    ORDER,
    ROUNDS,
    SAME,
    SEGMENT,
    TEST_ALARM,
)
from ptp_symbolic.numeric.identify.run import Run

FloatArray = NDArray[np.float64]


def is_steady(series: Sequence[FloatArray], pole: float, share: float, least: float) -> bool:
    """Whether residual `series` [n] may be noise of one size, a `share` of whose variance is an
    autoregression with `pole`, the rest white: the upper quartile of the rms of their stretches
    lies over the lower one by no more than ABOVE_NOISE times what such noise shows, or by what
    chance adds to that. A few bursts change no quartile; stretches below the `least` noise count as
    that, for a machine at rest may show none. True where stretches are too few.
    """
    squares = [
        float(np.mean(values[first : first + SEGMENT] ** 2))
        for values in series
        for first in range(0, len(values) - SEGMENT + 1, SEGMENT)
    ]
    if len(squares) < FEWEST_BLOCKS:
        return True
    low, high = np.quantile(np.log(np.maximum(squares, least**2)), (0.25, 0.75))
    usual, deviation = _spread(degrees(pole, share), len(squares))
    more = float(high - low) - usual
    return more <= max(2.0 * np.log(ABOVE_NOISE), FAR * deviation)


def degrees(pole: float, share: float) -> float:
    """Independent normal numbers in a stretch whose mean square scatters as that of the noise."""
    lag = np.arange(1, SEGMENT)
    correlation = share * pole**lag
    return float(SEGMENT / (1.0 + 2.0 * np.sum((1.0 - lag / SEGMENT) * correlation**2)))


def _spread(freedom: float, count: int) -> tuple[float, float]:
    """Distance of the quartiles of the logarithm of a mean square with so many degrees of freedom,
    and its standard deviation in samples of `count` (Cramer, 1946, 28.5).
    """
    below, above = 0.25, 0.75
    places = stats.chi2.ppf((below, above), freedom)
    density = stats.chi2.pdf(places, freedom) * places
    variance = (
        below * (1.0 - below) / density[0] ** 2
        + above * (1.0 - above) / density[1] ** 2
        - 2.0 * below * (1.0 - above) / (density[0] * density[1])
    )
    return float(np.log(places[1] / places[0])), float(np.sqrt(variance / count))


def _poles() -> tuple[float, ...]:
    """Zero, and from the smallest correlation that is significant in a SEGMENT to a time constant
    of half a SEGMENT, in steps of at most half the error that a SEGMENT leaves: 1 / sqrt(SEGMENT)
    in the inverse hyperbolic tangent of a correlation, wherever it is (Fisher, 1915).
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
    `is_steady`).
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
    `runs`, each in residual series [n], have in common: the residual of none can be smaller.

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


def is_missed_at_rest(
    series: Sequence[FloatArray], simulated: Sequence[FloatArray], slow: float, pole: float
) -> bool:
    """Whether residual `series` [n] hold less slow noise where the `simulated` signals [n], in the
    same unit, stand still than they would if noise of the standard deviation `slow`, as an
    autoregression with `pole` has it, went on there; False where they hardly stand still.

    Their squares about the mean of each stretch, less those of white noise by its differences (in
    which a part of the slow noise is), are compared with what would go on at the largest pole that
    is tried. That varies as n (1 - a^2) / (1 + a^2) - 1 independent normal numbers (Bartlett,
    1946), and the squares of white noise miss those of its differences by what `_spread_at_rest`
    says: both are allowed for at 99 %.
    """
    seen = (slow / hidden_from_differences(pole)) ** 2
    slowest, found, expected, degrees, variance = POLES[-1], 0.0, 0.0, 0.0, 0.0
    for residual, motion in zip(series, simulated, strict=True):
        for first, last in stretches_at_rest(motion):
            rest = residual[first:last]
            n, white = len(rest), max(float(np.mean(differences(rest) ** 2)) - seen, 0.0)
            found += float(np.sum((rest - rest.mean()) ** 2)) - (n - 1) * white
            variance += n * max(white, float(np.var(rest))) ** 2
            expected += slow**2 * n * (1.0 - _kept_in_mean(slowest, n))
            degrees += max(n * (1.0 - slowest**2) / (1.0 + slowest**2) - 1.0, 0.0)
    if degrees == 0.0:
        return False
    least = expected * float(stats.chi2.ppf(TEST_ALARM, degrees)) / degrees
    least -= float(stats.norm.isf(TEST_ALARM)) * np.sqrt(_spread_at_rest() * variance)
    return least > 0.0 and found < least


def _spread_at_rest() -> float:
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


@dataclass(frozen=True, eq=False)
class Repeatability:
    """Standard deviation [ny] of one run, from the differences of two with equal inputs, in the
    units of the signals, and the `names` of such runs, in pairs.
    """

    rms: FloatArray
    names: tuple[tuple[str, str], ...]


def repeatability(runs: Sequence[Run]) -> Repeatability | None:
    """The repeatability that whole `runs` show; None where no two have equal inputs and starts.

    Inputs are equal where they differ by no more than their noise, and by little beside what they
    vary; starts where they differ by less than FAR standard deviations of the signal.
    """
    pairs = [(a, b) for a, b in itertools.combinations(runs, 2) if _alike(a, b)]
    if not pairs:
        return None
    squares = np.vstack([0.5 * (a.measured - b.measured) ** 2 for a, b in pairs])
    return Repeatability(
        np.sqrt(np.mean(squares, axis=0)), tuple((a.name, b.name) for a, b in pairs)
    )


def _alike(a: Run, b: Run) -> bool:
    """Whether two runs have the same times, the same inputs and the same start."""
    if len(a.time) != len(b.time):
        return False
    period = float(np.median(np.diff(a.time)))
    if np.max(np.abs((a.time - a.time[0]) - (b.time - b.time[0]))) > 0.5 * period:
        return False
    for one, other in zip(a.held_inputs.T, b.held_inputs.T, strict=True):
        noise = ABOVE_NOISE * np.hypot(white_noise(one, a.time), white_noise(other, b.time))
        apart = float(np.sqrt(np.mean((one - other) ** 2)))
        if apart > min(noise, MATERIAL * float(np.std(one))) + NOTHING * np.max(np.abs(one)):
            return False
    far = FAR * np.sqrt(2.0) / a.weight
    return bool(np.all(np.abs(a.measured[0] - b.measured[0]) <= far))


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
