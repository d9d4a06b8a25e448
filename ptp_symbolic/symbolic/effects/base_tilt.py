"""A base that is not level, so that gravity reaches the pan axis.

It acts on every mass off the axes: a payload, a tilt body ahead of the pan axis, a pan body whose
centre of mass is off its axis.
"""

import math

from ptp_symbolic.symbolic.effect_interface.contribution import Change, Contribution
from ptp_symbolic.symbolic.effect_interface.effect import Effect
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effect_interface.place import Place

TILT = Parameter(
    "beta_base",
    "rad",
    0.0,
    0.0,
    1.5,
    "angle between the pan axis and the vertical",
    vanishes=0.0,
    starts=(0.05,),
)
AZIMUTH = Parameter(
    "alpha_base",
    "rad",
    0.0,
    -7.0,
    7.0,
    "pan angle at which a mass ahead of the pan axis would rest",
    starts=(-math.pi / 2, 0.0, math.pi / 2, math.pi),
    period=2 * math.pi,
)


def _contribute(place: Place) -> Contribution:
    return Contribution(
        changes={
            "gravity_tilt": Change(addition=place.parameter("beta_base")),
            "gravity_azimuth": Change(addition=place.parameter("alpha_base")),
        }
    )


BASE_TILT = Effect(
    id="base_tilt",
    title="base that is not level",
    reference="gravity as a force on every body, thesis section 2.2.1, turned by two angles",
    parameters=(TILT, AZIMUTH),
    contribute=_contribute,
    on_axis=False,
    needs=("off_axis_mass",),
    separating_experiment="Sweep the pan axis over a full turn (a spring keeps growing, gravity"
    " comes back), or level the base with shims and repeat.",
    instead_on_linear="gravity along it is a constant force: declare constant_torque",
)
