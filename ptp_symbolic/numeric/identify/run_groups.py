"""Runs and windows together: which are of one log, and how long each is."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.identify.run import Run

FloatArray = NDArray[np.float64]


def by_source(runs: Sequence[Run]) -> list[list[int]]:
    """Indices of the runs, the windows of one run together."""
    grouped: dict[str, list[int]] = {}
    for index, run in enumerate(runs):
        grouped.setdefault(run.source, []).append(index)
    return list(grouped.values())


def by_log(runs: Sequence[Run], parts: Sequence[FloatArray]) -> list[FloatArray]:
    """What belongs to every run, rows [k, ...], one after the other for the runs of each log."""
    return [np.concatenate([parts[k] for k in group]) for group in by_source(runs)]


def sizes(runs: Sequence[Run]) -> FloatArray:
    """Number of samples of every run [runs]."""
    return np.array([len(run.time) for run in runs], dtype=np.float64)
