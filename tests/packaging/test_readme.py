"""What the README shows works as it stands there."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

from ptp_symbolic.effects import EFFECTS
from ptp_symbolic.platform import read_platform

COMMANDS = (
    "platforms",
    "models",
    "effects",
    "regenerate",
    "simulate",
    "sensitivity",
    "fit",
    "diagnose",
    "report derivation",
)


@pytest.fixture(scope="module")
def readme(checkout: Path) -> str:
    """The text of the README."""
    return (checkout / "README.md").read_text(encoding="utf-8")


def block(readme: str, language: str) -> str:
    """The one fenced block of a language."""
    (found,) = re.findall(rf"^```{language}\n(.*?)^```", readme, re.MULTILINE | re.DOTALL)
    return str(found)


def test_the_example_platform_is_accepted(readme: str, tmp_path: Path) -> None:
    file = tmp_path / "turret.toml"
    file.write_text(block(readme, "toml"), encoding="utf-8")
    platform = read_platform(file)
    values = {parameter.name: parameter.value for parameter in platform.parameters}
    assert values == pytest.approx({"m_payload": 4.992, "c_x_payload": 0.1, "F_c_pan": 0.2})
    assert [parameter.name for parameter in platform.parameters if parameter.free] == ["F_c_pan"]


def test_the_python_example_runs(readme: str, tmp_path: Path) -> None:
    program = block(readme, "python") + "print(dx.shape, np.isfinite(dx).all())\n"
    command = [sys.executable, "-c", program]
    ran = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    assert (ran.stdout, ran.stderr) == ("(4,) True\n", "")


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
