"""How a joint moved at the rows of the equation space: angle, rate, time since it turned back."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.identify.equation_rows import resting_rates
from ptp_symbolic.numeric.identify.equation_space import EquationSpace
from ptp_symbolic.numeric.identify.run import Run

FloatArray = NDArray[np.float64]


class RowMotion(NamedTuple):
    """Motion of an axis at its rows [n]: angle in rad, rate in rad/s, and the time in s since the
    joint turned back, nan before it first did.
    """

    angle: FloatArray
    rate: FloatArray
    since_reversal: FloatArray


def row_motion(space: EquationSpace, axis: int) -> RowMotion:
    """The measured motion of `axis` at the rows of its own equation: the angle as it was measured,
    the rate as a central difference over a window.
    """
    equation, number, time = space.labels()
    own = equation == axis
    found = np.full((3, int(own.sum())), np.nan)
    for k, run in enumerate(space.runs):
        here = number[own] == k
        if here.any():
            found[:, here] = _along(space, run, axis, time[own][here])
    return RowMotion(*found)


def _along(space: EquationSpace, run: Run, axis: int, time: FloatArray) -> FloatArray:
    """Angle, rate and time since reversal [3, n] of one run at `time` [n]."""
    column = run.signals.index(f"theta_{space.model.module.AXES[axis]}")
    measured = run.measured[:, column]
    h = space.half_width

    def rate_at(at: FloatArray) -> FloatArray:
        ahead, behind = (np.interp(at + d, run.time, measured) for d in (h, -h))
        return np.asarray((ahead - behind) / (2.0 * h))

    rate = rate_at(run.time)
    rate[np.abs(rate) <= _slowest(space, run, column)] = 0.0
    moving = np.flatnonzero(rate)
    turns = np.flatnonzero(np.diff(np.sign(rate[moving])) != 0.0)
    reversals = run.time[moving[turns + 1]]
    last = np.searchsorted(reversals, time, side="right") - 1
    since = np.full(len(time), np.nan)
    since[last >= 0] = time[last >= 0] - reversals[last[last >= 0]]
    return np.stack([np.interp(time, run.time, measured), rate_at(time), since])


def _slowest(space: EquationSpace, run: Run, column: int) -> float:
    """The rate in rad/s that noise and rounding of a signal give a joint at rest."""
    period = float(np.median(np.diff(run.time)))
    noise = 1.0 / run.weight[[column]]
    return float(resting_rates(run.counts[[column]], noise, period, space.half_width)[0])
