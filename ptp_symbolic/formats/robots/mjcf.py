"""MJCF: bodies and joints of MuJoCo, with the defaults of its compiler."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from ptp_symbolic.formats.robots.geoms import geom_inertial
from ptp_symbolic.formats.robots.robot import (
    TURNS,
    Inertial,
    Joint,
    Link,
    Pose,
    Robot,
    checked,
    smallest_turn,
    turned,
    unit,
)
from ptp_symbolic.formats.robots.xml_file import Element, FloatArray
from ptp_symbolic.platform import STANDARD_GRAVITY
from ptp_symbolic.platform.fields import shown

COMPILED = (
    "; let MuJoCo write the file that it compiles, mujoco.mj_saveLastXML(file, model), and give"
    " that one."
)
MACROS = ("include", "frame", "replicate", "attach", "composite", "flexcomp", "flex")
WITHOUT_WORD = (  # that neither move nor weigh
    "compiler",
    "option",
    "size",
    "default",
    "worldbody",
    "visual",
    "statistic",
    "asset",
    "custom",
    "keyframe",
    "sensor",
    "actuator",
)
# What the compiler may be told that changes masses, and the value with which it does not.
OF_MASSES = {"boundmass": 0.0, "boundinertia": 0.0, "settotalmass": -1.0}
LOST_OF_JOINTS = ("springdamper", "actuatorfrcrange", "actuatorgravcomp")


@dataclass
class _Compiler:
    """How numbers of the file are meant: `turn` is an angle's unit in rad."""

    turn: float
    euler: str
    limits_by_range: bool
    geoms: str  # "true", "false" or "auto": whether they have the inertia of their bodies
    defaults: dict[str, dict[str, dict[str, str]]] = field(default_factory=dict)

    def with_defaults(self, element: Element, inherited: str) -> Element:
        """The element with the attributes of its class, or of the one that its body hands down."""
        name = element.attributes.get("class") or inherited
        if name not in self.defaults:
            raise element.refused(f"class {shown(name)} is not defined; define it in <default>.")
        whole = {**self.defaults[name].get(element.tag, {}), **element.attributes}
        return replace(element, attributes=whole)


def read_mjcf(root: Element) -> Robot:
    """The robot of a `<mujoco>`; its base is the world.

    Raises InputError, with the line, for what only MuJoCo's compiler knows (macros, meshes without
    a mass), for names twice, and for numbers that are none.
    """
    compiler = _compiler(root)
    for position, element in enumerate(root.all("default")):
        _read_defaults(element, "main" if position == 0 else "", {}, compiler)
    compiler.defaults.setdefault("main", {})
    _refuse_macros(root)
    option = {k: (v, e) for e in root.all("option") for k, v in e.attributes.items()}
    gravity = np.array([0.0, 0.0, -STANDARD_GRAVITY])
    if "gravity" in option:
        gravity = option["gravity"][1].numbers("gravity", 3)
    tree = _Tree(compiler)
    for world in root.all("worldbody"):
        for body in world.all("body"):
            tree.add(body, "world", "main")
    others = {e.tag: e for e in reversed(root.children) if e.tag not in WITHOUT_WORD}
    lost = [f"<{tag}>, first in line {e.line}: all of it" for tag, e in others.items()]
    lost += [
        f"{word} of the medium, line {e.line}"
        for word, (text, e) in option.items()
        if word in ("density", "viscosity", "wind") and set(text) - set(" 0.")
    ]
    lost += _actuators(root, tree)
    name = root.attributes.get("model", "robot")
    return Robot(name, "world", tree.links, tree.joints, gravity, (*lost, *tree.lost))


def _compiler(root: Element) -> _Compiler:
    given = {k: (v, e) for e in root.all("compiler") for k, v in e.attributes.items()}

    def choice(name: str, choices: tuple[str, ...], default: str) -> str:
        text, element = given.get(name, (default, root))
        if text not in choices:
            raise element.refused(f"{name} = {shown(text)} is not one of {', '.join(choices)}.")
        return text

    for name, harmless in OF_MASSES.items():
        if name in given and given[name][1].number(name) != harmless:
            raise given[name][1].refused(f"{name} changes masses{COMPILED}")
    for name in ("balanceinertia", "inertiagrouprange", "coordinate"):
        if name in given and given[name][0] not in ("false", "0 5", "local"):
            raise given[name][1].refused(f"{name} = {shown(given[name][0])} is not read{COMPILED}")
    euler = given.get("eulerseq", ("xyz", root))
    if len(euler[0]) != 3 or set(euler[0]) - set("xyzXYZ"):
        raise euler[1].refused(f"eulerseq = {shown(euler[0])} is not three of x, y, z, X, Y, Z.")
    degrees = choice("angle", ("degree", "radian"), "degree") == "degree"
    return _Compiler(
        math.pi / 180.0 if degrees else 1.0,
        euler[0],
        choice("autolimits", ("true", "false"), "true") == "true",
        choice("inertiafromgeom", ("true", "false", "auto"), "auto"),
    )


def _read_defaults(
    element: Element, name: str, above: Mapping[str, dict[str, str]], compiler: _Compiler
) -> None:
    """Attributes of every tag by class, those of the classes around it included."""
    name = element.attributes.get("class") or name or "main"
    own = {tag: dict(attributes) for tag, attributes in above.items()}
    for child in element.children:
        if child.tag != "default":
            own[child.tag] = {**own.get(child.tag, {}), **child.attributes}
    compiler.defaults[name] = {**compiler.defaults.get(name, {}), **own}
    for child in element.all("default"):
        child.required("class")
        _read_defaults(child, "", own, compiler)


def _refuse_macros(element: Element) -> None:
    for child in element.children:
        if child.tag in MACROS:
            raise child.refused(f"is not read{COMPILED}")
        _refuse_macros(child)


class _Tree:
    """Links and joints of the bodies added so far."""

    def __init__(self, compiler: _Compiler) -> None:
        self.compiler = compiler
        self.links = {"world": Link("world", ())}
        self.joints: dict[str, Joint] = {}
        self.lost: list[str] = []

    def add(self, body: Element, parent: str, inherited: str) -> None:
        """Add a body and those that it carries."""
        inherited = body.attributes.get("childclass", inherited)
        name = body.name or f"body{len(self.links)}"
        joints = [e for e in body.children if e.tag in ("joint", "freejoint")]
        names = [*(f"{name} before {shown(e.name)}" for e in joints[1:]), name]
        pose = self.pose(body)
        for position, link in enumerate(names):
            if link in self.links:
                raise body.refused(f"a second body {shown(link)}; rename one.")
            own = self.bodies(body, inherited) if link == name else ()
            self.links[link] = Link(link, own)
            if joints:
                label = joints[position].name or f"{name}.{position + 1}"
                joint = self.joint(joints[position], label, parent, link, pose, inherited)
            else:
                joint = Joint(f"{name}.0", "fixed", parent, link, pose, body)
            if joint.name in {j.name for j in self.joints.values()}:
                raise joint.element.refused(f"a second joint {shown(joint.name)}; rename one.")
            self.joints[link] = joint
            parent, pose = link, Pose()
        if body.number("gravcomp", 0.0):
            self.lost.append(f"gravity compensation of body {shown(name)}, line {body.line}")
        for child in body.all("body"):
            self.add(child, name, inherited)

    def joint(
        self, element: Element, name: str, parent: str, child: str, pose: Pose, inherited: str
    ) -> Joint:
        """A joint between two links."""
        free = element.tag == "freejoint"
        own = element if free else self.compiler.with_defaults(element, inherited)
        kind = "free" if free else own.attributes.get("type", "hinge")
        if kind not in ("free", "ball", "slide", "hinge"):
            raise own.refused(f"type = {shown(kind)} is not one of free, ball, slide, hinge.")
        if kind != "hinge":
            return Joint(name, kind, parent, child, pose, element)
        turn, drawn = self.compiler.turn, own.number("ref", 0.0) * self.compiler.turn
        lost = [
            f"{word} = {shown(own.attributes[word])}"
            for word in LOST_OF_JOINTS
            if word in own.attributes
        ]
        if drawn:
            lost.append(f"ref: theta is {drawn:g} rad less than the angle of the file")
        limits = self.limits(own)
        return Joint(
            name,
            TURNS,
            parent,
            child,
            pose,
            element,
            unit(own.numbers("axis", 3, [0, 0, 1]), own, "axis"),
            own.numbers("pos", 3, [0, 0, 0]),
            damping=own.positive("damping", 0.0),
            friction=own.positive("frictionloss", 0.0),
            armature=own.positive("armature", 0.0),
            stiffness=own.positive("stiffness", 0.0),
            rest=own.number("springref", 0.0) * turn - drawn,
            limits=None if limits is None else (limits[0] - drawn, limits[1] - drawn),
            lost=tuple(lost),
        )

    def limits(self, joint: Element) -> tuple[float, float] | None:
        """Angles in rad of a joint's ends, None where it has none."""
        limited = joint.attributes.get("limited", "auto")
        if limited == "auto":
            limited = "true" if self.compiler.limits_by_range else "false"
        if limited != "true" or "range" not in joint.attributes:
            return None
        low, high = joint.numbers("range", 2) * self.compiler.turn
        return float(low), float(high)

    def bodies(self, body: Element, inherited: str) -> tuple[Inertial, ...]:
        """What of a body has a mass: its `<inertial>`, or its geoms that have one."""
        way, element = self.compiler.geoms, body.first("inertial")
        explicit = () if element is None else (self.inertial(element),)
        if way == "false" or (way == "auto" and explicit):
            return explicit
        found = []
        for geom in body.all("geom"):
            own = self.compiler.with_defaults(geom, inherited)
            inertial, pose = geom_inertial(own, self.pose(own), COMPILED)
            found.append(inertial.seen_from(pose))
        return tuple(found) if any(each.mass for each in found) else explicit

    def inertial(self, element: Element) -> Inertial:
        """An explicit `<inertial>`."""
        pose = self.pose(element, "pos")
        if "fullinertia" in element.attributes:
            xx, yy, zz, xy, xz, yz = element.numbers("fullinertia", 6)
            inertia = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        else:
            inertia = np.diag(element.numbers("diaginertia", 3))
        body = Inertial(element.positive("mass"), np.zeros(3), inertia)
        return checked(body, element).seen_from(pose)

    def pose(self, element: Element, needed: str | None = None) -> Pose:
        """Position and orientation of an element, in any of MJCF's ways."""
        default = None if needed else [0, 0, 0]
        position = element.numbers("pos", 3, default)
        ways = {
            "quat": self.by_quaternion,
            "axisangle": self.by_axis,
            "euler": self.by_euler,
            "xyaxes": self.by_axes,
            "zaxis": self.by_z,
        }
        given = [way for way in ways if way in element.attributes]
        if len(given) > 1:
            raise element.refused(f"has {' and '.join(given)}; give one orientation.")
        return Pose(ways[given[0]](element) if given else np.eye(3), position)

    def by_quaternion(self, element: Element) -> FloatArray:
        """Rotation of (w, x, y, z), of any length."""
        w, *v = unit(element.numbers("quat", 4), element, "quat")
        length = float(np.linalg.norm(v))
        if length == 0.0:
            return np.eye(3)
        return turned(np.array(v) / length, 2.0 * math.atan2(length, w))

    def by_axis(self, element: Element) -> FloatArray:
        """Rotation about an axis."""
        *axis, angle = element.numbers("axisangle", 4)
        return turned(unit(np.array(axis), element, "axisangle"), angle * self.compiler.turn)

    def by_euler(self, element: Element) -> FloatArray:
        """Three rotations, about axes that turn along (small letters) or stay (capitals)."""
        rotation = np.eye(3)
        for letter, angle in zip(self.compiler.euler, element.numbers("euler", 3), strict=True):
            axis = np.eye(3)["xyz".index(letter.lower())]
            turn = turned(axis, angle * self.compiler.turn)
            rotation = rotation @ turn if letter.islower() else turn @ rotation
        return rotation

    def by_axes(self, element: Element) -> FloatArray:
        """Rotation with a given x axis, and y axis as far as it is across."""
        given = element.numbers("xyaxes", 6)
        x = unit(given[:3], element, "xyaxes")
        y = unit(given[3:] - (given[3:] @ x) * x, element, "xyaxes")
        return np.column_stack([x, y, np.cross(x, y)])

    def by_z(self, element: Element) -> FloatArray:
        """The smallest rotation with a given z axis."""
        return smallest_turn(unit(element.numbers("zaxis", 3), element, "zaxis"))


def _actuators(root: Element, tree: _Tree) -> list[str]:
    """What is lost of actuators: all but a motor whose control is the torque on its joint."""
    lost = []
    for element in (e for group in root.all("actuator") for e in group.children):
        own = tree.compiler.with_defaults(element, "main")
        gear = own.numbers("gear", len(own.attributes.get("gear", "1").split()), [1.0])
        if own.tag == "motor" and own.attributes.get("joint") in {
            j.name for j in tree.joints.values()
        }:
            if gear[0] != 1.0:
                lost.append(
                    f"gear {gear[0]:g} of motor {shown(own.name)}, line {element.line}: the input"
                    " of the platform is the torque on the joint"
                )
        else:
            lost.append(f"<{own.tag}> {shown(own.name)}, line {element.line}: all of it")
    return lost
