"""Whiteness and independence tests of the residual on validation runs, for every signal."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from ptp_symbolic.numeric.identify.constants import LAGS, TEST_ALARM
from ptp_symbolic.numeric.identify.fit import Fit

FloatArray = NDArray[np.float64]

WHITE = (
    "residuals should not be autocorrelated; rounding and noise of the inputs correlate them a"
    " little where nothing is missing, so that this test alone proves nothing"
)
INDEPENDENT = (
    "the residual should be uncorrelated with {name}; where it is not, an effect is missing, or the"
    " log of {name} is noisy"
)


def residual_tests(fit: Fit, inputs: tuple[str, ...]) -> list[dict[str, Any]]:
    """Per measured signal: whiteness of its residual (autocorrelation), and independence of each of
    the `inputs` (cross-correlation).

    The statistic is the largest correlation over `LAGS` lags; of independent residuals it stays
    below the threshold in 99 of 100 cases, whatever the colour of residual and input.
    """
    pairs = [(r, e) for r, e in fit.pairs() if len(r.time) > 4 * LAGS]
    rows: list[dict[str, Any]] = []
    for column, signal in enumerate(fit.runs[0].signals if pairs else ()):
        left = [e.residual.reshape(run.measured.shape)[:, column] for run, e in pairs]
        white, size = correlations(left, left)
        rows.append(_row("whiteness", signal, white[1:], size, WHITE))
        for k, name in enumerate(inputs):
            given = [run.held_inputs[:, k] for run, _ in pairs]
            crossed, size = correlations(left, given)
            row = f"independence of {name}", signal, crossed, size, INDEPENDENT.format(name=name)
            rows.append(_row(*row, spread(left, given)))
    return rows


def correlations(
    first: Sequence[FloatArray], other: Sequence[FloatArray]
) -> tuple[FloatArray, int]:
    """Correlations [LAGS + 1] of series over runs of any lengths, and the number of samples.

    Each run is scaled by itself and counts by its samples, so that the standard deviation of
    independent series of which one is white is 1 / sqrt(samples).
    """
    total, size = np.zeros(LAGS + 1), 0
    for a, b in zip(first, other, strict=True):
        a, b = a - a.mean(), b - b.mean()
        norm = max(float(np.linalg.norm(a) * np.linalg.norm(b)), 1e-300)
        total += [a.size * float(a[k:] @ b[: b.size - k]) / norm for k in range(LAGS + 1)]
        size += a.size
    return total / max(size, 1), size


def spread(first: Sequence[FloatArray], other: Sequence[FloatArray]) -> float:
    """Standard deviation of the correlations of independent series over runs, beside that of white
    ones: the root of the sum over all lags of the product of their autocorrelations (Bartlett,
    1946; Ljung, 1999, 16.6), by their periodograms.
    """
    total, size = 0.0, 0
    for a, b in zip(first, other, strict=True):
        a, b = a - a.mean(), b - b.mean()
        powers = [np.abs(np.fft.fft(part, 2 * part.size)) ** 2 for part in (a, b)]
        product = float(np.mean(powers[0] * powers[1]))
        total += a.size * product / max(float((a @ a) * (b @ b)), 1e-300)
        size += a.size
    return float(np.sqrt(total / max(size, 1)))


def _row(
    name: str, signal: str, values: FloatArray, size: int, meaning: str, deviation: float = 1.0
) -> dict[str, Any]:
    largest = float(np.max(np.abs(values)))
    quantile = stats.norm.ppf(1.0 - 0.5 * TEST_ALARM / values.size)
    threshold = float(quantile * deviation / np.sqrt(size))
    return {
        "name": name,
        "signal": signal,
        "statistic": largest,
        "threshold": threshold,
        "passed": largest <= threshold,
        "meaning": meaning,
    }
