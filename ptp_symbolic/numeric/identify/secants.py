"""Finite-difference Jacobians, where the derivatives at a point mislead.

Zero-order-hold inputs let a friction break away at one sample or the next: the residual is then a
staircase of the parameter, and its derivative sees the treads alone. Bounces in a gap that appear
and vanish do the same. A difference over a finite step sees both.
"""

from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.identify.constants import MISLEADING, STEP
from ptp_symbolic.numeric.identify.evaluate import Evaluation

FloatArray = NDArray[np.float64]
Shift = tuple[int, int]
Residual = Callable[[int, FloatArray, FloatArray], FloatArray | None]


@dataclass(eq=False)
class Secants:
    """Replaces misleading columns of the Jacobians by phi [nf] with finite differences.

    `residual(run, phi, z)` simulates one run (None: it failed); `upper` [nf] bounds phi. The first
    call compares every column of every run, later ones only those that misled, `chosen`; `step` is
    that of the differences, in search coordinates, or one for each of them [nf].
    """

    residual: Residual
    upper: FloatArray
    executor: Executor | None = None
    chosen: list[Shift] | None = None
    step: float | FloatArray = STEP

    def __call__(
        self, phi: FloatArray, z: Sequence[FloatArray], evaluations: Sequence[Evaluation]
    ) -> list[Evaluation]:
        """`evaluations` at (phi, z) with their derivatives by phi refined."""
        every = [(r, c) for r in range(len(evaluations)) for c in range(len(phi))]
        shifts = every if self.chosen is None else self.chosen
        steps = np.broadcast_to(self.step, phi.shape)

        def difference(shift: Shift) -> FloatArray:
            run, column = shift
            step = float(steps[column])
            step = step if phi[column] + step <= self.upper[column] else -step
            shifted = phi.copy()
            shifted[column] += step
            after = self.residual(run, shifted, z[run])
            if after is None:
                return evaluations[run].by_parameter[:, column]
            return (after - evaluations[run].residual) / step

        run_each = self.executor.map if self.executor else map
        columns = list(run_each(difference, shifts))
        if self.chosen is None:
            self.chosen = [
                (r, c)
                for (r, c), column in zip(shifts, columns, strict=True)
                if _misleads(evaluations[r].by_parameter[:, c], column)
            ]
        return _replaced(evaluations, shifts, columns)


def _misleads(tangent: FloatArray, secant: FloatArray) -> bool:
    return bool(np.linalg.norm(tangent - secant) > MISLEADING * np.linalg.norm(secant))


def _replaced(
    evaluations: Sequence[Evaluation], shifts: Sequence[Shift], columns: Sequence[FloatArray]
) -> list[Evaluation]:
    jacobians = [e.by_parameter.copy() for e in evaluations]
    for (run, column), values in zip(shifts, columns, strict=True):
        jacobians[run][:, column] = values
    return [replace(e, by_parameter=j) for e, j in zip(evaluations, jacobians, strict=True)]
