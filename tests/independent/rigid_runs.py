"""Runs of driven joints: with given inputs from given states, or under a sampled servo."""

import math
from typing import Any, NamedTuple

import numba
import numpy as np

from tests.independent.drive import Floats
from tests.independent.drive_laws import harmonics
from tests.independent.rigid_drives import (
    ANGLE,
    DRIVEN,
    GEAR,
    GEAR_RATE,
    LAGGED,
    RATE,
    REST,
    SLIP,
    SMOOTH,
    STATES,
    STEP,
    Joints,
    advance,
)


class Servo(NamedTuple):
    """A sampled tracking controller per joint, on the encoder's count and the true rate.

    Arrays [2]: stiffness and rate_gain in the input's unit per rad and per rad/s, weight (input
    that lifts a payload at angle zero), limit of the input. `count` in rad.
    """

    stiffness: Floats
    rate_gain: Floats
    weight: Floats
    limit: Floats
    count: float


@numba.njit(cache=True)
def _sample(
    drives: Any,
    frame: Any,
    state: Floats,
    inputs: Floats,
    pushes: Floats,
    k: int,
    period: float,
    step: float,
) -> None:
    """Move the state [2, 12] over sample `k`, each input late by its drive's delay; in place."""
    y, rest = state[:, :SMOOTH].copy(), state[:, REST].copy()
    slip, late, change = np.empty(2, np.int64), np.empty(2, np.int64), np.empty(2)
    t, end = k * period, (k + 1) * period
    for joint in range(2):
        slip[joint] = int(state[joint, SLIP])
        rise = (pushes[k + 1, joint] - pushes[k, joint]) / period
        frame.push_slope[joint] = rise
        frame.push[joint] = pushes[k, joint] - rise * t
        late[joint] = int(drives[joint].delay / period)
        change[joint] = t + (drives[joint].delay - late[joint] * period)
    while t < end:
        until = end
        for joint in range(2):
            source = k - late[joint]
            if t < change[joint]:
                until = min(until, change[joint])
                source -= 1
            frame.input[joint] = inputs[max(source, 0), joint]
        advance((t, until), y, slip, rest, drives, frame, step)
        t = until
    state[:, :SMOOTH] = y
    state[:, REST] = rest
    for joint in range(2):
        state[joint, SLIP] = slip[joint]


@numba.njit(cache=True)
def _command(servo: Servo, drives: Any, state: Floats, target: Floats, out: Floats) -> None:
    """Inputs [2] of the servo for feedforward, angle and rate wanted: `target` [2, 3]."""
    for joint in range(2):
        angle = state[joint, ANGLE]
        read = angle + harmonics(drives[joint].encoder, angle)
        counted = servo.count * np.rint(read / servo.count)
        wanted = target[joint, 0]
        wanted += servo.stiffness[joint] * (target[joint, 1] - counted)
        wanted += servo.rate_gain[joint] * (target[joint, 2] - state[joint, RATE])
        wanted -= servo.weight[joint] * math.cos(counted)
        out[joint] = min(servo.limit[joint], max(-servo.limit[joint], wanted))


@numba.njit(cache=True)
def _settle(frame: Any, state: Floats) -> None:
    """Set the modes of `state` [2, 12] to what its rates and the kinds of its joints say; in place.

    A joint at rest with dry friction keeps its mode.
    """
    for joint in range(2):
        if frame.present[joint] == 0:
            state[joint, SLIP] = 0.0
        elif frame.dry[joint] == 0:
            state[joint, SLIP] = 1.0
        elif state[joint, RATE] != 0.0:
            state[joint, SLIP] = np.sign(state[joint, RATE])


@numba.njit(cache=True)
def _track(
    both: tuple[Any, Any],
    servo: Servo,
    targets: Floats,
    kept: Any,
    pushes: Floats,
    state: Floats,
    clock: tuple[float, float],
) -> tuple[Floats, Floats]:
    drives, frame = both
    samples = targets.shape[0]
    inputs, states = np.zeros((samples, 2)), np.empty((samples, 2, STATES))
    _settle(frame, state)
    for k in range(samples):
        if kept[k] or k == 0:
            _command(servo, drives, state, targets[k], inputs[k])
        else:
            inputs[k] = inputs[k - 1]
        if k == 0:
            state[:, DRIVEN] = inputs[0]  # what lags behind has settled
        states[k] = state
        _sample(drives, frame, state, inputs, pushes, k, clock[0], clock[1])
    return inputs, states


def track(
    machine: Joints,
    servo: Servo,
    targets: Floats,
    kept: Any,
    pushes: Floats,
    start: Floats,
    period: float,
    step: float = STEP,
) -> tuple[Floats, Floats]:
    """Inputs [n, 2] and states [n, 2, 12] of a run under the servo, from `start` [2, 12].

    targets [n, 2, 3]: feedforward, angle and rate wanted; where `kept` [n] is False the computer
    stalls and the input stays; pushes [n + 1, 2] in N m are linear between samples.
    """
    both = (machine.drives, machine.frame[0])
    return _track(both, servo, targets, kept, pushes, start.copy(), (period, step))


@numba.njit(cache=True)
def _replay(
    both: tuple[Any, Any],
    inputs: Floats,
    pushes: Floats,
    starts: Floats,
    window: int,
    clock: tuple[float, float],
) -> Floats:
    drives, frame = both
    states = np.empty((inputs.shape[0], 2, STATES))
    state = starts[0].copy()
    for k in range(inputs.shape[0]):
        if k % window == 0:
            state[:] = starts[k // window]
            _settle(frame, state)
        states[k] = state
        _sample(drives, frame, state, inputs, pushes, k, clock[0], clock[1])
    return states


def replay(
    machine: Joints,
    inputs: Floats,
    pushes: Floats,
    starts: Floats,
    window: int,
    period: float,
    step: float = STEP,
) -> Floats:
    """States [n, 2, 12] under inputs [n, 2], anew from starts [windows, 2, 12] every `window`.

    An input is held from its sample to the next; before the first it is the first.
    """
    both = (machine.drives, machine.frame[0])
    return _replay(both, inputs, pushes, starts, window, (period, step))


def at_rest(angles: Floats, rates: Floats | None = None) -> Floats:
    """State [2, 12] at given angles [2] and rates [2]; a joint at rest starts stuck.

    Shafts are relaxed and readings have settled.
    """
    state = np.zeros((2, STATES))
    state[:, ANGLE] = state[:, GEAR] = state[:, LAGGED] = angles
    state[:, RATE] = state[:, GEAR_RATE] = 0.0 if rates is None else rates
    return state
