"""An antenna on a gear that is declared rigid and true: its shaft, friction in bearings behind it,
friction by direction and the gear's error are all found, in logs of an integration of their own.
"""

from pathlib import Path

import numpy as np
import pytest

from ptp_symbolic.platform import read_platform
from ptp_symbolic.workflows.diagnosis import diagnose_platform
from tests.diagnose.motor_on_shaft import Machine, angles, write_log

ANTENNA = Machine(
    resistance=1.0,
    inductance=2e-3,
    torque_constant=0.1,
    motor_inertia=4e-4,
    ratio=500.0,
    inertia=60.0,
    stiffness=6e4,
    damping=80.0,
    coulomb=40.0,
    static=52.0,
    stribeck=0.01,
    viscous=60.0,
    asymmetry=0.15,
    error=2e-3,
    phase=0.7,
    smooth=5e-6,
)
PERIOD, SUBSTEPS, SAMPLES, COUNT = 0.01, 8000, 2000, 2.0 * np.pi / 131072
PLATFORM = """
[platform]
name = "antenna"
title = "Antenna on a pan axis"
axes = ["pan"]

[[effects]]
effect = "rigid_bodies"
[[effects]]
effect = "dc_motor"
axis = "pan"
[[effects]]
effect = "csvs_friction"
axis = "pan"

[parameters]
J_pan = { start = 80.0, unit = "kg m^2", bounds = [5.0, 500.0] }
L_pan = { value = 2e-3, unit = "H" }
R_pan = { value = 1.0, unit = "ohm" }
K_t_pan = { value = 0.1, unit = "N m/A" }
N_pan = { value = 500.0, unit = "1" }
J_motor_pan = { value = 4e-4, unit = "kg m^2" }
F_c_pan = { start = 30.0, unit = "N m", bounds = [0.0, 500.0] }
F_s_pan = { start = 40.0, unit = "N m", bounds = [0.0, 500.0] }
v_s_pan = { start = 0.02, unit = "rad/s", bounds = [1e-4, 1.0] }
F_v_pan = { start = 30.0, unit = "N m s/rad", bounds = [0.0, 1000.0] }

[signals]
u_pan = { role = "input", column = "voltage", unit = "V" }
theta_pan = { role = "output", column = "angle", unit = "rad", counts_per_revolution = 131072 }
"""


def record(path: Path, seed: int, kind: int) -> None:
    """Twenty seconds of steps, a chirp with reversals, or a slow wave with steps."""
    rng, time = np.random.default_rng(seed), PERIOD * np.arange(SAMPLES)
    if kind == 0:
        volts = 14.0 * np.repeat(rng.uniform(-1.0, 1.0, 21), 100)[:SAMPLES]
    elif kind == 1:
        chirp = np.sin(2.0 * np.pi * (0.1 + 0.06 * time) * time + rng.uniform(0.0, 6.0))
        volts = 9.0 * chirp + 3.0 * np.sign(np.sin(0.5 * time))
    else:
        wave = np.sin(2.0 * np.pi * 0.08 * time + rng.uniform(0.0, 6.0))
        volts = 10.0 * wave + 4.0 * np.repeat(rng.uniform(-1.0, 1.0, 51), 40)[:SAMPLES]
    volts = np.round(volts, 6)
    start = np.zeros(5)
    start[0] = start[2] = rng.uniform(-1.0, 1.0)
    for _ in range(50):  # the shaft is not twisted
        start[2] = start[0] - ANTENNA.error * np.sin(start[2] + ANTENNA.phase)
    shown = COUNT * np.round(angles(ANTENNA, start, volts, PERIOD, SUBSTEPS) / COUNT)
    write_log(path, PERIOD, volts, shown)


@pytest.mark.long
def test_all_that_a_rigid_gear_lacks_is_named(tmp_path: Path) -> None:
    (tmp_path / "platform.toml").write_text(PLATFORM, encoding="utf-8")
    logs = {"train": range(6), "validate": range(3)}
    for half, runs in logs.items():
        for k in runs:
            record(tmp_path / half / f"run_{k}.csv", (10 if half == "train" else 50) + k, k % 3)
    platform = read_platform(tmp_path / "platform.toml")
    train, validate = (sorted((tmp_path / half).glob("*.csv")) for half in logs)
    summary = diagnose_platform(platform, train, validate).summary
    found = {added["effect"]: added for added in summary["added"]}
    assert set(found) == {"shaft_compliance", "direction_dependent_friction", "gear_eccentricity"}
    assert summary["verdict"] == "explained"
    assert found["shaft_compliance"]["title"].endswith("friction at the joint")
    own = {name: p["value"] for added in found.values() for name, p in added["parameters"].items()}
    assert own["k_shaft_pan"] == pytest.approx(ANTENNA.stiffness, rel=0.05)
    assert own["a_F_c_pan"] == pytest.approx(ANTENNA.asymmetry, rel=0.01)
    assert own["g_sin_pan"] == pytest.approx(ANTENNA.error * np.cos(ANTENNA.phase), rel=0.05)
    assert own["g_cos_pan"] == pytest.approx(ANTENNA.error * np.sin(ANTENNA.phase), rel=0.05)
