"""The equation space of a set of runs: window, rates of rest, and the rows that count.

Structural dependence: which parameters and states act on what, probed at random states.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.identify.constants import CYCLES, SEED
from ptp_symbolic.numeric.identify.equation_rows import half_width_of, resting_rates
from ptp_symbolic.numeric.identify.equation_space import EquationSpace
from ptp_symbolic.numeric.identify.layout import Layout, layout_of
from ptp_symbolic.numeric.identify.run import Run
from ptp_symbolic.numeric.identify.sample_averages import usual_period
from ptp_symbolic.numeric.runtime.model import Model

BoolArray = NDArray[np.bool_]
FloatArray = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Dependence:
    """Which parameters act on what the sensors of the angles show (`sensing` [np]) and on the rates
    of further states (`moving` [np]), and which of these states act on a torque or on one another
    (`acting` [e]).
    """

    sensing: BoolArray
    moving: BoolArray
    acting: BoolArray


def dependence_of(
    model: Model, layout: Layout, runs: Sequence[Run], p: FloatArray, varied: FloatArray
) -> Dependence:
    """What depends on what, probed at random states with p [np] and with `varied` [np]
    in turn: what half of all states show is missed once in 64.
    """
    rng = np.random.default_rng(SEED)
    count = len(layout.further)
    found = Dependence(
        np.zeros(len(p), dtype=np.bool_),
        np.zeros(len(p), dtype=np.bool_),
        np.zeros(count, dtype=np.bool_),
    )
    shown = [model.output_names.index(f"theta_{a}") for a in model.module.AXES]
    largest = np.max([np.max(np.abs(run.held_inputs), axis=0) for run in runs], axis=0)
    steps = np.where(varied != p, varied - p, 0.01 * p + 1e-3)

    def seen(x: FloatArray, u: FloatArray, q: FloatArray, m: FloatArray) -> tuple[FloatArray, ...]:
        r, y = np.zeros(layout.rows + count), np.zeros(len(model.output_names))
        model.module.equation_error(0.5, x, u, q, m, r)
        model.module.outputs(0.5, x, u, q, y)
        return y[shown], r[layout.rows :], r

    for base in (p, varied) * CYCLES:
        x, m = (
            rng.standard_normal(layout.states + layout.rows),
            rng.choice([-1.0, 1.0], layout.modes),
        )
        u = largest * rng.choice([-1.0, 1.0], len(largest))
        here = seen(x, u, base, m)
        for j, step in enumerate(steps if base is p else -steps):
            shifted = base.copy()
            shifted[j] += step
            there = seen(x, u, shifted, m)
            found.sensing[j] |= bool(np.any(there[0] != here[0]))
            found.moving[j] |= bool(np.any(there[1] != here[1]))
        for e, state in enumerate(layout.further):
            shifted = x.copy()
            shifted[state] += 1.0
            other = seen(shifted, u, base, m)[2] - here[2]
            other[layout.rows + e] = 0.0
            found.acting[e] |= bool(np.any(other))
    found.moving[[j for j in model.input_delays if j >= 0 and count]] = True
    return found


def prepare_equation_space(
    model: Model,
    runs: Sequence[Run],
    p: FloatArray,
    others: Sequence[FloatArray],
    varied: FloatArray,
    shortest: bool = False,
    half_width: float | None = None,
) -> EquationSpace:
    """The equation space of `model` over whole `runs`.

    Which rows count is decided at the parameters p [np] and at `others` (see `decide_rows`);
    `varied` are parameters that differ from p in all that may be searched, to see which of them act
    on sensors and on further states; windows are as short as noise allows with `shortest`, or of a
    `half_width` in s. Raises InputError for a model with sampled states, and where an axis has no
    angle among the signals.
    """
    layout = layout_of(model)
    axes = model.module.AXES
    for axis in axes:
        if any(f"theta_{axis}" not in run.signals for run in runs):
            raise InputError(f"Signal 'theta_{axis}' is not measured; torques need every angle.")
    further = [model.state_names[i] for i in layout.further]
    measured = tuple(
        (column, further.index(name))
        for column, name in enumerate(runs[0].signals)
        if name in further
    )
    depends = dependence_of(model, layout, runs, p, varied)
    columns = [runs[0].signals.index(f"theta_{axis}") for axis in axes]
    noise = 1.0 / runs[0].weight[columns]
    period = usual_period(runs)
    if half_width is None:
        half_width = half_width_of(runs, columns, noise, period, shortest)
    resting = resting_rates(runs[0].counts[columns], noise, period, 0.5 * half_width)
    frictions = set(layout.friction_axis.tolist())
    resting = np.where([a in frictions for a in range(len(axes))], resting, 0.0)
    widths, acts = (half_width, 0.5 * half_width), (depends.sensing, depends.moving, depends.acting)
    space = EquationSpace(model, tuple(runs), layout, *widths, resting, measured, *acts)
    space.decide_rows(p, others)
    return space
