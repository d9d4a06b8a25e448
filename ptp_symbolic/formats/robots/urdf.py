"""URDF: links and joints of ROS."""

import numpy as np

from ptp_symbolic.errors import InputError
from ptp_symbolic.formats.robots.robot import (
    TURNS,
    Inertial,
    Joint,
    Link,
    Pose,
    Robot,
    checked,
    turned,
    unit,
)
from ptp_symbolic.formats.robots.xml_file import Element, FloatArray
from ptp_symbolic.platform import STANDARD_GRAVITY
from ptp_symbolic.platform.fields import shown

KINDS = ("fixed", "revolute", "continuous", "prismatic", "floating", "planar")
DRAWN = ("link", "joint", "material")  # elements that need no word; others are lost
LOST_OF_JOINTS = ("mimic", "safety_controller")


def read_urdf(root: Element) -> Robot:
    """The robot of a `<robot>`; its base is level and gravity is -z, as ROS has it.

    Raises InputError, with the line, for what is no URDF: names twice or not there, a link with
    two joints before it, no base or several, numbers that are none.
    """
    for element in root.children:
        if element.tag.startswith("xacro:"):
            raise element.refused("is xacro; write the URDF first: xacro FILE > robot.urdf")
    links: dict[str, Link] = {}
    for element in root.all("link"):
        name = element.required("name")
        if name in links:
            raise element.refused(f"a second link {shown(name)}; rename one.")
        links[name] = Link(name, tuple(_inertial(element)))
    joints: dict[str, Joint] = {}
    for element in root.all("joint"):
        joint = _joint(element, links)
        if joint.child in joints or joint.name in {j.name for j in joints.values()}:
            raise element.refused(
                f"a second joint before {shown(joint.child)}, or called {shown(joint.name)};"
                " remove or rename one."
            )
        joints[joint.child] = joint
    bases = [name for name in links if name not in joints]
    if len(bases) != 1:
        found = ", ".join(map(shown, bases)) or "none"
        raise InputError(
            f"{root.where}: a robot has one link without a joint before it, its base; here are:"
            f" {found}. Join the links into one tree."
        )
    others = {e.tag: e for e in reversed(root.children) if e.tag not in DRAWN}
    lost = (f"<{tag}>, first in line {e.line}: all of it" for tag, e in others.items())
    gravity = np.array([0.0, 0.0, -STANDARD_GRAVITY])
    robot = Robot(root.name or "robot", bases[0], links, joints, gravity, tuple(lost))
    for joint in joints.values():
        _refuse_loop(joint, joints)
    return robot


def _refuse_loop(joint: Joint, joints: dict[str, Joint]) -> None:
    seen, link = set(), joint.parent
    while link in joints:
        if link in seen:
            raise joint.element.refused(f"link {shown(link)} carries itself; break the loop.")
        seen.add(link)
        link = joints[link].parent


def _inertial(link: Element) -> list[Inertial]:
    element = link.first("inertial")
    if element is None:
        return []
    mass, tensor = element.first("mass"), element.first("inertia")
    if mass is None or tensor is None:
        raise element.refused("needs <mass> and <inertia>; add what is missing.")
    pose = _pose(element)
    inertia = np.zeros((3, 3))
    for i in range(3):
        for j in range(i, 3):
            default = None if i == j else 0.0
            inertia[i, j] = inertia[j, i] = tensor.number(f"i{'xyz'[i]}{'xyz'[j]}", default)
    body = Inertial(mass.positive("value"), np.zeros(3), inertia)
    return [checked(body, tensor).seen_from(pose)]


def _pose(element: Element) -> Pose:
    origin = element.first("origin")
    if origin is None:
        return Pose()
    return Pose(_rpy(origin.numbers("rpy", 3, [0, 0, 0])), origin.numbers("xyz", 3, [0, 0, 0]))


def _rpy(angles: FloatArray) -> FloatArray:
    """Rotation [3, 3] of roll, pitch and yaw in rad about fixed axes x, y, z."""
    x, y, z = (turned(axis, a) for axis, a in zip(np.eye(3), angles, strict=True))
    return z @ y @ x


def _joint(element: Element, links: dict[str, Link]) -> Joint:
    kind = element.required("type")
    if kind not in KINDS:
        raise element.refused(f"type {shown(kind)} is not one of {', '.join(KINDS)}.")
    ends: dict[str, str] = {}
    for end in ("parent", "child"):
        named = element.first(end)
        link = named.required("link") if named is not None else ""
        if link not in links:
            raise element.refused(f"its {end} {shown(link)} is no link of the file; name one.")
        ends[end] = link
    turns = kind in ("revolute", "continuous")
    axis, dynamics = element.first("axis"), element.first("dynamics")
    along = np.array([1.0, 0.0, 0.0])
    if axis is not None and kind not in ("fixed", "floating"):
        along = unit(axis.numbers("xyz", 3), axis, "xyz")
    limits, lost = _limits(element, kind)
    return Joint(
        element.required("name"),
        TURNS if turns else kind,
        ends["parent"],
        ends["child"],
        _pose(element),
        element,
        along,
        damping=dynamics.positive("damping", 0.0) if dynamics is not None else 0.0,
        friction=dynamics.positive("friction", 0.0) if dynamics is not None else 0.0,
        limits=limits,
        lost=(
            *lost,
            *(f"<{e.tag}>: all of it" for e in element.children if e.tag in LOST_OF_JOINTS),
        ),
    )


def _limits(joint: Element, kind: str) -> tuple[tuple[float, float] | None, list[str]]:
    """Angles in rad between which a joint turns, and limits that are no angles."""
    element = joint.first("limit")
    if element is None:
        return None, []
    lost = [
        f"limit of the {word}, {element.number(word):g} {unit}"
        for word, unit in (("effort", "N m"), ("velocity", "rad/s"))
        if word in element.attributes
    ]
    if kind != "revolute":
        return None, lost
    return (element.number("lower", 0.0), element.number("upper", 0.0)), lost
