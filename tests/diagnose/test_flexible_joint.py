"""A joint that is driven by a torque through a soft gear, and declared rigid: rotor, stiffness and
load are found, whether the encoder sits at the load or at the motor. The logs are integrated here,
by small steps in which dry friction is implicit.
"""

from pathlib import Path

import numpy as np
import pytest

from ptp_symbolic.models.structures import Rebuilt, structures
from ptp_symbolic.numeric.data import log_files, read_logs
from ptp_symbolic.numeric.identify.evidence import Allowance
from ptp_symbolic.platform import read_platform
from ptp_symbolic.workflows.diagnosis import diagnose_platform
from ptp_symbolic.workflows.preparation import workers
from ptp_symbolic.workflows.structure_fits import Logs, fit_structures, in_scale

ROTOR, LOAD, STIFFNESS, DAMPING, COULOMB, VISCOUS = 0.08, 0.25, 140.0, 0.25, 0.4, 0.5
PERIOD, SUBSTEPS, COUNT, DURATION = 5e-3, 200, 2.0 * np.pi / 16384, 6.0
AT = {"load": 1, "motor": 0}  # of the angles of rotor and load the one that the encoder shows
PLATFORM = """
[platform]
name = "joint"
title = "A joint that is declared rigid"
axes = ["pan"]

[[effects]]
effect = "rigid_bodies"
[[effects]]
effect = "csvs_friction"
axis = "pan"

[parameters]
J_pan = { start = 0.2, unit = "kg m^2", bounds = [0.001, 10.0] }
F_c_pan = { start = 0.3, unit = "N m", bounds = [0.0, 10.0] }
F_s_pan = { same_as = "F_c_pan" }
v_s_pan = { value = 0.01, unit = "rad/s" }
F_v_pan = { start = 0.3, unit = "N m s/rad", bounds = [0.0, 10.0] }

[signals]
tau_pan = { role = "input", column = "torque", unit = "N m" }
theta_pan = { role = "output", column = "angle", unit = "rad", counts_per_revolution = 16384 }
"""


def angles(torque: np.ndarray) -> np.ndarray:
    """Angles [n, 2] of rotor and load under torques that are held for a sample."""
    step, found = PERIOD / SUBSTEPS, []
    rotor = load = rotor_rate = load_rate = 0.0
    for held in torque:
        found.append((rotor, load))
        for _ in range(SUBSTEPS):
            shaft = STIFFNESS * (rotor - load) + DAMPING * (rotor_rate - load_rate)
            free = rotor_rate + step * (held - shaft - VISCOUS * rotor_rate) / ROTOR
            stopped = max(abs(free) - step * COULOMB / ROTOR, 0.0)
            rotor_rate = float(np.copysign(stopped, free))
            load_rate += step * shaft / LOAD
            rotor += step * rotor_rate
            load += step * load_rate
    return np.array(found)


def record(folder: Path, side: str, seed: int) -> Path:
    """A log of torques with seven lines from 0.3 to 9.3 Hz, by an encoder on one `side`."""
    rng = np.random.default_rng(seed)
    time = PERIOD * np.arange(round(DURATION / PERIOD) + 1)
    lines = rng.uniform(0.3, 0.5) * np.array([1.0, 2.2, 4.1, 7.3, 11.0, 15.7, 21.0])
    phases = rng.uniform(0.0, 2.0 * np.pi, len(lines))
    waves = np.sin(2.0 * np.pi * np.outer(time, lines) + phases)
    torque = np.round(2.5 * waves.sum(axis=1) / np.sqrt(len(lines)), 3)
    shown = COUNT * np.round(angles(torque)[:, AT[side]] / COUNT)
    path = folder / f"{side}_{seed}.csv"
    table = np.column_stack([time, torque, shown])
    np.savetxt(path, table, delimiter=",", comments="", header="time [s],torque [N m],angle [rad]")
    return path


def with_shaft(every: tuple[Rebuilt, ...], *beside: str) -> Rebuilt:
    keys = tuple(f"{e}@pan" for e in ("shaft_compliance", "rotor_inertia", *beside))
    return next(s for s in every if s.keys == keys and s.notes[0] != "friction at the joint")


@pytest.mark.parametrize("side", ["load", "motor"])
def test_the_side_of_the_encoder_shows(tmp_path: Path, side: str) -> None:
    """From usual starts, a shaft with the encoder on its side leaves noise alone."""
    (tmp_path / "platform.toml").write_text(PLATFORM, encoding="utf-8")
    platform = read_platform(tmp_path / "platform.toml")
    paths = [record(tmp_path, side, seed) for seed in range(4)]
    read = tuple(read_logs(log_files(paths), platform))
    every = in_scale(structures(platform)[0], platform)
    both = [with_shaft(every), with_shaft(every, "motor_encoder")]
    with workers() as executor:
        logs = Logs(read, read, executor, lambda text: None, Allowance())
        (found,) = fit_structures(platform, both, logs).quiet
    assert ("motor_encoder@pan" in found.keys) == (side == "motor")
    true = {"J_rotor_pan": ROTOR, "J_pan": LOAD, "k_shaft_pan": STIFFNESS, "F_c_pan": COULOMB}
    for name, value in true.items():
        assert found.trial.values[name] == pytest.approx(value, rel=0.01), name


@pytest.mark.long
@pytest.mark.parametrize("side", ["load", "motor"])
def test_a_joint_that_is_declared_rigid_is_explained(tmp_path: Path, side: str) -> None:
    (tmp_path / "platform.toml").write_text(PLATFORM, encoding="utf-8")
    train = [record(tmp_path, side, seed) for seed in range(4)]
    found = diagnose_platform(
        read_platform(tmp_path / "platform.toml"), train, [record(tmp_path, side, 9)]
    )
    assert found.summary["verdict"] == "explained"
    added = {a["effect"]: a for a in found.summary["added"]}
    assert list(added) == ["shaft_compliance", "rotor_inertia"]
    assert ("encoder at the motor" in added["shaft_compliance"]["title"]) == (side == "motor")
    assert 'effect = "motor_encoder"' in str(found.files["platform.toml"]) or side == "load"
    lower, upper = added["shaft_compliance"]["parameters"]["k_shaft_pan"]["ci95"]
    assert 0.99 * lower < STIFFNESS < 1.01 * upper
