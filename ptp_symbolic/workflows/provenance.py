"""What a result rests on: program, date, platform file and logs, with their checksums."""

import hashlib
from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

from ptp_symbolic.numeric.data import Log, stored_at
from ptp_symbolic.platform import Platform


def provenance(
    platform: Platform,
    parts: Mapping[str, tuple[Sequence[Path], Sequence[Log]]],
    command: str | None,
) -> dict[str, Any]:
    """Version, date (UTC), `command` line, and every file that was read, with its SHA-256.

    `parts` gives the files and the logs of each part, such as "train"; the clock of a log is its
    number of samples, its duration in s and its rate in Hz by the median period.
    """
    source = None if platform.source is None else Path(platform.source)
    return {
        "version": version("ptp-symbolic"),
        "date": datetime.now(UTC).isoformat(timespec="seconds"),
        "command": command,
        "platform": None if source is None else _file(source),
        "logs": [
            {"part": part, **_file(file), **_clock(log)}
            for part, (paths, logs) in parts.items()
            for path, log in zip(paths, logs, strict=True)
            for file in stored_at(path)
        ],
    }


def _file(path: Path) -> dict[str, Any]:
    with path.open("rb") as file:
        digest = hashlib.file_digest(file, "sha256").hexdigest()
    return {"file": path.name, "sha256": digest}


def _clock(log: Log) -> dict[str, Any]:
    return {
        "samples": len(log.time),
        "duration": float(log.time[-1] - log.time[0]),
        "rate": 1.0 / float(np.median(np.diff(log.time))),
    }
