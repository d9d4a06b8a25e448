"""Assemble a declared platform: place its effects, resolve quantities, derive the equations."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

import sympy as sp

from ptp_symbolic import kinematics
from ptp_symbolic.bodies import RigidConfiguration, RigidEquations
from ptp_symbolic.derivation.equations import Contact, Equations, Ledger, PlacedEffect
from ptp_symbolic.derivation.lagrange import lagrange
from ptp_symbolic.derivation.placement import place_effects, resolved_parameters
from ptp_symbolic.effects.effect import Contribution, Drive, Friction, Input, Shaft
from ptp_symbolic.effects.effect import quantity as quantity_symbol
from ptp_symbolic.parameters import Parameter
from ptp_symbolic.platform import Platform

GRAVITY_QUANTITIES = ("gravity_tilt", "gravity_azimuth")


@dataclass(frozen=True)
class _Parts:
    """Everything that the effects contributed, flattened."""

    contributions: tuple[Contribution, ...]
    dissipative: tuple[bool, ...]
    values: Mapping[sp.Symbol, sp.Expr]

    def resolve(self, expression: sp.Expr) -> sp.Expr:
        """Replace quantity placeholders, also inside other quantities."""
        expression = sp.sympify(expression, strict=True)
        while True:
            present = expression.free_symbols & self.values.keys()
            if not present:
                return expression
            expression = expression.subs({symbol: self.values[symbol] for symbol in present})

    def frictions(self) -> list[Friction]:
        return [f for c in self.contributions for f in c.frictions]

    def shafts(self) -> list[Shaft]:
        return [s for c in self.contributions for s in c.shafts]

    def drives(self) -> list[Drive]:
        return [d for c in self.contributions for d in c.drives]


def assemble(platform: Platform) -> Equations:
    """Return the equations of `platform`.

    Raises InputError for an unknown effect, a parameter that no effect declares, a wrong unit or
    a value outside the bounds of its effect.
    """
    placed = place_effects(platform)
    parts = _collect(platform, placed)
    rigid = _rigid_configuration(platform, parts)
    rigid_equations = lagrange(rigid)
    gears = [shaft.axis for shaft in parts.shafts()]
    joints = platform.axes
    coordinates = [*map(kinematics.angle, joints), *map(kinematics.gear_angle, gears)]
    rates = [*map(kinematics.rate, joints), *map(kinematics.gear_rate, gears)]
    contacts, shaft_torques, shaft_ledgers = _transmissions(parts)
    mass = sp.diag(rigid_equations.mass_matrix, sp.zeros(len(gears)))
    forcing = sp.Matrix([*rigid_equations.forcing, *([0] * len(gears))])
    row = {symbol: index for index, symbol in enumerate(rates)}
    for drive in parts.drives():
        at = row.get(kinematics.gear_rate(drive.axis), row[kinematics.rate(drive.axis)])
        mass[at, at] += drive.inertia
    torques = [*_joint_torques(platform, parts), *_drive_torques(parts, row), *shaft_torques]
    torques += [t for c in parts.contributions for t in c.torques.items()]
    potential = sum((parts.resolve(c.potential) for c in parts.contributions), sp.Integer(0))
    for symbol, torque in torques:
        forcing[row[symbol]] += parts.resolve(torque)
    for index, coordinate in enumerate(coordinates):
        forcing[index] -= sp.diff(potential, coordinate)
    frictions = tuple(
        Friction(f.axis, f.rate, parts.resolve(f.level), parts.resolve(f.breakaway))
        for f in parts.frictions()
    )
    mass = mass.applyfunc(parts.resolve)
    ledger = _ledger(platform, parts, frictions, potential, shaft_ledgers, rigid_equations)
    equations = Equations(
        name=platform.name,
        title=platform.title,
        axes=joints,
        coordinates=tuple(coordinates),
        rates=tuple(rates),
        mass_matrix=sp.ImmutableMatrix(mass),
        forcing=sp.ImmutableMatrix(forcing),
        extra_states=_extra_states(parts),
        inputs=_inputs(platform, parts),
        parameters=(),
        frictions=frictions,
        contacts=contacts,
        outputs=_outputs(platform, parts),
        ledger=ledger,
        effects=tuple(
            PlacedEffect(e, p.axis, tuple(q.name for q in e.parameters(p))) for e, p in placed
        ),
        rigid=rigid,
        rigid_equations=rigid_equations,
    )
    return _with_parameters(equations, resolved_parameters(platform, placed))


def _collect(platform: Platform, placed: Iterable[tuple]) -> _Parts:
    placed = list(placed)
    contributions = tuple(effect.contribute(place) for effect, place in placed)
    nominal: dict[str, sp.Expr] = {name: sp.Integer(0) for name in GRAVITY_QUANTITIES}
    for contribution in contributions:
        nominal.update(contribution.quantities)
    values = dict(nominal)
    for contribution in contributions:
        for name, change in contribution.changes.items():
            values[name] = values[name] * change.factor
    for contribution in contributions:
        for name, change in contribution.changes.items():
            values[name] = values[name] + change.addition
    symbols = {
        quantity_symbol(name): sp.sympify(value, strict=True) for name, value in values.items()
    }
    return _Parts(contributions, tuple(effect.dissipative for effect, _ in placed), symbols)


def _rigid_configuration(platform: Platform, parts: _Parts) -> RigidConfiguration:
    tilt, azimuth = (parts.resolve(quantity_symbol(name)) for name in GRAVITY_QUANTITIES)
    g = sp.Rational(repr(platform.gravity))
    direction = [
        sp.sin(tilt) * sp.cos(azimuth),
        sp.sin(tilt) * sp.sin(azimuth),
        -sp.cos(tilt),
    ]
    bodies = tuple(
        type(body)(
            body.name,
            body.frame,
            parts.resolve(body.mass),
            body.com.applyfunc(parts.resolve),
            body.inertia.applyfunc(parts.resolve),
        )
        for contribution in parts.contributions
        for body in contribution.bodies
    )
    return RigidConfiguration(platform.axes, bodies, sp.ImmutableMatrix([g * d for d in direction]))


def _transmissions(
    parts: _Parts,
) -> tuple[tuple[Contact, ...], list[tuple[sp.Symbol, sp.Expr]], list[Ledger]]:
    """Contacts, torques on gear and joint, and energy of every shaft."""
    contacts, torques, ledgers = [], [], []
    for shaft in parts.shafts():
        gear, joint = kinematics.gear_rate(shaft.axis), kinematics.rate(shaft.axis)
        separation = kinematics.gear_angle(shaft.axis) - kinematics.angle(shaft.axis)
        half_gap = parts.resolve(quantity_symbol(f"half_gap_{shaft.axis}"))
        side, active = (sp.Symbol(f"{word}_{shaft.axis}", real=True) for word in ("side", "active"))
        if half_gap == 0:
            side_or_one, active_or_one = sp.Integer(0), sp.Integer(1)
            touching = sp.Integer(1)
        else:
            side_or_one, active_or_one, touching = side, active, side**2
        twist = separation - side_or_one * half_gap
        spring, damper = shaft.stiffness * twist, shaft.damping * (gear - joint)
        torque = spring + damper
        transmitted = active_or_one * torque
        torques += [(gear, -transmitted), (joint, transmitted)]
        lost = active_or_one * damper - (1 - active_or_one) * spring
        ledgers.append(
            Ledger(
                stored=touching * shaft.stiffness * twist**2 / 2,
                power_in=sp.Integer(0),
                dissipated=touching * lost * (gear - joint),
            )
        )
        if half_gap != 0:
            contacts.append(Contact(shaft.axis, separation, half_gap, torque, side, active))
    return tuple(contacts), torques, ledgers


def _joint_torques(platform: Platform, parts: _Parts) -> list[tuple[sp.Symbol, sp.Expr]]:
    driven = {drive.axis for drive in parts.drives()}
    return [
        (kinematics.rate(axis), kinematics.torque(axis))
        for axis in platform.axes
        if axis not in driven
    ]


def _drive_torques(parts: _Parts, row: Mapping[sp.Symbol, int]) -> list[tuple[sp.Symbol, sp.Expr]]:
    return [(_drive_rate(drive, row), drive.torque) for drive in parts.drives()]


def _drive_rate(drive: Drive, rates: Iterable[sp.Symbol]) -> sp.Symbol:
    gear = kinematics.gear_rate(drive.axis)
    return gear if gear in rates else kinematics.rate(drive.axis)


def _inputs(platform: Platform, parts: _Parts) -> tuple[Input, ...]:
    drives = {drive.axis: drive.inputs for drive in parts.drives()}
    inputs: list[Input] = []
    for axis in platform.axes:
        own = Input(str(kinematics.torque(axis)), "N m", f"torque on the {axis} joint")
        inputs.extend(drives.get(axis, (own,)))
    return tuple(inputs)


def _extra_states(parts: _Parts) -> tuple:
    return tuple(
        type(state)(
            state.name, state.unit, state.meaning, parts.resolve(state.derivative), state.initial
        )
        for contribution in parts.contributions
        for state in contribution.states
    )


def _outputs(platform: Platform, parts: _Parts) -> tuple[tuple[str, str, sp.Expr], ...]:
    """Measured signals: joint angles, then extra states, each with what sensing effects add."""
    signals = {str(kinematics.angle(axis)): "rad" for axis in platform.axes}
    for contribution in parts.contributions:
        signals.update({state.name: state.unit for state in contribution.states})
    added: dict[str, sp.Expr] = {}
    for contribution in parts.contributions:
        for signal, expression in contribution.measured.items():
            added[signal] = added.get(signal, sp.Integer(0)) + parts.resolve(expression)
    return tuple(
        (name, unit, sp.Symbol(name, real=True) + added.get(name, sp.Integer(0)))
        for name, unit in signals.items()
    )


def _ledger(
    platform: Platform,
    parts: _Parts,
    frictions: tuple[Friction, ...],
    potential: sp.Expr,
    shafts: list[Ledger],
    rigid_equations: RigidEquations,
) -> Ledger:
    stored = rigid_equations.kinetic + rigid_equations.potential + potential
    power_in, dissipated = sp.Integer(0), sp.Integer(0)
    driven = {drive.axis for drive in parts.drives()}
    for axis in platform.axes:
        if axis not in driven:
            power_in += kinematics.torque(axis) * kinematics.rate(axis)
    for drive in parts.drives():
        rates = [kinematics.gear_rate(s.axis) for s in parts.shafts()]
        stored += drive.stored + drive.inertia * _drive_rate(drive, rates) ** 2 / 2
        power_in += drive.power_in
        dissipated += drive.dissipated
    for contribution, is_loss in zip(parts.contributions, parts.dissipative, strict=True):
        power = sum((torque * rate for rate, torque in contribution.torques.items()), sp.Integer(0))
        power_in, dissipated = (
            (power_in, dissipated - power) if is_loss else (power_in + power, dissipated)
        )
    for friction in frictions:
        direction = sp.Symbol(f"slide_{friction.axis}", real=True)
        dissipated += direction * friction.level * friction.rate
    for shaft in shafts:
        stored, dissipated = stored + shaft.stored, dissipated + shaft.dissipated
    return Ledger(
        *(parts.resolve(sp.sympify(e, strict=True)) for e in (stored, power_in, dissipated))
    )


def _with_parameters(equations: Equations, declared: dict[str, Parameter]) -> Equations:
    """Attach the parameters that the equations use, in the order of the effects."""
    used: set[sp.Symbol] = set(equations.mass_matrix.free_symbols | equations.forcing.free_symbols)
    for friction in equations.frictions:
        used |= friction.level.free_symbols | friction.breakaway.free_symbols
    for contact in equations.contacts:
        used |= contact.half_gap.free_symbols | contact.torque.free_symbols
    for state in equations.extra_states:
        used |= state.derivative.free_symbols
    for _, _, expression in equations.outputs:
        used |= expression.free_symbols
    names = {str(symbol) for symbol in used}
    parameters = tuple(p for name, p in declared.items() if name in names)
    return replace(equations, parameters=parameters)
