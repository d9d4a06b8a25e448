"""Maxwell-slip friction: springs side by side that each slip at a torque of their own.

Below breakaway the machine moves against the springs; what it gives back on the way home depends on
which of them have slipped (presliding hysteresis with nonlocal memory).
"""

from ptp_symbolic.platform import SITES
from ptp_symbolic.symbolic.effect_interface.contribution import Contribution, State, Switch
from ptp_symbolic.symbolic.effect_interface.effect import Effect, Structure
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effect_interface.place import Place, active
from ptp_symbolic.symbolic.symbols import ZERO

ELEMENTS = (1, 2, 3)
STIFFNESSES = tuple(
    Parameter(f"k_slip{k}_{{axis}}", "N m/rad", value, 1e-6, 1e9, f"stiffness of slip element {k}")
    for k, value in zip(ELEMENTS, (2000.0, 500.0, 100.0), strict=True)
)
TORQUES = tuple(
    Parameter(f"F_slip{k}_{{axis}}", "N m", 0.1, 1e-9, 1e4, f"torque at which element {k} slips")
    for k in ELEMENTS
)


def _contribute(place: Place) -> Contribution:
    torque, stored = ZERO, ZERO
    states, switches = [], []
    pairs = zip(ELEMENTS, place.symbols(STIFFNESSES), place.symbols(TORQUES), strict=True)
    for k, stiffness, limit in pairs:
        name = f"slip{k}_{place.axis}"
        slipping = active(name)
        meaning = f"deflection of slip element {k} of {place.axis}"
        state = State(f"z_{name}", "rad", meaning, (1 - slipping) * place.friction_rate)
        torque -= stiffness * state.symbol
        stored += stiffness * state.symbol**2 / 2
        states.append(state)
        switches.append(Switch(name, state.symbol, limit / stiffness, place.friction_rate))
    return Contribution(
        torques={place.friction_rate: torque},
        stored=stored,
        states=tuple(states),
        switches=tuple(switches),
    )


MAXWELL_SLIP_FRICTION = Effect(
    id="maxwell_slip_friction",
    title="Maxwell-slip friction",
    reference="Lampaert, Al-Bender and Swevers (2003), Eq. 9-12; Iwan (1966)",
    parameters=(*STIFFNESSES, *TORQUES),
    contribute=_contribute,
    structural=True,
    dissipative=True,
    sites=SITES,
    structure=Structure(in_place_of=("csvs_friction",), along_with=("viscous_friction",)),
    separating_experiment="Swing below breakaway in loops within loops: each inner loop closes, and"
    " the outer one goes on as if it had not been.",
)
