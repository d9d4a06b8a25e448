"""Errors of what few samples tell, under noise of one colour: an autoregression's closed form."""

import numpy as np
import pytest
from scipy.linalg import toeplitz
from scipy.signal import lfilter

from ptp_symbolic.numeric.identify.blocks import autocovariance
from ptp_symbolic.numeric.identify.coordinates import free_parameter
from ptp_symbolic.numeric.identify.intervals import chance_of_zero, coloured_variances, estimates
from tests.identify.curves import Floats
from tests.identify.straight import finished

SAMPLES, LOGS, SIZE = 1000, 3, 3.0
EVENT = free_parameter("k", 1.0, -1e3, 1e3)


def slow(rng: np.random.Generator, pole: float) -> Floats:
    """An autoregression [SAMPLES] of rms SIZE."""
    white = rng.standard_normal(SAMPLES + 300)
    return np.asarray(SIZE * lfilter([np.sqrt(1.0 - pole**2)], [1.0, -pole], white)[300:])


@pytest.mark.parametrize("pole", [0.0, 0.9, 0.97])
def test_a_sum_scatters_as_the_covariance_of_the_noise_says(pole: float) -> None:
    """Two signals with their own weights: w' R w for each, R of the autoregression."""
    rng = np.random.default_rng(1)
    weights = np.zeros((SAMPLES, 2, 1))
    weights[300:340, 0, 0], weights[600:900, 1, 0] = np.hanning(40), 0.1
    every = toeplitz(SIZE**2 * pole ** np.arange(SAMPLES))
    exact = sum(float(w @ every @ w) for w in weights[:, :, 0].T)
    found = [
        coloured_variances(
            [np.column_stack([slow(rng, pole), slow(rng, pole)]) for _ in range(LOGS)],
            [weights.reshape(-1, 1)] * LOGS,
        )[0]
        for _ in range(20)
    ]
    assert np.mean(found) == pytest.approx(LOGS * exact, rel=0.1 if pole < 0.95 else 0.2)


def test_covariance_ends_where_it_is_noise() -> None:
    rng = np.random.default_rng(2)
    found = autocovariance([slow(rng, 0.9) for _ in range(20)])
    assert found[0] == pytest.approx(SIZE**2, rel=0.1)
    assert found[:10] == pytest.approx(SIZE**2 * 0.9 ** np.arange(10), rel=0.15)
    assert 20 < len(found) < 200
    assert np.all(autocovariance([np.zeros(50)]) == 0.0)
    assert np.all(autocovariance([np.ones(2)]) == 0.0)


@pytest.mark.parametrize("pole", [0.9, 0.97])
def test_what_one_event_tells_has_an_interval_that_holds_the_truth(pole: float) -> None:
    """Forty samples of one log: with it left out nothing is known, so that blocks tell no error.
    White noise as large would tell intervals that hold in 78 and 55 %.
    """
    rng, held, clear = np.random.default_rng(3), [], []
    for _ in range(200):
        columns = [np.zeros(SAMPLES) for _ in range(LOGS)]
        first = int(rng.integers(100, SAMPLES - 100))
        columns[1][first : first + 40] = np.hanning(40)
        noise = [slow(rng, pole) for _ in range(LOGS)]
        value = float(columns[1] @ noise[1] / (columns[1] @ columns[1]))
        left = [n - value * c for n, c in zip(noise, columns, strict=True)]
        slopes = [-EVENT.scale * c[:, None] for c in columns]
        fit = finished(left, slopes, None, (EVENT,), {"k": value})
        (told,) = estimates(fit)
        held.append(told.lower <= 0.0 <= told.upper)
        clear.append(chance_of_zero(fit, {"k": 0.0}) < 0.05)
    assert 0.9 <= np.mean(held) <= 0.99
    assert np.mean(clear) <= 0.1
