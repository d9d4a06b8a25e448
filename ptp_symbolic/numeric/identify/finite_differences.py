"""Finite differences in the Jacobian of a finished fit, for intervals and tests."""

from concurrent.futures import Executor
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.identify.constants import ITERATIONS, MISLEADING, MOST, STEP
from ptp_symbolic.numeric.identify.coordinates import to_search
from ptp_symbolic.numeric.identify.evaluate import Evaluation
from ptp_symbolic.numeric.identify.fit import Fit
from ptp_symbolic.numeric.identify.intervals import reaches
from ptp_symbolic.numeric.identify.simulations import Effort, problem_of, simulations_of

BoolArray = NDArray[np.bool_]


def with_finite_differences(fit: Fit, executor: Executor | None = None) -> Fit:
    """`fit` with finite differences in its Jacobians where the tangents at the optimum are blind to
    them: friction that holds, or lets go a sample later, makes the residual a staircase of a
    parameter.

    The differences reach as far as the interval by the tangents does, or over a usual step where
    that is shorter. Where they tell a parameter far better than that, the step is too long: one
    jump somewhere in it says that the parameter is no further off, but not where it is. So it is
    shortened until the interval is about as long.
    """
    if not fit.free or fit.failed:
        return fit
    effort = Effort(tolerance=fit.tolerance, secants=STEP)
    simulations = simulations_of(fit.model, fit.runs, fit.free, fit.values, effort, executor)
    problem = problem_of(simulations, effort)
    assert problem.refine is not None
    phi = to_search(fit.free, fit.values)
    here = problem.evaluate(phi, fit.z, True)
    fit = replace(fit, evaluations=tuple(here))
    steps = np.minimum(reaches(fit), STEP)
    steps = np.where(steps > 0.0, steps, STEP)
    wanted = np.ones(len(phi), dtype=np.bool_)
    for _ in range(ITERATIONS):
        shifts = [(run, int(c)) for run in range(len(here)) for c in np.flatnonzero(wanted)]
        refined = replace(problem.refine, step=steps, chosen=shifts)(phi, fit.z, here)
        parts = zip(fit.evaluations, here, refined, strict=True)
        fit = replace(fit, evaluations=tuple(_seeing(*part, wanted) for part in parts))
        reach = reaches(fit)
        wanted = reach < MOST * steps
        if not wanted.any():
            break
        steps = np.where(wanted, np.maximum(reach, MOST**2 * steps), steps)
    return fit


def _seeing(
    before: Evaluation, at_point: Evaluation, finite: Evaluation, wanted: BoolArray
) -> Evaluation:
    """A run with the derivatives of `before`; of the `wanted` [nf] parameters with its tangents, or
    with differences in the place of those that are blind to them.
    """
    seen, size = (np.linalg.norm(e.by_parameter, axis=0) for e in (at_point, finite))
    columns = np.where(seen < MISLEADING * size, finite.by_parameter, at_point.by_parameter)
    return replace(before, by_parameter=np.where(wanted, columns, before.by_parameter))
