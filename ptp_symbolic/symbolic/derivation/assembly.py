"""Assemble a declared platform: place its effects, resolve quantities, derive the equations."""

from collections.abc import Sequence
from dataclasses import replace

import sympy as sp

from ptp_symbolic.platform import Platform
from ptp_symbolic.symbolic.derivation.equations import Equations, PlacedEffect
from ptp_symbolic.symbolic.derivation.friction import Mechanics, driving_torque, resolved_frictions
from ptp_symbolic.symbolic.derivation.lagrange import lagrange
from ptp_symbolic.symbolic.derivation.ledger import energy_ledger
from ptp_symbolic.symbolic.derivation.parts import (
    BASE_ACCELERATION,
    GRAVITY_QUANTITIES,
    Parts,
    collect,
)
from ptp_symbolic.symbolic.derivation.placement import acts_on, place_effects, resolved_parameters
from ptp_symbolic.symbolic.derivation.prescribed import constraint_power, reduced, released
from ptp_symbolic.symbolic.derivation.rigid_play import rigid_contact
from ptp_symbolic.symbolic.derivation.transmission import Transmission, transmission
from ptp_symbolic.symbolic.effects.conditions import Limit
from ptp_symbolic.symbolic.effects.effect import Input, Sampler, State
from ptp_symbolic.symbolic.effects.effect import quantity as quantity_symbol
from ptp_symbolic.symbolic.mechanics import kinematics
from ptp_symbolic.symbolic.mechanics.bodies import RigidConfiguration, RigidEquations
from ptp_symbolic.symbolic.mechanics.kinematics import TIME
from ptp_symbolic.symbolic.parameters import Parameter


def assemble(platform: Platform) -> Equations:
    """Return the equations of `platform`.

    Raises InputError for an unknown effect, a parameter that no effect declares, a wrong unit or
    a value outside the bounds of its effect; ValueError for an effect whose states share a name
    with others, or whose expressions hold a symbol that nothing defines.
    """
    placed = place_effects(platform)
    parts = released(collect(platform.axes, placed))
    transmissions = [transmission(shaft, parts) for shaft in parts.shafts]
    parts = _with_shaft_torques(parts, transmissions)
    rigid = _rigid_configuration(platform, parts)
    rigid_equations = lagrange(rigid)
    full = _mechanics(platform, parts, transmissions, rigid_equations)
    mechanics, rigid_equations = reduced(full, rigid_equations, parts.prescribed)
    contacts = [t.contact for t in transmissions if t.contact is not None]
    contacts += [rigid_contact(play, parts, mechanics) for play in parts.plays]
    frictions, loads = resolved_frictions(parts, mechanics)
    inputs = _inputs(platform, parts)
    ledger = energy_ledger(
        platform.axes, parts, frictions, [t.ledger for t in transmissions], rigid_equations
    )
    power = constraint_power(full, mechanics, frictions, parts.prescribed)
    equations = Equations(
        name=platform.name,
        title=platform.title,
        axes=platform.axes,
        coordinates=mechanics.coordinates,
        rates=mechanics.rates,
        mass_matrix=mechanics.mass,
        forcing=mechanics.forcing,
        terms=(*parts.terms.items(), *loads),
        extra_states=_extra_states(parts, (*mechanics.coordinates, *mechanics.rates)),
        samplers=_samplers(parts),
        inputs=tuple(given for given, _ in inputs),
        delays=tuple(_delay_of(axis, parts) for _, axis in inputs),
        parameters=(),
        frictions=frictions,
        contacts=tuple(contacts),
        outputs=_outputs(platform, parts),
        limits=_limits(parts),
        requirements=tuple(r for effect, place in placed for r in effect.requires(place)),
        ledger=replace(ledger, power_in=ledger.power_in + power),
        effects=tuple(
            PlacedEffect(e, p.axis, tuple(q.name for q in e.parameters(p)), acts_on(e, p, placed))
            for e, p in placed
        ),
        rigid=rigid,
        rigid_equations=rigid_equations,
    )
    return _with_parameters(equations, resolved_parameters(platform, placed))


def _with_shaft_torques(parts: Parts, transmissions: Sequence[Transmission]) -> Parts:
    """`parts` in which the torque of every shaft is a quantity."""
    torques = {
        quantity_symbol(f"shaft_torque_{s.axis}"): t.transmitted
        for s, t in zip(parts.shafts, transmissions, strict=True)
    }
    return replace(parts, values={**parts.values, **torques})


def _limits(parts: Parts) -> tuple[Limit, ...]:
    return tuple(
        Limit(own.state, parts.resolve(own.lower), parts.resolve(own.upper), own.meaning)
        for contribution in parts.contributions
        for own in contribution.limits
    )


def _mechanics(
    platform: Platform,
    parts: Parts,
    transmissions: Sequence[Transmission],
    rigid: RigidEquations,
) -> Mechanics:
    """Add drives, shafts, torques and potentials of the effects to the rigid equations."""
    joints, gears = platform.axes, parts.split_axes
    coordinates = (*map(kinematics.angle, joints), *map(kinematics.gear_angle, gears))
    rates = (*map(kinematics.rate, joints), *map(kinematics.gear_rate, gears))
    mass = sp.diag(rigid.mass_matrix, sp.zeros(len(gears)))
    forcing = sp.Matrix([*rigid.forcing, *([0] * len(gears))])
    row = {symbol: index for index, symbol in enumerate(rates)}
    free = [axis for axis in joints if axis not in parts.driven]
    torques = [(kinematics.rate(axis), kinematics.torque(axis)) for axis in free]
    torques += [torque for t in transmissions for torque in t.torques]
    torques += [torque for c in parts.contributions for torque in c.torques.items()]
    for drive in parts.drives:
        rate = parts.drive_rate(drive)
        inertia = parts.resolve(drive.inertia)
        mass[row[rate], row[rate]] += inertia
        torques.append((rate, driving_torque(drive, parts, coordinates[row[rate]])))
    for symbol, torque in torques:
        forcing[row[symbol]] += parts.resolve(torque)
    potential = parts.resolve(sum((c.potential for c in parts.contributions), sp.Integer(0)))
    for index, coordinate in enumerate(coordinates):
        forcing[index] -= sp.diff(potential, coordinate)
    mass = mass.applyfunc(parts.resolve)
    return Mechanics(coordinates, rates, sp.ImmutableMatrix(mass), sp.ImmutableMatrix(forcing))


def _rigid_configuration(platform: Platform, parts: Parts) -> RigidConfiguration:
    """Bodies, and gravity in the base frame less the acceleration of the base."""
    tilt, azimuth = (parts.resolve(quantity_symbol(name)) for name in GRAVITY_QUANTITIES)
    moved = [parts.resolve(quantity_symbol(name)) for name in BASE_ACCELERATION]
    g = sp.Rational(repr(platform.gravity))
    direction = [
        sp.sin(tilt) * sp.cos(azimuth),
        sp.sin(tilt) * sp.sin(azimuth),
        -sp.cos(tilt),
    ]
    bodies = tuple(
        replace(
            body,
            mass=parts.resolve(body.mass),
            com=body.com.applyfunc(parts.resolve),
            inertia=body.inertia.applyfunc(parts.resolve),
        )
        for contribution in parts.contributions
        for body in contribution.bodies
    )
    gravity = [g * d - a for d, a in zip(direction, moved, strict=True)]
    return RigidConfiguration(platform.axes, bodies, sp.ImmutableMatrix(gravity))


def _inputs(platform: Platform, parts: Parts) -> list[tuple[Input, str]]:
    """The inputs, each with its axis: of what commands or drives it, else the joint's torque."""
    drives = {drive.axis: drive.inputs for drive in parts.drives}
    drives |= {str(w).removeprefix("omega_"): (given,) for w, given in parts.prescribed.items()}
    for contribution in parts.contributions:
        drives |= contribution.commands
    inputs = []
    for axis in platform.axes:
        own = Input(str(kinematics.torque(axis)), "N m", f"torque on the {axis} joint")
        inputs += [(given, axis) for given in drives.get(axis, (own,))]
    return inputs


def _delay_of(axis: str, parts: Parts) -> sp.Symbol | None:
    return next((c.delays[axis] for c in parts.contributions if axis in c.delays), None)


def _extra_states(parts: Parts, coordinates: Sequence[sp.Symbol]) -> tuple[State, ...]:
    states = [state for contribution in parts.contributions for state in contribution.states]
    taken = {str(symbol) for symbol in coordinates}
    for state in states:
        if state.name in taken:
            raise ValueError(
                f"State '{state.name}' ({state.meaning}) has the name of another state; put its"
                " effect and axis into its name."
            )
        taken.add(state.name)
    return tuple(replace(s, derivative=parts.resolve(s.derivative)) for s in states)


def _samplers(parts: Parts) -> tuple[Sampler, ...]:
    return tuple(
        Sampler(
            parts.resolve(own.period),
            {symbol: parts.resolve(value) for symbol, value in own.updates.items()},
            parts.resolve(own.offset),
            parts.resolve(own.phase),
            {symbol: parts.resolve(term) for symbol, term in own.terms.items()},
        )
        for contribution in parts.contributions
        for own in contribution.samplers
    )


def _outputs(platform: Platform, parts: Parts) -> tuple[tuple[str, str, sp.Expr], ...]:
    """Measured signals: joint angles, then extra states, as their sensors show them."""
    signals = {str(kinematics.angle(axis)): "rad" for axis in platform.axes}
    for contribution in parts.contributions:
        signals.update({state.name: state.unit for state in contribution.states})
    return tuple(
        (name, unit, parts.resolve(quantity_symbol(f"reading_{name}")))
        for name, unit in signals.items()
    )


def _with_parameters(equations: Equations, declared: dict[str, Parameter]) -> Equations:
    """Attach the parameters that the equations use, in the order of the effects."""
    used: set[sp.Symbol] = set(equations.mass_matrix.free_symbols | equations.forcing.free_symbols)
    for _, expression in equations.terms:
        used |= expression.free_symbols
    for friction in equations.frictions:
        used |= friction.level.free_symbols | friction.breakaway.free_symbols
    for contact in equations.contacts:
        used |= contact.half_gap.free_symbols | contact.torque.free_symbols
        used |= set() if contact.restitution is None else contact.restitution.free_symbols
    for state in equations.extra_states:
        used |= state.derivative.free_symbols
    for sampler in equations.samplers:
        for expression in (
            sampler.period,
            sampler.offset,
            sampler.phase,
            *sampler.updates.values(),
            *sampler.terms.values(),
        ):
            used |= expression.free_symbols
    for _, _, expression in equations.outputs:
        used |= expression.free_symbols
    for limit in equations.limits:
        used |= limit.lower.free_symbols | limit.upper.free_symbols
    for power in (equations.ledger.stored, equations.ledger.power_in, equations.ledger.dissipated):
        used |= power.free_symbols
    used |= {delay for delay in equations.delays if delay is not None}
    names = {str(symbol) for symbol in used}
    _refuse_undefined(equations, names - declared.keys())
    parameters = tuple(p for name, p in declared.items() if name in names)
    requirements = tuple(r for r in equations.requirements if r.holds.free_symbols <= used)
    return replace(equations, parameters=parameters, requirements=requirements)


def _refuse_undefined(equations: Equations, names: set[str]) -> None:
    """Refuse `names` that are no parameters, where they are not variables of the machine either."""
    variables = {*equations.state_symbols, *equations.mode_symbols, TIME}
    variables |= {symbol for symbol, _ in equations.terms}
    variables |= {symbol for sampler in equations.samplers for symbol in sampler.terms}
    variables |= {symbol for friction in equations.frictions for symbol in friction.terms}
    known = {str(symbol) for symbol in variables} | {given.name for given in equations.inputs}
    if unknown := sorted(names - known):
        raise ValueError(
            f"Nothing defines {', '.join(unknown)}: declare it as a parameter of its effect, or"
            " mend its name."
        )
