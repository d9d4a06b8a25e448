"""Platforms on which the laws of effects are tried."""

from dataclasses import replace
from pathlib import Path

import sympy as sp

from ptp_symbolic.models import variants
from ptp_symbolic.platform import EffectDeclaration, Platform, read_platform
from ptp_symbolic.symbolic.derivation.assembly import assemble
from ptp_symbolic.symbolic.derivation.equations import Equations
from ptp_symbolic.symbolic.derivation.placement import available_quantities, place_effects
from ptp_symbolic.symbolic.effects import EFFECTS, Effect

PLATFORMS = Path(__file__).parents[1] / "platforms"
BASES = tuple(
    read_platform(source)
    for source in (
        "thesis-payload",
        PLATFORMS / "fieldlog_pan.toml",
        PLATFORMS / "fieldlog_two_axis.toml",
    )
)
IDS = [effect.id for effect in EFFECTS]


def with_effect(effect: Effect) -> Platform:
    """The first base platform that has the effect, or that it can be added to."""
    for base in BASES:
        if any(e.effect == effect.id for e in base.effects):
            return base
        available = available_quantities(place_effects(base))
        for addition in variants.candidate_effects(base):
            needs = {need.format(axis=addition.axis) for need in effect.needs}
            if addition.effect == effect.id and needs <= available:
                return replace(base, effects=(*base.effects, addition))
    assert not effect.searched, f"No base platform takes {effect.id}."
    needs = {need.format(axis="pan") for need in effect.needs}
    if effect.splits_axis:
        return instead_of_shaft(effect)
    base = next(b for b in BASES if needs <= available_quantities(place_effects(b)))
    addition = EffectDeclaration(effect.id, base.axes[0] if effect.on_axis else None, None)
    return replace(base, effects=(*base.effects, addition))


def instead_of_shaft(effect: Effect) -> Platform:
    """The first base platform with a shaft, `effect` in its place, and nothing that acts on it."""
    splitting = {e.id for e in EFFECTS if e.splits_axis}
    base, shaft = next((b, e) for b in BASES for e in b.effects if e.effect in splitting)
    key = f"{shaft.effect}@{shaft.axis}"
    gone = [e for e in assemble(base).effects if e.effect.id == shaft.effect or key in e.acts_on]
    own, names = {n for e in gone for n in e.parameters}, {e.effect.id for e in gone}
    kept = tuple(e for e in base.effects if e.effect not in names)
    return replace(
        base,
        effects=(*kept, EffectDeclaration(effect.id, shaft.axis, None)),
        parameters=tuple(p for p in base.parameters if p.name not in own),
    )


def without(platform: Platform, effect: Effect) -> Platform:
    """`platform` without the effect and its parameters."""
    own = {n for e in assemble(platform).effects if e.effect is effect for n in e.parameters}
    return replace(
        platform,
        effects=tuple(e for e in platform.effects if e.effect != effect.id),
        parameters=tuple(p for p in platform.parameters if p.name not in own),
    )


def vanishing(equations: Equations, effect: Effect) -> dict[sp.Symbol, sp.Expr]:
    return {
        sp.Symbol(p.name, real=True): sp.nsimplify(p.vanishes)
        for placed in equations.effects
        if placed.effect is effect
        for p in equations.parameters
        if p.name in placed.parameters and p.vanishes is not None
    }
