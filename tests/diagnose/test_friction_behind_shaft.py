"""Dry friction in the bearings of a load, behind a soft shaft: logs tell on which side of the shaft
it sits, whether somebody declared the shaft or nobody did.
"""

from collections.abc import Iterator
from concurrent.futures import Executor
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from ptp_symbolic.models.structures import structures
from ptp_symbolic.models.variants import with_candidates
from ptp_symbolic.numeric.data import log_files, read_logs
from ptp_symbolic.numeric.diagnose.structures import FittedStructure, begin_structure, is_better
from ptp_symbolic.numeric.identify.intervals import estimates
from ptp_symbolic.platform import (
    EffectDeclaration,
    ParameterDeclaration,
    Platform,
    read_platform,
)
from ptp_symbolic.workflows.preparation import model_of, problem_for, workers
from tests.diagnose.motor_on_shaft import Machine, angles, write_log

MACHINE = Machine(
    resistance=3.0,
    inductance=4e-3,
    torque_constant=0.06,
    motor_inertia=4e-6,
    ratio=100.0,
    inertia=0.1,
    stiffness=60.0,
    damping=0.3,
    coulomb=1.2,
    static=1.5,
    stribeck=0.05,
    viscous=0.4,
    asymmetry=0.0,
    error=0.0,
    phase=0.0,
    smooth=1e-5,
)
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
L_pan = {{ value = {MACHINE.inductance}, unit = "H" }}
R_pan = {{ value = {MACHINE.resistance}, unit = "ohm" }}
K_t_pan = {{ value = {MACHINE.torque_constant}, unit = "N m/A" }}
J_motor_pan = {{ value = {MACHINE.motor_inertia}, unit = "kg m^2" }}
N_pan = {{ value = {MACHINE.ratio}, unit = "1" }}
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


def record(path: Path, seed: int) -> None:
    """Four seconds of held voltages, the shaft wound up at first by half of what friction holds."""
    rng = np.random.default_rng(seed)
    volts = np.round(np.repeat(rng.uniform(-3.0, 3.0, 41), 20)[:801], 3)
    start = np.array([0.0, 0.0, (seed - 1) * 0.5 * MACHINE.static / MACHINE.stiffness, 0.0, 0.0])
    shown = COUNT * np.round(angles(MACHINE, start, volts, PERIOD, SUBSTEPS) / COUNT)
    write_log(path, PERIOD, volts, shown)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The platform, on a rigid gear, and three runs."""
    made = tmp_path_factory.mktemp("bearings")
    (made / "platform.toml").write_text(PLATFORM, encoding="utf-8")
    for seed in range(3):
        record(made / f"run_{seed}.csv", seed)
    return made


@pytest.fixture(scope="module")
def executor() -> Iterator[Executor]:
    """What fits run in, as long as anything is asked of them."""
    with workers() as own:
        yield own


def fitted(platform: Platform, folder: Path, key: str, executor: Executor) -> list[FittedStructure]:
    """The structures with the effect `key` one step away from a platform, fitted to the runs."""
    logs = read_logs(log_files(sorted(folder.glob("*.csv"))), platform)
    found = []
    for one in structures(platform)[0]:
        if one.keys == (key,):
            model = model_of(one.platform)
            problem = problem_for(one.platform, model, logs, logs, (), executor, lambda text: None)
            begun = begin_structure(one.keys, one.provides, problem, one.starts, (), one.notes)
            found.append(begun.finished())
    return found


@pytest.fixture(scope="module")
def shafts(folder: Path, executor: Executor) -> list[FittedStructure]:
    """The two shafts, friction at the gear and behind it, fitted to the runs."""
    platform = read_platform(folder / "platform.toml")
    return fitted(platform, folder, "shaft_compliance@pan", executor)


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
    true = {
        "k_shaft_pan": MACHINE.stiffness,
        "F_c_pan": MACHINE.coulomb,
        "F_s_pan": MACHINE.static,
        "J_pan": MACHINE.inertia,
    }
    for name, value in true.items():
        assert own[name].lower <= value <= own[name].upper, name
        assert own[name].value == pytest.approx(value, rel=0.05), name


def test_a_shaft_begins_twisted_where_a_gap_is_searched_for_beside_it(
    folder: Path, executor: Executor
) -> None:
    """The model that holds all candidates has a gap without width, in which no place is twisted."""
    rigid = read_platform(folder / "platform.toml")
    behind = next(
        one.platform
        for one in structures(rigid)[0]
        if one.keys == ("shaft_compliance@pan",) and one.notes[0].endswith("at the joint")
    )
    logs = read_logs(log_files(sorted(folder.glob("*.csv"))), behind)
    for platform in (behind, with_candidates(behind)):
        model = model_of(platform)
        problem = problem_for(behind, model, logs, logs, (), executor, lambda text: None)
        for run in problem.whole:
            assert "theta_gear_pan" in [unknown.name for unknown in run.unknowns]


def test_friction_is_moved_behind_a_shaft_that_is_declared(
    folder: Path, executor: Executor
) -> None:
    rigid = read_platform(folder / "platform.toml")
    shaft = EffectDeclaration("shaft_compliance", "pan", None)
    own = (
        ParameterDeclaration("k_shaft_pan", "N m/rad", 100.0, free=True),
        ParameterDeclaration("d_shaft_pan", "N m s/rad", 0.3, free=True),
    )
    declared = replace(rigid, effects=(*rigid.effects, shaft), parameters=(*rigid.parameters, *own))
    (moved,) = fitted(declared, folder, "csvs_friction@pan", executor)
    assert moved.is_noise_alone
    known = {e.name: e for e in estimates(moved.trial.fit)}
    for name, value in {"F_c_pan": MACHINE.coulomb, "F_s_pan": MACHINE.static}.items():
        assert known[name].value == pytest.approx(value, rel=0.05), name
