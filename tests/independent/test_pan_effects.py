"""The hidden effects of the pan drive against SciPy, closed forms and energy."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from tests.independent.drive import as_records, rows
from tests.independent.pan_drive import (
    CURRENT,
    DRIVEN,
    GEAR_ANGLE,
    GEAR_RATE,
    LOAD_ANGLE,
    LOAD_RATE,
    WRAP,
    PanDrive,
    shaft_torques,
    simulate,
)

PERIOD = 5e-3
PLAIN = PanDrive()
TOUCHING = np.array([0.0, 0.0, PLAIN.gap / 2, 0.0, 0.0, 0.0])

EVERYTHING = PanDrive(
    cogging=rows(3, (0.3, 24.0, 0.4), (0.1, 48.0, -1.0), (0.05, 7.3, 2.0)),
    transmission=rows(2, (2e-3, -1e-3, 1.0), (5e-4, 3e-4, 2.0)),
    friction_by_angle=rows(3, (0.05, 0.02, 1.0), (0.03, -0.04, 2.0)),
    friction_by_load=0.03,
    quadratic_drag=0.8,
    stribeck_exponent=1.3,
    viscous_exponent=0.9,
    friction_decay=0.2,
    decay_time=1.5,
    viscous_by_angle=0.4,
    torque_by_angle_and_rate=0.3,
    wrap_torque=0.4,
    wrap_angle=0.3,
    contact_softness=1e-4,
    base_shake_sine=0.2,
    base_shake_cosine=-0.1,
    base_shake_frequency=1.7,
    base_shake_phase=0.6,
    heating_gain=0.2,
    heating_time=2.0,
    k1_cable=0.4,
    k3_cable=0.3,
    theta0_cable=0.2,
    voltage_offset=0.3,
    voltage_deadband=0.5,
    gravity_torque=0.3,
    alpha_base=0.7,
    constant_torque=-0.1,
)


def wave(given: tuple, angle: float) -> tuple[float, float]:
    """Sum of the harmonics (sine, cosine, harmonic) and its derivative."""
    value = sum(s * math.sin(h * angle) + c * math.cos(h * angle) for s, c, h in given)
    slope = sum(h * (s * math.cos(h * angle) - c * math.sin(h * angle)) for s, c, h in given)
    return value, slope


def forward_slope(t: float, y: np.ndarray, u: float, d: PanDrive) -> list[float]:
    """Slope of the state while the gear turns forward and the upper flank presses."""
    load, load_rate, gear, gear_rate, current, heat, wrap = y
    error, error_slope = wave(d.transmission, gear)
    depth = gear + error - load - d.gap / 2
    stiffness = d.k_shaft * depth / (depth + d.contact_softness)
    shaft = stiffness * depth + d.d_shaft * (gear_rate * (1 + error_slope) - load_rate)
    on_load = (
        shaft
        + d.constant_torque
        - d.b_load * load_rate * abs(load_rate) ** (d.viscous_exponent - 1)
    )
    on_load -= d.k1_cable * (load - d.theta0_cable) + d.k3_cable * (load - d.theta0_cable) ** 3
    on_load -= d.wrap_torque * wrap + d.quadratic_drag * load_rate * abs(load_rate)
    on_load -= d.torque_by_angle_and_rate * load * load_rate
    on_load -= d.viscous_by_angle * load_rate * math.sin(2 * load)
    on_load -= d.gravity_torque * math.sin(load - d.alpha_base)
    shake = math.sin(2 * math.pi * d.base_shake_frequency * t + d.base_shake_phase)
    lever = d.base_shake_sine * math.sin(load) + d.base_shake_cosine * math.cos(load)
    on_load += lever * shake
    level = d.F_c_forward + (d.F_s_forward - d.F_c_forward) * math.exp(
        -(abs(gear_rate / d.v_s_forward) ** d.stribeck_exponent)
    )
    level *= 1 + wave(d.friction_by_angle, gear)[0]
    level += d.friction_by_load * abs(shaft)
    level *= 1 + d.friction_decay * math.exp(-t / d.decay_time)
    friction = level + d.F_v_forward * gear_rate * abs(gear_rate) ** (d.viscous_exponent - 1)
    cogging = sum(a * math.sin(n * gear + phase) for a, n, phase in d.cogging)
    on_gear = d.N * d.K_t * current + cogging - (1 + error_slope) * shaft - friction
    volts = math.copysign(max(abs(u) - d.voltage_deadband, 0.0), u) + d.voltage_offset
    drop = d.R * (1 + heat) * current
    return [
        load_rate,
        on_load / d.J_load,
        gear_rate,
        on_gear / (d.J_motor * d.N**2),
        (volts - drop - d.K_t * d.N * gear_rate) / d.L,
        (d.heating_gain * drop * current - heat) / d.heating_time,
        (load_rate - 0.5 * (abs(load_rate) * wrap + load_rate * abs(wrap))) / d.wrap_angle,
    ]


def test_all_smooth_laws_at_once_agree_with_scipy(figure) -> None:
    settled, _ = simulate(EVERYTHING, np.full(100, 14.0), TOUCHING, PERIOD)
    moving = settled[-1]
    states, events = simulate(EVERYTHING, np.full(200, 14.0), moving, PERIOD, 1e-13)
    assert events == 0, "the stretch must be smooth"
    solution = solve_ivp(
        forward_slope,
        (0.0, 1.0),
        moving[: WRAP + 1],
        "LSODA",
        t_eval=np.arange(200) * PERIOD,
        args=(14.0, EVERYTHING),
        rtol=1e-12,
        atol=1e-13,
    )
    difference = np.max(np.abs(states[:, [LOAD_ANGLE, GEAR_ANGLE]] - solution.y[[0, 2]].T))
    assert figure("rad between the event scheme and SciPy", difference) < 1e-9


def test_a_transmission_error_neither_makes_nor_takes_energy(figure) -> None:
    free = dict.fromkeys(("F_c_forward", "F_c_backward", "F_s_forward", "F_s_backward"), 0.0)
    free |= dict.fromkeys(("F_v_forward", "F_v_backward", "b_load", "d_shaft", "K_t"), 0.0)
    drive = PanDrive(gap=0.0, transmission=rows(2, (0.02, -0.01, 1.0), (4e-3, 2e-3, 2.0)), **free)
    start = np.array([0.0, 2.0, 0.01, 2.0, 0.0, 0.0])
    states, _ = simulate(drive, np.zeros(200), start, PERIOD, 1e-13)
    seen = states[:, GEAR_ANGLE].copy()
    for sine, cosine, harmonic in drive.transmission:
        angle = harmonic * states[:, GEAR_ANGLE]
        seen += sine * np.sin(angle) + cosine * np.cos(angle)
    twist = seen - states[:, LOAD_ANGLE]
    energy = 0.5 * drive.J_motor * drive.N**2 * states[:, GEAR_RATE] ** 2
    energy += 0.5 * drive.J_load * states[:, LOAD_RATE] ** 2 + 0.5 * drive.k_shaft * twist**2
    assert figure("relative change of the energy", np.ptp(energy) / energy[0]) < 1e-8


def breakaway_voltage(drive: PanDrive, start: np.ndarray) -> float:
    """Voltage on a slow ramp at which the gear first turns."""
    ramp = np.arange(1200) * 1e-3
    states, _ = simulate(drive, ramp, start)
    return float(ramp[int(np.argmax(states[:, GEAR_RATE] > 0)) - 1])


def test_breakaway_goes_with_angle_load_and_cogging() -> None:
    per_torque = PLAIN.R / (PLAIN.N * PLAIN.K_t)
    angle = 0.8
    start = TOUCHING + np.array([angle, 0.0, angle, 0.0, 0.0, 0.0])
    by_angle = PanDrive(friction_by_angle=rows(3, (0.2, 0.1, 1.0)))
    gear = start[GEAR_ANGLE]
    expected = 0.65 * (1 + 0.2 * math.sin(gear) + 0.1 * math.cos(gear)) * per_torque
    assert breakaway_voltage(by_angle, start) == pytest.approx(expected, abs=2e-3)
    pole = PanDrive(cogging=rows(3, (0.15, 4.0, 0.3)))
    expected = (0.65 - 0.15 * math.sin(4.0 * gear + 0.3)) * per_torque
    assert breakaway_voltage(pole, start) == pytest.approx(expected, abs=2e-3)
    # The load is pressed against the flank by a constant torque: the shaft carries it.
    loaded = PanDrive(constant_torque=-0.5, friction_by_load=0.2)
    pressed = start - np.array([0.5 / PLAIN.k_shaft, 0.0, 0.0, 0.0, 0.0, 0.0])
    expected = (0.65 + 0.5 + 0.2 * 0.5) * per_torque
    assert breakaway_voltage(loaded, pressed) == pytest.approx(expected, abs=2e-3)


def test_steady_speed_balances_drag_and_friction_by_load() -> None:
    drive = PanDrive(quadratic_drag=6.0, friction_by_load=0.3)

    def surplus(rate: float) -> float:
        current = (24.0 - drive.K_t * drive.N * rate) / drive.R
        shaft = drive.b_load * rate + drive.quadratic_drag * rate**2
        stribeck = 0.41 * math.exp(-((rate / drive.v_s_forward) ** 2))
        friction = 0.24 + stribeck + drive.F_v_forward * rate + 0.3 * shaft
        return drive.N * drive.K_t * current - friction - shaft

    states, _ = simulate(drive, np.full(600, 24.0), TOUCHING)
    rate = brentq(surplus, 0.1, 1.0)
    assert states[-1, LOAD_RATE] == pytest.approx(rate, abs=1e-9)
    shaft = shaft_torques(as_records(drive)[0], states[-1:])
    assert shaft[0] == pytest.approx(drive.b_load * rate + 6.0 * rate**2, abs=1e-6)


def test_a_hysteretic_cable_pulls_by_an_exponential_of_the_way() -> None:
    drive = PanDrive(wrap_torque=0.2, wrap_angle=0.4)
    states, _ = simulate(drive, np.full(400, 12.0), TOUCHING)
    way = states[:, LOAD_ANGLE] - states[0, LOAD_ANGLE]
    assert way[-1] > 0.4
    assert states[:, WRAP] == pytest.approx(1.0 - np.exp(-way / 0.4), abs=1e-9)


def test_dry_friction_that_decays_lets_go_later_than_it_would_at_the_end() -> None:
    drive = PanDrive(friction_decay=1.0, decay_time=0.5)
    per_torque = PLAIN.R / (PLAIN.N * PLAIN.K_t)
    voltage = 1.2 * 0.65 * per_torque
    states, _ = simulate(drive, np.full(600, voltage), TOUCHING)
    freed = PERIOD * int(np.argmax(states[:, GEAR_RATE] > 0))
    assert freed == pytest.approx(0.5 * math.log(1.0 / 0.2), abs=2 * PERIOD)


def test_dead_band_and_rails_act_as_a_changed_voltage() -> None:
    voltage = 9.0 * np.sin(np.arange(300) * 0.03)
    inner = np.sign(voltage) * np.maximum(np.abs(voltage) - 0.7, 0.0)
    clipped = np.clip(voltage, -5.0, 5.0)
    for drive, same in (
        (PanDrive(voltage_deadband=0.7), inner),
        (PanDrive(voltage_limit=5.0), clipped),
        (PanDrive(voltage_offset=0.4), voltage + 0.4),
    ):
        changed, _ = simulate(drive, voltage, TOUCHING)
        plain, _ = simulate(PLAIN, same, TOUCHING)
        assert np.max(np.abs(changed - plain)[:, :DRIVEN]) < 1e-10


@pytest.mark.parametrize("delay", [0.0023, 0.0117])
def test_a_held_input_arrives_late_by_exactly_the_delay(delay: float) -> None:
    voltage = 8.0 * np.cos(np.arange(120) * 0.1)
    late, _ = simulate(PanDrive(delay=delay), voltage, TOUCHING)
    fine, shift = 50, round(delay / 1e-4)
    dense = np.concatenate([np.full(shift, voltage[0]), np.repeat(voltage, fine)])
    dense = dense[: fine * len(voltage)]
    shifted, _ = simulate(PLAIN, dense, TOUCHING, 1e-4)
    assert np.max(np.abs(late - shifted[::fine])) < 1e-9


def test_a_push_on_the_load_is_linear_between_samples() -> None:
    drive = PanDrive(F_s_forward=50.0, F_s_backward=50.0, b_load=0.5)
    push = 0.02 * np.sin(np.arange(101) * 0.05)
    inside = np.zeros(6)
    states, events = simulate(drive, np.zeros(100), inside, push=push)
    assert events == 0, "the load must stay inside the gap"

    def slope(t: float, y: np.ndarray) -> list[float]:
        torque = np.interp(t, np.arange(101) * PERIOD, push) - drive.b_load * y[1]
        return [y[1], torque / drive.J_load]

    times = np.arange(100) * PERIOD
    exact = solve_ivp(
        slope, (0.0, 0.5), [0.0, 0.0], t_eval=times, rtol=1e-11, atol=1e-14, max_step=PERIOD
    )
    assert np.max(np.abs(states[:, LOAD_ANGLE] - exact.y[0])) < 1e-9
    assert np.all(states[:, GEAR_ANGLE] == 0.0)


def test_friction_never_pushes() -> None:
    # A share below minus one: the level is zero there, not negative.
    drive = PanDrive(friction_by_angle=rows(3, (0.0, -2.0, 1.0)), F_v_forward=0.0)
    states, _ = simulate(drive, np.zeros(200), TOUCHING + np.array([0, 0, 0, 0.2, 0.0, 0]))
    assert np.all(np.diff(states[:40, GEAR_RATE]) <= 1e-12)
    assert abs(states[-1, CURRENT]) < 0.02
