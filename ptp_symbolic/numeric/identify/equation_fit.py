"""Fit parameters to the weak-form rows: bounded, robust, nearly linear least squares.

The initial values of every simulation: inertia, friction and the strength of most effects are found
from far away, for their rows are linear in them (inverse dynamic identification: Gautier and
Khalil, 1990).
"""

from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import stats
from scipy.optimize import lsq_linear

from ptp_symbolic.numeric.identify.constants import DEVIATIONS, NOTHING, SAME, SHORT
from ptp_symbolic.numeric.identify.coordinates import FreeParameter
from ptp_symbolic.numeric.identify.equation_space import EquationSpace

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Linearised:
    """Residual rows [n], their Jacobian [n, nf] by the free parameters, and the weight [n] of every
    row.
    """

    rows: FloatArray
    jacobian: FloatArray
    weight: FloatArray


def blocks_in_time(run: IntArray, time: FloatArray) -> IntArray:
    """The block [n, 2] of SHORT that every row is in, of its `run` [n] and `time` [n] in s: the
    run, and the number of the block in it.
    """
    return np.column_stack([run, (time // SHORT).astype(np.int64)])


def robust_scale(rows: FloatArray, equation: IntArray) -> FloatArray:
    """Standard deviation [n] of each row, by the median of its `equation` [n] (Huber, 1981); rows
    without a residual give none: a current that is rounded is exactly zero while a drive is off.
    """
    scale = np.ones(len(rows))
    for number in np.unique(equation):
        own = equation == number
        size = np.abs(rows[own])
        told = size[size > NOTHING * size.max()]
        if told.size:
            scale[own] = float(np.median(told) / stats.norm.ppf(0.75))
    return scale


def huber_weight(rows: FloatArray, scale: FloatArray) -> FloatArray:
    """Huber's weight [n] in a least squares fit of rows with the standard deviation `scale` [n]:
    1 / variance, less for outliers.
    """
    return np.minimum(1.0, DEVIATIONS * scale / np.maximum(np.abs(rows), 1e-300)) / scale**2


def fit_equations(
    space: EquationSpace,
    free: Sequence[FreeParameter],
    values: Mapping[str, float],
    iterations: int,
    executor: Executor | None = None,
    own_torque: bool = False,
) -> dict[str, float]:
    """The values of `free`, and of those tied to them, that fit the rows of `space`: reweighted
    Gauss-Newton steps within bounds, begun at `values` (all parameters of the model). With
    `own_torque` the model's own torque is the instrument (Janot, Vandanjon and Gautier, 2014):
    friction that is a share of the measured one carries the residual that it should explain, and
    comes out too small.

    A prior of one start value (or one scale) around the start of every parameter keeps those in
    place that the rows do not see; thousands of rows, which overlap, outweigh it where they do. A
    step to values at which there are no finite rows is not taken. Raises InputError for `values`
    out of bounds.
    """
    equation, run, time = space.labels()
    blocks = len(np.unique(np.column_stack([equation, blocks_in_time(run, time)]), axis=0))
    overlap = len(equation) / max(blocks, 1)
    here = {f.name: float(np.clip(values[f.name], f.lower, f.upper)) for f in free}
    centre = np.array([f.start for f in free])
    sigma = np.array([f.scale for f in free])
    lower, upper = np.array([f.lower for f in free]), np.array([f.upper for f in free])
    before = here
    for iteration in range(iterations):
        found = linearised(space, free, values, here, executor, own_torque)
        if not (np.all(np.isfinite(found.rows)) and np.all(np.isfinite(found.jacobian))):
            here = before
            break
        at = np.array([here[f.name] for f in free])
        root = np.sqrt(found.weight / np.maximum(overlap, 1.0))
        matrix = np.vstack([found.jacobian * root[:, None], np.diag(1.0 / sigma)])
        right = -np.concatenate([found.rows * root, (at - centre) / sigma])
        size = np.maximum(np.linalg.norm(matrix, axis=0), 1e-300)
        triangle = np.linalg.qr(matrix / size, mode="reduced")
        slack = 1e-12 * np.maximum(np.abs(at), sigma)
        step = (
            lsq_linear(
                triangle[1],
                triangle[0].T @ right,
                ((lower - at - slack) * size, (upper - at + slack) * size),
            ).x
            / size
        )
        new = np.clip(at + step, lower, upper)
        before = here
        here = {f.name: float(v) for f, v in zip(free, new, strict=True)}
        change = np.max(np.abs(new - at) / np.maximum(np.abs(new), SAME * sigma), initial=0.0)
        if change < SAME or iteration == iterations - 1:
            break
    return {name: here[f.name] for f in free for name in f.names}


def linearised(
    space: EquationSpace,
    free: Sequence[FreeParameter],
    values: Mapping[str, float],
    here: Mapping[str, float],
    executor: Executor | None = None,
    own_torque: bool = False,
) -> Linearised:
    """The rows [n] and their difference quotients [n, nf] with `free` at the values `here`, the
    quotients with the model's `own_torque` where it is true (see `EquationSpace.own_torque`).
    Raises InputError for `values` out of bounds.
    """
    model = space.model
    names = list(model.parameter_names)
    base = model.parameter_vector(dict(values))
    owned = [[names.index(n) for n in f.names] for f in free]
    for f, columns in zip(free, owned, strict=True):
        base[columns] = here[f.name]
    rows = space.rows(base)
    own = space.own_torque(base) if own_torque else None
    origin = rows if own is None else space.rows(base, own)

    def quotient(index: int) -> FloatArray:
        f = free[index]
        step = SAME * max(abs(here[f.name]), SAME * f.scale)
        if here[f.name] + step > f.upper:
            step = -step
        shifted = base.copy()
        shifted[owned[index]] += step
        return (space.rows(shifted, own) - origin) / step

    quotients = (executor.map if executor else map)(quotient, range(len(free)))
    slopes: list[FloatArray] = list(quotients)
    jacobian = np.column_stack(slopes) if slopes else np.zeros((len(rows), 0))
    equation, _, _ = space.labels()
    return Linearised(rows, jacobian, huber_weight(rows, robust_scale(rows, equation)))
