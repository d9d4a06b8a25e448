"""Smooth models, LANES trajectories side by side: one instruction computes several of them.

The method is DOP853 (Dormand and Prince, order 8 with the error estimate of orders 5 and 3 of
Hairer, Norsett and Wanner, *Solving Ordinary Differential Equations I*, section II.10, and its
dense output of order 7). Every lane has a step length of its own, ends its steps where its inputs
jump, and takes the next trajectory when it has reached the end. Lanes do not exchange numbers: a
trajectory has the same bits in any lane and beside any others.

Many runs of one model at once: shared preparation, all cores, every failure with its reason.

Trajectories are independent of each other and of how they are divided: chunks, threads and
neighbours change no bit. Smooth models go through `lanes`, all others through the runner with
events, one after the other in every thread.
"""

import itertools
import os
from collections.abc import Callable, Sequence
from concurrent.futures import Executor, ThreadPoolExecutor
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Any, TypeVar

import numpy as np
from numba import njit, types
from numpy.typing import NDArray

from ptp_symbolic.errors import InputError, out_of_bounds
from ptp_symbolic.numeric.runtime.model import BOUND_SLACK, Model
from ptp_symbolic.numeric.simulation.inputs import (
    InputSignal,
    InputTable,
    delayed,
    delays_of,
    stack,
    values_at,
)
from ptp_symbolic.numeric.simulation.integration import (
    EXPLICIT,
    Accuracy,
    Solution,
    default_method,
    integrate,
)
from ptp_symbolic.numeric.simulation.kernels.calls import call, output_addresses
from ptp_symbolic.numeric.simulation.kernels.records import DONE, KERNEL, MATRIX, VECTOR
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
from ptp_symbolic.numeric.simulation.run import refuse_failure

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
Item = TypeVar("Item")
Result = TypeVar("Result")


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


IMPOSSIBLE = -1  # status of a trajectory whose values no machine can have
PORTIONS = 8  # of a chunk per thread, so that threads end together


@dataclass(frozen=True, eq=False)
class BatchProblem:
    """Runs of `model` over `times` [k] in s: what they have in common.

    `drives` are the signals of all inputs, in the order of the model, for every kind of
    trajectory; `method` as `integrate` takes it, `accuracy` of every one.
    """

    model: Model
    times: FloatArray
    drives: Sequence[Sequence[InputSignal]]
    method: str | None
    accuracy: Accuracy


@dataclass(frozen=True, eq=False)
class BatchStates:
    """States of b trajectories: status [b] (see `kernels.records`, or IMPOSSIBLE) and `reasons` [b]
    in words, empty where it is DONE; steps tried [b]; x [b, k, n] at the times, NaN where a run
    failed; where they are asked for, the derivatives of states [b, k, n, m] and of what the sensors
    show [b, k, ny, m], NaN there too.
    """

    status: NDArray[np.int64]
    reasons: list[str]
    steps: NDArray[np.int64]
    x: FloatArray
    tangents: FloatArray = field(default_factory=lambda: np.zeros((0, 0, 0, 0)))
    output_tangents: FloatArray = field(default_factory=lambda: np.zeros((0, 0, 0, 0)))


def integrate_batch(
    problem: BatchProblem,
    p: FloatArray,
    x: FloatArray,
    drive: NDArray[np.int64],
    threads: int | None = None,
    alone: Callable[[int, InputTable], Solution] | None = None,
) -> BatchStates:
    """Integrate from every x [b, n] at parameters p [b, np], driven by `drives[drive[b]]`, on all
    cores or as many `threads`.

    Where `alone` is given, it integrates each trajectory b, driven by a table. Values that are
    impossible, and runs that do not reach their end, are reported in their place.
    """
    count, (k, n) = len(p), (len(problem.times), x.shape[1])
    found = BatchStates(
        *impossible(problem.model, p, x),
        np.zeros(count, np.int64),
        np.full((count, k, n), np.nan),
    )
    possible = np.flatnonzero(found.status == DONE)
    tables = [stack(signals) for signals in problem.drives]
    stops = [table.with_stops(problem.times[[0, -1]]) for table in tables]
    threads = threads or cores()
    left = possible
    if alone is None and suits(problem.model, problem.method, problem.accuracy):
        left = integrate_in_lanes(
            problem.model,
            problem.times,
            stack([signal for signals in problem.drives for signal in signals]),
            [table.stops for table in tables],
            problem.accuracy,
            p,
            x,
            drive,
            possible,
            threads,
            found.x,
            found.steps,
        )

    def by_events(b: int, table: InputTable) -> Solution:
        late = table is not tables[drive[b]]
        return integrate(
            problem.model,
            problem.method,
            p[b],
            x[b],
            table,
            table.held,
            table.with_stops(problem.times[[0, -1]]) if late else stops[drive[b]],
            problem.times,
            problem.accuracy,
        )

    def one(b: int) -> None:
        table = delayed(tables[drive[b]], delays_of(problem.model, p[b]))
        _note(problem.model, alone or by_events, table, p[b], b, found)

    _in_threads(one, left, threads)
    return found


def cores() -> int:
    """Number of cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def _note(
    model: Model,
    run: Callable[[int, InputTable], Solution],
    table: InputTable,
    p: FloatArray,
    b: int,
    to: BatchStates,
) -> None:
    """Integrate trajectory `b` at p [np] by `run`, and write the result to its place."""
    try:
        found = run(b, table)
        to.steps[b], to.status[b] = found.steps, found.status
        refuse_failure(model, p, found.status, found.reached, found.state)
    except InputError as error:
        to.status[b] = to.status[b] if to.status[b] != DONE else IMPOSSIBLE
        to.reasons[b] = str(error)
        return
    to.x[b] = found.x


def _in_threads(one: Callable[[int], None], rows: NDArray[np.int64], threads: int) -> None:
    """Call `one` for all `rows`; the first alone, so that kernels are compiled once."""
    if not len(rows):
        return
    one(int(rows[0]))
    with ThreadPoolExecutor(threads) as pool:
        in_portions(one, rows[1:].tolist(), pool, threads)


def in_portions(
    one: Callable[[Item], Result],
    items: Sequence[Item],
    executor: Executor | None,
    threads: int | None = None,
) -> list[Result]:
    """`one` of all `items`, in their order, in the `threads` of an executor (None: as many as there
    are cores), or in turn where there is none. A thread takes several of them at a time: to hand
    one over takes as long as a short run.
    """
    if executor is None:
        return [one(item) for item in items]
    count = max(1, min(len(items), PORTIONS * (threads or cores())))
    ends = [k * len(items) // count for k in range(count + 1)]
    portions = [items[first:last] for first, last in itertools.pairwise(ends)]

    def several(portion: Sequence[Item]) -> list[Result]:
        return [one(item) for item in portion]

    return [result for part in executor.map(several, portions) for result in part]


def impossible(model: Model, p: FloatArray, x: FloatArray) -> tuple[IntArray, list[str]]:
    """Status [b], IMPOSSIBLE where values are no machine's, else DONE, and why, in words [b]."""
    status, reasons = np.full(len(p), DONE), [""] * len(p)
    lower = np.array([each.lower for each in model.parameters])
    upper = np.array([each.upper for each in model.parameters])
    inside = (p >= lower - BOUND_SLACK * abs(lower)) & (p <= upper + BOUND_SLACK * abs(upper))
    for b in np.flatnonzero(~(inside & np.isfinite(p)).all(axis=1)):
        j = int(np.flatnonzero(~(inside[b] & np.isfinite(p[b])))[0])
        each = model.parameters[j]
        reasons[b] = str(out_of_bounds(each.name, p[b, j], each.unit, each.lower, each.upper))
    for b, j in zip(*np.nonzero(~np.isfinite(x)), strict=True):
        name = model.state_names[j]
        said = f"State '{name}' starts at {x[b, j]} {model.units[name]}; give a finite number."
        reasons[b] = reasons[b] or said
    margin, margins = np.zeros(len(model.module.REQUIREMENTS)), model.module.margins
    for row in range(len(p) if len(margin) else 0):
        margins(p[row], margin)
        if not reasons[row] and not margin.min() > 0.0:
            try:
                model.refuse_impossible(p[row])
            except InputError as error:
                reasons[row] = str(error)
    status[[bool(why) for why in reasons]] = IMPOSSIBLE
    return status, reasons


@njit(types.void(types.int64, VECTOR, MATRIX, MATRIX, VECTOR, MATRIX), cache=True, **KERNEL)
def fill_outputs(outputs, times, x, u, p, y):
    """Write what sensors show y [k, ny] along x [k, n], with u [k, nu] and p [np]; `outputs` is the
    address of the function of the model.
    """
    for i in range(len(times)):
        call(outputs, times[i], x[i], u[i], p, y[i])


def outputs_along(
    problem: BatchProblem, p: FloatArray, drive: NDArray[np.int64], x: FloatArray
) -> FloatArray:
    """What the sensors of the model show, y [b, k, ny], along x [b, k, n] at parameters p [b, np].

    Without noise; inputs are late where parameters say so.
    """
    y = np.full((*x.shape[:2], len(problem.model.output_names)), np.nan)
    outputs = int(output_addresses(problem.model.module)[0])
    for b in range(len(p)):
        table = delayed(stack(problem.drives[drive[b]]), delays_of(problem.model, p[b]))
        u = values_at(table, problem.times)
        fill_outputs(outputs, problem.times, x[b], u, p[b], y[b])
    return y
