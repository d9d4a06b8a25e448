"""Air drag: a torque that grows with the square of the rate."""

import sympy as sp

from ptp_symbolic.symbolic.effect_interface.contribution import Contribution
from ptp_symbolic.symbolic.effect_interface.effect import Effect
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effect_interface.place import Place

PARAMETERS = (
    Parameter(
        "c_drag_{axis}",
        "N m s^2/rad^2",
        0.0,
        0.0,
        1e4,
        "quadratic drag on the {axis} joint",
        vanishes=0.0,
        starts=(0.3,),
    ),
)


def _contribute(place: Place) -> Contribution:
    torque = -place.parameter("c_drag_{axis}") * place.rate * sp.Abs(place.rate)
    return Contribution(torques={place.rate: torque})


QUADRATIC_DRAG = Effect(
    id="quadratic_drag",
    title="drag that grows with the square of the rate",
    reference="Newton (1687): resistance of the air; no wind",
    parameters=PARAMETERS,
    contribute=_contribute,
    dissipative=True,
    separating_experiment="Run at six or more steady rates up to the largest; repeat with the"
    " antenna taken off.",
)
