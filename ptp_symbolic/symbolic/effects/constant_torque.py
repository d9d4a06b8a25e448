"""A constant torque on a joint: mean wind, a counterweight, a pulling cable.

Its work goes with the angle alone: the ledger books it as stored.
"""

from ptp_symbolic.symbolic.effect_interface.contribution import Contribution
from ptp_symbolic.symbolic.effect_interface.effect import Effect
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effect_interface.place import Place

TORQUE = Parameter(
    "tau0_{axis}",
    "N m",
    0.0,
    -1e4,
    1e4,
    "constant torque on the {axis} joint",
    vanishes=0.0,
    starts=(-0.3, 0.3),
)


def _contribute(place: Place) -> Contribution:
    return Contribution(potential=-place.parameter(TORQUE.name) * place.angle)


CONSTANT_TORQUE = Effect(
    id="constant_torque",
    title="constant torque on the joint",
    reference="mean of wind, or a preload: beside the efforts e_1, e_2 of thesis Eq. 3.8",
    parameters=(TORQUE,),
    contribute=_contribute,
    separating_experiment="Drive the same speeds in both directions with the motor leads swapped:"
    " a torque on the joint keeps its sign, an electrical offset turns with the leads.",
)
