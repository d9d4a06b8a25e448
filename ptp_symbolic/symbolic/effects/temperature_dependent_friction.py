"""Friction that falls as its lubricant warms, with a measured temperature as input.

The input is the temperature above the one at which the parameters of the friction hold; at zero the
friction is theirs. Dry and viscous friction each fall exponentially: viscosity does so in all oils,
Coulomb and static friction little, and with either sign.
"""

import sympy as sp

from ptp_symbolic.symbolic.effect_interface.contribution import Change, Contribution, Input
from ptp_symbolic.symbolic.effect_interface.effect import Effect
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effect_interface.place import Place

PARAMETERS = (
    Parameter(
        "k_T_dry_{axis}",
        "1/K",
        0.0,
        -0.2,
        0.2,
        "share by which dry friction falls per kelvin",
        vanishes=0.0,
    ),
    Parameter(
        "k_T_viscous_{axis}",
        "1/K",
        0.0,
        -0.2,
        0.2,
        "share by which viscous friction falls per kelvin",
        vanishes=0.0,
    ),
)
QUANTITIES = (
    ("coulomb_torque_{axis}", 0),
    ("static_torque_{axis}", 0),
    ("viscous_coefficient_{axis}", 1),
)


def _contribute(place: Place) -> Contribution:
    warmer = Input(
        f"temperature_{place.axis}", "K", f"temperature of the {place.axis} friction above its own"
    )
    left = [sp.exp(-fall * warmer.symbol) for fall in place.symbols(PARAMETERS)]
    return Contribution(
        changes={name.format(axis=place.axis): Change(factor=left[k]) for name, k in QUANTITIES},
        inputs=(warmer,),
    )


TEMPERATURE_DEPENDENT_FRICTION = Effect(
    id="temperature_dependent_friction",
    title="friction that falls with temperature",
    reference="Bittencourt and Gunnarsson (2012), section 4: temperature of a robot joint",
    parameters=PARAMETERS,
    contribute=_contribute,
    needs=tuple(name for name, _ in QUANTITIES),
    declared_only=True,
    separating_experiment="Repeat the same run cold and after an hour of motion, the housing's"
    " temperature logged beside.",
)
