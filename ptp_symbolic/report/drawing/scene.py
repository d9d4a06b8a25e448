"""Neutral primitives of a drawing, in cm: x to the right, y up."""

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

import sympy as sp

Point = tuple[float, float]
FULL_TURN = 2.0 * math.pi
STEPS_OF_A_TURN = 60  # of the polygon that stands for a circle or an arc
HALF_CHARACTER = 0.085  # half the width of a letter in cm, on average
HALF_LINE = 0.2  # half the height of a line of text in cm
MOVES = (0.25, 0.4, 0.6, 0.85, 1.1)  # in cm, of a label that would lie over another one
DIRECTIONS = 12  # in which it may be moved


@dataclass(frozen=True)
class Stroke:
    """A line through `points`: a `weight` of "thin", "normal" or "bold", maybe "dashed".

    With `head` it ends in an arrow; `closed`, it is the outline of an area of which a `shade`
    (0 to 1) is filled.
    """

    points: tuple[Point, ...]
    weight: str = "normal"
    dashed: bool = False
    head: bool = False
    closed: bool = False
    shade: float = 0.0
    marked: bool = False


@dataclass(frozen=True)
class Label:
    """Mathematics (an expression) or words beside a point, on the side of `direction`."""

    at: Point
    text: sp.Expr | str
    direction: Point = (0.0, 0.0)
    marked: bool = False


Item = Stroke | Label


@dataclass(frozen=True)
class Scene:
    """A drawing; `description` says in words what it shows."""

    items: tuple[Item, ...]
    description: str

    @property
    def strokes(self) -> list[Stroke]:
        """The lines and areas, in the order in which they are drawn: before all labels, which
        would be illegible under them.
        """
        return [item for item in self.items if isinstance(item, Stroke)]

    @property
    def labels(self) -> list[Label]:
        """The labels, drawn over all strokes."""
        return [item for item in self.items if isinstance(item, Label)]

    def bounds(self) -> tuple[float, float, float, float]:
        """Left, bottom, right and top in cm, with room for the labels."""
        points = [p for item in self.items for p in _extent(item)]
        xs, ys = zip(*points, strict=True)
        return min(xs), min(ys), max(xs), max(ys)


def _extent(item: Item) -> Iterator[Point]:
    if isinstance(item, Stroke):
        yield from item.points
        return
    (x, y), half = box_of(item)
    for side in (-half, half):
        yield x + side, y - HALF_LINE
        yield x + side, y + HALF_LINE


Box = tuple[Point, float]


def box_of(label: Label) -> Box:
    """The middle of a label and half its width, in cm; it is HALF_LINE high from there."""
    half = HALF_CHARACTER * max(len(str(label.text).replace("_", "")), 2)
    x, y = placed(label)
    beside = abs(label.direction[0]) > 0.5
    return (x + math.copysign(half, label.direction[0]) * beside, y), half


def apart(items: Iterable[Item], taken: Iterable[Box] = ()) -> list[Item]:
    """`items`, each label that would lie over what is `taken`, or over an earlier label, at the
    nearest place that is free.
    """
    found: list[Item] = []
    boxes = list(taken)
    for item in items:
        if isinstance(item, Label):
            free = (p for p in _nearby(item) if not any(_touch(box_of(p), b) for b in boxes))
            item = next(free, item)
            boxes.append(box_of(item))
        found.append(item)
    return found


def _nearby(label: Label) -> Iterator[Label]:
    yield label
    (x, y), (dx, dy) = label.at, label.direction
    for far in MOVES:
        for k in range(DIRECTIONS):
            turn = math.atan2(dy, dx) + FULL_TURN * k / DIRECTIONS
            yield replace(label, at=(x + far * math.cos(turn), y + far * math.sin(turn)))


def _touch(one: Box, other: Box) -> bool:
    ((ax, ay), a), ((bx, by), b) = one, other
    return abs(ax - bx) < a + b and abs(ay - by) < 2 * HALF_LINE


def placed(label: Label) -> Point:
    """Where the near edge or the middle of a label is, a little away from its point."""
    (x, y), (dx, dy) = label.at, label.direction
    return x + 0.1 * dx, y + 0.28 * dy


def moved(items: Iterable[Item], by: Point) -> list[Item]:
    """`items`, moved."""

    def there(point: Point) -> Point:
        return point[0] + by[0], point[1] + by[1]

    return [
        replace(item, at=there(item.at))
        if isinstance(item, Label)
        else replace(item, points=tuple(map(there, item.points)))
        for item in items
    ]


def line(*points: Point, weight: str = "normal", dashed: bool = False) -> Stroke:
    """A line through `points`."""
    return Stroke(points, weight, dashed)


def arrow(*points: Point, weight: str = "normal", dashed: bool = False) -> Stroke:
    """A line that ends in an arrow."""
    return Stroke(points, weight, dashed, head=True)


def area(points: Sequence[Point], shade: float = 0.0, weight: str = "normal") -> Stroke:
    """A closed outline, shaded."""
    return Stroke(tuple(points), weight, closed=True, shade=shade)


def box(centre: Point, width: float, height: float, shade: float = 0.0) -> Stroke:
    """An upright rectangle."""
    (x, y), w, h = centre, width / 2, height / 2
    return area([(x - w, y - h), (x + w, y - h), (x + w, y + h), (x - w, y + h)], shade)


def arc(centre: Point, radius: float, begin: float, end: float) -> tuple[Point, ...]:
    """Points of an arc from the angle `begin` to `end` in rad, counted against the clock."""
    count = max(2, math.ceil(abs(end - begin) / FULL_TURN * STEPS_OF_A_TURN))
    turns = (begin + (end - begin) * k / count for k in range(count + 1))
    return tuple(
        (centre[0] + radius * math.cos(a), centre[1] + radius * math.sin(a)) for a in turns
    )


def circle(centre: Point, radius: float, shade: float = 0.0) -> Stroke:
    """A circle, shaded."""
    return area(arc(centre, radius, 0.0, FULL_TURN)[:-1], shade)


def balloon(centre: Point, number: int, marked: bool) -> list[Item]:
    """A number in a circle, for a list beside the drawing; `marked` it stands out."""
    ring = circle(centre, 0.21, 0.25 if marked else 0.0)
    ring = replace(ring, weight="bold" if marked else "thin", marked=marked)
    return [ring, Label(centre, str(number), marked=marked)]
