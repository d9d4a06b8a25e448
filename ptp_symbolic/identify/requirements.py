"""Keep a search where the machine is possible: no breakaway below sliding friction, for one."""

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.identify.coordinates import FreeParameter
from ptp_symbolic.runtime.model import Model

FloatArray = NDArray[np.float64]
Allow = Callable[[FloatArray, FloatArray], FloatArray]

HALVINGS = 30


def keep_possible(
    model: Model, free: Sequence[FreeParameter], parameters: Callable[[FloatArray], FloatArray]
) -> Allow:
    """Return a function that cuts a step from phi to trial [nf] short, so that no relation that
    the machine needs is broken: only in the coordinates that the relation is about.

    `parameters(phi)` gives all parameters [np]. A relation broken at phi already is let be.
    """
    requirements = model.module.REQUIREMENTS
    about = [
        np.array([bool({f.name, *f.tied} & set(names)) for f in free], dtype=np.bool_)
        for names, _, _ in requirements
    ]

    def holds(row: int, phi: FloatArray) -> bool:
        margin = np.zeros(len(requirements))
        model.module.margins(parameters(phi), margin)
        strict = requirements[row][2]
        return bool(margin[row] > 0.0 if strict else margin[row] >= 0.0)

    def allow(phi: FloatArray, trial: FloatArray) -> FloatArray:
        for row, columns in enumerate(about):
            if not columns.any() or holds(row, trial) or not holds(row, phi):
                continue
            whole, kept, lost = trial, 0.0, 1.0
            for _ in range(HALVINGS):
                middle = 0.5 * (kept + lost)
                trial = np.where(columns, phi + middle * (whole - phi), whole)
                kept, lost = (middle, lost) if holds(row, trial) else (kept, middle)
            trial = np.where(columns, phi + kept * (whole - phi), whole)
        return trial

    return allow
