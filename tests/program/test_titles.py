"""A title is text of a file: in whatever is emitted it stays text, whatever it looks like."""

from pathlib import Path

import pytest

import ptp_symbolic
from ptp_symbolic.numeric.runtime.model import load_module
from ptp_symbolic.platform import read_platform
from ptp_symbolic.symbolic.derivation.assembly import assemble
from ptp_symbolic.symbolic.targets.numba.module import module_text

PLATFORM = """[platform]
name = "named"
title = '{title}'
axes = ["tilt"]
[[effects]]
effect = "rigid_bodies"
"""
INERTIA = '[parameters.J_y_tilt]\nvalue = {}\nunit = "kg m^2"\n'
MARK = 'open("mark", "w").close()'
TITLES = {
    "ends the docstring": f'zebra""" + str({MARK}) + """',
    "ends the constant": f'zebra"; {MARK}; b = "',
    "ends in a quote": 'called "zebra"',
    "ends in a backslash": "zebra\\",
    "escapes": r"zebra \x41 \N{BULLET} \u0041",
}


@pytest.fixture
def declared(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The platform file, in the working folder, where code in a title would leave `mark`."""
    monkeypatch.chdir(tmp_path)
    return tmp_path / "named.toml"


@pytest.mark.parametrize("title", TITLES.values(), ids=TITLES)
def test_a_title_that_is_written_into_a_module_is_never_run(title: str, declared: Path) -> None:
    declared.write_text(PLATFORM.format(title=title), encoding="utf-8")
    path = declared.with_name("named.py")
    path.write_text(module_text(assemble(read_platform(declared))), encoding="utf-8")
    model = load_module(path, f"named_{list(TITLES.values()).index(title)}")
    assert title == model.module.TITLE == model.title
    assert (model.module.__doc__ or "").startswith(f"{title}: equations of motion")
    assert not declared.with_name("mark").exists()


@pytest.mark.parametrize("title", TITLES.values(), ids=TITLES)
def test_a_module_that_machines_share_holds_nothing_of_their_titles(
    title: str, declared: Path
) -> None:
    declared.write_text(PLATFORM.format(title=title) + INERTIA.format(2e-3), encoding="utf-8")
    model = ptp_symbolic.load(declared)
    assert (model.name, model.title) == ("named", title)
    emitted = Path(model.module.__file__ or "").read_text(encoding="utf-8")
    assert "zebra" not in emitted
    assert "named" not in emitted
    assert not declared.with_name("mark").exists()


def test_machines_that_differ_in_title_and_numbers_share_a_module(declared: Path) -> None:
    models = []
    for title, inertia in (("one", 2e-3), ("the other", 3e-3)):
        declared.write_text(
            PLATFORM.format(title=title) + INERTIA.format(inertia), encoding="utf-8"
        )
        models.append(ptp_symbolic.load(declared))
    assert models[0].module is models[1].module
    assert [model.title for model in models] == ["one", "the other"]
    assert [model.defaults["J_y_tilt"] for model in models] == [2e-3, 3e-3]
