"""The drive of one axis from its input to its encoder, as a chain of glyphs."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from ptp_symbolic.report.drawing.scene import (
    Item,
    Label,
    arc,
    area,
    arrow,
    box,
    circle,
    line,
    moved,
)
from ptp_symbolic.symbolic.derivation.equations import Equations
from ptp_symbolic.symbolic.derivation.sites import (
    COMMAND,
    GEAR,
    JOINT,
    MOTOR,
    SENSOR,
    SHAFT,
    Sited,
)
from ptp_symbolic.symbolic.mechanics import kinematics
from ptp_symbolic.symbolic.symbols import real

TALL = 0.55  # half the height of the large glyphs in cm
TURN_ABOVE = 0.95  # height of the arrows that show a positive angle, in cm


@dataclass(frozen=True)
class DriveTrain:
    """Items of the chain of one axis, and the middle of every part in cm, by part."""

    items: tuple[Item, ...]
    middles: dict[str, float]


def drive_train(equations: Equations, axis: str, effects: Iterable[Sited]) -> DriveTrain:
    """The chain of `axis` along y = 0, from x = 0 to the right."""
    effects = tuple(effects)
    own = [e.added for e in effects if e.axis == axis]
    drives = [d for added in own for d in added.drives]
    linear = axis in equations.rigid.sliding
    parts = {site.part for e in effects for site in e.sites if site.axis == axis}
    items: list[Item] = [*_input(equations, axis, effects)]
    middles: dict[str, float] = {}
    x = 1.3

    def add(part: str, width: float, glyph: Iterator[Item]) -> None:
        nonlocal x
        items.extend(moved(glyph, (x, 0.0)))
        middles.setdefault(part, x + width / 2)
        x += width

    if COMMAND in parts:
        add(COMMAND, 1.9, _box("command", 1.9))
    if drives:
        add(MOTOR, 1.7, _motor())
        fixed = drives[0].inertia.free_symbols <= {p.symbol for p in equations.parameters}
        add(GEAR, 1.8, _gear_pair() if fixed else _linkage())
    if axis in {c.axis for c in equations.contacts}:
        items += _positive(x, f"theta_gear_{axis}", linear)
        add(SHAFT, 1.5, _gap())
    elif kinematics.gear_angle(axis) in equations.coordinates:
        items += _positive(x, f"theta_gear_{axis}", linear)
    if any(added.shafts for added in own):
        add(SHAFT, 2.0, _shaft())
    add(JOINT, 1.3, _bearing())
    items += _positive(x, f"theta_{axis}", linear)
    items += moved(_load(axis), (x, 0.0))
    x += 1.9
    add(SENSOR, 1.9, _sensor(equations, axis))
    return DriveTrain(tuple(items), middles)


def _input(equations: Equations, axis: str, effects: Iterable[Sited]) -> Iterator[Item]:
    """The arrow of what drives the axis."""
    beside = {given.name for e in effects for given in e.added.inputs}
    names = [i.name for i in equations.inputs if i.name.endswith(f"_{axis}")]
    yield arrow((0.1, 0.0), (1.3, 0.0))
    for k, name in enumerate(n for n in names if n not in beside):
        yield Label((1.15, 0.28 + 0.45 * k), real(name), (-1.0, 0.0))


def _positive(x: float, name: str, linear: bool) -> Iterator[Item]:
    """The positive direction of a coordinate, above the line at `x`."""
    if linear:
        yield arrow((x - 0.45, TURN_ABOVE), (x + 0.45, TURN_ABOVE))
    else:
        turned = [(x + 0.3 * px, TURN_ABOVE + 0.3 * py) for px, py in arc((0, 0), 1.0, 3.5, -0.7)]
        yield arrow(*turned)
    yield Label((x, TURN_ABOVE + 0.3), real(name), (0.0, 1.0))
    yield line((x, 0.1), (x, TURN_ABOVE - 0.1), weight="thin", dashed=True)


def _box(word: str, width: float) -> Iterator[Item]:
    yield box((width / 2 - 0.15, 0.0), width - 0.3, 2 * TALL - 0.3)
    yield Label((width / 2 - 0.15, 0.0), word)
    yield line((width - 0.3, 0.0), (width, 0.0))


def _motor() -> Iterator[Item]:
    yield circle((TALL, 0.0), TALL, 0.06)
    yield Label((TALL, 0.0), "M")
    yield line((2 * TALL, 0.0), (1.7, 0.0))


def _gear_pair() -> Iterator[Item]:
    """A pinion on the motor's line, and the wheel that it drives, on the line of the joint."""
    yield line((0.0, 0.0), (0.45, 0.0))
    yield box((0.6, 0.0), 0.3, 0.5, 0.12)
    yield box((1.05, 0.0), 0.3, 2 * TALL + 0.2, 0.12)
    for y in (-0.2, 0.0, 0.2):
        yield line((0.75, y), (0.9, y), weight="thin")
    yield line((1.2, 0.0), (1.8, 0.0))


def _linkage() -> Iterator[Item]:
    """A transmission whose ratio varies: a strut between two pins, and the arm that it turns."""
    foot, pin, joint = (0.15, -0.45), (1.05, 0.5), (1.45, 0.0)
    yield line((0.0, 0.0), (0.15, 0.0))
    yield line((0.15, 0.0), foot)
    yield line(foot, pin, weight="bold")
    yield line(pin, joint)
    for place in (foot, pin, joint):
        yield circle(place, 0.08, 0.3)
    yield line(joint, (1.8, 0.0))


def _gap() -> Iterator[Item]:
    """A tongue with play in a fork."""
    yield line((0.0, 0.0), (0.35, 0.0))
    yield area([(0.35, -0.14), (0.95, -0.14), (0.95, 0.14), (0.35, 0.14)], 0.12)
    fork = [(0.6, 0.46), (1.2, 0.46), (1.2, -0.46), (0.6, -0.46), (0.6, -0.28), (1.05, -0.28)]
    yield area([*fork, (1.05, 0.28), (0.6, 0.28)], 0.12)
    yield line((1.2, 0.0), (1.5, 0.0))


def _shaft() -> Iterator[Item]:
    """A spring and a damper side by side."""
    left, right, up, low = 0.25, 1.75, 0.32, -0.32
    yield line((0.0, 0.0), (left, 0.0))
    yield line((right, 0.0), (2.0, 0.0))
    for end in (left, right):
        yield line((end, up), (end, low))
    zigzag = [(0.55 + 0.1 * k, up + (0.16 if k % 2 else -0.16)) for k in range(1, 9)]
    yield line((left, up), (0.55, up), *zigzag, (1.45, up), (right, up))
    yield line((left, low), (0.9, low))
    yield line((0.9, low + 0.13), (0.9, low - 0.13))
    yield line((1.2, low + 0.18), (0.75, low + 0.18))
    yield line((1.2, low - 0.18), (0.75, low - 0.18))
    yield line((1.2, low + 0.18), (1.2, low - 0.18))
    yield line((1.2, low), (right, low))


def _bearing() -> Iterator[Item]:
    """The joint: the line between two fixed, hatched surfaces."""
    yield line((0.0, 0.0), (1.3, 0.0))
    for side in (-1, 1):
        yield line((0.3, side * 0.2), (1.0, side * 0.2))
        for k in range(6):
            x = 0.35 + 0.12 * k
            yield line((x, side * 0.2), (x + 0.1, side * 0.38), weight="thin")


def _load(axis: str) -> Iterator[Item]:
    """What the joint carries."""
    yield line((0.0, 0.0), (0.5, 0.0))
    yield box((0.95, 0.0), 0.9, 2 * TALL + 0.1, 0.08)
    yield Label((0.95, 0.0), axis)
    yield line((1.4, 0.0), (1.9, 0.0), dashed=True)


def _sensor(equations: Equations, axis: str) -> Iterator[Item]:
    """A slotted disc beside its reading head, and what it shows."""
    yield line((0.15, -0.45), (0.15, 0.45), weight="bold")
    for k in range(5):
        y = -0.4 + 0.2 * k
        yield line((0.05, y), (0.25, y), weight="thin")
    yield box((0.5, 0.0), 0.3, 0.45)
    yield arrow((0.65, 0.0), (1.25, 0.0))
    shown = [n for n, _, _ in equations.outputs if n == str(kinematics.angle(axis))]
    for name in shown:
        yield Label((1.25, 0.0), real(name), (1.0, 0.0))
