"""Variants of a platform: with candidate effects, extended by what was found, driven by torques."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

from ptp_symbolic.errors import InputError
from ptp_symbolic.platform import EffectDeclaration, ParameterDeclaration, Platform, effect_key
from ptp_symbolic.symbolic.derivation.assembly import assemble
from ptp_symbolic.symbolic.derivation.contributions import TORQUES
from ptp_symbolic.symbolic.derivation.placement import (
    available_quantities,
    place_effects,
)
from ptp_symbolic.symbolic.effect_interface.effect import Effect
from ptp_symbolic.symbolic.effects import catalogue


def candidate_effects(platform: Platform) -> tuple[EffectDeclaration, ...]:
    """Effects that could be added to `platform`: searchable, not declared, with what they need,
    which may itself be one of them; none that describes what a declared effect does.
    """
    declared = {(effect.id, place.axis) for effect, place in place_effects(platform)}
    order = {effect.id: number for number, effect in enumerate(catalogue())}
    found: list[EffectDeclaration] = []
    while True:
        extended = replace(platform, effects=(*platform.effects, *found))
        available = available_quantities(place_effects(extended))
        added = [
            EffectDeclaration(effect.id, axis, None)
            for effect in catalogue()
            for axis in (platform.axes if effect.on_axis else (None,))
            if effect.searched
            and not (platform.linear_axes and effect.instead_on_linear)
            and (effect.id, axis) not in declared | {(e.effect, e.axis) for e in found}
            and {need.format(axis=axis) for need in effect.needs} <= available
            and described_by(platform, effect, axis) is None
        ]
        if not added:
            return tuple(sorted(found, key=lambda e: order[e.effect]))
        found += added


def described_by(platform: Platform, effect: Effect, axis: str | None) -> str | None:
    """The declared effect that describes a parameter of `effect` on `axis` already; None if none
    does. LuGre friction does so to Coulomb friction.
    """
    own = {p.name.format(axis=axis) for p in effect.parameters}
    return next(
        (
            other.id
            for other, place in place_effects(platform)
            if (other.id, place.axis) != (effect.id, axis)
            and own & {p.name for p in other.parameters_at(place)}
        ),
        None,
    )


def with_candidates(platform: Platform) -> Platform:
    """`platform` with every candidate effect that can stand beside it and the others: a friction by
    load cannot beside a rigid gap, which leaves that load open.
    """
    return _with_those_that_fit(platform, candidate_effects(platform))


def _with_those_that_fit(platform: Platform, added: tuple[EffectDeclaration, ...]) -> Platform:
    whole = replace(platform, effects=(*platform.effects, *added))
    try:
        assemble(whole)
    except InputError:
        if len(added) < 2:
            return platform
        half = len(added) // 2
        return _with_those_that_fit(_with_those_that_fit(platform, added[:half]), added[half:])
    return whole


def that_cannot_stand(platform: Platform) -> dict[str, str]:
    """By key, the candidates that `with_candidates` leaves out, and why."""
    kept, found = with_candidates(platform).effects, {}
    for effect in candidate_effects(platform):
        if effect in kept:
            continue
        why = "another candidate excludes it"
        try:
            assemble(replace(platform, effects=(*platform.effects, effect)))
        except InputError as error:
            why = str(error).rstrip(".")
        found[effect_key(effect.effect, effect.axis)] = f"it cannot stand there: {why}"
    return found


def torque_driven(platform: Platform) -> Platform:
    """`platform` with torques on its joints: without motors, shafts, what acts on those alone, and
    what lies between a torque and its command.

    Friction at the gear output then acts on the joint.
    """
    kept = []
    for effect, place in place_effects(platform):
        added = effect.turning_contribution_at(place)
        inputs = {name.format(axis=place.axis) for name in TORQUES} & added.changes.keys()
        if not (added.drives or added.shafts or added.plays or added.prescribed or inputs):
            kept.append((effect, replace(place, shafts=frozenset())))
    while True:
        available = available_quantities(kept)
        usable = [
            (effect, place)
            for effect, place in kept
            if all(need.format(axis=place.axis) in available for need in effect.needs)
        ]
        if len(usable) == len(kept):
            break
        kept = usable
    own = {p.name for effect, place in kept for p in effect.parameters_at(place)}
    return replace(
        platform,
        effects=tuple(EffectDeclaration(e.id, place.axis, place.site) for e, place in kept),
        parameters=tuple(p for p in platform.parameters if p.name in own),
    )


def extended(
    platform: Platform,
    added: Sequence[EffectDeclaration],
    values: Mapping[str, float],
    fitted: Sequence[ParameterDeclaration],
) -> Platform:
    """`platform` with effects and fitted parameters added; `values` are the new starts of what is
    free, and of the added effects what was not fitted: the result declares all that the model had.
    What is declared as known stays so, though a fit beside other effects may have moved it.
    """
    kept = []
    replaced = {p.name for p in fitted}
    for declaration in platform.parameters:
        if declaration.name in replaced:
            continue
        found = values.get(declaration.name, declaration.value)
        kept.append(replace(declaration, value=found) if declaration.free else declaration)
    whole = replace(platform, effects=(*platform.effects, *added), parameters=(*kept, *fitted))
    own = {(e.effect, e.axis) for e in added}
    known = tuple(
        ParameterDeclaration(p.name, p.unit, values[p.name])
        for effect, place in place_effects(whole)
        if (effect.id, place.axis) in own
        for p in effect.parameters_at(place)
        if p.name in values and p.name not in {d.name for d in whole.parameters}
    )
    return replace(whole, parameters=(*whole.parameters, *known))
