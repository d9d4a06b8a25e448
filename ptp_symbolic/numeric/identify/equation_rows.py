"""The weak-form rows of a run: how wide their windows are, and which of them count.

Angles are freed of the errors of sensors, smoothed and averaged; further states are integrated
along the measured motion.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.identify.along_motion import (
    Layout,
    Motion,
    angles_behind_sensors,
    equation_addresses,
    further_states,
)
from ptp_symbolic.numeric.identify.constants import (
    CALM,
    HALF_WIDTHS,
    NOTHING,
    RESTING,
    ROWS_PER_WINDOW,
    SAMPLES_PER_WINDOW,
)
from ptp_symbolic.numeric.identify.run import Run, grid_averages, part_averages
from ptp_symbolic.numeric.identify.weak_form import (
    Windows,
    averages,
    curvature_noise,
    local_motion,
    weak_average,
    windows,
)
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.inputs import delays_of

BoolArray = NDArray[np.bool_]
FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class RunRows:
    """The rows of a run: `grid` [g] are the samples at which torques are taken, `chosen` [c] those
    of the grid that have a row, `kept` [c, equations] the rows that count; `face` [g, na] is the
    face that every gear output touches.

    `part` [g] is what a row needs of a sample of the grid: 0 nothing, 1 its torque, 2 the
    derivatives of the torque too. The windows of the rows: `on_grid` and `curved` (of second
    derivatives) over the grid, `on_samples` over all samples.
    """

    grid: IntArray
    chosen: IntArray
    kept: BoolArray
    face: FloatArray
    part: IntArray
    on_grid: Windows
    curved: Windows
    on_samples: Windows


def half_width_of(
    runs: Sequence[Run],
    columns: Sequence[int],
    noise: FloatArray,
    period: float,
    shortest: bool = False,
) -> float:
    """Half width in s of the shortest usual window in which `noise` [na] in rad of the angles, in
    measured `columns` [na] every `period` s, is small beside what accelerates the
    joints, and which holds at least half of SAMPLES_PER_WINDOW (a second derivative is then off by
    0.3 %); with `shortest` it is divided by root two as long as it is.
    """

    def is_calm(half_width: float) -> bool:
        if 4.0 * half_width / period < SAMPLES_PER_WINDOW:
            return False
        gain = curvature_noise(period, half_width)
        curved = [
            weak_average(
                run.time,
                np.ascontiguousarray(run.measured[:, columns]),
                half_width,
                2,
                np.arange(0, len(run.time), max(1, int(half_width / period))),
            )
            for run in runs
        ]
        curvature = np.concatenate(curved)
        if np.isnan(curvature).all(axis=0).any():  # no window fits into any run
            return False
        size = np.sqrt(np.nanmean(curvature**2, axis=0))
        return bool(np.all(noise * gain <= CALM * size))

    half_width = next((w for w in HALF_WIDTHS if is_calm(w)), None)
    if half_width is None:
        return max(HALF_WIDTHS[-1], 0.25 * SAMPLES_PER_WINDOW * period)
    while shortest and is_calm(half_width / np.sqrt(2.0)):
        half_width /= np.sqrt(2.0)
    return float(half_width)


def resting_rates(
    counts: FloatArray, noise: FloatArray, period: float, rate_width: float
) -> FloatArray:
    """Rate [na] in rad/s below which a joint may be at rest, from the `counts` [na] of its encoder
    in rad (nan where it has none) and the `noise` [na] of its angle in rad, sampled every `period`
    s and differentiated over windows of half `rate_width` s.
    """
    rounding = np.nan_to_num(counts) / np.sqrt(12.0)
    samples = 2.0 * rate_width / period + 1.0
    return np.asarray(RESTING * np.hypot(noise * np.sqrt(3.0 / samples), rounding) / rate_width)


def every_row(run: Run, half_width: float, axes: int, equations: int) -> RunRows:
    """The grid of a run for windows of `half_width` s and the samples of it that have a row, all of
    which count for now.
    """
    period = float(np.median(np.diff(run.time)))
    window = 2.0 * half_width / period
    grid = np.arange(0, len(run.time), max(1, int(window / SAMPLES_PER_WINDOW)))
    spacing = window / max(1, int(window / SAMPLES_PER_WINDOW))
    chosen = np.arange(0, len(grid), max(1, round(spacing / ROWS_PER_WINDOW)))
    kept = np.ones((len(chosen), equations), dtype=np.bool_)
    return _with_windows(run, half_width, grid, chosen, kept, np.zeros((len(grid), axes)))


def _with_windows(
    run: Run,
    half_width: float,
    grid: IntArray,
    chosen: IntArray,
    kept: BoolArray,
    face: FloatArray,
) -> RunRows:
    """The rows of a run with their windows of `half_width` s."""
    time = run.time[grid]
    on_grid, curved = (windows(time, half_width, d, chosen) for d in (0, 2))
    part = np.zeros(len(grid), dtype=np.int64)
    for first, end in zip(on_grid.first, on_grid.end, strict=True):
        part[first:end] = 1
    part[chosen] = 2
    on_samples = windows(run.time, half_width, 0, grid[chosen])
    return RunRows(grid, chosen, kept, face, part, on_grid, curved, on_samples)


def rows_that_count(
    run: Run,
    rows: RunRows,
    motion: Motion,
    faces: Sequence[FloatArray],
    resting: FloatArray,
    half_width: float,
    measured: int,
) -> RunRows:
    """The `rows` of a run whose windows, of `half_width` s, are whole and hold neither rest
    (`resting` [na] in rad/s) nor a change of one of the `faces` [g, na], the first of which are
    those at the parameters; so many further states are `measured`.
    """
    rests = (np.abs(motion.rate) < resting).astype(np.float64)
    changed = np.zeros_like(rests)
    for face in faces:
        changed[1:] = np.maximum(changed[1:], face[1:] != face[:-1])
    both = np.column_stack([rests, changed])
    both = averages(rows.on_grid, both)
    axes = rests.shape[1]
    slides = (both[:, :axes] < NOTHING) & (both[:, axes:] < NOTHING)
    electric = np.all(both[:, axes:] < NOTHING, axis=1)
    kept = np.column_stack([slides, *[electric] * measured])
    return _those_kept(run, rows, kept, faces[0], half_width)


def rows_without(run: Run, rows: RunRows, wrong: BoolArray, half_width: float) -> RunRows:
    """The `rows` of a run whose windows, of `half_width` s, hold no sample of the grid at which an
    axis is `wrong` [g, na]; all rows of a window with one are left out.
    """
    clean = np.all(averages(rows.on_grid, wrong.astype(np.float64)) < NOTHING, axis=1)
    return _those_kept(run, rows, rows.kept & clean[:, None], rows.face, half_width)


def _those_kept(
    run: Run, rows: RunRows, kept: BoolArray, face: FloatArray, half_width: float
) -> RunRows:
    """The `rows` of a run, those `kept` [c, equations] alone, with their windows."""
    some = kept.any(axis=1)
    return _with_windows(run, half_width, rows.grid, rows.chosen[some], kept[some], face)


@dataclass(frozen=True, eq=False)
class MeasuredMotion:
    """The motion of one run at all samples and on the grid, the averaged second derivatives [c, na]
    in rad/s^2 of its angles, and the smoothing bias [c, 2 na] of the averages of angles and rates.
    """

    fine: Motion
    coarse: Motion
    curvature: FloatArray
    missed: FloatArray


@dataclass(frozen=True, eq=False)
class FurtherStates:
    """Further states: their values on the grid [g, e], measured where they are; residual [k, e],
    measured minus integrated, at all samples; quasi-static derivative by the joint rates
    [k, e, na].
    """

    acting: FloatArray
    left: FloatArray
    by_rate: FloatArray


def angles_of(model: Model, layout: Layout, run: Run, p: FloatArray, errors: bool) -> FloatArray:
    """Measured joint angles [k, na] in rad; with sensor `errors`, those at p [np] taken out."""
    axes = model.module.AXES
    columns = [run.signals.index(f"theta_{a}") for a in axes]
    shown = [model.output_names.index(f"theta_{a}") for a in axes]
    measured = np.ascontiguousarray(run.measured[:, columns])
    if not errors:
        return measured
    found: FloatArray = angles_behind_sensors(
        equation_addresses(model),
        layout,
        np.array(shown),
        run.time,
        measured,
        run.held_inputs,
        p,
        len(model.output_names),
    )
    return found


def measured_motion(
    run: Run,
    angles: FloatArray,
    further: int,
    measured: Sequence[tuple[int, int]],
    rows: RunRows,
    half_width: float,
    rate_width: float,
) -> MeasuredMotion:
    """The motion of a run with joint `angles` [k, na]; of so many `further` states those that are
    `measured`, each with its column. Widths in s of the windows and of the local motion.
    """
    local = local_motion(run.time, angles, rate_width)
    seen = np.full((len(run.time), further), np.nan)
    for column, place in measured:
        seen[:, place] = run.measured[:, column]
    smooth, rate, acceleration = (np.ascontiguousarray(local[:, k]) for k in range(3))
    fine = Motion(run.time, smooth, rate, acceleration, run.held_inputs, seen)
    coarse = Motion(*(np.ascontiguousarray(column[rows.grid]) for column in fine))
    at = rows.grid[rows.chosen]
    curvature = weak_average(run.time, angles, half_width, 2, at)
    exact = [
        averages(rows.on_samples, angles),
        weak_average(run.time, angles, half_width, 1, at),
    ]
    taken = [averages(rows.on_grid, c) for c in coarse[1:3]]
    missed = np.column_stack([e - s for e, s in zip(exact, taken, strict=True)])
    return MeasuredMotion(fine, coarse, curvature, missed)


def states_along(
    model: Model,
    layout: Layout,
    run: Run,
    rows: RunRows,
    fine: Motion,
    p: FloatArray,
    added: FloatArray,
    resting: FloatArray,
    acting: NDArray[np.bool_],
    measured: Sequence[int],
) -> FurtherStates:
    """Further states of a run along its motion at all samples, with what is `added` [g, nu] to the
    inputs; `measured` are their places in the layout, the rest is as in `EquationSpace`.
    """
    grid, delays = rows.grid, delays_of(model, p)
    parts = 4 if np.any(delays) else 2  # the halves of a sample, which averages need; their halves
    late = np.stack([part_averages(run, j, d, parts) for j, d in enumerate(delays)], axis=2)
    if np.any(added):
        more = [np.interp(run.time[:-1], run.time[grid], a) for a in added.T]
        late = late + np.column_stack(more)[:, None, :]
    shown = np.zeros(len(layout.further), dtype=np.bool_)
    shown[list(measured)] = True
    wanted = np.zeros(len(run.time), dtype=np.bool_)
    wanted[grid[rows.chosen]] = True
    addresses = equation_addresses(model)
    found, mean, by_rate = further_states(
        addresses, layout, fine, p, resting, acting, shown, wanted, late
    )
    left = fine.measured - found
    acts = grid_averages(np.where(np.isnan(left), mean, mean + left), grid)
    return FurtherStates(acts, np.nan_to_num(left), by_rate)
