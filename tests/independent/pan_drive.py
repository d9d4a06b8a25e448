"""Voltage-driven pan axis with true sticking and a gap, event by event: a truth for fits and tests.

Motor current, gear output with set-valued CSVS friction, dead zone whose contact cannot pull, load.
Between events the motion is smooth: Dormand and Prince's pair of orders 5 and 4 (J. Comput. Appl.
Math. 6, 1980) at a tight tolerance; events are bisected to 1e-12 s and landed on their far side.
Beside the declared drive it holds effects that a test can plant; at their defaults they vanish.
"""

import math
from typing import Any, NamedTuple

import numba
import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

LOAD_ANGLE, LOAD_RATE, GEAR_ANGLE, GEAR_RATE, CURRENT, HEAT = range(6)
DEAD_BAND = 1e-13  # rad/s; rounding right after breakaway must not count as a reversal
EVENT_TOLERANCE = 1e-12  # s
LONGEST_STEP = 5e-4  # s
NEGLIGIBLE = 1e-60  # flushed to zero, as denormal numbers are slow


class PanDrive(NamedTuple):
    """The drive and everything hidden in it; SI units, torques and rates at the gear output.

    `forward` is motion towards positive angles. Payload torque: gravity_torque = m g c sin(beta),
    towards the angle alpha_base. Coulomb ripple: friction_ripple (1 - cos(n theta - phase)) / 2 on
    top of Coulomb and breakaway torque. Breakaway grows by the factor
    1 + dwell_gain ln(1 + rest / dwell_time); resistance by heat, with
    heating_time d(heat)/dt = heating_gain R i^2 - heat.
    """

    L: float = 6.9e-3
    R: float = 12.9
    K_t: float = 0.0724
    J_motor: float = 1.1e-5
    N: float = 500.0
    k_shaft: float = 5000.0
    d_shaft: float = 1.5
    gap: float = math.radians(1.49)
    J_load: float = 0.1
    b_load: float = 2.0
    F_c_forward: float = 0.24
    F_c_backward: float = 0.24
    F_s_forward: float = 0.65
    F_s_backward: float = 0.65
    v_s_forward: float = 0.016
    v_s_backward: float = 0.016
    F_v_forward: float = 14.0
    F_v_backward: float = 14.0
    gravity_torque: float = 0.0
    alpha_base: float = 0.0
    k1_cable: float = 0.0
    k3_cable: float = 0.0
    theta0_cable: float = 0.0
    constant_torque: float = 0.0
    voltage_offset: float = 0.0
    friction_ripple: float = 0.0
    ripple_count: float = 1.0
    ripple_phase: float = 0.0
    dwell_gain: float = 0.0
    dwell_time: float = 1.0
    heating_gain: float = 0.0
    heating_time: float = 1.0
    shake_torque: float = 0.0
    shake_frequency: float = 1.0
    shake_phase: float = 0.0


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
def _touching(y: Floats, drive: PanDrive) -> int:
    """Flank that presses: 1, -1, or 0 in the gap and where the damped contact would pull."""
    for side in (1, -1):
        depth = side * (y[GEAR_ANGLE] - y[LOAD_ANGLE]) - 0.5 * drive.gap
        closing = side * (y[GEAR_RATE] - y[LOAD_RATE])
        if depth > 0.0 and drive.k_shaft * depth + drive.d_shaft * closing > 0.0:
            return side
    return 0


@numba.njit(cache=True)
def _contact_torque(y: Floats, contact: int, drive: PanDrive) -> float:
    """Torque on the load in N m through the flank `contact`."""
    if contact == 0:
        return 0.0
    twist = y[GEAR_ANGLE] - y[LOAD_ANGLE] - contact * 0.5 * drive.gap
    return drive.k_shaft * twist + drive.d_shaft * (y[GEAR_RATE] - y[LOAD_RATE])


@numba.njit(cache=True)
def _gear_torque(y: Floats, contact: int, drive: PanDrive) -> float:
    """Torque in N m at the gear output that is left for friction and motor inertia."""
    return drive.N * drive.K_t * y[CURRENT] - _contact_torque(y, contact, drive)


@numba.njit(cache=True)
def _ripple(y: Floats, drive: PanDrive) -> float:
    angle = drive.ripple_count * y[GEAR_ANGLE] - drive.ripple_phase
    return 0.5 * drive.friction_ripple * (1.0 - math.cos(angle))


@numba.njit(cache=True)
def _sliding_friction(y: Floats, slip: int, drive: PanDrive) -> float:
    """CSVS friction in N m while sliding towards `slip`; smooth in the rate, also past zero."""
    rate = y[GEAR_RATE]
    coulomb, static = drive.F_c_forward, drive.F_s_forward
    stribeck, viscous = drive.v_s_forward, drive.F_v_forward
    if slip < 0:
        coulomb, static = drive.F_c_backward, drive.F_s_backward
        stribeck, viscous = drive.v_s_backward, drive.F_v_backward
    level = coulomb + (static - coulomb) * math.exp(-((rate / stribeck) ** 2))
    return slip * (level + _ripple(y, drive)) + viscous * rate


@numba.njit(cache=True)
def _breakaway(y: Floats, side: int, rest: float, drive: PanDrive) -> float:
    """Torque in N m that starts motion towards `side` after `rest` seconds at rest."""
    static = drive.F_s_forward if side > 0 else drive.F_s_backward
    growth = 1.0 + drive.dwell_gain * math.log(1.0 + rest / drive.dwell_time)
    return static * growth + _ripple(y, drive)


@numba.njit(cache=True)
def _slope(
    t: float, y: Floats, u: float, contact: int, slip: int, drive: PanDrive, out: Floats
) -> None:
    """Time derivative of the state [6] in a fixed mode, into `out`."""
    stretch = y[LOAD_ANGLE] - drive.theta0_cable
    load = _contact_torque(y, contact, drive) - drive.b_load * y[LOAD_RATE]
    load -= drive.k1_cable * stretch + drive.k3_cable * stretch**3
    load -= drive.gravity_torque * math.sin(y[LOAD_ANGLE] - drive.alpha_base)
    load += drive.constant_torque
    shake = 2.0 * math.pi * drive.shake_frequency * t + drive.shake_phase
    load += drive.shake_torque * math.sin(shake)
    out[LOAD_ANGLE], out[GEAR_ANGLE] = y[LOAD_RATE], y[GEAR_RATE]
    out[LOAD_RATE] = load / drive.J_load
    out[GEAR_RATE] = 0.0
    if slip != 0:
        torque = _gear_torque(y, contact, drive) - _sliding_friction(y, slip, drive)
        out[GEAR_RATE] = torque / (drive.J_motor * drive.N**2)
    drop = drive.R * (1.0 + y[HEAT]) * y[CURRENT]
    back = drive.K_t * drive.N * y[GEAR_RATE]
    out[CURRENT] = (u + drive.voltage_offset - drop - back) / drive.L
    out[HEAT] = (drive.heating_gain * drop * y[CURRENT] - y[HEAT]) / drive.heating_time


@numba.njit(cache=True)
def _step(
    t: float, y: Floats, u: float, contact: int, slip: int, drive: PanDrive, h: float
) -> tuple[Floats, float]:
    """State [6] after one step of order 5, and the largest difference to order 4."""
    slopes = np.empty((7, 6))
    stage = y.copy()
    for s in range(7):
        for i in range(6):
            total = 0.0
            for j in range(s):
                total += _A[s, j] * slopes[j, i]
            stage[i] = y[i] + h * total
        _slope(t + _C[s] * h, stage, u, contact, slip, drive, slopes[s])
    error = 0.0
    for i in range(6):
        total = 0.0
        for j in range(7):
            total += _ERROR[j] * slopes[j, i]
        error = max(error, abs(h * total))
    return stage, error


@numba.njit(cache=True)
def _leaves_mode(
    t: float, y: Floats, contact: int, slip: int, rest_since: float, drive: PanDrive
) -> bool:
    """Whether flank or friction mode no longer fits the state."""
    if _touching(y, drive) != contact:
        return True
    if slip != 0:
        return slip * y[GEAR_RATE] < -DEAD_BAND
    torque = _gear_torque(y, contact, drive)
    side = 1 if torque > 0.0 else -1
    return abs(torque) > _breakaway(y, side, t - rest_since, drive)


@numba.njit(cache=True)
def _choose_mode(t: float, y: Floats, mode: Any, memory: Floats, drive: PanDrive) -> None:
    """New (contact, slip) in `mode` [2]; first the rate is stopped, then the flank, then friction.

    memory [2] = (time since when the gear is at rest in s, last step size in s).
    """
    if mode[1] * y[GEAR_RATE] < 0.0:
        y[GEAR_RATE] = 0.0
        memory[0] = t
    mode[0] = _touching(y, drive)
    if y[GEAR_RATE] == 0.0:
        torque = _gear_torque(y, mode[0], drive)
        side = 1 if torque > 0.0 else -1
        holds = abs(torque) <= _breakaway(y, side, t - memory[0], drive)
        mode[1] = 0 if holds else side


@numba.njit(cache=True)
def _land(
    t: float, y: Floats, u: float, mode: Any, memory: Floats, drive: PanDrive, h: float
) -> float:
    """Length in s of the step that just leaves the mode, within the `h` that leaves it."""
    low = 0.0
    while h - low > EVENT_TOLERANCE:
        middle = 0.5 * (low + h)
        after, _ = _step(t, y, u, mode[0], mode[1], drive, middle)
        if _leaves_mode(t + middle, after, mode[0], mode[1], memory[0], drive):
            h = middle
        else:
            low = middle
    return h


@numba.njit(cache=True)
def _advance(
    t: float,
    end: float,
    y: Floats,
    u: float,
    mode: Any,
    memory: Floats,
    drive: PanDrive,
    tol: float,
) -> int:
    """Move the state [6] from `t` to `end` under held voltage, in place; the number of events."""
    events = 0
    while end - t > EVENT_TOLERANCE:
        h = min(memory[1], end - t)
        after, error = _step(t, y, u, mode[0], mode[1], drive, h)
        growth = min(4.0, max(0.2, 0.9 * (tol / max(error, 1e-30)) ** 0.2))
        if error > tol:
            memory[1] = h * growth
            continue
        if h == memory[1] or growth < 1.0:
            memory[1] = min(LONGEST_STEP, h * growth)
        if _leaves_mode(t + h, after, mode[0], mode[1], memory[0], drive):
            h = _land(t, y, u, mode, memory, drive, h)
            after, _ = _step(t, y, u, mode[0], mode[1], drive, h)
            _choose_mode(t + h, after, mode, memory, drive)
            events += 1
            if events > 10_000:
                raise RuntimeError("mode changes pile up")
        t += h
        for i in range(6):
            y[i] = after[i] if abs(after[i]) > NEGLIGIBLE else 0.0
    return events


@numba.njit(cache=True)
def _run(
    drive: PanDrive, voltage: Floats, start: Floats, period: float, tol: float
) -> tuple[Floats, int]:
    states = np.empty((voltage.shape[0], 6))
    y = start.copy()
    mode = np.zeros(2, dtype=np.int64)
    memory = np.array([0.0, 1e-5])
    mode[1] = int(np.sign(y[GEAR_RATE]))
    _choose_mode(0.0, y, mode, memory, drive)
    events = 0
    for k in range(voltage.shape[0]):
        states[k] = y
        events += _advance(k * period, (k + 1) * period, y, voltage[k], mode, memory, drive, tol)
    return states, events


def simulate(
    drive: PanDrive, voltage: Floats, start: Floats, period: float = 5e-3, tolerance: float = 1e-12
) -> tuple[Floats, int]:
    """States [n, 6] at the sample times under voltage [n] in V, and the number of events.

    Columns: load angle and rate, gear angle and rate (rad, rad/s), current in A, relative heating.
    `voltage[k]` is held from sample k to sample k + 1; `tolerance` is the local error of a step.
    """
    voltage, start = np.asarray(voltage, dtype=float), np.asarray(start, dtype=float)
    return _run(PanDrive(*(float(value) for value in drive)), voltage, start, period, tolerance)
