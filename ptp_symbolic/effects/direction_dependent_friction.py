"""Friction that differs by direction: half differences added for positive, taken for negative rate."""

from ptp_symbolic.effects.effect import Change, Contribution, Effect, Place
from ptp_symbolic.parameters import Parameter

CHANGED = {
    "dF_c_{axis}": "coulomb_torque_{axis}",
    "dF_s_{axis}": "static_torque_{axis}",
    "dv_s_{axis}": "stribeck_speed_{axis}",
    "dF_v_{axis}": "viscous_coefficient_{axis}",
}
PARAMETERS = tuple(
    Parameter(name, unit, 0.0, -1e3, 1e3, f"half difference of {meaning}", 0.0, starts)
    for name, unit, meaning, starts in (
        ("dF_c_{axis}", "N m", "Coulomb friction", (-0.03, 0.03)),
        ("dF_s_{axis}", "N m", "static friction", (0.0,)),
        ("dv_s_{axis}", "rad/s", "Stribeck speed", (0.0,)),
        ("dF_v_{axis}", "N m s/rad", "viscous friction", (0.0,)),
    )
)


def _parameters(place: Place) -> tuple[Parameter, ...]:
    return tuple(p.at_axis(place.axis) for p in PARAMETERS)


def _contribute(place: Place) -> Contribution:
    return Contribution(
        changes={
            changed.format(axis=place.axis): Change(addition=place.slide * place.parameter(name))
            for name, changed in CHANGED.items()
        }
    )


DIRECTION_DEPENDENT_FRICTION = Effect(
    id="direction_dependent_friction",
    title="friction that differs by direction",
    reference="thesis Tables 4.1 and 4.2 (omega > 0, omega < 0)",
    parameters=_parameters,
    contribute=_contribute,
    needs=("coulomb_torque_{axis}",),
    separating_experiment="Run the same speeds both ways at two supply polarities, or back-drive"
    " the joint without power: friction follows the motion, an offset does not.",
)
