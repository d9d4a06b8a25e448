"""`experiment` at the command line: an input to play, what it will show, and what is refused."""

import json
import re
import time
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tests.diagnose.spring_table import PLATFORM, log

PHASE = r"(?m)^\[ *\d+\.\d s\] .+\n"
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
    assert done.code == 0 and not re.sub(PHASE, "", done.err)
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
    assert done.code == 0 and not re.sub(PHASE, "", done.err)
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
    # Phases stand above the refusal where deriving takes more than two seconds.
    refusals = [line for line in done.err.splitlines() if not line.startswith("[")]
    assert len(refusals) == 1 and message in refusals[0]
    assert not done.out and not out.exists()


ELEVATION = """[platform]
name = "elevation"
axes = ["tilt"]
[[effects]]
effect = "rigid_bodies"
[[effects]]
effect = "payload"
[[effects]]
effect = "viscous_friction"
axis = "tilt"
[parameters]
J_y_tilt = { value = 0.05 }
m_payload = { value = 2.0 }
c_x_payload = { value = 0.1 }
J_y_payload = { value = 0.0 }
b_tilt = { start = 0.1 }
[signals]
tau_tilt = { role = "input", column = "torque", unit = "N m", noise = 0.001 }
theta_tilt = { role = "output", column = "angle", unit = "rad", counts_per_revolution = 65536 }
"""


def test_a_machine_that_falls_at_rest_is_known_before_any_input_is_tried(
    call, tmp_path: Path
) -> None:
    """The boresight is level at first: the payload falls as a pendulum with a damper, by SciPy."""
    source = tmp_path / "elevation.toml"
    source.write_text(ELEVATION)
    asked = ("--parameter", "b_tilt", "--limit", "tau_tilt=4", "theta_tilt=-20..20deg")
    asked = (*asked, "--duration", 3, "--tries", 60, "--period", 0.01, "--out", tmp_path / "out")
    begun = time.monotonic()
    done = call("experiment", "--platform", source, *asked)
    assert time.monotonic() - begun < 60.0
    assert done.code == 2 and not (tmp_path / "out").exists()

    def fall(t: float, x: list[float]) -> list[float]:
        return [x[1], (2.0 * 9.80665 * 0.1 * np.cos(x[0]) - 0.1 * x[1]) / (0.05 + 2.0 * 0.1**2)]

    def reached(t: float, x: list[float]) -> float:
        return x[0] - np.radians(20.0)

    reached.terminal = True  # type: ignore[attr-defined]
    at = solve_ivp(fall, (0.0, 3.0), [0.0, 0.0], events=reached, rtol=1e-8).t_events[0][0]
    assert f"theta_tilt is past its limit of {np.radians(20):.4g} rad after" in done.err
    (said,) = re.findall(r"rad after (\S+) s", done.err)
    assert float(said) == pytest.approx(at, abs=0.011)  # the next sample
    assert "--limit 'tau_tilt=LOW..HIGH N m'" in done.err
    hanging = ("tau_tilt=0.3", "theta_tilt=70..110deg", "--initial", f"theta_tilt={np.pi / 2}")
    asked = (*asked[:3], *hanging, *asked[5:])
    assert call("experiment", "--platform", source, *asked).code == 0


def test_an_effect_that_the_platform_declares_is_no_rival(
    call, table: tuple[Path, Path], tmp_path: Path
) -> None:
    rivals = ("--between", "viscous_friction@pan", "cable_spring@pan", "--limit", "tau_pan=1")
    done = call("experiment", "--platform", table[0], *rivals, "--out", tmp_path / "out")
    assert done.code == 2
    assert "viscous_friction@pan: " in done.err and "declares it already; give the pl" in done.err


def test_rivals_that_are_one_and_the_same_are_called_so(
    call, table: tuple[Path, Path], tmp_path: Path
) -> None:
    """Mass and lever of a payload enter as one inertia, which the body's own can stand for."""
    same = ("declared_value:m_payload", "declared_value:c_x_payload")
    done = call(
        *("experiment", "--platform", table[0], "--between", *same, "--limit", "tau_pan=0.3"),
        *("--duration", 3, "--period", 0.01, "--tries", 60, "--out", tmp_path / "out"),
    )
    assert done.code == 0 and not re.sub(PHASE, "", done.err)
    (line,) = (text for text in done.out.splitlines() if text.startswith("No input tried"))
    assert "separates them within the limits" in line
    summary = json.loads((tmp_path / "out/experiment.json").read_text(encoding="utf-8"))
    assert summary["separable"] is False
