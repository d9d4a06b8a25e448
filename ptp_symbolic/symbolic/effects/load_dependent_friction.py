"""Dry friction that grows with the torque that the gear carries.

That is the torque of the shaft. An axis without one takes the torque of its drive at the gear
output, what accelerates the rotor included, or else its torque input.
"""

import sympy as sp

from ptp_symbolic.symbolic.effect_interface.contribution import Change, Contribution
from ptp_symbolic.symbolic.effect_interface.effect import Effect
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effect_interface.place import Place

PARAMETERS = (
    Parameter(
        "mu_load_{axis}",
        "1",
        0.0,
        0.0,
        0.9,
        "dry friction per torque transmitted to the joint",
        vanishes=0.0,
        starts=(0.05,),
    ),
)


def _contribute(place: Place) -> Contribution:
    carried = sp.Abs(place.quantity("transmitted_torque_{axis}"))
    added = Change(addition=place.parameter("mu_load_{axis}") * carried)
    return Contribution(
        changes={f"{word}_torque_{place.axis}": added for word in ("coulomb", "static")}
    )


LOAD_DEPENDENT_FRICTION = Effect(
    id="load_dependent_friction",
    title="friction that grows with the load",
    reference="Dohring, Lee and Newman (1993): load-dependent transmission friction",
    parameters=PARAMETERS,
    contribute=_contribute,
    needs=("coulomb_torque_{axis}", "static_torque_{axis}"),
    separating_experiment="Repeat with a known weight on a known arm, lifted and lowered at the"
    " same speeds.",
)
