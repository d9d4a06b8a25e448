"""Stops at both ends of what a joint may turn: they push back, and never pull.

Beyond the angle of a stop a torque grows with the depth, more so while the joint goes deeper; the
damping grows from nothing at contact, so that the torque is continuous. One stop is met from below,
the other from above; where a stop is never met, its angle only says so.
"""

import sympy as sp

from ptp_symbolic.symbolic.effect_interface.conditions import Requirement
from ptp_symbolic.symbolic.effect_interface.contribution import Contribution
from ptp_symbolic.symbolic.effect_interface.effect import Effect, Member
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effect_interface.place import Place
from ptp_symbolic.symbolic.symbols import ZERO

FAR = 1e4  # rad
UPPER, LOWER = (
    Parameter(
        f"theta_stop_{name}_{{axis}}",
        "rad",
        far,
        -FAR,
        FAR,
        f"angle at which the {name} stop of the {{axis}} is met",
        vanishes=far,
        starts=(start,),
    )
    for name, far, start in (("upper", FAR, 0.5), ("lower", -FAR, 0.0))
)
OF_DAMPING = "damping of the {axis} stops: share of the spring's torque per rate"
STIFFNESS = (1e3, 1e-3, 1e9, "stiffness of the {axis} stops")
SHAPE = (
    Parameter("k_stop_{axis}", "N m/rad", *STIFFNESS, starts=(100.0, 3000.0)),
    Parameter("c_stop_{axis}", "s/rad", 0.3, 0.0, 1e3, OF_DAMPING, starts=(0.3,)),
)
PARAMETERS = (UPPER, LOWER, *SHAPE)


def _contribute(place: Place) -> Contribution:
    upper, lower, stiffness, damping = place.symbols(PARAMETERS)
    energy = torque = ZERO
    for sign, depth in ((1, place.angle - upper), (-1, lower - place.angle)):
        spring, met = stiffness * depth, depth > 0
        lost = spring * sp.Max(sign * damping * place.rate, -1)
        energy += sp.Piecewise((spring * depth / 2, met), (ZERO, True))
        torque -= sign * sp.Piecewise((lost, met), (ZERO, True))
    return Contribution(potential=energy, torques={place.rate: torque})


def _requires(place: Place) -> tuple[Requirement, ...]:
    upper, lower = place.symbols((UPPER, LOWER))
    return (Requirement(lower <= upper, "the lower stop lies below the upper; change one angle"),)


SHAPES = tuple(p.name for p in SHAPE)
END_STOP = Effect(
    id="end_stop",
    title="stops at the ends of what the joint may turn",
    reference="Hunt and Crossley (1975), Eq. 3 with a linear spring",
    parameters=PARAMETERS,
    contribute=_contribute,
    requires=_requires,
    dissipative=True,
    members=(
        Member("upper stop", (UPPER.name, *SHAPES)),
        Member("lower stop", (LOWER.name, *SHAPES)),
        Member("both stops", (UPPER.name, LOWER.name, *SHAPES)),
    ),
    separating_experiment="Turn the unpowered joint to its ends by hand, and read the angles.",
)
