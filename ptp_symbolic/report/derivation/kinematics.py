"""Kinematics and the steps of the three routes, as the derivation leaves them."""

from collections.abc import Iterator, Sequence

import sympy as sp

from ptp_symbolic.report.latex_text import displayed, numbered
from ptp_symbolic.symbolic.derivation.kane import KaneSteps
from ptp_symbolic.symbolic.derivation.lagrange import LagrangeRow
from ptp_symbolic.symbolic.derivation.newton_euler import JointLoad, Motion, acceleration
from ptp_symbolic.symbolic.documents.latex import latex_of, symbol_latex
from ptp_symbolic.symbolic.mechanics import kinematics
from ptp_symbolic.symbolic.mechanics.bodies import Body, RigidConfiguration
from ptp_symbolic.symbolic.symbols import real

Row = tuple[str, sp.Expr]
DIRECTIONS = ("x", "y", "z")
OF_CENTRES = (
    r"The centre of mass of a body, at $c$ in its frame, moves with $v + \omega\times c$ and"
    r" $a + \alpha\times c + \omega\times(\omega\times c)$. Those that move do so with"
)
NEWTON_EULER = (
    r"\begin{gathered}F = m\,(a_\mathrm{centre} - \mathbf{g}),\qquad"
    r" N = J\alpha + \omega\times J\omega,\\"
    r" \tau = n\cdot\sum(N + r\times F) \text{ of a joint that turns, }"
    r" n\cdot\sum F \text{ of one that slides.}\end{gathered}"
)
KANE = (
    r"\begin{gathered}Q_{\mathrm{active},i} = \sum m\,\mathbf{g}\cdot v_i,\qquad"
    r" Q_{\mathrm{inertia},i} = -\sum\left(m\,a_\mathrm{centre}\cdot v_i"
    r" + (J\alpha + \omega\times J\omega)\cdot\omega_i\right),\\"
    r" Q_{\mathrm{active},i} + Q_{\mathrm{inertia},i} + \tau_i = 0\end{gathered}"
)
LAGRANGE = (
    r"\begin{gathered}\frac{\mathrm{d}}{\mathrm{d}t}\frac{\partial T}{\partial\omega_i}"
    r" - \frac{\partial T}{\partial\theta_i} + \frac{\partial V}{\partial\theta_i} = \tau_i,"
    r"\\ T = \sum\tfrac12\left(m\,v_\mathrm{centre}\cdot v_\mathrm{centre}"
    r" + \omega\cdot J\omega\right),\qquad V = -\sum m\,\mathbf{g}\cdot r_\mathrm{centre}"
    r"\end{gathered}"
)


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
        velocity, acceleration_of_centre = _centre(configuration, motions, body)
        centres += _components("v", f"{body.name}_centre", velocity)
        centres += _components("a", f"{body.name}_centre", acceleration_of_centre)
    if centres:
        parts += [OF_CENTRES, numbered(centres)]
    return "\n".join(parts)


def _centre(
    configuration: RigidConfiguration, motions: Sequence[Motion], body: Body
) -> tuple[sp.Matrix, sp.Matrix]:
    """Velocity and acceleration of the centre of mass of `body`, in its frame."""
    motion = motions[len(kinematics.joints_up_to(configuration.axes, body.frame))]
    spin, arm = motion.spin, sp.Matrix(body.com)
    turning = motion.spin_rate.cross(arm) + spin.cross(spin.cross(arm))
    return motion.velocity + spin.cross(arm), motion.acceleration + turning


def inward_steps(loads: Sequence[JointLoad]) -> str:
    """Newton-Euler: forces and moments of the bodies, outermost joint first."""
    parts = [
        r"\subsection{Newton--Euler}From the outermost joint inward: the force $F$ that every body"
        r" takes at its centre of mass, less its weight (Newton), the moment $N$ about it (Euler),"
        r" and the torque (or force) $\tau$ of the joint: the part along its direction $n$ of all"
        r" moments (or forces) behind the joint, taken about the origin there, $r$ from it,"
        + displayed(NEWTON_EULER)
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
        r"\subsection{Kane}The partial velocities of every centre of mass, $v_i$, and of every"
        r" body, $\omega_i$, are the derivatives of its velocity by the rate of joint $i$. With"
        + displayed(KANE)
        + r"they are, the joint named last, in the frame of the body,"
        + numbered(rows)
        + r"They project gravity to the generalized active forces and the inertia of the bodies to"
        r" the generalized inertia forces; with the torque of the joint each pair adds up to zero:"
        + numbered(forces)
    )


def energy_steps(kinetic: sp.Expr, potential: sp.Expr, found: Sequence[LagrangeRow]) -> str:
    """Lagrange: kinetic and potential energy, and their derivatives term by term."""
    parts = [
        r"\subsection{Lagrange}With kinetic and potential energy as sums over the bodies, the"
        r" equation of joint $i$ is" + displayed(LAGRANGE) + "The energies are",
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
