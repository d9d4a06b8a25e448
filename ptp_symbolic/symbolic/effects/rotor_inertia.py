"""The inertia of a motor and its gear on an axis whose torque is the input.

Rigid, it adds to that of the axis; before a shaft or a gap the torque acts on it, not on the joint.
"""

from ptp_symbolic.symbolic.effect_interface.contribution import Contribution
from ptp_symbolic.symbolic.effect_interface.effect import Effect
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effect_interface.place import Place

INERTIA = Parameter(
    "J_rotor_{axis}",
    "kg m^2",
    0.05,
    1e-9,
    1e6,
    "inertia of the {axis} motor and gear, seen at the joint",
)


def _contribute(place: Place) -> Contribution:
    return Contribution(inertias={place.gear_rate: place.parameter(INERTIA.name)})


ROTOR_INERTIA = Effect(
    id="rotor_inertia",
    title="inertia of motor and gear",
    reference="Spong (1987), Eq. 8: a flexible joint between rotor and link",
    parameters=(INERTIA,),
    contribute=_contribute,
    structural=True,
    needs=("command_torque_{axis}",),
)
