"""Lubricant that thins with the rate: viscous friction that levels off."""

import sympy as sp

from ptp_symbolic.symbolic.effect_interface.contribution import Contribution
from ptp_symbolic.symbolic.effect_interface.effect import Effect
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effect_interface.place import Place

PARAMETERS = (
    Parameter(
        "F_t_{axis}",
        "N m",
        0.0,
        0.0,
        1e4,
        "torque at which the thinning part of viscous friction levels off",
        vanishes=0.0,
        starts=(0.1,),
    ),
    Parameter(
        "v_t_{axis}",
        "rad/s",
        0.05,
        1e-4,
        1e3,
        "rate at which the lubricant is half as viscous",
        starts=(0.01, 0.1),
    ),
)


def _contribute(place: Place) -> Contribution:
    torque, thinning = place.symbols(PARAMETERS)
    return Contribution(
        torques={place.rate: -torque * place.rate / (thinning + sp.Abs(place.rate))}
    )


SHEAR_THINNING_FRICTION = Effect(
    id="shear_thinning_friction",
    title="viscous friction that levels off as the lubricant thins",
    reference="Cross, J. Colloid Sci. 20 (1965) 417, Eq. 5 with exponent 1: viscosity over rate",
    parameters=PARAMETERS,
    contribute=_contribute,
    dissipative=True,
    separating_experiment="Run at six or more steady rates, from a tenth of the rate at which"
    " friction levels off to the largest; repeat warm.",
)
