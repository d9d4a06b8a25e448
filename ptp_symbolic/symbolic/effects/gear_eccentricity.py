"""A gear that does not run true: its output leads and lags once per turn."""

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
    return Contribution(changes={f"transmission_error_{place.axis}": Change(addition=error)})


GEAR_ECCENTRICITY = Effect(
    id="gear_eccentricity",
    title="gear that runs out of true",
    reference="Smith (1999), transmission error of an eccentric wheel",
    parameters=(*(p for pair in AMPLITUDES for p in pair), NUMBER),
    has=has_wave_number,
    contribute=_contribute,
    needs=("half_gap_{axis}",),
    members=harmonic_members(AMPLITUDES, (NUMBER.name,)),
    first_leads=True,
    separating_experiment="Compare an encoder on the motor with the one on the joint over a full"
    " slow turn both ways; an encoder error shows without load as well.",
)
