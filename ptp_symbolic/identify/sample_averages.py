"""Averages over parts of samples: of held inputs, and of values at the samples around a grid."""

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.identify.run import Run

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


def cell_averages(run: Run, column: int, delay: float, grid: IntArray) -> FloatArray:
    """A held input [g], late by `delay` s, averaged over the cell around every sample of a grid."""
    time = run.time[grid]
    middle = 0.5 * (time[1:] + time[:-1])
    edges = np.concatenate(
        [[1.5 * time[0] - 0.5 * time[1]], middle, [1.5 * time[-1] - 0.5 * time[-2]]]
    )
    return _averages(run, column, edges - delay)


def part_averages(run: Run, column: int, delay: float, parts: int) -> FloatArray:
    """A held input, late by `delay` s, averaged over equal parts of every sample [k - 1, parts]."""
    shares = np.arange(parts) / parts
    edges = run.time[:-1, None] + np.diff(run.time)[:, None] * shares
    flat = np.append(edges.ravel(), run.time[-1])
    return _averages(run, column, flat - delay).reshape(-1, parts)


def _averages(run: Run, column: int, edges: FloatArray) -> FloatArray:
    """Averages of a held input between neighbouring `edges`; before the first sample it is that."""
    time, held = run.time, run.held_inputs[:, column]
    integral = np.concatenate([[0.0], np.cumsum(held[:-1] * np.diff(time))])
    at = np.interp(edges, time, integral)
    at += np.where(edges < time[0], (edges - time[0]) * held[0], 0.0)
    at += np.where(edges > time[-1], (edges - time[-1]) * held[-1], 0.0)
    return np.diff(at) / np.diff(edges)


def grid_averages(values: FloatArray, grid: IntArray) -> FloatArray:
    """Averages [g, v] of `values` [k, v] over the samples nearest to every one of the grid."""
    edges = np.concatenate([[0], (grid[1:] + grid[:-1] + 1) // 2, [len(values)]])
    return np.add.reduceat(values, edges[:-1], axis=0) / np.diff(edges)[:, None]
