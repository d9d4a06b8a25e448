"""A robot seen as a pan-tilt platform: its axes, and what each of them carries as one body."""

import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass

import numpy as np

from ptp_symbolic.errors import InputError, unknown
from ptp_symbolic.formats.robots.robot import TURNS, Inertial, Joint, Robot, lumped
from ptp_symbolic.formats.robots.xml_file import FloatArray
from ptp_symbolic.platform.fields import shown

OFF_SQUARE = 1e-3  # rad; axes nearer to square are square: 1.57 for pi/2 is off by 8e-4
ROUNDING = 1e-9  # rad; what the digits of a file leave of a right angle, not worth a word
HIGHEST_LEAN = 1.5  # rad; between pan axis and vertical, as far as base_tilt goes


@dataclass(frozen=True)
class Carried:
    """An axis of the platform: its joint, the links that it carries up to the next axis and
    their one body in its frame, and `sign`: -1 where the joint turns the other way.
    """

    joint: Joint
    links: tuple[str, ...]
    body: Inertial
    sign: float


@dataclass(frozen=True)
class Seen:
    """A robot as a platform. `frame` [3, 3] has the axes x, y, z of the platform at zero angles in
    the base of the file, `ahead` in m is the tilt axis along x, `gravity` [3] in m/s^2 is in the
    frame; `notes` say what was changed on the way.
    """

    axes: Mapping[str, Carried]
    frame: FloatArray
    ahead: float
    gravity: FloatArray
    notes: tuple[str, ...]


def seen(robot: Robot, named: Mapping[str, str], freeze: Collection[str]) -> Seen:
    """`robot` with the joints `named` by axis; the joints `freeze` stay as they are drawn.

    Raises InputError, with the line, for names that are no joints, for pan and tilt joints that do
    not turn, stand in no chain or are not square to each other or to gravity as far as a platform
    needs it, and for other joints that move in the chain.
    """
    joints = {axis: _turning(robot, axis, name) for axis, name in named.items()}
    _check_frozen(robot, joints, freeze)
    last = joints[tuple(joints)[-1]]
    if "pan" in joints and "tilt" in joints and joints["pan"] not in robot.above(last.parent):
        raise last.element.refused(
            f"tilt joint {shown(last.name)} is not carried by pan joint"
            f" {shown(joints['pan'].name)} (line {joints['pan'].element.line}); swap the two, or"
            " name joints of one chain."
        )
    carried = _carried(robot, joints)
    _refuse_others(robot, joints, carried, freeze)
    frame, signs, notes = _frame(robot, joints)
    points = {a: robot.pose(j.child).point(j.point) for a, j in joints.items()}
    first = points[next(iter(joints))]
    apart = frame.T @ (points.get("tilt", first) - first)
    ahead = float(apart[0]) if abs(apart[0]) > 1e-12 else 0.0  # m
    origin = {"pan": first + frame[:, 2] * apart[2]}
    origin["tilt"] = origin["pan"] + ahead * frame[:, 0] if "pan" in joints else first
    axes = {}
    for axis, joint in joints.items():
        bodies = [
            b.seen_from(robot.pose(name))
            for name in carried[axis]
            for b in robot.links[name].bodies
        ]
        whole = lumped(bodies)
        com = frame.T @ (whole.com - origin[axis]) if whole.mass else np.zeros(3)
        body = Inertial(whole.mass, com, frame.T @ whole.inertia @ frame)
        axes[axis] = Carried(joint, tuple(carried[axis]), body, signs[axis])
    return Seen(axes, frame, ahead, frame.T @ robot.gravity, tuple(notes))


def _carried(robot: Robot, joints: Mapping[str, Joint]) -> dict[str, list[str]]:
    """Names of the links that each axis carries, up to the next."""
    carried: dict[str, list[str]] = {axis: [] for axis in joints}
    for link in robot.links:
        above = robot.above(link)
        axis = next((a for a in reversed(tuple(joints)) if joints[a] in above), None)
        if axis is not None:
            carried[axis].append(link)
    return carried


def _turning(robot: Robot, axis: str, name: str) -> Joint:
    own = {joint.name: joint for joint in robot.joints.values() if joint.moves}
    if name not in own:
        raise unknown(f"{axis} joint", name, map(_plain, own))
    joint = own[name]
    if joint.kind != TURNS:
        raise joint.element.refused(
            f"{axis} joint {shown(name)} is {joint.kind}; the joints of a platform turn about one"
            " axis: name a revolute or continuous joint (URDF), a hinge (MJCF)."
        )
    return joint


def _check_frozen(robot: Robot, joints: Mapping[str, Joint], freeze: Collection[str]) -> None:
    own = [joint.name for joint in robot.joints.values() if joint.moves]
    for name in freeze:
        if name not in own:
            raise unknown("joint to freeze", name, map(_plain, own))
        for axis, joint in joints.items():
            if joint.name == name:
                raise InputError(f"Joint {shown(name)} is the {axis} axis; do not freeze it.")


def _refuse_others(
    robot: Robot,
    joints: Mapping[str, Joint],
    carried: Mapping[str, list[str]],
    freeze: Collection[str],
) -> None:
    """Refuse joints that move before the last axis or behind the first, unless they are frozen."""
    links = [link for own in carried.values() for link in own]
    chain = [robot.joints[link] for link in links]
    chain += robot.above(next(iter(joints.values())).parent)
    for joint in chain:
        if joint.moves and joint not in joints.values() and joint.name not in freeze:
            how = "turns" if joint.kind == TURNS else f"is {joint.kind}"
            raise joint.element.refused(
                f"joint {shown(joint.name)} {how} too, in the chain of pan and tilt; a platform"
                f" has two joints: hold it where it is drawn with --freeze {shown(joint.name)}."
            )


def _frame(
    robot: Robot, joints: Mapping[str, Joint]
) -> tuple[FloatArray, dict[str, float], list[str]]:
    """Axes of the platform at zero angles in the base, signs of the joints, notes."""
    directions = {a: robot.pose(j.child).rotation @ j.axis for a, j in joints.items()}
    g = float(np.linalg.norm(robot.gravity))
    up: FloatArray = -robot.gravity / g if g else directions.get("pan", np.eye(3)[2])
    signs: dict[str, float] = dict.fromkeys(joints, 1.0)
    notes: list[str] = []
    if "pan" not in directions:
        y = directions["tilt"]
        up = up if g else _square_to(y)
        z = up - _across(y, up, joints["tilt"], "the vertical", notes) * y
    else:
        signs["pan"] = 1.0 if directions["pan"] @ up >= 0.0 else -1.0
        z = signs["pan"] * directions["pan"]
        lean = math.atan2(float(np.linalg.norm(np.cross(z, up))), float(z @ up))
        if lean > HIGHEST_LEAN:
            raise joints["pan"].element.refused(
                f"the axis of pan joint {shown(joints['pan'].name)} leans by {_degrees(lean)} from"
                f" the vertical, gravity being {np.round(robot.gravity, 6).tolist()} m/s^2; it may"
                f" lean by {_degrees(HIGHEST_LEAN)}: name the joint that turns about the vertical."
            )
        if "tilt" in directions:
            y = directions["tilt"]
            y = y - _across(y, z, joints["tilt"], "the pan axis", notes) * z
        else:
            y = _square_to(z)
    y, z = y / np.linalg.norm(y), z / np.linalg.norm(z)
    if signs.get("pan", 1.0) < 0.0:
        notes.append(f"theta_pan is minus the angle of {shown(joints['pan'].name)}: it turns down")
    return np.column_stack([np.cross(y, z), y, z]), signs, notes


def _across(axis: FloatArray, other: FloatArray, joint: Joint, of: str, notes: list[str]) -> float:
    """The part of one unit vector along another, next to nothing where they are square."""
    along = float(axis @ other)
    off = abs(math.asin(max(-1.0, min(1.0, along))))
    if off > OFF_SQUARE:
        found = _degrees(math.pi / 2 - off)
        raise joint.element.refused(
            f"the axis of tilt joint {shown(joint.name)} and {of} make {found}; a platform"
            f" has 90 deg, to {_degrees(OFF_SQUARE)}: name another joint, or correct"
            " the angles of the file."
        )
    if off > ROUNDING:
        notes.append(
            f"{math.pi / 2 - off:.9g} rad between the axis of {shown(joint.name)} and {of}: taken"
            " as a right angle"
        )
    return along


def _square_to(axis: FloatArray) -> FloatArray:
    """Some direction [3] across a unit vector."""
    return np.cross(axis, np.eye(3)[0 if abs(axis[0]) < 0.9 else 1])


def _degrees(angle: float) -> str:
    return f"{math.degrees(angle):.4g} deg"


def _plain(name: str) -> str:
    return name if name.isprintable() else shown(name)
