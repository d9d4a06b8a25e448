"""A small torque on the load holds a gear on one face of its gap: the gap is found beside it, in
logs that are integrated by the classical Runge-Kutta method.
"""

from collections.abc import Iterator
from concurrent.futures import Executor
from pathlib import Path

import numpy as np
import pytest
from numba import njit
from numpy.typing import NDArray

from ptp_symbolic.models.structures import Rebuilt, structures
from ptp_symbolic.numeric.data import log_files, read_logs
from ptp_symbolic.numeric.identify.evidence import Allowance
from ptp_symbolic.platform import read_platform
from ptp_symbolic.workflows.preparation import workers
from ptp_symbolic.workflows.structure_fits import Logs, fit_structures, leading_platform
from tests.diagnose.motor_on_shaft import write_log

R, L, K_T, J_MOTOR, RATIO = 3.0, 4e-3, 0.06, 4e-6, 100.0
J_LOAD, VISCOUS, GAP, STIFFNESS, DAMPING, COULOMB = 0.05, 0.2, 0.03, 2e3, 5.0, 0.4
PERIOD, STEPS, SMOOTH, COUNT = 5e-3, 200, 1e-3, 2.0 * np.pi / 36000
LEANING = -0.05  # N m

PLATFORM = f"""
[platform]
name = "leaning"
axes = ["pan"]
[[effects]]
effect = "rigid_bodies"
[[effects]]
effect = "viscous_friction"
axis = "pan"
[[effects]]
effect = "csvs_friction"
axis = "pan"
site = "gear"
[[effects]]
effect = "dc_motor"
axis = "pan"
[parameters]
L_pan = {{ value = {L}, unit = "H" }}
R_pan = {{ value = {R}, unit = "ohm" }}
K_t_pan = {{ value = {K_T}, unit = "N m/A" }}
J_motor_pan = {{ value = {J_MOTOR}, unit = "kg m^2" }}
N_pan = {{ value = {RATIO}, unit = "1" }}
J_pan = {{ start = 0.07, unit = "kg m^2", bounds = [0.005, 1.0] }}
b_pan = {{ start = 0.5, unit = "N m s/rad", bounds = [0.0, 20.0] }}
F_c_pan = {{ start = 1.0, unit = "N m", bounds = [0.0, 20.0] }}
F_s_pan = {{ start = 1.0, unit = "N m", bounds = [0.0, 20.0] }}
v_s_pan = {{ value = 0.05, unit = "rad/s" }}
F_v_pan = {{ value = 0.0, unit = "N m s/rad" }}
[signals.u_pan]
role = "input"
column = "voltage"
unit = "V"
noise = 0.0
[signals.theta_pan]
role = "output"
column = "angle"
unit = "rad"
counts_per_revolution = 36000
"""


@njit
def slope(y: NDArray[np.float64], u: float, leaning: float) -> NDArray[np.float64]:
    """Rates of load angle and rate, gear angle and rate, and current."""
    load, rate, gear, gear_rate, current = y
    twist = gear - load
    press = 0.0
    if abs(twist) > GAP / 2:
        press = STIFFNESS * (twist - np.sign(twist) * GAP / 2) + DAMPING * (gear_rate - rate)
        press = press if press * twist > 0.0 else 0.0
    friction = COULOMB * np.tanh(gear_rate / SMOOTH)
    return np.array(
        [
            rate,
            (press - VISCOUS * rate + leaning) / J_LOAD,
            gear_rate,
            (RATIO * K_T * current - friction - press) / (J_MOTOR * RATIO**2),
            (u - R * current - K_T * RATIO * gear_rate) / L,
        ]
    )


@njit
def angles(volts: NDArray[np.float64], leaning: float) -> NDArray[np.float64]:
    """The load's angle [k] in rad at every sample of held voltages [k], from rest on a face."""
    h, found = PERIOD / STEPS, np.zeros(len(volts))
    y = np.array([0.0, 0.0, np.sign(-leaning) * GAP / 2, 0.0, 0.0])
    for k in range(len(volts)):
        found[k] = y[0]
        for _ in range(STEPS):
            a = slope(y, volts[k], leaning)
            b = slope(y + 0.5 * h * a, volts[k], leaning)
            c = slope(y + 0.5 * h * b, volts[k], leaning)
            d = slope(y + h * c, volts[k], leaning)
            y = y + h / 6.0 * (a + 2.0 * b + 2.0 * c + d)
    return found


@pytest.fixture(scope="module")
def executor() -> Iterator[Executor]:
    """What fits run in, as long as anything is asked of them."""
    with workers() as own:
        yield own


@pytest.mark.parametrize("leaning", [LEANING, 0.0])
def test_a_torque_that_holds_a_gear_on_a_face_leads_to_its_gap(
    leaning: float, tmp_path: Path, executor: Executor
) -> None:
    (tmp_path / "platform.toml").write_text(PLATFORM, encoding="utf-8")
    for seed in range(3):
        rng = np.random.default_rng(seed)
        volts = np.round(np.repeat(rng.uniform(-3.0, 3.0, 41), 20)[:801], 3)
        shown = COUNT * np.round(angles(volts, leaning) / COUNT)
        write_log(tmp_path / f"run_{seed}.csv", PERIOD, volts, shown)
    platform = read_platform(tmp_path / "platform.toml")
    own = tuple(read_logs(log_files(sorted(tmp_path.glob("*.csv"))), platform))
    logs = Logs(own, own, executor, lambda text: None, Allowance())
    every: list[Rebuilt] = [one for one in structures(platform)[0] if one.beside]
    assert {one.keys[0] for one in every} == {"backlash@pan"}
    fitted = fit_structures(platform, every, logs)
    leading = leading_platform(platform, every, fitted, logs)
    names = [] if leading is None else [e.effect for e in leading.effects]
    assert ("constant_torque" in names) == (leaning != 0.0)
