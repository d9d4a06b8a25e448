"""`friction-map` at the command line: from a CSV to a fragment that a platform file takes."""

import json
from pathlib import Path

import numpy as np
import pytest

from ptp_symbolic.numeric.friction_map.summary import LARGEST_DIFFERENCE
from ptp_symbolic.platform import read_platform
from ptp_symbolic.symbolic.effects.direction_dependent_friction import PARAMETERS
from tests.friction_map.laws import Side, drawn

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
