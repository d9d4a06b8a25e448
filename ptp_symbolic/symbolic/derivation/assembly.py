"""Assemble a declared platform: place its effects, resolve quantities, derive the equations."""

import keyword
from collections.abc import Sequence
from dataclasses import replace

import sympy as sp

from ptp_symbolic.platform import Platform
from ptp_symbolic.symbolic.derivation.contributions import Contributions
from ptp_symbolic.symbolic.derivation.equations import Equations, PlacedEffect
from ptp_symbolic.symbolic.derivation.ledger import energy_ledger
from ptp_symbolic.symbolic.derivation.machine import machine
from ptp_symbolic.symbolic.derivation.placement import acts_on, definitions, resolved_parameters
from ptp_symbolic.symbolic.effect_interface.conditions import Limit
from ptp_symbolic.symbolic.effect_interface.contribution import Input, Sampler, State, Switch
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effect_interface.place import quantity as quantity_symbol
from ptp_symbolic.symbolic.effect_interface.place import quantity_name
from ptp_symbolic.symbolic.mechanics import kinematics
from ptp_symbolic.symbolic.mechanics.kinematics import TIME
from ptp_symbolic.symbolic.symbols import ZERO

# names that emitted modules need for themselves
RESERVED = frozenset(
    ["t", "x", "u", "p", "m", "c", "g", "y", "z", "e", "r", "dx", "forces", "np", "math", "float32"]
)
RESERVED_PREFIXES = (
    *("mass_", "force_", "accel_", "inverse_", "slide_", "side_", "active_", "rate_of_"),
    *("given_", "balance_"),
)


def assemble(platform: Platform) -> Equations:
    """Return the equations of `platform`.

    Raises InputError for an unknown effect, a parameter that no effect declares, a wrong unit or a
    value out of bounds; ValueError for states of one name, and symbols that nothing defines.
    """
    parts = machine(platform)
    placed, contributions, mechanics = parts.placed, parts.contributions, parts.mechanics
    defined = definitions(placed)
    inputs = _inputs(platform, contributions)
    ledger = energy_ledger(
        platform.axes,
        contributions,
        parts.frictions,
        [t.ledger for t in parts.transmissions],
        replace(
            parts.rigid_equations,
            kinetic=parts.rigid_equations.kinetic.xreplace(parts.base.at_rest),
            potential=parts.rigid_equations.potential.xreplace(parts.base.at_rest),
        ),
    )
    outside = (*parts.constraint_torques.items(), *parts.base.torques.items())
    power = sum((torque * rate for rate, torque in outside), ZERO)
    equations = Equations(
        name=platform.name,
        title=platform.title,
        axes=platform.axes,
        coordinates=mechanics.coordinates,
        rates=mechanics.rates,
        mass_matrix=mechanics.mass,
        forcing=mechanics.forcing,
        terms=(*parts.base.terms.items(), *contributions.terms.items(), *parts.loads),
        extra_states=_extra_states(contributions, (*mechanics.coordinates, *mechanics.rates)),
        samplers=_samplers(contributions),
        inputs=tuple(given for given, _ in inputs),
        delays=tuple(_delay_of(axis, contributions) for _, axis in inputs),
        parameters=(),
        frictions=parts.frictions,
        contacts=parts.contacts,
        switches=_switches(contributions),
        outputs=_outputs(platform, contributions),
        quantities=_quantities(contributions),
        limits=_limits(contributions),
        requirements=tuple(r for effect, place in placed for r in effect.requires(place)),
        ledger=replace(ledger, power_in=ledger.power_in + power),
        effects=tuple(
            PlacedEffect(
                effect.worded_at(place),
                place.axis,
                tuple(parameter.name for parameter in effect.parameters_at(place)),
                acts_on(effect, place, defined),
                tuple(state.name for state in own.states),
            )
            for (effect, place), own in zip(placed, contributions.by_effect, strict=True)
        ),
        rigid=parts.rigid,
        rigid_equations=parts.rigid_equations,
    )
    equations = _with_parameters(equations, resolved_parameters(platform, placed))
    _refuse_reserved_names(equations)
    return equations


def _switches(contributions: Contributions) -> tuple[Switch, ...]:
    return tuple(
        Switch(own.name, *map(contributions.resolve, (own.deviation, own.threshold, own.drive)))
        for own in contributions.switches
    )


def _limits(contributions: Contributions) -> tuple[Limit, ...]:
    return tuple(
        Limit(
            own.state,
            contributions.resolve(own.lower),
            contributions.resolve(own.upper),
            own.meaning,
        )
        for contribution in contributions.by_effect
        for own in contribution.limits
    )


def _inputs(platform: Platform, contributions: Contributions) -> list[tuple[Input, str | None]]:
    """The inputs, each with its axis: of what commands or drives it, else the joint's torque; then
    those that drive none.
    """
    drives = {drive.axis: drive.inputs for drive in contributions.drives}
    drives |= {kinematics.place_of(w): (given,) for w, given in contributions.prescribed.items()}
    for contribution in contributions.by_effect:
        drives |= contribution.commands
    inputs: list[tuple[Input, str | None]] = []
    for axis in platform.axes:
        own = _own_input(axis, axis in platform.linear_axes)
        inputs += [(given, axis) for given in drives.get(axis, (own,))]
    return inputs + [(given, None) for c in contributions.by_effect for given in c.inputs]


def _own_input(axis: str, linear: bool) -> Input:
    """What acts on a joint without a drive: a torque, a force on a linear one."""
    unit, word = ("N", "force") if linear else ("N m", "torque")
    return Input(str(kinematics.torque(axis)), unit, f"{word} on the {axis} joint")


def _delay_of(axis: str | None, contributions: Contributions) -> sp.Symbol | None:
    delays = (d for c in contributions.by_effect for on, d in c.delays.items() if on == axis)
    return next(delays, None)


def _extra_states(
    contributions: Contributions, coordinates: Sequence[sp.Symbol]
) -> tuple[State, ...]:
    states = [state for contribution in contributions.by_effect for state in contribution.states]
    taken = {str(symbol) for symbol in coordinates}
    for state in states:
        if state.name in taken:
            raise ValueError(
                f"State '{state.name}' ({state.meaning}) has the name of another state; put its"
                " effect and axis into its name."
            )
        taken.add(state.name)
    return tuple(replace(s, derivative=contributions.resolve(s.derivative)) for s in states)


def _quantities(contributions: Contributions) -> tuple[tuple[str, sp.Expr], ...]:
    """Quantities that are more than a number or a symbol, the last defined first: those of shafts
    are nearest to the equations.
    """
    named = {quantity_name(s): contributions.resolve(s) for s in reversed(contributions.values)}
    return tuple((name, e) for name, e in named.items() if not (e.is_Symbol or e.is_number))


def _samplers(contributions: Contributions) -> tuple[Sampler, ...]:
    return tuple(
        Sampler(
            contributions.resolve(own.period),
            {symbol: contributions.resolve(value) for symbol, value in own.updates.items()},
            contributions.resolve(own.offset),
            contributions.resolve(own.phase),
            {symbol: contributions.resolve(term) for symbol, term in own.terms.items()},
        )
        for contribution in contributions.by_effect
        for own in contribution.samplers
    )


def _outputs(
    platform: Platform, contributions: Contributions
) -> tuple[tuple[str, str, sp.Expr], ...]:
    """Measured signals, as their sensors show them: joint angles, extra states, and what else the
    platform declares.
    """
    signals = {
        str(kinematics.angle(axis)): "m" if axis in platform.linear_axes else "rad"
        for axis in platform.axes
    }
    for contribution in contributions.by_effect:
        signals.update({state.name: state.unit for state in contribution.states})
    signals.update({sensor.name: sensor.unit for sensor in contributions.sensors})
    return tuple(
        (name, unit, contributions.resolve(quantity_symbol(f"reading_{name}")))
        for name, unit in signals.items()
    )


def _with_parameters(equations: Equations, declared: dict[str, Parameter]) -> Equations:
    """Attach the parameters that the equations use, in the order of the effects."""
    used = {symbol for e in equations.expressions() for symbol in e.free_symbols}
    names = {str(symbol) for symbol in used}
    _refuse_undefined(equations, names - declared.keys())
    parameters = tuple(p for name, p in declared.items() if name in names)
    requirements = tuple(r for r in equations.requirements if r.holds.free_symbols <= used)
    return replace(equations, parameters=parameters, requirements=requirements)


def _refuse_undefined(equations: Equations, names: set[str]) -> None:
    """Refuse `names` that are no parameters, where they are not variables of the machine either."""
    variables = {*equations.state_symbols, *equations.mode_symbols, TIME}
    variables |= {symbol for symbol, _ in equations.terms}
    variables |= {kinematics.acceleration(axis) for axis in equations.axes}
    variables |= {symbol for sampler in equations.samplers for symbol in sampler.terms}
    variables |= {symbol for friction in equations.frictions for symbol in friction.terms}
    known = {str(symbol) for symbol in variables} | {given.name for given in equations.inputs}
    if unknown := sorted(names - known):
        raise ValueError(
            f"Nothing defines {', '.join(unknown)}: declare it as a parameter of its effect, or"
            " mend its name."
        )


def _refuse_reserved_names(equations: Equations) -> None:
    """Raise ValueError for a parameter, state, input or named function whose name is none, or
    that of a variable or an intermediate result of the emitted modules.
    """
    named = [("Parameter", p.name) for p in equations.parameters]
    named += [("State", state.name) for state in equations.extra_states]
    named += [("Input", given.name) for given in equations.inputs]
    named += [("Named function", str(symbol)) for symbol, _ in equations.terms]
    for what, name in named:
        if not (name.isidentifier() and name.isascii()) or keyword.iskeyword(name):
            raise ValueError(f"{what} '{name}' has no valid name: use letters, digits and _.")
        if name in RESERVED or name.startswith(RESERVED_PREFIXES):
            raise ValueError(
                f"{what} '{name}' has a name that emitted modules use for themselves; put its"
                " meaning first."
            )
