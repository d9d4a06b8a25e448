"""A harmonic drive: a shaft that stiffens with its twist, and gives back less than it took.

It has no backlash, its teeth being preloaded.
"""

from ptp_symbolic.symbolic.effect_interface.contribution import Contribution, Shaft, State, Switch
from ptp_symbolic.symbolic.effect_interface.effect import Effect, Structure
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effect_interface.place import Place, active

PARAMETERS = (
    Parameter(
        "k1_drive_{axis}",
        "N m/rad",
        5000.0,
        1e-3,
        1e9,
        "stiffness at no twist",
        starts=(100.0, 3000.0),
    ),
    Parameter("k3_drive_{axis}", "N m/rad^3", 1e7, 0.0, 1e15, "torque per cube of the twist"),
    Parameter("d_drive_{axis}", "N m s/rad", 1.0, 0.0, 1e6, "damping of the twist"),
    Parameter("k_hyst_{axis}", "N m/rad", 2000.0, 1e-6, 1e9, "stiffness of what slips inside"),
    Parameter("T_hyst_{axis}", "N m", 0.5, 1e-9, 1e4, "torque at which that slips"),
)


def _contribute(place: Place) -> Contribution:
    linear, cubic, damping, stiffness, limit = place.symbols(PARAMETERS)
    twist, name = place.twist, f"hyst_{place.axis}"
    rate = (1 - active(name)) * place.twist_rate
    inside = State(f"z_{name}", "rad", f"deflection of what slips in the {place.axis} drive", rate)
    return Contribution(
        shafts=(
            Shaft(
                place.own_axis,
                energy=linear * twist**2 / 2 + cubic * twist**4 / 4,
                losses=damping * place.twist_rate + stiffness * inside.symbol,
            ),
        ),
        stored=stiffness * inside.symbol**2 / 2,
        states=(inside,),
        switches=(Switch(name, inside.symbol, limit / stiffness, place.twist_rate),),
    )


HARMONIC_DRIVE = Effect(
    id="harmonic_drive",
    title="harmonic drive",
    reference="Tuttle and Seering (1996), Eq. 4 (cubic stiffness); Dhaouadi, Ghorbel and Gandhi"
    " (2003): hysteresis as stiffness and slip side by side",
    parameters=PARAMETERS,
    contribute=_contribute,
    structural=True,
    splits_axis=True,
    dissipative=True,
    structure=Structure(
        along_with=("rotor_inertia",), excluded_by=("shaft_compliance", "backlash")
    ),
    separating_experiment="Lock the motor and load the joint in slow loops of several sizes: the"
    " twist stiffens, and every loop leaves an area.",
    instead_on_linear="it turns on both sides: declare shaft_compliance",
)
