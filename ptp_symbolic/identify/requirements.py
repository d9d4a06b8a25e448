"""Keep a search where the machine is possible: no breakaway below sliding friction, for one."""

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.identify.coordinates import FreeParameter, limits
from ptp_symbolic.runtime.model import Model

FloatArray = NDArray[np.float64]
Allow = Callable[[FloatArray, FloatArray], FloatArray]

HALVINGS = 40
DIFFERENCE = 1e-6


def keep_possible(
    model: Model, free: Sequence[FreeParameter], parameters: Callable[[FloatArray], FloatArray]
) -> Allow:
    """Return a function that brings a step from phi to trial [nf] back to where no relation that
    the machine needs is broken: only in the coordinates that the relation is about.

    It goes back at right angles to the edge, so that a search can slide along it, and back the way
    it came where that leads nowhere. `parameters(phi)` gives all parameters [np]. A relation broken
    at phi already is let be.
    """
    requirements = model.module.REQUIREMENTS
    lower, upper = limits(free)
    about = [
        np.array([bool({f.name, *f.tied} & set(names)) for f in free], dtype=np.bool_)
        for names, _, _ in requirements
    ]

    def margin(row: int, phi: FloatArray) -> float:
        margins = np.zeros(len(requirements))
        model.module.margins(parameters(phi), margins)
        return float(margins[row])

    def holds(row: int, phi: FloatArray) -> bool:
        strict = requirements[row][2]
        return margin(row, phi) > 0.0 if strict else margin(row, phi) >= 0.0

    def inward(row: int, phi: FloatArray) -> FloatArray:
        """Unit vector [nf] along which the margin grows fastest."""
        steps = DIFFERENCE * np.diag(about[row].astype(np.float64))
        slope = np.array([margin(row, phi + h) - margin(row, phi - h) for h in steps])
        return slope / max(float(np.linalg.norm(slope)), 1e-300)

    def landed(row: int, back: FloatArray, trial: FloatArray, along: FloatArray) -> FloatArray:
        """Where the relation just holds on the way from trial along a direction, or else `back`."""
        reach = 2.0 * float(np.linalg.norm(trial - back))
        beyond = np.clip(trial + reach * along, lower, upper)
        kept, lost = beyond if holds(row, beyond) else back, trial
        for _ in range(HALVINGS):
            middle = 0.5 * (kept + lost)
            kept, lost = (middle, lost) if holds(row, middle) else (kept, middle)
        return kept

    def allow(phi: FloatArray, trial: FloatArray) -> FloatArray:
        for row, columns in enumerate(about):
            if not columns.any() or holds(row, trial) or not holds(row, phi):
                continue
            back = np.where(columns, phi, trial)
            edge = landed(row, back, trial, inward(row, trial))
            trial = landed(row, back, trial, inward(row, edge))
        return trial

    return allow
