"""A shaft with bristles behind it is found as a pair, in logs that are integrated by hand."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from ptp_symbolic.models.structures import pairs, structures
from ptp_symbolic.models.variants import extended
from ptp_symbolic.numeric.data import log_files, read_logs
from ptp_symbolic.numeric.identify.evidence import Allowance
from ptp_symbolic.platform import read_platform
from ptp_symbolic.workflows.preparation import workers
from ptp_symbolic.workflows.structure_fits import Logs, fit_structures

R, L, K_T, J_MOTOR, RATIO = 3.0, 4e-3, 0.06, 4e-6, 100.0
J_LOAD, STIFFNESS, DAMPING = 0.1, 60.0, 0.3
BRISTLES, LOSS, VISCOUS, COULOMB, STATIC, STRIBECK = 60.0, 1.0, 0.5, 1.5, 1.8, 0.05
PERIOD, STEPS, COUNT = 5e-3, 20, 2.0 * np.pi / 36000

PLATFORM = f"""
[platform]
name = "two_masses"
axes = ["pan"]
[[effects]]
effect = "rigid_bodies"
[[effects]]
effect = "csvs_friction"
axis = "pan"
site = "joint"
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
F_s_pan = {{ start = 1.5, unit = "N m", bounds = [0.0, 20.0] }}
v_s_pan = {{ start = 0.05, unit = "rad/s", bounds = [0.001, 1.0] }}
F_v_pan = {{ start = 1.0, unit = "N m s/rad", bounds = [0.0, 50.0] }}
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


def slope(y: np.ndarray, u: float) -> np.ndarray:
    """Rates of load angle and rate, gear angle and rate, current, bend of the bristles."""
    load, rate, gear, gear_rate, current, bend = y
    shaft = STIFFNESS * (gear - load) + DAMPING * (gear_rate - rate)
    level = COULOMB + (STATIC - COULOMB) * np.exp(-((rate / STRIBECK) ** 2))
    bending = rate - BRISTLES * abs(rate) / level * bend
    friction = BRISTLES * bend + LOSS * bending + VISCOUS * rate
    return np.array(
        [
            rate,
            (shaft - friction) / J_LOAD,
            gear_rate,
            (RATIO * K_T * current - shaft) / (J_MOTOR * RATIO**2),
            (u - R * current - K_T * RATIO * gear_rate) / L,
            bending,
        ]
    )


def record(path: Path, seed: int) -> Path:
    """Four seconds of held voltages, every sample in twenty steps of Runge and Kutta."""
    rng = np.random.default_rng(seed)
    time, h = PERIOD * np.arange(801), PERIOD / STEPS
    size = np.where(np.arange(41) % 3 == 0, 1.0, 8.0)
    volts = np.round(np.repeat(size * rng.uniform(-1.0, 1.0, 41), 20)[:801], 3)
    volts[:5] = 0.0
    y, angle = np.zeros(6), [0.0]
    for u in volts[:-1]:
        for _ in range(STEPS):
            a = slope(y, u)
            b = slope(y + h / 2 * a, u)
            c = slope(y + h / 2 * b, u)
            y = y + h / 6 * (a + 2 * b + 2 * c + slope(y + h * c, u))
        angle.append(y[0])
    shown = COUNT * np.round(np.array(angle) / COUNT)
    table = np.column_stack([time, volts, shown])
    np.savetxt(path, table, delimiter=",", comments="", header="time [s],voltage [V],angle [rad]")
    return path


def test_bristles_are_a_pair_with_the_shaft_that_they_are_behind(tmp_path: Path) -> None:
    (tmp_path / "platform.toml").write_text(PLATFORM, encoding="utf-8")
    every, _ = structures(read_platform(tmp_path / "platform.toml"))
    shaft = next(each for each in every if each.keys == ("shaft_compliance@pan",))
    found = {each.keys: each for each in pairs(shaft)}
    both = found["shaft_compliance@pan", "lugre_friction@pan"]
    assert {e.effect for e in both.removed} == {"csvs_friction"}
    assert {e.effect for e in both.platform.effects} == {
        "rigid_bodies",
        "dc_motor",
        "shaft_compliance",
        "lugre_friction",
    }
    assert shaft.provides < both.provides
    bristles = next(each for each in every if each.keys == ("lugre_friction@pan",))
    assert ("lugre_friction@pan", "shaft_compliance@pan") in {p.keys for p in pairs(bristles)}


def test_bristles_are_found_beside_the_shaft_and_leave_noise_alone(tmp_path: Path) -> None:
    """The shaft alone is soft and leaves a hundred times the noise: it moves on its bristles."""
    (tmp_path / "platform.toml").write_text(PLATFORM, encoding="utf-8")
    platform = read_platform(tmp_path / "platform.toml")
    paths = [record(tmp_path / f"run_{seed}.csv", seed) for seed in range(2)]
    read = tuple(read_logs(log_files(paths), platform))
    shaft = next(s for s in structures(platform)[0] if s.keys == ("shaft_compliance@pan",))
    with workers() as executor:
        logs = Logs(read, read, executor, lambda text: None, Allowance())
        alone = fit_structures(platform, [shaft], logs).every[0]
        assert not alone.is_noise_alone
        there = extended(shaft.platform, (), alone.trial.values, ())
        beside = pairs(replace(shaft, platform=there))
        both = next(each for each in beside if "lugre_friction@pan" in each.keys)
        (found,) = fit_structures(there, [both], logs).quiet
    assert found.keys == ("shaft_compliance@pan", "lugre_friction@pan")
    for name, true in (
        ("k_shaft_pan", STIFFNESS),
        ("sigma0_pan", BRISTLES),
        ("F_c_pan", COULOMB),
        ("J_pan", J_LOAD),
    ):
        assert found.trial.values[name] == pytest.approx(true, rel=0.05), name
