"""Parameters of effects: name, unit, default, bounds, and where the effect vanishes."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import sympy as sp

from ptp_symbolic.symbolic.symbols import real

HIGHEST_HARMONIC = 3


@dataclass(frozen=True)
class Parameter:
    """One physical parameter of an effect.

    `name` may hold the field ``{axis}``, filled in by `at_axis`. `vanishes` is the value that
    switches the effect off; None means that the value does not matter once the others are there
    (the rest angle of a spring without stiffness). `starts` are the values from which a search
    begins when the parameter is not declared. A parameter with a `period` wraps around. `locked_to`
    ("time" or "angle") marks a frequency that is searched at the strongest lines of the residual.
    `turns`: of a motor, which turns before a linear joint too. `linear` names the fields that are
    others on a linear joint, where they do not follow from those here.
    """

    name: str
    unit: str
    default: float
    lower: float
    upper: float
    meaning: str
    vanishes: float | None = None
    starts: tuple[float, ...] = ()
    period: float | None = None
    locked_to: str | None = None
    turns: bool = False
    linear: Mapping[str, Any] | None = field(default=None, hash=False)

    def check(self) -> None:
        """Raise ValueError where default, a start or the vanishing value lies out of bounds."""
        values = [("default", self.default), *(("start", start) for start in self.starts)]
        if self.vanishes is not None:
            values.append(("vanishing value", self.vanishes))
        for word, value in values:
            if not self.lower <= value <= self.upper:
                raise ValueError(
                    f"Parameter '{self.name}': its {word}, {value:g} {self.unit}, lies outside"
                    f" [{self.lower:g}, {self.upper:g}]; change it, or the bounds."
                )

    @property
    def has_natural_default(self) -> bool:
        """Whether a machine that does not declare the parameter is as good as said: the default is
        zero, or switches the effect off. Any other one is that of some machine.
        """
        return self.default in (0.0, self.vanishes)

    @property
    def symbol(self) -> sp.Symbol:
        """The symbol of the parameter, its name being filled in."""
        return real(self.name)

    def at_axis(self, axis: str | None) -> "Parameter":
        """Return the parameter with its name and meaning filled in for `axis`."""
        name, meaning = (text.replace("{axis}", str(axis)) for text in (self.name, self.meaning))
        return replace(self, name=name, meaning=meaning)


def harmonics(sine: Parameter, cosine: Parameter) -> tuple[tuple[Parameter, Parameter], ...]:
    """The amplitudes `sine` and `cosine` of a wave and those of its harmonics up to the third.

    A name ``f_sin_{axis}`` becomes ``f_sin2_{axis}``; harmonics begin at zero in a search.
    """

    def of_order(parameter: Parameter, order: int) -> Parameter:
        if order == 1:
            return parameter
        name = parameter.name.replace("_{axis}", f"{order}_{{axis}}")
        meaning = f"{parameter.meaning}, harmonic {order}"
        return replace(parameter, name=name, meaning=meaning, starts=(0.0,))

    orders = range(1, HIGHEST_HARMONIC + 1)
    return tuple((of_order(sine, n), of_order(cosine, n)) for n in orders)
