"""What a workflow gives: a result as data, and the files that hold it."""

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from ptp_symbolic.numeric.diagnose.trial import Task

Progress = Callable[[str], None]
SCHEMA_VERSION = 1


@dataclass(frozen=True)
class Output:
    """A result as data (`summary`) and every file to be written, by name."""

    summary: dict[str, Any]
    files: Mapping[str, str | bytes]


def json_text(value: object) -> str:
    """Return `value` as the text of a JSON file."""
    return json.dumps(value, indent=2, ensure_ascii=False, allow_nan=False) + "\n"


def windows_table(task: Task) -> dict[str, Any] | None:
    """How many windows the runs were cut into, and how long they are; None for whole runs."""
    if len(task.train) == len(task.whole):
        return None
    length = sum(float(run.time[-1] - run.time[0]) for run in task.train) / len(task.train)
    return {"count": len(task.train), "seconds": length}
