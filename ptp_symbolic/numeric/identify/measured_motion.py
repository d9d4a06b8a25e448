"""The measured motion of a run: angles without the errors of sensors, smoothed and averaged; and
further states along it.

How a joint moved at the rows of the equation space: angle, rate, time since it turned back.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.identify.along_motion import (
    Motion,
    angles_behind_sensors,
    further_states,
)
from ptp_symbolic.numeric.identify.equation_rows import RunRows
from ptp_symbolic.numeric.identify.layout import Layout, equation_addresses
from ptp_symbolic.numeric.identify.run import Run
from ptp_symbolic.numeric.identify.sample_averages import grid_averages, part_averages
from ptp_symbolic.numeric.identify.weak_form import averages, local_motion, weak_average
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.signals.inputs import delays_of

FloatArray = NDArray[np.float64]


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
