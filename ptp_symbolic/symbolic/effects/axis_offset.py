"""Axes that do not cross: the tilt axis lies ahead of the pan axis, and its body has a mass.

The height of the tilt axis does not matter on a level base, and a shift along it is one of what it
carries.
"""

from ptp_symbolic.symbolic.effect_interface.contribution import Change, Contribution
from ptp_symbolic.symbolic.effect_interface.effect import Effect
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effect_interface.place import Place

PARAMETERS = (
    Parameter(
        "a_tilt",
        "m",
        0.0,
        -10.0,
        10.0,
        "tilt axis ahead of the pan axis, along x",
        vanishes=0.0,
        starts=(0.05,),
    ),
    Parameter("m_tilt", "kg", 1.0, 0.0, 1e5, "mass of the tilt body, on its axis"),
)


def _contribute(place: Place) -> Contribution:
    offset, mass = place.symbols(PARAMETERS)
    return Contribution(
        changes={
            "tilt_axis_offset": Change(addition=offset),
            "tilt_body_mass": Change(addition=mass),
        }
    )


AXIS_OFFSET = Effect(
    id="axis_offset",
    title="tilt axis off the pan axis",
    reference="Craig (2005), section 3.4: link length a between two joint axes",
    parameters=PARAMETERS,
    contribute=_contribute,
    on_axis=False,
    declared_only=True,
    needs=("tilt_axis_offset",),
    separating_experiment="Weigh the tilt body, and measure how far its axis is from the pan axis.",
    instead_on_linear="it has no tilt axis",
)
