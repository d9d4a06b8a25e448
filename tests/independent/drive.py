"""A drive with its joint and everything that can hide in it, as plain numbers.

The simulators `pan_drive` and `rigid_drives` read the same record; a machine leaves at the default
what it does not have. At the defaults every hidden effect vanishes.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Rows = tuple[tuple[float, float, float], ...]

_NO_HARMONIC = (0.0, 0.0, 1.0)
NO_LIMIT = 1e6  # V, N m or rad


class Drive(NamedTuple):
    """SI units, torques and rates at the gear output; the laws stand in `drive_laws`.

    `forward` is motion towards positive angles. Payload torque: gravity_torque = m g c sin(beta),
    towards the angle alpha_base. Dry friction goes with the angle by the factor
    1 + friction_ripple (1 - cos(n theta - phase)) / 2 + friction_by_angle. Breakaway grows by
    1 + dwell_gain ln(1 + rest / dwell_time); resistance by heat, with
    heating_time d(heat)/dt = heating_gain R i^2 - heat.
    A shaft without stiffness is rigid; its gap, if any, lies between rigid faces that an impact
    leaves with `restitution` times the speed. Bristles (LuGre) stand in for the set-valued dry
    friction where they have a stiffness. End stops press with k depth (1 + c depth_rate). A loss in
    proportion to the transmitted torque T takes mean |T| z + difference T z^2, with
    loss_angle dz/d(theta) = sign - z.
    Rows of `cogging` are (amplitude, cycles per turn, phase); rows of `friction_by_angle`,
    `transmission` and `encoder` are (sine part, cosine part, harmonic of the angle).
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
    base_shake_sine: float = 0.0  # N m, part of a shaking base's torque that goes with sin(theta)
    base_shake_cosine: float = 0.0
    base_shake_frequency: float = 1.0
    base_shake_phase: float = 0.0
    stribeck_exponent: float = 2.0
    viscous_exponent: float = 1.0
    friction_by_load: float = 0.0
    friction_decay: float = 0.0  # dry friction is 1 + friction_decay times as large at time zero
    decay_time: float = 1.0
    quadratic_drag: float = 0.0
    viscous_by_angle: float = 0.0  # N m s/rad, with sin(2 theta)
    torque_by_angle_and_rate: float = 0.0  # N m s/rad^2
    wrap_torque: float = 0.0  # N m, a hysteretic cable at its largest
    wrap_angle: float = 1.0  # rad over which the cable gives way
    contact_softness: float = 0.0  # rad, depth at which the contact has half its stiffness
    voltage_deadband: float = 0.0
    voltage_limit: float = NO_LIMIT
    delay: float = 0.0  # s, of the held input
    actuator_lag: float = 0.0  # s, of the voltage or torque behind the held input
    measurement_lag: float = 0.0  # s, of the encoder
    torque_limit: float = NO_LIMIT
    restitution: float = 0.0
    bristle_stiffness: float = 0.0
    bristle_damping: float = 0.0
    stop_upper: float = NO_LIMIT
    stop_lower: float = -NO_LIMIT
    stop_stiffness: float = 0.0
    stop_damping: float = 0.0  # s/rad
    loss_mean: float = 0.0
    loss_difference: float = 0.0
    loss_angle: float = 1.0
    cogging: Rows = (_NO_HARMONIC,) * 3
    friction_by_angle: Rows = (_NO_HARMONIC,) * 3
    transmission: Rows = (_NO_HARMONIC,) * 2
    encoder: Rows = (_NO_HARMONIC,) * 2


def _field(name: str) -> tuple:
    default = Drive._field_defaults[name]
    return (name, float, np.shape(default)) if isinstance(default, tuple) else (name, float)


RECORD = np.dtype([_field(name) for name in Drive._fields])


def rows(count: int, *given: tuple[float, float, float]) -> Rows:
    """The rows `given`, filled up to `count` with rows that vanish."""
    return (*given, *((_NO_HARMONIC,) * (count - len(given))))


def as_records(*drives: Drive) -> NDArray[np.void]:
    """The drives as a structured array [n], for jitted functions, which take it by reference."""
    records = np.zeros(len(drives), RECORD)
    for record, drive in zip(records, drives, strict=True):
        for name, value in drive._asdict().items():
            record[name] = value
    return records
