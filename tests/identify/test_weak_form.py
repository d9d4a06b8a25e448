"""Averages under a smooth test function: exact on parabolas, nothing where samples are missing."""

import numpy as np
import pytest

from ptp_symbolic.numeric.identify.weak_form import curvature_noise, weak_average

HALF_WIDTH = 0.08


def stalled(period: float, first: float, length: float) -> np.ndarray:
    """Times in s of a log that stalls from `first` on for `length` s."""
    time = np.arange(0.0, 1.0, period)
    return time[(time <= first + 1e-9) | (time >= first + length - 1e-9)]


@pytest.mark.parametrize("derivative", [0, 1, 2])
def test_a_parabola_has_its_exact_averages(derivative: int) -> None:
    time = stalled(1e-3, 0.5, 0.006)
    values = (3.0 - 2.0 * time + 5.0 * (time - time[400]) ** 2)[:, None]
    found = weak_average(time, values, HALF_WIDTH, derivative, np.array([400]))[0, 0]
    # the test function (1 - s^2)^4 has the second moment 1 / 11
    expected = (3.0 - 2.0 * time[400] + 5.0 * HALF_WIDTH**2 / 11.0, -2.0, 10.0)[derivative]
    assert found == pytest.approx(expected, rel=1e-4)


@pytest.mark.parametrize("derivative", [1, 2])
@pytest.mark.parametrize("jitter", [0.05, 0.4])
def test_samples_at_uneven_times_show_no_rate_in_a_curvature(
    derivative: int, jitter: float
) -> None:
    """A line has no second derivative and a square about the middle no first one: 5 % of a period
    of 5 ms made 0.015 rad/s^2 of a rad/s.
    """
    rng = np.random.default_rng(3)
    time = 5e-3 * (np.arange(400) + jitter * rng.uniform(-1.0, 1.0, 400))
    chosen = np.arange(100, 300)
    for k in chosen[::20]:
        from_here = time - time[k]
        values = (7.0 + 3.0 * from_here + 5.0 * from_here**2)[:, None]
        found = weak_average(time, values, HALF_WIDTH, derivative, np.array([k]))[0, 0]
        assert found == pytest.approx((3.0, 10.0)[derivative - 1], rel=1e-10)


@pytest.mark.parametrize("offset", [-0.08, -0.06, 0.01, 0.05])
def test_a_stall_anywhere_in_the_window_leaves_no_average(offset: float) -> None:
    """Also one that begins or ends at the very edge, where a single sample is left beyond."""
    middle = 0.5
    time = stalled(1e-3, middle + offset, 0.055)
    chosen = np.array([int(np.argmin(np.abs(time - middle)))])
    found = weak_average(time, np.ones((len(time), 1)), HALF_WIDTH, 0, chosen)
    assert time[chosen[0]] == pytest.approx(middle)
    assert np.isnan(found[0, 0])


def test_what_a_coarse_grid_shows_the_samples_show_too() -> None:
    """Rows average torques on a grid and angles on all samples; a row needs both."""
    time = stalled(1e-3, 0.42, 0.055)
    grid = np.arange(0, len(time), 4)
    coarse = weak_average(time[grid], np.ones((len(grid), 1)), HALF_WIDTH, 0, np.arange(len(grid)))[
        :, 0
    ]
    fine = weak_average(time, np.ones((len(time), 1)), HALF_WIDTH, 0, grid)[:, 0]
    assert np.isfinite(coarse).any()
    assert np.all(np.isfinite(fine[np.isfinite(coarse)]))


@pytest.mark.parametrize("period, half_width", [(1e-3, 0.08), (5e-3, 0.1), (2e-3, 0.02)])
def test_noise_of_a_second_derivative_is_the_sum_of_its_weights(
    period: float, half_width: float
) -> None:
    """The average is linear: unit impulses show the weight of every sample."""
    time = np.arange(-1.5 * half_width, 1.5 * half_width, period)
    middle = np.array([len(time) // 2])
    weights = weak_average(time, np.eye(len(time)), half_width, 2, middle)[0]
    assert curvature_noise(period, half_width) == pytest.approx(np.linalg.norm(weights), rel=5e-3)
