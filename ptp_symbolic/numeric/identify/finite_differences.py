"""Finite differences in the Jacobian of a finished fit, for intervals and tests."""

from concurrent.futures import Executor
from dataclasses import replace

import numpy as np

from ptp_symbolic.numeric.identify.constants import MISLEADING, STEP
from ptp_symbolic.numeric.identify.coordinates import to_search
from ptp_symbolic.numeric.identify.fit import Fit
from ptp_symbolic.numeric.identify.simulations import Effort, problem_of, simulations_of


def with_finite_differences(fit: Fit, executor: Executor | None = None) -> Fit:
    """`fit` with finite-difference columns in its Jacobians where the tangents at the optimum are
    blind to such a step: intervals of an effect that acts through breakaways need them.
    """
    if not fit.free or fit.failed:
        return fit
    effort = Effort(tolerance=fit.tolerance, secants=STEP)
    simulations = simulations_of(fit.model, fit.runs, fit.free, fit.values, effort, executor)
    problem = problem_of(simulations, effort)
    assert problem.refine is not None
    phi = to_search(fit.free, fit.values)
    here = problem.evaluate(phi, fit.z, True)
    refined = problem.refine(phi, fit.z, here)
    chosen = []
    for at_point, finite in zip(here, refined, strict=True):
        seen, size = (np.linalg.norm(e.by_parameter, axis=0) for e in (at_point, finite))
        columns = np.where(seen < MISLEADING * size, finite.by_parameter, at_point.by_parameter)
        chosen.append(replace(at_point, by_parameter=columns))
    return replace(fit, evaluations=tuple(chosen))
