"""Averages over parts of samples: of inputs, and of values around a grid."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from ptp_symbolic.numeric.data.latency import input_averages
from ptp_symbolic.numeric.identify.constants import FAR, LITTLE
from ptp_symbolic.numeric.identify.run import Run
from ptp_symbolic.numeric.simulation.signals.inputs import (
    InputSignal,
    sampled_signals,
    stack,
    table,
)

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


def cell_averages(run: Run, column: int, delay: float, grid: IntArray) -> FloatArray:
    """An input [g], delayed by `delay` s, averaged over the cell around every sample of a `grid`
    [g].
    """
    return _averages(run, column, _cell_edges(run.time[grid]) - delay)


def _cell_edges(time: FloatArray) -> FloatArray:
    """Edges [n + 1] in s of the cells around every one of the times [n] in s."""
    middle = 0.5 * (time[1:] + time[:-1])
    return np.concatenate(
        [[1.5 * time[0] - 0.5 * time[1]], middle, [1.5 * time[-1] - 0.5 * time[-2]]]
    )


def part_averages(run: Run, column: int, delay: float, parts: int) -> FloatArray:
    """An input, delayed by `delay` s, averaged over equal parts of every sample [k - 1, parts]."""
    shares = np.arange(parts) / parts
    edges = run.time[:-1, None] + np.diff(run.time)[:, None] * shares
    flat = np.append(edges.ravel(), run.time[-1])
    return _averages(run, column, flat - delay).reshape(-1, parts)


def _averages(run: Run, column: int, edges: FloatArray) -> FloatArray:
    """Averages [m] of an input between neighbouring `edges` [m + 1] in s."""
    between = run.interpolation(column)
    return input_averages(run.time, run.held_inputs[:, column], edges, between)


def usual_period(runs: Sequence[Run]) -> float:
    """Sampling period in s of most samples of some runs."""
    return float(np.median(np.concatenate([np.diff(run.time) for run in runs])))


def samples_within(run: Run, period: float) -> int:
    """How many samples of `run` come within `period` s, at least one."""
    return max(1, int(period / usual_period((run,)) + 1e-6))


def thinned(run: Run, every: int) -> Run:
    """`run` with the first of `every` so many samples, the inputs averaged in between. Inputs that
    are held jump where they did: a step that comes half a sample late moves an angle by counts.
    """
    if every < 2:
        return run
    kept = np.arange(0, len(run.time), every)
    time = np.ascontiguousarray(run.time[kept])
    return replace(
        run,
        time=time,
        measured=np.ascontiguousarray(run.measured[kept]),
        held_inputs=np.ascontiguousarray(run.held_inputs[kept]),
        inputs=stack(
            [
                _fewer(
                    signal.breaks[:-1], signal.coefficients[:, 0], time, run.interpolation(column)
                )
                for column, signal in enumerate(sampled_signals(run.inputs))
            ]
        ),
    )


def _fewer(
    times: FloatArray, values: FloatArray, edges: FloatArray, interpolation: str
) -> InputSignal:
    """An input averaged around `edges` in s, or, where it is held, between them and the jumps that
    stand out: beyond noise and slope, and a material share of its range.
    """
    if interpolation == "linear":
        means = input_averages(times, values, _cell_edges(edges), interpolation)
        return table(edges, means, interpolation)
    rise = np.abs(np.diff(values))
    usual = float(np.median(rise) / stats.norm.ppf(0.75)) if rise.size else 0.0
    jumps = times[1:][rise > max(FAR * usual, LITTLE * float(np.ptp(values)))]
    at = np.union1d(edges, jumps[(jumps > edges[0]) & (jumps < edges[-1])])
    last = values[max(0, int(np.searchsorted(times, edges[-1], side="right")) - 1)]
    return table(at, np.append(input_averages(times, values, at), last))


def grid_averages(values: FloatArray, grid: IntArray) -> FloatArray:
    """Averages [g, v] of `values` [k, v] over the samples nearest to every one of the grid."""
    edges = np.concatenate([[0], (grid[1:] + grid[:-1] + 1) // 2, [len(values)]])
    return np.add.reduceat(values, edges[:-1], axis=0) / np.diff(edges)[:, None]
