"""The platform of the how-to on IMUs, fitted to a log that MuJoCo made on a ship."""

import re
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import ptp_symbolic as ptp

mujoco = pytest.importorskip("mujoco", reason="MuJoCo is an extra")

PLANTED = {
    "c_x_payload": 0.11,
    "x_imu": 0.15,
    "y_imu": -0.08,
    "z_imu": 0.06,
    "roll_imu": 0.10,
    "pitch_imu": -0.20,
    "yaw_imu": 0.30,
}
KNOWN = {
    "J_pan": 0.30,
    "J_x_pan": 0.35,
    "J_y_pan": 0.40,
    "J_x_tilt": 0.05,
    "J_y_tilt": 0.04,
    "J_z_tilt": 0.06,
    "m_payload": 3.0,
    "J_x_payload": 0.020,
    "J_y_payload": 0.025,
    "J_z_payload": 0.030,
    "x_base": 0.4,
    "y_base": -0.3,
    "z_base": -0.5,
}
DAMPING = np.array([0.4, 0.3])
PERIOD, DURATION = 0.002, 4.0
GYRO, ACCELEROMETER, ENCODER = np.radians(0.1), 0.05, 1e-4  # rms noise in rad/s, m/s^2 and rad
# The ship: amplitude in m and rad, frequency in Hz and phase in rad of x, y, z, yaw, pitch, roll.
SWAY = np.array([0.2, 0.3, 0.4, 0.05, 0.08, 0.25])
PACE = np.array([0.25, 0.3, 0.35, 0.1, 0.3, 0.4])
BEGIN = np.array([0.0, 1.0, 2.0, 0.5, 1.5, 2.5])
COLUMNS = {
    "time [s]": 1,
    "pan_torque [N m]": 1,
    "tilt_torque [N m]": 1,
    **{f"deck_{k} [rad/s]": 1 for k in "pqr"},
    **{f"deck_{k}_slope [rad/s^2]": 1 for k in "pqr"},
    **{f"deck_f{k} [m/s^2]": 1 for k in "xyz"},
    "pan_angle [rad]": 1,
    "tilt_angle [rad]": 1,
    **{f"gyro_{k} [rad/s]": 1 for k in "xyz"},
    **{f"acc_{k}": 1 for k in "xyz"},
}


def ship(t: float) -> np.ndarray:
    """Places, rates and accelerations [3, 6] of the base."""
    turn = 2 * np.pi * PACE
    phase = turn * t + BEGIN
    return np.array(
        [SWAY * np.sin(phase), SWAY * turn * np.cos(phase), -SWAY * turn**2 * np.sin(phase)]
    )


def torque(t: float) -> np.ndarray:
    """Torques [2] on the joints in N m, which hold the payload on average."""
    return np.array([1.5 * np.sin(5.0 * t), -2.8 + 1.4 * np.sin(7.0 * t + 1.0)])


def write_log(path: Path) -> None:
    """A log of joints that are moved on a ship, every reading with its noise but those on deck.

    The torques are held from sample to sample, as a drive does.
    """
    from tests.independent.mujoco_moving_base import MovingPlatform

    platform, rng = MovingPlatform(KNOWN | PLANTED), np.random.default_rng(6)
    times = np.arange(0.0, DURATION, PERIOD)
    x, rows = np.zeros(4), []
    for t in times:
        tau = torque(t)

        def slope(s: float, x: np.ndarray, tau: np.ndarray = tau) -> np.ndarray:
            read = platform.read(ship(s), x[:2], x[2:], tau - DAMPING * x[2:])
            return np.concatenate([x[2:], read.joints])

        read = platform.read(ship(t), x[:2], x[2:], tau - DAMPING * x[2:])
        gyro = read.gyro + GYRO * rng.normal(size=3)
        force = (read.accelerometer + ACCELEROMETER * rng.normal(size=3)) / 0.00981
        angles = x[:2] + ENCODER * rng.normal(size=2)
        rows.append([t, *tau, *read.rate, *read.slope, *read.force, *angles, *gyro, *force])
        x = solve_ivp(slope, (t, t + PERIOD), x, rtol=1e-8, atol=1e-10).y[:, -1]
    np.savetxt(path, rows, delimiter=",", header=",".join(COLUMNS), comments="", fmt="%.12g")


@pytest.fixture(scope="module")
def fitted(checkout: Path, tmp_path_factory: pytest.TempPathFactory) -> ptp.FitResult:
    folder = tmp_path_factory.mktemp("imu")
    page = (checkout / "docs/how-to/imu.md").read_text(encoding="utf-8")
    (block,) = re.findall(r"^```toml\n(.*?)^```", page, re.MULTILINE | re.DOTALL)
    (folder / "deck_camera.toml").write_text(block, encoding="utf-8")
    write_log(folder / "run.csv")
    return ptp.fit(folder / "deck_camera.toml", [folder / "run.csv"])


@pytest.mark.long
def test_the_mounting_of_an_imu_is_found_on_a_ship(fitted: ptp.FitResult) -> None:
    """From starts at zero; the bound is two half widths of 95 % intervals, four sigmas."""
    for name, truth in PLANTED.items():
        estimate = fitted.parameters[name]
        lower, upper = estimate.interval
        assert lower is not None and upper is not None, name
        width = upper - lower
        assert abs(estimate.value - truth) <= width, (name, estimate)
        assert width < 0.2 * abs(truth), (name, estimate)
