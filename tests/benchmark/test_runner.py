"""Sets that cannot be made do not end a run of the others."""

from pathlib import Path

import pytest

from tests.benchmark import runner
from tests.benchmark.catalogue import catalogue
from tests.benchmark.entry import Entry
from tests.benchmark.sizing import AbsorbedError


def test_a_set_that_shows_nothing_is_said_and_the_next_is_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    first, second = catalogue()[:2]

    def make(entry: Entry, folder: Path) -> bool:
        reason = "level 1.48 at the limit 0.05" if entry is first else "torque too large"
        raise AbsorbedError(f"{entry.id}: {reason}")

    monkeypatch.setattr(runner, "make_missing", make)
    runner.run_all([first, second], tmp_path, jobs=1)
    lines = sorted(capsys.readouterr().out.splitlines())
    assert lines == [
        f"not made: {first.id}: level 1.48 at the limit 0.05",
        f"not made: {second.id}: torque too large",
    ]
