"""The sample that ships, made with MuJoCo: its hidden truth is the one that its script states."""

import math
from pathlib import Path

import numpy as np
import pytest

from tests.independent import rigid_platform

COUNT = 2 * math.pi / 7200
PERIOD, SAMPLES = 5e-3, 400
RUNS = ("train/tracking_1", "train/tracking_2", "validate/tracking_3", "validate/tracking_4")
DECLARED = {
    "J_pan": 5.3e-4,
    "J_x_tilt": 4.1e-4,
    "J_y_tilt": 6.5e-4,
    "J_z_tilt": 2.7e-4,
    "m_payload": 4.992,
    "J_x_payload": 5.3e-3,
    "J_y_payload": 6.8e-3,
    "J_z_payload": 6.8e-3,
    "c_x_payload": 0.1,
    "b_pan": 0.1,
    "b_tilt": 0.1,
}
LEANING = DECLARED | {"beta_base": math.radians(4.0), "alpha_base": -0.6}


def read_sample(checkout: Path, run: str) -> tuple[np.ndarray, np.ndarray]:
    """Torques and angles [n, 2]; the angles exactly on encoder counts."""
    log = checkout / "ptp_symbolic" / "samples" / "tilted_base" / f"{run}.csv"
    rows = np.loadtxt(log, delimiter=",", skiprows=1)
    return rows[:, 1:3], np.rint(rows[:, 3:5] / COUNT) * COUNT


def replay(torques: np.ndarray, start: np.ndarray, parameters: dict[str, float]) -> np.ndarray:
    """Angles [n, 2] from rest under held torque, one Runge-Kutta step per sample."""
    state, angles = np.concatenate([start, np.zeros(2)]), []

    def slope(x: np.ndarray, tau: np.ndarray) -> np.ndarray:
        return np.concatenate([x[2:], rigid_platform.accelerations(x[:2], x[2:], tau, parameters)])

    for tau in torques:
        angles.append(state[:2])
        k1 = slope(state, tau)
        k2 = slope(state + PERIOD / 2 * k1, tau)
        k3 = slope(state + PERIOD / 2 * k2, tau)
        k4 = slope(state + PERIOD * k3, tau)
        state = state + PERIOD / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    return np.array(angles)


@pytest.mark.parametrize("run", RUNS)
def test_the_base_leans_by_four_degrees_although_it_is_declared_level(
    checkout: Path, run: str
) -> None:
    torques, measured = read_sample(checkout, run)
    torques, measured = torques[:SAMPLES], measured[:SAMPLES]
    leaning = replay(torques, measured[0], LEANING)
    assert np.max(np.abs(leaning - measured)) < 0.501 * COUNT
    level = replay(torques, measured[0], DECLARED)
    assert np.max(np.abs(level - measured)) > 20 * COUNT


def test_the_sample_is_small_enough_to_ship(checkout: Path) -> None:
    folder = checkout / "ptp_symbolic" / "samples"
    assert sum(file.stat().st_size for file in folder.rglob("*.*")) < 400_000
