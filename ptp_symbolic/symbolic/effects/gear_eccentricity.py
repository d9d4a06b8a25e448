"""A gear that does not run true: its output leads and lags once per turn.

Before a flexible shaft the error twists the shaft. Without one the motor lags and leads the joint,
by the error at the joint's own angle: its inertia seen there, the lever of its torque and its back
EMF change with the angle. The two agree but for the square of the error.
"""

import sympy as sp

from ptp_symbolic.symbolic.effect_interface.contribution import Change, Contribution
from ptp_symbolic.symbolic.effect_interface.effect import Effect
from ptp_symbolic.symbolic.effect_interface.harmonics import (
    harmonic_members,
    has_wave_number,
    wave,
    wave_number,
)
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter, harmonics
from ptp_symbolic.symbolic.effect_interface.place import Place

AMPLITUDES = harmonics(
    Parameter(
        "g_sin_{axis}",
        "rad",
        0.0,
        -0.2,
        0.2,
        "transmission error: part that goes with the sine of the gear output's angle",
        vanishes=0.0,
        starts=(0.002,),
    ),
    Parameter(
        "g_cos_{axis}",
        "rad",
        0.0,
        -0.2,
        0.2,
        "transmission error: part that goes with the cosine",
        vanishes=0.0,
        starts=(0.002,),
    ),
)
NUMBER = wave_number("n_gear_{axis}")


def _contribute(place: Place) -> Contribution:
    error = wave(place, AMPLITUDES, place.gear_angle, NUMBER)
    changes = {f"transmission_error_{place.axis}": Change(addition=error)}
    if place.own_axis in place.shafts:
        return Contribution(changes=changes)
    slope = place.parameter("gear_error_slope_{axis}")
    changes[f"motor_lead_{place.axis}"] = Change(addition=-slope)
    return Contribution(changes=changes, terms={slope: sp.diff(error, place.gear_angle)})


GEAR_ECCENTRICITY = Effect(
    id="gear_eccentricity",
    title="gear that runs out of true",
    reference="Smith (1999), transmission error of an eccentric wheel",
    parameters=(*(p for pair in AMPLITUDES for p in pair), NUMBER),
    has=has_wave_number,
    contribute=_contribute,
    needs=("transmission_error_{axis}",),
    members=harmonic_members(AMPLITUDES, (NUMBER.name,)),
    first_leads=True,
    separating_experiment="Compare an encoder on the motor with the one on the joint over a full"
    " slow turn both ways; an encoder error shows without load as well.",
)
