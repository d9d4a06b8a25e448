"""A machine under its own controller: the commanded position is logged, and the angle.

The truth is written by hand: a sampled PID controller that reads encoder counts and commands whole
steps of voltage, and between its samples a geared motor and a load, by the matrix exponential.
"""

from pathlib import Path

import numpy as np
import pytest
from scipy.linalg import expm

from ptp_symbolic.platform import read_platform
from ptp_symbolic.workflows.fit import fit_platform

TRUTH = {"J_pan": 0.4, "b_pan": 0.6}
L, R, K_T, ROTOR, RATIO = 5e-3, 5.0, 0.05, 1e-5, 100.0
KP, KI, KD, LIMIT, FULL, STEPS = 60.0, 120.0, 2.0, 6.0, 24.0, 128
SAMPLING, PERIOD, DURATION, COUNTS = 0.002, 0.01, 6.0, 7200
COUNT = 2.0 * np.pi / COUNTS
PLATFORM = f"""
[platform]
name = "servo"
axes = ["pan"]
[[effects]]
effect = "rigid_bodies"
[[effects]]
effect = "viscous_friction"
axis = "pan"
[[effects]]
effect = "dc_motor"
axis = "pan"
[[effects]]
effect = "pid_controller"
axis = "pan"
[[effects]]
effect = "encoder_quantization"
axis = "pan"
[parameters]
J_pan = {{ start = 0.7, bounds = [0.001, 10.0] }}
b_pan = {{ start = 0.2, bounds = [0.0, 10.0] }}
L_pan = {{ value = {L} }}
R_pan = {{ value = {R} }}
K_t_pan = {{ value = {K_T} }}
J_motor_pan = {{ value = {ROTOR} }}
N_pan = {{ value = {RATIO} }}
K_p_pan = {{ value = {KP} }}
K_i_pan = {{ value = {KI} }}
K_d_pan = {{ value = {KD} }}
u_i_max_pan = {{ value = {LIMIT} }}
t_sample_pan = {{ value = {SAMPLING} }}
n_d_pan = {{ value = 1 }}
u_full_pan = {{ value = {FULL} }}
n_u_pan = {{ value = {STEPS} }}
q_count_pan = {{ value = {COUNT!r} }}
[signals]
setpoint_pan = {{ role = "input", column = "wanted", unit = "deg", noise = 0.0 }}
[signals.theta_pan]
role = "output"
column = "seen"
unit = "rad"
counts_per_revolution = {COUNTS}
noise = 0.0
"""


def over_one_sample() -> tuple[np.ndarray, np.ndarray]:
    """Angle, rate and current after a sample, linear in those before [3, 3] and the voltage [3]."""
    inertia = TRUTH["J_pan"] + ROTOR * RATIO**2
    rates = np.zeros((4, 4))
    rates[0, 1] = 1.0
    rates[1, 1:3] = -TRUTH["b_pan"] / inertia, RATIO * K_T / inertia
    rates[2, 1:] = -K_T * RATIO / L, -R / L, 1.0 / L
    after = expm(SAMPLING * rates)
    return after[:3, :3], after[:3, 3]


def motion(wanted: np.ndarray, start: float) -> np.ndarray:
    """Angle in rad at every sample of the `wanted` angle [n] in rad, held; it begins at rest."""
    (free, driven), every = over_one_sample(), round(PERIOD / SAMPLING)
    state, total, last, angles = np.array([start, 0.0, 0.0]), 0.0, 0.0, []
    for goal in wanted:
        angles.append(state[0])
        for _ in range(every):
            error = goal - COUNT * np.floor(state[0] / COUNT + 0.5)
            total += SAMPLING * error
            asked = KP * error + np.clip(KI * total, -LIMIT, LIMIT)
            asked += KD * (error - last) / SAMPLING
            last = error
            step = FULL / STEPS
            voltage = np.clip(step * np.floor(asked / step + 0.5), -FULL, FULL)
            state = free @ state + driven * voltage
    return np.array(angles)


def test_a_servo_is_found_from_what_it_was_asked_and_where_it_went(tmp_path: Path) -> None:
    time, logs = PERIOD * np.arange(round(DURATION / PERIOD)), []
    for seed in (1, 2):
        rng = np.random.default_rng(seed)
        tones, phases = rng.uniform(0.3, 1.5, 3), rng.uniform(0.0, 2.0 * np.pi, 3)
        rise = np.minimum(1.0, time)
        wanted = 0.3 * rise * np.sin(2.0 * np.pi * np.outer(time, tones) + phases).sum(axis=1)
        wanted = np.radians(np.round(np.degrees(wanted), 2))
        angle = np.rint(motion(wanted, 0.2 * COUNT) / COUNT) * COUNT
        logs.append(tmp_path / f"{seed}.csv")
        table = np.column_stack([time, np.degrees(wanted), angle])
        np.savetxt(
            logs[-1], table, delimiter=",", comments="", header="time [s],wanted [deg],seen [rad]"
        )
    path = tmp_path / "servo.toml"
    path.write_text(PLATFORM, encoding="utf-8")
    found = fit_platform(read_platform(path), logs).summary
    for name, value in TRUTH.items():
        estimate = found["parameters"][name]
        assert estimate["value"] == pytest.approx(value, rel=5e-3), name
        low, high = estimate["ci95"]
        assert low <= value <= high, name
    assert found["error"]["after"]["total"]["rmse_counts"] < 0.35
