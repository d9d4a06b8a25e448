"""Machines on which the laws of effects are tried."""

from dataclasses import replace
from functools import lru_cache

from ptp_symbolic.errors import InputError
from ptp_symbolic.models import variants
from ptp_symbolic.platform import (
    EffectDeclaration,
    Platform,
    SignalDeclaration,
    read_platform,
)
from ptp_symbolic.symbolic.derivation.admissible import refuse_impossible
from ptp_symbolic.symbolic.derivation.assembly import assemble
from ptp_symbolic.symbolic.derivation.placement import available_quantities, place_effects
from ptp_symbolic.symbolic.effects import EFFECTS, Effect, catalogue

BARE = ("rigid_bodies",)
DRY = (*BARE, "csvs_friction")
DRIVEN = (*DRY, "dc_motor")
GEARED = (*DRIVEN, "shaft_compliance")
SERVED = (*DRIVEN, "pid_controller")


def bases() -> tuple[Platform, ...]:
    """A rigid two-axis machine, a pan axis with its whole drive train, two axes with friction, and
    a pan axis under its own controller.
    """
    return _packaged_bases()


@lru_cache(maxsize=1)
def _packaged_bases() -> tuple[Platform, ...]:
    def effect(name: str, axis: str | None = None, site: str | None = None) -> EffectDeclaration:
        return EffectDeclaration(name, axis, site)

    bodies = (effect("rigid_bodies"), effect("payload"))
    drive = (
        *bodies,
        effect("viscous_friction", "pan"),
        effect("dc_motor", "pan"),
        effect("shaft_compliance", "pan"),
        effect("backlash", "pan"),
        effect("csvs_friction", "pan", "gear"),
    )
    served = (*drive[:4], effect("pid_controller", "pan"))
    friction = tuple(
        declared
        for axis in ("pan", "tilt")
        for declared in (
            effect("viscous_friction", axis),
            effect("csvs_friction", axis, "joint"),
        )
    )
    return (
        read_platform("thesis-payload"),
        Platform("driven_pan", "Driven pan axis", ("pan",), 9.81, drive, (), ()),
        Platform("two_axes", "Two axes", ("pan", "tilt"), 9.81, (*bodies, *friction), (), ()),
        Platform("served_pan", "Pan axis and controller", ("pan",), 9.81, served, (), ()),
    )


def machine_with(effect: Effect) -> Platform:
    """The first base that has `effect`, or that it can be added to, with all that it can measure as
    outputs. Raises InputError for none.
    """
    platform = _machine_with(effect)
    own = [e.contribution_at(place) for e, place in place_effects(platform) if e.id == effect.id]
    known = {signal.signal for signal in platform.signals}
    shown = tuple(
        SignalDeclaration(sensor.name, sensor.name, sensor.unit, "output")
        for added in own
        for sensor in added.sensors
        if sensor.name not in known
    )
    return replace(platform, signals=(*platform.signals, *shown))


def _machine_with(effect: Effect) -> Platform:
    for base in bases():
        if any(e.effect == effect.id for e in base.effects):
            return base
        available = available_quantities(place_effects(base))
        for addition in variants.candidate_effects(base):
            needs = {need.format(axis=addition.axis) for need in effect.needs}
            if addition.effect == effect.id and needs <= available:
                return replace(base, effects=(*base.effects, addition))
    if effect.splits_axis:
        return _instead_of_shaft(effect)
    needs = {need.format(axis="pan") for need in effect.needs}
    for base in bases():
        if needs <= available_quantities(place_effects(base)):
            addition = EffectDeclaration(effect.id, base.axes[0] if effect.on_axis else None, None)
            return replace(base, effects=(*base.effects, addition))
    raise InputError(
        f"Effect '{effect.id}': no machine has all that it `needs`, {', '.join(effect.needs)}; give"
        " the quantities of effects that exist."
    )


def _instead_of_shaft(effect: Effect) -> Platform:
    """The first base with a shaft, `effect` in its place, and nothing that acts on it."""
    splitting = {e.id for e in EFFECTS if e.splits_axis}
    base, shaft = next((b, e) for b in bases() for e in b.effects if e.effect in splitting)
    key = f"{shaft.effect}@{shaft.axis}"
    gone = [e for e in assemble(base).effects if e.effect.id == shaft.effect or key in e.acts_on]
    own, names = {n for e in gone for n in e.parameters}, {e.effect.id for e in gone}
    kept = tuple(e for e in base.effects if e.effect not in names)
    return replace(
        base,
        effects=(*kept, EffectDeclaration(effect.id, shaft.axis, None)),
        parameters=tuple(p for p in base.parameters if p.name not in own),
    )


def machine_without(platform: Platform, effect: Effect) -> Platform:
    """`platform` without `effect` and its parameters."""
    own = {n for e in assemble(platform).effects if e.effect is effect for n in e.parameters}
    return replace(
        platform,
        effects=tuple(e for e in platform.effects if e.effect != effect.id),
        parameters=tuple(p for p in platform.parameters if p.name not in own),
    )


def carriage(*names: str) -> Platform:
    """A linear axis with the effects of these names."""
    found = [e for e in catalogue() if e.id in names]
    declared = tuple(EffectDeclaration(e.id, "pan" if e.on_axis else None, None) for e in found)
    return Platform("slide", "slide", ("pan",), 9.81, declared, (), (), linear_axes=("pan",))


def carriage_with(effect: Effect) -> Platform:
    """The smallest carriage that takes `effect`. Raises InputError where none does."""
    refusal: InputError | None = None
    for base in (BARE, DRY, DRIVEN, GEARED, SERVED):
        try:
            platform = carriage(*base, effect.id)
            refuse_impossible(assemble(platform))
        except InputError as error:
            refusal = error
            continue
        return platform
    raise InputError(
        f"Effect '{effect.id}': no machine on a linear joint takes it ({refusal}); say by"
        " `instead_on_linear` why."
    )
