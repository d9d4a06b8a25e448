"""Where frames, bodies and gravity are in space: from the declared numbers, at the drawn pose."""

import math
from dataclasses import dataclass

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from ptp_symbolic.report.drawing.scene import Point
from ptp_symbolic.symbolic.derivation.equations import Equations
from ptp_symbolic.symbolic.derivation.placement import GRAVITY
from ptp_symbolic.symbolic.mechanics import kinematics
from ptp_symbolic.symbolic.mechanics.bodies import Body

Vector = NDArray[np.float64]

POSE = {"pan": math.radians(55.0), "tilt": math.radians(24.0)}  # every angle shows its sign
CAMERA_AZIMUTH, CAMERA_HEIGHT = math.radians(-15.0), math.radians(28.0)
LONGEST, HALF_WAY = 4.6, 0.35  # cm on paper of an endless length; m that are drawn 0.71 as long
TRAVEL = 2.2  # cm that a carriage is drawn away from its origin


@dataclass(frozen=True)
class Frame:
    """A frame of the machine: its origin [3] in cm of the drawing, its axes as columns [3, 3]."""

    name: str
    origin: Vector
    axes: Vector


@dataclass(frozen=True)
class Centre:
    """A body's centre of mass off the origin of its frame: `offset` [3] in m, its expressions,
    and where it is drawn.
    """

    body: Body
    offset: Vector
    frame: Frame
    at: Vector


@dataclass(frozen=True)
class Space:
    """Frames from the base outward, centres of mass, the direction of gravity [3] (None without).

    All vectors are in the drawing's own frame, whose z axis points up: where gravity is not along
    the base's z axis, the base leans by `lean` in rad. A base that nothing turns on is turned
    itself, so that its x axis does not point at the reader.
    """

    frames: tuple[Frame, ...]
    centres: tuple[Centre, ...]
    down: Vector | None
    lean: float
    shaken: bool


def space_of(equations: Equations) -> Space:
    """The machine at the drawn pose, with the default of every parameter."""
    values = {p.symbol: p.default for p in equations.parameters}
    rigid = equations.rigid
    still = {s: 0.0 for s in (*equations.state_symbols, kinematics.TIME)}
    turned = {kinematics.angle(a): POSE[a] for a in rigid.axes if a not in rigid.sliding}
    pull = np.array([float(g.diff(GRAVITY.symbol).xreplace(values | still)) for g in rigid.gravity])
    rest = rigid.gravity - GRAVITY.symbol * rigid.gravity.diff(GRAVITY.symbol)
    down = pull / np.linalg.norm(pull) if pull.any() else None
    lean = 0.0 if down is None else math.acos(min(max(-down[2], -1.0), 1.0))
    upright = np.eye(3) if down is None else _turn_to(-down, np.array([0.0, 0.0, 1.0]))
    if "pan" not in rigid.axes or "pan" in rigid.sliding:
        upright = (
            _numbers(kinematics.joint_rotation("pan"), {kinematics.angle("pan"): POSE["pan"]})
            @ upright
        )
    frames = [Frame("base", np.zeros(3), upright)]
    for axis in rigid.axes:
        last = frames[-1]
        offset = _numbers(rigid.offset(axis).xreplace({kinematics.angle(axis): 0}), values)
        along = _numbers(kinematics.ALONG, {}) * TRAVEL if axis in rigid.sliding else 0.0
        turn = _numbers(rigid.rotation(axis), values | turned)
        place = last.origin + last.axes @ (drawn_offset(offset) + along)
        frames.append(Frame(axis, place, last.axes @ turn))
    centres = []
    for body in rigid.bodies:
        frame = frames[len(kinematics.joints_up_to(rigid.axes, body.frame))]
        offset = _numbers(body.com, values)
        if offset.any() and body.mass.xreplace(values) != 0:
            centres.append(Centre(body, offset, frame, _beside(frame, offset)))
    shaken = any(entry != 0 for entry in rest)
    return Space(tuple(frames), tuple(centres), down, lean, shaken)


def drawn_offset(offset: Vector) -> Vector:
    """An offset [3] in m as it is drawn, in cm: in its direction, the longer the longer.

    The length grows as a root where it is short, and ends at LONGEST: what is small can be seen,
    and what is large stays on the page.
    """
    length = float(np.linalg.norm(offset))
    if length == 0.0:
        return np.zeros(3)
    return offset / length * LONGEST * math.sqrt(length / (length + HALF_WAY))


def projected(place: Vector) -> Point:
    """Where on paper a place in space is, by a parallel projection."""
    (a, b), (s, c) = (
        (math.cos(CAMERA_AZIMUTH), math.sin(CAMERA_AZIMUTH)),
        (math.sin(CAMERA_HEIGHT), math.cos(CAMERA_HEIGHT)),
    )
    x, y, z = (float(v) for v in place)
    return -b * x + a * y, -s * a * x - s * b * y + c * z


def _beside(frame: Frame, offset: Vector) -> Vector:
    place: Vector = frame.origin + frame.axes @ drawn_offset(offset)
    return place


def _numbers(matrix: sp.Matrix, values: dict[sp.Symbol, float]) -> Vector:
    found = np.array(sp.Matrix(matrix).xreplace(values).evalf().tolist(), dtype=float)
    return found[:, 0] if found.shape[1] == 1 else found


def _turn_to(given: Vector, wanted: Vector) -> Vector:
    """The smallest rotation [3, 3] of the unit vector `given` into `wanted`; Rodrigues' formula."""
    axis, cosine = np.cross(given, wanted), float(given @ wanted)
    if cosine <= -1.0:
        return np.diag([1.0, -1.0, -1.0])
    x, y, z = axis
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    turn: Vector = np.eye(3) + cross + cross @ cross / (1.0 + cosine)
    return turn
