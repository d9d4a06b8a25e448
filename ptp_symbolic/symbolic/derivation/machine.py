"""The parts of a declared platform: what its effects add up to before equations are written.

Equations of motion, the energy ledger and the bond graph are all made from these.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import sympy as sp

from ptp_symbolic.platform import Platform
from ptp_symbolic.symbolic.derivation.contributions import (
    AXIS_OFFSET,
    BASE_ACCELERATION,
    BASE_SPIN,
    BASE_SPIN_RATE,
    GRAVITY_QUANTITIES,
    GRAVITY_SHARE,
    Contributions,
    collect,
)
from ptp_symbolic.symbolic.derivation.equations import Contact
from ptp_symbolic.symbolic.derivation.friction import (
    Mechanics,
    Term,
    driving_torque,
    resolved_frictions,
)
from ptp_symbolic.symbolic.derivation.lagrange import lagrange
from ptp_symbolic.symbolic.derivation.moving_base import MovingBase, moving_base
from ptp_symbolic.symbolic.derivation.newton_euler import acceleration, newton_euler_steps
from ptp_symbolic.symbolic.derivation.placement import GRAVITY, place_effects
from ptp_symbolic.symbolic.derivation.prescribed import constraint_torques, reduced, released
from ptp_symbolic.symbolic.derivation.rigid_play import rigid_contact
from ptp_symbolic.symbolic.derivation.transmission import Transmission, transmission
from ptp_symbolic.symbolic.derivation.trigonometry import normal_form
from ptp_symbolic.symbolic.effect_interface.contribution import Friction
from ptp_symbolic.symbolic.effect_interface.effect import Effect
from ptp_symbolic.symbolic.effect_interface.place import Place, quantity_name
from ptp_symbolic.symbolic.effect_interface.place import quantity as quantity_symbol
from ptp_symbolic.symbolic.mechanics import kinematics
from ptp_symbolic.symbolic.mechanics.bodies import RigidConfiguration, RigidEquations
from ptp_symbolic.symbolic.symbols import ZERO

MOTION_OF_BODIES = ("spin_", "specific_force_")  # how the names of these quantities begin


@dataclass(frozen=True)
class Machine:
    """What a platform consists of.

    `full` and `full_rigid` are the mechanics with the rows of all joints, `mechanics` and
    `rigid_equations` those in which a prescribed joint follows its input; `constraint_torques` in
    N m, by the rates of these joints, make it do so. `loads` are named functions of what frictions
    carry.
    """

    placed: list[tuple[Effect, Place]]
    contributions: Contributions
    transmissions: tuple[Transmission, ...]
    rigid: RigidConfiguration
    base: MovingBase
    full_rigid: RigidEquations
    full: Mechanics
    rigid_equations: RigidEquations
    mechanics: Mechanics
    contacts: tuple[Contact, ...]
    frictions: tuple[Friction, ...]
    loads: tuple[Term, ...]
    constraint_torques: Mapping[sp.Symbol, sp.Expr]

    @property
    def base_torques(self) -> dict[sp.Symbol, sp.Expr]:
        """Torques in N m that the measured motion of the base exerts, by the rates of the joints,
        written out; those that are zero left out.
        """
        return {rate: self.base.written_out(torque) for rate, torque in self.base.torques.items()}


def machine(platform: Platform) -> Machine:
    """The parts of `platform`.

    Raises InputError for an unknown effect, a parameter that no effect declares, a wrong unit or a
    value out of bounds, and for effects that cannot be combined.
    """
    placed = place_effects(platform)
    measured = {s.signal for s in platform.signals if s.role == "output"}
    contributions = released(collect(platform.axes, placed, measured))
    transmissions = [transmission(shaft, contributions) for shaft in contributions.shafts]
    contributions = _with_twists(contributions, transmissions)
    rigid = _rigid_configuration(platform, contributions)
    base = moving_base(rigid, _inputs_of_base(rigid, contributions))
    contributions = _with_motion_of_bodies(contributions, base.seen)
    full_rigid = lagrange(rigid)
    full = _mechanics(platform, contributions, transmissions, full_rigid, base)
    mechanics, rigid_equations = reduced(full, full_rigid, contributions.prescribed)
    contacts = [t.contact for t in transmissions if t.contact is not None]
    contacts += [rigid_contact(play, contributions, mechanics) for play in contributions.plays]
    frictions, loads = resolved_frictions(contributions, mechanics)
    return Machine(
        placed=placed,
        contributions=contributions,
        transmissions=tuple(transmissions),
        rigid=rigid,
        base=base,
        full_rigid=full_rigid,
        full=full,
        rigid_equations=rigid_equations,
        mechanics=mechanics,
        contacts=tuple(contacts),
        frictions=frictions,
        loads=loads,
        constraint_torques=constraint_torques(full, mechanics, frictions, contributions.prescribed),
    )


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


def _with_motion_of_bodies(
    contributions: Contributions, rigid: RigidConfiguration
) -> Contributions:
    """`contributions` in which the motion of bodies is a quantity where a sensor reads it: in the
    axes of the frame behind a joint its rates ``spin_x_<axis>`` in rad/s, their derivatives
    ``spin_rate_x_<axis>``, and the specific force ``specific_force_x_<axis>`` of its origin in
    m/s^2, acceleration less gravity.
    """
    read = {symbol for sensor in contributions.sensors for symbol in sensor.value.free_symbols}
    if not any(quantity_name(symbol).startswith(MOTION_OF_BODIES) for symbol in read):
        return contributions
    motions, _ = newton_euler_steps(rigid)
    joints = {acceleration(axis): kinematics.acceleration(axis) for axis in rigid.axes}
    found = {}
    for axis, motion in zip(rigid.axes, motions[1:], strict=True):
        vectors = {
            "spin": motion.spin,
            "spin_rate": motion.spin_rate,
            "specific_force": motion.acceleration - motion.gravity,
        }
        for name, vector in vectors.items():
            for k, value in zip("xyz", vector, strict=True):
                symbol = quantity_symbol(f"{name}_{k}_{axis}")
                if symbol in read:
                    found[symbol] = normal_form(value.xreplace(joints))
    return replace(contributions, values={**contributions.values, **found})


def _inputs_of_base(
    rigid: RigidConfiguration, contributions: Contributions
) -> dict[sp.Symbol, sp.Expr]:
    """Zero for every input that moves the base of `rigid`, by its symbol."""
    given = (*rigid.gravity, *rigid.base_spin, *rigid.base_spin_rate)
    inputs = {i.symbol for c in contributions.by_effect for i in c.inputs}
    found = inputs & {symbol for e in given for symbol in e.free_symbols}
    return dict.fromkeys(sorted(found, key=str), ZERO)


def _mechanics(
    platform: Platform,
    contributions: Contributions,
    transmissions: Sequence[Transmission],
    rigid: RigidEquations,
    base: MovingBase,
) -> Mechanics:
    """Add drives, shafts, torques and potentials of the effects to the rigid equations."""
    joints, gears = platform.axes, contributions.split_axes
    coordinates = (*map(kinematics.angle, joints), *map(kinematics.gear_angle, gears))
    rates = (*map(kinematics.rate, joints), *map(kinematics.gear_rate, gears))
    mass = sp.diag(rigid.mass_matrix, sp.zeros(len(gears)))
    still = rigid.forcing.xreplace(base.at_rest)
    forcing = sp.Matrix([*still, *([0] * len(gears))])
    row = {symbol: index for index, symbol in enumerate(rates)}
    torques = [(contributions.drive_rate(a), contributions.input_torque(a)) for a in joints]
    torques += base.torques.items()
    torques += [torque for t in transmissions for torque in t.torques]
    torques += [torque for c in contributions.by_effect for torque in c.torques.items()]
    for drive in contributions.drives:
        rate = contributions.drive_rate(drive.axis)
        mass[row[rate], row[rate]] += contributions.resolve(drive.inertia)
        torques.append((rate, driving_torque(drive, contributions, coordinates[row[rate]])))
    for rate in rates:
        mass[row[rate], row[rate]] += contributions.inertia_on(rate)
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
    share, *rest = (
        contributions.resolve(quantity_symbol(name))
        for name in (GRAVITY_SHARE, *BASE_ACCELERATION, *BASE_SPIN, *BASE_SPIN_RATE)
    )
    spins = (sp.ImmutableMatrix(rest[3:6]), sp.ImmutableMatrix(rest[6:]))
    g = share * GRAVITY.symbol if platform.gravity else ZERO
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
    gravity = [g * d - a for d, a in zip(direction, rest[:3], strict=True)]
    apart = contributions.resolve(contributions.values.get(quantity_symbol(AXIS_OFFSET), ZERO))
    offsets = {} if apart == 0 else {"tilt": sp.ImmutableMatrix([apart, 0, 0])}
    base = sp.ImmutableMatrix(gravity)
    return RigidConfiguration(platform.axes, bodies, base, offsets, platform.linear_axes, *spins)
