"""Averages over parts of samples: of zero-order-hold inputs, and of values around a grid."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.data.zero_order_hold import held_averages
from ptp_symbolic.numeric.identify.run import Run
from ptp_symbolic.numeric.identify.run_inputs import with_inputs

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


def cell_averages(run: Run, column: int, delay: float, grid: IntArray) -> FloatArray:
    """A zero-order-hold input [g], delayed by `delay` s, averaged over the cell around every sample
    of a `grid` [g].
    """
    time = run.time[grid]
    middle = 0.5 * (time[1:] + time[:-1])
    edges = np.concatenate(
        [[1.5 * time[0] - 0.5 * time[1]], middle, [1.5 * time[-1] - 0.5 * time[-2]]]
    )
    return held_averages(run.time, run.held_inputs[:, column], edges - delay)


def part_averages(run: Run, column: int, delay: float, parts: int) -> FloatArray:
    """A zero-order-hold input, delayed by `delay` s, averaged over equal parts of every sample
    [k - 1, parts].
    """
    shares = np.arange(parts) / parts
    edges = run.time[:-1, None] + np.diff(run.time)[:, None] * shares
    flat = np.append(edges.ravel(), run.time[-1])
    return held_averages(run.time, run.held_inputs[:, column], flat - delay).reshape(-1, parts)


def thinned(run: Run, period: float) -> Run:
    """`run` decimated to samples about every `period` s, the inputs averaged in between; the run
    itself where less than two samples come in that time.
    """
    every = int(period / float(np.median(np.diff(run.time))) + 1e-6)
    if every < 2:
        return run
    kept = np.arange(0, len(run.time), every)
    time, last = run.time[kept], run.held_inputs[kept[-1:]]
    means = [held_averages(run.time, column, time) for column in run.held_inputs.T]
    few = replace(
        run,
        time=np.ascontiguousarray(time),
        measured=np.ascontiguousarray(run.measured[kept]),
    )
    return with_inputs(few, np.vstack([np.column_stack(means), last]))


def grid_averages(values: FloatArray, grid: IntArray) -> FloatArray:
    """Averages [g, v] of `values` [k, v] over the samples nearest to every one of the grid."""
    edges = np.concatenate([[0], (grid[1:] + grid[:-1] + 1) // 2, [len(values)]])
    return np.add.reduceat(values, edges[:-1], axis=0) / np.diff(edges)[:, None]
