"""Place the declared effects of a platform and check its parameters against them."""

import re
from collections.abc import Iterator, Mapping
from dataclasses import replace

from ptp_symbolic.errors import InputError, did_you_mean, out_of_bounds, unknown
from ptp_symbolic.platform import (
    STANDARD_GRAVITY,
    ParameterDeclaration,
    Platform,
    effect_key,
    naming_file,
)
from ptp_symbolic.platform.units import compatible
from ptp_symbolic.symbolic.derivation.contributions import (
    OFF_AXIS_MASS,
    TORQUES,
    machine_quantities,
    sensors_on,
)
from ptp_symbolic.symbolic.effect_interface.effect import Effect
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effect_interface.place import Place
from ptp_symbolic.symbolic.effects import catalogue

GRAVITY = Parameter("gravity", "m/s^2", STANDARD_GRAVITY, 0.0, 1e3, "gravitational acceleration")


def find_effect(identifier: str) -> Effect:
    """Return the effect `identifier`; raises InputError with the list of choices."""
    for effect in catalogue():
        if effect.id == identifier:
            return effect
    words = {word for word in str(identifier).lower().split("_") if len(word) > 3}
    titled = [
        e for e in catalogue() if words & {*re.findall(r"\w+", e.title.lower())} - {"friction"}
    ]
    known = (effect.id for effect in titled or catalogue())
    raise unknown("effect", identifier, known, listing="`ptp-symbolic effects`")


def _of_kind(effect: Effect, kind: str | None) -> Effect:
    """The `kind` of `effect`, its usual one if None; raises InputError with the list of choices."""
    if kind is None:
        return effect
    kinds = {each.kind: each for each in (effect, *effect.kinds) if each.kind is not None}
    if not kinds:
        raise InputError(f"Effect '{effect.id}' has no kinds; remove kind = \"{kind}\".")
    if kind not in kinds:
        raise InputError(
            f"Effect '{effect.id}' has no kind '{kind}'. Choose one of: {', '.join(kinds)}."
        )
    return kinds[kind]


def place_effects(platform: Platform) -> list[tuple[Effect, Place]]:
    """Return every declared effect with its place, after checking names, units and bounds.

    The order is that of the catalogue, however the platform lists them: the same machine has the
    same equations. Raises InputError, which names the file of the platform where it has one.
    """
    with naming_file(platform):
        placed = _placed(platform)
        _check_needs(platform, placed)
        _check_ownership(placed)
        _check_exclusion(placed)
        _check_parameters(platform, placed)
    return placed


def _placed(platform: Platform) -> list[tuple[Effect, Place]]:
    order = [effect.id for effect in catalogue()]
    found = [(_of_kind(find_effect(d.effect), d.kind), d) for d in platform.effects]
    found.sort(key=lambda pair: order.index(pair[0].id))
    shafts = frozenset(d.axis for e, d in found if e.splits_axis and d.axis is not None)
    turns = any(effect.turns_base for effect, _ in found)
    placed = []
    for effect, declaration in found:
        if effect.on_axis and declaration.axis is None:
            raise InputError(
                f"Effect '{effect.id}' sits on an axis; add axis = \"{platform.axes[0]}\"."
            )
        if not effect.on_axis and declaration.axis is not None:
            raise InputError(
                f"Effect '{effect.id}' is of the whole platform; remove its axis ="
                f' "{declaration.axis}".'
            )
        if declaration.site is not None and declaration.site not in effect.sites:
            raise InputError(
                f"Effect '{effect.id}' has no choice of site; remove its site ="
                f' "{declaration.site}".'
            )
        linear = bool(platform.linear_axes)
        if linear and effect.instead_on_linear:
            raise InputError(
                f"Effect '{effect.id}' makes no sense on a linear joint:"
                f" {effect.instead_on_linear}; remove it."
            )
        place = Place(platform.axes, declaration.axis, declaration.site, shafts, linear, turns)
        placed.append((effect, place))
    return placed


def _check_exclusion(placed: list[tuple[Effect, Place]]) -> None:
    for effect, place in placed:
        excluded = effect.structure.excluded_by if effect.structure else ()
        for other, there in placed:
            if other.id in excluded and there.axis == place.axis:
                raise InputError(
                    f"Effects '{effect.id}' and '{other.id}' exclude each other on axis"
                    f" '{place.axis}'; remove one of them."
                )


def parameters_of(placed: list[tuple[Effect, Place]]) -> dict[str, Parameter]:
    """Return gravity and the parameters of the placed effects by name, effects first."""
    return {**_of_effects(placed), GRAVITY.name: GRAVITY}


def _of_effects(placed: list[tuple[Effect, Place]]) -> dict[str, Parameter]:
    return {p.name: p for effect, place in placed for p in effect.parameters_at(place)}


def undeclared_parameters(platform: Platform) -> tuple[Parameter, ...]:
    """Parameters of the declared effects that `platform` leaves at the catalogue's default."""
    said = {declaration.name for declaration in platform.parameters}
    own = _of_effects(place_effects(platform))
    return tuple(parameter for name, parameter in own.items() if name not in said)


def refuse_undeclared(platform: Platform) -> None:
    """Raise InputError where `platform` leaves out a parameter that has no natural default (see
    `Parameter`): its value is known of one machine, never of another.
    """
    left = [p for p in undeclared_parameters(platform) if not p.has_natural_default]
    if not left:
        return
    named = ", ".join(f"{p.name} in {p.unit} ({p.meaning})" for p in left)
    first = left[0]
    with naming_file(platform):
        raise InputError(
            f"Not declared, and without a natural default: {named}. Declare each under"
            f' [parameters], as in {first.name} = {{ value = NUMBER, unit = "{first.unit}" }}, or'
            " with start in place of value where it is to be fitted."
        )


def resolved_parameters(
    platform: Platform, placed: list[tuple[Effect, Place]]
) -> dict[str, Parameter]:
    """Return gravity and the parameters of the placed effects, values and bounds as `platform`
    declares.
    """
    declarations = {d.name: d for d in platform.parameters}
    own = parameters_of(placed)
    own[GRAVITY.name] = replace(GRAVITY, default=platform.gravity)
    return {name: _declared(parameter, declarations) for name, parameter in own.items()}


def _declared(parameter: Parameter, declarations: dict[str, ParameterDeclaration]) -> Parameter:
    declaration = declarations.get(parameter.name)
    if declaration is None:
        return parameter
    source = declarations.get(declaration.same_as or "", declaration)
    lower = parameter.lower if declaration.lower is None else declaration.lower
    upper = parameter.upper if declaration.upper is None else declaration.upper
    return replace(parameter, default=source.value, lower=lower, upper=upper)


def available_quantities(placed: list[tuple[Effect, Place]]) -> set[str]:
    """Names of the quantities that the placed effects define, and of the machine's own."""
    added = [effect.turning_contribution_at(place) for effect, place in placed]
    axes = {axis for _, place in placed for axis in place.axes}
    return {name for own in added for name in own.quantities} | machine_quantities(axes, added)


def definitions(placed: list[tuple[Effect, Place]]) -> dict[str, set[str]]:
    """The quantities that every placed effect defines, by its key."""
    added = {
        effect_key(effect.id, place.axis): effect.turning_contribution_at(place)
        for effect, place in placed
    }
    return {
        key: {*own.quantities, *({OFF_AXIS_MASS} & machine_quantities((), (own,)))}
        for key, own in added.items()
    }


def acts_on(effect: Effect, place: Place, defined: Mapping[str, set[str]]) -> tuple[str, ...]:
    """Keys of the placed effects that define a quantity which `effect` at `place` needs; `defined`
    are their `definitions`.
    """
    needs = {need.format(axis=place.axis) for need in effect.needs}
    return tuple(key for key, names in defined.items() if needs & names)


def effects_that_define(quantity: str, axes: tuple[str, ...], linear: bool = False) -> list[str]:
    """Ids of the effects that define `quantity` on a machine with these axes, linear or not."""
    added = [(e, e.turning_contribution_at(place)) for e, place in _everywhere(axes, linear)]
    if quantity != OFF_AXIS_MASS:
        return [effect.id for effect, own in added if quantity in own.quantities]
    bodies = [own for _, own in added if own.bodies and not machine_quantities((), (own,))]
    return [e.id for e, own in added if quantity in machine_quantities((), (*bodies, own))]


def _everywhere(axes: tuple[str, ...], linear: bool) -> Iterator[tuple[Effect, Place]]:
    """Every effect of the catalogue at its places on a machine with these axes."""
    for effect in catalogue():
        if not (linear and effect.instead_on_linear):
            for axis in axes if effect.on_axis else (None,):
                yield effect, Place(axes, axis, None, frozenset(), linear)


def readings(platform: Platform, placed: list[tuple[Effect, Place]]) -> set[str]:
    """Quantities of what the declared outputs beside the angles show; gravity and a moving base
    act on an accelerometer as on a mass off the axes.
    """
    added = [effect.contribution_at(place) for effect, place in placed]
    sensors = sensors_on(platform.axes, added, platform.linear_axes)
    declared = {s.signal for s in platform.signals}
    known = {s.name for s in sensors} | {state.name for c in added for state in c.states}
    read = {str(q) for s in sensors if s.name in declared for q in s.value.free_symbols}
    heavy = {OFF_AXIS_MASS} if any("specific_force" in name for name in read) else set()
    return {f"reading_{name}" for name in declared & known} | heavy


def _check_needs(platform: Platform, placed: list[tuple[Effect, Place]]) -> None:
    available = available_quantities(placed) | readings(platform, placed)
    for effect, place in placed:
        for need in effect.needs:
            name = need.format(axis=place.axis)
            if name not in available and name.startswith("reading_"):
                signal = name.removeprefix("reading_")
                raise InputError(
                    f"Effect '{effect.id}' of kind '{effect.kind}' filters '{signal}', which is no"
                    f" output of the machine; declare [signals.{signal}] and what it measures, or"
                    " remove it."
                )
            if name not in available:
                bringing = " or ".join(effects_that_define(name, place.axes, place.linear))
                on_axis = "" if place.axis is None else f" on axis '{place.axis}'"
                if name in (own.format(axis=place.axis) for own in TORQUES):
                    raise InputError(
                        f"Effect '{effect.id}' acts on the torque input of axis '{place.axis}',"
                        " which a motor or a prescribed motion replaces; remove one of them."
                    )
                next_step = (
                    f"declare {bringing}{on_axis} too, or remove it"
                    if bringing
                    else f"no effect does on a platform of {' and '.join(place.axes)}; remove it"
                )
                if name == OFF_AXIS_MASS:
                    raise InputError(
                        f"Effect '{effect.id}' has no effect: no declared body has a mass off its"
                        f" axis; {next_step}."
                    )
                raise InputError(
                    f"Effect '{effect.id}' acts on '{name}', which no declared effect"
                    f" defines; {next_step}."
                )


def _check_ownership(placed: list[tuple[Effect, Place]]) -> None:
    """Refuse what would count twice: one effect declared again, or two that share parameters."""
    owners: dict[str, Effect] = {}
    for effect, place in placed:
        for parameter in effect.parameters_at(place):
            other = owners.setdefault(parameter.name, effect)
            if other is not effect:
                raise InputError(
                    f"Effects '{other.id}' and '{effect.id}' both describe {parameter.name};"
                    " declare one of them."
                )
        again = [p for e, p in placed if e is effect and p.axis == place.axis]
        if len(again) > 1:
            where = "" if place.axis is None else f" on axis '{place.axis}'"
            raise InputError(f"Effect '{effect.id}'{where} is declared twice; remove one.")


def _check_parameters(platform: Platform, placed: list[tuple[Effect, Place]]) -> None:
    own = parameters_of(placed)
    for declaration in platform.parameters:
        parameter = own.get(declaration.name)
        if parameter is None:
            raise InputError(_no_owner(declaration.name, platform, own))
        if declaration.unit is not None and not compatible(declaration.unit, parameter.unit):
            raise InputError(
                f"Parameter '{declaration.name}' has unit '{declaration.unit}';"
                f" give it in '{parameter.unit}'."
            )
        value = declaration.value
        if not parameter.lower <= value <= parameter.upper:
            bounds = (parameter.lower, parameter.upper)
            raise out_of_bounds(declaration.name, value, parameter.unit, *bounds)
        ends = (declaration.lower, declaration.upper)
        for end in (each for each in ends if each is not None):
            if not parameter.lower <= end <= parameter.upper:
                raise InputError(
                    f"Parameter '{declaration.name}' has a bound of {end:g} {parameter.unit}, which"
                    f" it cannot have: it lies within [{parameter.lower:g}, {parameter.upper:g}]"
                    f" {parameter.unit}; change the bound."
                )


def _no_owner(name: str, platform: Platform, own: dict[str, Parameter]) -> str:
    """What to say of a parameter that no declared effect has, though another may have it, or the
    same one on other axes.
    """
    elsewhere = {p.name for d in platform.effects for p in find_effect(d.effect).parameters}
    idle = [p.name for p in platform.parameters if p.name in elsewhere and p.name not in own]
    owners = [
        effect.id
        for effect, place in _everywhere(platform.axes, bool(platform.linear_axes))
        if name in {p.name for p in effect.parameters_at(place)}
    ]
    guess = f": it is of {' or '.join(owners)}; declare one." if owners else did_you_mean(name, own)
    if name in idle:
        guess = f": nothing depends on {', '.join(idle)} on {' and '.join(platform.axes)}; remove."
    known = ", ".join(own)
    return f"Parameter '{name}' belongs to no declared effect{guess or '.'} Known here: {known}."
