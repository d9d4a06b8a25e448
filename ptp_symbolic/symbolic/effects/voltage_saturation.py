"""A drive whose voltage ends at its supply."""

import sympy as sp

from ptp_symbolic.symbolic.effect_interface.contribution import Change, Contribution
from ptp_symbolic.symbolic.effect_interface.effect import Effect
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effect_interface.place import Place

PARAMETERS = (
    Parameter(
        "u_max_{axis}",
        "V",
        1e6,
        1e-3,
        1e6,
        "largest voltage of the {axis} drive",
        vanishes=1e6,
        starts=(10.0, 20.0),
    ),
)


def _contribute(place: Place) -> Contribution:
    largest = place.parameter("u_max_{axis}")

    def through(voltage: sp.Expr) -> sp.Expr:
        return sp.Max(sp.Min(voltage, largest), -largest)

    return Contribution(changes={f"motor_voltage_{place.axis}": Change(through=through)})


VOLTAGE_SATURATION = Effect(
    id="voltage_saturation",
    title="supply voltage that limits the drive",
    reference="saturation at the supply rails, thesis sections 5.3 and 5.4 (24 V)",
    parameters=PARAMETERS,
    contribute=_contribute,
    needs=("motor_voltage_{axis}",),
    separating_experiment="Read the voltage at the motor terminals at the largest command.",
)
