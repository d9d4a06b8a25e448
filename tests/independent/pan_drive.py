"""Voltage-driven pan axis with true sticking and a gap, event by event: a truth for fits and tests.

Motor current, gear output with set-valued CSVS friction, dead zone whose contact cannot pull, load.
Without a gap the shaft pulls as it pushes; without stiffness it is rigid, and a gap then lies
between rigid faces, which impacts part and contact holds together while it presses.
Between events the motion is smooth: Dormand and Prince's pair of orders 5 and 4 (J. Comput. Appl.
Math. 6, 1980) at a tight tolerance; events are bisected to 1e-12 s and landed on their far side.
Beside the declared drive it holds effects that a test can plant; at their defaults they vanish.
"""

from typing import Any

import numba
import numpy as np
from numpy.typing import NDArray

from tests.independent.drive import Drive, as_records
from tests.independent.drive_laws import (
    breakaway,
    bristle_friction,
    cogging_torque,
    harmonics,
    harmonics_slope,
    joint_torque,
    sliding_friction,
    viscous,
    winding,
    wrap_slope,
)

Floats = NDArray[np.float64]
PanDrive = Drive

LOAD_ANGLE, LOAD_RATE, GEAR_ANGLE, GEAR_RATE, CURRENT, HEAT, WRAP = range(7)
DRIVEN, LAGGED, BEND = range(7, 10)  # lagged voltage, lagged reading, bend of bristles
STATES = 10
BOTH_WAYS = 2  # contact of a shaft without a gap, which pulls as well; 1 and -1 are flanks
SLOWEST_REBOUND = 1e-6  # rad/s; slower ones stay in contact
DEAD_BAND = 1e-13  # rad/s; rounding right after breakaway must not count as a reversal
EVENT_TOLERANCE = 1e-12  # s
LONGEST_STEP = 5e-4  # s
NEGLIGIBLE = 1e-60  # flushed to zero, as denormal numbers are slow

_A = np.array(
    [
        [0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [1 / 5, 0.0, 0.0, 0.0, 0.0, 0.0],
        [3 / 40, 9 / 40, 0.0, 0.0, 0.0, 0.0],
        [44 / 45, -56 / 15, 32 / 9, 0.0, 0.0, 0.0],
        [19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729, 0.0, 0.0],
        [9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656, 0.0],
        [35 / 384, 0.0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84],
    ]
)
_C = np.array([0.0, 1 / 5, 3 / 10, 4 / 5, 8 / 9, 1.0, 1.0])
_FOURTH = np.array(
    [5179 / 57600, 0.0, 7571 / 16695, 393 / 640, -92097 / 339200, 187 / 2100, 1 / 40]
)
_ERROR = np.append(_A[6], 0.0) - _FOURTH


@numba.njit(cache=True)
def _twist(y: Floats, drive: Any) -> tuple[float, float]:
    """Angle in rad by which the shaft's end on the gear leads the load, and its rate."""
    angle, rate = y[GEAR_ANGLE], y[GEAR_RATE]
    seen = angle + harmonics(drive.transmission, angle)
    seen_rate = rate * (1.0 + harmonics_slope(drive.transmission, angle))
    return seen - y[LOAD_ANGLE], seen_rate - y[LOAD_RATE]


@numba.njit(cache=True)
def _flank_torque(depth: float, closing: float, drive: Any) -> float:
    """Torque in N m with which a flank presses at a depth; negative where it would have to pull."""
    stiffness = drive.k_shaft
    if drive.contact_softness != 0.0:
        stiffness *= depth / (depth + drive.contact_softness)
    return stiffness * depth + drive.d_shaft * closing


@numba.njit(cache=True)
def _touching(y: Floats, drive: Any) -> int:
    """Flank that presses: 1, -1, or 0 in the gap and where the damped contact would pull."""
    if drive.gap == 0.0:
        return BOTH_WAYS
    twist, rate = _twist(y, drive)
    for side in (1, -1):
        depth = side * twist - 0.5 * drive.gap
        if depth > 0.0 and _flank_torque(depth, side * rate, drive) > 0.0:
            return side
    return 0


@numba.njit(cache=True)
def _contact_torque(y: Floats, contact: int, drive: Any) -> float:
    """Torque on the load in N m through the flank `contact`."""
    if contact == 0:
        return 0.0
    twist, rate = _twist(y, drive)
    if contact == BOTH_WAYS:
        return drive.k_shaft * twist + drive.d_shaft * rate
    return contact * _flank_torque(contact * twist - 0.5 * drive.gap, contact * rate, drive)


@numba.njit(cache=True)
def _gear_torque(y: Floats, shaft: float, drive: Any) -> float:
    """Torque in N m at the gear output that is left for friction and motor inertia."""
    lever = 1.0 + harmonics_slope(drive.transmission, y[GEAR_ANGLE])
    return drive.N * drive.K_t * y[CURRENT] - lever * shaft + cogging_torque(drive, y[GEAR_ANGLE])


@numba.njit(cache=True)
def _bonded(contact: int, drive: Any) -> bool:
    """Whether load and gear are one rigid body."""
    return contact != 0 and drive.k_shaft == 0.0


@numba.njit(cache=True)
def _joined_torque(t: float, y: Floats, push: float, slip: int, drive: Any) -> float:
    """Torque in N m from the rigid body of load and gear on the load alone."""
    load = push + joint_torque(drive, t, y[LOAD_ANGLE], y[LOAD_RATE], y[WRAP])
    if slip == 0:
        return -load
    gear = _gear_torque(y, 0.0, drive) - _friction(t, y, slip, 0.0, drive)
    return (gear * drive.J_load - load * drive.J_motor * drive.N**2) / (
        drive.J_load + drive.J_motor * drive.N**2
    )


@numba.njit(cache=True)
def _friction(t: float, y: Floats, slip: int, load: float, drive: Any) -> float:
    """Friction in N m at the gear output while it slides, or of its bristles."""
    if drive.bristle_stiffness == 0.0:
        return sliding_friction(drive, t, y[GEAR_RATE], slip, y[GEAR_ANGLE], load)
    coefficient = drive.F_v_forward if y[GEAR_RATE] >= 0.0 else drive.F_v_backward
    dry = bristle_friction(drive, y[GEAR_RATE], y[BEND])[0]
    return dry + viscous(drive, coefficient, y[GEAR_RATE])


@numba.njit(cache=True)
def _lags(y: Floats, u: float, drive: Any, out: Floats) -> float:
    """Slopes of all that lags behind, into `out`; the voltage in V that arrives for a held `u`."""
    out[DRIVEN], out[LAGGED], out[BEND] = 0.0, 0.0, 0.0
    if drive.measurement_lag != 0.0:
        out[LAGGED] = (y[LOAD_ANGLE] - y[LAGGED]) / drive.measurement_lag
    if drive.bristle_stiffness != 0.0:
        out[BEND] = bristle_friction(drive, y[GEAR_RATE], y[BEND])[1]
    if drive.actuator_lag == 0.0:
        return u
    out[DRIVEN] = (u - y[DRIVEN]) / drive.actuator_lag
    return y[DRIVEN]


@numba.njit(cache=True)
def _slope(
    t: float, y: Floats, u: float, push: float, contact: int, slip: int, drive: Any, out: Floats
) -> None:
    """Time derivative of the state [10] in a fixed mode, into `out`; `push` in N m on the load."""
    rigid = _bonded(contact, drive)
    if rigid:
        shaft = _joined_torque(t, y, push, slip, drive)
    else:
        shaft = _contact_torque(y, contact, drive)
    load = shaft + push + joint_torque(drive, t, y[LOAD_ANGLE], y[LOAD_RATE], y[WRAP])
    out[LOAD_ANGLE], out[GEAR_ANGLE] = y[LOAD_RATE], y[GEAR_RATE]
    out[LOAD_RATE] = load / drive.J_load
    out[GEAR_RATE] = 0.0
    if rigid:
        out[GEAR_RATE] = out[LOAD_RATE] if slip != 0 else 0.0
        out[LOAD_RATE] = out[GEAR_RATE]
    elif slip != 0:
        torque = _gear_torque(y, shaft, drive) - _friction(t, y, slip, shaft, drive)
        out[GEAR_RATE] = torque / (drive.J_motor * drive.N**2)
    u = _lags(y, u, drive, out)
    out[CURRENT], out[HEAT] = winding(drive, u, y[GEAR_RATE], y[CURRENT], y[HEAT])
    out[WRAP] = wrap_slope(drive, y[LOAD_RATE], y[WRAP])


@numba.njit(cache=True)
def _step(
    t: float, y: Floats, drawn: Any, contact: int, slip: int, drive: Any, h: float
) -> tuple[Floats, float]:
    """State [10] after one step of order 5, and the largest difference to order 4.

    `drawn` = (voltage in V, push on the load in N m at time zero, its slope in N m/s).
    """
    slopes = np.empty((7, STATES))
    stage = y.copy()
    for s in range(7):
        for i in range(STATES):
            total = 0.0
            for j in range(s):
                total += _A[s, j] * slopes[j, i]
            stage[i] = y[i] + h * total
        now = t + _C[s] * h
        push = drawn[1] + drawn[2] * now
        _slope(now, stage, drawn[0], push, contact, slip, drive, slopes[s])
    error = 0.0
    for i in range(STATES):
        total = 0.0
        for j in range(7):
            total += _ERROR[j] * slopes[j, i]
        error = max(error, abs(h * total))
    return stage, error


@numba.njit(cache=True)
def _holds(t: float, y: Floats, push: float, contact: int, rest_since: float, drive: Any) -> int:
    """Zero if dry friction holds the gear at rest, else the side to which it breaks away."""
    if _bonded(contact, drive):
        shaft = _joined_torque(t, y, push, 0, drive)
    else:
        shaft = _contact_torque(y, contact, drive)
    torque = _gear_torque(y, shaft, drive)
    side = 1 if torque > 0.0 else -1
    limit = breakaway(drive, t, side, t - rest_since, y[GEAR_ANGLE], shaft)
    return 0 if abs(torque) <= limit else side


@numba.njit(cache=True)
def _face_met(y: Floats, drive: Any) -> int:
    """Rigid face that gear and load run into: 1, -1, or 0."""
    twist, rate = _twist(y, drive)
    for side in (1, -1):
        if side * twist - 0.5 * drive.gap > 0.0 and side * rate > 0.0:
            return side
    return 0


@numba.njit(cache=True)
def _leaves_contact(t: float, y: Floats, push: float, contact: int, slip: int, drive: Any) -> bool:
    """Whether the contact no longer fits the state."""
    if drive.k_shaft != 0.0 or drive.gap == 0.0:
        return _touching(y, drive) != contact
    if contact == 0:
        return _face_met(y, drive) != 0
    return contact * _joined_torque(t, y, push, slip, drive) < 0.0


@numba.njit(cache=True)
def _leaves_mode(
    t: float, y: Floats, drawn: Any, contact: int, slip: int, rest_since: float, drive: Any
) -> bool:
    """Whether flank or friction mode no longer fits the state."""
    push = drawn[1] + drawn[2] * t
    if _leaves_contact(t, y, push, contact, slip, drive):
        return True
    if drive.bristle_stiffness != 0.0:
        return False
    if slip != 0:
        return slip * y[GEAR_RATE] < -DEAD_BAND
    return _holds(t, y, push, contact, rest_since, drive) != 0


@numba.njit(cache=True)
def _impact(y: Floats, side: int, drive: Any) -> int:
    """Rates after gear and load met at the face `side`; the face they stay at, or 0; in place.

    Dry friction is finite and takes no part in an impact.
    """
    gear = drive.J_motor * drive.N**2
    closing = side * (y[GEAR_RATE] - y[LOAD_RATE])
    stays = drive.restitution * closing < SLOWEST_REBOUND
    rebound = 0.0 if stays else drive.restitution
    impulse = side * (1.0 + rebound) * closing * gear * drive.J_load / (gear + drive.J_load)
    y[LOAD_RATE] += impulse / drive.J_load
    y[GEAR_RATE] -= impulse / gear
    if not stays:
        return 0
    y[LOAD_RATE] = y[GEAR_RATE]
    y[LOAD_ANGLE] = y[GEAR_ANGLE] - side * 0.5 * drive.gap
    return side


@numba.njit(cache=True)
def _choose_face(t: float, y: Floats, push: float, mode: Any, memory: Floats, drive: Any) -> None:
    """New (contact, slip) in `mode` [2] between rigid faces; the slip of a moving gear is set."""
    if mode[0] != 0:
        if y[GEAR_RATE] == 0.0:
            mode[1] = _holds(t, y, push, mode[0], memory[0], drive)
        if mode[0] * _joined_torque(t, y, push, mode[1], drive) < 0.0:
            mode[0] = 0
        return
    side = _face_met(y, drive)
    if side == 0:
        return
    mode[0] = _impact(y, side, drive)
    if y[GEAR_RATE] != 0.0:
        mode[1] = 1 if y[GEAR_RATE] > 0.0 else -1
    elif mode[1] != 0:
        mode[1] = 0
        memory[0] = t


@numba.njit(cache=True)
def _choose_mode(t: float, y: Floats, drawn: Any, mode: Any, memory: Floats, drive: Any) -> None:
    """New (contact, slip) in `mode` [2]; first the rate is stopped, then the flank, then friction.

    memory [2] = (time since when the gear is at rest in s, last step size in s).
    """
    push = drawn[1] + drawn[2] * t
    if drive.bristle_stiffness == 0.0 and mode[1] * y[GEAR_RATE] < 0.0:
        y[GEAR_RATE] = 0.0
        memory[0] = t
        if _bonded(mode[0], drive):
            y[LOAD_RATE] = 0.0
    if drive.k_shaft == 0.0 and drive.gap != 0.0:
        _choose_face(t, y, push, mode, memory, drive)
    else:
        mode[0] = _touching(y, drive)
    if drive.bristle_stiffness != 0.0:
        mode[1] = 1
    elif y[GEAR_RATE] == 0.0:
        mode[1] = _holds(t, y, push, mode[0], memory[0], drive)


@numba.njit(cache=True)
def _land(
    t: float, y: Floats, drawn: Any, mode: Any, memory: Floats, drive: Any, h: float
) -> float:
    """Length in s of the step that just leaves the mode, within the `h` that leaves it."""
    low = 0.0
    while h - low > EVENT_TOLERANCE:
        middle = 0.5 * (low + h)
        after, _ = _step(t, y, drawn, mode[0], mode[1], drive, middle)
        if _leaves_mode(t + middle, after, drawn, mode[0], mode[1], memory[0], drive):
            h = middle
        else:
            low = middle
    return h


@numba.njit(cache=True)
def _advance(
    t: float,
    end: float,
    y: Floats,
    drawn: Any,
    mode: Any,
    memory: Floats,
    drive: Any,
    tol: float,
) -> int:
    """Move the state [10] from `t` to `end` under held voltage, in place; the number of events."""
    events = 0
    while end - t > EVENT_TOLERANCE:
        h = min(memory[1], end - t)
        after, error = _step(t, y, drawn, mode[0], mode[1], drive, h)
        growth = min(4.0, max(0.2, 0.9 * (tol / max(error, 1e-30)) ** 0.2))
        if error > tol:
            memory[1] = h * growth
            continue
        if h == memory[1] or growth < 1.0:
            memory[1] = min(LONGEST_STEP, h * growth)
        if _leaves_mode(t + h, after, drawn, mode[0], mode[1], memory[0], drive):
            h = _land(t, y, drawn, mode, memory, drive, h)
            after, _ = _step(t, y, drawn, mode[0], mode[1], drive, h)
            _choose_mode(t + h, after, drawn, mode, memory, drive)
            events += 1
            if events > 10_000:
                raise RuntimeError("mode changes pile up")
        t += h
        for i in range(STATES):
            y[i] = after[i] if abs(after[i]) > NEGLIGIBLE else 0.0
    return events


@numba.njit(cache=True)
def _run(
    drive: Any, voltage: Floats, push: Floats, start: Floats, period: float, tol: float
) -> tuple[Floats, int]:
    states = np.empty((voltage.shape[0], STATES))
    y = start.copy()
    mode = np.zeros(2, dtype=np.int64)
    memory = np.array([0.0, 1e-5])
    mode[1] = int(np.sign(y[GEAR_RATE]))
    if drive.actuator_lag != 0.0:
        y[DRIVEN] = voltage[0]  # what lags behind has settled
    if drive.measurement_lag != 0.0:
        y[LAGGED] = y[LOAD_ANGLE]
    rise = (push[1] - push[0]) / period
    _choose_mode(0.0, y, (voltage[0], push[0], rise), mode, memory, drive)
    events = 0
    late = int(drive.delay / period)
    fraction = drive.delay - late * period
    for k in range(voltage.shape[0]):
        states[k] = y
        begin, middle, end = k * period, k * period + fraction, (k + 1) * period
        rise = (push[k + 1] - push[k]) / period
        for source, t, until in ((k - late - 1, begin, middle), (k - late, middle, end)):
            if until > t:
                drawn = (voltage[max(source, 0)], push[k] - rise * begin, rise)
                events += _advance(t, until, y, drawn, mode, memory, drive, tol)
    return states, events


def simulate(
    drive: PanDrive,
    voltage: Floats,
    start: Floats,
    period: float = 5e-3,
    tolerance: float = 1e-12,
    push: Floats | None = None,
) -> tuple[Floats, int]:
    """States [n, 10] at the sample times under voltage [n] in V, and the number of events.

    Columns: load angle and rate, gear angle and rate (rad, rad/s), current in A, relative heating,
    relative pull of a hysteretic cable, voltage and reading that lag, bend of bristles in rad;
    `start` may leave out what follows the heating. `voltage[k]` is held from
    sample k to sample k + 1, the first also before it; `push` [n + 1] in N m turns the load and is
    linear from sample to sample; `tolerance` is the local error of a step.
    """
    voltage, begin = np.asarray(voltage, dtype=float), np.zeros(STATES)
    begin[: len(start)] = start
    if push is None:
        push = np.zeros(len(voltage) + 1)
    return _run(as_records(drive)[0], voltage, push, begin, period, tolerance)


@numba.njit(cache=True)
def shaft_torques(drive: Any, states: Floats) -> Floats:
    """Torque [n] in N m from the shaft on the load along states [n, 10] of a drive's record; of a
    rigid one the motor's.
    """
    torques = np.empty(states.shape[0])
    if drive.k_shaft == 0.0:
        return drive.N * drive.K_t * states[:, CURRENT]
    for k in range(states.shape[0]):
        torques[k] = _contact_torque(states[k], _touching(states[k], drive), drive)
    return torques
