"""Erratum of the shaft: the sign of its damping in Eq. 2.15."""

import numpy as np
import sympy as sp

from ptp_symbolic.thesis.friction import drive_values
from ptp_symbolic.thesis.items import Item, erratum, plain
from ptp_symbolic.thesis.responses import pan_drive

INPUT_RATE, OUTPUT_RATE, DAMPING = sp.symbols("omega_1 omega_2 c", real=True)
# The damping term as Eq. 2.15 prints it.
PRINTED_DAMPING = DAMPING * (OUTPUT_RATE - INPUT_RATE)


def derived_damping() -> sp.Expr:
    """Damping term of Eq. 2.15 in N m: c times the time derivative of the printed twist."""
    t = sp.Symbol("t", real=True)
    first, second, third = (sp.Function(f"theta_{k}")(t) for k in (1, 2, 3))
    # theta_s = theta_d - theta_b, theta_d = theta_1 - theta_3, theta_b = theta_2 - theta_3
    twist = (first - third) - (second - third)
    rates = {first.diff(t): INPUT_RATE, second.diff(t): OUTPUT_RATE}
    return sp.factor(DAMPING * twist.diff(t).subs(rates))


def emitted_damping() -> float:
    """Torque on the load in N m per rad/s of the gear output, from the emitted pan drive.

    The faces touch and the gear output slides; the load is at rest.
    """
    model = pan_drive()
    p, modes = model.parameter_vector(), np.ones(len(model.mode_names))
    load, gear = (model.state_names.index(f"omega_{end}pan") for end in ("", "gear_"))

    def load_acceleration(gear_rate: float) -> float:
        x, slope = np.zeros(len(model.state_names)), np.zeros(len(model.state_names))
        x[gear] = gear_rate
        model.module.mode_derivative(0.0, x, np.zeros(len(model.input_names)), p, modes, slope)
        return float(slope[load])

    return drive_values()["J_pan"] * (load_acceleration(1.0) - load_acceleration(0.0))


def growth(damping: sp.Expr) -> float:
    """Growth rate in 1/s of the free oscillation of motor against load, Table 5.7.

    `damping` is the damping term of the torque from motor to load; negative: the motion decays.
    """
    p = drive_values()
    values = {DAMPING: p["d_shaft_pan"]}
    per_rate = [float(damping.diff(rate).subs(values)) for rate in (INPUT_RATE, OUTPUT_RATE)]
    per_state = np.array([p["k_shaft_pan"], -p["k_shaft_pan"], *per_rate])
    inertias = p["J_motor_pan"] * p["N_pan"] ** 2, p["J_pan"]
    matrix = np.zeros((4, 4))
    matrix[:2, 2:] = np.eye(2)
    matrix[2], matrix[3] = -per_state / inertias[0], per_state / inertias[1]
    return float(max(np.linalg.eigvals(matrix), key=lambda value: value.imag).real)


def shaft_damping() -> Item:
    """Erratum 4: differentiating the twist of Eq. 2.15 gives the other sign."""
    derived = derived_damping()
    twist_rate = INPUT_RATE - OUTPUT_RATE
    power = [sp.factor(term * twist_rate) for term in (PRINTED_DAMPING, derived)]
    rates = growth(PRINTED_DAMPING), growth(derived)
    constant, emitted = drive_values()["d_shaft_pan"], emitted_damping()
    agrees = abs(emitted - float(derived.diff(INPUT_RATE).subs({DAMPING: constant}))) < 1e-9
    return erratum(
        4,
        "Eq. 2.15, damping term",
        plain(PRINTED_DAMPING),
        plain(derived),
        "N m",
        sp.expand(derived + PRINTED_DAMPING) == 0 and rates[0] > 0.0 > rates[1] and agrees,
        "time derivative of the printed twist theta_s = theta_d - theta_b; power taken by the"
        f" printed term {plain(power[0])}, by the derived one {plain(power[1])}; motor and load of"
        f" Table 5.7 swing against each other with a growth rate of {rates[0]:.1f} 1/s as printed"
        f" and {rates[1]:.1f} 1/s as derived; the emitted pan drive transmits {emitted:g} N m s/rad"
        f" times omega_1 - omega_2 for c = {constant:g}",
    )
