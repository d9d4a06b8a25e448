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


def test_what_logs_hold_and_can_show(call, table: tuple[Path, Path], tmp_path: Path) -> None:
    out = tmp_path / "out"
    done = call("check", "--platform", table[0], table[1], "--out", out)
    assert done.code == 0 and not re.sub(r"(?m)^\[ *\d+\.\d s\] .+\n", "", done.err)
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
