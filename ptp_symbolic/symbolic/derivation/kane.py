"""Equations of motion by Kane's method, left to `sympy.physics.mechanics`."""

import sympy as sp
from sympy.physics.mechanics import (
    KanesMethod,
    Point,
    ReferenceFrame,
    RigidBody,
    dynamicsymbols,
    inertia,
)

from ptp_symbolic.symbolic.mechanics import kinematics
from ptp_symbolic.symbolic.mechanics.bodies import Body, RigidConfiguration, RigidEquations
from ptp_symbolic.symbolic.symbols import ZERO


def kane(configuration: RigidConfiguration) -> RigidEquations:
    """Return M q'' = f + tau of `configuration` by Kane's equations, not simplified.

    Frames, bodies and inertia dyadics are SymPy's; only the joint directions are ours. Source: Kane
    and Levinson, Dynamics: Theory and Applications, 1985, section 6.1.
    """
    axes = configuration.axes
    angles = [dynamicsymbols(f"theta_{axis}") for axis in axes]
    speeds = [dynamicsymbols(f"omega_{axis}") for axis in axes]
    base, origin = ReferenceFrame("base"), Point("foot")
    origin.set_vel(base, 0)
    frames = _frames(configuration, base, origin, angles, speeds)
    bodies = [_rigid_body(body, *frames[body.frame], base) for body in configuration.bodies]
    down = _vector(configuration.gravity, base)
    loads = [(body.masscenter, body.mass * down) for body in bodies]
    kinematic = [q.diff() - u for q, u in zip(angles, speeds, strict=True)]
    method = KanesMethod(base, q_ind=angles, u_ind=speeds, kd_eqs=kinematic)
    method.kanes_equations(bodies, loads)
    coordinates = tuple(kinematics.angle(axis) for axis in axes)
    rates = tuple(kinematics.rate(axis) for axis in axes)
    plain = dict(zip((*angles, *speeds), (*coordinates, *rates), strict=True))
    potential = -sum((b.mass * down.dot(b.masscenter.pos_from(origin)) for b in bodies), ZERO)
    kinetic = sum((body.kinetic_energy(base) for body in bodies), ZERO)
    return RigidEquations(
        axes,
        coordinates,
        rates,
        sp.ImmutableMatrix(method.mass_matrix.xreplace(plain)),
        sp.ImmutableMatrix(method.forcing.xreplace(plain)),
        kinetic.xreplace(plain),
        potential.xreplace(plain),
    )


def _frames(
    configuration: RigidConfiguration,
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
                origin.v1pt_theory(before, base, last)
            else:
                origin.v2pt_theory(before, base, last)
                direction = _vector(kinematics.joint_direction(axis), last)
                frame.orient_axis(last, direction, angles[place])
                frame.set_ang_vel(last, speeds[place] * direction)
            last = frame
        frames[axis] = last, origin
    return frames


def _rigid_body(
    body: Body, frame: ReferenceFrame, origin: Point, base: ReferenceFrame
) -> RigidBody:
    centre = origin.locatenew(f"{body.name}_centre", _vector(body.com, frame))
    centre.v2pt_theory(origin, base, frame)
    tensor = body.inertia
    dyadic = inertia(
        frame,
        *(tensor[i, i] for i in range(3)),
        *(tensor[i, j] for i, j in ((0, 1), (1, 2), (2, 0))),
    )
    return RigidBody(body.name, centre, frame, body.mass, (dyadic, centre))


def _vector(components: sp.Matrix, frame: ReferenceFrame) -> sp.Expr:
    return sum((c * unit for c, unit in zip(components, frame, strict=True)), 0 * frame.x)
