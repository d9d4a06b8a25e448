"""The rate at the first sample, from angles in closed form."""

import numpy as np
import pytest

from ptp_symbolic.numeric.identify.constants import ROUNDING
from ptp_symbolic.numeric.identify.run import Around, first_rate
from tests.identify.curves import Floats


def around(time: Floats, angle: Floats, first: int = 0) -> Around:
    return Around(time, angle[:, None], first)


def test_noise_is_averaged_over_the_whole_span() -> None:
    """Of a steady rate a longer span tells more: its error falls with the power 3/2 of it."""
    time, sigma = 0.001 * np.arange(400), 1e-4
    rng = np.random.default_rng(4)
    found = [
        first_rate(around(time, 0.3 * time + sigma * rng.standard_normal(400)), 0, sigma, np.nan)
        for _ in range(300)
    ]
    rates = np.array([rate for rate, _ in found])
    parabola = np.vander(time[:100], 3, increasing=True)
    closed = sigma * float(np.linalg.norm(np.linalg.pinv(parabola)[1]))
    assert float(np.median(np.abs(rates - 0.3))) / 0.6745 == pytest.approx(closed, rel=0.3)
    honest = [abs(rate - 0.3) <= 4.0 * error for rate, error in found]
    assert np.mean(honest) > 0.98


def test_a_joint_that_lets_go_is_not_said_to_have_turned() -> None:
    """Stribeck friction falls as the joint speeds up: a(exp(t/T) - 1 - t/T) until the torque is
    used up. A parabola over a tenth of a second has a rate of the wrong sign there.
    """
    time, growth = 0.01 * np.arange(100), 0.017
    angle = 1e-5 * (np.exp(time / growth) - 1.0 - time / growth)
    late = time > 0.05
    slope = 1e-5 / growth * (np.exp(0.05 / growth) - 1.0)
    angle[late] = angle[time <= 0.05][-1] + slope * (time[late] - 0.05)
    sigma = 1.8e-6
    rate, error = first_rate(around(time, angle), 0, sigma, sigma / ROUNDING)
    assert abs(rate) <= 4.0 * error
    assert error < 0.5 * slope


def test_a_window_is_looked_at_from_both_sides() -> None:
    """Spans on both sides tell the rate in the middle of them, as far as the log reaches."""
    time = 0.005 * np.arange(200)
    angle = 0.2 * time + 0.5 * time**2
    for first in (0, 1, 100, 190):
        rate, error = first_rate(around(time, angle, first), 0, 1e-9, np.nan)
        assert rate == pytest.approx(0.2 + time[first], abs=1e-6)
        assert error < 1e-5
