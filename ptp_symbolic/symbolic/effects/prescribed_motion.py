"""A joint that is locked or driven along a profile, whatever torque that takes.

The acceleration becomes the input of the axis (zero: locked, or turning steadily); the other joint
moves freely. Dry friction of the axis only adds to the torque that the motion takes, and is left
out. Assumed: no motor and no shaft on the axis.
"""

from ptp_symbolic.symbolic.effect_interface.contribution import Contribution, Input
from ptp_symbolic.symbolic.effect_interface.effect import Effect
from ptp_symbolic.symbolic.effect_interface.place import Place


def _contribute(place: Place) -> Contribution:
    axis = place.own_axis
    given = Input(f"alpha_{axis}", "rad/s^2", f"acceleration of the {axis} joint")
    return Contribution(prescribed={place.rate: given})


PRESCRIBED_MOTION = Effect(
    id="prescribed_motion",
    title="prescribed motion of the joint",
    reference="rheonomic constraint; Goldstein, Poole and Safko (2002), section 1.3",
    parameters=(),
    contribute=_contribute,
    structural=True,
)
