"""Runs replayed with the noise of their inputs once more: what it leaves in the outputs, and what a
fit follows of it.

Finite differences in the Jacobian of a finished fit, for intervals and tests.
"""

from collections.abc import Sequence
from concurrent.futures import Executor
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.identify.blocks import huber_root
from ptp_symbolic.numeric.identify.constants import (
    MISLEADING,
    MOST,
    REPEATS,
    REPLAYS,
    ROUGH,
    SEED,
    STEP,
)
from ptp_symbolic.numeric.identify.coordinates import to_search
from ptp_symbolic.numeric.identify.evaluate import Evaluation, Tolerance, evaluate, mean_squares
from ptp_symbolic.numeric.identify.evidence import derived, is_recording
from ptp_symbolic.numeric.identify.fit import Fit
from ptp_symbolic.numeric.identify.intervals import project_out, reaches
from ptp_symbolic.numeric.identify.noise import white_noise
from ptp_symbolic.numeric.identify.robust_loss import weighted_median
from ptp_symbolic.numeric.identify.run import Run, with_inputs
from ptp_symbolic.numeric.identify.simulations import (
    DEFAULT_TOLERANCE,
    POLISH,
    Effort,
    problem_of,
    simulations_of,
)
from ptp_symbolic.numeric.runtime.model import Model

BoolArray = NDArray[np.bool_]
FloatArray = NDArray[np.float64]


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
    if not is_recording():
        return _with_finite_differences(fit, executor, reach)

    def changed() -> Sequence[Evaluation]:
        return _with_finite_differences(fit, executor, reach).evaluations

    squares = mean_squares(fit.evaluations, fit.runs)
    return replace(fit, evaluations=derived("finite differences", (fit, reach), changed, squares))


def _with_finite_differences(fit: Fit, executor: Executor | None, reach: FloatArray | None) -> Fit:
    """See `with_finite_differences`, of a fit that has free parameters and has not failed."""
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


def input_noise(run: Run, declared: Sequence[float | None]) -> FloatArray:
    """Noise (rms) of every input [nu] in its unit: as declared, else as its samples show it."""
    columns = zip(run.held_inputs.T, declared, strict=True)
    return np.array([white_noise(c, run.time) if d is None else d for c, d in columns])


def noisier(run: Run, noise: FloatArray, rng: np.random.Generator) -> Run:
    """`run` with more `noise` (rms) [nu] on its inputs."""
    return with_inputs(run, run.held_inputs + noise * rng.standard_normal(run.held_inputs.shape))


def replayed(
    model: Model,
    run: Run,
    p: FloatArray,
    z: FloatArray,
    noise: FloatArray,
    rng: np.random.Generator,
    times: int = 1,
    tolerance: Tolerance = DEFAULT_TOLERANCE,
) -> tuple[FloatArray, FloatArray]:
    """Changes [k * ny, times] of the weighted residuals by input noise, each from another draw, and
    the Jacobian by the start of the run; nan where it cannot be simulated. Inputs change at samples
    alone, whatever the log has in between.
    """
    none = np.zeros(0, dtype=np.int64)
    plain = evaluate(model, with_inputs(run, run.held_inputs), p, z, none, True, tolerance)
    changes = np.full((run.size, times), np.nan)
    for column in changes.T:
        other = evaluate(model, noisier(run, noise, rng), p, z, none, False, tolerance)
        if not (plain.failed or other.failed):
            column[:] = other.residual - plain.residual
    return changes, plain.by_start


def replayed_squares(
    model: Model,
    runs: Sequence[Run],
    z: Sequence[FloatArray],
    p: FloatArray,
    declared_noise: Sequence[float | None],
    executor: Executor | None = None,
) -> FloatArray:
    """What input noise leaves in the residual of a perfect model: mean squares [REPEATS, runs, ny]
    of the replays of every run, in units of the noise of every signal (see `Run.weight`); nan where
    a run cannot be simulated. What its unknown start can take up is projected out.
    """

    def squares(number: int) -> FloatArray:
        run, rng = runs[number], np.random.default_rng((SEED, number))
        noise = input_noise(run, declared_noise)
        if not np.any(noise):
            return np.zeros((REPEATS, len(run.signals)))
        changes, by_start = replayed(model, run, p, z[number], noise, rng, REPEATS)
        left = project_out(changes, by_start).reshape(*run.measured.shape, REPEATS)
        return np.asarray(np.mean(left**2, axis=0).T)

    every = (executor.map if executor else map)(squares, range(len(runs)))
    return np.stack(list(every), axis=1)


def propagated_noise(
    model: Model,
    runs: Sequence[Run],
    z: Sequence[FloatArray],
    p: FloatArray,
    declared_noise: Sequence[float | None],
    executor: Executor | None = None,
) -> FloatArray:
    """Root mean square [runs, ny] of what input noise leaves, over all replays of
    `replayed_squares` but the one that leaves most, which may stick elsewhere.
    """
    squares = np.sort(replayed_squares(model, runs, z, p, declared_noise, executor), axis=0)
    return np.asarray(np.sqrt(np.mean(squares[:-1], axis=0)))


def estimable(
    fit: Fit, declared_noise: Sequence[float | None], executor: Executor | None = None
) -> Fit:
    """A finished fit with all that its intervals need: what the noise of the inputs changes, and
    derivatives that are not blind.
    """
    return with_finite_differences(with_input_noise(fit, declared_noise, executor), executor)


def with_input_noise(
    fit: Fit, declared_noise: Sequence[float | None], executor: Executor | None = None
) -> Fit:
    """`fit` with what the noise of its inputs, as declared or as their samples show it, leaves in
    its residuals: intervals allow for it. A fit follows in part what that noise leaves, and the
    fewer runs tell, the more: the residual is no measure of it then.

    As many replays as make REPLAYS of all runs or windows together. Those that change far more
    than usual, as where the machine sticks elsewhere, weigh less, as they do in the fit.
    """
    if not fit.free or fit.failed:
        return fit

    def changed() -> Sequence[FloatArray]:
        return _shaken(fit, declared_noise, executor)

    shaken: Sequence[FloatArray]
    if is_recording():
        shaken = derived("input noise", (fit, declared_noise), changed)
    else:
        shaken = changed()
    return replace(fit, shaken=shaken) if len(shaken) else fit


def _shaken(
    fit: Fit, declared_noise: Sequence[float | None], executor: Executor | None
) -> Sequence[FloatArray]:
    """The `shaken` of `with_input_noise`."""
    p = fit.model.parameter_vector(dict(fit.values))
    replays = -(-REPLAYS // len(fit.runs))

    def changes(number: int) -> FloatArray:
        run, rng = fit.runs[number], np.random.default_rng((SEED, number))
        noise = input_noise(run, declared_noise)
        if not np.any(noise):
            return np.zeros((run.size, 0))
        every, _ = replayed(fit.model, run, p, fit.z[number], noise, rng, replays, fit.tolerance)
        simulated = every[:, np.all(np.isfinite(every), axis=0)]
        return project_out(simulated, fit.evaluations[number].by_start)

    every = list((executor.map if executor else map)(changes, range(len(fit.runs))))
    square = np.concatenate([np.mean(c**2, axis=0) for c in every])
    if not square.size:
        return ()
    size = np.concatenate([np.full(c.shape[1], float(len(c))) for c in every])
    usual = max(float(weighted_median(square[:, None], size)[0]), 1.0)
    return tuple(c * huber_root(np.mean(c**2, axis=0), usual) for c in every)
