"""What a rival without physics may see: the residual torque, and motion and inputs beside it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.identify.equation_space import EquationSpace
from ptp_symbolic.numeric.identify.run import Run
from ptp_symbolic.numeric.identify.weak_form import weak_average

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
Values = Mapping[str, float]


@dataclass(frozen=True, eq=False)
class AxisRows:
    """The rows of one axis: what is `seen` [n, s] under `names`, which columns of it are joint
    `rates`, the number of the run [n], and the residual torque [n] in N m (N of a linear joint) of
    the `declared` model and of the one with the `named` effects.
    """

    names: tuple[str, ...]
    rates: tuple[int, ...]
    seen: FloatArray
    run: IntArray
    declared: FloatArray
    named: FloatArray


def space_along(
    space: EquationSpace, runs: Sequence[Run], declared: Values, named: Values
) -> EquationSpace:
    """`space` over other `runs`, with the rows that count for both sets of parameter values."""
    vector = space.model.parameter_vector
    other = replace(space, runs=tuple(runs), rows_of=())
    other.decide_rows(vector(dict(declared)), [vector(dict(named))])
    return other


def axis_rows(space: EquationSpace, axis: int, declared: Values, named: Values) -> AxisRows:
    """The rows of the torque of `axis` (its number), at the values of all parameters of the
    declared model and of the one with the named effects.
    """
    axes, model = space.model.module.AXES, space.model
    equation, number, _ = space.labels()
    own = equation == axis
    before, after = (
        space.rows(model.parameter_vector(dict(values)))[own] for values in (declared, named)
    )
    seen = [
        _seen(space, run, rows.grid[rows.chosen[rows.kept[:, axis]]])
        for run, rows in zip(space.runs, space.rows_of, strict=True)
    ]
    names = (*(f"{word}_{a}" for word in ("theta", "omega") for a in axes), *model.input_names)
    rates = tuple(range(len(axes), 2 * len(axes)))
    return AxisRows(names, rates, np.concatenate(seen), number[own], before, after)


def _seen(space: EquationSpace, run: Run, at: IntArray) -> FloatArray:
    """Angles, rates and inputs [c, 2 na + nu] of a run, averaged under the test functions of its
    rows at the samples `at` [c].
    """
    columns = [run.signals.index(f"theta_{a}") for a in space.model.module.AXES]
    angles = np.ascontiguousarray(run.measured[:, columns])
    motion = [weak_average(run.time, angles, space.half_width, d, at) for d in (0, 1)]
    inputs = np.ascontiguousarray(run.held_inputs)
    return np.hstack([*motion, weak_average(run.time, inputs, space.half_width, 0, at)])
