"""Breakaway torque that grows with the time at rest, so that slow torque ramps break away late."""

import sympy as sp

from ptp_symbolic.symbolic.effect_interface.contribution import Change, Contribution, State
from ptp_symbolic.symbolic.effect_interface.effect import Effect
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effect_interface.place import Place
from ptp_symbolic.symbolic.symbols import real

PARAMETERS = (
    Parameter(
        "a_rest_{axis}",
        "1",
        0.0,
        0.0,
        10.0,
        "relative growth of breakaway per e-fold of rest",
        vanishes=0.0,
        starts=(0.4,),
    ),
    Parameter(
        "t_rest_{axis}",
        "s",
        1.0,
        1e-4,
        1e4,
        "time at rest after which breakaway grows",
        starts=(0.1, 2.0),
    ),
)


def _contribute(place: Place) -> Contribution:
    gain, time = place.symbols(PARAMETERS)
    rest = real(f"rest_time_{place.axis}")
    return Contribution(
        changes={f"breakaway_torque_{place.axis}": Change(1 + gain * sp.log(1 + rest / time))},
        states=(
            State(
                str(rest),
                "s",
                f"rest of the {place.axis} friction; while sliding, its last one",
                1 - place.slide**2,
                zero_at_rest_of=place.axis,
            ),
        ),
    )


RATE_DEPENDENT_BREAKAWAY = Effect(
    id="rate_dependent_breakaway",
    title="breakaway torque that grows with the time at rest",
    reference="Rabinowicz (1958), logarithm of the dwell time; thesis section 5.4.2 (slow ramp)",
    parameters=PARAMETERS,
    contribute=_contribute,
    needs=("breakaway_torque_{axis}",),
    separating_experiment="Ramp the torque from rest at several rates and after several pauses:"
    " a fixed breakaway torque gives the same peak each time.",
)
