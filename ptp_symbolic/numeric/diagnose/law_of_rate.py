"""Whether the torque of an effect goes with the rate as its law says.

What has the shape of an effect along the angle, but another law of the rate, has to be of one size
where its axis is slow and of another where it is fast. Simulations hardly see that, for they
integrate both; the rows of the equation space do.
"""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.diagnose.candidates import Candidate
from ptp_symbolic.numeric.diagnose.linear import projected_off
from ptp_symbolic.numeric.diagnose.regression import blocks_of
from ptp_symbolic.numeric.diagnose.trial import Task, all_free
from ptp_symbolic.numeric.identify.constants import FAR, FEWEST_BLOCKS, MATERIAL
from ptp_symbolic.numeric.identify.equation_fit import linearised
from ptp_symbolic.numeric.identify.equation_space import EquationSpace
from ptp_symbolic.numeric.identify.row_motion import row_motion

FloatArray = NDArray[np.float64]


def breaks_its_law(
    task: Task,
    space: EquationSpace,
    candidates: Sequence[Candidate],
    values: Mapping[str, float],
    member: Candidate,
) -> bool:
    """Whether the torque of a member of a set at `values` changes with the speed of its axis in
    another way than its law says, clearly, and by a material share of it: a multiple of it times
    speed / mean speed - 1 is added, where all parameters are free, its own too. Rows of one block
    of time count as one (sandwich of clusters: Liang and Zeger, 1986). Errors of sensors are no
    torques, and what acts on currents or temperatures comes to the joint through these, late.
    """
    names = list(task.model.parameter_names)
    elsewhere = space.sensing | space.moving
    if any(elsewhere[names.index(name)] for name in member.names):
        return False
    free = all_free(task, candidates, values)
    at = linearised(space, free, values, {f.name: values[f.name] for f in free}, task.executor)
    without = space.rows(task.model.parameter_vector({**values, **member.vanishing}))
    equation, run, time = space.labels()
    speed = np.full(len(equation), np.nan)
    for axis in range(len(space.layout.angle)):
        speed[equation == axis] = np.abs(row_motion(space, axis).rate)
    known = np.isfinite(speed)
    _, block = np.unique(blocks_of(run, time)[known], axis=0, return_inverse=True)
    block = block.reshape(-1)
    if len(np.unique(block)) < FEWEST_BLOCKS:
        return False
    root = np.sqrt(at.weight[known])
    rows, effect = root * at.rows[known], root * (at.rows - without)[known]
    table = root[:, None] * at.jacobian[known]
    others = table[:, [k for k, f in enumerate(free) if f.name not in member.parameters]]
    own = projected_off(effect[:, None], others)[:, 0]
    if not (np.all(np.isfinite(own)) and np.any(own)):
        return False
    growing = effect * (speed[known] / np.average(speed[known], weights=own**2) - 1.0)
    amount, variance = _amount(rows, growing, table, block)
    added = amount * projected_off(growing[:, None], table)[:, 0]
    whole = own + amount * projected_off(growing[:, None], others)[:, 0]
    is_clear = amount**2 > FAR**2 * variance
    return bool(is_clear and added @ added > MATERIAL * (whole @ whole))


def _amount(
    rows: FloatArray, column: FloatArray, others: FloatArray, block: NDArray[np.int64]
) -> tuple[float, float]:
    """How much of a `column` [n] has to be added to the `rows` [n] to leave least, with any amounts
    of the `others` [n, k], and its variance by `block` [n].
    """
    table = np.column_stack([column, others])
    length = np.maximum(np.linalg.norm(table, axis=0), 1e-300)
    unit = table / length
    inverse = np.linalg.pinv(unit.T @ unit, hermitian=True)
    change = -inverse @ (unit.T @ rows)
    left = rows + unit @ change
    scores = np.array([np.bincount(block, c * left) for c in unit.T])
    spread = inverse[0] @ scores
    return float(change[0] / length[0]), float(spread @ spread / length[0] ** 2)
