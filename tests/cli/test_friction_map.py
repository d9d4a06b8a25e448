"""`friction-map` at the command line: from a CSV to a fragment that a platform file takes."""

import json
from pathlib import Path

import numpy as np
import pytest

from ptp_symbolic.numeric.friction_map.summary import LARGEST_DIFFERENCE
from ptp_symbolic.platform import read_platform
from ptp_symbolic.symbolic.effects.direction_dependent_friction import PARAMETERS
from tests.friction_map.laws import RATES, Side, drawn, torque

HEAD = '[platform]\nname = "t"\ntitle = "t"\naxes = ["pan"]\n[[effects]]\neffect = "rigid_bodies"\n'
DIFFERENT = (Side(0.33, 0.33, 0.3, 0.0), Side(0.27, 0.27, 0.3, 0.0))
PUSHED = (Side(0.8, 0.8, 0.3, 0.0), Side(-0.2, -0.2, 0.3, 0.0))


def written(path: Path, sides: tuple[Side, Side]) -> Path:
    points = drawn(0, *sides, scatter=0.005)
    rows = np.column_stack([np.degrees(points.rate), 1e3 * points.torque])
    header = "rate [deg/s],torque [mN m]"
    np.savetxt(path, rows, delimiter=",", header=header, comments="", fmt="%.9g")
    return path


def test_the_fragment_is_read_as_part_of_a_platform(call, tmp_path: Path) -> None:
    points, out = written(tmp_path / "p.csv", DIFFERENT), tmp_path / "out"
    done = call("friction-map", points, "--out", out)
    assert (done.code, done.err) == (0, "")
    assert "p.csv: Coulomb; Coulomb by direction" in done.out
    assert {file.name for file in out.iterdir()} == {
        "friction.toml",
        "friction.png",
        "friction.json",
    }
    assert (out / "friction.png").read_bytes().startswith(b"\x89PNG")
    platform = tmp_path / "platform.toml"
    platform.write_text(HEAD + (out / "friction.toml").read_text(encoding="utf-8"))
    read = read_platform(platform)
    effects = [effect.effect for effect in read.effects]
    assert effects == ["rigid_bodies", "csvs_friction", "direction_dependent_friction"]
    values = {p.name: p.value for p in read.parameters}
    assert values["F_c_pan"] == pytest.approx(0.3, abs=0.005)
    assert values["F_s_pan"] == values["F_c_pan"]
    assert values["a_F_c_pan"] == pytest.approx(0.1, abs=0.02)
    assert values["a_F_s_pan"] == values["a_F_c_pan"]


def test_a_torque_that_pushes_both_ways_is_a_constant_torque(call, tmp_path: Path) -> None:
    out = tmp_path / "out"
    call("friction-map", written(tmp_path / "p.csv", PUSHED), "--out", out)
    platform = tmp_path / "platform.toml"
    platform.write_text(HEAD + (out / "friction.toml").read_text(encoding="utf-8"))
    values = {p.name: p.value for p in read_platform(platform).parameters}
    assert values["F_c_pan"] == pytest.approx(0.3, abs=0.01)
    assert values["tau0_pan"] == pytest.approx(-0.5, abs=0.01)


def test_a_constant_torque_leaves_the_other_differences(call, tmp_path: Path) -> None:
    sides = (Side(0.8, 0.8, 0.3, 0.06), Side(-0.2, -0.2, 0.3, 0.04))
    out = tmp_path / "out"
    call("friction-map", written(tmp_path / "p.csv", sides), "--out", out)
    platform = tmp_path / "platform.toml"
    platform.write_text(HEAD + (out / "friction.toml").read_text(encoding="utf-8"))
    values = {p.name: p.value for p in read_platform(platform).parameters}
    assert "a_F_c_pan" not in values
    assert values["tau0_pan"] == pytest.approx(-0.5, abs=0.01)
    assert values["a_F_v_pan"] == pytest.approx(0.2, abs=0.05)


def test_the_largest_difference_is_the_bound_of_its_effect() -> None:
    assert {p.upper for p in PARAMETERS} == {LARGEST_DIFFERENCE}


def test_json_is_what_the_file_holds(call, tmp_path: Path) -> None:
    points, out = written(tmp_path / "p.csv", DIFFERENT), tmp_path / "out"
    done = call("friction-map", points, "--axis", "tilt", "--json", "--out", out)
    printed = json.loads(done.out)
    assert printed == json.loads((out / "friction.json").read_text(encoding="utf-8"))
    assert set(printed["parameters"]) == {"F_c_tilt", "a_F_c_tilt"}


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("--platform", "thesis-pan-drive", "--axis", "tilt"), "has pan; give one of these"),
        (("--confidence", "95"), "--confidence 95: give at least 0.5"),
        (("--spread", "std"), "Unknown column 'std'"),
    ],
)
def test_refusals_write_nothing(
    arguments: tuple[str, ...], message: str, call, tmp_path: Path
) -> None:
    out = tmp_path / "out"
    points = written(tmp_path / "p.csv", DIFFERENT)
    done = call("friction-map", points, *arguments, "--out", out)
    assert done.code == 2 and message in done.err and done.err.count("\n") == 1
    assert not out.exists()


def carriage_points(path: Path, heading: str = "force [N]", scale: float = 1.0) -> Path:
    """20 N of Coulomb friction, 35 N static, 15 mm/s of Stribeck speed, 240 N s/m, both ways."""
    side = Side(20.0, 35.0, 0.015, 240.0)
    rates = 0.02 * RATES  # m/s
    forces = torque(rates, side, side) + 0.2 * np.random.default_rng(3).standard_normal(len(rates))
    rows = np.column_stack([1e3 * rates, forces / scale])
    np.savetxt(path, rows, delimiter=",", header=f"rate [mm/s],{heading}", comments="", fmt="%.9g")
    return path


@pytest.mark.parametrize(("heading", "scale"), [("force [N]", 1.0), ("force [% of 60 N]", 0.6)])
def test_points_of_a_linear_axis_are_in_newtons(
    heading: str, scale: float, call, tmp_path: Path
) -> None:
    points, out = carriage_points(tmp_path / "p.csv", heading, scale), tmp_path / "out"
    done = call("friction-map", points, "--torque", "force", "--out", out)
    assert (done.code, done.err) == (0, "")
    assert "this law 0.2" in done.out and " N\n" in done.out
    summary = json.loads((out / "friction.json").read_text(encoding="utf-8"))
    found = summary["parameters"]
    for name, value, unit in (
        ("F_c_pan", 20.0, "N"),
        ("F_s_pan", 35.0, "N"),
        ("v_s_pan", 0.015, "m/s"),
        ("F_v_pan", 240.0, "N s/m"),
    ):
        assert found[name]["unit"] == unit
        assert found[name]["low"] < value < found[name]["high"]
    platform = tmp_path / "platform.toml"
    linear = HEAD.replace('axes = ["pan"]', 'axes = ["pan"]\njoints = { pan = "linear" }')
    platform.write_text(linear + (out / "friction.toml").read_text(encoding="utf-8"))
    values = {p.name: p.value for p in read_platform(platform).parameters}
    assert values["F_v_pan"] == pytest.approx(240.0, rel=0.02)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((), "Unknown column 'torque'. Choose one of: rate, force; say by --torque which one"),
        (("--torque", "force", "--platform", "thesis-pan-drive"), "moves in rad/s; give points"),
    ],
)
def test_points_of_a_linear_axis_are_not_mistaken(
    arguments: tuple[str, ...], message: str, call, tmp_path: Path
) -> None:
    done = call("friction-map", carriage_points(tmp_path / "p.csv"), *arguments)
    assert done.code == 2 and message in done.err and done.err.count("\n") == 1


def test_a_linear_axis_has_no_newton_metres(call, tmp_path: Path) -> None:
    points = carriage_points(tmp_path / "p.csv", "force [N m]")
    done = call("friction-map", points, "--torque", "force")
    assert done.code == 2 and "column 'force' is in N m; give N, or one of mN" in done.err


def test_steady_points_given_as_a_log_are_sent_here(call, tmp_path: Path) -> None:
    points = written(tmp_path / "p.csv", DIFFERENT)
    done = call("fit", points, "--platform", "thesis-ideal", "--out", tmp_path / "out")
    assert done.code == 2 and not (tmp_path / "out").exists()
    assert "p.csv:1: column 'time [s]' is missing; the header has rate [deg/s], " in done.err
    assert "steady points of rate and torque are for friction-map" in done.err
