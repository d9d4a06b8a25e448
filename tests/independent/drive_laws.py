"""Torques and voltages of a drive's record, jitted; the two simulators share them.

`drive` is a record of `drive.RECORD`. Angles in rad, rates in rad/s, torques in N m at the gear
output. Dry friction is a level (Coulomb, Stribeck and all that changes them) with the sign of the
motion; its value at rest is the breakaway torque.
"""

import math
from typing import Any

import numba

from tests.independent.drive import Floats


@numba.njit(cache=True)
def harmonics(rows: Floats, angle: float) -> float:
    """Sum of sine and cosine parts over the rows (sine, cosine, harmonic)."""
    total = 0.0
    for k in range(rows.shape[0]):
        if rows[k, 0] != 0.0 or rows[k, 1] != 0.0:
            turned = rows[k, 2] * angle
            total += rows[k, 0] * math.sin(turned) + rows[k, 1] * math.cos(turned)
    return total


@numba.njit(cache=True)
def harmonics_slope(rows: Floats, angle: float) -> float:
    """Derivative of `harmonics` by the angle."""
    total = 0.0
    for k in range(rows.shape[0]):
        if rows[k, 0] != 0.0 or rows[k, 1] != 0.0:
            count = rows[k, 2]
            turned = count * angle
            total += count * (rows[k, 0] * math.cos(turned) - rows[k, 1] * math.sin(turned))
    return total


@numba.njit(cache=True)
def cogging_torque(drive: Any, gear_angle: float) -> float:
    """Torque of the motor's poles on the gear output."""
    total = 0.0
    for k in range(drive.cogging.shape[0]):
        amplitude = drive.cogging[k, 0]
        if amplitude != 0.0:
            total += amplitude * math.sin(drive.cogging[k, 1] * gear_angle + drive.cogging[k, 2])
    return total


@numba.njit(cache=True)
def dry_friction(drive: Any, level: float, gear_angle: float, load: float) -> float:
    """Dry friction that is at `level` on an even gear without load: its share by the angle, and
    what the transmitted torque `load` adds.
    """
    share = 1.0 + harmonics(drive.friction_by_angle, gear_angle)
    if drive.friction_ripple != 0.0:
        turned = drive.ripple_count * gear_angle - drive.ripple_phase
        share += 0.5 * drive.friction_ripple * (1.0 - math.cos(turned))
    return level * max(0.0, share) + drive.friction_by_load * abs(load)


@numba.njit(cache=True)
def _decay(drive: Any, t: float) -> float:
    if drive.friction_decay == 0.0:
        return 1.0
    return 1.0 + drive.friction_decay * math.exp(-t / drive.decay_time)


@numba.njit(cache=True)
def viscous(drive: Any, coefficient: float, rate: float) -> float:
    """Viscous torque; with an exponent below one it is curved, and the same at 1 rad/s."""
    if drive.viscous_exponent == 1.0 or rate == 0.0:
        return coefficient * rate
    return coefficient * rate * abs(rate) ** (drive.viscous_exponent - 1.0)


@numba.njit(cache=True)
def sliding_friction(
    drive: Any, t: float, rate: float, slip: int, gear_angle: float, load: float
) -> float:
    """CSVS friction while sliding towards `slip`; smooth in the rate, also past zero."""
    coulomb, static = drive.F_c_forward, drive.F_s_forward
    stribeck, coefficient = drive.v_s_forward, drive.F_v_forward
    if slip < 0:
        coulomb, static = drive.F_c_backward, drive.F_s_backward
        stribeck, coefficient = drive.v_s_backward, drive.F_v_backward
    ratio = abs(rate / stribeck)
    if drive.stribeck_exponent == 2.0:
        drop = math.exp(-ratio * ratio)
    else:
        drop = math.exp(-(ratio**drive.stribeck_exponent))
    level = dry_friction(drive, coulomb + (static - coulomb) * drop, gear_angle, load)
    return slip * level * _decay(drive, t) + viscous(drive, coefficient, rate)


@numba.njit(cache=True)
def breakaway(
    drive: Any, t: float, side: int, rest: float, gear_angle: float, load: float
) -> float:
    """Torque that starts motion towards `side` after `rest` seconds at rest."""
    static = drive.F_s_forward if side > 0 else drive.F_s_backward
    growth = 1.0 + drive.dwell_gain * math.log(1.0 + rest / drive.dwell_time)
    return dry_friction(drive, static * growth, gear_angle, load) * _decay(drive, t)


@numba.njit(cache=True)
def bristle_friction(drive: Any, rate: float, bend: float) -> tuple[float, float]:
    """LuGre friction in N m without its viscous part, and the slope of the bend in rad/s."""
    coulomb, static, stribeck = drive.F_c_forward, drive.F_s_forward, drive.v_s_forward
    if rate < 0.0:
        coulomb, static, stribeck = drive.F_c_backward, drive.F_s_backward, drive.v_s_backward
    ratio = rate / stribeck
    level = coulomb + (static - coulomb) * math.exp(-ratio * ratio)
    bending = rate - drive.bristle_stiffness * abs(rate) / level * bend
    return drive.bristle_stiffness * bend + drive.bristle_damping * bending, bending


@numba.njit(cache=True)
def loss_torque(drive: Any, transmitted: float, wound: float) -> float:
    """Torque lost in proportion to the one transmitted; `wound` is its state between -1 and 1."""
    loss = drive.loss_mean * abs(transmitted) * wound
    return loss + drive.loss_difference * transmitted * wound * wound


@numba.njit(cache=True)
def loss_slope(drive: Any, rate: float, wound: float) -> float:
    """Slope of the state of the loss in 1/s."""
    return (rate - abs(rate) * wound) / drive.loss_angle


@numba.njit(cache=True)
def shaft_contact(drive: Any, twist: float, rate: float) -> int:
    """Flank on which a shaft presses: 1, -1, or 0 in the gap and where it would have to pull; 2
    without a gap, where it pulls as it pushes.
    """
    if drive.gap == 0.0:
        return 2
    side = 1 if twist > 0.0 else -1
    depth = side * twist - 0.5 * drive.gap
    presses = drive.k_shaft * depth + drive.d_shaft * side * rate > 0.0
    return side if depth > 0.0 and presses else 0


@numba.njit(cache=True)
def shaft_torque(drive: Any, twist: float, rate: float, contact: int) -> float:
    """Torque in N m of a shaft on the load in a contact."""
    if contact == 0:
        return 0.0
    rest = 0.0 if contact == 2 else 0.5 * contact * drive.gap
    return drive.k_shaft * (twist - rest) + drive.d_shaft * rate


@numba.njit(cache=True)
def stop_torque(drive: Any, angle: float, rate: float) -> float:
    """Torque in N m of the end stops, after Hunt and Crossley; they never pull."""
    if angle > drive.stop_upper:
        depth = angle - drive.stop_upper
        return -max(0.0, drive.stop_stiffness * depth * (1.0 + drive.stop_damping * rate))
    if angle < drive.stop_lower:
        depth = drive.stop_lower - angle
        return max(0.0, drive.stop_stiffness * depth * (1.0 - drive.stop_damping * rate))
    return 0.0


@numba.njit(cache=True)
def joint_torque(drive: Any, t: float, angle: float, rate: float, wrap: float) -> float:
    """Torque on the joint from all that hangs on it, but for friction of the drive."""
    stretch = angle - drive.theta0_cable
    torque = drive.constant_torque - viscous(drive, drive.b_load, rate)
    torque -= drive.k1_cable * stretch + drive.k3_cable * stretch**3
    torque -= drive.wrap_torque * wrap
    torque -= drive.quadratic_drag * rate * abs(rate)
    torque -= drive.torque_by_angle_and_rate * angle * rate
    if drive.viscous_by_angle != 0.0:
        torque -= drive.viscous_by_angle * rate * math.sin(2.0 * angle)
    if drive.gravity_torque != 0.0:
        torque -= drive.gravity_torque * math.sin(angle - drive.alpha_base)
    if drive.shake_torque != 0.0:
        shake = 2.0 * math.pi * drive.shake_frequency * t + drive.shake_phase
        torque += drive.shake_torque * math.sin(shake)
    if drive.base_shake_sine != 0.0 or drive.base_shake_cosine != 0.0:
        lever = drive.base_shake_sine * math.sin(angle) + drive.base_shake_cosine * math.cos(angle)
        shake = 2.0 * math.pi * drive.base_shake_frequency * t + drive.base_shake_phase
        torque += lever * math.sin(shake)
    if drive.stop_stiffness != 0.0:
        torque += stop_torque(drive, angle, rate)
    return torque


@numba.njit(cache=True)
def wrap_slope(drive: Any, rate: float, wrap: float) -> float:
    """Bouc and Wen's hysteresis with n = 1: the relative pull `wrap` stays within -1 and 1."""
    return (rate - 0.5 * (abs(rate) * wrap + rate * abs(wrap))) / drive.wrap_angle


@numba.njit(cache=True)
def motor_voltage(drive: Any, u: float) -> float:
    """Voltage in V at the winding for a commanded `u`: dead band, offset, then the rails."""
    width = drive.voltage_deadband
    u = max(u - width, 0.0) + min(u + width, 0.0) + drive.voltage_offset
    return min(drive.voltage_limit, max(-drive.voltage_limit, u))


@numba.njit(cache=True)
def winding(drive: Any, u: float, rate: float, current: float, heat: float) -> tuple[float, float]:
    """Slopes of the current in A/s and of the relative heating in 1/s under a commanded `u` in V.

    `rate` is the motor's speed referred to the gear output.
    """
    drop = drive.R * (1.0 + heat) * current
    slope = (motor_voltage(drive, u) - drop - drive.K_t * drive.N * rate) / drive.L
    return slope, (drive.heating_gain * drop * current - heat) / drive.heating_time
