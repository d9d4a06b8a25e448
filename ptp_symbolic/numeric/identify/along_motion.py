"""Inverse dynamics along a measured motion, sample by sample, without simulating it.

The joint angles are measured; what is behind a gap follows them: the torque that a joint lacks is
what its shaft transmits, its sign gives the face that is touched, and the twist follows from the
shaft's own law. Winding currents, temperatures and other states of effects are integrated along.
Joint angles behind sensors that err are those at which the sensors show what was measured.
"""

from functools import lru_cache
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np
from numba import njit, types
from numpy.typing import NDArray

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.identify.constants import ROUNDS
from ptp_symbolic.numeric.runtime.element_layout import contact_count, contact_guards, contact_modes
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.kernels.calls import (
    OUTPUT_SIGNATURES,
    SIGNATURES,
    call,
    compiled_addresses,
)
from ptp_symbolic.numeric.simulation.kernels.records import CUBE, INTEGERS, MATRIX, VECTOR

IntArray = NDArray[np.int64]


class Layout(NamedTuple):
    """Where things are in the arrays of a model; -1 for what an axis does not have.

    Per axis [na]: state index of angle and rate, of those of the gear output, the row of the gear
    output in the equations, and the contact between. Per friction [f]: its axis. Per further state
    [e]: its state index, and the friction that sets it to zero at rest.
    """

    angle: IntArray
    rate: IntArray
    gear_angle: IntArray
    gear_rate: IntArray
    gear_row: IntArray
    contact: IntArray
    rigid: IntArray
    friction_axis: IntArray
    further: IntArray
    zero_at_rest: IntArray
    rows: int
    states: int
    modes: int


LAYOUT = types.NamedTuple(
    [types.int64 if kind is int else INTEGERS for kind in Layout.__annotations__.values()], Layout
)


def layout_of(model: Model) -> Layout:
    """The layout of `model`.

    Raises InputError for a model whose states are set by samplers, which have no equation of
    motion, and for one with switches, which depend on what was before.
    """
    if len(model.contacts) > len(model.module.CONTACT_ANGLES):
        raise InputError(
            f"Model '{model.name}' has switches; its torques do not follow from the motion alone."
        )
    if len(model.sampled):
        raise InputError(
            f"Model '{model.name}' has sampled states;"
            " its equations have no residual along a motion."
        )
    states, axes = list(model.state_names), model.module.AXES
    rates = [name for name in states if name.startswith("omega_")]
    contact_of = {pair[1]: k for k, pair in enumerate(model.module.CONTACT_ANGLES)}

    def index(name: str) -> int:
        return states.index(name) if name in states else -1

    angle = np.array([index(f"theta_{a}") for a in axes], dtype=np.int64)
    gear_rate = np.array([index(f"omega_gear_{a}") for a in axes], dtype=np.int64)
    owner = {
        index(f"{word}_{a}"): k for k, a in enumerate(axes) for word in ("omega", "omega_gear")
    }
    mechanical = {i for i, name in enumerate(states) if name.startswith(("theta_", "omega_"))}
    further = [i for i in range(len(states)) if i not in mechanical]
    contact = np.array([contact_of.get(i, -1) for i in angle], dtype=np.int64)
    return Layout(
        angle=angle,
        rate=np.array([index(f"omega_{a}") for a in axes], dtype=np.int64),
        gear_angle=np.array([index(f"theta_gear_{a}") for a in axes], dtype=np.int64),
        gear_rate=gear_rate,
        gear_row=np.array(
            [
                rates.index(f"omega_gear_{a}") if g >= 0 else -1
                for a, g in zip(axes, gear_rate, strict=True)
            ],
            dtype=np.int64,
        ),
        contact=contact,
        rigid=np.array([model.contacts[c, 2] if c >= 0 else 0 for c in contact], dtype=np.int64),
        friction_axis=np.array([owner[int(r)] for r in model.friction_rates], dtype=np.int64),
        further=np.array(further, dtype=np.int64),
        zero_at_rest=model.zero_at_rest[further],
        rows=len(rates),
        states=len(states),
        modes=len(model.mode_names),
    )


def equation_addresses(model: Model) -> IntArray:
    """Addresses [3] of the compiled `equation_error`, `guards` and `outputs` of `model`."""
    kernel, outputs = SIGNATURES["guards"], OUTPUT_SIGNATURES["outputs"]
    return _addresses(model.module, kernel, outputs)


@lru_cache(maxsize=16)
def _addresses(module: ModuleType, kernel: Any, outputs: Any) -> IntArray:
    wanted = {"equation_error": kernel, "guards": kernel, "outputs": outputs}
    return compiled_addresses(module, wanted)


QUOTIENT = float(np.cbrt(np.finfo(float).eps))  # rad, rad/s; step of difference quotients


class Motion(NamedTuple):
    """A measured motion: time [k] in s; angle, rate and acceleration of the joints [k, na] in rad,
    rad/s and rad/s^2; inputs [k, nu] averaged over the cell of each sample; measured further states
    [k, e], nan where a state is not measured.
    """

    time: Any
    angle: Any
    rate: Any
    acceleration: Any
    inputs: Any
    measured: Any


@njit(cache=True, nogil=True, error_model="numpy")
def _fill(layout, motion, k, x, m, resting):
    """State and friction modes at sample k, gear outputs turning with their joints."""
    na = len(layout.angle)
    x[:] = 0.0
    m[:] = 0.0
    for a in range(na):
        x[layout.angle[a]] = motion.angle[k, a]
        x[layout.rate[a]] = motion.rate[k, a]
        x[layout.states + a] = motion.acceleration[k, a]
        if layout.gear_rate[a] >= 0:
            x[layout.gear_angle[a]] = motion.angle[k, a]
            x[layout.gear_rate[a]] = motion.rate[k, a]
            x[layout.states + layout.gear_row[a]] = motion.acceleration[k, a]
    for f in range(len(layout.friction_axis)):
        rate = motion.rate[k, layout.friction_axis[f]]
        m[f] = 0.0 if abs(rate) < resting[layout.friction_axis[f]] else np.sign(rate)


@njit(cache=True, nogil=True, error_model="numpy")
def gear_ahead(addresses, layout, motion, p, resting, given, wanted):
    """How far [k, na] in rad every gear output is ahead of its joint at p [np], and the face
    [k, na] (-1, 0, 1) that it touches: the `given` [k, na] one, or where that is 0 the one on which
    the joint must rest; `resting` [na] in rad/s. Both stay 0 where they are not `wanted` [k].
    """
    n, na = motion.angle.shape
    ahead, face = np.zeros((n, na)), np.zeros((n, na))
    if np.all(layout.contact < 0):
        return ahead, face
    frictions = len(layout.friction_axis)
    x, m = np.zeros(layout.states + layout.rows), np.zeros(layout.modes)
    r = np.zeros(layout.rows + len(layout.further))
    contacts = contact_count(frictions, layout.modes)
    g = np.zeros(contact_guards(frictions, contacts))
    for k in range(n):
        if not wanted[k]:
            continue
        _fill(layout, motion, k, x, m, resting)
        for e in range(len(layout.further)):
            value = motion.measured[k, e]
            x[layout.further[e]] = 0.0 if np.isnan(value) else value
        call(addresses[0], motion.time[k], x, motion.inputs[k], p, m, r)
        for a in range(na):
            c = layout.contact[a]
            if c < 0:
                continue
            side = given[k, a]
            if side == 0.0:
                side = 1.0 if r[a] > 0.0 else -1.0
            face[k, a] = side
            at = contact_guards(frictions, c)
            torque = at + 2 if side > 0.0 else at + 3
            m[contact_modes(frictions, c)] = side
            call(addresses[1], motion.time[k], x, motion.inputs[k], p, m, g)
            if layout.rigid[a] > 0:
                ahead[k, a] = side * g[at + 1] - g[at]
                continue
            first = g[torque]
            x[layout.gear_angle[a]] += QUOTIENT
            call(addresses[1], motion.time[k], x, motion.inputs[k], p, m, g)
            ahead[k, a] = (r[a] - first) * QUOTIENT / (g[torque] - first)
            x[layout.gear_angle[a]] = motion.angle[k, a]
    return ahead, face


@njit(cache=True, nogil=True, error_model="numpy")
def gear_pushes(addresses, layout, motion, p, resting, face, further):
    """Torque [k, na] in N m (force of a linear joint) with which every gear output must push the
    `face` [k, na] that it touches to turn with its joint, at p [np] and the `further` states
    [k, e]: below zero it would have to pull, which no face can.
    """
    n, na = motion.angle.shape
    pushes = np.zeros((n, na))
    x, m = np.zeros(layout.states + layout.rows), np.zeros(layout.modes)
    r = np.zeros(layout.rows + len(layout.further))
    for k in range(n):
        _fill(layout, motion, k, x, m, resting)
        for e in range(len(layout.further)):
            x[layout.further[e]] = further[k, e]
        for f in range(len(layout.friction_axis)):
            m[f] = np.sign(motion.rate[k, layout.friction_axis[f]])
        call(addresses[0], motion.time[k], x, motion.inputs[k], p, m, r)
        for a in range(na):
            if layout.contact[a] >= 0 and layout.gear_row[a] >= 0:
                pushes[k, a] = -face[k, a] * r[layout.gear_row[a]]
    return pushes


@njit(cache=True, nogil=True, error_model="numpy")
def further_states(addresses, layout, motion, p, resting, acts, shown, wanted, late):
    """The further states [k, e] integrated along the motion at p [np], their averages [k, e] over
    the cells around the samples, and the quasi-static derivative [k, e, na] by the joint rates of
    those that are `shown` [e], 0 where it is not `wanted` [k]. `late` [k - 1, parts, nu] holds the
    inputs between samples, an even number of parts, each one exponential Euler step per state; a
    state that does not act (`acts` [e]) on anything stays at zero.
    """
    n, na = motion.angle.shape
    count, frictions, parts = len(layout.further), len(layout.friction_axis), late.shape[1]
    found, mean = np.zeros((n, count)), np.zeros((n, count))
    by_rate, halves, decay = np.zeros((n, count, na)), np.zeros((2, count)), np.zeros(count)
    x, m = np.zeros(layout.states + layout.rows), np.zeros(layout.modes)
    r = np.zeros(layout.rows + count)
    previous = np.ones(frictions)
    for k in range(n - 1):
        _fill(layout, motion, k, x, m, resting)
        for e in range(count):
            friction = layout.zero_at_rest[e]
            if friction >= 0 and m[friction] == 0.0 and previous[friction] != 0.0:
                found[k, e] = 0.0
            x[layout.further[e]] = found[k, e]
        for f in range(frictions):
            previous[f] = m[f]
        _find_decays(addresses, layout, motion.time[k], x, late[k, 0], p, m, r, acts, decay)
        step = (motion.time[k + 1] - motion.time[k]) / parts
        halves[:] = 0.0
        for s in range(parts):
            share = (s + 0.5) / parts
            _move(layout, motion, k, share, x)
            time = motion.time[k] + (s + 0.5) * step
            for e in range(count):
                if not acts[e]:
                    continue
                at = layout.further[e]
                call(addresses[0], time, x, late[k, s], p, m, r)
                z, change = decay[e] * step, step * r[layout.rows + e]
                growth = np.expm1(z) / z if abs(z) > 1e-6 else 1.0 + 0.5 * z
                bend = (growth - 1.0) / z if abs(z) > 1e-4 else 0.5 + z / 6.0
                halves[0 if 2 * s < parts else 1, e] += (x[at] + bend * change) / parts
                x[at] += growth * change
        for e in range(count):
            found[k + 1, e] = x[layout.further[e]]
            mean[k, e] += halves[0, e]
            mean[k + 1, e] += halves[1, e]
            if wanted[k] and shown[e] and decay[e] != 0.0:
                _settle(addresses, layout, motion.time[k], x, late[k, 0], p, m, r, e, by_rate[k, e])
                for a in range(na):
                    by_rate[k, e, a] /= -decay[e]
    for k in (0, n - 1):
        for e in range(count):
            mean[k, e] += 0.5 * found[k, e]
    return found, mean, by_rate


@njit(cache=True, nogil=True, error_model="numpy")
def _move(layout, motion, k, share, x):
    """Joints between samples k and k + 1, gear outputs with them."""
    for a in range(len(layout.angle)):
        angle = (1.0 - share) * motion.angle[k, a] + share * motion.angle[k + 1, a]
        rate = (1.0 - share) * motion.rate[k, a] + share * motion.rate[k + 1, a]
        x[layout.angle[a]], x[layout.rate[a]] = angle, rate
        if layout.gear_rate[a] >= 0:
            x[layout.gear_angle[a]], x[layout.gear_rate[a]] = angle, rate


@njit(cache=True, nogil=True, error_model="numpy")
def _find_decays(addresses, layout, time, x, u, p, m, r, acts, decay):
    """Derivative [e] of the rate of every further state by itself."""
    call(addresses[0], time, x, u, p, m, r)
    for e in range(len(layout.further)):
        decay[e] = -r[layout.rows + e]
    for e in range(len(layout.further)):
        if acts[e]:
            at = layout.further[e]
            by = 1e-6 * max(abs(x[at]), 1.0)
            x[at] += by
            call(addresses[0], time, x, u, p, m, r)
            x[at] -= by
            decay[e] = (decay[e] + r[layout.rows + e]) / by


@njit(cache=True, nogil=True, error_model="numpy")
def _settle(addresses, layout, time, x, u, p, m, r, e, by_rate):
    """Derivative [na] of the rate of the further state e by the rates of the joints."""
    call(addresses[0], time, x, u, p, m, r)
    still = r[layout.rows + e]
    for a in range(len(layout.angle)):
        behind = layout.gear_rate[a]
        x[layout.rate[a]] += QUOTIENT
        if behind >= 0:
            x[behind] += QUOTIENT
        call(addresses[0], time, x, u, p, m, r)
        x[layout.rate[a]] -= QUOTIENT
        if behind >= 0:
            x[behind] -= QUOTIENT
        by_rate[a] = (r[layout.rows + e] - still) / QUOTIENT


@njit(cache=True, nogil=True, error_model="numpy")
def torques_along(addresses, layout, motion, p, resting, ahead, ahead_rate, face, further, part):
    """Inverse dynamics per sample at p [np]: the torque [k, na] in N m that every axis lacks
    without accelerations, its derivatives [k, na, rows] by every acceleration (inertia), and
    [k, na, 2 na] by the angles, then the rates of the joints; a gear output counts with its joint.
    Samples whose `part` [k] is 0 stay zero, and derivatives where it is 1.
    """
    n, na = motion.angle.shape
    frictions = len(layout.friction_axis)
    lacking, inertia = np.zeros((n, na)), np.zeros((n, na, layout.rows))
    slopes = np.zeros((n, na, 2 * na))
    x, m = np.zeros(layout.states + layout.rows), np.zeros(layout.modes)
    r = np.zeros(layout.rows + len(layout.further))
    still = np.zeros(layout.rows + len(layout.further))
    for k in range(n):
        if part[k] == 0:
            continue
        _fill(layout, motion, k, x, m, resting)
        for a in range(na):
            if layout.contact[a] >= 0:
                x[layout.gear_angle[a]] += ahead[k, a]
                x[layout.gear_rate[a]] += ahead_rate[k, a]
                m[contact_modes(frictions, layout.contact[a])] = face[k, a]
                m[contact_modes(frictions, layout.contact[a]) + 1] = 1.0
        for f in range(frictions):
            m[f] = np.sign(motion.rate[k, layout.friction_axis[f]])
        for e in range(len(layout.further)):
            x[layout.further[e]] = further[k, e]
        x[layout.states :] = 0.0
        call(addresses[0], motion.time[k], x, motion.inputs[k], p, m, still)
        for a in range(na):
            lacking[k, a] = still[a]
            if layout.gear_row[a] >= 0:
                lacking[k, a] += still[layout.gear_row[a]]
        if part[k] == 1:
            continue
        for row in range(layout.rows):
            x[layout.states + row] = 1.0
            call(addresses[0], motion.time[k], x, motion.inputs[k], p, m, r)
            x[layout.states + row] = 0.0
            for a in range(na):
                inertia[k, a, row] = r[a] - still[a]
                if layout.gear_row[a] >= 0:
                    inertia[k, a, row] += r[layout.gear_row[a]] - still[layout.gear_row[a]]
        for j in range(2 * na):
            axis = j % na
            at = layout.angle[axis] if j < na else layout.rate[axis]
            behind = layout.gear_angle[axis] if j < na else layout.gear_rate[axis]
            x[at] += QUOTIENT
            if behind >= 0:
                x[behind] += QUOTIENT
            call(addresses[0], motion.time[k], x, motion.inputs[k], p, m, r)
            x[at] -= QUOTIENT
            if behind >= 0:
                x[behind] -= QUOTIENT
            for a in range(na):
                slopes[k, a, j] = (r[a] - still[a]) / QUOTIENT
                if layout.gear_row[a] >= 0:
                    row = layout.gear_row[a]
                    slopes[k, a, j] += (r[row] - still[row]) / QUOTIENT
    return lacking, inertia, slopes


NEXT_TO_NONE = float(np.sqrt(np.finfo(float).eps))  # rad; of an angle: the root of rounding


@njit(cache=True, nogil=True, error_model="numpy")
def angles_behind_sensors(addresses, layout, shown, time, measured, inputs, p, signals):
    """Joint angles [k, na] in rad at which the sensors at p [np] show what was `measured` [k, na];
    `shown` [na] is the place of every angle among the `signals` outputs. Fixed-point iteration:
    errors of sensors are small and smooth.
    """
    angles = measured.copy()
    x, y = np.zeros(layout.states), np.zeros(signals)
    for k in range(len(time)):
        for _ in range(ROUNDS):
            left = 0.0
            for a in range(len(shown)):
                x[layout.angle[a]] = angles[k, a]
            call(addresses[2], time[k], x, inputs[k], p, y)
            for a in range(len(shown)):
                error = measured[k, a] - y[shown[a]]
                angles[k, a] += error
                left = max(left, abs(error))
            if left <= NEXT_TO_NONE:
                break
    return angles


_FLAGS = INTEGERS.copy(dtype=types.boolean)
_MOTION = types.NamedTuple((VECTOR, MATRIX, MATRIX, MATRIX, MATRIX, MATRIX), Motion)
_ALONG = (INTEGERS, LAYOUT, _MOTION, VECTOR, VECTOR)  # addresses, layout, motion, p, resting
AHEAD = (
    (gear_ahead, (*_ALONG, MATRIX, _FLAGS)),
    (gear_pushes, (*_ALONG, MATRIX, MATRIX)),
    (further_states, (*_ALONG, _FLAGS, _FLAGS, _FLAGS, CUBE)),
    (torques_along, (*_ALONG, MATRIX, MATRIX, MATRIX, MATRIX, INTEGERS)),
    (
        angles_behind_sensors,
        (INTEGERS, LAYOUT, INTEGERS, VECTOR, MATRIX, MATRIX, VECTOR, types.int64),
    ),
)
