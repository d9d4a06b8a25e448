"""MJCF and URDF: the rigid part of a machine for simulators of bodies, and what is lost in it."""

import xml.etree.ElementTree as ET
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
import sympy as sp

from ptp_symbolic.symbolic.mechanics.bodies import Body
from ptp_symbolic.symbolic.mechanics.kinematics import place_of
from ptp_symbolic.symbolic.program.program import Program
from ptp_symbolic.symbolic.symbols import real
from ptp_symbolic.symbolic.targets.target import effects_of

# Effects that are bodies, gravity or where axes lie: whole in both formats but for URDF's gravity.
BODIES = {
    "rigid_bodies",
    "payload",
    "payload_com_offset",
    "product_of_inertia",
    "axis_offset",
    "pan_com_offset",
    "base_tilt",
}
# What a joint has in these formats, and what of the effect is lost.
JOINT_PARTS = {
    "viscous_friction": "",
    "csvs_friction": "static and Stribeck friction; Coulomb friction is that of the solver",
    "dc_motor": "windings and back EMF; its rotor is the armature of the joint",
    "cable_spring": "the cubic part",
}
STANDARD_GRAVITY = 9.81  # m/s^2; where no equation has gravity in it
STAND_IN = 1.0  # kg; mass of a body whose mass is not declared, on the axes, where it has no effect
LEAST_MASS = 1e-12  # kg; of such a body off the pan axis: simulators refuse zero


@dataclass(frozen=True)
class Joint:
    """A joint with the numbers that a simulator of bodies knows, in SI units."""

    axis: str
    slides: bool
    origin: tuple[float, float, float]
    damping: float
    friction: float
    armature: float
    stiffness: float
    rest: float


@dataclass(frozen=True)
class Inertial:
    """A rigid body in the frame of its joint: mass in kg, centre of mass [3] in m, inertia [3, 3]
    in kg m^2 about it.
    """

    name: str
    mass: float
    com: tuple[float, ...]
    inertia: tuple[tuple[float, ...], ...]


class Machine:
    """The rigid part of a program in numbers."""

    def __init__(self, program: Program) -> None:
        self.equations = program.equations
        self.values = {p.name: float(p.default) for p in self.equations.parameters}
        self.rigid = self.equations.rigid
        self.lost = _lost(program, self)

    def number(self, expression: sp.Expr) -> float:
        """The value of an expression of parameters."""
        symbols = {real("gravity"): STANDARD_GRAVITY}
        symbols |= {p.symbol: self.values[p.name] for p in self.equations.parameters}
        return float(expression.subs(symbols))

    @property
    def gravity(self) -> tuple[float, ...]:
        """Gravity [3] in the base frame, in m/s^2."""
        return tuple(self.number(g) for g in self.rigid.gravity)

    def joint(self, axis: str) -> Joint:
        """The joint of an axis."""
        still = self.rigid.offsets.get(axis, sp.ImmutableMatrix([0, 0, 0]))
        x, y, z = (self.number(o) for o in still)

        def have(effect: str, name: str) -> float:
            declared = any(p.effect.id == effect and p.axis == axis for p in self.equations.effects)
            return self.values.get(f"{name}_{axis}", 0.0) if declared else 0.0

        return Joint(
            axis,
            axis in self.rigid.sliding,
            (x, y, z),
            have("viscous_friction", "b") + have("csvs_friction", "F_v"),
            have("csvs_friction", "F_c"),
            _rotor(self, axis) or 0.0,
            have("cable_spring", "k1_cable"),
            have("cable_spring", "theta0_cable"),
        )

    def bodies(self, axis: str) -> list[Inertial]:
        """The bodies that the frame behind a joint carries. The inertia of one without a mass is
        that of the others, wherever they are.
        """
        own = [self._inertial(b, axis) for b in self.rigid.bodies if b.frame == axis]
        heavy = [b for b in own if b.mass]
        if not heavy:
            mass = LEAST_MASS if self.rigid.offsets.get(axis) else STAND_IN
            return [replace(b, mass=mass) for b in own]
        first, *others = heavy
        tensor = np.sum([b.inertia for b in own if not b.mass or b is first], axis=0)
        return [replace(first, inertia=tuple(map(tuple, tensor.tolist()))), *others]

    def _inertial(self, body: Body, axis: str) -> Inertial:
        mass = self.number(body.mass)
        inertia = [[self.number(body.inertia[i, j]) for j in range(3)] for i in range(3)]
        first = self.rigid.axes[0] == axis
        if first and axis == "pan" and inertia[0][0] == inertia[1][1] == 0.0:
            inertia[0][0] = inertia[1][1] = inertia[2][2]  # a body that turns about z alone
        return Inertial(
            body.name,
            mass,
            tuple(self.number(c) for c in body.com),
            tuple(map(tuple, inertia)),
        )


def _lost(program: Program, machine: Machine) -> list[str]:
    """What these formats cannot say of a program, a line per effect."""
    lines = [
        f"rotor on {axis}: its inertia changes with the angle"
        for axis in machine.rigid.axes
        if _rotor(machine, axis) is None
    ]
    for key in effects_of(program):
        effect = key.partition("@")[0]
        if effect in JOINT_PARTS:
            if JOINT_PARTS[effect]:
                lines.append(f"{key}: {JOINT_PARTS[effect]}")
        elif effect not in BODIES:
            lines.append(f"{key}: all of it")
    return lines


def _rotor(machine: Machine, axis: str) -> float | None:
    """Inertia in kg m^2 that the rotor adds to the rows of an axis; None where that changes with
    the angle, as behind a linkage.
    """
    equations = machine.equations
    inertia = real(f"J_motor_{axis}")
    rows = [k for k, q in enumerate(equations.coordinates) if place_of(q).endswith(axis)]
    whole = sum((equations.mass_matrix[k, k] for k in rows), start=sp.Integer(0))
    added = inertia * sp.diff(equations.written_out(whole), inertia)
    known = {p.symbol for p in equations.parameters}
    return machine.number(added) if added.free_symbols <= known else None


def _text(*numbers: float) -> str:
    return " ".join(repr(float(n)) for n in numbers)


def _document(root: ET.Element, lost: list[str]) -> str:
    """The document with what is lost as a comment at its head."""
    said = ["Rigid part of a pan-tilt platform, in SI units."]
    said += ["Not in this file:", *(f"  {line}" for line in lost)] if lost else []
    ET.indent(root)
    comment = "\n".join(said).replace("--", "- -")
    return f"<!-- {comment} -->\n{ET.tostring(root, encoding='unicode')}\n"


class Mjcf:
    """``name.xml`` for MuJoCo: bodies with full inertia tensors, joints, motors of unit gear."""

    name = "mjcf"
    summary = "MuJoCo model of the rigid part"

    def refuse(self, program: Program) -> str | None:
        """Nothing is refused: what is lost is listed."""
        return None

    def remarks(self, program: Program) -> list[str]:
        """What is lost."""
        return [f"not in the file: {line}" for line in Machine(program).lost]

    def files(self, program: Program, name: str) -> Mapping[str, str]:
        """One file."""
        machine = Machine(program)
        root = ET.Element("mujoco", model=name)
        ET.SubElement(root, "compiler", angle="radian", inertiafromgeom="false")
        ET.SubElement(root, "option", gravity=_text(*machine.gravity))
        parent = ET.SubElement(root, "worldbody")
        for axis in machine.rigid.axes:
            joint = machine.joint(axis)
            parent = ET.SubElement(parent, "body", name=axis, pos=_text(*joint.origin))
            ET.SubElement(
                parent,
                "joint",
                name=axis,
                type="slide" if joint.slides else "hinge",
                axis="1 0 0" if joint.slides else "0 0 1" if axis == "pan" else "0 1 0",
                damping=_text(joint.damping),
                frictionloss=_text(joint.friction),
                armature=_text(joint.armature),
                stiffness=_text(joint.stiffness),
                springref=_text(joint.rest),
            )
            first, *others = machine.bodies(axis)
            self._inertial(parent, first)
            for body in others:
                self._inertial(ET.SubElement(parent, "body", name=f"{axis}_{body.name}"), body)
        motors = ET.SubElement(root, "actuator")
        for axis in machine.rigid.axes:
            ET.SubElement(motors, "motor", name=f"tau_{axis}", joint=axis)
        return {f"{name}.xml": _document(root, machine.lost)}

    def _inertial(self, parent: ET.Element, body: Inertial) -> None:
        t = body.inertia
        full = (t[0][0], t[1][1], t[2][2], t[0][1], t[0][2], t[1][2])
        numbers = {"mass": _text(body.mass), "pos": _text(*body.com), "fullinertia": _text(*full)}
        ET.SubElement(parent, "inertial", numbers)


class Urdf:
    """``name.urdf``: links and joints for ROS and others; rpy is 0 throughout."""

    name = "urdf"
    summary = "URDF of the rigid part"

    def refuse(self, program: Program) -> str | None:
        """Nothing is refused: what is lost is listed."""
        return None

    def remarks(self, program: Program) -> list[str]:
        """What is lost."""
        return [f"not in the file: {line}" for line in self._lost(Machine(program))]

    def _lost(self, machine: Machine) -> list[str]:
        joints = [machine.joint(axis) for axis in machine.rigid.axes]
        lost = list(machine.lost)
        lost += [f"inertia of the rotor on {j.axis}" for j in joints if j.armature]
        lost += [f"cable_spring@{j.axis}: its linear part" for j in joints if j.stiffness]
        if any(machine.gravity[:2]):
            lost.append(f"gravity {_text(*machine.gravity)} m/s^2, not along z")
        return lost

    def files(self, program: Program, name: str) -> Mapping[str, str]:
        """One file."""
        machine = Machine(program)
        root = ET.Element("robot", name=name)
        ET.SubElement(root, "link", name="base")
        parent = "base"
        for axis in machine.rigid.axes:
            joint = machine.joint(axis)
            element = ET.SubElement(
                root, "joint", name=axis, type="prismatic" if joint.slides else "continuous"
            )
            ET.SubElement(element, "parent", link=parent)
            ET.SubElement(element, "child", link=axis)
            ET.SubElement(element, "origin", xyz=_text(*joint.origin), rpy="0 0 0")
            along = "1 0 0" if joint.slides else "0 0 1" if axis == "pan" else "0 1 0"
            ET.SubElement(element, "axis", xyz=along)
            if joint.slides:
                wide = {"lower": "-1e3", "upper": "1e3", "effort": "1e6", "velocity": "1e3"}
                ET.SubElement(element, "limit", wide)
            ET.SubElement(
                element, "dynamics", damping=_text(joint.damping), friction=_text(joint.friction)
            )
            first, *others = machine.bodies(axis)
            self._link(root, axis, first)
            for body in others:
                link = f"{axis}_{body.name}"
                fixed = ET.SubElement(root, "joint", name=link, type="fixed")
                ET.SubElement(fixed, "parent", link=axis)
                ET.SubElement(fixed, "child", link=link)
                self._link(root, link, body)
            parent = axis
        return {f"{name}.urdf": _document(root, self._lost(machine))}

    def _link(self, root: ET.Element, name: str, body: Inertial) -> None:
        inertial = ET.SubElement(ET.SubElement(root, "link", name=name), "inertial")
        ET.SubElement(inertial, "origin", xyz=_text(*body.com), rpy="0 0 0")
        ET.SubElement(inertial, "mass", value=_text(body.mass))
        t = body.inertia
        tensor = {f"i{'xyz'[i]}{'xyz'[j]}": _text(t[i][j]) for i in range(3) for j in range(i, 3)}
        ET.SubElement(inertial, "inertia", tensor)
