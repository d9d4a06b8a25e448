"""A controller that computes for a time is named in logs of a loop that is written by hand.

Between the instants at which something changes the geared motor moves as the matrix exponential
says; the controller reads encoder counts and commands whole steps of voltage.
"""

from pathlib import Path

import numpy as np
import pytest
from scipy.linalg import expm

from ptp_symbolic import diagnose

J, DRAG, L, R, K_T, ROTOR, RATIO = 0.4, 0.6, 5e-3, 5.0, 0.05, 1e-5, 100.0
KP, KD, FULL, STEPS, PERIOD, SAMPLES, COUNTS = 60.0, 1.0, 24.0, 4096, 5e-3, 800, 72000
COUNT = 2.0 * np.pi / COUNTS
DELAY = 1.2  # sampling times

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
J_pan = {{ start = 0.5, bounds = [0.01, 5.0] }}
b_pan = {{ start = 0.4, bounds = [0.0, 10.0] }}
L_pan = {{ value = {L} }}
R_pan = {{ value = {R} }}
K_t_pan = {{ value = {K_T} }}
J_motor_pan = {{ value = {ROTOR} }}
N_pan = {{ value = {RATIO} }}
K_p_pan = {{ value = {KP} }}
K_i_pan = {{ value = 0.0 }}
K_d_pan = {{ value = {KD} }}
u_i_max_pan = {{ value = 6.0 }}
t_sample_pan = {{ value = {PERIOD} }}
n_d_pan = {{ value = 1 }}
u_full_pan = {{ value = {FULL} }}
n_u_pan = {{ value = {STEPS} }}
q_count_pan = {{ value = {COUNT!r} }}
[signals]
setpoint_pan = {{ role = "input", column = "wanted", unit = "rad", noise = 0.0 }}
[signals.theta_pan]
role = "output"
column = "seen"
unit = "rad"
counts_per_revolution = {COUNTS}
noise = 0.0
"""


def motion(wanted: np.ndarray, delay: float) -> np.ndarray:
    """Angle in rad at every sample of the `wanted` angle [n], the command `delay` samples late."""
    inertia = J + ROTOR * RATIO**2
    rates = np.zeros((4, 4))
    rates[0, 1] = 1.0
    rates[1, 1:3] = -DRAG / inertia, RATIO * K_T / inertia
    rates[2, 1:] = -K_T * RATIO / L, -R / L, 1.0 / L
    whole = max(int(np.ceil(delay)) - 1, 0)
    before, after = (expm(PERIOD * part * rates) for part in (delay - whole, 1 + whole - delay))
    commands, state, last, angles = [0.0] * whole, np.zeros(4), 0.0, []
    for goal in wanted:
        angles.append(state[0])
        error = goal - COUNT * np.floor(state[0] / COUNT + 0.5)
        asked, one = KP * error + KD * (error - last) / PERIOD, FULL / STEPS
        last = error
        commands.append(np.clip(one * np.floor(asked / one + 0.5), -FULL, FULL))
        state = before @ state
        state[3] = commands[-1 - whole]
        state = after @ state
    return np.array(angles)


def record(path: Path, seed: int, delay: float) -> Path:
    """Four seconds of steps of the set point."""
    rng = np.random.default_rng(seed)
    goals = np.repeat(rng.uniform(-0.15, 0.15, SAMPLES // 40), 40)
    wanted = np.round(goals, 3)
    wanted[:10] = 0.0
    angle = np.rint(motion(wanted, delay) / COUNT) * COUNT
    table = np.column_stack([PERIOD * np.arange(SAMPLES), wanted, angle])
    np.savetxt(path, table, delimiter=",", comments="", header="time [s],wanted [rad],seen [rad]")
    return path


@pytest.mark.long
@pytest.mark.parametrize("delay", [0.0, DELAY])
def test_a_controller_that_computes_is_named_where_there_is_one(
    tmp_path: Path, delay: float
) -> None:
    (tmp_path / "servo.toml").write_text(PLATFORM, encoding="utf-8")
    paths = [record(tmp_path / f"run_{seed}.csv", seed, delay) for seed in range(5)]
    found = diagnose(tmp_path / "servo.toml", train=paths[:3], validate=paths[3:])
    if not delay:
        assert found.verdict == "nothing_missing"
        return
    assert found.verdict == "explained"
    (named,) = found.added
    assert named["effect"] == "controller_delay"
    assert not named["confusable_with"]
    estimate = named["parameters"]["n_compute_pan"]
    low, high = estimate["ci95"]
    assert low <= delay <= high
    assert estimate["value"] == pytest.approx(delay, abs=0.05)
