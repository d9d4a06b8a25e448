"""Friction that depends on the angle: a bent shaft, a bearing under uneven load.

What presses the surfaces together goes with the angle, and with it Coulomb and static friction by
the same share.
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
        "f_sin_{axis}",
        "1",
        0.0,
        -10.0,
        10.0,
        "share of dry friction that goes with the sine of the angle at the gear output",
        vanishes=0.0,
        starts=(0.0, 0.1),
    ),
    Parameter(
        "f_cos_{axis}",
        "1",
        0.0,
        -10.0,
        10.0,
        "share of dry friction that goes with the cosine",
        vanishes=0.0,
        starts=(0.1,),
    ),
)
NUMBER = wave_number("n_F_{axis}")


def _contribute(place: Place) -> Contribution:
    change = Change(sp.Max(1 + wave(place, AMPLITUDES, place.gear_angle, NUMBER), 0))
    return Contribution(
        changes={f"{word}_torque_{place.axis}": change for word in ("coulomb", "static")}
    )


POSITION_DEPENDENT_FRICTION = Effect(
    id="position_dependent_friction",
    title="friction that depends on the angle",
    reference="Armstrong-Helouvry (1991), section 4: friction against position",
    parameters=(*(p for pair in AMPLITUDES for p in pair), NUMBER),
    has=has_wave_number,
    contribute=_contribute,
    needs=("coulomb_torque_{axis}", "static_torque_{axis}"),
    members=harmonic_members(AMPLITUDES, (NUMBER.name,)),
    separating_experiment="Pass the same angles both ways at two speeds: gravity keeps its sign,"
    " friction flips, an encoder error grows with the speed.",
)
