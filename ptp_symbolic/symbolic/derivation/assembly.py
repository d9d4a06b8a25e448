"""Assemble a declared platform: place its effects, resolve quantities, derive the equations."""

from collections.abc import Sequence
from dataclasses import replace

import sympy as sp

from ptp_symbolic.platform import Platform
from ptp_symbolic.symbolic.derivation.contributions import (
    AXIS_OFFSET,
    BASE_ACCELERATION,
    GRAVITY_QUANTITIES,
    Contributions,
    collect,
)
from ptp_symbolic.symbolic.derivation.equations import Equations, PlacedEffect
from ptp_symbolic.symbolic.derivation.friction import Mechanics, driving_torque, resolved_frictions
from ptp_symbolic.symbolic.derivation.lagrange import lagrange
from ptp_symbolic.symbolic.derivation.ledger import energy_ledger
from ptp_symbolic.symbolic.derivation.placement import (
    GRAVITY,
    acts_on,
    definitions,
    place_effects,
    resolved_parameters,
)
from ptp_symbolic.symbolic.derivation.prescribed import constraint_power, reduced, released
from ptp_symbolic.symbolic.derivation.reserved_names import refuse_reserved_names
from ptp_symbolic.symbolic.derivation.rigid_play import rigid_contact
from ptp_symbolic.symbolic.derivation.transmission import Transmission, transmission
from ptp_symbolic.symbolic.effect_interface.conditions import Limit
from ptp_symbolic.symbolic.effect_interface.contribution import Input, Sampler, State, Switch
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effect_interface.place import quantity as quantity_symbol
from ptp_symbolic.symbolic.effect_interface.place import quantity_name
from ptp_symbolic.symbolic.mechanics import kinematics
from ptp_symbolic.symbolic.mechanics.bodies import RigidConfiguration, RigidEquations
from ptp_symbolic.symbolic.mechanics.kinematics import TIME
from ptp_symbolic.symbolic.symbols import ZERO


def assemble(platform: Platform) -> Equations:
    """Return the equations of `platform`.

    Raises InputError for an unknown effect, a parameter that no effect declares, a wrong unit or a
    value out of bounds; ValueError for states of one name, and symbols that nothing defines.
    """
    placed = place_effects(platform)
    defined = definitions(placed)
    measured = {s.signal for s in platform.signals if s.role == "output"}
    contributions = released(collect(platform.axes, placed, measured))
    transmissions = [transmission(shaft, contributions) for shaft in contributions.shafts]
    contributions = _with_twists(contributions, transmissions)
    rigid = _rigid_configuration(platform, contributions)
    rigid_equations = lagrange(rigid)
    full = _mechanics(platform, contributions, transmissions, rigid_equations)
    mechanics, rigid_equations = reduced(full, rigid_equations, contributions.prescribed)
    contacts = [t.contact for t in transmissions if t.contact is not None]
    contacts += [rigid_contact(play, contributions, mechanics) for play in contributions.plays]
    frictions, loads = resolved_frictions(contributions, mechanics)
    inputs = _inputs(platform, contributions)
    ledger = energy_ledger(
        platform.axes, contributions, frictions, [t.ledger for t in transmissions], rigid_equations
    )
    power = constraint_power(full, mechanics, frictions, contributions.prescribed)
    equations = Equations(
        name=platform.name,
        title=platform.title,
        axes=platform.axes,
        coordinates=mechanics.coordinates,
        rates=mechanics.rates,
        mass_matrix=mechanics.mass,
        forcing=mechanics.forcing,
        terms=(*contributions.terms.items(), *loads),
        extra_states=_extra_states(contributions, (*mechanics.coordinates, *mechanics.rates)),
        samplers=_samplers(contributions),
        inputs=tuple(given for given, _ in inputs),
        delays=tuple(_delay_of(axis, contributions) for _, axis in inputs),
        parameters=(),
        frictions=frictions,
        contacts=tuple(contacts),
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
        rigid=rigid,
        rigid_equations=rigid_equations,
    )
    equations = _with_parameters(equations, resolved_parameters(platform, placed))
    refuse_reserved_names(equations)
    return equations


def _with_twists(
    contributions: Contributions, transmissions: Sequence[Transmission]
) -> Contributions:
    """`contributions` in which the torque and the twist of every shaft are quantities, and the
    torque that a sensor shows, where one is read.
    """
    found = [item for t in transmissions for item in t.quantities.items()]
    read = {symbol for sensor in contributions.sensors for symbol in sensor.value.free_symbols}
    torques = {quantity_symbol(f"torque_in_shaft_{t.axis}"): t.measured for t in transmissions}
    found += [(symbol, torque) for symbol, torque in torques.items() if symbol in read]
    return replace(contributions, values={**contributions.values, **dict(found)})


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


def _mechanics(
    platform: Platform,
    contributions: Contributions,
    transmissions: Sequence[Transmission],
    rigid: RigidEquations,
) -> Mechanics:
    """Add drives, shafts, torques and potentials of the effects to the rigid equations."""
    joints, gears = platform.axes, contributions.split_axes
    coordinates = (*map(kinematics.angle, joints), *map(kinematics.gear_angle, gears))
    rates = (*map(kinematics.rate, joints), *map(kinematics.gear_rate, gears))
    mass = sp.diag(rigid.mass_matrix, sp.zeros(len(gears)))
    forcing = sp.Matrix([*rigid.forcing, *([0] * len(gears))])
    row = {symbol: index for index, symbol in enumerate(rates)}
    torques = [(kinematics.rate(axis), contributions.input_torque(axis)) for axis in joints]
    torques += [torque for t in transmissions for torque in t.torques]
    torques += [torque for c in contributions.by_effect for torque in c.torques.items()]
    for drive in contributions.drives:
        rate = contributions.drive_rate(drive)
        inertia = contributions.resolve(drive.inertia)
        mass[row[rate], row[rate]] += inertia
        torques.append((rate, driving_torque(drive, contributions, coordinates[row[rate]])))
    for symbol, torque in torques:
        forcing[row[symbol]] += contributions.resolve(torque)
    potential = contributions.resolve(sum((c.potential for c in contributions.by_effect), ZERO))
    for index, coordinate in enumerate(coordinates):
        forcing[index] -= sp.diff(potential, coordinate)
    mass = mass.applyfunc(contributions.resolve)
    return Mechanics(coordinates, rates, sp.ImmutableMatrix(mass), sp.ImmutableMatrix(forcing))


def _rigid_configuration(platform: Platform, contributions: Contributions) -> RigidConfiguration:
    """Bodies, and gravity in the base frame less the acceleration of the base."""
    tilt, azimuth = (contributions.resolve(quantity_symbol(name)) for name in GRAVITY_QUANTITIES)
    acceleration = [contributions.resolve(quantity_symbol(name)) for name in BASE_ACCELERATION]
    g = GRAVITY.symbol if platform.gravity else ZERO
    direction = [
        sp.sin(tilt) * sp.cos(azimuth),
        sp.sin(tilt) * sp.sin(azimuth),
        -sp.cos(tilt),
    ]
    bodies = tuple(
        replace(
            body,
            mass=contributions.resolve(body.mass),
            com=body.com.applyfunc(contributions.resolve),
            inertia=body.inertia.applyfunc(contributions.resolve),
        )
        for contribution in contributions.by_effect
        for body in contribution.bodies
    )
    gravity = [g * d - a for d, a in zip(direction, acceleration, strict=True)]
    apart = contributions.resolve(contributions.values.get(quantity_symbol(AXIS_OFFSET), ZERO))
    offsets = {} if apart == 0 else {"tilt": sp.ImmutableMatrix([apart, 0, 0])}
    base = sp.ImmutableMatrix(gravity)
    return RigidConfiguration(platform.axes, bodies, base, offsets, platform.linear_axes)


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
    variables |= {symbol for sampler in equations.samplers for symbol in sampler.terms}
    variables |= {symbol for friction in equations.frictions for symbol in friction.terms}
    known = {str(symbol) for symbol in variables} | {given.name for given in equations.inputs}
    if unknown := sorted(names - known):
        raise ValueError(
            f"Nothing defines {', '.join(unknown)}: declare it as a parameter of its effect, or"
            " mend its name."
        )
