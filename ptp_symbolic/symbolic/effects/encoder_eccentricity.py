"""An encoder disc off its centre: the reading leads and lags once per turn."""

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
        "e_sin_{axis}",
        "rad",
        0.0,
        -0.2,
        0.2,
        "reading error of the encoder: part that goes with the sine of the joint angle",
        vanishes=0.0,
        starts=(0.002,),
    ),
    Parameter(
        "e_cos_{axis}",
        "rad",
        0.0,
        -0.2,
        0.2,
        "reading error of the encoder: part that goes with the cosine",
        vanishes=0.0,
        starts=(0.002,),
    ),
)
NUMBER = wave_number("n_enc_{axis}")


def _contribute(place: Place) -> Contribution:
    error = wave(place, AMPLITUDES, place.angle, NUMBER)
    return Contribution(changes={f"reading_{place.angle}": Change(addition=error)})


ENCODER_ECCENTRICITY = Effect(
    id="encoder_eccentricity",
    title="encoder off its centre",
    reference="Ellin and Dolsak (2008): eccentricity error of rotary encoders",
    parameters=(*(p for pair in AMPLITUDES for p in pair), NUMBER),
    has=has_wave_number,
    contribute=_contribute,
    members=harmonic_members(AMPLITUDES, (NUMBER.name,)),
    first_leads=True,
    separating_experiment="Turn slowly against a second encoder or an optical polygon: the error"
    " depends on the angle alone, at any speed and load.",
)
