"""Modules that were once written are found again, by their mathematics and nothing else."""

import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
import sympy as sp

from ptp_symbolic.errors import InputError
from ptp_symbolic.models import module_cache
from ptp_symbolic.platform import read_platform
from ptp_symbolic.symbolic.derivation.assembly import assemble
from ptp_symbolic.symbolic.derivation.equations import Equations
from ptp_symbolic.symbolic.derivation.placement import parameters_of, place_effects
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter

Machine = tuple[Equations, dict[str, Parameter]]


@pytest.fixture
def written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Titles of the modules that were written; the folder of modules is new."""
    titles: list[str] = []
    usual = module_cache.module_text

    def module_text(equations: Equations) -> str:
        titles.append(equations.title)
        return usual(equations)

    monkeypatch.setattr(module_cache, "module_text", module_text)
    monkeypatch.setenv("PTP_SYMBOLIC_CACHE", str(tmp_path / "modules"))
    return titles


@pytest.fixture
def machine(checkout: Path) -> Machine:
    platform = read_platform(checkout / "ptp_symbolic/platform/presets/thesis-ideal.toml")
    return assemble(platform), parameters_of(place_effects(platform))


def test_a_module_is_written_once(machine: Machine, written: list[str]) -> None:
    equations, usual = machine
    first = module_cache.emitted(equations, usual)
    heavier = tuple(replace(p, default=2.0 * p.default) for p in equations.parameters)
    other = replace(equations, title="Another of the kind", parameters=heavier)
    assert module_cache.emitted(other, usual) == first
    assert written == ["Machine of a user"]


def test_other_equations_are_another_module(machine: Machine, written: list[str]) -> None:
    equations, usual = machine
    forcing = equations.forcing + sp.ones(*equations.forcing.shape)
    paths = {
        module_cache.emitted(e, usual) for e in (equations, replace(equations, forcing=forcing))
    }
    assert len(paths) == len(written) == 2


@pytest.mark.parametrize("damage", [b"cut", b"\xff\xfe", b"\0", None])
def test_a_damaged_module_is_written_again(
    damage: bytes | None, machine: Machine, written: list[str]
) -> None:
    path = module_cache.emitted(*machine)
    whole = path.read_bytes()
    path.unlink()
    if damage is not None:
        path.write_bytes(whole[: len(whole) // 2] + damage)
    assert module_cache.emitted(*machine) == path
    assert path.read_bytes() == whole
    assert len(written) == 2


@pytest.mark.parametrize("damage", [b"", b"\xff\xfe", b"a\0b", b"../../elsewhere.py"])
def test_a_damaged_name_is_written_again(
    damage: bytes, machine: Machine, written: list[str]
) -> None:
    path = module_cache.emitted(*machine)
    (name,) = path.parent.glob("*.name")
    whole = name.read_bytes()
    name.write_bytes(damage)
    assert module_cache.emitted(*machine) == path
    assert name.read_bytes() == whole


def test_a_folder_without_room_is_replaced_for_the_process(
    machine: Machine, written: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Nothing can be written: a folder has the name of the file, or a file that of the folder."""
    usual = module_cache.emitted(*machine)
    usual.unlink()
    usual.mkdir()
    other = module_cache.emitted(*machine)
    monkeypatch.setenv("PTP_SYMBOLIC_CACHE", str(next(usual.parent.glob("*.name")) / "below"))
    assert module_cache.emitted(*machine) == other
    assert other.name == usual.name
    assert not other.is_relative_to(usual.parent)
    assert other.parent.stat().st_mode & 0o777 == 0o700


EMIT = """from pathlib import Path
from ptp_symbolic.models.emission import emit
from ptp_symbolic.models.module_cache import cache_folder
from ptp_symbolic.platform import read_platform
emit(read_platform("thesis-ideal"))
print(len(list(cache_folder().glob("*.name"))))
"""


def test_edits_of_what_derives_and_emits_write_anew_and_others_do_not(
    checkout: Path, tmp_path: Path
) -> None:
    """A copy of the package is edited file by file; how often was the same machine written?"""
    package = tmp_path / "ptp_symbolic"
    shutil.copytree(
        checkout / "ptp_symbolic", package, ignore=shutil.ignore_patterns("__pycache__")
    )
    environment = os.environ | {
        "PYTHONPATH": str(tmp_path),
        "PTP_SYMBOLIC_CACHE": str(tmp_path / "modules"),
    }
    written = []
    for edited in (
        (),
        ("report/style.py", "cli/tables.py", "numeric/runtime/model.py", "models/emission.py"),
        ("symbolic/effects/cogging.py",),
    ):
        for file in edited:
            with (package / file).open("a", encoding="utf-8") as source:
                source.write("\n# edited\n")
        command = [sys.executable, "-c", EMIT]
        printed = subprocess.run(command, env=environment, cwd=tmp_path, capture_output=True)
        written.append(int(printed.stdout))
    assert written == [1, 1, 2]


def test_the_description_is_the_same_in_every_process(
    checkout: Path, printed_in_two_processes: Callable[..., set[str]]
) -> None:
    script = (
        "import hashlib, sys\n"
        "from ptp_symbolic.symbolic.derivation.assembly import assemble\n"
        "from ptp_symbolic.models.module_cache import described\n"
        "from ptp_symbolic.platform import read_platform\n"
        "text = described(assemble(read_platform(sys.argv[1])))\n"
        "print(hashlib.sha256(text.encode()).hexdigest())\n"
    )
    preset = checkout / "ptp_symbolic/platform/presets/thesis-tilt-drive.toml"
    assert len(printed_in_two_processes(script, str(preset))) == 1


@pytest.mark.parametrize("mode", [0o777, 0o770, 0o702])
@pytest.mark.parametrize("inside", ["", "__pycache__"])
def test_a_folder_that_others_may_write_is_refused(
    mode: int, inside: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / "open"
    (folder / inside).mkdir(parents=True)
    (folder / inside).chmod(mode)
    monkeypatch.setenv("PTP_SYMBOLIC_CACHE", str(folder))
    with pytest.raises(InputError, match="can be written by other users"):
        module_cache.cache_folder()


def test_a_folder_of_another_user_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PTP_SYMBOLIC_CACHE", str(tmp_path / "theirs"))
    owner = tmp_path.stat().st_uid
    monkeypatch.setattr(module_cache.os, "getuid", lambda: owner + 1)
    with pytest.raises(InputError, match="set PTP_SYMBOLIC_CACHE to a folder of your own"):
        module_cache.cache_folder()


def test_where_no_home_can_be_written_every_user_has_a_folder_of_his_own(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.delenv("PTP_SYMBOLIC_CACHE", raising=False)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.setattr(module_cache.os, "access", lambda *_: False)
    monkeypatch.setattr(module_cache.tempfile, "gettempdir", lambda: str(tmp_path))
    folder = module_cache.cache_folder()
    assert folder == tmp_path / f"ptp_symbolic-{module_cache.os.getuid()}"
    assert folder.stat().st_mode & 0o777 == 0o700
