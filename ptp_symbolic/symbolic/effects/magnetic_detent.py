"""A magnetic detent: a well at one angle of the joint, out of reach of which it does nothing."""

import sympy as sp

from ptp_symbolic.symbolic.effect_interface.contribution import Contribution
from ptp_symbolic.symbolic.effect_interface.effect import Effect
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effect_interface.place import Place

PARAMETERS = (
    Parameter(
        "T_detent_{axis}",
        "N m",
        0.0,
        0.0,
        1e4,
        "largest torque of the detent",
        vanishes=0.0,
        starts=(0.1,),
    ),
    Parameter("theta_detent_{axis}", "rad", 0.0, -10.0, 10.0, "angle of the detent"),
    Parameter("w_detent_{axis}", "rad", 0.02, 1e-4, 3.2, "from there to where it is strongest"),
)


def _contribute(place: Place) -> Contribution:
    largest, centre, width = place.symbols(PARAMETERS)
    off = (place.angle - centre) / width
    depth = largest * width * sp.exp(sp.Rational(1, 2))
    return Contribution(potential=-depth * sp.exp(-(off**2) / 2))


MAGNETIC_DETENT = Effect(
    id="magnetic_detent",
    title="magnetic detent",
    reference="Furlani (2001), section 5: torque of a magnet over a pole, as a Gaussian well",
    parameters=PARAMETERS,
    contribute=_contribute,
    declared_only=True,
    separating_experiment="Let the axis coast slowly past the angle from both sides: it is caught"
    " or sped up there, and nowhere else.",
)
