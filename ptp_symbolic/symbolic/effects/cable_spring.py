"""A cable wrap that pulls back: a hardening spring with a rest angle."""

from ptp_symbolic.symbolic.effect_interface.contribution import Contribution
from ptp_symbolic.symbolic.effect_interface.effect import Effect, Member
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effect_interface.place import Place

PARAMETERS = (
    Parameter(
        "k1_cable_{axis}",
        "N m/rad",
        0.0,
        0.0,
        1e4,
        "linear stiffness of the cable wrap",
        vanishes=0.0,
        starts=(0.3,),
        linear={"upper": 1e8},
    ),
    Parameter(
        "k3_cable_{axis}",
        "N m/rad^3",
        0.0,
        0.0,
        1e4,
        "cubic stiffness of the cable wrap",
        vanishes=0.0,
        starts=(0.1,),
        linear={"upper": 1e10},
    ),
    Parameter(
        "theta0_cable_{axis}",
        "rad",
        0.0,
        -7.0,
        7.0,
        "angle at which the cable wrap is at rest",
        starts=(-0.5, 0.5),
    ),
)
LINEAR, CUBIC, REST = (p.name for p in PARAMETERS)
MEMBERS = (
    Member("linear spring", (LINEAR, REST)),
    Member("spring with linear and cubic part", (LINEAR, CUBIC, REST)),
)


def _contribute(place: Place) -> Contribution:
    linear, cubic, rest = place.symbols(PARAMETERS)
    twist = place.angle - rest
    return Contribution(potential=linear * twist**2 / 2 + cubic * twist**4 / 4)


CABLE_SPRING = Effect(
    id="cable_spring",
    title="cable wrap that pulls back",
    reference="Duffing (1918): spring with linear and cubic part",
    parameters=PARAMETERS,
    contribute=_contribute,
    members=MEMBERS,
    linear={"separating_experiment": "Unplug or unwind the cable and repeat."},
    separating_experiment="Unplug or unwind the cable and repeat; or sweep beyond +-180 deg, where"
    " what turns with the angle comes back and a spring does not.",
)
