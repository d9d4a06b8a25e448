"""Smooth models, LANES trajectories side by side: one instruction computes several of them.

The method is DOP853 (Dormand and Prince, order 8 with the error estimate of orders 5 and 3 of
Hairer, Norsett and Wanner, *Solving Ordinary Differential Equations I*, section II.10, and its
dense output of order 7). Every lane has a step length of its own, ends its steps where its inputs
jump, and takes the next trajectory when it has reached the end. Lanes do not exchange numbers: a
trajectory has the same bits in any lane and beside any others.
"""

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.integration import EXPLICIT, Accuracy, default_method
from ptp_symbolic.numeric.simulation.lane_runner import (
    ALL,
    BLOCK,
    DENSE,
    ERROR_3,
    ERROR_5,
    NEW,
    Lanes,
    run_lanes,
)
from ptp_symbolic.numeric.simulation.methods import dormand_prince
from ptp_symbolic.numeric.simulation.signals.inputs import InputTable

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

PATIENCE = 100_000  # steps of a trajectory, after which the runner with events takes it
CACHE_LINE = 64  # bytes
WAVE = 7  # numbers of a sine: see `waves_of`


def suits(model: Model, method: str | None, accuracy: Accuracy) -> bool:
    """Whether runs of `model` are smooth, and an explicit method is right or asked for."""
    chosen = default_method(model) if method is None else method
    smooth = not model.mode_names and not model.limits and not np.any(model.input_delays >= 0)
    return chosen == EXPLICIT and smooth and "lane_derivative" in vars(model.module)


def _blocks(rows: FloatArray) -> tuple[FloatArray, IntArray, IntArray]:
    """The non-zero weights of every row [r, s], where they stand, and their number rounded up to a
    multiple of BLOCK by weights of zero.
    """
    width = BLOCK * -(-int((rows != 0.0).sum(axis=1).max()) // BLOCK)
    weights, stages = np.zeros((len(rows), width)), np.zeros((len(rows), width), np.int64)
    counts = np.zeros(len(rows), np.int64)
    for row, values in enumerate(rows):
        where = np.flatnonzero(values)
        weights[row, : len(where)], stages[row, : len(where)] = values[where], where
        counts[row] = BLOCK * -(-len(where) // BLOCK)
    return weights, stages, counts


@lru_cache(maxsize=1)
def tableau() -> tuple[FloatArray, IntArray, IntArray, FloatArray]:
    """DOP853 as `run_lanes` takes it: rows 1 to 11 of the stages, 12 the solution, 13 to 15 the
    stages of dense output, 16 and 17 the errors of order 5 and 3, 18 to 21 the dense output; and
    the nodes [16].
    """
    rows = np.zeros((22, ALL))
    rows[:ALL] = dormand_prince.A
    rows[ERROR_5, : NEW + 1], rows[ERROR_3, : NEW + 1] = (
        dormand_prince.ERROR_5,
        dormand_prince.ERROR_3,
    )
    rows[DENSE:] = dormand_prince.INTERPOLANT
    return *_blocks(rows), dormand_prince.C


def _aligned_zeros(shape: int | tuple[int, ...], kind: Any = np.float64) -> NDArray[Any]:
    """Zeros that begin at a cache line: vectors of eight numbers would cross two otherwise."""
    count = int(np.prod(shape))
    room = np.zeros(count + CACHE_LINE // 8, kind)
    first = -room.ctypes.data % CACHE_LINE // 8
    return room[first : first + count].reshape(shape)


def new_lanes(
    lanes: int, nu: int, parameters: int, prepared: int, waves: int, atol: FloatArray
) -> Lanes:
    """Preallocated arrays for as many `lanes`, with as many `waves` per input."""
    z, n = _aligned_zeros, len(atol)
    w = z((1 + 2 * n + nu + parameters + prepared, lanes))
    parts = np.split(w, np.cumsum([1, n, nu, parameters + prepared]))
    t, state, u, constants, dx = parts
    angle, total = z((waves * nu, lanes)), z(n * lanes)
    tolerance = z(n * lanes)
    tolerance[:] = np.repeat(atol, lanes)
    arrays: list[Any] = [
        *(part.reshape(-1) for part in (w, t, state, dx)),
        u,
        constants,
        z((ALL, n * lanes)),
        *z((2, n * lanes)),
        total,
        total.reshape(n, lanes),
        *z((2, n * lanes)),
        tolerance,
        z((4, n * lanes)),
        *z((5, lanes)),
        z((nu, lanes)),
        z((4, nu, lanes)),
        z((4, waves * nu, lanes)),
        z((waves * nu, lanes)),
        angle,
        angle.reshape(-1),
        *z((5, lanes), np.int64),
        z((nu, lanes), np.int64),
        z((nu, lanes)),
        z(parameters),
        z(prepared),
    ]
    return Lanes(*arrays)


def waves_of(table: InputTable) -> FloatArray:
    """Sines and sweeps [s, r, 7] of every signal, as many rows r as the one with most has:
    amplitude, phase in rad, rad/s, rad/s^2, origin, begin and end in s.
    """
    signals = len(table.offsets) - 1
    parts = []
    for j in range(signals):
        sines = table.sines[table.sine_offsets[j] : table.sine_offsets[j + 1]]
        sweeps = table.sweeps[table.sweep_offsets[j] : table.sweep_offsets[j + 1]]
        rows = [[a, phase, 2 * np.pi * f, 0.0, 0.0, -np.inf, np.inf] for a, f, phase in sines]
        for a, lowest, highest, t0, t1 in sweeps:
            chirp = np.pi * (highest - lowest) / (t1 - t0)
            rows.append([a, 0.0, 2 * np.pi * lowest, chirp, t0, t0, t1])
        parts.append(rows)
    most = max(map(len, parts), default=0)
    waves = np.zeros((signals, most, WAVE))
    for j, rows in enumerate(parts):
        if rows:
            waves[j, : len(rows)] = rows
    return waves


def integrate_in_lanes(
    model: Model,
    times: FloatArray,
    table: InputTable,
    stops: Sequence[FloatArray],
    accuracy: Accuracy,
    p: FloatArray,
    x: FloatArray,
    drive: IntArray,
    todo: IntArray,
    threads: int,
    out: FloatArray,
    steps: IntArray,
) -> IntArray:
    """Integrate the trajectories `todo` of p [b, np] and x [b, n] over `times` [k] into out
    [b, k, n], and count their steps [b]; returns those that did not reach the end.

    `table` holds the signals of all kinds of drive one after the other, `stops` the times in s at
    which those of each jump, `drive` [b] the kind of every trajectory.
    """
    module = model.module
    inner = [s[(s > times[0]) & (s < times[-1])] for s in stops]
    offsets = np.cumsum([0, *map(len, inner)], dtype=np.int64)
    most = min(accuracy.most_steps, PATIENCE)
    limits = np.array([accuracy.relative, accuracy.largest_step, most])
    all_stops = np.concatenate([np.empty(0), *inner])
    pieces, waves = (table.breaks, table.coefficients, table.offsets), waves_of(table)
    sizes = (module.LANES, len(model.input_names), p.shape[1], module.PREPARED, waves.shape[1])
    done = np.zeros(len(p), np.bool_)

    run = run_lanes()

    def portion(rows: IntArray) -> None:
        runs = (p, x, drive, rows, times, limits, all_stops, offsets)
        run(
            (module.lane_derivative, module.lane_sines),
            module.prepare,
            tableau(),
            pieces,
            bool(table.coefficients[:, 1:].any()),
            waves,
            (*runs, out, steps, done),
            tuple(new_lanes(*sizes, accuracy.absolute)),
        )

    with ThreadPoolExecutor(threads) as pool:
        for _ in pool.map(portion, [part for part in np.array_split(todo, threads) if len(part)]):
            pass
    left = todo[~done[todo]]
    out[left], steps[left] = np.nan, 0
    return left
