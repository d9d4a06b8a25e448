"""Frames, joint angles, offsets, centres of mass and gravity, drawn from `Space`."""

import math
from collections.abc import Iterator

import numpy as np
import sympy as sp

from ptp_symbolic.report.drawing.scene import Item, Label, Point, Stroke, area, arrow, line
from ptp_symbolic.report.drawing.space import Centre, Frame, Space, Vector, projected
from ptp_symbolic.symbolic.derivation.equations import Equations
from ptp_symbolic.symbolic.symbols import real

ARROW = {"base": 3.4, "pan": 4.0, "tilt": 4.6}  # lengths of the axes of a frame in cm
ARC = {"pan": 2.2, "tilt": 3.2}  # radii of the arcs of the joint angles in cm
LEG, HALF_FORK, TABLE = 2.6, 1.45, 0.6  # of the machine's outline, in cm
BODY, CARRIAGE = (0.95, 0.95, 0.5), (0.6, 0.4, 0.4)  # half the size of a box in cm
SHADE = 0.06
MARK = 0.17  # radius of the mark of a centre of mass in cm
ALONG_STEP = 0.72  # where beside a coordinate of a centre of mass its name is
RAIL = (-0.8, 5.2)  # from end to end, in cm
TURNED = {"pan": 1, "tilt": 0}  # between which axes of two frames the angle is drawn
SAME = 1e-6  # cosine from 1 within which two axes are drawn as one
GRAVITY_AT = (-2.6, 3.2)
SMALLEST_LEAN = math.radians(0.05)


def drawn_frames(equations: Equations, space: Space) -> list[Item]:
    """The machine's outline in thin lines, and on it frames, angles, offsets and gravity."""
    items = list(_outline(equations, space))
    for number, frame in enumerate(space.frames):
        items += _axes(frame, space.frames[:number])
    for before, frame in zip(space.frames, space.frames[1:], strict=False):
        sliding = frame.name in equations.rigid.sliding
        items += _travel(before, frame) if sliding else _joint_angle(before, frame)
        offset = equations.rigid.offset(frame.name)[0]
        if not sliding and np.linalg.norm(frame.origin - before.origin) > 0:
            items += [_along(before.origin, frame.origin), _dimension(before, frame, offset)]
    for centre in space.centres:
        items += _centre(centre)
    items += _gravity(space)
    return items


def _axes(frame: Frame, before: tuple[Frame, ...]) -> Iterator[Item]:
    """The three axes; one that is that of an earlier frame at the same place only adds its name."""
    for k, letter in enumerate("xyz"):
        direction = frame.axes[:, k]
        if any(_same_line(frame, other, k) for other in before):
            continue
        end = frame.origin + direction * ARROW[frame.name]
        yield arrow(projected(frame.origin), projected(end), weight="bold")
        names = real(f"{letter}_{frame.name}")
        yield Label(projected(end), names, _outward(frame.origin, end))


def _same_line(frame: Frame, other: Frame, k: int) -> bool:
    along = float(frame.axes[:, k] @ other.axes[:, k])
    apart = np.linalg.norm(np.cross(frame.origin - other.origin, frame.axes[:, k]))
    return bool(along > 1.0 - SAME and apart < SAME)


def _outward(origin: Vector, end: Vector) -> Point:
    (x0, y0), (x1, y1) = projected(origin), projected(end)
    length = math.hypot(x1 - x0, y1 - y0) or 1.0
    return (x1 - x0) / length, (y1 - y0) / length


def _joint_angle(before: Frame, frame: Frame) -> Iterator[Item]:
    """The arc from an axis of the frame before to that of this one, towards a growing angle."""
    radius, k = ARC[frame.name], TURNED[frame.name]
    a, b = before.axes[:, k], frame.axes[:, k]
    turn = math.acos(min(float(a @ b), 1.0))
    across = (b - a * math.cos(turn)) / math.sin(turn)
    steps = np.linspace(0.0, turn, 16)
    points = [frame.origin + radius * (a * math.cos(s) + across * math.sin(s)) for s in steps]
    if np.linalg.norm(frame.origin - before.origin) > 0:
        start = frame.origin + a * radius * 1.2
        yield line(projected(frame.origin), projected(start), weight="thin", dashed=True)
    yield arrow(*map(projected, points))
    middle = points[len(points) // 2]
    angle = real(f"theta_{frame.name}")
    yield Label(projected(middle), angle, _outward(frame.origin, middle))


def _travel(before: Frame, frame: Frame) -> Iterator[Item]:
    """The coordinate of a carriage along its rail."""
    down = np.array([0.0, 0.0, -0.95])
    ends = [projected(f.origin + down) for f in (before, frame)]
    yield from (
        line(projected(f.origin), projected(f.origin + down), weight="thin")
        for f in (before, frame)
    )
    yield arrow(*ends)
    yield Label(_middle(*ends), real(f"theta_{frame.name}"), (0.0, -1.0))


def _along(begin: Vector, end: Vector) -> Stroke:
    return line(projected(begin), projected(end), weight="bold")


def _dimension(before: Frame, frame: Frame, offset: sp.Expr) -> Label:
    return Label(_middle(projected(before.origin), projected(frame.origin)), offset, (0.0, -1.0))


def _middle(a: Point, b: Point) -> Point:
    return (a[0] + b[0]) / 2, (a[1] + b[1]) / 2


def _centre(centre: Centre) -> Iterator[Item]:
    """The way to a centre of mass along the axes of its frame, and the mark of one."""
    at, frame = centre.frame.origin, centre.frame
    way = centre.at - frame.origin
    shown = [k for k in range(3) if centre.offset[k]]
    for k in shown:
        step = frame.axes[:, k] * float(way @ frame.axes[:, k])
        yield line(projected(at), projected(at + step), dashed=True)
        here = projected(at + ALONG_STEP * step)
        yield Label(here, centre.body.com[k], _away(here, frame.origin + way / 2, step))
        at = at + step
    yield from _centre_mark(projected(centre.at), MARK)


def _away(here: Point, middle: Vector, step: Vector) -> Point:
    """Across `step`, on the side that is not that of `middle`; to the left or down without one."""
    (x0, y0), (x1, y1) = projected(np.zeros(3)), projected(step)
    length = math.hypot(x1 - x0, y1 - y0) or 1.0
    across = (y1 - y0) / length, (x0 - x1) / length
    mx, my = projected(middle)
    side = across[0] * (here[0] - mx) + across[1] * (here[1] - my)
    steep = abs(across[0]) > abs(across[1])
    sign = math.copysign(1.0, side if abs(side) > SAME else -across[0 if steep else 1])
    return sign * across[0], sign * across[1]


def _centre_mark(at: Point, radius: float) -> Iterator[Item]:
    """The usual mark: a circle, two of its quarters filled."""
    (x, y) = at
    for begin in (0.0, math.pi):
        turns = [begin + math.pi / 2 * k / 8 for k in range(9)]
        rim = [(x + radius * math.cos(a), y + radius * math.sin(a)) for a in turns]
        yield area([at, *rim], 1.0, "thin")
    rim = [
        (x + radius * math.cos(a / 16 * math.pi), y + radius * math.sin(a / 16 * math.pi))
        for a in range(32)
    ]
    yield area(rim, 0.0)


def _gravity(space: Space) -> Iterator[Item]:
    """Gravity points down the page; where the base leans, how far it is from the vertical."""
    x, y = GRAVITY_AT
    if space.down is not None:
        yield arrow((x, y), (x, y - 1.2), weight="bold")
        yield Label((x, y - 0.6), real("gravity"), (-1.0, 0.0))
    base = space.frames[0]
    if space.lean > SMALLEST_LEAN:
        top = base.origin + np.array([0.0, 0.0, 1.2 * ARROW["base"]])
        yield line(projected(base.origin), projected(top), dashed=True)
        words = f"vertical, {math.degrees(space.lean):.3g}° from z"
        yield Label(projected(top), words, (0.0, 1.0))
    if space.shaken:
        x, y = projected(base.origin - base.axes[:, 2] * LEG)
        for side in (-1.0, 1.0):
            yield arrow((x, y - 0.75), (x + 0.8 * side, y - 0.75))


def _outline(equations: Equations, space: Space) -> Iterator[Item]:
    """The machine in thin lines: foot and column, fork, and the body that tilts; or rail and
    carriage.
    """
    base, last = space.frames[0], space.frames[-1]
    if equations.rigid.sliding:
        yield from _rail(base, last)
        return
    up = base.axes[:, 2]
    foot = base.origin - up * LEG
    yield from _ring(foot, base, 0.75, 0.1)
    if "pan" in equations.axes:
        pan = next(f for f in space.frames if f.name == "pan")
        yield from _ring(foot + up * 0.55, base, 0.5, 0.06)
        yield line(projected(foot), projected(base.origin), weight="thin")
        yield from _fork(foot + up * 0.95, pan, last)
    else:
        yield from _fork(foot, base, last)


def _ring(centre: Vector, frame: Frame, radius: float, shade: float) -> Iterator[Item]:
    turns = np.linspace(0.0, 2.0 * math.pi, 41)[:-1]
    rim = [
        centre + radius * (frame.axes[:, 0] * math.cos(a) + frame.axes[:, 1] * math.sin(a))
        for a in turns
    ]
    yield area([projected(p) for p in rim], shade, "thin")


def _fork(foot: Vector, carrier: Frame, last: Frame) -> Iterator[Item]:
    """Two arms that hold the tilt axis, and the body between them; without a tilt axis a table."""
    if last.name != "tilt":
        yield from _ring(foot + carrier.axes[:, 2] * TABLE, carrier, 1.1, SHADE)
        return
    across, centre = carrier.axes[:, 1] * HALF_FORK, last.origin
    level = foot + carrier.axes[:, 0] * float((centre - foot) @ carrier.axes[:, 0])
    for side in (-1.0, 1.0):
        arm = [foot, foot + side * across + (level - foot), centre + side * across]
        yield line(*map(projected, arm), weight="thin")
    yield from _block(last, BODY)


def _rail(base: Frame, carriage: Frame) -> Iterator[Item]:
    """A rail along x, and a carriage on it."""
    x, y, z = base.axes.T
    low = base.origin - z * 0.45
    for side in (-0.4, 0.4):
        yield line(*(projected(low + side * y + x * end) for end in RAIL), weight="thin")
    for end in RAIL:
        yield line(
            projected(low + x * end - 0.4 * y), projected(low + x * end + 0.4 * y), weight="thin"
        )
    yield from _block(carriage, CARRIAGE)


def _block(frame: Frame, half: tuple[float, float, float]) -> Iterator[Item]:
    """A box about the origin of `frame`, of half the size `half` along its axes."""
    centre = frame.origin
    x, y, z = (frame.axes[:, k] * size for k, size in enumerate(half))
    for side in (-1.0, 1.0):
        corners = [-x - z, x - z, x + z, z - x]
        yield area([projected(centre + side * y + c) for c in corners], SHADE, "thin")
    for edge in (x + z, x - z, -x + z, -x - z):
        yield line(projected(centre - y + edge), projected(centre + y + edge), weight="thin")
