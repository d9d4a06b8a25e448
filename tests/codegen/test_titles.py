"""A title is text of a file: in the emitted module it stays text, whatever it looks like."""

from pathlib import Path

import pytest

import ptp_symbolic

PLATFORM = """[platform]
name = "named"
title = '{title}'
axes = ["tilt"]
[[effects]]
effect = "rigid_bodies"
"""
MARK = 'open("mark", "w").close()'
TITLES = {
    "ends the docstring": f'a""" + str({MARK}) + """',
    "ends the constant": f'a"; {MARK}; b = "',
    "ends in a quote": 'called "tracker"',
    "ends in a backslash": "a\\",
    "escapes": r"\x41 \N{BULLET} \u0041",
}


@pytest.mark.parametrize("title", TITLES.values(), ids=TITLES)
def test_a_title_is_never_run(title: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "named.toml"
    path.write_text(PLATFORM.format(title=title), encoding="utf-8")
    model = ptp_symbolic.load(path)
    assert title == model.module.TITLE
    assert (model.module.__doc__ or "").startswith(f"{title}: equations of motion")
    assert [p.name for p in tmp_path.iterdir()] == ["named.toml"]
