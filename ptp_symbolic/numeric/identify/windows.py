"""How long a run may be simulated freely: replay it with the noise of its inputs and look.

A machine that forgets (a geared drive, damped by its back-EMF) is judged over whole runs. One that
integrates its input noise, or whose errors grow (a torque-driven axis, a payload above the tilt
axis), would be judged by that noise; it is cut into windows with initial states of their own. The
same replays give the propagated input noise of a fit.
"""

import itertools
from collections.abc import Sequence
from concurrent.futures import Executor
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.identify.blocks import huber_root, weighted_median
from ptp_symbolic.numeric.identify.constants import (
    ALLOWED_RISE,
    BINS,
    LEAST_START,
    LENGTHS,
    MATERIAL,
    NOTHING,
    REPEATS,
    REPLAYS,
    ROUNDING,
    SEED,
    SHORT,
    START_SPAN,
    TUNING,
)
from ptp_symbolic.numeric.identify.evaluate import Tolerance, evaluate
from ptp_symbolic.numeric.identify.evidence import derived, is_recording, recorded
from ptp_symbolic.numeric.identify.fit import Fit
from ptp_symbolic.numeric.identify.intervals import project_out, with_finite_differences
from ptp_symbolic.numeric.identify.least_squares import (
    DEFAULT_TOLERANCE,
)
from ptp_symbolic.numeric.identify.noise import white_noise
from ptp_symbolic.numeric.identify.run import WINDOW, Around, Run, thinned, with_inputs, with_start
from ptp_symbolic.numeric.identify.start import start_state
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.inputs import part_of_sampled
from ptp_symbolic.numeric.simulation.lanes import in_portions

FloatArray = NDArray[np.float64]


def input_noise(run: Run, declared: Sequence[float | None]) -> FloatArray:
    """Noise (rms) of every input [nu] in its unit: as declared, else as its samples show it."""
    columns = zip(run.held_inputs.T, declared, strict=True)
    return np.array([white_noise(c, run.time) if d is None else d for c, d in columns])


def noisier(run: Run, noise: FloatArray, rng: np.random.Generator) -> Run:
    """`run` with more `noise` (rms) [nu] on its inputs."""
    return with_inputs(run, run.held_inputs + noise * rng.standard_normal(run.held_inputs.shape))


def replayed(
    model: Model,
    run: Run,
    p: FloatArray,
    z: FloatArray,
    noise: FloatArray,
    rng: np.random.Generator,
    times: int = 1,
    tolerance: Tolerance = DEFAULT_TOLERANCE,
) -> tuple[FloatArray, FloatArray]:
    """Changes [k * ny, times] of the weighted residuals by input noise, each from another draw, and
    the Jacobian by the start of the run; nan where it cannot be simulated. Inputs change at
    samples alone, whatever the log has in between.
    """
    none = np.zeros(0, dtype=np.int64)
    plain = evaluate(model, with_inputs(run, run.held_inputs), p, z, none, True, tolerance)
    changes = np.full((run.size, times), np.nan)
    for column in changes.T:
        other = evaluate(model, noisier(run, noise, rng), p, z, none, False, tolerance)
        if not (plain.failed or other.failed):
            column[:] = other.residual - plain.residual
    return changes, plain.by_start


def replayed_squares(
    model: Model,
    runs: Sequence[Run],
    z: Sequence[FloatArray],
    p: FloatArray,
    declared_noise: Sequence[float | None],
    executor: Executor | None = None,
) -> FloatArray:
    """The propagated input noise in the residual of a perfect model: mean squares [REPEATS, runs,
    ny] of the replays of every run, in units of the noise of every signal (see `Run.weight`); nan
    where a run cannot be simulated. What its unknown start can take up is projected out.
    """

    def squares(number: int) -> FloatArray:
        run, rng = runs[number], np.random.default_rng((SEED, number))
        noise = input_noise(run, declared_noise)
        if not np.any(noise):
            return np.zeros((REPEATS, len(run.signals)))
        changes, by_start = replayed(model, run, p, z[number], noise, rng, REPEATS)
        left = project_out(changes, by_start).reshape(*run.measured.shape, REPEATS)
        return np.asarray(np.mean(left**2, axis=0).T)

    return np.stack(in_portions(squares, range(len(runs)), executor), axis=1)


def propagated_noise(
    model: Model,
    runs: Sequence[Run],
    z: Sequence[FloatArray],
    p: FloatArray,
    declared_noise: Sequence[float | None],
    executor: Executor | None = None,
) -> FloatArray:
    """Root mean square [runs, ny] of the propagated input noise, over all replays of
    `replayed_squares` but the largest one, which may stick elsewhere.
    """
    squares = np.sort(replayed_squares(model, runs, z, p, declared_noise, executor), axis=0)
    return np.asarray(np.sqrt(np.mean(squares[:-1], axis=0)))


def estimable(
    fit: Fit, declared_noise: Sequence[float | None], executor: Executor | None = None
) -> Fit:
    """A finished fit with all that its intervals need: what the noise of the inputs changes, and
    finite differences where derivatives miss what these see.
    """
    return with_finite_differences(with_input_noise(fit, declared_noise, executor), executor)


def with_input_noise(
    fit: Fit, declared_noise: Sequence[float | None], executor: Executor | None = None
) -> Fit:
    """`fit` with the propagated noise of its inputs, as declared or as their samples show it, in
    its residuals: intervals allow for it. A fit follows a part of that noise, and the fewer runs
    there are, the more: the residual is no measure of it then.

    As many replays as make REPLAYS of all runs or windows together. Those that change far more than
    usual, as where the machine sticks elsewhere, weigh less, as they do in the fit.
    """
    if not fit.free or fit.failed:
        return fit

    def changed() -> Sequence[FloatArray]:
        return _by_input_noise(fit, declared_noise, executor)

    by_input_noise: Sequence[FloatArray]
    if is_recording():
        by_input_noise = derived("input noise", (fit, declared_noise), changed)
    else:
        by_input_noise = changed()
    return replace(fit, by_input_noise=by_input_noise) if len(by_input_noise) else fit


def _by_input_noise(
    fit: Fit, declared_noise: Sequence[float | None], executor: Executor | None
) -> Sequence[FloatArray]:
    """The `by_input_noise` of `with_input_noise`."""
    p = fit.model.parameter_vector(dict(fit.values))
    replays = -(-REPLAYS // len(fit.runs))

    def changes(number: int) -> FloatArray:
        run, rng = fit.runs[number], np.random.default_rng((SEED, number))
        noise = input_noise(run, declared_noise)
        if not np.any(noise):
            return np.zeros((run.size, 0))
        every, _ = replayed(fit.model, run, p, fit.z[number], noise, rng, replays, fit.tolerance)
        simulated = every[:, np.all(np.isfinite(every), axis=0)]
        return project_out(simulated, fit.evaluations[number].by_start)

    every = in_portions(changes, range(len(fit.runs)), executor)
    square = np.concatenate([np.mean(c**2, axis=0) for c in every])
    if not square.size:
        return ()
    size = np.concatenate([np.full(c.shape[1], float(len(c))) for c in every])
    usual = max(float(weighted_median(square[:, None], size)[0]), 1.0)
    return tuple(c * huber_root(np.mean(c**2, axis=0), usual) for c in every)


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
    shown = set(run.signals)
    angles = [
        i for i, u in enumerate(run.unknowns) if u.name.startswith("theta_") and u.name in shown
    ]
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
    """The runs, those cut into windows in which the propagated noise of the inputs exceeds the
    noise of the signals and may be most of the residual `left` [runs, ny], or in which a gear
    rattles: breakaways and bounces amplify any error until nothing can be predicted.
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
    propagated = propagated_noise(model, runs, z, p, declared_noise, executor)
    grows = np.any((propagated > 1.0) & (left < TUNING * propagated), axis=1)
    grows |= in_portions(lambda run: _rattles(model, run, p), runs, executor)
    return [bool(one) for one in grows]


def _rattles(model: Model, run: Run, p: FloatArray) -> bool:
    """True when a small error of the place of a gear in its gap moves the joint ten (1 / MATERIAL)
    times as far within the run, by the geometric mean over the places in the gap: from a single one
    it scatters tenfold, for some end by chance at a rest on a face.
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
