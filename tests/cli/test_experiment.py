"""`experiment` at the command line: an input to play, what it will show, and what is refused."""

import json
from pathlib import Path

import numpy as np
import pytest

from tests.diagnose.spring_table import PLATFORM, log

RIVALS = ("--between", "cable_spring@pan", "quadratic_drag@pan")


@pytest.fixture
def table(tmp_path: Path) -> tuple[Path, Path]:
    """Platform and log of a turntable on a spring, which the platform does not declare."""
    source, run = tmp_path / "table.toml", log(1)
    source.write_text(PLATFORM)
    rows = np.column_stack([run.time, run.inputs, run.outputs])[:300]
    header = "time [s],torque [N m],angle [rad]"
    np.savetxt(tmp_path / "run.csv", rows, delimiter=",", header=header, comments="")
    return source, tmp_path / "run.csv"


def test_an_input_that_separates_and_plays_within_its_limits(
    call, table: tuple[Path, Path], tmp_path: Path
) -> None:
    source, run = table
    out = tmp_path / "out"
    limits = ("--limit", "tau_pan=0.3N m", "theta_pan=-20..30deg", "omega_pan=60deg/s")
    asked = ("--duration", 3, "--tries", 60, "--out", out)
    done = call("experiment", "--platform", source, *RIVALS, "--train", run, *limits, *asked)
    assert (done.code, done.err) == (0, "")
    assert "if it is" in done.out and f"Play {out / 'input.csv'}" in done.out
    summary = json.loads((out / "experiment.json").read_text(encoding="utf-8"))
    pairs = {(p["machine"], p["other"]): p for p in summary["separation"]}
    told = pairs["cable_spring@pan", "quadratic_drag@pan"]
    assert summary["separable"] and told["after"] > told["run"] > 10.0
    (spring,) = (
        row
        for row in summary["parameters"].values()
        if "k1_cable_pan" in row and row["k1_cable_pan"]["sd_before"] is not None
    )
    assert spring["k1_cable_pan"]["sd_after"] < spring["k1_cable_pan"]["sd_before"]
    assert (out / "experiment.png").read_bytes().startswith(b"\x89PNG")
    time, torque = np.loadtxt(out / "input.csv", delimiter=",", skiprows=1).T
    assert np.max(np.abs(torque)) <= 0.3 and time[-1] == pytest.approx(3.0)
    assert np.diff(time) == pytest.approx(0.01)
    played = call(
        "simulate", "--platform", source, "--input", out / "input.csv", "--out", tmp_path / "played"
    )
    assert played.code == 0


def test_a_parameter_is_known_better(call, table: tuple[Path, Path], tmp_path: Path) -> None:
    out = tmp_path / "out"
    done = call(
        *("experiment", "--platform", table[0], "--parameter", "b_pan", "--limit", "tau_pan=0.3"),
        *("--duration", 3, "--period", 0.01, "--tries", 60, "--out", out, "--json"),
    )
    assert (done.code, done.err) == (0, "")
    (rows,) = json.loads(done.out)["parameters"].values()
    assert rows["b_pan"]["sd_before"] is None
    assert 0.0 < rows["b_pan"]["sd_after"] < 0.01 * rows["b_pan"]["value"]


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--limit", "tau_pan=1"), "either --between two effects or more"),
        (("--between", "cogging@pan", "--limit", "tau_pan=1"), "give two effects or more"),
        ((*RIVALS,), "Input tau_pan has no limit"),
        (
            ("--between", "cogging@pan", "wobble", "--limit", "tau_pan=1"),
            "Unknown effect to add 'wobble'",
        ),
        (("--parameter", "k_pan", "--limit", "tau_pan=1"), "Unknown free parameter 'k_pan'"),
        ((*RIVALS, "--limit", "tau_pan=1", "--tries", 3), "--tries 3: give at least 60"),
        ((*RIVALS, "--limit", "tau_pan=1", "--duration", 0.1), "samples of 0.005 s; give 100 to"),
        ((*RIVALS, "--limit", "tau_pan=1", "theta_pan=1..2"), "begins with theta_pan = 0 rad"),
        ((*RIVALS, "--diagnosis", "none", "--limit", "tau_pan=1"), "is no diagnosis"),
    ],
)
def test_what_makes_no_sense_is_one_line(
    call, table: tuple[Path, Path], tmp_path: Path, options: tuple[object, ...], message: str
) -> None:
    out = tmp_path / "out"
    done = call("experiment", "--platform", table[0], *options, "--out", out)
    assert done.code == 2
    assert message in done.err and done.err.count("\n") == 1
    assert not done.out and not out.exists()


def test_rivals_that_are_one_and_the_same_are_called_so(
    call, table: tuple[Path, Path], tmp_path: Path
) -> None:
    """Mass and lever of a payload enter as one inertia, which the body's own can stand for."""
    same = ("declared_value:m_payload", "declared_value:c_x_payload")
    done = call(
        *("experiment", "--platform", table[0], "--between", *same, "--limit", "tau_pan=0.3"),
        *("--duration", 3, "--period", 0.01, "--tries", 60, "--out", tmp_path / "out"),
    )
    assert (done.code, done.err) == (0, "")
    (line,) = (text for text in done.out.splitlines() if text.startswith("No input tried"))
    assert "separates them within the limits" in line
    summary = json.loads((tmp_path / "out/experiment.json").read_text(encoding="utf-8"))
    assert summary["separable"] is False
