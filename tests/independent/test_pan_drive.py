"""The pan drive against a second scheme, closed forms and its own statements."""

import math
from pathlib import Path

import numba
import numpy as np
import pytest
from scipy.optimize import brentq

from tests.independent.make_logs import main
from tests.independent.pan_drive import PanDrive, simulate

PERIOD = 5e-3
AT_REST = np.array([0.0, 0.0, 0.004, 0.0, 0.0, 0.0])


@numba.njit
def march(drive: PanDrive, voltage: np.ndarray, start: np.ndarray, inner: int) -> np.ndarray:
    """Load angle [n] by time stepping with projected friction: first order, and without events."""
    h = PERIOD / inner
    inertia = drive.J_motor * drive.N**2
    load, load_rate, gear, gear_rate, current, _ = start
    angles = np.empty(voltage.shape[0])
    for k in range(voltage.shape[0]):
        angles[k] = load
        for _ in range(inner):
            twist, rate = gear - load, gear_rate - load_rate
            torque = 0.0
            if twist > drive.gap / 2:
                torque = max(0.0, drive.k_shaft * (twist - drive.gap / 2) + drive.d_shaft * rate)
            elif twist < -drive.gap / 2:
                torque = min(0.0, drive.k_shaft * (twist + drive.gap / 2) + drive.d_shaft * rate)
            back = drive.K_t * drive.N * gear_rate
            pull = drive.gravity_torque * math.sin(load - drive.alpha_base)
            drag = (drive.F_s_forward - drive.F_c_forward) * math.exp(
                -((gear_rate / drive.v_s_forward) ** 2)
            )
            free = drive.N * drive.K_t * current - torque - drive.F_v_forward * gear_rate
            free_rate = gear_rate + h * free / inertia
            limit = h * (drive.F_c_forward + drag) / inertia
            current += h * (voltage[k] - drive.R * current - back) / drive.L
            load_rate += h * (torque - drive.b_load * load_rate - pull) / drive.J_load
            gear_rate = max(0.0, free_rate - limit) + min(0.0, free_rate + limit)
            load += h * load_rate
            gear += h * gear_rate
    return angles


def test_projected_time_stepping_converges_to_the_events() -> None:
    drive = PanDrive(gravity_torque=0.3, alpha_base=-0.8)
    time = np.arange(400) * PERIOD
    voltage = 6.0 * np.sin(2 * math.pi * 0.9 * time) + 4.0 * np.sin(2 * math.pi * 2.3 * time)
    states, events = simulate(drive, voltage, AT_REST)
    errors = [
        float(np.max(np.abs(march(drive, voltage, AT_REST, inner) - states[:, 0])))
        for inner in (500, 1000, 2000)
    ]
    assert events > 10
    assert errors[-1] < 2e-5
    assert errors[0] / errors[1] == pytest.approx(2.0, rel=0.3)
    assert errors[1] / errors[2] == pytest.approx(2.0, rel=0.3)


def test_result_does_not_depend_on_the_tolerance() -> None:
    drive = PanDrive(d_shaft=0.7, k1_cable=0.5, theta0_cable=0.2)
    voltage = np.repeat([0.0, 12.0, -3.0, 6.0], 100)
    fine, coarse = (simulate(drive, voltage, AT_REST, PERIOD, tol)[0] for tol in (1e-13, 1e-10))
    assert np.max(np.abs(fine[:, 0] - coarse[:, 0])) < 1e-9


def test_steady_speed_balances_the_motor_against_friction() -> None:
    drive = PanDrive()

    def surplus(rate: float) -> float:
        current = (24.0 - drive.K_t * drive.N * rate) / drive.R
        stribeck = (drive.F_s_forward - drive.F_c_forward) * math.exp(
            -((rate / drive.v_s_forward) ** 2)
        )
        friction = drive.F_c_forward + stribeck + drive.F_v_forward * rate
        return drive.N * drive.K_t * current - friction - drive.b_load * rate

    states, _ = simulate(drive, np.full(600, 24.0), AT_REST)
    assert states[-1, 1] == pytest.approx(brentq(surplus, 0.1, 1.0), abs=1e-9)
    assert states[-1, 3] == pytest.approx(states[-1, 1], abs=1e-9)


def test_below_breakaway_nothing_moves_at_all() -> None:
    drive = PanDrive()
    voltage = 0.99 * drive.F_s_forward * drive.R / (drive.N * drive.K_t)
    states, events = simulate(drive, np.full(200, voltage), AT_REST)
    assert events == 0
    assert np.all(states[:, 2] == AT_REST[2])
    states, _ = simulate(drive, np.full(200, voltage / 0.98), AT_REST)
    assert states[-1, 2] > AT_REST[2]


def test_breakaway_waits_for_the_torque_that_dwell_has_built_up() -> None:
    ramp = np.arange(800) * PERIOD * 0.3
    waits = []
    for gain in (0.0, 0.2):
        drive = PanDrive(dwell_gain=gain, dwell_time=0.3)
        states, _ = simulate(drive, ramp, AT_REST)
        waits.append(PERIOD * int(np.argmax(states[:, 3] > 0)))
    time = waits[1]
    growth = 1 + 0.2 * math.log(1 + time / 0.3)
    assert time == pytest.approx(waits[0] * growth, abs=0.02)
    assert waits[1] > waits[0] + 0.1


def test_a_payload_on_a_leaning_base_falls_to_the_azimuth_side_of_the_gap() -> None:
    drive = PanDrive(gravity_torque=0.3, alpha_base=1.0)
    states, _ = simulate(drive, np.zeros(400), np.zeros(6))
    squeeze = 0.3 * math.sin(1.0 - states[-1, 0]) / drive.k_shaft
    assert states[-1, 0] > 0.9 * drive.gap / 2
    assert states[-1, 0] - states[-1, 2] == pytest.approx(drive.gap / 2 + squeeze, abs=1e-9)


def test_a_warm_winding_slows_the_axis_down() -> None:
    voltage = np.full(4000, 12.0)
    cold, _ = simulate(PanDrive(), voltage, AT_REST)
    warm, _ = simulate(PanDrive(heating_gain=0.5, heating_time=2.0), voltage, AT_REST)
    power = 12.9 * (1 + warm[-1, 5]) * warm[-1, 4] ** 2
    assert warm[-1, 5] == pytest.approx(0.5 * power, rel=1e-3)
    assert warm[-1, 1] < cold[-1, 1]


def test_logs_come_out_the_same_for_the_same_seed(tmp_path: Path) -> None:
    for name in ("first", "second"):
        arguments = (
            f"--seed 5 --run validate/ramp_fast --set alpha_base=0.5 --out {tmp_path / name}"
        )
        main(["--effect", "base_tilt+wrong_gap", *arguments.split()])
    first, second = (
        (tmp_path / name / "validate" / "ramp_fast.csv").read_text() for name in ("first", "second")
    )
    assert first == second
    assert first.startswith("time [s],pan_voltage [V],pan_current [A],pan_angle [rad]\n0.0000,")
    assert len(first.splitlines()) == 401
