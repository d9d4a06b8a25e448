"""The equation space of a set of runs: window, rates of rest, and the rows that count."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.identify.dependence import dependence_of
from ptp_symbolic.numeric.identify.equation_rows import half_width_of, resting_rates
from ptp_symbolic.numeric.identify.equation_space import EquationSpace
from ptp_symbolic.numeric.identify.layout import layout_of
from ptp_symbolic.numeric.identify.run import Run
from ptp_symbolic.numeric.identify.sample_averages import usual_period
from ptp_symbolic.numeric.runtime.model import Model

FloatArray = NDArray[np.float64]


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
