"""Training and validation logs: no run may be in both, whole or in part."""

from collections.abc import Iterable
from pathlib import Path

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.data.log import Log, log_files, read_logs
from ptp_symbolic.platform import Platform

EXCERPT = 50  # samples in a row
CHANGES = 10  # of them differ from the one before, or they say little


def read_split_logs(
    train: Iterable[Path | str], validate: Iterable[Path | str], platform: Platform
) -> tuple[tuple[Log, ...], tuple[Log, ...]]:
    """Read the training logs and the validation logs, which must be other runs.

    Raises InputError as `read_logs` does, and for a run that is in both, under whatever name, whole
    or in part. A part that was resampled is not noticed.
    """
    places = [log_files(paths) for paths in (train, validate)]
    fitted, judging = (read_logs(files, platform) for files in places)
    seen = [_excerpts(log) for log in fitted]
    for file, log in zip(places[1], judging, strict=True):
        own = _excerpts(log)
        for other, known, excerpts in zip(places[0], fitted, seen, strict=True):
            whole = _same_run(log, known)
            if whole or own & excerpts:
                raise InputError(
                    f"{file}: holds {'the same run as' if whole else 'samples of'} {other}, which"
                    " is given to be fitted; a fit is judged by runs that it has never seen: give"
                    " others to `validate`."
                )
    return fitted, judging


def _same_run(log: Log, other: Log) -> bool:
    """Whether both hold the same samples, wherever their clocks started."""
    return (
        np.array_equal(log.outputs, other.outputs)
        and np.array_equal(log.inputs, other.inputs)
        and np.allclose(log.time - log.time[0], other.time - other.time[0])
    )


def _excerpts(log: Log) -> set[int]:
    """Hashes of all EXCERPT samples in a row that hold some motion."""
    rows = np.hstack([log.inputs, log.outputs])
    if len(rows) < EXCERPT:
        return set()
    changed = np.any(np.diff(rows, axis=0) != 0.0, axis=1)
    moving = np.convolve(changed, np.ones(EXCERPT - 1), "valid") >= CHANGES
    windows = sliding_window_view(rows, EXCERPT, axis=0)
    return {hash(window.tobytes()) for window in windows[moving]}
