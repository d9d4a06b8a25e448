"""Errata of the equations of motion and of the gears: symbolic identities."""

from functools import cache

import numpy as np
import pint
import sympy as sp

from ptp_symbolic.platform import read_platform
from ptp_symbolic.symbolic.derivation.assembly import assemble
from ptp_symbolic.symbolic.derivation.newton_euler import newton_euler
from ptp_symbolic.symbolic.derivation.trigonometry import normal_form
from ptp_symbolic.symbolic.mechanics import kinematics
from ptp_symbolic.symbolic.symbols import real
from ptp_symbolic.thesis import configurations, printed, rigid
from ptp_symbolic.thesis.items import Item, erratum, plain
from ptp_symbolic.thesis.motion import along
from ptp_symbolic.thesis.tilt_drive import deviation


def euler_sign() -> Item:
    """Erratum 5: the sign before J_zt in Eq. 3.7, from Newton-Euler."""
    equations = newton_euler(assemble(read_platform("thesis-ideal")).rigid)
    factor = normal_form(equations.forcing[1].diff(real("J_z_tilt")))
    theta, rate = kinematics.angle("tilt"), kinematics.rate("pan")
    settled = normal_form(factor + sp.cos(theta) * sp.sin(theta) * rate**2) == 0
    return erratum(
        5,
        "Eq. 3.7, sign before J_zt",
        "- +",
        "-",
        "",
        settled,
        f"derivative by J_zt of the tilt forcing derived by Newton-Euler: {plain(factor)}",
    )


def damping_names() -> Item:
    """Erratum 6: the coefficients that the equations hold are b_p and b_t."""
    forcing = assemble(read_platform("thesis-ideal")).forcing
    found = [
        plain(-sp.expand(force).coeff(kinematics.rate(axis), 1).subs(kinematics.rate(other), 0))
        for force, axis, other in zip(forcing, ("pan", "tilt"), ("tilt", "pan"), strict=True)
    ]
    return erratum(
        6,
        "text under Eq. 3.3, damping coefficients",
        "b_7, b_18",
        ", ".join(found),
        "",
        found == ["b_pan", "b_tilt"],
        "damping of each axis in the derived equations; 7 and 18 number the bonds",
    )


@cache
def _euler_rates() -> tuple[sp.Matrix, sp.Matrix]:
    """Euler rates (theta', psi', phi') of z-y-x angles from body rates, and the matrix behind."""
    psi, theta, phi = sp.symbols("psi theta phi", real=True)
    rates = sp.symbols("psi_rate theta_rate phi_rate", real=True)
    about_x = sp.Matrix([[1, 0, 0], [0, sp.cos(phi), -sp.sin(phi)], [0, sp.sin(phi), sp.cos(phi)]])
    about_y = sp.Matrix(kinematics.joint_rotation("tilt")).subs(kinematics.angle("tilt"), theta)
    about_z = sp.Matrix(kinematics.joint_rotation("pan")).subs(kinematics.angle("pan"), psi)
    rotation = about_z * about_y * about_x
    turning = zip((psi, theta, phi), rates, strict=True)
    spin = rotation.T * sum((rotation.diff(a) * w for a, w in turning), sp.zeros(3, 3))
    body = sp.Matrix([spin[2, 1], spin[0, 2], spin[1, 0]]).applyfunc(sp.trigsimp)
    matrix = body.jacobian(rates)
    solved = matrix.LUsolve(sp.Matrix(sp.symbols("omega_x omega_y omega_z", real=True)))
    return sp.Matrix([solved[1], solved[0], solved[2]]), matrix


def euler_rate_names() -> Item:
    """Erratum 7: which Euler rate each line of Eq. 3.9 gives."""
    theta, phi, x, y, z = sp.symbols("theta phi omega_x omega_y omega_z", real=True)
    cos, sin = sp.cos(phi), sp.sin(phi)
    lines = [
        cos * y - sin * z,
        (sin * y + cos * z) / sp.cos(theta),
        x + (sin * y + cos * z) * sp.tan(theta),
    ]
    derived, _ = _euler_rates()
    left = [sp.simplify(a - b) for a, b in zip(derived, lines, strict=True)]
    return erratum(
        7,
        "Eq. 3.9, left sides",
        "theta, psi', psi'",
        "theta', psi', phi'",
        "",
        left == [0, 0, 0],
        f"inverted kinematics of the rotations z, y, x minus the three right sides:"
        f" {', '.join(map(str, left))}",
    )


def euler_singularity() -> Item:
    """Erratum 30: the Euler rates of Eq. 3.9 on the motion of Table 5.2."""
    _, matrix = _euler_rates()
    determinant = sp.simplify(matrix.det())
    theta = real("theta")
    singular = determinant.subs(theta, sp.pi / 2) == 0
    times = np.linspace(0.0, 2.0, 200_001)
    angle = along(times, printed.IDEAL_MOTION["tilt"]).angle
    crossing = float(times[np.argmax(angle >= np.pi / 2.0)])
    return erratum(
        30,
        "Eq. 3.9, Euler rates",
        "used without a limit",
        f"singular at {crossing:.3f} s",
        "",
        bool(singular and 0.0 < crossing < 2.0),
        f"determinant of the rate matrix: {plain(determinant)}; the tilt angle of Table 5.2"
        " passes 90 deg at this time",
    )


def gear_torques() -> Item:
    """Erratum 8: Eq. 3.11 against Lagrange's equations of motor and load behind a shaft."""
    J_m, J_l, k, N, F_f, drive = sp.symbols("J_m J_l k_s N F_f T_m", positive=True)
    motor, load, motor_rate, load_rate = sp.symbols("theta_m theta_l w_m w_l", real=True)
    kinetic = (J_m * motor_rate**2 + J_l * load_rate**2) / 2
    potential = k * (motor / N - load) ** 2 / 2
    # virtual power of drive and friction: the friction acts on the gear output, w_m / N
    power = drive * motor_rate - F_f * motor_rate / N
    needed = power.diff(motor_rate) - potential.diff(motor)
    inertia = kinetic.diff(motor_rate, 2)
    shaft = k * (motor / N - load)
    right = sp.expand(needed - (drive - (F_f + shaft) / N)) == 0 and inertia == J_m
    spring = sp.expand(k * (motor - N * load) / N**2 - shaft / N) == 0
    friction = sp.simplify(F_f / N**2 - F_f / N) != 0
    return erratum(
        8,
        "Eq. 3.11, reflected torques",
        "(F_f + J_l theta_m'' + k_s (theta_m - N theta_l)) / N^2",
        "(F_f + T_s) / N, J_l on the load side alone",
        "N m",
        bool(right and spring and friction),
        "Lagrange's equations with the friction at the gear output: the printed spring term is"
        " T_s / N, the printed friction is not F_f / N, and the motor side holds no J_l",
    )


def actuator_force() -> Item:
    """Erratum 9: the actuator force must be the power conjugate of the stroke speed."""
    torque, speed, r, theta = sp.symbols("tau v_a r theta", real=True)
    rate = -speed / (r * sp.cos(theta))
    remainders = [
        sp.simplify(force * speed - torque * rate)
        for force in (-torque / (r * sp.cos(theta)), -torque * sp.cos(theta) / r)
    ]
    missing = [float(np.sin(deviation("40.5", stroke)) ** 2) for stroke in (None, 0.0)]
    return erratum(
        9,
        "section 3.2.3.2, actuator force",
        "-tau cos(theta) / r",
        "-tau / (r cos(theta))",
        "N",
        remainders[0] == 0 and remainders[1] != 0,
        "F_a v_a - tau omega = 0 for the corrected force; the printed one misses by"
        f" {100 * missing[0]:.1f} % at stroke 40.5 mm and {100 * missing[1]:.0f} % at stroke 0",
    )


def symmetric_row() -> Item:
    """Erratum 11: the completely symmetric, balanced configuration."""
    row = next(i for i in configurations.table_2_2() if "completely" in i.id)
    return erratum(
        11,
        "Table 2.2, completely symmetric and balanced",
        row.printed,
        row.computed,
        "",
        row.computed == "linear; un-coupled",
        row.check,
    )


def coupling_rows() -> Item:
    """Erratum 27: products of inertia couple at any speed, gravity does not couple."""
    equations = configurations.configuration(configurations.ASYMMETRIC, configurations.BALANCED)
    left = normal_form(equations.mass_matrix[0, 1])
    theta = kinematics.angle("tilt")
    wanted = -configurations.J_XY * sp.sin(theta) + configurations.J_YZ * sp.cos(theta)
    general = configurations.configuration(configurations.ASYMMETRIC, configurations.OFFSET)
    axes = configurations.gravity_axes(general)
    return erratum(
        27,
        "Table 2.2, asymmetric and balanced",
        "coupled at higher speeds; by gravity",
        "coupled at any speed; by inertia",
        "",
        normal_form(left - wanted) == 0 and axes == "tilt",
        f"M_pt = {plain(left)} without any rate; gravity enters the {axes} axis alone",
    )


def friction_unit() -> Item:
    """Erratum 17: the dimension of a viscous coefficient at a joint."""
    registry: pint.UnitRegistry = pint.UnitRegistry()
    as_printed = registry("kilogram * meter / (radian / second)").dimensionality
    torque_per_rate = registry("newton * meter / (radian / second)").dimensionality
    settled = as_printed != torque_per_rate
    return erratum(
        17,
        "Table 5.1, unit of the joint friction",
        "kg m/(rad/s)",
        "N m s/rad",
        "",
        settled,
        f"dimensions: printed {plain(as_printed)}, torque per rate {plain(torque_per_rate)}",
    )


def payload_offset() -> Item:
    """Erratum 18: which offset gives the torques that section 5.2 reports."""
    found = {i.id: i for i in rigid.payload_items()}
    right = [found["fig_5_4.pan_at_0.1_m"], found["fig_5_5.tilt_at_0.1_m"]]
    wrong = [found["fig_5_4.pan_at_0.01_m"], found["fig_5_5.tilt_at_0.01_m"]]
    offsets = rigid.reported_offsets()
    # one digit, like the printed value
    offset = float(f"{np.mean(offsets):.1g}")
    return erratum(
        18,
        "Table 5.3, offset of the payload",
        printed.PAYLOAD_OFFSET,
        offset,
        "m",
        all(i.agrees for i in right) and not any(i.agrees for i in wrong) and offset == 0.1,
        f"offsets that give the reported torques: {offsets[0]:.4f} m (pan), {offsets[1]:.4f} m"
        " (tilt);"
        " inverse dynamics along Table 5.4, pan and tilt in N m:"
        f" {right[0].computed:.3g} and {right[1].computed:.3g} at 0.1 m,"
        f" {wrong[0].computed:.2g} and {wrong[1].computed:.2g} at 0.01 m",
    )
