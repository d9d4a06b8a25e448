"""Residuals of a run and their Jacobians by parameters and by the unknown initial state.

Where a window begins, a fast state that no sensor shows, such as the current of a winding, follows
the motion and the input before as if it had settled there: the reduced model of fast states
(Kokotovic, Khalil and O'Reilly, 1986, 1.2). From zero, a current would come up within the window,
and a joint that slides would start a little behind.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numba import njit, types
from numpy.typing import NDArray

from ptp_symbolic.numeric.identify.along_motion import NEXT_TO_NONE
from ptp_symbolic.numeric.identify.constants import (
    BOUNCES,
    CHATTER,
    FORGOTTEN,
    NEARBY,
    ROUNDING,
    ROUNDS,
    SAME,
)
from ptp_symbolic.numeric.identify.evidence import Deferred, refuse_unstored
from ptp_symbolic.numeric.identify.run import Run
from ptp_symbolic.numeric.runtime.element_layout import contact_guards
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
    INTEGER_TABLE,
    INTEGERS,
    MATRIX,
    VECTOR,
)
from ptp_symbolic.numeric.simulation.specialised import specialised

FloatArray = NDArray[np.float64]

LOG_OF_FORGOTTEN = math.log(SAME)  # of the share at which an initial value is forgotten


def settle(
    model: Model,
    run: Run,
    p: FloatArray,
    x: FloatArray,
    s: FloatArray,
    columns: NDArray[np.int64],
) -> None:
    """Put the hidden states of a window that forget all but the share SAME of what they were within
    FORGOTTEN, and those that a reading depends on, into the state x [n] with which it
    begins, at p [np], and their derivatives by the parameters `columns` [nc] and by the start
    unknowns [nz] into its tangents s [n, nc + nz]. Their own laws are linear in them. Angles move
    so that sensors go on showing what they did: behind a filter an encoder that turns lags. A run
    that is no window and begins at rest begins as it does.
    """
    if (run.before is None and not _moves(model, run)) or not len(hidden := _hidden(model, run)):
        return
    u = run.held_inputs[0] if run.before is None else run.before
    t, m, dx = float(run.time[0]), np.zeros(len(model.mode_names)), np.zeros(len(x))
    model.module.initial_modes(t, x, u, p, m)
    here = model.derivatives(t, x, u, p, m)
    slopes = _reading_slopes(model, run, p, x)[run.outputs]
    fast = _fast(here.fx, slopes, hidden)
    if not len(fast):
        return
    model.module.mode_derivative(t, x, u, p, m, dx)
    encoders = _encoders(model, run)
    _settle_state(here.fx, dx, fast, slopes, encoders, x)
    if s.shape[1]:
        there = model.derivatives(t, x, u, p, m)
        _settle_tangents(there.fx, there.fp, fast, columns, slopes, encoders, s)


@njit(cache=True, nogil=True, error_model="numpy")
def _fast(fx, slopes, hidden):
    """Those of the `hidden` states that are forgotten soon, or that a reading depends on."""
    found, count = np.zeros(len(hidden), np.int64), 0
    for k in hidden:
        is_read = False
        for row in range(len(slopes)):
            is_read = is_read or slopes[row, k] != 0.0
        if (is_read and fx[k, k] < 0.0) or fx[k, k] * FORGOTTEN < LOG_OF_FORGOTTEN:
            found[count] = k
            count += 1
    return found[:count]


@njit(cache=True, nogil=True, error_model="numpy")
def _of_each_other(fx, fast):
    """Derivatives of the rates of `fast` states by each other."""
    own = np.zeros((len(fast), len(fast)))
    for i in range(len(fast)):
        for j in range(len(fast)):
            own[i, j] = fx[fast[i], fast[j]]
    return own


@njit(cache=True, nogil=True, error_model="numpy")
def _by_turn(slopes, row, joint, gear):
    """How a reading changes as a joint turns, and what is before its shaft with it."""
    return slopes[row, joint] + (slopes[row, gear] if gear >= 0 else 0.0)


@njit(cache=True, nogil=True, error_model="numpy")
def _settle_state(fx, dx, fast, slopes, encoders, x):
    """Put `fast` states where their rates dx are zero, and angles where sensors go on showing the
    same. Nothing moves where there are no finite rates: the simulation fails by itself.
    """
    own = _of_each_other(fx, fast)
    if not (np.isfinite(own).all() and np.isfinite(dx[fast]).all()):
        return
    moved = -np.linalg.solve(own, dx[fast])
    x[fast] += moved
    for row, joint, gear in encoders:
        shift = 0.0
        for i in range(len(fast)):
            shift += slopes[row, fast[i]] * moved[i]
        shift /= _by_turn(slopes, row, joint, gear)
        x[joint] -= shift
        if gear >= 0:
            x[gear] -= shift


@njit(cache=True, nogil=True, error_model="numpy")
def _settle_tangents(fx, fp, fast, columns, slopes, encoders, s):
    """Put the tangents s of `fast` states where their rates stay zero, and those of angles where
    sensors go on showing the same; see `_settle_state`.
    """
    n, ns = s.shape
    earlier, change = s[fast], np.zeros((len(fast), ns))
    s[fast] = 0.0
    for i in range(len(fast)):
        for c in range(ns):
            total = fp[fast[i], columns[c]] if c < len(columns) else 0.0
            for a in range(n):
                total += fx[fast[i], a] * s[a, c]
            change[i, c] = total
    own = _of_each_other(fx, fast)
    if not (np.isfinite(own).all() and np.isfinite(change).all()):
        return
    now = -np.linalg.solve(own, change)
    s[fast] = now
    for row, joint, gear in encoders:
        for c in range(ns):
            shift = 0.0
            for i in range(len(fast)):
                shift += slopes[row, fast[i]] * (now[i, c] - earlier[i, c])
            shift /= _by_turn(slopes, row, joint, gear)
            s[joint, c] -= shift
            if gear >= 0:
                s[gear, c] -= shift


def _moves(model: Model, run: Run) -> bool:
    """Whether a run surely begins in motion: from rest, the rate at its start is as uncertain as
    it is large.
    """
    rates = [u for u in run.unknowns if u.name.startswith("omega_")]
    starts = [run.start[model.state_names.index(u.name)] for u in rates]
    return any(abs(r) > NEARBY * u.sigma for r, u in zip(starts, rates, strict=True))


def _reading_slopes(model: Model, run: Run, p: FloatArray, x: FloatArray) -> FloatArray:
    """Derivatives [signals, n] of all readings by the state x [n] at p [np]."""
    signals = len(model.output_names)
    yx, yp = np.zeros((signals, len(x))), np.zeros((signals, len(p)))
    model.module.output_jacobian(run.time[0], x, run.held_inputs[0], p, yx, yp)
    return yx


def _encoders(model: Model, run: Run) -> NDArray[np.int64]:
    """The columns of `run` that are encoders [e, 3], each with the states that are its angle: at
    the joint, and at the gear (-1: none).
    """
    return _encoders_among(run.signals, model.state_names)


@lru_cache(maxsize=256)
def _encoders_among(signals: tuple[str, ...], states: tuple[str, ...]) -> NDArray[np.int64]:
    rows = []
    for column, signal in enumerate(signals):
        if signal.startswith("theta_"):
            gear = f"theta_gear_{signal.removeprefix('theta_')}"
            behind = states.index(gear) if gear in states else -1
            rows.append((column, states.index(signal), behind))
    return np.array(rows, np.int64).reshape(-1, 3)


def _hidden(model: Model, run: Run) -> NDArray[np.int64]:
    """States with a differential equation beside the motion that no signal shows, and that friction
    does not set.
    """
    by_friction = tuple(model.zero_at_rest[: model.moving] >= 0)
    return _hidden_among(run.signals, model.state_names[: model.moving], by_friction)


@lru_cache(maxsize=256)
def _hidden_among(
    signals: tuple[str, ...], states: tuple[str, ...], by_friction: tuple[bool, ...]
) -> NDArray[np.int64]:
    shown = ("theta_", "omega_")
    rows = [
        k
        for k, name in enumerate(states)
        if not name.startswith(shown) and name not in signals and not by_friction[k]
    ]
    return np.array(rows, np.int64)


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
    (_fast, (MATRIX, MATRIX, INTEGERS)),
    (_of_each_other, (MATRIX, INTEGERS)),
    (_by_turn, (MATRIX, types.int64, types.int64, types.int64)),
    (_settle_state, (MATRIX, VECTOR, INTEGERS, MATRIX, INTEGER_TABLE, VECTOR)),
    (_settle_tangents, (MATRIX, MATRIX, INTEGERS, INTEGERS, MATRIX, INTEGER_TABLE, MATRIX)),
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


def start_state(
    model: Model, run: Run, p: FloatArray, z: FloatArray, columns: NDArray[np.int64]
) -> tuple[FloatArray, FloatArray]:
    """Initial state [n] of `run` at p [np] for start unknowns z [nz], and its tangents [n, nc + nz]
    by the parameters `columns` [nc] and by z.
    """
    x = run.start.copy()
    s = np.zeros((len(x), len(columns) + len(z)))
    u = run.held_inputs[0]
    _put_behind_sensors(model, run, p, columns, x, s)
    for index, (unknown, value) in enumerate(zip(run.unknowns, z, strict=True)):
        scale = 1.0
        if unknown.contact is not None:
            scale, by_p = put_into_gap(model, unknown.contact, x, s, u, p, columns)
            s[:, : len(columns)] += np.outer(unknown.tangent * value, by_p[columns])
        x += unknown.tangent * value * scale
        s[:, len(columns) + index] = unknown.tangent * scale
    settle(model, run, p, x, s, columns)
    return x, s


def _put_behind_sensors(
    model: Model, run: Run, p: FloatArray, columns: NDArray[np.int64], x: FloatArray, s: FloatArray
) -> None:
    """Move the angles in the state x [n], and their tangents s by the parameters `columns`, to
    where the sensors show what the run begins with. Errors of sensors are small and smooth.
    """
    n, signals = len(x), len(model.output_names)
    y, yx, yp = np.zeros(signals), np.zeros((signals, n)), np.zeros((signals, len(p)))
    for column, joint, gear in _encoders(model, run):
        shown, angle_states = run.outputs[column], [joint] if gear < 0 else [joint, gear]
        for _ in range(ROUNDS):
            model.module.outputs(run.time[0], x, run.held_inputs[0], p, y)
            error = run.measured[0, column] - y[shown]
            x[angle_states] += error
            if abs(error) <= NEXT_TO_NONE:
                break
        if len(columns):
            model.module.output_jacobian(run.time[0], x, run.held_inputs[0], p, yx, yp)
            slope = yp[shown, columns] / yx[shown, angle_states].sum()
            s[angle_states, : len(columns)] -= slope


def put_into_gap(
    model: Model,
    contact: int,
    x: FloatArray,
    s: FloatArray,
    u: FloatArray,
    p: FloatArray,
    columns: NDArray[np.int64],
) -> tuple[float, FloatArray]:
    """Move the gear in the state x [n], and its tangents s by the parameters `columns`, to the
    middle of a gap, which a gear out of true shifts; half the gap in rad, and its derivative [np].
    """
    frictions = len(model.friction_rates)
    count = contact_guards(frictions, len(model.contacts))
    m, g = np.zeros(len(model.mode_names)), np.zeros(count)
    at, gear = contact_guards(frictions, contact), model.module.CONTACT_ANGLES[contact][0]
    for _ in range(ROUNDS):
        model.module.guards(0.0, x, u, p, m, g)
        x[gear] -= g[at]
        if abs(g[at]) <= NEXT_TO_NONE:
            break
    there = model.derivatives(0.0, x, u, p, m)
    gx, gp = there.gx, there.gp
    known = slice(0, len(columns))
    s[gear, known] -= (gx[at] @ s[:, known] + gp[at, columns]) / gx[at, gear]
    return float(g[at + 1]), gp[at + 1]


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
    if is_asked:  # what a fit simulates without derivatives needs no functions of its own
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
