"""Whether residuals scatter as noise does, which does not know what the machine does.

What a model lacks is small where the machine rests and large where it turns, noise of a sensor is
of one size. Mean squares of stretches of a stationary series are like those of some independent
normal numbers, as many as its autocorrelation says (Bartlett, 1946).
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from ptp_symbolic.numeric.identify.constants import ABOVE_NOISE, FAR, FEWEST_BLOCKS, SEGMENT

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
