"""Viscous friction in a joint."""

from ptp_symbolic.symbolic.effect_interface.contribution import Contribution
from ptp_symbolic.symbolic.effect_interface.effect import Effect
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effect_interface.place import Place

DAMPING = Parameter(
    "b_{axis}",
    "N m s/rad",
    0.1,
    0.0,
    1e4,
    "viscous friction in the {axis} joint",
    vanishes=0.0,
    starts=(0.1,),
)


def _contribute(place: Place) -> Contribution:
    return Contribution(torques={place.rate: -place.parameter("b_{axis}") * place.rate})


VISCOUS_FRICTION = Effect(
    id="viscous_friction",
    title="viscous friction in the joint",
    reference="thesis Eq. 2.8, Eq. 3.8 (b_p, b_t)",
    parameters=(DAMPING,),
    contribute=_contribute,
    dissipative=True,
    separating_experiment="Run at six or more steady speeds, the slowest near the Stribeck speed.",
)
