"""Whether an effect is as large where its axis is slow as where it is fast.

The law of an effect says how its torque goes with the rate. What has its name, but another law, has
to be of one size in the slow part of the motion and of another in the fast one, which simulations
hardly see: they integrate both. The rows of the equation space tell them apart.
"""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.diagnose.candidates import Candidate
from ptp_symbolic.numeric.diagnose.linear import projected_off
from ptp_symbolic.numeric.diagnose.regression import blocks_of
from ptp_symbolic.numeric.diagnose.trial import Task, all_free
from ptp_symbolic.numeric.identify.constants import FEWEST_BLOCKS, MATERIAL, SEEN
from ptp_symbolic.numeric.identify.equation_fit import linearised
from ptp_symbolic.numeric.identify.equation_space import EquationSpace
from ptp_symbolic.numeric.identify.row_motion import row_motion

FloatArray = NDArray[np.float64]


def differs_with_speed(
    task: Task,
    space: EquationSpace,
    candidates: Sequence[Candidate],
    values: Mapping[str, float],
    member: Candidate,
) -> bool:
    """Whether the torque of a member of a set at `values` has clearly different sizes at the slower
    and at the faster rows of its axis, each with half of what is known of it: so different that one
    size for both leaves a material share of it. All other parameters are free, and common to both;
    rows of one block of time count as one (sandwich of clusters: Liang and Zeger, 1986).
    """
    free = all_free(task, candidates, values)
    at = linearised(space, free, values, {f.name: values[f.name] for f in free}, task.executor)
    without = space.rows(task.model.parameter_vector({**values, **member.vanishing}))
    equation, run, time = space.labels()
    speed = np.full(len(equation), np.nan)
    for axis in range(len(space.layout.angle)):
        speed[equation == axis] = np.abs(row_motion(space, axis).rate)
    known = np.isfinite(speed)
    root = np.sqrt(at.weight[known])
    rows, effect = root * at.rows[known], root * (at.rows - without)[known]
    others = [k for k, f in enumerate(free) if f.name not in member.parameters]
    table = root[:, None] * at.jacobian[known][:, others]
    own = projected_off(effect[:, None], table)[:, 0]
    order = np.argsort(speed[known])
    told = np.cumsum(own[order] ** 2)
    if not (len(told) and np.isfinite(told[-1]) and told[-1] > 0.0):
        return False
    is_fast = np.zeros(len(own), dtype=np.bool_)
    is_fast[order[np.searchsorted(told, 0.5 * told[-1]) :]] = True
    _, block = np.unique(blocks_of(run, time)[known], axis=0, return_inverse=True)
    block = block.reshape(-1)
    if min(len(np.unique(block[part])) for part in (is_fast, ~is_fast)) < FEWEST_BLOCKS:
        return False
    columns = np.column_stack([effect * ~is_fast, effect * is_fast, table])
    sizes, covariance = _sizes(rows, columns, block)
    difference, total = sizes[1] - sizes[0], sizes[1] + sizes[0]
    scatter = covariance[0, 0] + covariance[1, 1] - 2.0 * covariance[0, 1]
    is_clear = difference**2 > SEEN**2 * scatter
    return bool(is_clear and difference**2 > MATERIAL * total**2)


def _sizes(
    rows: FloatArray, columns: FloatArray, block: NDArray[np.int64]
) -> tuple[FloatArray, FloatArray]:
    """How much of the first two `columns` [n, k], which are in the `rows` [n] once, there should
    be [2], beside any amounts of the others; and its covariance [2, 2] by `block` [n].
    """
    length = np.maximum(np.linalg.norm(columns, axis=0), 1e-300)
    unit = columns / length
    inverse = np.linalg.pinv(unit.T @ unit, hermitian=True)
    change = -inverse @ (unit.T @ rows)
    left = rows + unit @ change
    scores = np.array([np.bincount(block, column * left) for column in unit.T])
    covariance = inverse @ (scores @ scores.T) @ inverse
    return 1.0 + change[:2] / length[:2], covariance[:2, :2] / np.outer(length[:2], length[:2])
