"""What an effect may not do is refused by name: its author, or who declares it, reads why."""

from collections.abc import Callable
from dataclasses import replace

import pytest
import sympy as sp

from ptp_symbolic.errors import InputError
from ptp_symbolic.platform import EffectDeclaration, Platform
from ptp_symbolic.symbolic.derivation import placement
from ptp_symbolic.symbolic.derivation.assembly import assemble
from ptp_symbolic.symbolic.effect_interface.contribution import Change, Contribution, State
from ptp_symbolic.symbolic.effect_interface.effect import Effect, Member
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effect_interface.place import Place, quantity
from ptp_symbolic.symbolic.effects import EFFECTS

OWN = Parameter("a_{axis}", "N m", 1.0, 0.0, 2.0, "a torque", vanishes=0.0)


def effect(
    contribute: Callable[[Place], Contribution], identifier: str = "own", *more: Parameter
) -> Effect:
    return Effect(identifier, "an effect", "none", (OWN, *more), contribute, structural=True)


def machine(monkeypatch: pytest.MonkeyPatch, *own: Effect) -> Platform:
    """A pan axis with effects that are added to the catalogue."""
    monkeypatch.setattr(placement, "catalogue", lambda: (*EFFECTS, *own))
    declared = [EffectDeclaration("rigid_bodies", None, None)]
    declared += [EffectDeclaration(e.id, "pan", None) for e in own]
    return Platform("own", "Own effects", ("pan",), 9.81, tuple(declared), (), ())


def torque(place: Place) -> Contribution:
    (amount,) = place.symbols((OWN,))
    return Contribution(torques={place.rate: amount})


def with_quantity(name: str, value: sp.Expr) -> Callable[[Place], Contribution]:
    def contribute(place: Place) -> Contribution:
        return replace(torque(place), quantities={name: value})

    return contribute


def test_a_quantity_that_two_effects_define_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    one = effect(with_quantity("grip_pan", sp.Integer(1)), "one")
    two = replace(
        effect(with_quantity("grip_pan", sp.Integer(2)), "two"),
        parameters=(replace(OWN, name="b_{axis}"),),
        contribute=lambda place: Contribution(quantities={"grip_pan": sp.Integer(2)}),
    )
    with pytest.raises(InputError, match="'one' and 'two' both define 'grip_pan'"):
        assemble(machine(monkeypatch, one, two))


def test_a_quantity_that_refers_to_itself_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    def contribute(place: Place) -> Contribution:
        circle = {"here": quantity("there") + 1, "there": 2 * quantity("here")}
        return replace(torque(place), quantities=circle)

    with pytest.raises(ValueError, match=r"refers to itself: \w+ -> \w+ -> \w+; break the circle"):
        assemble(machine(monkeypatch, effect(contribute)))


def test_a_change_of_a_quantity_that_nothing_defines_is_refused(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def contribute(place: Place) -> Contribution:
        return replace(torque(place), changes={"grip_pan": Change(addition=sp.Integer(1))})

    with pytest.raises(ValueError, match="'own' changes 'grip_pan', which nothing defines"):
        assemble(machine(monkeypatch, effect(contribute)))


@pytest.mark.parametrize("name", ["force_pan", "mass_x", "x", "accel_pan", "lambda"])
def test_a_name_that_modules_use_for_themselves_is_refused(
    monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    def contribute(place: Place) -> Contribution:
        return replace(torque(place), states=(State(name, "1", "a state", -place.rate),))

    with pytest.raises(ValueError, match=rf"State '{name}' has"):
        assemble(machine(monkeypatch, effect(contribute)))


def test_a_site_that_an_effect_does_not_use_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    platform = machine(monkeypatch, effect(torque))
    (bodies, own) = platform.effects
    with pytest.raises(InputError, match="'own' has no choice of site; remove its site"):
        assemble(replace(platform, effects=(bodies, replace(own, site="gear"))))


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"default": 3.0}, r"its default, 3 N m, lies outside \[0, 2\]"),
        ({"starts": (0.1, -1.0)}, r"its start, -1 N m, lies outside \[0, 2\]"),
        ({"vanishes": -0.1}, r"its vanishing value, -0\.1 N m, lies outside \[0, 2\]"),
    ],
)
def test_values_out_of_bounds_are_refused_when_the_effect_is_made(
    wrong: dict[str, object], message: str
) -> None:
    with pytest.raises(ValueError, match=message):
        replace(effect(torque), parameters=(replace(OWN, **wrong),))  # type: ignore[arg-type]


def test_a_member_with_parameters_of_others_is_refused() -> None:
    with pytest.raises(ValueError, match=r"its member 'less' has b_\{axis\}, which the effect"):
        replace(effect(torque), members=(Member("less", ("b_{axis}",)),))
