"""The command line in this process: fast, and with everything that it prints."""

import sys
from collections.abc import Callable
from typing import NamedTuple

import pytest

from ptp_symbolic.cli import main


class Done(NamedTuple):
    """Exit code and what was printed."""

    code: int
    out: str
    err: str


Call = Callable[..., Done]


@pytest.fixture
def call(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> Call:
    """Run `ptp-symbolic` with the given arguments."""

    def run(*arguments: object) -> Done:
        monkeypatch.setattr(sys, "argv", ["ptp-symbolic", *map(str, arguments)])
        with pytest.raises(SystemExit) as ended:
            main()
        printed = capsys.readouterr()
        return Done(int(ended.value.code or 0), printed.out, printed.err)

    return run
