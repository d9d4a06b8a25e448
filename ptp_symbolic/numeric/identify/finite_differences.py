"""Finite differences in the Jacobian of a finished fit, for intervals and tests."""

from collections.abc import Sequence
from concurrent.futures import Executor
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.identify.constants import MISLEADING, MOST, ROUGH, STEP
from ptp_symbolic.numeric.identify.coordinates import to_search
from ptp_symbolic.numeric.identify.evaluate import Evaluation
from ptp_symbolic.numeric.identify.fit import Fit
from ptp_symbolic.numeric.identify.intervals import reaches
from ptp_symbolic.numeric.identify.simulations import POLISH, Effort, problem_of, simulations_of

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]


def with_finite_differences(
    fit: Fit, executor: Executor | None = None, reach: FloatArray | None = None
) -> Fit:
    """`fit` with finite differences in its Jacobians where the tangents at the optimum are blind to
    what these see: friction that holds, or lets go a sample later, makes the residual a staircase
    of a parameter.

    The differences go over a usual step, or as far as the parameters may be off where that `reach`
    [nf] in search coordinates is given. Where they stand in and tell a parameter far better than
    their step, that is too long: one jump somewhere in it says that the parameter is no further
    off, but not where it is. So it is shortened until the interval is about as long; where it never
    is, the tangents stay.
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
    steps = np.full(len(phi), STEP) if reach is None else np.minimum(reach, STEP)
    steps = np.where(steps > 0.0, steps, STEP)
    wanted = np.ones(len(phi), dtype=np.bool_)
    for _ in range(POLISH):
        shifts = [(run, int(c)) for run in range(len(here)) for c in np.flatnonzero(wanted)]
        finite = replace(problem.refine, step=steps, chosen=shifts)(phi, fit.z, here)
        blind = [_is_blind(*pair, steps) for pair in zip(here, finite, strict=True)]
        parts = zip(blind, here, finite, strict=True)
        columns = [np.where(b, f.by_parameter, e.by_parameter) for b, e, f in parts]
        fit = _with_columns(fit, columns, wanted)
        if reach is not None:
            return fit
        found = reaches(fit)
        wanted &= np.any(blind, axis=0) & (found < MOST * steps)
        if not wanted.any():
            return fit
        steps = np.where(wanted, np.maximum(found, MOST**2 * steps), steps)
    return _with_columns(fit, [e.by_parameter for e in here], wanted)


def _with_columns(fit: Fit, columns: Sequence[FloatArray], wanted: BoolArray) -> Fit:
    """`fit` with the `wanted` [nf] columns of other Jacobians, one per run."""
    parts = zip(fit.evaluations, columns, strict=True)
    every = [replace(e, by_parameter=np.where(wanted, c, e.by_parameter)) for e, c in parts]
    return replace(fit, evaluations=tuple(every))


def _is_blind(at_point: Evaluation, finite: Evaluation, steps: FloatArray) -> BoolArray:
    """Which tangents [nf] of a run are blind to what differences over `steps` [nf] see, beyond what
    errors of the simulation may change.
    """
    seen, size = (np.linalg.norm(e.by_parameter, axis=0) for e in (at_point, finite))
    by_errors = ROUGH * np.sqrt(len(at_point.residual)) / steps
    return np.asarray((size > by_errors) & (seen < MISLEADING * size))
