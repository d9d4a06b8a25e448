"""What effects that go with the harmonics of an angle have in common."""

import sympy as sp

from ptp_symbolic.symbolic.effect_interface.effect import Member
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effect_interface.place import Place


def wave(
    place: Place, amplitudes: tuple[tuple[Parameter, Parameter], ...], angle: sp.Expr
) -> sp.Expr:
    """Sum of the harmonics of `angle` with sine and cosine `amplitudes` (see `harmonics`)."""
    return sp.Add(
        *(
            place.parameter(sine.name) * sp.sin(order * angle)
            + place.parameter(cosine.name) * sp.cos(order * angle)
            for order, (sine, cosine) in enumerate(amplitudes, start=1)
        )
    )


def harmonic_members(
    amplitudes: tuple[tuple[Parameter, Parameter], ...], beside: tuple[str, ...] = ()
) -> tuple[Member, ...]:
    """Members of an effect with one harmonic, two, and all; the parameters `beside` are in each."""
    titles = ("one harmonic", "two harmonics", "three harmonics")
    return tuple(
        Member(title, (*(p.name for pair in amplitudes[:count] for p in pair), *beside))
        for count, title in enumerate(titles, start=1)
    )
