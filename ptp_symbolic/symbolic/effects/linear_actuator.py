"""A linear actuator: motor, gear and lead screw that turn the joint through a linkage.

The screw's friction depends on the load and that on the acceleration: both are solved for exactly.
"""

from dataclasses import replace

import sympy as sp

from ptp_symbolic.symbolic.effect_interface.conditions import Limit, Requirement
from ptp_symbolic.symbolic.effect_interface.contribution import Contribution, Friction
from ptp_symbolic.symbolic.effect_interface.effect import Effect, Step
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effect_interface.place import Place
from ptp_symbolic.symbolic.effects.dc_motor import electric_drive, motor_parameters
from ptp_symbolic.symbolic.mechanisms.linkage import Linkage
from ptp_symbolic.symbolic.mechanisms.screw import Screw, ScrewFriction
from ptp_symbolic.symbolic.symbols import real

PARAMETERS = (
    *motor_parameters((9.35e-3, 17.0, 0.044, 1.62e-6)),
    Parameter("b_motor_{axis}", "N m s/rad", 1.1696e-4, 0.0, 1e2, "viscous friction of the rotor"),
    Parameter("N_{axis}", "1", 93.0, 1e-3, 1e6, "gear ratio"),
    Parameter("lead_{axis}", "m", 4e-3, 1e-6, 1.0, "lead of the screw per turn"),
    Parameter("d_screw_{axis}", "m", 8e-3, 1e-6, 1.0, "mean diameter of the screw"),
    Parameter("f_screw_{axis}", "1", 0.15, 0.0, 10.0, "friction coefficient of the screw"),
    Parameter("l_ground_{axis}", "m", 0.19755, 1e-6, 1e2, "joint to foot of the actuator"),
    Parameter("l_min_{axis}", "m", 0.139, 1e-6, 1e2, "length of the actuator drawn in"),
    Parameter("r_arm_{axis}", "m", 0.0634133, 1e-6, 1e2, "joint to pin of the actuator"),
    Parameter("s_start_{axis}", "m", 0.0405022, 0.0, 1e2, "stroke at {axis} angle zero"),
    Parameter("s_max_{axis}", "m", 0.1, 1e-6, 1e2, "longest stroke"),
)


def _machinery(place: Place) -> tuple[Screw, Linkage, sp.Symbol]:
    own = place.symbols(PARAMETERS[6:])
    return Screw(*own[:3]), Linkage(*own[3:7]), own[7]


def _contribute(place: Place) -> Contribution:
    (screw, linkage, longest), angle, axis = _machinery(place), place.gear_angle, place.own_axis
    ratio = real(f"ratio_{axis}")
    terms, lever = linkage.ratio_terms(angle, axis)
    added = electric_drive(place, ratio, place.parameter("b_motor_{axis}"))
    lost = ScrewFriction(axis, screw, *place.loads, added.drives[0].inertia)
    dry = lost.sliding(place.slide), lost.breakaway(place.slide), lost.terms
    limits = (
        Limit(angle, *linkage.dead_centres(), f"dead centre of the {axis} linkage"),
        Limit(angle, *linkage.reach(longest), f"stroke end of the {axis} actuator"),
    )
    terms[ratio] = place.parameter("N_{axis}") * screw.turning * lever
    frictions = (Friction(axis, place.gear_rate, *dry),)
    return replace(added, terms=terms, frictions=frictions, limits=limits)


def _derived(place: Place) -> tuple[Step, ...]:
    axis, (screw, *_) = place.own_axis, _machinery(place)
    return tuple(ScrewFriction(axis, screw, *place.loads, real(f"J_drive_{axis}")).steps())


def _requires(place: Place) -> tuple[Requirement, ...]:
    screw, linkage, longest = _machinery(place)
    return (
        Requirement(linkage.opens, "the linkage closes, off its dead centres; change a length"),
        Requirement(linkage.start <= longest, "s_start is at most s_max; change one of them"),
        Requirement(screw.can_raise, "the screw wedges unless f < pi d / lead; lower f_screw"),
    )


LINEAR_ACTUATOR = Effect(
    id="linear_actuator",
    title="linear actuator with lead screw and linkage",
    reference="thesis Eq. 3.10, 3.12 and 3.2.3.2 with errata 9 and 10, Tables 5.5, 5.6",
    parameters=PARAMETERS,
    contribute=_contribute,
    derived=_derived,
    structural=True,
    requires=_requires,
    instead_on_linear="its linkage turns a joint: declare dc_motor, with N in rad/m",
)
