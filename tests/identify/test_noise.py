"""The size of noise: white on a motion, rounded, and coloured below what is seen of it."""

import numpy as np
import pytest
from scipy import stats
from scipy.signal import lfilter

from ptp_symbolic.numeric.identify.noise import (
    POLES,
    coloured_noise,
    differences,
    hidden_from_differences,
    most_in_quietest,
    neighbour_correlation,
    white_noise,
)
from tests.identify.curves import Floats

TIME = np.arange(4000)


def motion(time: Floats) -> Floats:
    """A smooth motion, its fastest part at a thirtieth of the sampling rate."""
    return np.sin(0.05 * time) + 0.3 * np.sin(0.21 * time + 1.0)


MOTION = motion(TIME)


def remembering(pole: float, series: int, n: int) -> Floats:
    """AR(1) noise [series, n] of rms 1."""
    white = np.random.default_rng(23).standard_normal((series, n + 300))
    return lfilter([np.sqrt(1.0 - pole**2)], [1.0, -pole], white)[:, 300:]


@pytest.mark.parametrize("sigma", [1e-4, 1e-2])
def test_white_noise_on_a_smooth_motion_is_found(sigma: float) -> None:
    """Within 10 %: fifth differences of 4000 samples are worth some 800 independent ones, so that
    the standard error is 2.5 %.
    """
    noise = sigma * np.random.default_rng(21).standard_normal(4000)
    assert white_noise(MOTION + noise) == pytest.approx(sigma, rel=0.1)


def test_the_size_of_white_noise_is_not_biased() -> None:
    """300 series: a standard error of 0.15 %. Clipped at two standard deviations it would be 12 %
    low.
    """
    noise = np.random.default_rng(22).standard_normal((300, 4000))
    assert np.mean([white_noise(row) for row in noise]) == pytest.approx(1.0, abs=0.01)


def test_rounding_of_a_motion_is_white_noise_of_its_own_size() -> None:
    """A motion through many counts, of which every sample rounds to another fraction."""
    assert white_noise(np.rint(1e3 * MOTION)) == pytest.approx(1.0 / np.sqrt(12.0), rel=0.1)


def test_a_motion_at_a_tenth_of_the_sampling_rate_leaves_less_than_a_hundredth() -> None:
    assert white_noise(np.sin(0.2 * np.pi * TIME)) < 0.01 * np.sqrt(0.5)


@pytest.mark.parametrize("jitter", [0.0, 0.1, 0.4])
@pytest.mark.parametrize("sigma", [1e-4, 1e-2])
def test_a_motion_is_not_seen_in_the_jitter_of_its_samples(sigma: float, jitter: float) -> None:
    """Nor where every tenth sample is missing. Taken for even, 10 % of jitter would show 64 times
    the smaller noise.
    """
    rng = np.random.default_rng(26)
    kept = rng.random(4000) < 0.9
    time = (TIME + rng.uniform(-jitter, jitter, 4000))[kept]
    signal = motion(time) + sigma * rng.standard_normal(len(time))
    assert white_noise(signal, 0.005 * time) == pytest.approx(sigma, rel=0.1)
    assert white_noise(signal) > 1.1 * sigma


def test_divided_differences_are_those_of_even_samples_and_leave_nothing_of_a_polynomial() -> None:
    rng = np.random.default_rng(27)
    signal = rng.standard_normal(300)
    even = differences(signal, 0.01 * np.arange(300))
    assert np.abs(even) == pytest.approx(np.abs(differences(signal)), rel=1e-6, abs=1e-9)
    time = np.cumsum(rng.uniform(0.2, 1.8, 300))
    quartic = np.polynomial.Polynomial([1.0, -2.0, 0.5, 0.3, -0.1])
    assert differences(quartic(time - 150.0), time) == pytest.approx(0.0, abs=1e-4)
    assert np.sum(differences(signal, time) ** 2) / 295 == pytest.approx(1.0, rel=0.3)


def test_jumps_and_rough_passages_are_not_noise() -> None:
    """Rough for a quarter of the time, and with three steps elsewhere."""
    noise = 0.01 * np.random.default_rng(24).standard_normal(4000)
    rough = np.where(TIME < 1000, np.sin(1.5 * TIME), 0.0) + (TIME > 1900) + (TIME > 2900)
    assert white_noise(rough + noise) == pytest.approx(0.01, rel=0.15)


def test_reversals_of_a_motion_are_not_noise() -> None:
    """The acceleration jumps every 25 samples by 200 times the noise: a fifth of all differences
    of order 5 hold a jump. Half a percent of them trimmed, they would show 5.9 times the noise.
    """
    noise = 0.01 * np.random.default_rng(25).standard_normal(4000)
    reversing = np.cumsum(np.cumsum(np.sign(np.sin(2.0 * np.pi * TIME / 50.0))))
    assert white_noise(reversing + noise) == pytest.approx(0.01, rel=0.1)


def test_a_signal_at_rest_or_of_a_few_samples_shows_no_noise() -> None:
    assert white_noise(np.full(500, 0.7)) == 0.0
    assert white_noise(np.arange(12.0) ** 3) == 0.0


@pytest.mark.parametrize(("pole", "single", "mean"), [(0.8, 0.3, 1.1), (0.9, 1.0, 1.6)])
def test_coloured_noise_is_as_large_as_it_is_below_the_motion_too(
    pole: float, single: float, mean: float
) -> None:
    """White noise alone says a third or a quarter. The spectrum is seen from 3/64 of the sampling
    rate on, that of pole 0.9 bends at 1/64: from there it looks like that of 0.97, with 1.8 times
    the rms. Of pole 0.8 the bend is in sight.
    """
    noise = remembering(pole, 20, 4000)
    found = [coloured_noise([row], 1e-3) for row in noise]
    rms = np.array([n.rms for n in found])
    assert np.all((rms > 0.7) & (rms < 1.0 + single))
    assert 1.0 / mean < rms.mean() < mean
    assert np.mean([white_noise(row) for row in noise]) < 0.4
    assert np.mean([n.pole for n in found]) == pytest.approx(pole, abs=0.06)
    most = np.array([n.most for n in found])
    assert np.all(most >= rms) and np.mean(most >= 1.0) >= 0.85


def test_white_noise_is_not_taken_for_coloured() -> None:
    rms = [coloured_noise([row], 1e-3).rms for row in remembering(0.0, 20, 4000)]
    assert np.mean(rms) == pytest.approx(1.0, abs=0.03)


def test_runs_of_any_lengths_are_taken_together() -> None:
    (row,) = remembering(0.8, 1, 6000)
    parts = np.split(row, [500, 530, 2000, 4500])
    assert coloured_noise(parts, 1e-3).rms == pytest.approx(1.0, abs=0.25)


@pytest.mark.parametrize("pole", [0.0, 0.8, 0.97])
def test_noise_that_all_runs_have_is_within_what_the_quietest_allows(pole: float) -> None:
    """Five runs of 1500 samples, in pieces: nearly always, whatever the pole; and a third of it
    where one run is three times quieter than the others, so that what these have is no noise.
    """
    found = []
    for row in remembering(pole, 60, 7500):
        runs = [np.split(run, [100, 700]) for run in np.split(row, 5)]
        found.append(most_in_quietest(runs))
        quiet = [*runs[1:], [piece / 3.0 for piece in runs[0]]]
        assert most_in_quietest(quiet) < 0.75 * found[-1]
    assert np.mean(np.array(found) >= 1.0) >= 0.95
    assert np.max(found) < 2.5


def test_noise_is_at_least_what_is_known_of_it() -> None:
    """Runs too short for a spectrum, and residuals below the noise that is known to be there."""
    short = coloured_noise([np.ones(40)], 0.2)
    assert (short.rms, short.pole, short.most) == (0.2, 0.0, 0.2)
    (row,) = remembering(0.0, 1, 4000)
    assert coloured_noise([0.01 * row], 0.2).rms == pytest.approx(0.2)


@pytest.mark.parametrize("pole", [0.0, 0.5, 0.9, 0.95])
def test_so_much_of_an_autoregression_is_hidden_from_differences(pole: float) -> None:
    drawn = np.random.default_rng(3).standard_normal(200_000)
    series = lfilter([np.sqrt(1.0 - pole**2)], [1.0, -pole], drawn)
    size = hidden_from_differences(pole)
    assert white_noise(size * series) == pytest.approx(1.0, rel=0.05)


@pytest.mark.parametrize("pole", [0.0, 0.3, 0.9])
def test_noise_is_correlated_from_sample_to_sample_as_its_interval_says(pole: float) -> None:
    """On a motion with kinks; of 40 intervals of 95 % at least 35 hold (38 less 3 deviations)."""
    time = 0.005 * np.arange(10_000)
    motion = np.sin(8.0 * time) + np.abs(np.sin(2.0 * time))
    found = [neighbour_correlation(motion + 1e-3 * row) for row in remembering(pole, 40, 10_000)]
    assert sum(c is not None and c.least <= pole <= c.most for c in found) >= 35


@pytest.mark.parametrize("pole", [0.0, 0.3, 0.6])
def test_a_long_series_shows_the_correlation_of_its_noise(pole: float) -> None:
    """Up to what 25,000 segments leave open: poles near one have all but one slope there."""
    found = neighbour_correlation(remembering(pole, 1, 800_000)[0])
    assert found is not None and found.value == pytest.approx(pole, abs=0.05)


def test_coloured_noise_is_told_from_white_noise() -> None:
    """The interval of the one begins above zero, that of the other does not."""
    found = [neighbour_correlation(remembering(pole, 1, 20_000)[0]) for pole in (0.8, 0.0)]
    assert found[0] is not None and found[0].least > 0.3
    assert found[1] is not None and found[1].least == 0.0


def test_rounding_is_white_where_the_motion_goes_through_many_counts() -> None:
    """A motion that rests half of the time, which leaves half of the segments out."""
    time = 0.005 * np.arange(20_000)
    moving = np.where(np.sin(0.6 * time) > 0.0, np.sin(6.0 * time), 0.0)
    found = neighbour_correlation(np.rint(4000.0 * moving))
    assert found is not None and found.least < 0.1 and found.most < 0.3


def test_a_signal_that_rests_or_is_short_shows_no_correlation() -> None:
    """Nothing is left of the one, two segments of the other."""
    assert neighbour_correlation(np.ones(5000)) is None
    assert neighbour_correlation(remembering(0.0, 1, 150)[0]) is None


def test_the_quietest_of_many_runs_is_quiet_by_chance() -> None:
    """Runs that leave the same allow more the more there are: each may be below the truth with the
    chance of the test over their number. Quantiles of chi-squared for the largest pole that is
    tried; SciPy.
    """
    pole, n = POLES[-1], 4000
    series = np.where(np.arange(n) % 2 == 0, 1.0, -1.0)  # mean square one
    degrees = n * (1.0 - pole**2) / (1.0 + pole**2)
    for runs in (1, 4, 16):
        allowed = most_in_quietest([[series]] * runs)
        below = stats.chi2.cdf(degrees / allowed**2, degrees)
        assert below == pytest.approx(0.01 / runs, rel=1e-6)
