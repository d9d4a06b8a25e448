"""What a long command says of itself while its output goes into a file."""

import time

import pytest

from ptp_symbolic.cli import progress
from ptp_symbolic.cli.progress import progress_line

SILENT = 0.2  # s


@pytest.fixture(autouse=True)
def short(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(progress, "SILENT", SILENT)


def test_a_phase_is_said_while_it_lasts_with_the_time_at_which_it_began(capsys) -> None:
    with progress_line() as say:
        say("reading")
        time.sleep(0.1)
        say("fitting")
        assert capsys.readouterr().err == ""
        time.sleep(0.4)
        first, second = capsys.readouterr().err.splitlines()
        assert (first, second) == ("[   0.0 s] reading", "[   0.1 s] fitting")
        say("writing")
        (last,) = capsys.readouterr().err.splitlines()
    begun, _, text = last.removeprefix("[").partition(" s] ")
    assert text == "writing" and 0.5 <= float(begun) < 5.0


def test_what_ends_soon_says_nothing_then_or_later(capsys) -> None:
    """A refusal stays the only line of stderr."""
    with pytest.raises(ValueError, match="refused"), progress_line() as say:
        say("reading")
        raise ValueError("refused")
    time.sleep(2.0 * SILENT)
    assert capsys.readouterr().err == ""
