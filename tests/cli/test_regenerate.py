"""Equations of one's own platform as a module."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from ptp_symbolic.numeric.runtime.model import load_module
from ptp_symbolic.platform import platform_text, read_platform


@pytest.fixture
def own(tmp_path: Path) -> Path:
    text = platform_text(read_platform("thesis-ideal")).replace('"ideal"', '"turret"')
    path = tmp_path / "my.toml"
    path.write_text(text, encoding="utf-8")
    return path


def test_a_platform_becomes_a_module_that_loads(call, own: Path, tmp_path: Path) -> None:
    folder = tmp_path / "modules"
    done = call("regenerate", own, "--out", folder)
    assert (done.code, done.err) == (0, "")
    assert done.out == f"written: {folder / 'turret.py'}\n"
    model = load_module(folder / "turret.py", "turret_for_a_test")
    assert model.name == "turret"
    assert np.isfinite(model.rhs(0.0, np.zeros(4), np.zeros(2), model.parameter_vector())).all()


def test_it_can_be_checked_and_comes_out_the_same_again(call, own: Path, tmp_path: Path) -> None:
    folder = tmp_path / "modules"
    assert call("regenerate", own, "--out", folder, "--check").code == 1
    assert not folder.exists()
    call("regenerate", own, "--out", folder)
    before = (folder / "turret.py").read_bytes()
    assert call("regenerate", own, "--out", folder, "--check").out == "1 modules are up to date.\n"
    (folder / "turret.py").write_bytes(before + b"#")
    assert call("regenerate", own, "--out", folder, "--check").code == 1
    call("regenerate", own, "--out", folder)
    assert (folder / "turret.py").read_bytes() == before


def test_refusals_point_to_what_to_do(call, own: Path, tmp_path: Path) -> None:
    for source in (own, "thesis-ideal"):
        done = call("regenerate", source)
        assert done.code == 2
        assert f"'{source}' is a platform, not one of the committed models ideal" in done.err
        assert "add --out FOLDER" in done.err
    assert "did you mean 'ideal'" in call("regenerate", "idael").err
    assert "is a folder; give a platform TOML" in call("regenerate", tmp_path).err
    assert "name a platform TOML" in call("regenerate", "--out", tmp_path).err
    twice = call("regenerate", own, own, "--out", tmp_path)
    assert "Two platforms are called 'turret'" in twice.err


@pytest.mark.parametrize(
    "command",
    [
        ("simulate", "--platform", "{}"),
        ("sensitivity", "--platform", "{}"),
        ("fit", "--platform", "{}", "log.csv"),
        ("diagnose", "--platform", "{}", "--train", "a.csv", "--validate", "b.csv"),
        ("report", "derivation", "--platform", "{}"),
        ("regenerate", "{}"),
    ],
)
def test_every_command_refuses_a_platform_in_the_same_words(
    call, tmp_path: Path, command: tuple[str, ...]
) -> None:
    for source, wanted in (
        ("thesis-idael", "Unknown platform 'thesis-idael': did you mean 'thesis-ideal'? Choose"),
        (str(tmp_path), f"{tmp_path}: is a folder; give a platform TOML."),
    ):
        out = ("--out", str(tmp_path / "out"))
        done = call(*(part.format(source) for part in command), *out)
        assert done.code == 2
        assert wanted in done.err


def test_a_file_that_is_no_text_differs_and_is_replaced(call, own: Path, tmp_path: Path) -> None:
    folder = tmp_path / "modules"
    call("regenerate", own, "--out", folder)
    whole = (folder / "turret.py").read_bytes()
    (folder / "turret.py").write_bytes(b"\xff\xfe\x00" + whole)
    done = call("regenerate", own, "--out", folder, "--check")
    assert (done.code, done.err) == (1, "")
    assert done.out == f"differs from its equations: {folder / 'turret.py'}\n"
    done = call("regenerate", own, "--out", folder)
    assert (done.code, done.err) == (0, "")
    assert (folder / "turret.py").read_bytes() == whole


@pytest.mark.parametrize(
    ("name", "fate"),
    [
        ("conftest", "run unasked"),
        ("sitecustomize", "run unasked"),
        ("setup", "run unasked"),
        ("con", "a device of Windows"),
        ("Nul", "a device of Windows"),
        ("lpt1", "a device of Windows"),
    ],
)
def test_a_module_that_is_more_than_a_module_is_refused(
    call, name: str, fate: str, own: Path, tmp_path: Path
) -> None:
    own.write_text(own.read_text().replace('"turret"', f'"{name}"'), encoding="utf-8")
    done = call("regenerate", own, "--out", tmp_path / "modules")
    assert done.code == 2
    assert f"A module called {name}.py would be {fate}" in done.err
    assert "change the name of the platform" in done.err
    assert not (tmp_path / "modules").exists()


@pytest.mark.parametrize("name", ["numpy", "NumPy", "os", "ruff", "click", "rich", "torch"])
def test_a_module_that_would_hide_another_is_refused(
    call, name: str, own: Path, tmp_path: Path
) -> None:
    own.write_text(own.read_text().replace('"turret"', f'"{name}"'), encoding="utf-8")
    done = call("regenerate", own, "--out", tmp_path / "modules")
    assert done.code == 2
    assert f"A module called {name}.py would be imported in place of" in done.err
    assert not (tmp_path / "modules").exists()


def test_nothing_runs_from_the_folder_one_stands_in(tmp_path: Path) -> None:
    (tmp_path / "ruff.py").write_text("open('trap', 'w').close()\n")
    command = [sys.executable, "-m", "ptp_symbolic", "regenerate", "ideal", "--check"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    assert (done.returncode, done.stdout) == (0, "1 modules are up to date.\n"), done.stderr
    assert not (tmp_path / "trap").exists()
