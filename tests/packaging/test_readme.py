"""What the README shows works as it stands there."""

import math
import re
import subprocess
import sys
from pathlib import Path

import pytest

from ptp_symbolic.platform import read_platform
from ptp_symbolic.symbolic.derivation.admissible import refuse_impossible
from ptp_symbolic.symbolic.derivation.assembly import assemble
from ptp_symbolic.symbolic.derivation.placement import undeclared_parameters
from ptp_symbolic.symbolic.effects import EFFECTS

COMMANDS = (
    "platforms",
    "models",
    "effects",
    "regenerate",
    "simulate",
    "sensitivity",
    "fit",
    "diagnose",
    "experiment",
    "report derivation",
)


@pytest.fixture(scope="module")
def readme(checkout: Path) -> str:
    """The text of the README."""
    return (checkout / "README.md").read_text(encoding="utf-8")


def block(readme: str, language: str) -> str:
    """The fenced blocks of a language, one after the other."""
    found = re.findall(rf"^```{language}\n(.*?)^```", readme, re.MULTILINE | re.DOTALL)
    assert found
    return "".join(found)


def test_the_example_platform_is_accepted(readme: str, tmp_path: Path) -> None:
    file = tmp_path / "turret.toml"
    file.write_text(block(readme, "toml"), encoding="utf-8")
    platform = read_platform(file)
    values = {parameter.name: parameter.value for parameter in platform.parameters}
    assert values["m_payload"] == 4.992
    assert values["J_x_payload"] == pytest.approx(5.3e-3)
    assert values["c_x_payload"] == pytest.approx(0.1)
    free = [parameter.name for parameter in platform.parameters if parameter.free]
    assert free == ["F_c_pan", "F_s_pan", "F_v_pan", "b_tilt"]


def test_the_examples_of_raw_signals_are_accepted(readme: str, tmp_path: Path) -> None:
    lines = re.findall(r"^\w+ = \{ role = .*(?:delay|scale).*", readme, re.MULTILINE)
    file = tmp_path / "turret.toml"
    head = '[platform]\nname = "a"\naxes = ["pan"]\n[[effects]]\neffect = "rigid_bodies"\n'
    file.write_text("\n".join([head, "[signals]", *lines]), encoding="utf-8")
    pwm, angle, gyro = read_platform(file).signals
    assert (pwm.scale, pwm.offset) == (0.1875, 128)
    assert angle.scale == pytest.approx(-2 * math.pi / 7200)
    assert (gyro.delay, gyro.offset) == pytest.approx((0.009, math.radians(3.0)))


def test_the_example_platform_declares_all_that_its_effects_need(
    readme: str, tmp_path: Path
) -> None:
    file = tmp_path / "turret.toml"
    file.write_text(block(readme, "toml"), encoding="utf-8")
    platform = read_platform(file)
    assert undeclared_parameters(platform) == ()
    refuse_impossible(assemble(platform), platform)


def test_the_python_example_runs(readme: str, tmp_path: Path) -> None:
    program = block(readme, "python") + "print(dx.shape, np.isfinite(dx).all())\n"
    command = [sys.executable, "-c", program]
    ran = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    assert ran.stderr == ""
    angle, equations = ran.stdout.splitlines()
    assert 0.0 < float(angle) < 10.0
    assert equations == "(4,) True"


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_explains_itself(command: str, readme: str, tmp_path: Path) -> None:
    assert re.search(rf"\b{command}\b", readme)
    program = "from ptp_symbolic.cli import main; main()"
    arguments = [sys.executable, "-c", program, *command.split(), "--help"]
    ran = subprocess.run(arguments, cwd=tmp_path, capture_output=True, text=True)
    assert ran.returncode == 0, ran.stderr
    assert "Usage:" in ran.stdout


def test_the_effects_it_names_exist(readme: str) -> None:
    section = readme.partition("## Effects")[2].partition("To add one")[0]
    named = set(re.findall(r"`(\w+)`", section))
    assert named
    assert named <= {effect.id for effect in EFFECTS}


def test_the_files_it_names_exist(readme: str, checkout: Path) -> None:
    mentioned = re.findall(r"`((?:scripts|tests|ptp_symbolic|\.ci)/[\w./]*)`", readme)
    mentioned += re.findall(r"\]\(([\w./]+)\)", readme)
    assert len(mentioned) >= 5
    assert [name for name in mentioned if not (checkout / name).exists()] == []
