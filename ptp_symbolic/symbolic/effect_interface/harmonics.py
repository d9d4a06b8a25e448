"""What effects that go with the harmonics of an angle have in common.

An angle comes back after a turn. A position does not: on a linear joint a wave number says how far
it is from one cycle to the next.
"""

import math

import sympy as sp

from ptp_symbolic.symbolic.effect_interface.effect import Member
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effect_interface.place import Place


def wave_number(name: str) -> Parameter:
    """The wave number `name` of an effect on a linear joint, which no rotary joint has (`has`)."""
    return Parameter(
        name,
        "rad/m",
        200.0 * math.pi,
        0.5,
        1e5,
        "wave number: one cycle, 2 pi, over its length (a screw: 2 pi over its lead)",
        locked_to="angle",
        turns=True,
    )


def has_wave_number(place: Place, parameter: Parameter) -> bool:
    """Which parameters an effect with a wave number has: that one on a linear joint alone."""
    return place.linear or parameter.locked_to is None


def wave(
    place: Place,
    amplitudes: tuple[tuple[Parameter, Parameter], ...],
    angle: sp.Expr,
    number: Parameter,
) -> sp.Expr:
    """Sum of the harmonics of `angle` with sine and cosine `amplitudes` (see `harmonics`); on a
    linear joint of the position times the wave `number`.
    """
    phase = place.parameter(number.name) * angle if place.linear else angle
    return sp.Add(
        *(
            place.parameter(sine.name) * sp.sin(order * phase)
            + place.parameter(cosine.name) * sp.cos(order * phase)
            for order, (sine, cosine) in enumerate(amplitudes, start=1)
        )
    )


def harmonic_members(
    amplitudes: tuple[tuple[Parameter, Parameter], ...], beside: tuple[str, ...] = ()
) -> tuple[Member, ...]:
    """Members of an effect with one harmonic, two, and all; the parameters `beside` are in each
    that has them.
    """
    titles = ("one harmonic", "two harmonics", "three harmonics")
    return tuple(
        Member(title, (*(p.name for pair in amplitudes[:count] for p in pair), *beside))
        for count, title in enumerate(titles, start=1)
    )
