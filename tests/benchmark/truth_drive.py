"""From parameters in the project's names to the record of a drive, and the torque that they make.

Beside the project's parameters there are names of the truth alone, such as wrap_torque_pan; a
number before the axis counts further harmonics (T_sin_2_pan, f_sin_3_pan).
"""

from collections.abc import Mapping
from typing import Any

import numba
import numpy as np

from tests.independent.drive import NO_LIMIT, Drive, Floats, Rows, rows
from tests.independent.drive_laws import (
    cogging_torque,
    joint_torque,
    sliding_friction,
)

Values = Mapping[str, float]
GRAVITY = 9.81  # m/s^2

# Field of the record and name of the parameter, where the value passes unchanged.
_SAME = {
    "L": "L",
    "R": "R",
    "K_t": "K_t",
    "J_motor": "J_motor",
    "N": "N",
    "k_shaft": "k_shaft",
    "d_shaft": "d_shaft",
    "gap": "gap",
    "b_load": "b",
    "k1_cable": "k1_cable",
    "k3_cable": "k3_cable",
    "theta0_cable": "theta0_cable",
    "constant_torque": "tau0",
    "voltage_offset": "u0",
    "dwell_gain": "a_rest",
    "dwell_time": "t_rest",
    "heating_gain": "k_heat",
    "heating_time": "t_heat",
    "friction_by_load": "mu_load",
    "quadratic_drag": "c_drag",
    "voltage_deadband": "u_dead",
    "delay": "t_delay",
    "stribeck_exponent": "stribeck_exponent",
    "viscous_exponent": "viscous_exponent",
    "friction_decay": "friction_decay",
    "decay_time": "decay_time",
    "viscous_by_angle": "viscous_by_angle",
    "torque_by_angle_and_rate": "torque_by_angle_and_rate",
    "wrap_torque": "wrap_torque",
    "wrap_angle": "wrap_angle",
    "contact_softness": "contact_softness",
    "actuator_lag": "t_actuator",
    "measurement_lag": "t_lag",
    "restitution": "e_gap",
    "bristle_stiffness": "sigma0",
    "bristle_damping": "sigma1",
    "stop_stiffness": "k_stop",
    "stop_damping": "c_stop",
    "loss_mean": "mu_avg",
    "loss_difference": "mu_dif",
    "loss_angle": "h_loss",
}
_LIMITS = {
    "voltage_limit": ("u_max", NO_LIMIT),
    "torque_limit": ("tau_max", NO_LIMIT),
    "stop_upper": ("theta_stop_upper", NO_LIMIT),
    "stop_lower": ("theta_stop_lower", -NO_LIMIT),
}
_MAY_BE_ABSENT_AS = {"dwell_time": 1.0, "heating_time": 1.0, "stribeck_exponent": 2.0}
_MAY_BE_ABSENT_AS |= {
    "viscous_exponent": 1.0,
    "decay_time": 1.0,
    "wrap_angle": 1.0,
    "loss_angle": 1.0,
}


def _numbered(name: str, number: int, axis: str) -> str:
    """Name of the parameter of a harmonic: the first has no number."""
    return f"{name}_{axis}" if number == 1 else f"{name}_{number}_{axis}"


def _harmonics(values: Values, sine: str, cosine: str, axis: str, count: int) -> Rows:
    """Rows (sine, cosine, harmonic) of the first `count` harmonics."""
    given = [
        (
            values.get(_numbered(sine, k, axis), 0.0),
            values.get(_numbered(cosine, k, axis), 0.0),
            float(k),
        )
        for k in range(1, count + 1)
    ]
    return rows(count, *given)


def _cogging(values: Values, axis: str) -> Rows:
    """Rows (amplitude, cycles per turn, phase) of up to three cogging torques."""
    given = []
    for k in (1, 2, 3):
        parts = (values.get(_numbered(name, k, axis), 0.0) for name in ("T_sin", "T_cos"))
        sine, cosine = parts
        cycles = values.get(_numbered("n_cog", k, axis), 1.0)
        given.append((float(np.hypot(sine, cosine)), cycles, float(np.arctan2(cosine, sine))))
    return rows(3, *given)


def payload_lever_torque(values: Values) -> float:
    """Mass times lever of the payload, kg m."""
    return values.get("m_payload", 0.0) * values.get("c_x_payload", 0.0)


def _friction_without(values: Values, name: str, axis: str) -> float:
    """A friction parameter that is not given: static friction is Coulomb's then."""
    return {"F_s": values.get(f"F_c_{axis}", 0.0), "v_s": 0.01}.get(name, 0.0)


def drive_of(values: Values, axis: str) -> Drive:
    """The record of the drive on `axis`, without bodies and gravity."""
    fields: dict[str, Any] = {
        field: float(values.get(f"{name}_{axis}", _MAY_BE_ABSENT_AS.get(field, 0.0)))
        for field, name in _SAME.items()
    }
    for name in ("F_c", "F_s", "v_s", "F_v"):
        level = values.get(f"{name}_{axis}", _friction_without(values, name, axis))
        asymmetry = values.get(f"a_{name}_{axis}", 0.0)
        fields[f"{name}_forward"] = level * (1.0 + asymmetry)
        fields[f"{name}_backward"] = level * (1.0 - asymmetry)
    for field, (name, without) in _LIMITS.items():
        fields[field] = float(values.get(f"{name}_{axis}", without))
    return Drive(
        **fields,
        cogging=_cogging(values, axis),
        friction_by_angle=_harmonics(values, "f_sin", "f_cos", axis, 3),
        transmission=_harmonics(values, "g_sin", "g_cos", axis, 2),
        encoder=_harmonics(values, "e_sin", "e_cos", axis, 2),
    )


def reading(values: Values, axis: str, angle: Floats) -> Floats:
    """Angles [n] in rad as an encoder off its centre reads them, not yet rounded."""
    read = angle.copy()
    for sine, cosine, harmonic in drive_of(values, axis).encoder:
        if sine or cosine:
            read += sine * np.sin(harmonic * angle) + cosine * np.cos(harmonic * angle)
    return read


@numba.njit(cache=True)
def torque_along(drive: Any, time: Floats, motion: Floats) -> Floats:
    """Torque [n] in N m along a motion from all but motor, shaft, gravity and inertia.

    motion [n, 6]: joint angle and rate, gear angle and rate, transmitted torque, relative pull of a
    hysteretic cable. A gear at rest has no dry friction here, as the law leaves that open.
    """
    torque = np.empty(len(time))
    for k in range(len(time)):
        angle, rate, gear_angle, gear_rate, load, wrap = motion[k]
        torque[k] = joint_torque(drive, time[k], angle, rate, wrap)
        torque[k] += cogging_torque(drive, gear_angle)
        if gear_rate != 0.0:
            slip = 1 if gear_rate > 0.0 else -1
            torque[k] -= sliding_friction(drive, time[k], gear_rate, slip, gear_angle, load)
    return torque
