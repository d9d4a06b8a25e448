"""A flexible shaft between the gear output and the load."""

from ptp_symbolic.symbolic.effect_interface.contribution import Contribution, Shaft
from ptp_symbolic.symbolic.effect_interface.effect import Effect, Structure
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effect_interface.place import Place
from ptp_symbolic.symbolic.symbols import ZERO

PARAMETERS = (
    Parameter(
        "k_shaft_{axis}",
        "N m/rad",
        5000.0,
        1e-3,
        1e9,
        "shaft stiffness",
        starts=(100.0, 3000.0),
    ),
    Parameter("d_shaft_{axis}", "N m s/rad", 1.0, 0.0, 1e6, "shaft damping", starts=(1.0,)),
)


def _contribute(place: Place) -> Contribution:
    stiffness, damping = place.symbols(PARAMETERS)
    return Contribution(
        quantities={f"half_gap_{place.axis}": ZERO},
        shafts=(Shaft(place.own_axis, stiffness * place.twist**2 / 2, damping * place.twist_rate),),
    )


SHAFT_COMPLIANCE = Effect(
    id="shaft_compliance",
    title="flexible shaft",
    reference="thesis Eq. 2.15 with erratum 4, Table 5.7",
    parameters=PARAMETERS,
    contribute=_contribute,
    structural=True,
    splits_axis=True,
    dissipative=True,
    structure=Structure(along_with=("rotor_inertia",)),
    separating_experiment="Lock the motor and strike the joint, or excite with a 10 to 40 Hz chirp:"
    " a shaft resonates, a delay only turns the phase, and a gap rings at no fixed frequency.",
)
