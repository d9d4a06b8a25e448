"""Whether the torque of an effect goes with the rate as its law says.

What has the shape of an effect along the angle, but another law of the rate, has to be of one size
where its axis is slow and of another where it is fast. Simulations hardly see that, for they
integrate both; the rows of the equation space do.
"""

from collections.abc import Mapping, Sequence

import numpy as np

from ptp_symbolic.numeric.diagnose.candidates import Candidate
from ptp_symbolic.numeric.diagnose.linear import projected_off
from ptp_symbolic.numeric.diagnose.regression import block_numbers
from ptp_symbolic.numeric.diagnose.trial import Task, all_free
from ptp_symbolic.numeric.identify.blocks import SINGULAR, jackknife_covariance, leave_blocks_out
from ptp_symbolic.numeric.identify.constants import FAR, FEWEST_BLOCKS, MATERIAL, MOST
from ptp_symbolic.numeric.identify.equation_fit import linearised
from ptp_symbolic.numeric.identify.equation_space import EquationSpace
from ptp_symbolic.numeric.identify.row_motion import row_motion


def breaks_its_law(
    task: Task,
    space: EquationSpace,
    candidates: Sequence[Candidate],
    values: Mapping[str, float],
    member: Candidate,
    *,
    loosely: bool = False,
) -> bool:
    """Whether the torque of a member of a set at `values` changes with the speed of its axis in
    another way than its law says, clearly, and by a material share of what the rows ask for or
    by most of its own: a multiple of it times speed / mean speed - 1 is added, where all parameters
    are free, its own too. That multiple is 0 by its law, and 1 for what goes with the speed beside
    that. Blocks of time are left out in turn to tell how clear it is. `loosely` it has to be both,
    a material share and most of its own: the friction of a real machine follows no law exactly.
    Errors of sensors are no torques, and what acts on currents or temperatures comes to the joint
    through these, late.
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
    block = block_numbers(run[known], time[known])
    if len(np.unique(block)) < FEWEST_BLOCKS:
        return False
    root = np.sqrt(at.weight[known])
    rows, effect = root * at.rows[known], root * (at.rows - without)[known]
    table = root[:, None] * at.jacobian[known]
    mine = np.array([f.name in member.parameters for f in free])
    own = projected_off(effect[:, None], table[:, ~mine])[:, 0]
    if not (np.all(np.isfinite(own)) and np.any(own)):
        return False
    growing = effect * (speed[known] / np.average(speed[known], weights=own**2) - 1.0)
    columns = np.column_stack([growing, table])
    size = np.maximum(np.linalg.norm(columns, axis=0), 1e-300)
    change = -np.linalg.lstsq(columns / size, rows, rcond=SINGULAR)[0]
    left = leave_blocks_out(rows + columns / size @ change, columns / size, block)
    variance = float(jackknife_covariance(left.shifts)[0, 0])
    change, clear = change / size, change[0] ** 2 > FAR**2 * variance
    added = change[0] * growing[:, None]
    beside_all, beside_others = (projected_off(added, t)[:, 0] for t in (table, table[:, ~mine]))
    whole = own + beside_others
    material = beside_all @ beside_all > MATERIAL * (whole @ whole)
    scaled = 1.0 + float(own @ table[:, mine] @ change[1:][mine]) / float(own @ own)
    most = abs(change[0]) > MOST * abs(scaled)
    return bool(clear and (material and most if loosely else material or most))
