"""A drive that does not react to small commands."""

import sympy as sp

from ptp_symbolic.symbolic.effect_interface.contribution import Change, Contribution
from ptp_symbolic.symbolic.effect_interface.effect import Effect
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effect_interface.place import Place

PARAMETERS = (
    Parameter(
        "u_dead_{axis}",
        "V",
        0.0,
        0.0,
        1e3,
        "half width of the {axis} drive's dead band",
        vanishes=0.0,
        starts=(0.3,),
    ),
)


def _contribute(place: Place) -> Contribution:
    width = place.parameter("u_dead_{axis}")

    def through(voltage: sp.Expr) -> sp.Expr:
        return sp.Max(voltage - width, 0) + sp.Min(voltage + width, 0)

    return Contribution(changes={f"motor_voltage_{place.axis}": Change(through=through)})


DRIVE_DEADBAND = Effect(
    id="drive_deadband",
    title="dead band of the drive",
    reference="dead zone of the power stage (blanking time of a bridge), Mohan (2003), section 8",
    parameters=PARAMETERS,
    contribute=_contribute,
    needs=("motor_voltage_{axis}",),
    separating_experiment="Read the voltage at the motor terminals against small commands.",
)
