"""The loop above both wings: emit a declared machine and its candidates, extend it."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

from ptp_symbolic.derivation.admissible import refuse_impossible
from ptp_symbolic.derivation.assembly import assemble
from ptp_symbolic.derivation.placement import (
    available_quantities,
    declared_parameters,
    place_effects,
)
from ptp_symbolic.effects import EFFECTS
from ptp_symbolic.errors import unknown
from ptp_symbolic.identify.coordinates import FreeParameter, free_parameter
from ptp_symbolic.module_cache import emitted
from ptp_symbolic.platform import EffectDeclaration, ParameterDeclaration, Platform, naming_file
from ptp_symbolic.runtime.loader import load_module
from ptp_symbolic.runtime.model import Model


def emit(platform: Platform) -> Model:
    """Derive, emit and load the model of `platform`; modules are kept by their mathematics.

    Machines that differ in their numbers alone share a module, which is compiled once. Raises
    InputError when no machine with its parameters can exist.
    """
    equations = assemble(platform)
    refuse_impossible(equations, platform)
    path = emitted(equations, declared_parameters(place_effects(platform)))
    own = {p.name: (p.default, p.lower, p.upper) for p in equations.parameters}
    return replace(load_module(path, path.stem), declared=(platform.name, platform.title, own))


def candidate_effects(platform: Platform) -> tuple[EffectDeclaration, ...]:
    """Effects that could be added to `platform`: searchable, not declared, with what they need,
    which may itself be one of them.
    """
    declared = {(effect.id, place.axis) for effect, place in place_effects(platform)}
    order = {effect.id: number for number, effect in enumerate(EFFECTS)}
    found: list[EffectDeclaration] = []
    while True:
        extended = replace(platform, effects=(*platform.effects, *found))
        available = available_quantities(place_effects(extended))
        added = [
            EffectDeclaration(effect.id, axis, None)
            for effect in EFFECTS
            for axis in (platform.axes if effect.on_axis else (None,))
            if not effect.structural
            and (effect.id, axis) not in declared | {(e.effect, e.axis) for e in found}
            and {need.format(axis=axis) for need in effect.needs} <= available
        ]
        if not added:
            return tuple(sorted(found, key=lambda e: order[e.effect]))
        found += added


def with_candidates(platform: Platform) -> Platform:
    """`platform` with every candidate effect added."""
    return replace(platform, effects=(*platform.effects, *candidate_effects(platform)))


def torque_driven(platform: Platform) -> Platform:
    """`platform` with torques on its joints: without motors, shafts, and what acts on those alone.

    Friction at the gear output then acts on the joint.
    """
    kept = []
    for effect, place in place_effects(platform):
        added = effect.contribute(place)
        if not (added.drives or added.shafts or added.plays or added.prescribed):
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
    own = {p.name for effect, place in kept for p in effect.parameters(place)}
    return replace(
        platform,
        effects=tuple(EffectDeclaration(e.id, place.axis, place.site) for e, place in kept),
        parameters=tuple(p for p in platform.parameters if p.name in own),
    )


def free_parameters(platform: Platform, model: Model) -> tuple[FreeParameter, ...]:
    """The parameters that `platform` leaves to be fitted, as far as `model` has them."""
    own = {p.name: p for p in model.parameters}
    ties: dict[str, list[str]] = {}
    for declaration in platform.parameters:
        if declaration.same_as is not None and declaration.name in own:
            ties.setdefault(declaration.same_as, []).append(declaration.name)
    return tuple(
        replace(
            free_parameter(
                d.name,
                d.value,
                own[d.name].lower if d.lower is None else d.lower,
                own[d.name].upper if d.upper is None else d.upper,
                own[d.name].period,
                tuple(ties.get(d.name, ())),
            ),
            table=d.value,
        )
        for d in platform.parameters
        if d.free and d.name in own
    )


def known_values(platform: Platform, model: Model) -> dict[str, tuple[float, float | None]]:
    """Values of the parameters that `platform` declares as known and `model` has, each with the
    most by which it may be off, where the platform says so.
    """
    own = set(model.parameter_names)
    return {
        d.name: (d.value, d.uncertainty)
        for d in platform.parameters
        if not d.free and d.same_as is None and d.name in own
    }


def refuse_unknown_signals(platform: Platform, model: Model) -> None:
    """Raise InputError for a signal of `platform` that `model` does not have.

    An input more than the model takes is let be, unless one that it takes is missing.
    """
    inputs, outputs = (
        [s.signal for s in platform.signals if s.role == r] for r in ("input", "output")
    )
    complete = set(model.input_names) <= set(inputs)
    with naming_file(platform):
        for role, given, known in (
            ("input", () if complete else inputs, model.input_names),
            ("output", outputs, model.output_names),
        ):
            for name in given:
                if name not in known:
                    raise unknown(f"{role} signal", name, known)


def extended(
    platform: Platform,
    added: Sequence[EffectDeclaration],
    values: Mapping[str, float],
    fitted: Sequence[ParameterDeclaration],
) -> Platform:
    """`platform` with effects and fitted parameters added; `values` are the new starts."""
    kept = []
    replaced = {p.name for p in fitted}
    for declaration in platform.parameters:
        if declaration.name in replaced:
            continue
        value = values.get(declaration.name, declaration.value)
        kept.append(replace(declaration, value=value))
    return replace(platform, effects=(*platform.effects, *added), parameters=(*kept, *fitted))
