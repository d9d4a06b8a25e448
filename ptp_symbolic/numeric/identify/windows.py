"""How long a run may be simulated freely: replay it with the noise of its inputs and look.

A machine that forgets (a geared drive, damped by its back-EMF) is judged over whole runs. One that
integrates its input noise, or whose errors grow (a torque-driven axis, a payload above the tilt
axis), would be judged by that noise; it is cut into windows with starts of their own.

Windows of a log that follow one another: each begins where the simulated one before it ended.
"""

import itertools
from collections.abc import Sequence
from concurrent.futures import Executor
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.identify.constants import (
    ALLOWED_RISE,
    BINS,
    LEAST_START,
    LENGTHS,
    MATERIAL,
    NOTHING,
    ROUNDING,
    SEED,
    SHORT,
    START_SPAN,
    TUNING,
)
from ptp_symbolic.numeric.identify.evaluate import Tolerance, evaluate, start_state
from ptp_symbolic.numeric.identify.evidence import recorded
from ptp_symbolic.numeric.identify.replays import input_noise, propagated_noise, replayed
from ptp_symbolic.numeric.identify.run import WINDOW, Around, Run, with_start
from ptp_symbolic.numeric.identify.sample_averages import thinned
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.signals.inputs import part_of_sampled

FloatArray = NDArray[np.float64]


@recorded()
def window_length(
    model: Model,
    runs: Sequence[Run],
    p: FloatArray,
    declared_noise: Sequence[float | None],
    executor: Executor | None = None,
) -> float | None:
    """Longest window in s over which input noise stays near the noise of the angles, at p [np].

    None where whole runs do. Near is half a count, of which the noise is the rounding. Where an
    error of the start grows tenfold, windows of 1 s at most.
    """
    every = executor.map if executor else map
    if any(every(lambda run: multiplies_errors(model, run, p, run.guess), runs)):
        lengths: tuple[float, ...] = tuple(x for x in LENGTHS if x <= SHORT)
    else:
        lengths = (np.inf, *LENGTHS)
    rng = np.random.default_rng(SEED)
    grown = [_drift(model, run, p, input_noise(run, declared_noise), rng) for run in runs]
    durations = [float(run.time[-1] - run.time[0]) for run in runs]
    allowed = max(0.5 / ROUNDING, ALLOWED_RISE * _typical(grown, LENGTHS[-1]))
    for length in lengths:
        if _typical(grown, length) <= allowed:
            return None if length >= max(durations) else float(length)
    return LENGTHS[-1]


def _typical(grown: Sequence[tuple[FloatArray, FloatArray]], length: float) -> float:
    """Median over runs of the rms drift within `length` s of the start; infinite without runs."""
    inside = [np.mean(drift[time <= length] ** 2) for drift, time in grown if time.size]
    return float(np.sqrt(np.median(inside))) if inside else np.inf


@recorded()
def multiplies_errors(model: Model, run: Run, p: FloatArray, z: FloatArray) -> bool:
    """True when a small error of a starting angle grows within the run until it is no MATERIAL
    share of what it has become, at p [np] from the start z [nz].
    """
    none = np.zeros(0, dtype=np.int64)
    e = evaluate(model, run, p, z, none, True, Tolerance())
    angles = [i for i, u in enumerate(run.unknowns) if u.name.startswith("theta")]
    if e.failed:
        return True
    by_angle = e.by_start[:, angles] / np.tile(run.weight, len(run.time))[:, None]
    return bool(np.max(np.abs(by_angle), initial=0.0) > 1.0 / MATERIAL)


def _drift(
    model: Model, run: Run, p: FloatArray, noise: FloatArray, rng: np.random.Generator
) -> tuple[FloatArray, FloatArray]:
    """Difference [k] between a run and its noisy replay, over the noise of its angles (of all
    signals where there is no encoder), and the time since start.
    """
    change = replayed(model, run, p, run.guess, noise, rng)[0].reshape(run.measured.shape)
    if not np.all(np.isfinite(change)):
        return np.zeros(0), np.zeros(0)
    encoders = np.isfinite(run.counts)
    change = change[:, encoders] if encoders.any() else change
    return np.sqrt(np.mean(change**2, axis=1)), run.time - run.time[0]


def cut_where_errors_grow(
    model: Model,
    runs: Sequence[Run],
    z: Sequence[FloatArray],
    left: FloatArray,
    p: FloatArray,
    declared_noise: Sequence[float | None],
    executor: Executor | None = None,
) -> tuple[Run, ...]:
    """The runs, those cut into windows in which the noise of the inputs leaves more than the noise
    of the signals and may be most of the residual `left` [runs, ny], or in which a gear rattles:
    breakaways and bounces amplify any error until nothing can be predicted.
    """
    grows = _errors_grow(model, tuple(runs), tuple(z), left, p, declared_noise, executor)
    found: list[Run] = []
    for run, chaotic in zip(runs, grows, strict=True):
        found += split_run(model, run, SHORT) if chaotic else (run,)
    return tuple(found)


@recorded()
def _errors_grow(
    model: Model,
    runs: Sequence[Run],
    z: Sequence[FloatArray],
    left: FloatArray,
    p: FloatArray,
    declared_noise: Sequence[float | None],
    executor: Executor | None,
) -> list[bool]:
    """Which runs `cut_where_errors_grow` cuts."""
    carried = propagated_noise(model, runs, z, p, declared_noise, executor)
    grows = np.any((carried > 1.0) & (left < TUNING * carried), axis=1)
    grows |= list((executor.map if executor else map)(lambda run: _rattles(model, run, p), runs))
    return [bool(one) for one in grows]


def _rattles(model: Model, run: Run, p: FloatArray) -> bool:
    """True when a small error of the place of a gear in its gap moves the joint ten (1 / MATERIAL)
    times as far within the run, by the geometric mean over the places in the gap: from a single
    one it scatters tenfold, for some by chance lead to a rest on a face.
    """
    none, z = np.zeros(0, dtype=np.int64), run.guess
    for index, unknown in enumerate(run.unknowns):
        if unknown.contact is None or unknown.column is None:
            continue
        gear, _ = model.module.CONTACT_ANGLES[unknown.contact]
        growth = []
        for z[index] in np.linspace(-1.0, 1.0, BINS // 2 + 1):
            e = evaluate(model, run, p, z, none, True, Tolerance())
            _, tangents = start_state(model, run, p, z, none)
            moved = e.by_start.reshape(*run.measured.shape, -1)[:, unknown.column, index]
            farthest = float(np.max(np.abs(moved))) / run.weight[unknown.column]
            growth.append(farthest / max(tangents[gear, index], NOTHING))
        z[index] = unknown.guess
        if np.mean(np.log(np.maximum(growth, NOTHING))) > np.log(1.0 / MATERIAL):
            return True
    return False


def cut(model: Model, runs: Sequence[Run], length: float | None) -> tuple[Run, ...]:
    """Runs as they are, or cut into windows of about `length` s."""
    if length is None:
        return tuple(runs)
    return tuple(piece for run in runs for piece in split_run(model, run, length))


def _moving_edges(run: Run, edges: NDArray[np.int64]) -> NDArray[np.int64]:
    """Shift inner edges by up to a quarter window to where every encoder moves fastest.

    A window that starts near standstill may settle in the wrong branch of sticking and sliding.
    """
    encoders = np.flatnonzero(np.isfinite(run.counts))
    if encoders.size == 0:
        return edges
    half = max(1, round(0.5 * START_SPAN / float(np.median(np.diff(run.time)))))
    if len(run.time) <= 4 * half:
        return edges
    rate = np.zeros((len(run.time), encoders.size))
    rate[half:-half] = run.measured[2 * half :, encoders] - run.measured[: -2 * half, encoders]
    speed = np.abs(rate) / np.maximum(np.sqrt(np.mean(rate**2, axis=0)), 1e-300)
    slowest = np.min(speed, axis=1)
    reach = max(1, int(np.min(np.diff(edges)) // 4))
    placed = [e - reach + int(np.argmax(slowest[e - reach : e + reach])) for e in edges[1:-1]]
    return np.array([edges[0], *placed, edges[-1]])


def split_run(model: Model, run: Run, length: float) -> tuple[Run, ...]:
    """Cut a run into windows of about `length` s, each with a start of its own; the first one has
    that of the run.

    Neighbours share the sample between them, so that no step from sample to sample is lost.
    """
    duration = run.time[-1] - run.time[0]
    pieces = max(1, min(round(duration / length), (len(run.time) - 1) // (2 * LEAST_START)))
    if pieces == 1:
        return (run,)
    edges = _moving_edges(run, np.linspace(0, len(run.time) - 1, pieces + 1).astype(int))
    windows = []
    for number, (a, b) in enumerate(itertools.pairwise(edges)):
        piece = piece_of(run, slice(a, b + 1), number + 1)
        if number:
            around = Around(run.time, run.measured, int(a))
            piece = with_start(model, replace(piece, before=run.held_inputs[a - 1]), around)
        windows.append(piece)
    return tuple(windows)


def piece_of(run: Run, part: slice, number: int) -> Run:
    """A `part` of the samples of a run as the window of that `number`, with the start of the run as
    yet.
    """
    time = np.ascontiguousarray(run.time[part])
    return replace(
        run,
        name=f"{run.name}{WINDOW}{number}",
        time=time,
        inputs=part_of_sampled(run.inputs, time[0], time[-1]),
        held_inputs=np.ascontiguousarray(run.held_inputs[part]),
        measured=np.ascontiguousarray(run.measured[part]),
    )


def parted_like(model: Model, runs: Sequence[Run], pattern: Sequence[Run]) -> tuple[Run, ...]:
    """Runs in the windows, and with the samples, of the runs of another model of the same logs."""
    found = []
    for other in pattern:
        first_time, last_time = other.time[0], other.time[-1]
        run = next(
            r
            for r in runs
            if r.source == other.source and r.time[0] <= first_time and last_time <= r.time[-1]
        )
        first, last = np.searchsorted(run.time, [first_time, last_time])
        piece = run
        if last - first + 1 < len(run.time):
            piece = replace(piece_of(run, slice(first, last + 1), 0), name=other.name)
        if first > 0:
            around = Around(run.time, run.measured, int(first))
            piece = with_start(model, replace(piece, before=run.held_inputs[first - 1]), around)
        every = round((len(piece.time) - 1) / max(len(other.time) - 1, 1))
        found.append(thinned(piece, every))
    return tuple(found)
