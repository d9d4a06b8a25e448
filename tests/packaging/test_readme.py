"""What the README shows works as it stands there."""

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest

from ptp_symbolic.platform import read_platform
from ptp_symbolic.report.diagnosis import VERDICTS
from ptp_symbolic.symbolic.derivation.admissible import refuse_impossible
from ptp_symbolic.symbolic.derivation.assembly import assemble
from ptp_symbolic.symbolic.derivation.placement import undeclared_parameters
from ptp_symbolic.symbolic.effects import PACKAGED
from tests.documentation.pages import Reader, blocks, command_lines, in_a_shell

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


def section(readme: str, title: str) -> str:
    """The text below a heading, up to the next."""
    found = re.search(rf"^## {title}\n(.*?)(?=^## |\Z)", readme, re.MULTILINE | re.DOTALL)
    assert found
    return found[1]


def test_it_is_read_at_once(readme: str) -> None:
    lines = readme.splitlines()
    assert len(lines) <= 150
    assert any("`diagnose`" in line for line in lines[:8])
    assert max(map(len, lines)) <= 356


def test_its_two_commands_exist(readme: str, checkout: Path) -> None:
    (block,) = (b for b in blocks(section(readme, "Two commands")) if b.language == "sh")
    commands = list(command_lines(block.text))
    assert commands == [["python3", "scripts/demo.py"], ["python3", "scripts/test.py"]]
    for _, script in commands:
        compile((checkout / script).read_text(encoding="utf-8"), script, "exec")
    ran = subprocess.run([sys.executable, checkout / "scripts/demo.py", "--help"], check=True)
    assert ran.returncode == 0
    assert "python3 scripts/test.py" in (checkout / ".ci" / "run").read_text(encoding="utf-8")


def test_the_example_platform_is_accepted(readme: str, tmp_path: Path) -> None:
    (block,) = (b for b in blocks(readme) if b.language == "toml")
    file = tmp_path / "turret.toml"
    file.write_text(block.text, encoding="utf-8")
    platform = read_platform(file)
    assert {p.name: p.value for p in platform.parameters} == {"J_pan": 0.03, "b_pan": 0.1}
    assert all(parameter.free for parameter in platform.parameters)
    assert undeclared_parameters(platform) == ()
    refuse_impossible(assemble(platform), platform)
    assert len(block.text.splitlines()) <= 14


@pytest.mark.long
def test_a_log_is_made_checked_diagnosed_and_fitted_as_shown(
    readme: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """All blocks of the two sections, as one would paste them into a shell and into Python."""
    monkeypatch.chdir(tmp_path)
    reader = Reader(tmp_path, in_a_shell)
    pasted = section(readme, "Your log in five minutes") + section(readme, "In Python")
    for block in blocks(pasted):
        reader.paste(block)
    assert reader.done == len(blocks(readme)) - 2  # the two commands, and what the demo prints
    found = json.loads((tmp_path / "out" / "diagnosis.json").read_text(encoding="utf-8"))
    (spring,) = found["added"]
    assert (spring["effect"], spring["axis"]) == ("cable_spring", "pan")
    assert spring["parameters"]["k1_cable_pan"]["value"] == pytest.approx(0.5, rel=1e-4)
    values = {n: p["value"] for n, p in found["fit"]["after"]["parameters"].items()}
    assert values["J_pan"] == pytest.approx(0.025, rel=1e-4)
    assert values["b_pan"] == pytest.approx(0.12, rel=1e-4)
    for name in ("report.html", "platform.toml", "equations.tex", "turret.py"):
        assert (tmp_path / "out" / name).is_file()


def test_the_verdicts_are_those_of_the_program(readme: str) -> None:
    rows = re.findall(r"^\| `(\w+)` \|", section(readme, "The five verdicts"), re.MULTILINE)
    assert rows == ["verdict", *VERDICTS]


def test_the_picture_is_small_and_of_the_size_of_a_page(readme: str, checkout: Path) -> None:
    (name,) = re.findall(r"!\[[^\]]+\]\(([\w./]+)\)", readme)
    data = (checkout / name).read_bytes()
    assert data.startswith(b"\x89PNG") and len(data) < 150_000
    assert int.from_bytes(data[16:20], "big") == 1000  # pixels wide


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_explains_itself(command: str, readme: str, tmp_path: Path) -> None:
    assert re.search(rf"\b{command}\b", readme)
    program = "from ptp_symbolic.cli import main; main()"
    arguments = [sys.executable, "-c", program, *command.split(), "--help"]
    ran = subprocess.run(arguments, cwd=tmp_path, capture_output=True, text=True)
    assert ran.returncode == 0, ran.stderr
    assert "Usage:" in ran.stdout


def test_it_names_every_effect_as_searched_or_declared(readme: str) -> None:
    rows = section(readme, "What it can name").splitlines()
    named = {row: set(re.findall(r"`(\w+)`", row)) for row in rows if row.startswith("|")}
    (declared,) = (names for row, names in named.items() if row.startswith("| declared only"))
    searched = set().union(*named.values()) - declared
    assert searched == {e.id for e in PACKAGED if e.searched or e.structure}
    assert declared == {e.id for e in PACKAGED if not (e.searched or e.structure)}


def test_the_files_it_names_exist(readme: str, checkout: Path) -> None:
    mentioned = re.findall(r"`((?:scripts|tests|ptp_symbolic|\.ci)/[\w./]*)`", readme)
    mentioned += re.findall(r"\]\(([\w./-]+)\)", readme)
    assert len(mentioned) >= 5
    assert [name for name in mentioned if not (checkout / name).exists()] == []
