"""Bodies of the rigid machines from parameters in the project's names, and their torques."""

import functools
import math
from collections.abc import Mapping

import numpy as np

from tests.benchmark.machine import Floats, Values
from tests.benchmark.truth_drive import GRAVITY
from tests.independent.bodies import PAN, TILT, Bodies, single_axis
from tests.independent.mujoco_bodies import mujoco_bodies
from tests.independent.rigid_drives import ANGLE, RATE

_FRAME_WORDS = ("J_", "m_payload", "c_", "dc_", "_base")


def _lean_and_shake(values: Values) -> tuple[float, float, float, float]:
    """Lean and its azimuth, acceleration of the base and its azimuth."""
    names = ("beta_base", "alpha_base", "a_base", "psi_base")
    beta, alpha, size, azimuth = (values.get(name, 0.0) for name in names)
    return beta, alpha, size, azimuth


def _tilt_bodies(values: Values) -> Bodies:
    """A tilt axis alone on a fixed pan angle of zero."""
    beta, alpha, size, azimuth = _lean_and_shake(values)
    mass = values["m_payload"]
    ahead = values["c_x_payload"] + values.get("dc_x_payload", 0.0)
    above = values.get("dc_z_payload", 0.0)
    down, forward = math.cos(beta), math.sin(beta) * math.cos(alpha)
    weight, shaken = mass * GRAVITY, -mass * size * math.cos(azimuth)
    return single_axis(
        TILT,
        values["J_y_tilt"] + mass * (ahead**2 + above**2),
        (weight * (ahead * down + above * forward), weight * (above * down - ahead * forward)),
        (shaken * above, -shaken * ahead),
        values.get("f_base", 1.0),
        values.get("phi_base", 0.0),
    )


def _pan_bodies(values: Values) -> Bodies:
    """A pan axis alone with its payload level."""
    beta, alpha, size, azimuth = _lean_and_shake(values)
    lever = values["m_payload"] * values["c_x_payload"]
    weight, shaken = lever * GRAVITY * math.sin(beta), -lever * size
    return single_axis(
        PAN,
        values["J_pan"] + lever * values["c_x_payload"],
        (weight * math.sin(alpha), -weight * math.cos(alpha)),
        (shaken * math.sin(azimuth), -shaken * math.cos(azimuth)),
        values.get("f_base", 1.0),
        values.get("phi_base", 0.0),
    )


@functools.lru_cache(maxsize=256)
def _both(items: tuple[tuple[str, float], ...]) -> Bodies:
    """Bodies by MuJoCo, kept for the next call with the same parameters."""
    return mujoco_bodies(dict(items))


def bodies_of(values: Mapping[str, float], axes: tuple[str, ...]) -> Bodies:
    """Bodies of one axis written down, of both axes read off MuJoCo."""
    if axes == ("tilt",):
        return _tilt_bodies(values)
    if axes == ("pan",):
        return _pan_bodies(values)
    wanted = {k: v for k, v in values.items() if any(word in k for word in _FRAME_WORDS)}
    return _both(tuple(sorted(wanted.items())))


def gravity_and_inertia(bodies: Bodies, states: Floats, period: float) -> Floats:
    """Torque [n, 2] in N m from gravity and a shaking base, less what the bodies' motion takes."""
    pan, tilt = states[:, 0, ANGLE], states[:, 1, ANGLE]
    of_pan = np.column_stack([np.ones_like(pan), np.cos(pan), np.sin(pan)])
    of_tilt = np.column_stack([np.ones_like(tilt), np.cos(tilt), np.sin(tilt)])
    wave = (of_pan[:, :, None] * of_tilt[:, None, :]).reshape(-1, 9)
    turn = 2 * math.pi * bodies.shake_frequency * period * np.arange(len(pan)) + bodies.shake_phase
    torque = wave @ bodies.gravity.T + np.sin(turn)[:, None] * (wave @ bodies.shake.T)
    rates = states[:, :, RATE]
    accelerations = np.gradient(rates, period, axis=0)
    mass, double = bodies.mass, 2 * tilt
    inertia = mass[0] + mass[1] * np.cos(double) + mass[2] * np.sin(double)
    slope = 2 * (mass[2] * np.cos(double) - mass[1] * np.sin(double))
    coupling = mass[3] * np.cos(tilt) + mass[4] * np.sin(tilt)
    coupling_slope = mass[4] * np.cos(tilt) - mass[3] * np.sin(tilt)
    torque[:, 0] -= inertia * accelerations[:, 0] + coupling * accelerations[:, 1]
    torque[:, 0] -= slope * rates[:, 0] * rates[:, 1] + coupling_slope * rates[:, 1] ** 2
    torque[:, 1] -= coupling * accelerations[:, 0] + mass[5] * accelerations[:, 1]
    torque[:, 1] += 0.5 * slope * rates[:, 0] ** 2
    return torque
