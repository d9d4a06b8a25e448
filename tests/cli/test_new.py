"""`ptp-symbolic new`: a platform file that is accepted once its numbers are filled in."""

import json
import re
import tomllib
from pathlib import Path

import pytest
from click.testing import CliRunner

from ptp_symbolic.cli.commands import commands
from ptp_symbolic.errors import InputError
from ptp_symbolic.models.committed import declared_platform
from ptp_symbolic.symbolic.derivation.admissible import refuse_impossible
from ptp_symbolic.symbolic.derivation.assembly import assemble
from ptp_symbolic.symbolic.derivation.placement import undeclared_parameters

WAYS = [(m, d) for m in ("pan-tilt", "pan", "tilt", "linear") for d in ("motor", "torque")]


def run(*arguments: str) -> str:
    """What the command prints; raises what it refuses."""
    result = CliRunner().invoke(commands, arguments)
    if result.exception is not None and not isinstance(result.exception, SystemExit):
        raise result.exception
    return result.output


def made(folder: Path, machine: str, drive: str) -> Path:
    file = folder / "machine.toml"
    run("new", str(file), "--machine", machine, "--drive", drive)
    return file


@pytest.mark.parametrize(("machine", "drive"), WAYS)
def test_what_is_left_open_is_named_and_filled_in_it_is_a_machine(
    machine: str, drive: str, tmp_path: Path
) -> None:
    file = made(tmp_path, machine, drive)
    text = file.read_text("utf-8")
    with pytest.raises(InputError, match=r"nan is no value; give that of \w+, .*F_c_(pan|tilt)"):
        declared_platform(str(file))
    filled = re.sub(r"(counts_per_\w+) = nan", r"\1 = 7200", text)
    filled = filled.replace("start = nan", "start = 0.5").replace("value = nan", "value = 1.5")
    file.write_text(filled, encoding="utf-8")
    platform = declared_platform(str(file))
    equations = assemble(platform)
    refuse_impossible(equations, platform)
    assert undeclared_parameters(platform) == ()
    assert len(platform.axes) == (2 if machine == "pan-tilt" else 1)
    assert bool(platform.linear_axes) == (machine == "linear")
    letter = "u" if drive == "motor" else "tau"
    assert [i.name for i in equations.inputs] == [f"{letter}_{axis}" for axis in platform.axes]
    inputs = [s.signal for s in platform.signals if s.role == "input"]
    assert inputs == [i.name for i in equations.inputs]
    assert all(p.free == p.name.startswith(("F_", "v_s_")) for p in platform.parameters)


@pytest.mark.parametrize("line", ["omega_pan", "i_pan"])
def test_signals_that_are_commented_out_can_be_used(line: str, tmp_path: Path) -> None:
    file = made(tmp_path, "pan", "motor")
    text = file.read_text("utf-8").replace(f"# {line}", line)
    text = re.sub(r"counts_per_revolution = nan", "counts_per_revolution = 7200", text)
    text = text.replace("start = nan", "start = 0.5").replace("= nan", "= 1.5")
    file.write_text(text, encoding="utf-8")
    platform = declared_platform(str(file))
    assert line in {name for name, *_ in assemble(platform).outputs}
    assert [s.noise for s in platform.signals if s.signal == line] == [1.5]


def test_the_schema_lies_beside_and_takes_the_file(tmp_path: Path) -> None:
    jsonschema = pytest.importorskip("jsonschema", reason="jsonschema is of the extra `test`")
    file = made(tmp_path, "linear", "motor")
    first = file.read_text("utf-8").splitlines()[0]
    schema = tmp_path / first.removeprefix("#:schema ")
    validator = jsonschema.Draft7Validator(json.loads(schema.read_text("utf-8")))
    document = tomllib.loads(file.read_text("utf-8").replace("counts_per_metre = nan", "a = 1"))
    assert [e.message for e in validator.iter_errors(document)] == [
        "Additional properties are not allowed ('a' was unexpected)"
    ]


def test_nothing_is_replaced(tmp_path: Path) -> None:
    file = made(tmp_path, "pan", "torque")
    before = file.read_bytes()
    with pytest.raises(InputError, match="is there already; give another name, or remove it"):
        run("new", str(file))
    assert file.read_bytes() == before
    run("new", str(tmp_path / "other.toml"))  # the schema of this program may be written again
    (tmp_path / "platform.schema.json").write_text("{}")
    with pytest.raises(InputError, match="is no schema of this program and would be replaced"):
        run("new", str(tmp_path / "third.toml"))
    assert not (tmp_path / "third.toml").exists()


@pytest.mark.parametrize(
    ("name", "message"),
    [("a.json", "a platform file ends in .toml; write a.toml"), ("2 axes.toml", "is not a name")],
)
def test_a_file_name_that_names_no_model_is_refused(
    name: str, message: str, tmp_path: Path
) -> None:
    with pytest.raises(InputError, match=re.escape(message)):
        run("new", str(tmp_path / name))
    assert list(tmp_path.iterdir()) == []


def test_the_schemas_are_printed() -> None:
    assert json.loads(run("schema", "platform"))["required"] == ["platform", "effects"]
    assert (
        "nothing_missing" in json.loads(run("schema", "diagnosis"))["properties"]["verdict"]["enum"]
    )
