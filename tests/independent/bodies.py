"""Rigid bodies of one or two crossing axes as trigonometric polynomials of the joint angles.

The mass matrix and the gravity torque of bodies that turn about two crossing axes are exactly such
polynomials. Their coefficients are read off MuJoCo (`mujoco_bodies`) or, for one axis, written down
(`single_axis`). Coriolis and centrifugal torques follow from the mass matrix (Christoffel symbols).
"""

import math
from typing import NamedTuple

import numba
import numpy as np

from tests.independent.drive import Floats

GRAVITY = 9.81  # m/s^2
PAN, TILT = 0, 1


class Bodies(NamedTuple):
    """Two joints, pan and tilt; a joint that does not exist is locked by the simulator.

    mass [6] in kg m^2: pan inertia as constant, cos and sin of twice the tilt angle; coupling as
    cos and sin of the tilt angle; tilt inertia. gravity [2, 9] and shake [2, 9] in N m: torque on
    each joint as coefficients of (1, cos, sin)(pan) x (1, cos, sin)(tilt). The torque of a shaking
    base is shake times sin(2 pi shake_frequency t + shake_phase).
    """

    mass: Floats
    gravity: Floats
    shake: Floats
    shake_frequency: float = 1.0
    shake_phase: float = 0.0


def single_axis(
    joint: int,
    inertia: float,
    gravity: tuple[float, float],
    shake: tuple[float, float] = (0.0, 0.0),
    shake_frequency: float = 1.0,
    shake_phase: float = 0.0,
) -> Bodies:
    """One joint alone: `gravity` and `shake` are the torques in N m with cosine and with sine."""
    mass = np.zeros(6)
    mass[[0, 5]] = 1.0
    mass[5 if joint == TILT else 0] = inertia
    torques = np.zeros((2, 2, 9))
    places = (1, 2) if joint == TILT else (3, 6)
    for table, pair in zip(torques, (gravity, shake), strict=True):
        table[joint, list(places)] = pair
    return Bodies(mass, torques[0], torques[1], shake_frequency, shake_phase)


@numba.njit(cache=True)
def products(pan: float, tilt: float, out: Floats) -> None:
    """Products (1, cos, sin)(pan) x (1, cos, sin)(tilt) into `out` [9]."""
    cos_pan, sin_pan = math.cos(pan), math.sin(pan)
    cos_tilt, sin_tilt = math.cos(tilt), math.sin(tilt)
    out[0], out[1], out[2] = 1.0, cos_tilt, sin_tilt
    out[3], out[4], out[5] = cos_pan, cos_pan * cos_tilt, cos_pan * sin_tilt
    out[6], out[7], out[8] = sin_pan, sin_pan * cos_tilt, sin_pan * sin_tilt


@numba.njit(cache=True)
def mass_matrix(mass: Floats, wave: Floats) -> tuple[float, float, float]:
    """Pan inertia, coupling and tilt inertia, from the coefficients and `products`."""
    cos_tilt, sin_tilt = wave[1], wave[2]
    double_cos, double_sin = cos_tilt * cos_tilt - sin_tilt * sin_tilt, 2.0 * cos_tilt * sin_tilt
    pan = mass[0] + mass[1] * double_cos + mass[2] * double_sin
    return pan, mass[3] * cos_tilt + mass[4] * sin_tilt, mass[5]


@numba.njit(cache=True)
def rate_torque(
    mass: Floats, wave: Floats, pan_rate: float, tilt_rate: float
) -> tuple[float, float]:
    """Torques that Coriolis and centrifugal forces take from pan and tilt."""
    cos_tilt, sin_tilt = wave[1], wave[2]
    double_cos, double_sin = cos_tilt * cos_tilt - sin_tilt * sin_tilt, 2.0 * cos_tilt * sin_tilt
    pan_slope = 2.0 * (mass[2] * double_cos - mass[1] * double_sin)
    coupling_slope = mass[4] * cos_tilt - mass[3] * sin_tilt
    on_pan = pan_slope * pan_rate * tilt_rate + coupling_slope * tilt_rate * tilt_rate
    return on_pan, -0.5 * pan_slope * pan_rate * pan_rate


@numba.njit(cache=True)
def table_torque(table: Floats, joint: int, wave: Floats) -> float:
    """Torque on a joint from a table of coefficients."""
    total = 0.0
    for k in range(9):
        total += table[joint, k] * wave[k]
    return total
