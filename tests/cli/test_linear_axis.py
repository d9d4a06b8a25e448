"""A linear axis at the command line: logs in mm and N, fits in kg, errors in counts of a scale."""

import json
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.independent.carriage import (
    COULOMB,
    COUNTS,
    FORCE,
    MACHINE,
    MASS,
    POSITION,
    force_at,
    truth,
)

Call = Callable[..., Any]


def write(path: Path, text: str) -> Path:
    path.write_text(text)
    return path


def test_what_is_read_and_written_is_in_metres_and_newtons(call: Call, tmp_path: Path) -> None:
    platform = write(tmp_path / "carriage.toml", MACHINE + FORCE + POSITION)
    drive = "tau_pan=sweep:80@0.3..1"
    done = call("simulate", "--platform", platform, "--input", drive, "--out", tmp_path / "out")
    assert done.code == 0, done.err
    head = (tmp_path / "out" / "trajectory.csv").read_text().splitlines()[0].split(",")
    named = ["theta_pan [m]", "omega_pan [m/s]", "force [N]", "position [m]"]
    assert set(named) <= set(head), head


def test_a_fit_finds_the_mass_and_gives_errors_in_counts(call: Call, tmp_path: Path) -> None:
    """A log of the truth, in mm, counted; mass and friction are free."""
    times = np.arange(0.0, 3.0, 1e-3)
    position = np.round(truth(times, motor=False)[:, 0] * COUNTS) / COUNTS
    force = np.array([force_at(t + 0.5e-3) for t in times])  # held over the next millisecond
    rows = [
        f"{t:.4f},{f:.12g},{1e3 * x:.9g}" for t, f, x in zip(times, force, position, strict=True)
    ]
    log = write(tmp_path / "log.csv", "\n".join(["time [s],force [N],position [mm]", *rows, ""]))
    free = MACHINE.replace(f"m_pan = {{ value = {1e3 * MASS}", "m_pan = { start = 9000.0")
    free = free.replace(f"F_c_pan = {{ value = {COULOMB}", "F_c_pan = { start = 4.0")
    platform = write(tmp_path / "carriage.toml", free + FORCE + POSITION)
    done = call("fit", "--platform", platform, log, "--out", tmp_path / "out")
    assert done.code == 0, done.err
    assert "counts rms" in done.out
    fit = json.loads((tmp_path / "out" / "fit.json").read_text())
    mass, friction = (fit["parameters"][name] for name in ("m_pan", "F_c_pan"))
    assert (mass["unit"], friction["unit"]) == ("kg", "N")
    assert mass["value"] == pytest.approx(MASS, rel=1e-3)
    assert friction["value"] == pytest.approx(COULOMB, rel=5e-3)
    assert fit["error"]["after"]["total"]["rmse_counts"] < 1.0
    written = tomllib.loads((tmp_path / "out" / "platform.toml").read_text())
    assert written["platform"]["joints"] == {"pan": "linear"}
    assert written["signals"]["theta_pan"]["counts_per_metre"] == COUNTS


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('unit = "g"', 'unit = "kg m^2"', "'m_pan' has unit 'kg m^2'; give it in 'kg'"),
        (
            'unit = "N/mm"',
            'unit = "N m/rad"',
            "'k1_cable_pan' has unit 'N m/rad'",
        ),
        ('unit = "mm"\ncounts_per_metre = 2000000.0', 'unit = "rad"', "declared in 'rad', but"),
        ("counts_per_metre = 2000000.0", "counts_per_revolution = 7200", "write counts_per_metre"),
        (
            'axes = ["pan"]',
            'axes = ["pan", "tilt"]',
            "is the only one of its platform",
        ),
        ('pan = "linear"', 'pan = "prismatic"', "is not one of rotary, linear"),
        ('pan = "linear"', 'tilt = "linear"', "unknown key 'tilt'"),
        ('"cable_spring"\naxis = "pan"', '"base_tilt"', "declare constant_torque"),
        ("m_pan", "J_pan", "'J_pan' belongs to no declared effect"),
    ],
)
def test_what_does_not_fit_a_linear_joint_is_refused(
    call: Call, old: str, new: str, said: str, tmp_path: Path
) -> None:
    whole = MACHINE + FORCE + POSITION
    assert old in whole
    platform = write(tmp_path / "carriage.toml", whole.replace(old, new))
    done = call("simulate", "--platform", platform, "--out", tmp_path / "out")
    assert done.code == 2
    assert said in done.err
    assert done.err.count("\n") == 1
