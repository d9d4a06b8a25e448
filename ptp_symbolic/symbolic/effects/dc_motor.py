"""A geared permanent-magnet DC motor, driven by a voltage."""

import sympy as sp

from ptp_symbolic.symbolic.effects.effect import Contribution, Drive, Effect, Input, Place, State
from ptp_symbolic.symbolic.parameters import Parameter

ZERO = sp.Integer(0)
WINDING = "winding_resistance_{axis}"
VOLTAGES = ("motor_voltage_{axis}", "drive_voltage_{axis}", "command_{axis}")  # each from the next


def motor_parameters(values: tuple[float, float, float, float]) -> tuple[Parameter, ...]:
    """Parameters of a winding and a rotor; `values` are their defaults, in this order."""
    inductance, resistance, constant, rotor = values
    return (
        Parameter("L_{axis}", "H", inductance, 1e-9, 1e3, "winding inductance"),
        Parameter("R_{axis}", "ohm", resistance, 1e-6, 1e6, "winding resistance"),
        Parameter("K_t_{axis}", "N m/A", constant, 1e-9, 1e4, "torque constant"),
        Parameter("J_motor_{axis}", "kg m^2", rotor, 1e-12, 1e3, "rotor inertia"),
    )


MOTOR = motor_parameters((6.9e-3, 12.9, 0.0724, 1.1e-5))
PARAMETERS = (*MOTOR, Parameter("N_{axis}", "1", 500.0, 1e-3, 1e6, "gear ratio"))


def electric_drive(place: Place, ratio: sp.Expr, damping: sp.Expr = ZERO) -> Contribution:
    """Voltage-driven motor that turns `ratio` times as fast as the gear output of `place`.

    `damping` in N m s/rad acts on the rotor. The parameters of the motor are those of `dc_motor`.
    """
    inductance, resistance, constant, rotor = (place.parameter(p.name) for p in MOTOR)
    current = sp.Symbol(f"i_{place.axis}", real=True)
    applied = sp.Symbol(f"u_{place.axis}", real=True)
    warm, (voltage, switched, command) = place.quantity(WINDING), map(place.quantity, VOLTAGES)
    speed = ratio * place.gear_rate
    derivative = (voltage - warm * current - constant * speed) / inductance
    drive = Drive(
        axis=place.own_axis,
        inertia=rotor * ratio**2,
        torque=ratio * (constant * current - damping * speed),
        inputs=(Input(str(applied), "V", f"voltage of the {place.axis} motor"),),
        power_in=voltage * current,
        stored=inductance * current**2 / 2,
        dissipated=warm * current**2 + damping * speed**2,
    )
    defined = {warm: resistance, voltage: switched, switched: command, command: applied}
    state = State(str(current), "A", f"current of the {place.axis} motor", derivative)
    quantities = {str(q).removeprefix("quantity:"): value for q, value in defined.items()}
    return Contribution(quantities=quantities, drives=(drive,), states=(state,))


def _contribute(place: Place) -> Contribution:
    return electric_drive(place, place.parameter("N_{axis}"))


DC_MOTOR = Effect(
    id="dc_motor",
    title="geared DC motor",
    reference="thesis Eq. 3.10, Eq. 3.11 with erratum 8",
    parameters=lambda place: place.named(PARAMETERS),
    contribute=_contribute,
    structural=True,
)
