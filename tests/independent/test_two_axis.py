"""The torque-driven simulator: friction that holds exactly, and the sample made with MuJoCo."""

import math
from pathlib import Path

import numpy as np
import pytest

from tests.independent.test_sample_logs import COUNT, LEANING, RUNS, read_sample
from tests.independent.two_axis import simulate, two_axis

pytestmark = pytest.mark.long  # compiling the simulator takes 20 s


@pytest.mark.parametrize("run", RUNS)
def test_the_shipped_sample_is_a_platform_that_leans_by_four_degrees(
    checkout: Path, run: str
) -> None:
    torques, measured = read_sample(checkout, run)

    def replay(time: float, *_: np.ndarray) -> np.ndarray:
        return torques[round(time / 5e-3)]

    _, angles, _ = simulate(two_axis(LEANING), measured[0], np.zeros(2), replay, len(torques))
    assert np.max(np.abs(angles - measured)) < 0.501 * COUNT


def test_a_joint_below_its_coulomb_torque_stands_exactly_still() -> None:
    model = two_axis(LEANING | {"F_c_pan": 0.5, "F_c_tilt": 5.0})
    start = np.array([0.2, 0.1])
    _, angles, _ = simulate(model, start, np.zeros(2), lambda *_: np.array([0.1, -4.0]), 200)
    assert np.array_equal(angles, np.broadcast_to(start, angles.shape))


def test_energy_lost_to_friction_is_coulomb_torque_times_travel() -> None:
    lone = {"J_pan": 0.05, "J_y_tilt": 0.02, "F_c_pan": 0.3, "F_c_tilt": 0.2}
    model = two_axis(lone)
    _, angles, rates = simulate(
        model, np.zeros(2), np.array([2.0, -1.0]), lambda *_: np.zeros(2), 200
    )
    for k, inertia in enumerate((0.05, 0.02)):
        coulomb = (0.3, 0.2)[k]
        assert rates[-1, k] == 0.0
        expected = math.copysign(0.5 * inertia * rates[0, k] ** 2 / coulomb, rates[0, k])
        assert angles[-1, k] == pytest.approx(expected, abs=1e-12)
