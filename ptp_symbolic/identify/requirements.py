"""Keep a search where the machine is possible: no breakaway below sliding friction, for one."""

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.identify.coordinates import FreeParameter
from ptp_symbolic.runtime.model import Model

FloatArray = NDArray[np.float64]
Allow = Callable[[FloatArray, FloatArray], FloatArray]

HALVINGS, CORRECTIONS, DIFFERENCE = 30, 20, 1e-6


def keep_possible(
    model: Model, free: Sequence[FreeParameter], parameters: Callable[[FloatArray], FloatArray]
) -> Allow:
    """Return a function that bends a step from phi to trial [nf], so that no relation that the
    machine needs is broken: up to the boundary, then along it, and only in the coordinates that
    the relation is about (gradient projection: Rosen, 1960).

    `parameters(phi)` gives all parameters [np]. A relation broken at phi already is let be.
    """
    requirements = model.module.REQUIREMENTS
    about = [
        np.array([bool({f.name, *f.tied} & set(names)) for f in free], dtype=np.bool_)
        for names, _, _ in requirements
    ]

    def margin(row: int, phi: FloatArray) -> float:
        found = np.zeros(len(requirements))
        model.module.margins(parameters(phi), found)
        return float(found[row])

    def holds(row: int, phi: FloatArray) -> bool:
        by = margin(row, phi)
        return by > 0.0 if requirements[row][2] else by >= 0.0

    def cut(row: int, phi: FloatArray, step: FloatArray) -> float:
        """The largest share of `step` after which the relation still holds."""
        kept, lost = 0.0, 1.0
        for _ in range(HALVINGS):
            middle = 0.5 * (kept + lost)
            kept, lost = (middle, lost) if holds(row, phi + middle * step) else (kept, middle)
        return kept

    def gradient(row: int, phi: FloatArray) -> FloatArray:
        """Derivatives [nf] of the margin by the coordinates that it is about."""
        slope = np.zeros(len(phi))
        for i in np.flatnonzero(about[row]):
            ahead = phi.copy()
            ahead[i] += DIFFERENCE
            slope[i] = (margin(row, ahead) - margin(row, phi)) / DIFFERENCE
        return slope

    def bent(row: int, phi: FloatArray, step: FloatArray) -> FloatArray:
        boundary = phi + cut(row, phi, step) * step
        rest, slope = phi + step - boundary, gradient(row, boundary)
        inward = slope / max(float(slope @ slope), 1e-300)
        rest -= inward * min(0.0, float(slope @ rest))
        for _ in range(CORRECTIONS):
            by = margin(row, boundary + rest)
            if holds(row, boundary + rest):
                return boundary + rest
            rest += inward * (DIFFERENCE * abs(by) - by)
        return boundary

    def allow(phi: FloatArray, trial: FloatArray) -> FloatArray:
        for row, columns in enumerate(about):
            if columns.any() and holds(row, phi) and not holds(row, trial):
                step = np.where(columns, trial - phi, 0.0)
                trial = np.where(columns, bent(row, phi, step), trial)
        return trial

    return allow
