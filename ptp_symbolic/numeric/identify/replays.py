"""Runs replayed with the noise of their inputs once more: what it leaves in the outputs, and what a
fit follows of it.
"""

from collections.abc import Sequence
from concurrent.futures import Executor
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.identify.blocks import huber_root
from ptp_symbolic.numeric.identify.constants import REPLAYS, SEED, TIMES
from ptp_symbolic.numeric.identify.evaluate import Tolerance, evaluate
from ptp_symbolic.numeric.identify.finite_differences import with_finite_differences
from ptp_symbolic.numeric.identify.fit import Fit
from ptp_symbolic.numeric.identify.intervals import project_out
from ptp_symbolic.numeric.identify.noise import white_noise
from ptp_symbolic.numeric.identify.robust_loss import weighted_median
from ptp_symbolic.numeric.identify.run import Run
from ptp_symbolic.numeric.identify.run_inputs import with_inputs
from ptp_symbolic.numeric.runtime.model import Model

FloatArray = NDArray[np.float64]


def input_noise(run: Run, declared: Sequence[float | None]) -> FloatArray:
    """Noise (rms) of every input [nu] in its unit: as declared, else as its samples show it."""
    columns = zip(run.held_inputs.T, declared, strict=True)
    return np.array([white_noise(column) if d is None else d for column, d in columns])


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
) -> tuple[FloatArray, FloatArray] | None:
    """Change of the weighted residuals by input noise, and the Jacobian by the start of the run;
    None where the run cannot be simulated.
    """
    held = with_inputs(run, run.held_inputs)
    none = np.zeros(0, dtype=np.int64)
    both = (held, noisier(run, noise, rng))
    plain, other = (evaluate(model, r, p, z, none, True, Tolerance()) for r in both)
    if plain.failed or other.failed:
        return None
    return other.residual - plain.residual, plain.by_start


def replayed_squares(
    model: Model,
    runs: Sequence[Run],
    z: Sequence[FloatArray],
    p: FloatArray,
    declared_noise: Sequence[float | None],
    executor: Executor | None = None,
) -> FloatArray:
    """What input noise leaves in the residual of a perfect model: mean squares [times, runs, ny] of
    some replays of every run, in units of the noise of every signal (see `Run.weight`); nan where a
    run cannot be simulated.

    Every run is replayed with noisy inputs; what its unknown start can take up is projected out.
    """
    none = np.zeros(0, dtype=np.int64)

    def squares(number: int) -> FloatArray:
        run, found = (
            with_inputs(runs[number], runs[number].held_inputs),
            np.zeros((TIMES, len(runs[number].signals))),
        )
        noise = input_noise(run, declared_noise)
        if not np.any(noise):
            return found
        plain = evaluate(model, run, p, z[number], none, True, Tolerance())
        rng = np.random.default_rng((SEED, number))
        for row in found:
            other = evaluate(
                model, noisier(run, noise, rng), p, z[number], none, False, Tolerance()
            )
            if plain.failed or other.failed:
                row[:] = np.nan
                continue
            change = project_out((other.residual - plain.residual)[:, None], plain.by_start)
            row[:] = np.mean(change.reshape(run.measured.shape) ** 2, axis=0)
        return found

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
    """The same as a root mean square [runs, ny] over the replays but for the one that leaves most,
    which may stick elsewhere.
    """
    squares = np.sort(replayed_squares(model, runs, z, p, declared_noise, executor), axis=0)
    return np.asarray(np.sqrt(np.mean(squares[:-1], axis=0)))


def estimable(
    fit: Fit, declared_noise: Sequence[float | None], executor: Executor | None = None
) -> Fit:
    """A finished fit with all that its intervals need: derivatives that are not blind, and what the
    noise of the inputs changes.
    """
    seeing = with_finite_differences(fit, executor)
    return with_input_noise(seeing, declared_noise, executor)


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
    p, none = fit.model.parameter_vector(dict(fit.values)), np.zeros(0, dtype=np.int64)
    replays = -(-REPLAYS // len(fit.runs))

    def changes(number: int) -> FloatArray:
        run, e, found = fit.runs[number], fit.evaluations[number], []
        noise = input_noise(run, declared_noise)
        rng = np.random.default_rng((SEED, number))
        for _ in range(replays if np.any(noise) else 0):
            noisy = noisier(run, noise, rng)
            other = evaluate(fit.model, noisy, p, fit.z[number], none, False, fit.tolerance)
            if other.failed is None:
                found.append(other.residual - e.residual)
        return project_out(np.column_stack(found), e.by_start) if found else np.zeros((run.size, 0))

    every = list((executor.map if executor else map)(changes, range(len(fit.runs))))
    square = np.concatenate([np.mean(c**2, axis=0) for c in every])
    if not square.size:
        return fit
    size = np.concatenate([np.full(c.shape[1], float(len(c))) for c in every])
    usual = max(float(weighted_median(square[:, None], size)[0]), 1.0)
    shaken = tuple(c * huber_root(np.mean(c**2, axis=0), usual) for c in every)
    return replace(fit, shaken=shaken)
