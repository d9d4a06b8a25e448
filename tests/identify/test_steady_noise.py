"""Noise is of one size whatever the machine does: told from residuals that come and go."""

import numpy as np
import pytest
from scipy import signal, stats

from ptp_symbolic.numeric.identify.constants import SEGMENT
from ptp_symbolic.numeric.identify.noise import _spread, coloured_noise, degrees, is_steady
from tests.identify.curves import Floats

RUNS, SAMPLES = 5, 2000


def autoregression(rng: np.random.Generator, pole: float, samples: int = SAMPLES) -> Floats:
    """Noise of variance 1, stationary from its first sample."""
    shocks = np.sqrt(1.0 - pole**2) * rng.standard_normal(samples + 500)
    return np.asarray(signal.lfilter([1.0], [1.0, -pole], shocks)[500:])


@pytest.mark.parametrize(("pole", "share"), [(0.0, 0.0), (0.5, 1.0), (0.9, 1.0), (0.9, 0.5)])
def test_mean_squares_scatter_like_those_of_so_many_normal_numbers(
    pole: float, share: float
) -> None:
    """The variance of a mean square of d normal numbers is 2 / d, which 20,000 stretches tell to
    3 %. Of correlated ones the tail is longer, so that quartiles lie closer by up to an eighth; of
    white ones they are where they should be, and scatter in samples of 50 as said.
    """
    rng = np.random.default_rng(7)
    white = np.sqrt(1.0 - share) * rng.standard_normal((20_000, SEGMENT))
    rows = np.array([autoregression(rng, pole, SEGMENT) for _ in range(20_000)])
    squares = np.mean((np.sqrt(share) * rows + white) ** 2, axis=1)
    d = degrees(pole, share)
    assert np.var(squares) == pytest.approx(2.0 / d, rel=0.1)
    low, high = np.quantile(np.log(squares).reshape(400, 50), [0.25, 0.75], axis=1)
    usual, deviation = _spread(d, 50)
    assert 0.87 * usual < np.mean(high - low) < 1.02 * usual
    assert 0.8 * deviation < np.std(high - low) < 1.1 * deviation
    if share == 0.0:
        assert np.mean(high - low) == pytest.approx(usual, rel=0.03)


def test_independent_numbers_count_all() -> None:
    assert degrees(0.0, 0.0) == SEGMENT
    low, high = np.log(stats.chi2.ppf([0.25, 0.75], 6))
    assert _spread(6.0, 100)[0] == pytest.approx(high - low)


@pytest.mark.parametrize("pole", [0.3, 0.7, 0.9, 0.97])
@pytest.mark.parametrize("counts", [0.5, 3.0])
def test_coloured_noise_of_an_encoder_is_steady(pole: float, counts: float) -> None:
    """Also where it is rounded, and where the machine rests for a third of the time."""
    rng = np.random.default_rng(int(100 * pole))
    motion = np.cumsum(np.repeat(rng.uniform(0.0, 3.0, SAMPLES // 100), 100))
    motion[SAMPLES // 3 : 2 * SAMPLES // 3] = motion[SAMPLES // 3]
    refused = 0
    for _ in range(20):
        noise = [counts * autoregression(rng, pole) for _ in range(RUNS)]
        series = [(np.rint(motion + part) - motion) * np.sqrt(12.0) for part in noise]
        refused += not coloured_noise(series, 1.0).steady
    assert refused == 0


@pytest.mark.parametrize("bursts", [False, True])
def test_what_is_three_times_as_large_while_the_machine_turns_is_no_noise(bursts: bool) -> None:
    """It may have the spectrum of noise. A few bursts are no such thing: friction that lets go a
    sample late in one run.
    """
    rng = np.random.default_rng(3)
    turning = np.ones(SAMPLES)
    turning[SAMPLES // 2 :] = 3.0
    if bursts:
        turning[:] = 1.0
        turning[:SEGMENT] = 4.0
    series = [2.0 * turning * autoregression(rng, 0.8) for _ in range(RUNS)]
    assert coloured_noise(series, 1.0).steady is bursts


def test_a_few_stretches_decide_nothing() -> None:
    rng = np.random.default_rng(5)
    series = [np.repeat([1.0, 9.0], SEGMENT) * rng.standard_normal(2 * SEGMENT)]
    assert is_steady(series, 0.0, 0.0, 1.0)
    assert not is_steady(8 * series, 0.0, 0.0, 1.0)
