"""Equations of motion by Kane's method, left to `sympy.physics.mechanics`."""

from dataclasses import dataclass

import sympy as sp
from sympy.physics.mechanics import (
    KanesMethod,
    Point,
    ReferenceFrame,
    RigidBody,
    dynamicsymbols,
    inertia,
    partial_velocity,
)

from ptp_symbolic.symbolic.derivation.newton_euler import acceleration
from ptp_symbolic.symbolic.mechanics import kinematics
from ptp_symbolic.symbolic.mechanics.bodies import (
    NO_SPIN,
    Body,
    RigidConfiguration,
    RigidEquations,
)
from ptp_symbolic.symbolic.symbols import ZERO


@dataclass(frozen=True)
class PartialVelocities:
    """Of one body, in its own frame and for every rate: `linear` [3] of the centre of mass, in m,
    and `angular` [3].
    """

    body: str
    linear: tuple[sp.Matrix, ...]
    angular: tuple[sp.Matrix, ...]


@dataclass(frozen=True)
class KaneSteps:
    """Partial velocities of the bodies, generalized `active` and `inertia` forces [n] in N m."""

    partial_velocities: tuple[PartialVelocities, ...]
    active: sp.Matrix
    inertia: sp.Matrix


def kane(configuration: RigidConfiguration) -> RigidEquations:
    """Return M q'' = f + tau of `configuration` by Kane's equations, not simplified."""
    return kane_with_steps(configuration)[0]


def kane_with_steps(configuration: RigidConfiguration) -> tuple[RigidEquations, KaneSteps]:
    """Kane's equations M q'' = f + tau of `configuration`, not simplified, and the way to them.

    Frames, bodies and inertia dyadics are SymPy's; only the joint directions are ours. Source: Kane
    and Levinson, Dynamics: Theory and Applications, 1985, section 6.1.
    """
    axes = configuration.axes
    angles = [dynamicsymbols(f"theta_{axis}") for axis in axes]
    speeds = [dynamicsymbols(f"omega_{axis}") for axis in axes]
    still, base, origin = ReferenceFrame("still"), ReferenceFrame("base"), Point("foot")
    spins = [dynamicsymbols(f"spin_{k}_base") for k in "xyz"]
    moving = configuration.base_spin != NO_SPIN
    base.set_ang_vel(still, _vector(sp.Matrix(spins), base) if moving else 0)
    origin.set_vel(still, 0)
    origin.set_vel(base, 0)
    frames = _frames(configuration, still, base, origin, angles, speeds)
    bodies = [_rigid_body(body, *frames[body.frame], still) for body in configuration.bodies]
    down = _vector(configuration.gravity, base)
    loads = [(body.masscenter, body.mass * down) for body in bodies]
    kinematic = [q.diff() - u for q, u in zip(angles, speeds, strict=True)]
    method = KanesMethod(still, q_ind=angles, u_ind=speeds, kd_eqs=kinematic)
    active, inertial = method.kanes_equations(bodies, loads)
    coordinates = tuple(kinematics.angle(axis) for axis in axes)
    rates = tuple(kinematics.rate(axis) for axis in axes)
    plain = dict(zip((*angles, *speeds), (*coordinates, *rates), strict=True))
    plain |= dict(zip(spins, configuration.base_spin, strict=True))
    slopes = (spin.diff() for spin in spins)
    plain |= dict(zip(slopes, configuration.base_spin_rate, strict=True))
    potential = -sum((b.mass * down.dot(b.masscenter.pos_from(origin)) for b in bodies), ZERO)
    kinetic = sum((body.kinetic_energy(still) for body in bodies), ZERO)
    accelerated = plain | {
        u.diff(): acceleration(axis) for u, axis in zip(speeds, axes, strict=True)
    }
    steps = KaneSteps(
        tuple(_partial_velocities(body, still, speeds, plain) for body in bodies),
        active.xreplace(accelerated),
        inertial.xreplace(accelerated),
    )
    found = RigidEquations(
        axes,
        coordinates,
        rates,
        sp.ImmutableMatrix(method.mass_matrix.xreplace(plain)),
        sp.ImmutableMatrix(method.forcing.xreplace(plain)),
        kinetic.xreplace(plain),
        potential.xreplace(plain),
    )
    return found, steps


def _partial_velocities(
    body: RigidBody,
    base: ReferenceFrame,
    speeds: list[sp.Expr],
    plain: dict[sp.Expr, sp.Symbol],
) -> PartialVelocities:
    linear, angular = partial_velocity(
        [body.masscenter.vel(base), body.frame.ang_vel_in(base)], speeds, base
    )

    def written(vectors: list[sp.Expr]) -> tuple[sp.Matrix, ...]:
        own = (v.to_matrix(body.frame) if v != 0 else sp.zeros(3, 1) for v in vectors)
        return tuple(v.xreplace(plain) for v in own)

    return PartialVelocities(body.name, written(linear), written(angular))


def _frames(
    configuration: RigidConfiguration,
    still: ReferenceFrame,
    base: ReferenceFrame,
    foot: Point,
    angles: list[sp.Expr],
    speeds: list[sp.Expr],
) -> dict[str, tuple[ReferenceFrame, Point]]:
    """The pan and the tilt frame, each with its origin; those of an absent axis are the ones
    before it.
    """
    frames, last, origin = {}, base, foot
    for axis in kinematics.AXES:
        if axis in configuration.axes:
            place = configuration.axes.index(axis)
            frame = ReferenceFrame(f"{axis}_frame")
            moving = {kinematics.angle(axis): angles[place]}
            offset = _vector(configuration.offset(axis).xreplace(moving), last)
            before, origin = origin, origin.locatenew(f"{axis}_origin", offset)
            if axis in configuration.sliding:
                frame.orient_axis(last, last.x, 0)
                origin.set_vel(last, speeds[place] * _vector(kinematics.ALONG, last))
                origin.v1pt_theory(before, still, last)
            else:
                origin.v2pt_theory(before, still, last)
                direction = _vector(kinematics.joint_direction(axis), last)
                frame.orient_axis(last, direction, angles[place])
                frame.set_ang_vel(last, speeds[place] * direction)
            last = frame
        frames[axis] = last, origin
    return frames


def _rigid_body(
    body: Body, frame: ReferenceFrame, origin: Point, still: ReferenceFrame
) -> RigidBody:
    centre = origin.locatenew(f"{body.name}_centre", _vector(body.com, frame))
    centre.v2pt_theory(origin, still, frame)
    tensor = body.inertia
    dyadic = inertia(
        frame,
        *(tensor[i, i] for i in range(3)),
        *(tensor[i, j] for i, j in ((0, 1), (1, 2), (2, 0))),
    )
    return RigidBody(body.name, centre, frame, body.mass, (dyadic, centre))


def _vector(components: sp.Matrix, frame: ReferenceFrame) -> sp.Expr:
    return sum((c * unit for c, unit in zip(components, frame, strict=True)), 0 * frame.x)
