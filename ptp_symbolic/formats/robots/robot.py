"""A tree of links and joints, as URDF and MJCF have it, in SI units."""

import math
from dataclasses import dataclass, field

import numpy as np

from ptp_symbolic.formats.robots.xml_file import Element, FloatArray

TURNS = "turns"  # kind of a joint about an axis; all others are words of the file


@dataclass(frozen=True)
class Pose:
    """Where a frame lies in another: `rotation` [3, 3] turns its vectors into the other,
    `position` [3] in m is its origin.
    """

    rotation: FloatArray = field(default_factory=lambda: np.eye(3))
    position: FloatArray = field(default_factory=lambda: np.zeros(3))

    def __matmul__(self, inner: "Pose") -> "Pose":
        return Pose(self.rotation @ inner.rotation, self.point(inner.position))

    def point(self, point: FloatArray) -> FloatArray:
        """A point [3] of this frame in the other."""
        return self.position + self.rotation @ point


@dataclass(frozen=True)
class Inertial:
    """A rigid body: mass in kg, centre of mass [3] in m, inertia [3, 3] in kg m^2 about it."""

    mass: float
    com: FloatArray
    inertia: FloatArray

    def seen_from(self, pose: Pose) -> "Inertial":
        """The body in the frame in which `pose` places its own."""
        turn = pose.rotation
        return Inertial(self.mass, pose.point(self.com), turn @ self.inertia @ turn.T)


NOTHING = Inertial(0.0, np.zeros(3), np.zeros((3, 3)))


def lumped(bodies: list[Inertial]) -> Inertial:
    """Bodies that move as one, in one frame, by the theorem of parallel axes."""
    mass = sum(b.mass for b in bodies)
    if not bodies:
        return NOTHING
    com = sum(b.mass * b.com for b in bodies) / mass if mass else np.zeros(3)
    inertia = np.zeros((3, 3))
    for body in bodies:
        inertia += body.inertia + about(body.mass, body.com - com)
    return Inertial(mass, np.asarray(com), inertia)


def about(mass: float, arm: FloatArray) -> FloatArray:
    """Inertia [3, 3] in kg m^2 of a point mass at `arm` [3] in m."""
    return mass * (arm @ arm * np.eye(3) - np.outer(arm, arm))


@dataclass(frozen=True)
class Link:
    """A body of the file, and its parts in its own frame."""

    name: str
    bodies: tuple[Inertial, ...]


@dataclass(frozen=True)
class Joint:
    """A joint before the link `child`: its `kind`, the `pose` of the child in its parent where the
    file draws it, and axis [3] and a point [3] of it in the child.

    `damping` in N m s/rad, `friction` in N m, `armature` in kg m^2, `stiffness` in N m/rad; `rest`
    of the spring and `limits` in rad, from where the file draws it. `lost` is what else the file
    says of it.
    """

    name: str
    kind: str
    parent: str
    child: str
    pose: Pose
    element: Element
    axis: FloatArray = field(default_factory=lambda: np.array([0.0, 0.0, 1.0]))
    point: FloatArray = field(default_factory=lambda: np.zeros(3))
    damping: float = 0.0
    friction: float = 0.0
    armature: float = 0.0
    stiffness: float = 0.0
    rest: float = 0.0
    limits: tuple[float, float] | None = None
    lost: tuple[str, ...] = ()

    @property
    def moves(self) -> bool:
        """Whether it is no fixed one."""
        return self.kind != "fixed"


@dataclass(frozen=True)
class Robot:
    """Links by name, the joint before each but the base, gravity [3] in m/s^2, what is lost."""

    name: str
    base: str
    links: dict[str, Link]
    joints: dict[str, Joint]  # by the name of the child
    gravity: FloatArray
    lost: tuple[str, ...] = ()

    def above(self, link: str) -> list[Joint]:
        """Joints from a link up to the base, the nearest first."""
        found = []
        while link in self.joints:
            found.append(self.joints[link])
            link = found[-1].parent
        return found

    def pose(self, link: str) -> Pose:
        """Where the frame of a link lies in that of the base, as drawn."""
        pose = Pose()
        for joint in reversed(self.above(link)):
            pose = pose @ joint.pose
        return pose


def turned(axis: FloatArray, angle: float) -> FloatArray:
    """Rotation [3, 3] by an angle in rad about a unit vector [3]: Rodrigues' formula."""
    x, y, z = axis
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + np.sin(angle) * cross + (1.0 - np.cos(angle)) * cross @ cross


def smallest_turn(z: FloatArray) -> FloatArray:
    """The smallest rotation [3, 3] that turns the z axis to a unit vector [3]."""
    across = np.cross([0.0, 0.0, 1.0], z)
    length = float(np.linalg.norm(across))
    if length < 1e-12:
        return np.eye(3) if z[2] > 0.0 else np.diag([1.0, -1.0, -1.0])
    return turned(across / length, math.atan2(length, float(z[2])))


def unit(vector: FloatArray, element: Element, attribute: str) -> FloatArray:
    """`vector` of length one; raises InputError where it has none."""
    length = float(np.linalg.norm(vector))
    if length < 1e-9:
        raise element.refused(f"{attribute} = {vector.tolist()} has no direction; give one.")
    return vector / length


def checked(body: Inertial, element: Element) -> Inertial:
    """`body`; raises InputError where its inertia is negative about some axis."""
    least = float(np.linalg.eigvalsh(body.inertia)[0])
    if least < -1e-9 * float(np.abs(body.inertia).max()):
        raise element.refused(
            f"a principal inertia is {least:.4g} kg m^2; none may be negative: check the products."
        )
    return body
