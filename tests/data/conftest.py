"""Files of libraries, read without a process for each."""

import json
from collections.abc import Sequence
from typing import BinaryIO

import pytest

from ptp_symbolic.numeric.files import child, content


@pytest.fixture
def in_this_process(monkeypatch: pytest.MonkeyPatch) -> None:
    """What a process of its own would read is read here: each would import the library anew. That a
    library may end its process is in test_damaged_files.py.
    """

    def run(command: Sequence[str], output: BinaryIO, patience: float) -> int:
        child.answer_to(json.loads(command[-1]), output)
        return 0

    monkeypatch.setattr(content, "_run", run)
