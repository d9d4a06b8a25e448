"""`ptp-symbolic new --from`: a file that loads as it is, says what is lost, and nothing else."""

import json
import re
import tomllib
from pathlib import Path

import pytest
from click.testing import CliRunner

import ptp_symbolic as ptp
from ptp_symbolic.cli.commands import commands
from ptp_symbolic.errors import InputError
from ptp_symbolic.models.emission import possible_equations
from tests.robots.texts import HEAD, TURRET

HOSTILE = "&quot;]&#10;[platform]&#10;name='x'\\}{%$#&amp;&lt;!--\N{RIGHT-TO-LEFT OVERRIDE}"


def run(*arguments: str) -> str:
    """What the command prints; raises what it refuses."""
    result = CliRunner().invoke(commands, arguments)
    if result.exception is not None and not isinstance(result.exception, SystemExit):
        raise result.exception
    assert result.exit_code == 0, result.output
    return result.output


def new_from(folder: Path, text: str, *arguments: str) -> tuple[Path, str]:
    robot = folder / ("robot.urdf" if "<robot" in text else "model.xml")
    robot.write_text(text, encoding="utf-8")
    file = folder / "turret.toml"
    return file, run("new", str(file), "--from", str(robot), *arguments)


def test_the_file_is_read_as_it_is_and_says_what_is_lost(tmp_path: Path) -> None:
    file, printed = new_from(tmp_path, HEAD, "--pan", "pan", "--tilt", "tilt")
    platform = ptp.read_platform(file)
    assert (platform.name, platform.axes) == ("turret", ("pan", "tilt"))
    assert [i.name for i in possible_equations(platform).inputs] == ["tau_pan", "tau_tilt"]
    head = file.read_text("utf-8").partition("[platform]")[0]
    for said in ("gear 20 of motor 'turn', line 41", "<general> 'nod', line 42", "line 17"):
        assert said in printed and said in head
    (robot,) = tmp_path.glob("model.xml")
    again = ptp.read_robot(robot, pan="pan", tilt="tilt", name="turret")
    assert again.text == file.read_text("utf-8")
    assert ptp.read_platform(file).parameters == again.platform.parameters


def test_the_schema_takes_the_file(tmp_path: Path) -> None:
    jsonschema = pytest.importorskip("jsonschema", reason="jsonschema is of the extra `test`")
    file, _ = new_from(tmp_path, TURRET, "--pan", "yaw", "--tilt", "pitch")
    schema = json.loads((tmp_path / "platform.schema.json").read_text("utf-8"))
    document = tomllib.loads(file.read_text("utf-8"))
    assert list(jsonschema.Draft7Validator(schema).iter_errors(document)) == []


def test_names_of_a_robot_cannot_enter_the_file(tmp_path: Path) -> None:
    text = TURRET
    for name in ("turret", "cradle", "pitch", "camera"):
        text = text.replace(f'"{name}"', f'"{name}{HOSTILE}"')
    (tmp_path / "plain").mkdir()
    plain, _ = new_from(tmp_path / "plain", TURRET, "--pan", "yaw", "--tilt", "pitch")
    pitch = "pitch\"]\n[platform]\nname='x'\\}{%$#&<!--\N{RIGHT-TO-LEFT OVERRIDE}"
    file, printed = new_from(tmp_path, text, "--pan", "yaw", "--tilt", pitch)
    assert "\N{RIGHT-TO-LEFT OVERRIDE}" not in printed + file.read_text("utf-8")
    found, expected = (tomllib.loads(f.read_text("utf-8")) for f in (file, plain))
    assert "title" in found["platform"]
    found["platform"].pop("title"), expected["platform"].pop("title")
    assert found == expected


def test_attributes_of_a_model_cannot_enter_the_file(tmp_path: Path) -> None:
    text = HEAD.replace('ref="5"', 'springdamper="1&#10;[evil]&#10;a=1" actuatorfrcrange="&#x85;"')
    file, printed = new_from(tmp_path, text, "--pan", "pan", "--tilt", "tilt")
    assert "springdamper = '1\\n[evil]\\na=1'" in printed
    assert "evil" not in tomllib.loads(file.read_text("utf-8"))


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("--pan", "yaw", "--tilt", "camera_mount"), "Unknown tilt joint"),
        ((), "name the joint of the pan axis with"),
        (("--pan", "yaw", "--tilt", "pitch", "--machine", "pan"), "a robot has its own"),
    ],
)
def test_what_is_refused_leaves_nothing(
    arguments: tuple[str, ...], message: str, tmp_path: Path
) -> None:
    with pytest.raises(InputError, match=message):
        new_from(tmp_path, TURRET, *arguments)
    assert [path.name for path in tmp_path.iterdir()] == ["robot.urdf"]


def test_joints_without_a_robot_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="name joints of a robot; add --from"):
        run("new", str(tmp_path / "a.toml"), "--pan", "yaw")
    with pytest.raises(InputError, match="no such file; give the path of a URDF or MJCF file"):
        run("new", str(tmp_path / "a.toml"), "--from", str(tmp_path / "b.urdf"), "--pan", "yaw")
    assert list(tmp_path.iterdir()) == []


BILLION = '<!DOCTYPE r [<!ENTITY a "ha"><!ENTITY b "&a;&a;&a;">]><robot name="&b;"/>'
OUTSIDE = '<!DOCTYPE r [<!ENTITY a SYSTEM "file:///etc/passwd">]><robot name="&a;"/>'
DEEP = "<robot>" + "<a>" * 5000 + "</a>" * 5000 + "</robot>"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (BILLION, "has a document type or entities"),
        (OUTSIDE, "has a document type or entities"),
        (DEEP, "is more than 100 elements deep"),
        ("<robot/>", "one link without a joint before it, its base; here are: none"),
        ("<sdf/>", r":1: <sdf>: is neither <robot> \(URDF\) nor <mujoco>"),
        ("<mujoco", ":1: is not XML"),
        ("", "is not XML"),
        ("<mujoco><compiler angle='grad'/></mujoco>", "'grad' is not one of degree, radian"),
        ("<mujoco/>", "Unknown pan joint 'yaw'. There is none here"),
    ],
)
def test_damaged_files_are_refused_in_a_line(text: str, message: str, tmp_path: Path) -> None:
    file = tmp_path / "robot.urdf"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=message) as refused:
        ptp.read_robot(file, pan="yaw", tilt="pitch")
    assert "\n" not in str(refused.value) and len(str(refused.value)) < 400


def test_a_file_cut_anywhere_is_refused_in_a_line(tmp_path: Path) -> None:
    """Half a file, as a full disk or a broken download leaves it."""
    file = tmp_path / "robot.urdf"
    for text in (TURRET, HEAD):
        for end in range(0, len(text) - 12, 97):
            file.write_text(text[:end], encoding="utf-8")
            with pytest.raises(InputError, match=re.escape(str(file))):
                ptp.read_robot(file, pan="yaw", tilt="pitch")
