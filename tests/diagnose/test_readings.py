"""What logs show of a shaft: two masses by SciPy, with the encoder on the load alone."""

import numpy as np
import pytest
from scipy.signal import lsim

from ptp_symbolic.numeric.diagnose.readings import spring_over_inertia

PERIOD, COUNT, INERTIA = 5e-3, 2.0 * np.pi / 36000, 0.1


def load_behind_a_shaft(stiffness: float, damping: float, seed: int) -> tuple[np.ndarray, ...]:
    """The lag [n] behind the gear output, which moves as filtered noise, and the angle [n], counted
    and offset: the transfer function from gear output to load is (d s + k) / (J s^2 + d s + k).
    """
    rng = np.random.default_rng(seed)
    time = PERIOD * np.arange(2000)
    tones, phases = rng.uniform(0.5, 12.0, 12), rng.uniform(0.0, 2.0 * np.pi, 12)
    gear = (np.sin(2.0 * np.pi * np.outer(time, tones) + phases) / tones**2).sum(axis=1) * 0.3
    gear -= gear[0]
    below = [INERTIA, damping, stiffness]
    _, angle, _ = lsim(([damping, stiffness], below), gear, time)
    shown = COUNT * np.round(angle / COUNT)
    drift = 0.02 + 0.01 * time
    return gear + drift - shown, shown


@pytest.mark.parametrize("stiffness", [60.0, 250.0, 800.0])
def test_the_stiffness_of_a_shaft_is_read_from_the_lag_behind_a_rigid_model(
    stiffness: float,
) -> None:
    runs = [load_behind_a_shaft(stiffness, 0.5, seed) for seed in range(2)]
    found = spring_over_inertia(PERIOD, [lag for lag, _ in runs], [angle for _, angle in runs])
    assert found == pytest.approx(stiffness / INERTIA, rel=0.25)


def test_a_lag_that_no_spring_explains_shows_none() -> None:
    """Noise, a filter of the encoder, and a log that is too slow to show a resonance."""
    rng = np.random.default_rng(3)
    _, angle = load_behind_a_shaft(250.0, 0.5, 0)
    assert spring_over_inertia(PERIOD, [COUNT * rng.standard_normal(len(angle))], [angle]) is None
    rate = np.gradient(angle, PERIOD)
    assert spring_over_inertia(PERIOD, [0.01 * rate], [angle]) is None
    assert spring_over_inertia(0.05, [angle], [angle]) is None
