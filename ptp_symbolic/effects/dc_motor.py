"""A geared permanent-magnet DC motor, driven by a voltage."""

import sympy as sp

from ptp_symbolic.effects.effect import Contribution, Drive, Effect, Input, Place, State
from ptp_symbolic.parameters import Parameter

PARAMETERS = (
    Parameter("L_{axis}", "H", 6.9e-3, 1e-9, 1e3, "winding inductance"),
    Parameter("R_{axis}", "ohm", 12.9, 1e-6, 1e6, "winding resistance"),
    Parameter("K_t_{axis}", "N m/A", 0.0724, 1e-9, 1e4, "torque constant"),
    Parameter("J_motor_{axis}", "kg m^2", 1.1e-5, 0.0, 1e3, "rotor inertia"),
    Parameter("N_{axis}", "1", 500.0, 1e-3, 1e6, "gear ratio"),
)


def _parameters(place: Place) -> tuple[Parameter, ...]:
    return tuple(p.at_axis(place.axis) for p in PARAMETERS)


def _contribute(place: Place) -> Contribution:
    inductance, _, constant, rotor, ratio = (place.parameter(p.name) for p in PARAMETERS)
    resistance = place.quantity("winding_resistance_{axis}")
    voltage = place.quantity("motor_voltage_{axis}")
    current = sp.Symbol(f"i_{place.axis}", real=True)
    applied = sp.Symbol(f"u_{place.axis}", real=True)
    back_emf = constant * ratio * place.gear_rate
    derivative = (voltage - resistance * current - back_emf) / inductance
    return Contribution(
        quantities={
            f"winding_resistance_{place.axis}": place.parameter("R_{axis}"),
            f"motor_voltage_{place.axis}": applied,
        },
        drives=(
            Drive(
                axis=place.own_axis,
                inertia=rotor * ratio**2,
                torque=ratio * constant * current,
                inputs=(Input(str(applied), "V", f"voltage of the {place.axis} motor"),),
                power_in=voltage * current,
                stored=inductance * current**2 / 2,
                dissipated=resistance * current**2,
            ),
        ),
        states=(State(str(current), "A", f"current of the {place.axis} motor", derivative),),
    )


DC_MOTOR = Effect(
    id="dc_motor",
    title="geared DC motor",
    reference="thesis Eq. 3.10, Eq. 3.11 with erratum 8",
    parameters=_parameters,
    contribute=_contribute,
    structural=True,
)
