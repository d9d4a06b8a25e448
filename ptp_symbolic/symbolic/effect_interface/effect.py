"""What an effect is: parameters, the values at which it vanishes, and what it adds.

An effect is plain data plus one function, `contribute`, that turns the place where the effect
sits into symbolic additions. Effects never name each other: they meet in *quantities*, named
placeholders such as ``winding_resistance_pan`` that one effect defines and others change.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import Any

import sympy as sp

from ptp_symbolic.symbolic.effect_interface.conditions import Requirement
from ptp_symbolic.symbolic.effect_interface.contribution import Contribution
from ptp_symbolic.symbolic.effect_interface.linear import (
    linear_contribution,
    linear_parameter,
    linear_words,
)
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effect_interface.place import Place


def _always(place: Place, parameter: Parameter) -> bool:
    return True


@lru_cache(maxsize=1024)
def _contribution(contribute: Callable[[Place], Contribution], place: Place) -> Contribution:
    return contribute(place)


Step = tuple[str, sp.Expr, sp.Expr]


def _without_steps(place: Place) -> tuple[Step, ...]:
    return ()


def _without_conditions(place: Place) -> tuple[Requirement, ...]:
    return ()


@dataclass(frozen=True)
class Member:
    """A simpler version of an effect: the templates of the `parameters` that it has.

    The others stay where they vanish, or take the value of another one, as `tied` says. A search
    names an effect with the smallest member that the logs ask for.
    """

    title: str
    parameters: tuple[str, ...]
    tied: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class Structure:
    """How a platform that lacks an effect is rebuilt with it, where no value makes it vanish.

    `needs` are quantities that a declared effect must define on the axis. Of the effects named in
    `in_place_of`, one must be declared on the axis: the effect takes its place. Those named in
    `along_with` come with it where they are not declared and have what they need. It cannot stand
    beside those named in `excluded_by`. A fit of it is led astray where one of those named in
    `beside` is missing too.
    """

    needs: tuple[str, ...] = ()
    in_place_of: tuple[str, ...] = ()
    along_with: tuple[str, ...] = ()
    excluded_by: tuple[str, ...] = ()
    beside: tuple[str, ...] = ()


@dataclass(frozen=True)
class Effect:
    """A physical effect, complete in one file.

    `on_axis`: it sits on an axis, not on the whole platform. `needs`: quantities without which it
    has nothing to act on; `requires`: what its parameters must fulfil. `dissipative`: its torques
    only take energy out, which tests verify. `structural`: no parameter value makes it vanish (a
    motor, a body): declared, never searched for; nor is one that is `declared_only`. `sites`: where
    on its axis it may sit, if there is a choice. `splits_axis`: the gear output has a coordinate of
    its own; `turns_base`: the base turns, and all of a body's inertia matters. A diagnosis rebuilds
    platforms with it as its `structure` says (None: it does not). `has` tells which of its
    parameters it has at a place. `members` are nested versions of it, the simplest first and the
    whole last; where `first_leads`, what the others add to the first can only be smaller. Other
    `kinds` share its id; this is the usual one. `linear` has the texts that are others on a linear
    joint, where they do not follow word by word; what makes no sense there says
    `instead_on_linear` why. `derived` has the steps from a principle to its law: words, left and
    right side of each.

    Raises ValueError for a parameter whose default, starts or vanishing value lie out of its
    bounds, and for a member with parameters that are not the effect's.
    """

    id: str
    title: str
    reference: str
    parameters: tuple[Parameter, ...]
    contribute: Callable[[Place], Contribution]
    on_axis: bool = True
    dissipative: bool = False
    structural: bool = False
    declared_only: bool = False
    sites: tuple[str, ...] = ()
    splits_axis: bool = False
    turns_base: bool = False
    needs: tuple[str, ...] = ()
    requires: Callable[[Place], tuple[Requirement, ...]] = _without_conditions
    has: Callable[[Place, Parameter], bool] = _always
    separating_experiment: str = ""
    members: tuple[Member, ...] = ()
    first_leads: bool = False
    kind: str | None = None
    kinds: tuple["Effect", ...] = ()
    linear: Mapping[str, str] | None = field(default=None, hash=False)
    instead_on_linear: str = ""
    structure: Structure | None = None
    derived: Callable[[Place], tuple[Step, ...]] = _without_steps

    def __post_init__(self) -> None:
        for parameter in self.parameters:
            parameter.check()
        names = {parameter.name for parameter in self.parameters}
        for member in self.members:
            named = {*member.parameters, *member.tied, *member.tied.values()}
            if foreign := sorted(named - names):
                raise ValueError(
                    f"Effect '{self.id}': its member '{member.title}' has {', '.join(foreign)},"
                    " which the effect has not."
                )

    @property
    def searched(self) -> bool:
        """Whether a diagnosis looks for the effect."""
        return not (self.structural or self.declared_only)

    def parameters_at(self, place: Place) -> tuple[Parameter, ...]:
        """The parameters that the effect has at `place`, the name of its axis filled in."""
        own = (p.at_axis(place.axis) for p in self.parameters if self.has(place, p))
        return tuple(map(linear_parameter, own) if place.linear else own)

    def contribution_at(self, place: Place) -> Contribution:
        """What the effect adds at `place`, in the units of the joint there."""
        added = self.turning_contribution_at(place)
        return linear_contribution(added) if place.linear else added

    def turning_contribution_at(self, place: Place) -> Contribution:
        """What `contribute` gives at `place`, on a joint that turns; derived once for a place."""
        return _contribution(self.contribute, place)

    def worded_at(self, place: Place) -> "Effect":
        """The effect with its texts in the words of the joint at `place`."""
        if not place.linear:
            return self
        texts: dict[str, Any] = {
            n: linear_words(getattr(self, n)) for n in ("title", "separating_experiment")
        }
        return replace(self, **{**texts, **(self.linear or {})})
