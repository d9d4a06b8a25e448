"""Friction that differs by direction: relative half differences, added for positive rate."""

from ptp_symbolic.symbolic.effect_interface.contribution import Change, Contribution
from ptp_symbolic.symbolic.effect_interface.effect import Effect, Member
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effect_interface.place import Place

CHANGED = {
    "a_F_c_{axis}": "coulomb_torque_{axis}",
    "a_F_s_{axis}": "static_torque_{axis}",
    "a_v_s_{axis}": "stribeck_speed_{axis}",
    "a_F_v_{axis}": "viscous_coefficient_{axis}",
}
PARAMETERS = tuple(
    Parameter(name, "1", 0.0, -0.95, 0.95, f"relative half difference of {meaning}", 0.0, starts)
    for name, meaning, starts in (
        ("a_F_c_{axis}", "Coulomb friction", (-0.1, 0.1)),
        ("a_F_s_{axis}", "static friction", (0.0,)),
        ("a_v_s_{axis}", "Stribeck speed", (0.0,)),
        ("a_F_v_{axis}", "viscous friction", (0.0,)),
    )
)
MEMBERS = (
    Member("Coulomb friction", ("a_F_c_{axis}",)),
    Member("viscous friction", ("a_F_v_{axis}",)),
    Member("Coulomb and static friction", ("a_F_c_{axis}", "a_F_s_{axis}")),
    Member("Coulomb and viscous friction", ("a_F_c_{axis}", "a_F_v_{axis}")),
    Member(
        "Coulomb, static and viscous friction", ("a_F_c_{axis}", "a_F_s_{axis}", "a_F_v_{axis}")
    ),
    Member("all of dry and viscous friction", tuple(CHANGED)),
)


def _contribute(place: Place) -> Contribution:
    return Contribution(
        changes={
            changed.format(axis=place.axis): Change(factor=1 + place.slide * place.parameter(name))
            for name, changed in CHANGED.items()
        }
    )


DIRECTION_DEPENDENT_FRICTION = Effect(
    id="direction_dependent_friction",
    title="friction that differs by direction",
    reference="thesis Tables 4.1 and 4.2 (omega > 0, omega < 0)",
    parameters=PARAMETERS,
    contribute=_contribute,
    needs=("coulomb_torque_{axis}",),
    members=MEMBERS,
    separating_experiment="Run the same speeds both ways at two supply polarities, or back-drive"
    " the joint without power: friction follows the motion, an offset does not.",
)
