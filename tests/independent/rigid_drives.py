"""Driven joints between rigid bodies with friction that truly sticks: one axis or two that cross.

Each joint sticks, slides forward or slides backward. Between mode changes the motion is smooth and
classical Runge-Kutta takes steps of 0.25 ms; a mode change is located by bisection. A stuck joint
stands exactly still: its friction is whatever balances it, up to the breakaway torque. A joint is
driven by a torque or by a voltage through a motor that is rigidly geared to it, or by a flexible
shaft with or without a gap: then the motor at its gear output is a body of its own without dry
friction, and contacts are modes that are located as well.
"""

import math
from typing import Any, NamedTuple

import numba
import numpy as np
from numpy.typing import NDArray

from tests.independent.bodies import (
    Bodies,
    mass_matrix,
    products,
    rate_torque,
    table_torque,
)
from tests.independent.drive import Drive, Floats, as_records
from tests.independent.drive_laws import (
    breakaway,
    cogging_torque,
    joint_torque,
    loss_slope,
    loss_torque,
    shaft_contact,
    shaft_torque,
    sliding_friction,
    winding,
    wrap_slope,
)

ANGLE, RATE, CURRENT, HEAT, WRAP = range(5)
GEAR, GEAR_RATE, DRIVEN, LAGGED, WOUND = range(5, 10)  # motor, lagged input and reading, loss
SMOOTH = 10  # the first states, which have a slope
REST, SLIP = SMOOTH, SMOOTH + 1
STATES = 12  # per joint; REST is the time in s since when it rests, SLIP its mode: 0, 1 or -1
STEP = 0.25e-3  # s
DEAD_BAND = 1e-13  # rad/s; rounding right after breakaway must not count as a reversal
EVENT_TOLERANCE = 1e-12  # s
MOST_EVENTS = 1000  # within a sample
MODES = np.array([(a, b) for a in (0, 1, -1) for b in (0, 1, -1)])
MODES = MODES[np.argsort(np.abs(MODES).sum(axis=1), kind="stable")]


class Joints(NamedTuple):
    """Two joints and their bodies: structured arrays, which jitted functions take by reference.

    drives [2] of `drive.RECORD`; frame [1] of `FRAME`.
    """

    drives: NDArray[np.void]
    frame: NDArray[np.void]


FRAME = np.dtype(
    [
        # Bodies and kinds of joints: `present` is 0 for a joint that is locked for good, `dry` is 0
        # for one without dry friction, whose mode is always 1.
        ("mass", float, 6),
        ("gravity", float, (2, 9)),
        ("shake", float, (2, 9)),
        ("shake_frequency", float),
        ("shake_phase", float),
        ("shakes", np.int64),
        ("present", np.int64, 2),
        ("dry", np.int64, 2),
        ("voltage_driven", np.int64),
        ("flexible", np.int64, 2),
        ("contact", np.int64, 2),
        # What acts from outside within a sample: inputs, torques at time zero and their slopes.
        ("input", float, 2),
        ("push", float, 2),
        ("push_slope", float, 2),
        # Room for intermediate results, as small arrays are slow to make.
        ("wave", float, 9),
        ("torque", float, 2),
        ("alpha", float, 2),
        ("friction", float, 2),
        ("slopes", float, (4, 2, SMOOTH)),
        ("stage", float, (2, SMOOTH)),
    ]
)


def joints(
    bodies: Bodies,
    pan: Drive | None,
    tilt: Drive | None,
    voltage_driven: bool = False,
    flexible: tuple[bool, bool] = (False, False),
) -> Joints:
    """The machine with the drives of its joints; None locks a joint, `flexible` ones have the shaft
    of their drive between motor and joint.
    """
    both = (pan, tilt)
    frame = np.zeros(1, FRAME)
    for name, value in bodies._asdict().items():
        frame[0][name] = value
    frame[0]["shakes"] = bool(np.any(bodies.shake))
    frame[0]["present"] = [one is not None for one in both]
    frame[0]["dry"] = [one is not None and one.F_c_forward + one.F_s_forward > 0.0 for one in both]
    frame[0]["voltage_driven"] = voltage_driven
    frame[0]["flexible"] = flexible
    return Joints(as_records(*(one or Drive() for one in both)), frame)


@numba.njit(cache=True)
def motor_torque(k: int, y: Floats, drives: Any, frame: Any) -> float:
    """Torque in N m of the drive on joint `k`."""
    if frame.flexible[k] == 1:
        twist, rate = y[k, GEAR] - y[k, ANGLE], y[k, GEAR_RATE] - y[k, RATE]
        return shaft_torque(drives[k], twist, rate, frame.contact[k])
    if frame.voltage_driven == 1:
        return drives[k].N * drives[k].K_t * y[k, CURRENT]
    limit = drives[k].torque_limit
    return min(limit, max(-limit, arrived(k, y, drives, frame)))


@numba.njit(cache=True)
def arrived(k: int, y: Floats, drives: Any, frame: Any) -> float:
    """Voltage or torque at joint `k`, which may lag behind the input."""
    return frame.input[k] if drives[k].actuator_lag == 0.0 else y[k, DRIVEN]


@numba.njit(cache=True)
def _torque_but_friction(t: float, y: Floats, k: int, drives: Any, frame: Any) -> float:
    """Torque in N m on joint `k` from all but its drive, other joints and its dry friction."""
    drive, angle = drives[k], y[k, ANGLE]
    torque = joint_torque(drive, t, angle, y[k, RATE], y[k, WRAP]) + cogging_torque(drive, angle)
    torque += table_torque(frame.gravity, k, frame.wave)
    if frame.shakes == 1:
        shake = math.sin(2.0 * math.pi * frame.shake_frequency * t + frame.shake_phase)
        torque += shake * table_torque(frame.shake, k, frame.wave)
    return torque + frame.push[k] + frame.push_slope[k] * t


@numba.njit(cache=True)
def _motion(t: float, y: Floats, slip: Any, drives: Any, frame: Any) -> None:
    """Accelerations [2] with stuck joints held, and the dry friction [2] that this takes.

    Both are left in the room of the frame.
    """
    torque, alpha, friction = frame.torque, frame.alpha, frame.friction
    products(y[0, ANGLE], y[1, ANGLE], frame.wave)
    pan, coupling, tilt = mass_matrix(frame.mass, frame.wave)
    bias = rate_torque(frame.mass, frame.wave, y[0, RATE], y[1, RATE])
    for k in range(2):
        torque[k], alpha[k] = 0.0, 0.0
        if frame.present[k] == 1:
            driving = motor_torque(k, y, drives, frame)
            torque[k] = driving + _torque_but_friction(t, y, k, drives, frame) - bias[k]
            if drives[k].loss_mean != 0.0:
                torque[k] -= loss_torque(drives[k], driving, y[k, WOUND])
            if slip[k] != 0:
                torque[k] -= sliding_friction(
                    drives[k], t, y[k, RATE], slip[k], y[k, ANGLE], driving
                )
    if frame.voltage_driven == 1:
        if frame.flexible[0] == 0:
            pan += drives[0].J_motor * drives[0].N ** 2
        if frame.flexible[1] == 0:
            tilt += drives[1].J_motor * drives[1].N ** 2
    if slip[0] != 0 and slip[1] != 0:
        determinant = pan * tilt - coupling * coupling
        alpha[0] = (tilt * torque[0] - coupling * torque[1]) / determinant
        alpha[1] = (pan * torque[1] - coupling * torque[0]) / determinant
    elif slip[0] != 0:
        alpha[0] = torque[0] / pan
    elif slip[1] != 0:
        alpha[1] = torque[1] / tilt
    friction[0] = torque[0] - pan * alpha[0] - coupling * alpha[1]
    friction[1] = torque[1] - tilt * alpha[1] - coupling * alpha[0]


@numba.njit(cache=True)
def _slope(t: float, y: Floats, slip: Any, drives: Any, frame: Any, number: int) -> None:
    """Time derivative of the smooth states [2, 10] in a fixed mode, into slopes[number]."""
    out = frame.slopes
    _motion(t, y, slip, drives, frame)
    for k in range(2):
        drive, rate = drives[k], y[k, RATE]
        out[number, k, ANGLE], out[number, k, RATE] = rate, frame.alpha[k]
        out[number, k, CURRENT], out[number, k, HEAT] = 0.0, 0.0
        if frame.voltage_driven == 1 and frame.present[k] == 1:
            turning = y[k, GEAR_RATE] if frame.flexible[k] == 1 else rate
            volts = arrived(k, y, drives, frame)
            slopes = winding(drive, volts, turning, y[k, CURRENT], y[k, HEAT])
            out[number, k, CURRENT], out[number, k, HEAT] = slopes
        out[number, k, WRAP] = wrap_slope(drive, rate, y[k, WRAP])
        _beside(y, k, drive, frame, out[number, k])


@numba.njit(cache=True)
def _beside(y: Floats, k: int, drive: Any, frame: Any, out: Floats) -> None:
    """Slopes of the states that only some drives have, into `out` [10]."""
    for place in (GEAR, GEAR_RATE, DRIVEN, LAGGED, WOUND):
        out[place] = 0.0
    if frame.flexible[k] == 1:
        twist, rate = y[k, GEAR] - y[k, ANGLE], y[k, GEAR_RATE] - y[k, RATE]
        shaft = shaft_torque(drive, twist, rate, frame.contact[k])
        torque = drive.N * drive.K_t * y[k, CURRENT] - shaft
        out[GEAR], out[GEAR_RATE] = y[k, GEAR_RATE], torque / (drive.J_motor * drive.N**2)
    if drive.actuator_lag != 0.0:
        out[DRIVEN] = (frame.input[k] - y[k, DRIVEN]) / drive.actuator_lag
    if drive.measurement_lag != 0.0:
        out[LAGGED] = (y[k, ANGLE] - y[k, LAGGED]) / drive.measurement_lag
    if drive.loss_mean != 0.0:
        out[WOUND] = loss_slope(drive, y[k, RATE], y[k, WOUND])


@numba.njit(cache=True)
def _step(t: float, y: Floats, slip: Any, drives: Any, frame: Any, h: float) -> Floats:
    """Smooth states [2, 10] after one classical Runge-Kutta step of `h` seconds in a fixed mode."""
    slopes, stage = frame.slopes, frame.stage
    _slope(t, y, slip, drives, frame, 0)
    for number in range(1, 4):
        part = h if number == 3 else 0.5 * h
        for k in range(2):
            for i in range(SMOOTH):
                stage[k, i] = y[k, i] + part * slopes[number - 1, k, i]
        _slope(t + part, stage, slip, drives, frame, number)
    after = np.empty((2, SMOOTH))
    for k in range(2):
        for i in range(SMOOTH):
            middle = slopes[1, k, i] + slopes[2, k, i]
            total = slopes[0, k, i] + 2.0 * middle + slopes[3, k, i]
            after[k, i] = y[k, i] + h / 6.0 * total
    return after


@numba.njit(cache=True)
def _breaks_away(t: float, y: Floats, k: int, rest: Floats, drives: Any, frame: Any) -> bool:
    """Whether the friction left in the frame is more than stuck joint `k` can carry."""
    friction, angle = frame.friction[k], y[k, ANGLE]
    side = 1 if friction > 0.0 else -1
    load = motor_torque(k, y, drives, frame)
    return abs(friction) > breakaway(drives[k], t, side, t - rest[k], angle, load)


@numba.njit(cache=True)
def _contact(k: int, y: Floats, drives: Any) -> int:
    """Contact of the shaft of joint `k`."""
    twist, rate = y[k, GEAR] - y[k, ANGLE], y[k, GEAR_RATE] - y[k, RATE]
    return shaft_contact(drives[k], twist, rate)


@numba.njit(cache=True)
def _leaves_mode(t: float, y: Floats, slip: Any, rest: Floats, drives: Any, frame: Any) -> bool:
    """Whether a sliding joint has reversed or a stuck joint carries more than it can."""
    stuck = False
    for k in range(2):
        if frame.flexible[k] == 1 and _contact(k, y, drives) != frame.contact[k]:
            return True
        if frame.dry[k] == 1 and slip[k] == 0:
            stuck = True
        elif frame.dry[k] == 1 and slip[k] * y[k, RATE] < -DEAD_BAND:
            return True
    if not stuck:
        return False
    _motion(t, y, slip, drives, frame)
    for k in range(2):
        loose = frame.dry[k] == 1 and slip[k] == 0
        if loose and _breaks_away(t, y, k, rest, drives, frame):
            return True
    return False


@numba.njit(cache=True)
def _fits(t: float, y: Floats, mode: Any, rest: Floats, drives: Any, frame: Any) -> bool:
    """Whether friction and motion agree in `mode` [2]."""
    for k in range(2):
        if frame.present[k] == 0:
            if mode[k] != 0:
                return False
        elif frame.dry[k] == 0:
            if mode[k] != 1:
                return False
        elif y[k, RATE] != 0.0 and mode[k] != (1 if y[k, RATE] > 0.0 else -1):
            return False
    _motion(t, y, mode, drives, frame)
    for k in range(2):
        if frame.dry[k] == 0 or y[k, RATE] != 0.0:
            continue
        if mode[k] == 0:
            if _breaks_away(t, y, k, rest, drives, frame):
                return False
        elif mode[k] * frame.alpha[k] <= 0.0:
            return False
    return True


@numba.njit(cache=True)
def _choose_mode(t: float, y: Floats, slip: Any, rest: Floats, drives: Any, frame: Any) -> None:
    """Stop reversed joints, then find the mode in which friction and motion fit; in place."""
    for k in range(2):
        if frame.dry[k] == 1 and slip[k] * y[k, RATE] < 0.0:
            y[k, RATE] = 0.0
            rest[k] = t
        if frame.flexible[k] == 1:
            frame.contact[k] = _contact(k, y, drives)
    for mode in MODES:
        if _fits(t, y, mode, rest, drives, frame):
            slip[:] = mode
            return
    raise RuntimeError("no friction mode fits the state")


@numba.njit(cache=True)
def _land(t: float, y: Floats, slip: Any, rest: Floats, drives: Any, frame: Any, h: float) -> float:
    """Length in s of the step that just leaves the mode, within the `h` that leaves it."""
    low = 0.0
    while h - low > EVENT_TOLERANCE:
        middle = 0.5 * (low + h)
        after = _step(t, y, slip, drives, frame, middle)
        if _leaves_mode(t + middle, after, slip, rest, drives, frame):
            h = middle
        else:
            low = middle
    return h


@numba.njit(cache=True)
def advance(
    span: tuple[float, float],
    y: Floats,
    slip: Any,
    rest: Floats,
    drives: Any,
    frame: Any,
    step: float,
) -> int:
    """Move smooth states, modes and rest times over `span` in s, in place; count the events.

    Inputs and pushes stand in the frame.
    """
    t, end = span
    events = 0
    for k in range(2):
        if frame.flexible[k] == 1:
            frame.contact[k] = _contact(k, y, drives)
    if _leaves_mode(t, y, slip, rest, drives, frame):
        _choose_mode(t, y, slip, rest, drives, frame)
    while end - t > EVENT_TOLERANCE:
        h = min(step, end - t)
        after = _step(t, y, slip, drives, frame, h)
        if _leaves_mode(t + h, after, slip, rest, drives, frame):
            h = _land(t, y, slip, rest, drives, frame, h)
            after = _step(t, y, slip, drives, frame, h)
            _choose_mode(t + h, after, slip, rest, drives, frame)
            events += 1
            if events > MOST_EVENTS:
                raise RuntimeError("mode changes pile up")
        y[:] = after
        t += h
    return events
