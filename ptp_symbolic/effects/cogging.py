"""Cogging: the motor prefers certain angles."""

import sympy as sp

from ptp_symbolic.effects.effect import Contribution, Effect, Place
from ptp_symbolic.parameters import Parameter

PARAMETERS = (
    Parameter(
        "T_sin_{axis}", "N m", 0.0, -1e4, 1e4,
        "cogging torque that goes with the sine of the gear output's angle",
        vanishes=0.0, starts=(0.2,),
    ),
    Parameter(
        "T_cos_{axis}", "N m", 0.0, -1e4, 1e4, "cogging torque that goes with the cosine",
        vanishes=0.0, starts=(0.2,),
    ),
    Parameter(
        "n_cog_{axis}", "1", 60.0, 0.5, 1e5, "cogging cycles per turn of the gear output",
        locked_to="angle",
    ),
)  # fmt: skip


def _parameters(place: Place) -> tuple[Parameter, ...]:
    return tuple(p.at_axis(place.axis) for p in PARAMETERS)


def _contribute(place: Place) -> Contribution:
    sine, cosine, cycles = (place.parameter(p.name) for p in PARAMETERS)
    phase = cycles * place.gear_angle
    return Contribution(potential=(sine * sp.cos(phase) - cosine * sp.sin(phase)) / cycles)


COGGING = Effect(
    id="cogging",
    title="cogging of the motor",
    reference="Hanselman (2003), section 6: cogging as a position-dependent potential",
    parameters=_parameters,
    contribute=_contribute,
    separating_experiment="Turn the unpowered motor by hand or repeat at two loads: cogging stays,"
    " a transmission error grows with the load.",
)
