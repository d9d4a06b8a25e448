"""Many runs of one model at once: shared preparation, all cores, every failure with its reason.

Trajectories are independent of each other and of how they are divided: chunks, threads and
neighbours change no bit. Smooth models go through `lanes`, all others through the runner with
events, one after the other in every thread.
"""

import os
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
from numba import njit, types
from numpy.typing import NDArray

from ptp_symbolic.errors import InputError, out_of_bounds
from ptp_symbolic.numeric.runtime.model import BOUND_SLACK, Model
from ptp_symbolic.numeric.simulation import lanes
from ptp_symbolic.numeric.simulation.integration import Accuracy, integrate
from ptp_symbolic.numeric.simulation.kernels.records import DONE, KERNEL, MATRIX, VECTOR
from ptp_symbolic.numeric.simulation.run import refuse_failure
from ptp_symbolic.numeric.simulation.signals.inputs import (
    InputSignal,
    InputTable,
    delayed,
    delays_of,
    stack,
    values_at,
)

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

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
    failed.
    """

    status: NDArray[np.int64]
    reasons: list[str]
    steps: NDArray[np.int64]
    x: FloatArray


def integrate_batch(
    problem: BatchProblem,
    p: FloatArray,
    x: FloatArray,
    drive: NDArray[np.int64],
    threads: int | None = None,
) -> BatchStates:
    """Integrate from every x [b, n] at parameters p [b, np], driven by `drives[drive[b]]`, on all
    cores or as many `threads`.

    Values that are impossible, and runs that do not reach their end, are reported in their place.
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
    if lanes.suits(problem.model, problem.method, problem.accuracy):
        left = lanes.integrate_in_lanes(
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

    def one(b: int) -> None:
        kind = drive[b]
        _one_run(problem, tables[kind], stops[kind], p[b], x[b], b, found)

    _in_threads(one, left, threads)
    return found


def cores() -> int:
    """Number of cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def _one_run(
    problem: BatchProblem,
    table: InputTable,
    stops: FloatArray,
    p: FloatArray,
    x: FloatArray,
    b: int,
    to: BatchStates,
) -> None:
    """Trajectory `b` by the runner with events, written to its place."""
    model, times = problem.model, problem.times
    if np.any(model.input_delays >= 0):
        table = delayed(table, delays_of(model, p))
        stops = table.with_stops(times[[0, -1]])
    try:
        run = integrate(
            model,
            problem.method,
            p,
            x,
            table,
            table.held,
            stops,
            times,
            problem.accuracy,
        )
        to.steps[b], to.status[b] = run.steps, run.status
        refuse_failure(model, p, run.status, run.reached, run.state)
    except InputError as error:
        to.status[b] = to.status[b] if to.status[b] != DONE else IMPOSSIBLE
        to.reasons[b] = str(error)
        return
    to.x[b] = run.x


def _in_threads(one: Callable[[int], None], rows: NDArray[np.int64], threads: int) -> None:
    """Call `one` for all `rows`; the first alone, so that kernels are compiled once."""
    if not len(rows):
        return
    one(int(rows[0]))
    portions = np.array_split(rows[1:], max(1, PORTIONS * threads))

    def several(portion: NDArray[np.int64]) -> None:
        for b in portion:
            one(int(b))

    with ThreadPoolExecutor(threads) as pool:
        for _ in pool.map(several, portions):
            pass


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


_OUTPUTS = types.FunctionType(types.void(types.float64, *[VECTOR] * 4))


@njit(
    types.void(
        _OUTPUTS, VECTOR, types.float64[:, :, ::1], MATRIX, MATRIX, types.float64[:, :, ::1]
    ),
    cache=True,
    **KERNEL,
)
def fill_outputs(outputs, times, x, u, p, y):
    """Write what sensors show y [b, k, ny] along x [b, k, n], with u [k, nu] and p [b, np]."""
    for b in range(len(p)):
        for i in range(len(times)):
            outputs(times[i], x[b, i], u[i], p[b], y[b, i])


def outputs_along(
    problem: BatchProblem, p: FloatArray, drive: NDArray[np.int64], x: FloatArray
) -> FloatArray:
    """What the sensors of the model show, y [b, k, ny], along x [b, k, n] at parameters p [b, np].

    Without noise; inputs are late where parameters say so.
    """
    y = np.full((*x.shape[:2], len(problem.model.output_names)), np.nan)
    for b in range(len(p)):
        table = delayed(stack(problem.drives[drive[b]]), delays_of(problem.model, p[b]))
        u = values_at(table, problem.times)
        row = slice(b, b + 1)
        fill_outputs(problem.model.module.outputs, problem.times, x[row], u, p[row], y[row])
    return y
