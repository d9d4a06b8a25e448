"""Dry friction in the bearings of a load, behind a soft shaft that nobody declared: logs tell on
which side of the shaft it sits. Made by the classical Runge-Kutta method of steps so short that a
friction smoothed over 1e-5 rad/s holds the load as a set-valued one does.
"""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from numba import njit
from numpy.typing import NDArray

from ptp_symbolic.models.structures import structures
from ptp_symbolic.numeric.data import log_files, read_logs
from ptp_symbolic.numeric.diagnose.structures import FittedStructure, begin_structure, is_better
from ptp_symbolic.numeric.identify.intervals import estimates
from ptp_symbolic.platform import read_platform
from ptp_symbolic.workflows.preparation import model_of, problem_for, workers

Floats = NDArray[np.float64]

R, L, K_T, J_MOTOR, RATIO = 3.0, 4e-3, 0.06, 4e-6, 100.0
J_LOAD, STIFFNESS, DAMPING = 0.1, 60.0, 0.3
COULOMB, STATIC, STRIBECK, VISCOUS = 1.2, 1.5, 0.05, 0.4
SMOOTH = 1e-5  # rad/s
PERIOD, SUBSTEPS, COUNT = 5e-3, 4000, 2.0 * np.pi / 36000

PLATFORM = f"""
[platform]
name = "bearings"
title = "A motor on a gear, declared rigid"
axes = ["pan"]

[[effects]]
effect = "rigid_bodies"
[[effects]]
effect = "csvs_friction"
axis = "pan"
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
F_c_pan = {{ start = 1.0, unit = "N m", bounds = [0.0, 20.0] }}
F_s_pan = {{ start = 1.0, unit = "N m", bounds = [0.0, 20.0] }}
v_s_pan = {{ start = 0.1, unit = "rad/s", bounds = [0.001, 1.0] }}
F_v_pan = {{ start = 1.0, unit = "N m s/rad", bounds = [0.0, 20.0] }}

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
def slope(y: Floats, u: float, out: Floats) -> None:
    load_rate, gear_rate = y[1], y[3]
    shaft = STIFFNESS * (y[2] - y[0]) + DAMPING * (gear_rate - load_rate)
    dry = COULOMB + (STATIC - COULOMB) * np.exp(-((load_rate / STRIBECK) ** 2))
    friction = dry * np.tanh(load_rate / SMOOTH) + VISCOUS * load_rate
    out[0] = load_rate
    out[1] = (shaft - friction) / J_LOAD
    out[2] = gear_rate
    out[3] = (RATIO * K_T * y[4] - shaft) / (J_MOTOR * RATIO**2)
    out[4] = (u - R * y[4] - K_T * RATIO * gear_rate) / L


@njit
def angles(volts: Floats, twist: float) -> Floats:
    """The load's angle at every sample, from rest with the shaft twisted."""
    h, y, found = PERIOD / SUBSTEPS, np.zeros(5), np.zeros(len(volts))
    y[2] = twist
    a, b, c, d = np.zeros(5), np.zeros(5), np.zeros(5), np.zeros(5)
    for k in range(len(volts)):
        found[k] = y[0]
        for _ in range(SUBSTEPS):
            slope(y, volts[k], a)
            slope(y + 0.5 * h * a, volts[k], b)
            slope(y + 0.5 * h * b, volts[k], c)
            slope(y + h * c, volts[k], d)
            y = y + h / 6.0 * (a + 2.0 * b + 2.0 * c + d)
    return found


def record(path: Path, seed: int) -> None:
    """Four seconds of held voltages, the shaft wound up at first by half of what friction holds."""
    rng = np.random.default_rng(seed)
    volts = np.round(np.repeat(rng.uniform(-3.0, 3.0, 41), 20)[:801], 3)
    shown = COUNT * np.round(angles(volts, (seed - 1) * 0.5 * STATIC / STIFFNESS) / COUNT)
    table = zip(PERIOD * np.arange(801), volts, shown, strict=True)
    rows = "\n".join(f"{t:.3f},{u:.3f},{a:.9f}" for t, u, a in table)
    path.write_text(f"time [s],voltage [V],angle [rad]\n{rows}\n", encoding="utf-8")


@pytest.fixture(scope="module")
def shafts(tmp_path_factory: pytest.TempPathFactory) -> Iterator[list[FittedStructure]]:
    """The two shafts, friction at the gear and behind it, fitted to the logs."""
    folder = tmp_path_factory.mktemp("bearings")
    (folder / "platform.toml").write_text(PLATFORM, encoding="utf-8")
    paths = [folder / f"run_{k}.csv" for k in range(3)]
    for seed, path in enumerate(paths):
        record(path, seed)
    platform = read_platform(folder / "platform.toml")
    logs = read_logs(log_files(paths), platform)
    found = []
    with workers() as executor:
        for one in structures(platform)[0]:
            if one.keys == ("shaft_compliance@pan",):
                model = model_of(one.platform)
                problem = problem_for(
                    one.platform, model, logs, logs, (), executor, lambda text: None
                )
                begun = begin_structure(one.keys, one.provides, problem, one.starts, {}, one.note)
                found.append(begun.finished())
        yield found


def test_the_logs_tell_on_which_side_of_a_shaft_friction_sits(
    shafts: list[FittedStructure],
) -> None:
    at_gear, behind = shafts
    assert behind.is_noise_alone and not at_gear.is_noise_alone
    assert is_better(behind, at_gear)
    assert behind.added[0].title == f"{at_gear.added[0].title}, friction at the joint"


def test_a_shaft_that_begins_twisted_has_its_true_stiffness_and_friction(
    shafts: list[FittedStructure],
) -> None:
    """The intervals of a strong back EMF are wide: ratios are known better than amounts."""
    own = {e.name: e for e in estimates(shafts[1].trial.fit)}
    true = {"k_shaft_pan": STIFFNESS, "F_c_pan": COULOMB, "F_s_pan": STATIC, "J_pan": J_LOAD}
    for name, value in true.items():
        assert own[name].lower <= value <= own[name].upper, name
        assert own[name].value == pytest.approx(value, rel=0.05), name
