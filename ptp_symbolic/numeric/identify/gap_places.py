"""Where a gear stands in its gap when a run begins: no sensor shows it, the rest of the run does.

The gear stays ahead of where it was thought to be by the same angle ever after, and the joint
follows it: the residual of the joint's angle moves as a whole, and its median falls with the place,
almost in a straight line. The sum of squares along the same place is rough, for bounces and rests
change with it. The place is therefore the root of the median (Brent, 1973), not a least square.
"""

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, field
from functools import partial

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from ptp_symbolic.numeric.identify.evaluate import Tolerance, evaluate
from ptp_symbolic.numeric.identify.run import Run
from ptp_symbolic.numeric.runtime.model import Model

FloatArray = NDArray[np.float64]
Residual = Callable[[FloatArray], FloatArray | None]


def gears_in_place(
    model: Model,
    runs: Sequence[Run],
    values: Mapping[str, float],
    z: Sequence[FloatArray],
    tolerance: Tolerance,
    executor: Executor | None,
) -> list[FloatArray]:
    """The start unknowns `z`, each [nz], of every run with the gears where `with_gap_places` finds
    them for the parameter `values`. Raises InputError for values out of bounds.
    """
    simulated = partial(residual_of, model, model.parameter_vector(values), tolerance)

    def one(run: Run, start: FloatArray) -> FloatArray:
        return with_gap_places(run, start, partial(simulated, run))

    return list((executor.map if executor else map)(one, runs, z))


def residual_of(
    model: Model, p: FloatArray, tolerance: Tolerance, run: Run, z: FloatArray
) -> FloatArray | None:
    """Weighted residual [k * ny] of a run at p [np]; None where the simulation fails."""
    e = evaluate(model, run, p, z, np.zeros(0, dtype=np.int64), False, tolerance)
    return None if e.failed else e.residual


def with_gap_places(run: Run, z: FloatArray, residual: Residual) -> FloatArray:
    """The start unknowns `z` [nz] of `run` with the place in every gap at the root of the median of
    the `residual` [k * ny], in units of the noise; as they are where that fits no better, or where
    simulations fail.
    """
    for index, unknown in enumerate(run.unknowns):
        if unknown.contact is not None and unknown.column is not None:
            z = _Gap(run, z, index, unknown.column, residual).filled()
    return z


class _NotSimulatedError(Exception):
    """A simulation on the way failed."""


@dataclass(frozen=True, eq=False)
class _Gap:
    """A gap whose place is entry `index` of `z` and moves the signal `column`; `squares` and
    `medians` by the places that were simulated.
    """

    run: Run
    z: FloatArray
    index: int
    column: int
    residual: Residual
    squares: dict[float, float] = field(default_factory=dict)
    medians: dict[float, float] = field(default_factory=dict)

    def filled(self) -> FloatArray:
        """`z` with the place that fits best of those looked at on the way to the root."""
        try:
            self._look()
        except _NotSimulatedError:
            return self.z
        return self._at(min(self.squares, key=lambda place: self.squares[place]))

    def _look(self) -> None:
        """Go to the root from where `z` is, unless only noise is to be gained."""
        here = float(self.z[self.index])
        median = self._median(here)
        end = 1.0 if median > 0.0 else -1.0
        if abs(median) <= 1.0 or (end - here) * median <= 0.0:
            return
        other = self._median(end)
        if other * median < 0.0:
            one_sigma = abs((end - here) / (other - median))
            brentq(self._median, here, end, xtol=one_sigma, disp=False)

    def _at(self, place: float) -> FloatArray:
        shifted = self.z.copy()
        shifted[self.index] = place
        return shifted

    def _median(self, place: float) -> float:
        """Median of the residual of the joint's angle in units of its noise."""
        if place not in self.medians:
            found = self.residual(self._at(place))
            if found is None:
                raise _NotSimulatedError
            self.squares[place] = float(found @ found)
            signal = found.reshape(self.run.measured.shape)[:, self.column]
            self.medians[place] = float(np.median(signal))
        return self.medians[place]
