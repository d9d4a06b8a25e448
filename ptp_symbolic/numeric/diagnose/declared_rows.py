"""The equation space of a task, and the declared model fitted to its rows."""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.diagnose.candidates import FAR_OFF
from ptp_symbolic.numeric.diagnose.trial import Task
from ptp_symbolic.numeric.identify.constants import CYCLES, DECLARED_AMOUNT, FAR, ITERATIONS
from ptp_symbolic.numeric.identify.coordinates import FreeParameter, to_search
from ptp_symbolic.numeric.identify.equation_fit import fit_equations, robust_scale
from ptp_symbolic.numeric.identify.equation_preparation import prepare_equation_space
from ptp_symbolic.numeric.identify.equation_space import EquationSpace
from ptp_symbolic.numeric.identify.requirements import nearest_possible
from ptp_symbolic.numeric.identify.run import Run
from ptp_symbolic.numeric.identify.simulations import all_values, all_values_at_start

FloatArray = NDArray[np.float64]


def declared_start(task: Task) -> dict[str, float]:
    """All parameters at the declared starts, every candidate at its vanishing value."""
    return {**task.fixed, **all_values_at_start(task.free)}


def equation_space(
    task: Task,
    start: Mapping[str, float],
    runs: Sequence[Run] | None = None,
    shortest: bool = False,
    half_width: float | None = None,
) -> EquationSpace | None:
    """The equation space of the whole training runs, or of other `runs`, in windows as short as
    noise allows with `shortest`, or of a `half_width` in s. None where angles are missing, states
    are sampled or switched, or rows are too few for the free parameters.
    """
    vector = task.model.parameter_vector
    varied = dict(start)
    for candidate in task.candidates:
        for f in candidate.free:
            amount = f.start
            if candidate.is_declared_value:
                amount = min((1.0 + DECLARED_AMOUNT) * f.start, f.upper)
            varied.update(dict.fromkeys(f.names, amount))
    others = []
    for f in task.free:
        for factor in (FAR_OFF, 1.0 / FAR_OFF):
            value = float(np.clip(f.start * factor, f.lower, f.upper))
            others.append(vector({**start, **dict.fromkeys(f.names, value)}))
    try:
        space = prepare_equation_space(
            task.model,
            task.whole if runs is None else runs,
            vector(dict(start)),
            others,
            vector(varied),
            shortest,
            half_width,
        )
    except InputError:
        return None
    total = sum(int(rows.kept.sum()) for rows in space.rows_of)
    return space if total > 4 * (len(task.free) + 1) else None


def possible(
    task: Task, free: Sequence[FreeParameter], values: Mapping[str, float]
) -> dict[str, float]:
    """`values` with `free` projected onto the boundary of every relation of the machine that they
    break, as a fit does with its start.
    """

    def parameters(phi: FloatArray) -> FloatArray:
        return task.model.parameter_vector({**values, **all_values(free, phi)})

    phi = to_search(free, values)
    found = nearest_possible(task.model, free, parameters, phi)
    return dict(values) if found is phi else {**values, **all_values(free, found)}


def first_fit(task: Task, space: EquationSpace, start: Mapping[str, float]) -> dict[str, float]:
    """All parameters of the declared model where its rows ask for it, those rows left out in turn
    in which a joint has left the face of its gap, far more clearly than the rows scatter.
    """
    first = fit_equations(space, task.free, start, ITERATIONS, task.executor)
    values = possible(task, task.free, {**start, **first})
    for _ in range(CYCLES):
        p = task.model.parameter_vector(values)
        rows, (equation, _, _) = space.rows(p), space.labels()
        scale = dict(zip(equation, robust_scale(rows, equation), strict=True))
        margin = FAR * np.array([scale.get(a, np.inf) for a in range(len(space.layout.angle))])
        if not space.leave_out_pulled(p, margin):
            break
        first = fit_equations(space, task.free, values, ITERATIONS, task.executor)
        values = possible(task, task.free, {**values, **first})
    return values
