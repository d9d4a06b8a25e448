"""Mass and inertia of the shapes that MJCF calls geoms."""

import math

import numpy as np

from ptp_symbolic.formats.robots.robot import NOTHING, Inertial, Pose, smallest_turn, unit
from ptp_symbolic.formats.robots.xml_file import Element, FloatArray
from ptp_symbolic.platform.fields import shown

WATER = 1000.0  # kg/m^3; density of a geom that says neither mass nor density, in MJCF
WEIGHTLESS = ("plane", "hfield")
SIZES = {"sphere": 1, "capsule": 2, "cylinder": 2, "box": 3, "ellipsoid": 3}
LONG = ("capsule", "cylinder", "box", "ellipsoid")  # that may be given by their ends


def geom_inertial(geom: Element, pose: Pose, instead: str) -> tuple[Inertial, Pose]:
    """Mass and inertia of a geom in its frame, and that frame in the one of its body.

    `instead` ends the refusal of a shape whose volume is not known here. Raises InputError.
    """
    kind = geom.attributes.get("type", "sphere")
    density = geom.positive("density", WATER)
    weightless = "mass" in geom.attributes and geom.positive("mass") == 0.0
    if kind in WEIGHTLESS or weightless or ("mass" not in geom.attributes and density == 0.0):
        return NOTHING, pose
    if kind not in SIZES or "mesh" in geom.attributes:
        raise geom.refused(f"the mass of a {shown(kind)} is not known{instead}")
    if geom.attributes.get("shellinertia", "false") != "false":
        raise geom.refused(f"shellinertia is not read{instead}")
    size, pose = _size(geom, kind, pose)
    volume, inertia = _volume(kind, size)
    mass = geom.positive("mass", density * volume)
    return Inertial(mass, np.zeros(3), mass * np.diag(inertia)), pose


def _size(geom: Element, kind: str, pose: Pose) -> tuple[FloatArray, Pose]:
    """Half lengths in m, as MJCF has them, and the frame of the shape."""
    if "fromto" not in geom.attributes:
        words = geom.required("size").split()
        given = geom.numbers("size", max(len(words), SIZES[kind]))
        size = given[: SIZES[kind]]
    elif kind in LONG:
        ends = geom.numbers("fromto", 6).reshape(2, 3)
        along = ends[0] - ends[1]
        radius = geom.numbers("size", len(geom.required("size").split()))[0]
        half = float(np.linalg.norm(along)) / 2.0
        size = np.array([radius, half] if SIZES[kind] == 2 else [radius, radius, half])
        pose = Pose(smallest_turn(unit(along, geom, "fromto")), ends.mean(axis=0))
    else:
        raise geom.refused(f"a {kind} has no fromto; give pos and size.")
    if np.any(size <= 0.0):
        raise geom.refused(f"size = {size.tolist()} must be above zero.")
    return size, pose


def _volume(kind: str, size: FloatArray) -> tuple[float, tuple[float, float, float]]:
    """Volume in m^3, and inertia per mass in m^2 about the axes of a homogeneous shape."""
    if kind in ("box", "ellipsoid"):
        a, b, c = (float(s) ** 2 for s in size)
        share = 3.0 if kind == "box" else 5.0
        whole = 8.0 if kind == "box" else 4.0 / 3.0 * math.pi
        inertia = ((b + c) / share, (a + c) / share, (a + b) / share)
        return whole * float(np.prod(size)), inertia
    r = float(size[0])
    ball = 4.0 / 3.0 * math.pi * r**3
    if kind == "sphere":
        return ball, (0.4 * r**2,) * 3
    length = 2.0 * float(size[1])
    tube = math.pi * r**2 * length
    ends = ball / (ball + tube) if kind == "capsule" else 0.0  # share of the two half balls
    across = (1.0 - ends) * (r**2 / 4.0 + length**2 / 12.0)
    across += ends * (0.4 * r**2 + length**2 / 4.0 + 3.0 * r * length / 8.0)
    along = (1.0 - ends) * r**2 / 2.0 + ends * 0.4 * r**2
    return tube + (ball if kind == "capsule" else 0.0), (across, across, along)
