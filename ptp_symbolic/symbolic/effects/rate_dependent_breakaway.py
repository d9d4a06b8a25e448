"""Breakaway torque that grows with the time at rest, so that slow torque ramps break away late."""

import sympy as sp

from ptp_symbolic.symbolic.effects.effect import Change, Contribution, Effect, Place, State
from ptp_symbolic.symbolic.parameters import Parameter

PARAMETERS = (
    Parameter(
        "a_rest_{axis}",
        "1",
        0.0,
        0.0,
        10.0,
        "relative growth of breakaway per e-fold of rest",
        vanishes=0.0,
        starts=(0.1,),
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


def _parameters(place: Place) -> tuple[Parameter, ...]:
    return tuple(p.at_axis(place.axis) for p in PARAMETERS)


def _contribute(place: Place) -> Contribution:
    gain, time = (place.parameter(p.name) for p in PARAMETERS)
    rest = sp.Symbol(f"rest_time_{place.axis}", real=True)
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
    reference="Rabinowicz (1958), logarithm of the dwell time; thesis section 5.4 (slow ramp)",
    parameters=_parameters,
    contribute=_contribute,
    needs=("breakaway_torque_{axis}",),
    separating_experiment="Ramp the torque from rest at several rates and after several pauses:"
    " a fixed breakaway torque gives the same peak each time.",
)
