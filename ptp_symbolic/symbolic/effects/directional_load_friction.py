"""Dry friction that grows with the torque of the motor and with that of the load, each on its own.

A gear loses more where its load drives it than where its motor does. The torque of the motor is
that of the drive at the gear output, what accelerates the rotor included (of the shaft for a joint
behind one, else the torque input); that of the load is of all else that acts on the same
coordinate, gravity first, without what accelerates it. Both count towards a growing angle, so that
equal factors take their difference.
"""

import sympy as sp

from ptp_symbolic.symbolic.effect_interface.contribution import Change, Contribution
from ptp_symbolic.symbolic.effect_interface.effect import Effect
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effect_interface.place import Place

PARAMETERS = tuple(
    Parameter(f"{name}_{{axis}}", unit, 0.0, 0.0, largest, meaning, 0.0, (start,))
    for name, unit, largest, start, meaning in (
        ("mu_motor", "1", 0.9, 0.05, "dry friction per torque of the motor"),
        ("mu_outer", "1", 0.9, 0.05, "dry friction per torque of the load"),
        ("mu_motor_rest", "1", 5.0, 0.05, "what rest adds per torque of the motor"),
        ("mu_outer_rest", "1", 5.0, 0.05, "what rest adds per torque of the load"),
        (
            "q_motor_rest",
            "1/(N m)",
            1e3,
            0.0,
            "what rest adds per squared torque of the motor, where the load drives",
        ),
        (
            "q_outer_rest",
            "1/(N m)",
            1e3,
            0.0,
            "what rest adds per squared torque of the load, where the motor drives",
        ),
    )
)


def _contribute(place: Place) -> Contribution:
    motor, load, _ = place.loads
    by_motor, by_load, motor_rest, load_rest, motor_square, load_square = place.symbols(PARAMETERS)
    sliding = sp.Abs(by_motor * motor - by_load * load)
    resting = sp.Abs(motor_rest * motor - load_rest * load)
    against = (1 - sp.sign(motor * load)) / 2
    motor_leads = (1 + sp.sign(motor**2 - load**2)) / 2
    squares = load_square * load**2 * motor_leads + motor_square * motor**2 * (1 - motor_leads)
    added = {"coulomb": sliding, "static": sliding + resting + against * squares}
    return Contribution(
        changes={
            f"{word}_torque_{place.axis}": Change(addition=torque) for word, torque in added.items()
        }
    )


DIRECTIONAL_LOAD_FRICTION = Effect(
    id="directional_load_friction",
    title="friction that grows with the torques of motor and load",
    reference="Duclusaud, Passault, Padois and Ly (2025), models M3 to M6 with Stribeck exponent 2",
    parameters=PARAMETERS,
    contribute=_contribute,
    declared_only=True,
    needs=("coulomb_torque_{axis}", "static_torque_{axis}"),
    separating_experiment="Lift and lower a known weight at the same slow speeds, driven by the"
    " motor and, the motor weaker, by the weight.",
)
