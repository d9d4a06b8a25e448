"""A set that cannot be made does not end a run of the others."""

from pathlib import Path
from typing import Any

import pytest

from tests.benchmark import runner
from tests.benchmark.catalogue import catalogue
from tests.benchmark.entry import Entry
from tests.benchmark.sizing import AbsorbedError


def test_a_set_that_shows_nothing_is_said_and_the_next_is_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    first, second = catalogue()[:2]

    def run_one(entry: Entry, *_: Any) -> dict[str, Any]:
        if entry is first:
            raise AbsorbedError(f"{entry.id}: level 1.48 at the limit 0.05")
        return {"id": entry.id}

    monkeypatch.setattr(runner, "run_one", run_one)
    monkeypatch.setattr(runner, "line_of", lambda outcome: f"right {outcome['id']}")
    runner.run_under([(first, tmp_path, "effort=2"), (second, tmp_path, None)], jobs=1)
    assert sorted(capsys.readouterr().out.splitlines()) == [
        f"effort=2: not made: {first.id}: level 1.48 at the limit 0.05",
        f"right {second.id}",
    ]
