"""A flexible shaft between the gear output and the load."""

from ptp_symbolic.symbolic.effects.effect import Contribution, Effect, Place, Shaft
from ptp_symbolic.symbolic.parameters import Parameter

PARAMETERS = (
    Parameter("k_shaft_{axis}", "N m/rad", 5000.0, 1e-3, 1e9, "shaft stiffness"),
    Parameter("d_shaft_{axis}", "N m s/rad", 1.0, 0.0, 1e6, "shaft damping"),
)


def _parameters(place: Place) -> tuple[Parameter, ...]:
    return tuple(p.at_axis(place.axis) for p in PARAMETERS)


def _contribute(place: Place) -> Contribution:
    stiffness, damping = (place.parameter(p.name) for p in PARAMETERS)
    return Contribution(
        quantities={f"half_gap_{place.axis}": 0 * stiffness},
        shafts=(Shaft(place.own_axis, stiffness, damping),),
    )


SHAFT_COMPLIANCE = Effect(
    id="shaft_compliance",
    title="flexible shaft",
    reference="thesis Eq. 2.15 with erratum 4, Table 5.7",
    parameters=_parameters,
    contribute=_contribute,
    structural=True,
    splits_axis=True,
    dissipative=True,
)
