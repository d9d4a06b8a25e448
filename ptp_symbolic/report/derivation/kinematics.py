"""Kinematics and the steps of the three routes, as the derivation leaves them."""

from collections.abc import Iterator, Sequence

import sympy as sp

from ptp_symbolic.report.latex_text import displayed, numbered
from ptp_symbolic.symbolic.codegen.latex import latex_of, symbol_latex
from ptp_symbolic.symbolic.derivation.kane import KaneSteps
from ptp_symbolic.symbolic.derivation.lagrange import LagrangeRow
from ptp_symbolic.symbolic.derivation.newton_euler import JointLoad, Motion, acceleration
from ptp_symbolic.symbolic.mechanics import kinematics
from ptp_symbolic.symbolic.mechanics.bodies import Body, RigidConfiguration
from ptp_symbolic.symbolic.symbols import real

Row = tuple[str, sp.Expr]
DIRECTIONS = ("x", "y", "z")


def _written(expression: sp.Expr) -> sp.Expr:
    """`expression` with alpha for the joint accelerations, multiplied out."""
    names = {acceleration(a): real(f"alpha_{a}") for a in kinematics.AXES}
    return sp.expand(expression.xreplace(names))


def _components(letter: str, place: str, vector: sp.Matrix) -> Iterator[Row]:
    """The components of a vector that are not zero, each with its name."""
    for direction, component in zip(DIRECTIONS, vector, strict=True):
        if component != 0:
            yield symbol_latex(f"{letter}_{place}_{direction}"), _written(component)


def carried_motion(configuration: RigidConfiguration, motions: Sequence[Motion]) -> str:
    """Section with rotations, rates, accelerations and the motion of the centres of mass."""
    parts = [
        r"\section{Kinematics}Vectors behind a joint are turned into the frame before it by",
    ]
    for axis in configuration.axes:
        rotation = latex_of(configuration.rotation(axis))
        parts.append(displayed(rf"R_\mathrm{{{axis}}} = {rotation}"))
    parts.append(
        r"Of every frame follow, in its own coordinates and from those of the frame before,"
        r" the angular velocity $\omega$, the angular acceleration $\alpha$ and, of its origin, the"
        r" velocity $v$ and the acceleration $a$. A component that is not given is zero;"
        r" $\alpha$ without a direction is the acceleration of a joint."
    )
    for axis, motion in zip(configuration.axes, motions[1:], strict=True):
        fields = (
            ("omega", motion.spin),
            ("alpha", motion.spin_rate),
            ("v", motion.velocity),
            ("a", motion.acceleration),
        )
        rows = [row for letter, vector in fields for row in _components(letter, axis, vector)]
        parts += [rf"\subsection*{{The {axis} frame}}", numbered(rows)]
    centres: list[Row] = []
    for body in configuration.bodies:
        velocity = _velocity(configuration, motions, body)
        centres += _components("v", f"{body.name}_centre", velocity)
    if centres:
        parts += ["The centres of mass that move do so with", numbered(centres)]
    return "\n".join(parts)


def _velocity(
    configuration: RigidConfiguration, motions: Sequence[Motion], body: Body
) -> sp.Matrix:
    motion = motions[len(kinematics.joints_up_to(configuration.axes, body.frame))]
    return motion.velocity + motion.spin.cross(sp.Matrix(body.com))


def inward_steps(loads: Sequence[JointLoad]) -> str:
    """Newton-Euler: forces and moments of the bodies, outermost joint first."""
    parts = [
        r"\subsection{Newton--Euler}From the outermost joint inward: the force $F$ that every body"
        r" takes at its centre of mass, less its weight, the moment $N$ about it, and the torque"
        r" (or force) $\tau$ of the joint: the part along its axis of all forces and moments"
        r" behind the joint, taken about the origin there."
    ]
    for load in reversed(loads):
        rows = [row for body, force in load.forces for row in _components("F", body, force)]
        rows += [row for body, moment in load.moments for row in _components("N", body, moment)]
        rows.append((symbol_latex(f"tau_{load.axis}"), _written(load.joint_torque)))
        parts += [rf"\par The {load.axis} joint:", numbered(rows)]
    return "\n".join(parts)


def projected_steps(axes: Sequence[str], steps: KaneSteps) -> str:
    """Kane: partial velocities of the bodies, generalized active and inertia forces."""
    rows: list[Row] = []
    for own in steps.partial_velocities:
        for axis, linear, angular in zip(axes, own.linear, own.angular, strict=True):
            rows += _components("v", f"{own.body}_{axis}", linear)
            rows += _components("omega", f"{own.body}_{axis}", angular)
    forces: list[Row] = []
    for axis, active, inertial in zip(axes, steps.active, steps.inertia, strict=True):
        forces.append((symbol_latex(f"Q_active_{axis}"), _written(active)))
        forces.append((symbol_latex(f"Q_inertia_{axis}"), _written(inertial)))
    return (
        r"\subsection{Kane}The partial velocities of every centre of mass, $v$, and of every body,"
        r" $\omega$, for the rate of the joint that is named last, in the frame of the body, are"
        + numbered(rows)
        + r"They project gravity to the generalized active forces and the inertia of the bodies to"
        r" the generalized inertia forces; with the torque of the joint each pair adds up to zero:"
        + numbered(forces)
    )


def energy_steps(kinetic: sp.Expr, potential: sp.Expr, found: Sequence[LagrangeRow]) -> str:
    """Lagrange: kinetic and potential energy, and their derivatives term by term."""
    parts = [
        r"\subsection{Lagrange}Kinetic and potential energy are",
        numbered([("T", sp.expand(kinetic)), ("V", potential)]),
        r"with the derivatives, where $\dot p$ is the rate of change of the momentum"
        r" $p=\partial T/\partial\omega$ at constant rates,",
    ]
    for row in found:
        at, angle = kinematics.place_of(row.rate), symbol_latex(str(row.coordinate))
        momentum = symbol_latex(f"p_{at}")
        parts.append(
            numbered(
                [
                    (momentum, _written(row.momentum)),
                    (rf"\dot{{p}}_{{\mathrm{{{at}}}}}", _written(row.transport)),
                    (rf"\partial T/\partial {angle}", _written(row.kinetic_slope)),
                    (rf"\partial V/\partial {angle}", _written(row.potential_slope)),
                ]
            )
        )
    return "\n".join(parts)
