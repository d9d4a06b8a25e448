"""What a workflow gives: a result as data, the files that hold it, and a diagnosis read back."""

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

from ptp_symbolic.errors import InputError
from ptp_symbolic.platform import Platform

Wanted = TypeVar("Wanted")
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


def read_diagnosis(
    source: Path, platform: Platform, wanted: Callable[[Mapping[str, Any]], Wanted]
) -> Wanted:
    """What is `wanted` of a diagnosis, in a file or in the folder that `diagnose` has written.

    Raises InputError for what is none or lacks something of it, or is of another platform.
    """
    path = source if source.is_file() else source / "diagnosis.json"
    try:
        found = json.loads(path.read_text(encoding="utf-8"))
        name, part = found["platform"]["name"], wanted(found)
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise InputError(
            f"{path}: is no diagnosis; name the folder that `diagnose --out` has written, or the"
            " diagnosis.json in it."
        ) from error
    if name != platform.name:
        raise InputError(
            f"{path}: is of platform '{name}', not of '{platform.name}'; give the platform that was"
            " diagnosed, of two as the first one."
        )
    return part
