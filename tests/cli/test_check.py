"""`check` at the command line: what logs hold and can show."""

import json
import re
from pathlib import Path

import numpy as np
import pytest

from tests.diagnose.spring_table import PLATFORM, STIFFNESS, log


@pytest.fixture
def table(tmp_path: Path) -> tuple[Path, Path]:
    """Platform and folder of two logs of a turntable on a spring, which it does not declare."""
    source, logs = tmp_path / "table.toml", tmp_path / "logs"
    source.write_text(PLATFORM)
    logs.mkdir()
    for seed in (1, 2):
        run = log(seed)
        rows = np.column_stack([run.time, run.inputs, run.outputs])
        header = "time [s],torque [N m],angle [rad]"
        np.savetxt(logs / f"run_{seed}.csv", rows, delimiter=",", header=header, comments="")
    return source, logs


def without_phases(text: str) -> str:
    """What stderr says beside the phases that a slow machine is told of."""
    return re.sub(r"(?m)^\[ *\d+\.\d s\] .+\n", "", text)


def test_what_logs_hold_and_can_show(call, table: tuple[Path, Path], tmp_path: Path) -> None:
    out = tmp_path / "out"
    done = call("check", "--platform", table[0], table[1], "--out", out)
    assert done.code == 0 and not without_phases(done.err)
    clock = (
        "run_1: 600 samples over 5.99 s at 100 Hz; evenly sampled, the longest period is 0.01 s."
    )
    assert clock in done.out
    assert "No two runs have the same inputs" in done.out
    summary = json.loads((out / "check.json").read_text(encoding="utf-8"))
    assert [entry["name"] for entry in summary["logs"]] == ["run_1", "run_2"]
    page = (out / "check.html").read_text(encoding="utf-8")
    assert page.count("<svg") == 2
    assert page.count("<h2>run_") == 2
    for row in summary["visible"]:
        assert f"<code>{row['parameter']}</code>" in page
    assert summary["units"] == {"tau_pan": "N m", "theta_pan": "rad"}
    (spring,) = (v for v in summary["visible"] if v["effect"] == "cable_spring@pan")
    assert spring["smallest"] < 0.01 * STIFFNESS
    (line,) = (text for text in done.out.splitlines() if "k1_cable_pan" in text)
    assert line.split() == [
        "cable_spring@pan",
        "k1_cable_pan",
        f"{spring['smallest']:.2g}",
        "N",
        "m/rad",
    ]


def test_logs_that_are_not_there_are_one_line(call, table: tuple[Path, Path]) -> None:
    done = call("check", "--platform", table[0], table[1] / "none.csv")
    assert done.code == 2
    assert done.err.count("\n") == 1
    assert not done.out


LEFT_OUT = """
platform = { name = "turret", title = "Turret", axes = ["pan"], gravity = 1.62 }
effects = [
    { effect = "rigid_bodies" },
    { effect = "csvs_friction", axis = "pan" },
    { effect = "constant_torque", axis = "pan" },
]

[parameters]
J_pan = { start = 0.03, unit = "kg m^2" }
F_c_pan = { value = 0.1, unit = "N m" }
F_s_pan = { same_as = "F_c_pan" }

[signals]
theta_pan = { role = "output", column = "angle", unit = "deg", counts_per_revolution = 65536 }
"""


def test_a_platform_alone_is_checked(call, tmp_path: Path) -> None:
    """Every parameter with where its value comes from, and at the end, with exit code 2, what is
    missing.
    """
    path = tmp_path / "turret.toml"
    path.write_text(LEFT_OUT, encoding="utf-8")
    done = call("check", "--platform", path)
    assert done.code == 2 and without_phases(done.err).count("\n") == 1
    assert "Not declared, and without a natural default: v_s_pan in rad/s" in done.err
    assert "F_v_pan in N m s/rad" in done.err and "tau0_pan" not in done.err
    assert "States: theta_pan [rad], omega_pan [rad/s]." in done.out
    assert "Inputs: tau_pan [N m]." in done.out
    assert "theta_pan [rad] in column 'angle', omega_pan [rad/s]," in done.out
    assert "To read logs, declare under [signals] too: tau_pan." in done.out
    data = json.loads(call("check", "--platform", path, "--json").out)
    assert {p["name"]: (p["value"], p["declared"]) for p in data["parameters"]} == {
        "J_pan": (0.03, "fitted"),
        "F_c_pan": (0.1, "known"),
        "F_s_pan": (0.1, "same as F_c_pan"),
        "v_s_pan": (None, "missing"),
        "F_v_pan": (None, "missing"),
        "tau0_pan": (0.0, "default"),
        "gravity": (1.62, "known"),
    }


def test_a_whole_platform_passes_and_a_wrong_signal_does_not(call, tmp_path: Path) -> None:
    path = tmp_path / "table.toml"
    path.write_text(PLATFORM, encoding="utf-8")
    done = call("check", "--platform", path)
    assert (done.code, without_phases(done.err)) == (0, "")
    path.write_text(PLATFORM.replace("tau_pan", "u_pan"), encoding="utf-8")
    done = call("check", "--platform", path)
    assert done.code == 2
    assert "Unknown input signal 'u_pan': did you mean 'tau_pan'?" in done.err
    done = call("check", "--platform", path, "--out", tmp_path / "out")
    assert done.code == 2 and "--out is for what logs show" in done.err
