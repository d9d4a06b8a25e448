"""Residuals of a run and their Jacobians by parameters and by the unknown initial state."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numba import njit, types
from numpy.typing import NDArray

from ptp_symbolic.numeric.identify.constants import (
    BOUNCES,
    CHATTER,
    ROUNDING,
    SAME,
)
from ptp_symbolic.numeric.identify.evidence import Deferred, refuse_unstored
from ptp_symbolic.numeric.identify.run import Run
from ptp_symbolic.numeric.identify.start import start_state
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.inputs import delay_columns, delays_of
from ptp_symbolic.numeric.simulation.integration import (
    MOST_STEPS,
    Accuracy,
    geared_weights,
    integrate,
)
from ptp_symbolic.numeric.simulation.kernels.calls import call
from ptp_symbolic.numeric.simulation.kernels.records import (
    CUBE,
    DONE,
    EXHAUSTED,
    INTEGERS,
    MATRIX,
    VECTOR,
)
from ptp_symbolic.numeric.simulation.specialised import specialised

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class Tolerance:
    """Error tolerance of the simulations that a fit runs: relative, and absolute by kind of state.

    An angle in rad counts fully, a rate in rad/s a hundredth, anything else a thousandth: an error
    of a rate or a current reaches the angle only through an integration. At the defaults the angles
    of a geared drive are good to a hundredth of a count of 7200 per turn.
    """

    relative: float = 1e-4
    angle: float = 1e-6

    @classmethod
    def for_resolution(cls, resolution: float, share: float) -> "Tolerance":
        """The tolerance at which angles are good to a `share` of `resolution` in rad.

        The default holds a count of 7200 per turn, less the rounding of it, to 1 %; the error of a
        step goes with the tolerance. A relative tolerance lies between the root of rounding, as
        sums of many steps need, and where values no longer count as the same.
        """
        usual = 2.0 * np.pi / 7200.0 * ROUNDING
        factor = resolution / usual * share / 0.01
        factor = min(max(factor, np.sqrt(np.finfo(float).eps) / cls.relative), SAME / cls.relative)
        return cls(cls.relative * factor, cls.angle * factor)

    def absolute(self, model: Model) -> FloatArray:
        """Absolute tolerance of every state [n], in its unit."""
        return self.angle * geared_weights(model)


@dataclass(frozen=True, eq=False)
class Evaluation:
    """Weighted residuals [k * ny], (measured - simulated) / sigma, and their Jacobians by
    parameters [k * ny, nc] and by the unknowns of the start [k * ny, nz]; `failed` says why a
    simulation ended. A simulation gives the state at its `end` [n].
    """

    residual: FloatArray
    by_parameter: FloatArray
    by_start: FloatArray
    failed: str | None = None
    end: FloatArray | None = None


def mean_squares(evaluations: Sequence[Evaluation], runs: Sequence[Run]) -> FloatArray:
    """Mean square [runs, ny] of the weighted residuals; infinite where a simulation failed."""
    if isinstance(evaluations, Deferred) and evaluations.squares is not None:
        return np.array(evaluations.squares)
    rows = []
    for e, run in zip(evaluations, runs, strict=True):
        table = e.residual.reshape(run.measured.shape)
        failed = e.failed is not None or not np.all(np.isfinite(table))
        rows.append(np.full(len(run.signals), np.inf) if failed else np.mean(table**2, axis=0))
    return np.array(rows)


def simulated_signals(run: Run, evaluation: Evaluation) -> FloatArray:
    """The measured signals [k, ny] of `run` as they were simulated, in their units."""
    return run.measured - evaluation.residual.reshape(run.measured.shape) / run.weight


@njit(cache=True, nogil=True, error_model="numpy")
def _compare(functions, signals, time, x, s, u, p, measured, columns, picked, weight, r, j):
    """Fill residuals r and their derivatives j; u is the held input.

    `functions` [2] are the addresses of the model's outputs, so many `signals`, and of their
    Jacobian.
    """
    k, n = x.shape
    ns = s.shape[2]
    buffer = np.zeros(signals)
    yx, yp = np.zeros((signals, n)), np.zeros((signals, len(p)))
    ny = len(picked)
    for i in range(k):
        call(functions[0], time[i], x[i], u[i], p, buffer)
        if ns > 0:
            call(functions[1], time[i], x[i], u[i], p, yx, yp)
        for o in range(ny):
            row = i * ny + o
            r[row] = weight[o] * (measured[i, o] - buffer[picked[o]])
            for c in range(ns):
                total_derivative = yp[picked[o], columns[c]] if c < len(columns) else 0.0
                for a in range(n):
                    total_derivative += yx[picked[o], a] * s[i, a, c]
                j[row, c] = -weight[o] * total_derivative


AHEAD = (
    (
        _compare,
        (
            INTEGERS,
            types.int64,
            VECTOR,
            MATRIX,
            CUBE,
            MATRIX,
            VECTOR,
            MATRIX,
            INTEGERS,
            INTEGERS,
            VECTOR,
            VECTOR,
            MATRIX,
        ),
    ),
)


def evaluate(
    model: Model,
    run: Run,
    p: FloatArray,
    z: FloatArray,
    columns: NDArray[np.int64],
    tangents: bool,
    tolerance: Tolerance,
) -> Evaluation:
    """Simulate `run` at p [np] from start unknowns z [nz]; with `tangents` also the Jacobians by
    the parameters `columns` [nc] and by z. A simulation that fails has zero residuals and says so
    in `failed`, one that takes more than CHATTER steps a sample, or BOUNCES more at once, too:
    bodies that bounce without loss strike each other millions of times. Raises InputError as
    `integrate` does.
    """
    refuse_unstored()
    may_chatter = bool(model.mode_names) and not model.sampler_periods
    lean = specialised(model.module)
    unneeded, is_asked = lean.unneeded(p, columns), len(columns) > 0
    functions = lean.without(unneeded, tangents)
    columns = columns if tangents else columns[:0]
    x, s = start_state(model, run, p, z, columns)
    inputs = run.acting_inputs(delays_of(model, p))
    found = integrate(
        model,
        None,
        p,
        x,
        inputs.table,
        inputs.table.held,
        inputs.stops,
        run.time,
        Accuracy(
            tolerance.relative,
            tolerance.absolute(model),
            1.0,
            int(CHATTER * len(run.time)) if may_chatter else MOST_STEPS,
            int(BOUNCES) if may_chatter else MOST_STEPS,
            int(CHATTER),
        ),
        s if tangents else None,
        columns,
        delay_columns(model, columns),
        rough_tangents=True,
        functions=functions.motion,
    )
    run.work.add(max(len(run.time), found.steps), tangents)
    if is_asked:  # differences go by the functions of the fit that asks for them
        lean.note(unneeded, found.steps)
    r, j = np.zeros(run.size), np.zeros((run.size, found.s.shape[2]))
    failed = None
    if found.status != DONE:
        after = f" after {found.steps} steps" if found.status == EXHAUSTED else ""
        failed = f"{run.name}: stopped at {found.reached:.4f} s{after}"
    if failed is None:
        _compare(
            functions.outputs,
            len(model.output_names),
            run.time,
            found.x,
            found.s,
            inputs.values,
            p,
            np.ascontiguousarray(run.measured),
            columns,
            run.outputs,
            run.weight,
            r,
            j,
        )
        if not np.isfinite(r).all():
            failed = f"{run.name}: not finite"
    split = len(columns)
    end = None if failed else found.x[-1].copy()
    return Evaluation(r, j[:, :split], j[:, split:].copy(), failed, end)


def residual_of(
    model: Model, p: FloatArray, tolerance: Tolerance, run: Run, z: FloatArray
) -> FloatArray | None:
    """Weighted residual [k * ny] of a run at p [np]; None where the simulation fails."""
    e = evaluate(model, run, p, z, np.zeros(0, dtype=np.int64), False, tolerance)
    return None if e.failed else e.residual
