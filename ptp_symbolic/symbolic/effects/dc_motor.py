"""A geared permanent-magnet DC motor, driven by a voltage."""

import sympy as sp

from ptp_symbolic.symbolic.effect_interface.contribution import (
    Contribution,
    Drive,
    Input,
    Sensor,
    State,
)
from ptp_symbolic.symbolic.effect_interface.effect import Effect
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effect_interface.place import Place
from ptp_symbolic.symbolic.symbols import ZERO, real

WINDING, LOSS = "winding_resistance_{axis}", "winding_loss_{axis}"
VOLTAGES = tuple(  # each from the next
    f"{of}_{{axis}}" for of in ("motor_voltage", "amplifier_voltage", "drive_voltage", "command")
)


def motor_parameters(values: tuple[float, float, float, float]) -> tuple[Parameter, ...]:
    """Parameters of a winding and a rotor; `values` are their defaults, in this order."""
    inductance, resistance, constant, rotor = values
    return (
        Parameter("L_{axis}", "H", inductance, 1e-9, 1e3, "winding inductance"),
        Parameter("R_{axis}", "ohm", resistance, 1e-6, 1e6, "winding resistance"),
        Parameter("K_t_{axis}", "N m/A", constant, 1e-9, 1e4, "torque constant", turns=True),
        Parameter("J_motor_{axis}", "kg m^2", rotor, 1e-12, 1e3, "rotor inertia", turns=True),
    )


MOTOR = motor_parameters((6.9e-3, 12.9, 0.0724, 1.1e-5))
SPINDLE = {"unit": "rad/m", "meaning": "motor angle per travel, 2 pi over the lead if direct"}
RATIO = Parameter("N_{axis}", "1", 500.0, 1e-3, 1e6, "gear ratio", linear=SPINDLE)
PARAMETERS = (*MOTOR, RATIO)


def electric_drive(place: Place, ratio: sp.Expr, damping: sp.Expr = ZERO) -> Contribution:
    """Voltage-driven motor that turns `ratio` times as fast as the gear output of `place`, or by
    `motor_lead_<axis>` faster where the gear between does not run true.

    `damping` in N m s/rad acts on the rotor. The parameters of the motor are those of `dc_motor`.
    """
    ratio = ratio * place.quantity("motor_lead_{axis}")
    inductance, resistance, constant, rotor = place.symbols(MOTOR)
    current, applied = real(f"i_{place.axis}"), real(f"u_{place.axis}")
    winding, loss = map(place.quantity, (WINDING, LOSS))
    voltage, amplified, switched, command = map(place.quantity, VOLTAGES)
    inputs = (Input(str(applied), "V", f"voltage of the {place.axis} motor"),)
    electrical = {"current": current, "voltage": voltage, "inductance": inductance}
    electrical |= {"resistance": winding, "loss": loss, "constant": constant}
    turning = {"rate": place.gear_rate, "ratio": ratio, "rotor": rotor, "damping": damping}
    drive = Drive(axis=place.own_axis, inputs=inputs, **electrical, **turning)
    names = (WINDING, LOSS, *VOLTAGES)
    values = (resistance, winding * current**2, amplified, switched, command, applied)
    defined = {n.format(axis=place.axis): v for n, v in zip(names, values, strict=True)}
    state = State(str(current), "A", f"current of the {place.axis} motor", drive.current_slope)
    rate = Sensor(
        f"omega_motor_{place.axis}", "rad/s", f"rate of the {place.axis} motor", drive.speed
    )
    return Contribution(quantities=defined, drives=(drive,), states=(state,), sensors=(rate,))


def _contribute(place: Place) -> Contribution:
    return electric_drive(place, place.parameter(RATIO.name))


DC_MOTOR = Effect(
    id="dc_motor",
    title="geared DC motor",
    reference="thesis Eq. 3.10, Eq. 3.11 with erratum 8",
    parameters=PARAMETERS,
    contribute=_contribute,
    structural=True,
)
