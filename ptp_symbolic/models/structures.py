"""Platforms one structure away from a declared one: rebuilt with an effect that brings states or
modes, or replaces a law, and that no value of a parameter makes vanish.

Which there are follows from the effects, each of which says how it is built in (`Structure`).
"""

import itertools
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from ptp_symbolic.errors import InputError
from ptp_symbolic.models.variants import candidate_effects, described_by
from ptp_symbolic.platform import EffectDeclaration, ParameterDeclaration, Platform, effect_key
from ptp_symbolic.symbolic.derivation.placement import (
    available_quantities,
    find_effect,
    parameters_of,
    place_effects,
    readings,
)
from ptp_symbolic.symbolic.effect_interface.effect import Effect
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effects import catalogue

Site = tuple[Effect, str | None]  # an effect, of one of its kinds, and its axis


@dataclass(frozen=True)
class Rebuilt:
    """A platform one structure away from the declared one.

    `added` are the effects that it has more, the one it is named after first; `removed` those whose
    place they take. `starts` are values of the parameters that came with them, from which a fit
    begins. Every effect `provides` mechanisms: where that of another structure has all of these,
    it contains this one. `notes` say of each added effect what was moved with it, or nothing. A fit
    may be led astray where one of the effects `beside` is missing too. One with the encoder at
    the motor is a version `of` one that provides these mechanisms.
    """

    platform: Platform
    added: tuple[EffectDeclaration, ...]
    removed: tuple[EffectDeclaration, ...]
    starts: tuple[Mapping[str, float], ...]
    provides: frozenset[str]
    notes: tuple[str, ...]
    beside: tuple[EffectDeclaration, ...] = ()
    of: frozenset[str] = frozenset()

    @property
    def keys(self) -> tuple[str, ...]:
        """Keys of the added effects, e.g. ``backlash@pan``."""
        return tuple(effect_key(e.effect, e.axis) for e in self.added)

    @property
    def axes(self) -> frozenset[str | None]:
        """Axes of the added effects; None for one of the whole platform."""
        return frozenset(e.axis for e in self.added)


BEHIND = "joint"  # the site of friction behind a shaft or a gap
SPLITTING = ("shaft", "play")  # mechanisms that leave friction at the gear, or behind them
BEFORE = " before friction"  # ends the name of a shaft or gap with friction at the joint
BEHIND_ENCODER = " behind the encoder"  # of one with the encoder at the motor
USUAL_INERTIA = 0.2  # kg m^2; of an axis that the starts of the effects suit
SPAN = 30.0  # 1; so many times lighter or heavier, they suit still


def to_scale(rebuilt: Rebuilt, inertia: Mapping[str, float]) -> Rebuilt:
    """A structure with the starts of inertias that came with it in proportion to the `inertia` in
    kg m^2 by axis, and of stiffnesses, dampings and torques where that is far from usual: then they
    swing at the same frequencies.
    """
    own = parameters_of(place_effects(rebuilt.platform))
    factors = {}
    for name in rebuilt.starts[0]:
        axis = next((a for a in inertia if name.endswith(f"_{a}")), None)
        ratio = 1.0 if axis is None else inertia[axis] / USUAL_INERTIA
        is_usual = not own[name].unit.startswith("N m") or 1.0 / SPAN <= ratio <= SPAN
        factors[name] = ratio if own[name].unit == "kg m^2" or not is_usual else 1.0

    def scaled(name: str, value: float) -> float:
        return min(max(value * factors[name], own[name].lower), own[name].upper)

    parameters = tuple(
        replace(p, value=scaled(p.name, p.value)) if p.name in factors else p
        for p in rebuilt.platform.parameters
    )
    return replace(
        rebuilt,
        platform=replace(rebuilt.platform, parameters=parameters),
        starts=tuple({n: scaled(n, v) for n, v in start.items()} for start in rebuilt.starts),
    )


def structures(platform: Platform) -> tuple[tuple[Rebuilt, ...], dict[str, str]]:
    """`platform` rebuilt with every effect of the catalogue that says how, on every axis that has
    what it needs; and, by key, why other effects are no candidates of a diagnosis.
    """
    found: list[Rebuilt] = []
    terms = {(e.effect, e.axis) for e in candidate_effects(platform)}
    declared = {(e.effect, e.axis) for e in platform.effects}
    untried: dict[str, str] = {}
    for effect, axis in _everywhere(platform):
        key = effect_key(effect.id, axis)
        if (effect.id, axis) in declared | terms:
            continue
        try:
            why = _lacking(platform, effect, axis)
            if why is None:
                usual = _rebuilt(platform, effect, axis)
                found += (usual, *_with_friction_behind(usual, platform, effect, axis))
                found += _with_encoder_before(usual, platform, effect, axis)
        except InputError as error:
            why = f"the platform cannot be rebuilt with it: {error}"
        if why is not None:
            untried.setdefault(key, why)
    found += _with_friction_moved(platform)
    tried = {key for each in found for key in each.keys}
    return tuple(found), {key: why for key, why in untried.items() if key not in tried}


def with_what_leads(platform: Platform, every: Sequence[Rebuilt]) -> tuple[Platform, ...]:
    """`platform` with each of the effects beside which structures are led right, on all of their
    axes, its parameters free.
    """
    effects = dict.fromkeys(effect for each in every for effect in each.beside)
    return tuple(
        _with_free(platform, tuple(e for e in effects if e.effect == name))
        for name in dict.fromkeys(e.effect for e in effects)
    )


def _with_free(platform: Platform, added: tuple[EffectDeclaration, ...]) -> Platform:
    """`platform` with effects whose parameters are free."""
    whole = replace(platform, effects=(*platform.effects, *added))
    own, said = {(e.effect, e.axis) for e in added}, {p.name for p in platform.parameters}
    fresh = tuple(
        ParameterDeclaration(p.name, p.unit, p.default, free=True)
        for effect, place in place_effects(whole)
        if (effect.id, place.axis) in own
        for p in effect.parameters_at(place)
        if p.name not in said
    )
    return replace(whole, parameters=(*platform.parameters, *fresh))


Family = tuple[tuple[str, ...], frozenset[str]]


def family(keys: Sequence[str], provides: frozenset[str]) -> Family:
    """What structures share that differ by the side of friction or encoder alone, from the `keys`
    and mechanisms of any of them.
    """
    bare = frozenset(m.removesuffix(BEFORE).removesuffix(BEHIND_ENCODER) for m in provides)
    return tuple(keys[:1]), bare


def pairs(first: Rebuilt) -> tuple[Rebuilt, ...]:
    """The structures one step away from the platform of the structure `first`, each as a pair with
    `first`; nothing is put in place of what that added, and no friction moved behind it, which is
    tried beside it anyway.
    """
    own = {(e.effect, e.axis) for e in first.added}
    have = {(e.effect, e.axis) for e in first.platform.effects}
    return tuple(
        replace(
            second,
            added=(*first.added, *second.added),
            removed=(*first.removed, *second.removed),
            provides=_mechanisms(second.platform, own | {(e.effect, e.axis) for e in second.added}),
            notes=(*first.notes, *second.notes),
        )
        for second in structures(first.platform)[0]
        if not own & {(e.effect, e.axis) for e in second.removed}
        and not have & {(e.effect, e.axis) for e in second.added}
    )


def _everywhere(platform: Platform) -> Iterator[Site]:
    """Every kind of every effect of the catalogue, on every axis."""
    for each in catalogue():
        for effect in (each, *each.kinds):
            for axis in platform.axes if effect.on_axis else (None,):
                yield effect, axis


def _lacking(platform: Platform, effect: Effect, axis: str | None) -> str | None:
    """Why an effect that is no term of `platform` is no structure of it either; None if it is."""
    if platform.linear_axes and effect.instead_on_linear:
        return f"not tried: on a linear joint {effect.instead_on_linear}"
    if effect.structure is None:
        if effect.searched:
            missing = _missing(platform, effect.needs, axis)
            if not missing:
                return f"not tried: {described_by(platform, effect, axis)} describes the same"
            return f"not tried: it acts on {missing}, which no declared effect defines"
        return "not tried: it is declared, never searched for"
    beside = [e.effect for e in platform.effects if e.axis == axis]
    excluding = [e for e in effect.structure.excluded_by if e in beside]
    if excluding:
        return f"not tried: it excludes {' and '.join(excluding)}, declared on this axis"
    missing = _missing(platform, effect.structure.needs, axis)
    if missing:
        return f"not tried: it needs {missing}, which no declared effect defines"
    if effect.structure.in_place_of and not _removed(platform, effect, axis):
        replaced = " or ".join(effect.structure.in_place_of)
        return f"not tried: it takes the place of {replaced}, which is not declared on this axis"
    return None


def _missing(platform: Platform, needs: tuple[str, ...], axis: str | None) -> str:
    placed = place_effects(platform)
    available = available_quantities(placed) | readings(platform, placed)
    return " and ".join(
        name for name in (need.format(axis=axis) for need in needs) if name not in available
    )


def _removed(platform: Platform, effect: Effect, axis: str | None) -> tuple[EffectDeclaration, ...]:
    """The declared effects whose place `effect` takes."""
    own = effect.structure.in_place_of if effect.structure else ()
    return tuple(e for e in platform.effects if e.effect in own and e.axis == axis)


def _rebuilt(platform: Platform, effect: Effect, axis: str | None) -> Rebuilt:
    """`platform` with `effect`, what comes along with it, and all of their parameters that are not
    declared free. Raises InputError where what is declared beside cannot do with it.
    """
    removed = _removed(platform, effect, axis)
    kept = tuple(e for e in platform.effects if e not in removed)
    have = {(e.effect, e.axis) for e in kept}
    along = effect.structure.along_with if effect.structure else ()
    leading = effect.structure.beside if effect.structure else ()
    added = (
        EffectDeclaration(effect.id, axis, next((e.site for e in removed), None), effect.kind),
        *(
            EffectDeclaration(other, axis, None)
            for other in along
            if (other, axis) not in have and not _missing(platform, find_effect(other).needs, axis)
        ),
    )
    bare = replace(platform, effects=(*kept, *added), parameters=())
    placed = place_effects(bare)
    own, said = parameters_of(placed), {p.name for p in platform.parameters}
    new = {(e.effect, e.axis) for e in added}
    fresh = [
        p
        for each, place in placed
        if (each.id, place.axis) in new
        for p in each.parameters_at(place)
        if p.name not in said
    ]
    grid = [p.starts or (p.default,) for p in fresh]
    names = [p.name for p in fresh]
    parameters = (
        *(_within(p, own[p.name]) for p in platform.parameters if p.name in own),
        *(
            ParameterDeclaration(p.name, p.unit, values[0], free=True)
            for p, values in zip(fresh, grid, strict=True)
        ),
    )
    rebuilt = replace(bare, parameters=parameters)
    place_effects(rebuilt)
    return Rebuilt(
        rebuilt,
        added,
        removed,
        tuple(dict(zip(names, point, strict=True)) for point in itertools.product(*grid)),
        _mechanisms(rebuilt, new),
        ("",) * len(added),
        tuple(EffectDeclaration(e, axis, None) for e in leading if (e, axis) not in have),
    )


def _with_friction_behind(
    as_declared: Rebuilt, platform: Platform, effect: Effect, axis: str | None
) -> tuple[Rebuilt, ...]:
    """`platform` with an effect that splits the axis, and the dry friction that this leaves at the
    gear behind it, as in the bearings of a heavy load. None where it is said where friction sits.
    """
    moved = _behind(platform, axis) if _splits(as_declared) else None
    if moved is None:
        return ()
    rebuilt = _rebuilt(moved, effect, axis)
    return (replace(rebuilt, notes=(f"friction at the {BEHIND}", *rebuilt.notes[1:])),)


def _splits(rebuilt: Rebuilt) -> bool:
    """Whether a structure brings a shaft or a gap."""
    return any(one.startswith(SPLITTING) for one in rebuilt.provides)


def _with_encoder_before(
    as_declared: Rebuilt, platform: Platform, effect: Effect, axis: str | None
) -> tuple[Rebuilt, ...]:
    """`platform` with an effect that splits the axis, and the angle measured before it, at the
    motor; none where no angle of the axis is.
    """
    signals = {s.signal for s in platform.signals if s.role == "output"}
    encoder = EffectDeclaration("motor_encoder", axis, None)
    if not _splits(as_declared) or f"theta_{axis}" not in signals or encoder in platform.effects:
        return ()
    there = replace(platform, effects=(*platform.effects, encoder))
    rebuilt = _rebuilt(there, effect, axis)
    return (
        replace(
            rebuilt,
            added=(*rebuilt.added, encoder),
            notes=("encoder at the motor", *rebuilt.notes[1:], ""),
            provides=frozenset(
                f"{m}{BEHIND_ENCODER}" if m.startswith(SPLITTING) else m for m in rebuilt.provides
            ),
            of=as_declared.provides,
        ),
    )


def _with_friction_moved(platform: Platform) -> Iterator[Rebuilt]:
    """`platform` with the dry friction behind the shaft or gap that is declared on its axis, where
    it is not said on which side it sits.
    """
    declared = {(e.effect, e.axis) for e in platform.effects}
    for axis in platform.axes:
        there = {f"{mechanism} {axis}" for mechanism in SPLITTING}
        moved = _behind(platform, axis) if there & _mechanisms(platform, declared) else None
        if moved is not None:
            added = tuple(e for e in moved.effects if e not in platform.effects)
            removed = tuple(e for e in platform.effects if e not in moved.effects)
            provides = frozenset({f"friction {axis} at the {BEHIND}"})
            notes = (f"at the {BEHIND}, not at the gear",) * len(added)
            yield Rebuilt(moved, added, removed, ({},), provides, notes)


def _behind(platform: Platform, axis: str | None) -> Platform | None:
    """`platform` with the dry friction of an axis at its joint; None where nothing is moved by
    that, or it is said where friction sits.
    """
    movable = [
        e
        for e in platform.effects
        if e.axis == axis and e.site is None and find_effect(e.effect).sites
    ]
    if not movable:
        return None
    moved = tuple(replace(e, site=BEHIND) if e in movable else e for e in platform.effects)
    return replace(platform, effects=moved)


def _within(declared: ParameterDeclaration, own: Parameter) -> ParameterDeclaration:
    """A declared parameter within the bounds of the effect that owns it now."""

    def inside(value: float | None) -> float | None:
        return None if value is None else min(max(value, own.lower), own.upper)

    return replace(
        declared,
        value=min(max(declared.value, own.lower), own.upper),
        lower=inside(declared.lower),
        upper=inside(declared.upper),
    )


def _mechanisms(platform: Platform, added: set[tuple[str, str | None]]) -> frozenset[str]:
    """What the effects `added` to `platform` bring, by kind and axis: shafts, gaps, what they
    change. A shaft with friction at the joint does not contain one with friction at the gear.
    """
    before = {e.axis: BEFORE for e in platform.effects if e.site == BEHIND}
    found: set[str] = set()
    for effect, place in place_effects(platform):
        if (effect.id, place.axis) in added:
            given = effect.turning_contribution_at(place)
            found |= {f"shaft {s.axis}{before.get(place.axis, '')}" for s in given.shafts}
            found |= {f"play {p.axis}{before.get(place.axis, '')}" for p in given.plays}
            found |= {f"change {name}" for name in given.changes}
            found |= {f"friction {f.axis}" for f in given.frictions}
            found |= {f"torque {rate}" for rate in given.torques}
    return frozenset(found)
