"""The state that a run begins with, by what its sensors show and by the unknowns of its start.

Where a window begins, a fast state that no sensor shows, such as the current of a winding, follows
the motion and the input before as if it had settled there: the reduced model of fast states
(Kokotovic, Khalil and O'Reilly, 1986, 1.2). From zero, a current would come up within the window,
and a joint that slides would start a little behind.
"""

import math
from functools import lru_cache
from types import ModuleType
from typing import NamedTuple

import numpy as np
from numba import njit, types
from numpy.typing import NDArray

from ptp_symbolic.numeric.identify.along_motion import NEXT_TO_NONE
from ptp_symbolic.numeric.identify.constants import FORGOTTEN, NEARBY, ROUNDS, SAME
from ptp_symbolic.numeric.identify.run import Run
from ptp_symbolic.numeric.runtime.element_layout import contact_guards
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.kernels.calls import (
    OUTPUT_SIGNATURES,
    SIGNATURES,
    call,
    compiled_addresses,
)
from ptp_symbolic.numeric.simulation.kernels.records import (
    INTEGER_TABLE,
    INTEGERS,
    MATRIX,
    VECTOR,
)

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

LOG_OF_FORGOTTEN = math.log(SAME)  # of the share at which an initial value is forgotten
CALLED = {
    **OUTPUT_SIGNATURES,
    "initial_modes": OUTPUT_SIGNATURES["outputs"],
    "mode_derivative": SIGNATURES["guards"],
    "linearize": SIGNATURES["linearize"],
    "guards": SIGNATURES["guards"],
}
OUTPUTS, OUTPUT_JACOBIAN, INITIAL_MODES, MODE_DERIVATIVE, LINEARIZE, GUARDS = range(len(CALLED))
SIZES = ("signals", "modes", "guards")
SIGNALS, MODES, ALL_GUARDS = range(len(SIZES))


class Beginning(NamedTuple):
    """What the start of a run is made from, whatever the parameters are.

    sizes [3]: signals of the model, modes, guards; t in s; x [n]: the state that is guessed; u,
    before [nu]: inputs at the first sample and until then; encoders [e, 3]: columns that are
    encoders, each with the states that are its angle, at the joint and at the gear (-1: none);
    outputs, shown [ny]: the signals that are measured and what they show; tangents [nz, n]:
    derivatives of the start by its unknowns; gaps [nz, 2]: for one that is a place in a gap its
    guard and the state of the gear, else -1; hidden: the states that may settle (see `_settle`),
    none where a run begins at rest.
    """

    sizes: IntArray
    t: float
    x: FloatArray
    u: FloatArray
    before: FloatArray
    encoders: IntArray
    outputs: IntArray
    shown: FloatArray
    tangents: FloatArray
    gaps: IntArray
    hidden: IntArray


def start_state(
    model: Model, run: Run, p: FloatArray, z: FloatArray, columns: IntArray
) -> tuple[FloatArray, FloatArray]:
    """Initial state [n] of `run` at p [np] for start unknowns z [nz], and its tangents [n, nc + nz]
    by the parameters `columns` [nc] and by z.
    """
    known: tuple[ModuleType, Beginning] | None = vars(run).get("_beginning")
    if known is None or known[0] is not model.module:
        vars(run)["_beginning"] = known = model.module, _beginning(model, run)
    begins = known[1]
    x, s = begins.x.copy(), np.zeros((len(begins.x), len(columns) + len(z)))
    _begin(_addresses(model.module), *begins[:2], x, s, *begins[3:], z, p, columns)
    return x, s


def put_into_gap(
    model: Model,
    contact: int,
    x: FloatArray,
    s: FloatArray,
    u: FloatArray,
    p: FloatArray,
    columns: IntArray,
) -> float:
    """Move the gear in the state x [n], and its tangents s by the parameters `columns`, to the
    middle of a gap, which a gear out of true shifts; half the gap in rad.
    """
    gap, sizes = _gap(model, contact), _sizes(model)
    return float(
        _into_gap(_addresses(model.module), sizes, *gap, x, s, u, p, columns, np.zeros(len(p)))
    )


@lru_cache(maxsize=256)
def _addresses(module: ModuleType) -> IntArray:
    return compiled_addresses(module, CALLED)


def _sizes(model: Model) -> IntArray:
    guards = contact_guards(len(model.friction_rates), len(model.contacts))
    return np.array([len(model.output_names), len(model.mode_names), guards], dtype=np.int64)


def _gap(model: Model, contact: int) -> tuple[int, int]:
    """The first guard of a contact, and the state that is the angle of its gear."""
    guard = contact_guards(len(model.friction_rates), contact)
    return guard, int(model.module.CONTACT_ANGLES[contact][0])


def _beginning(model: Model, run: Run) -> Beginning:
    u = np.ascontiguousarray(run.held_inputs[0])
    settles = run.before is not None or _moves(model, run)
    hidden = _hidden(model, run) if settles else np.zeros(0, dtype=np.int64)
    contacts = [unknown.contact for unknown in run.unknowns]
    gaps = [(-1, -1) if contact is None else _gap(model, contact) for contact in contacts]
    tangents = [unknown.tangent for unknown in run.unknowns]
    return Beginning(
        _sizes(model),
        float(run.time[0]),
        np.asarray(run.start, dtype=np.float64),
        u,
        u if run.before is None else np.ascontiguousarray(run.before),
        _encoders(model, run),
        np.ascontiguousarray(run.outputs),
        np.ascontiguousarray(run.measured[0]),
        np.array(tangents, dtype=np.float64).reshape(-1, len(run.start)),
        np.array(gaps, dtype=np.int64).reshape(-1, 2),
        hidden,
    )


def _moves(model: Model, run: Run) -> bool:
    """Whether a run surely begins in motion: from rest, the rate at its start is as uncertain as
    it is large.
    """
    rates = [u for u in run.unknowns if u.name.startswith("omega_")]
    starts = [run.start[model.state_names.index(u.name)] for u in rates]
    return any(abs(r) > NEARBY * u.sigma for r, u in zip(starts, rates, strict=True))


def _encoders(model: Model, run: Run) -> IntArray:
    """The columns of `run` that are encoders, as `Beginning` has them."""
    states, rows = model.state_names, []
    for column, signal in enumerate(run.signals):
        if signal.startswith("theta_"):
            gear = f"theta_gear_{signal.removeprefix('theta_')}"
            behind = states.index(gear) if gear in states else -1
            rows.append((column, states.index(signal), behind))
    return np.array(rows, np.int64).reshape(-1, 3)


def _hidden(model: Model, run: Run) -> IntArray:
    """States with a differential equation beside the motion that no signal shows, and that friction
    does not set.
    """
    by_friction, shown = model.zero_at_rest >= 0, ("theta_", "omega_")
    rows = [
        k
        for k, name in enumerate(model.state_names[: model.moving])
        if not name.startswith(shown) and name not in run.signals and not by_friction[k]
    ]
    return np.array(rows, np.int64)


@njit(cache=True, nogil=True, error_model="numpy")
def _begin(
    functions,
    sizes,
    t,
    x,
    s,
    u,
    before,
    encoders,
    outputs,
    shown,
    tangents,
    gaps,
    hidden,
    z,
    p,
    columns,
):
    """Fill in the state x [n], which is guessed, and its tangents s [n, nc + nz]."""
    _put_behind_sensors(functions, sizes, t, x, s, u, encoders, outputs, shown, p, columns)
    by_p = np.zeros(len(p))
    for i in range(len(z)):
        scale = 1.0
        if gaps[i, 0] >= 0:
            scale = _into_gap(functions, sizes, gaps[i, 0], gaps[i, 1], x, s, u, p, columns, by_p)
            for a in range(len(x)):
                for c in range(len(columns)):
                    s[a, c] += tangents[i, a] * z[i] * by_p[columns[c]]
        for a in range(len(x)):
            x[a] += tangents[i, a] * z[i] * scale
            s[a, len(columns) + i] = tangents[i, a] * scale
    if len(hidden) > 0:
        _settle(functions, sizes, t, x, s, u, before, encoders, outputs, hidden, p, columns)


@njit(cache=True, nogil=True, error_model="numpy")
def _put_behind_sensors(functions, sizes, t, x, s, u, encoders, outputs, shown, p, columns):
    """Move the angles in the state x [n], and their tangents s by the parameters `columns`, to
    where the sensors show what the run begins with. Errors of sensors are small and smooth.
    """
    y, yx = np.zeros(sizes[SIGNALS]), np.zeros((sizes[SIGNALS], len(x)))
    yp = np.zeros((sizes[SIGNALS], len(p)))
    for e in range(len(encoders)):
        column, joint, gear = encoders[e, 0], encoders[e, 1], encoders[e, 2]
        signal = outputs[column]
        for _ in range(ROUNDS):
            call(functions[OUTPUTS], t, x, u, p, y)
            error = shown[column] - y[signal]
            x[joint] += error
            if gear >= 0:
                x[gear] += error
            if abs(error) <= NEXT_TO_NONE:
                break
        if len(columns) > 0:
            call(functions[OUTPUT_JACOBIAN], t, x, u, p, yx, yp)
            turn = yx[signal, joint] + (yx[signal, gear] if gear >= 0 else 0.0)
            for c in range(len(columns)):
                slope = yp[signal, columns[c]] / turn
                s[joint, c] -= slope
                if gear >= 0:
                    s[gear, c] -= slope


@njit(cache=True, nogil=True, error_model="numpy")
def _into_gap(functions, sizes, guard, gear, x, s, u, p, columns, by_p):
    """See `put_into_gap`; the derivative of half the gap goes into by_p [np]."""
    m, g = np.zeros(sizes[MODES]), np.zeros(sizes[ALL_GUARDS])
    fx, gx = np.zeros((len(x), len(x))), np.zeros((len(g), len(x)))
    fu, fp = np.zeros((len(x), len(u))), np.zeros((len(x), len(p)))
    gp = np.zeros((len(g), len(p)))
    for _ in range(ROUNDS):
        call(functions[GUARDS], 0.0, x, u, p, m, g)
        x[gear] -= g[guard]
        if abs(g[guard]) <= NEXT_TO_NONE:
            break
    call(functions[LINEARIZE], 0.0, x, u, p, m, fx, fu, fp, gx, gp)
    for c in range(len(columns)):
        moved = gp[guard, columns[c]]
        for a in range(len(x)):
            moved += gx[guard, a] * s[a, c]
        s[gear, c] -= moved / gx[guard, gear]
    by_p[:] = gp[guard + 1]
    return g[guard + 1]


@njit(cache=True, nogil=True, error_model="numpy")
def _settle(functions, sizes, t, x, s, u, before, encoders, outputs, hidden, p, columns):
    """Put the hidden states of a window that forget all but the share SAME of what they were within
    FORGOTTEN, and those that a reading depends on, into the state x [n] with which it begins, at p
    [np], and their derivatives by the parameters `columns` [nc] and by the start unknowns [nz] into
    its tangents s [n, nc + nz]. Their own laws are linear in them. Angles move so that sensors go
    on showing what they did: behind a filter an encoder that turns lags. A run that is no window
    and begins at rest has no hidden states.
    """
    n, m, g = len(x), np.zeros(sizes[MODES]), sizes[ALL_GUARDS]
    fx, fu, fp = np.zeros((n, n)), np.zeros((n, len(before))), np.zeros((n, len(p)))
    gx, gp, dx = np.zeros((g, n)), np.zeros((g, len(p))), np.zeros(n)
    yx, yp = np.zeros((sizes[SIGNALS], n)), np.zeros((sizes[SIGNALS], len(p)))
    call(functions[INITIAL_MODES], t, x, before, p, m)
    call(functions[LINEARIZE], t, x, before, p, m, fx, fu, fp, gx, gp)
    call(functions[OUTPUT_JACOBIAN], t, x, u, p, yx, yp)
    slopes = np.zeros((len(outputs), n))
    for o in range(len(outputs)):
        slopes[o] = yx[outputs[o]]
    fast = _fast(fx, slopes, hidden)
    if len(fast) == 0:
        return
    call(functions[MODE_DERIVATIVE], t, x, before, p, m, dx)
    _settle_state(fx, dx, fast, slopes, encoders, x)
    if s.shape[1] > 0:
        call(functions[LINEARIZE], t, x, before, p, m, fx, fu, fp, gx, gp)
        _settle_tangents(fx, fp, fast, columns, slopes, encoders, s)


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


AHEAD = (
    (
        _begin,
        (
            INTEGERS,
            INTEGERS,
            types.float64,
            VECTOR,
            MATRIX,
            VECTOR,
            VECTOR,
            INTEGER_TABLE,
            INTEGERS,
            VECTOR,
            MATRIX,
            INTEGER_TABLE,
            INTEGERS,
            VECTOR,
            VECTOR,
            INTEGERS,
        ),
    ),
)
