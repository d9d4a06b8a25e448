"""The drawing of a platform: its frames, the drive of every axis, and a key of its effects."""

import math
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass

from ptp_symbolic.platform import Platform
from ptp_symbolic.report.drawing.drive_train import DriveTrain, drive_train
from ptp_symbolic.report.drawing.frames import LEG, MARK, drawn_frames
from ptp_symbolic.report.drawing.scene import (
    Item,
    Label,
    Point,
    Scene,
    apart,
    balloon,
    box_of,
    line,
)
from ptp_symbolic.report.drawing.space import Space, projected, space_of
from ptp_symbolic.symbolic.derivation.equations import Equations
from ptp_symbolic.symbolic.derivation.sites import (
    BASE,
    BODY,
    COMMAND,
    GEAR,
    JOINT,
    MOTOR,
    SENSOR,
    SHAFT,
    Site,
    Sited,
    sited_effects,
)

WORDS = {
    COMMAND: "input of the {axis} axis",
    MOTOR: "{axis} motor",
    GEAR: "gear output of the {axis} drive",
    SHAFT: "{axis} drive, before the joint",
    JOINT: "{axis} joint",
    SENSOR: "{axis} encoder",
}
IN_A_ROW, STEP = 3, 0.48  # balloons under a glyph, and from one to the next in cm
BESIDE = 0.5  # cm from a centre of mass to the number of its body
ON_COLUMN, ON_TABLE = 0.9, 1.55  # heights above the foot of what turns about pan, in cm
ROW_OF_NAMES = 0.5  # cm from the name of one marked effect to that of the next


@dataclass(frozen=True)
class KeyEntry:
    """What a number in the drawing stands for: the effect, where it sits, its parameters."""

    number: int
    effect: str
    title: str
    axis: str | None
    where: str
    parameters: tuple[str, ...]
    marked: bool


@dataclass(frozen=True)
class PlatformDrawing:
    """Scenes of the frames and of the drive of every axis, and the key of their numbers."""

    frames: Scene
    drives: tuple[Scene, ...]
    key: tuple[KeyEntry, ...]


def drawn(
    platform: Platform, equations: Equations, marked: Collection[str] = ()
) -> PlatformDrawing:
    """Draw `platform`; effects with a parameter in `marked` stand out, with their names.

    Every effect has a number at each part on which it sits. Raises InputError as `sited_effects`.
    """
    effects = sited_effects(platform)
    key = tuple(
        KeyEntry(
            number,
            e.effect.id,
            e.effect.title,
            e.axis,
            " and ".join(map(words_of, e.sites)),
            e.parameters,
            not {*marked}.isdisjoint(e.parameters),
        )
        for number, e in enumerate(effects, start=1)
    )
    space = space_of(equations)
    bare = drawn_frames(equations, space)
    left = Scene(tuple(bare), "").bounds()[0]
    numbers = list(_beside(left, space, equations.rigid.sliding, effects, key))
    taken = [box_of(item) for item in numbers if isinstance(item, Label)]
    taken += [(projected(centre.at), MARK) for centre in space.centres]
    items = [*apart(bare, taken), *numbers]
    return PlatformDrawing(
        Scene(tuple(items), f"Frames, axes and centres of mass of {platform.title}"),
        tuple(
            Scene(
                tuple(_numbered(drive_train(equations, axis, effects), axis, effects, key)),
                f"Drive of the {axis} axis of {platform.title}",
            )
            for axis in equations.axes
        ),
        key,
    )


def words_of(site: Site) -> str:
    """Where a site is, in words."""
    if site.part == BODY:
        return str(site.name).replace("_", " ")
    return WORDS[site.part].format(axis=site.axis) if site.part in WORDS else site.part


def _numbered(
    train: DriveTrain, axis: str, effects: Sequence[Sited], key: Sequence[KeyEntry]
) -> Iterator[Item]:
    """The chain of an axis, under each part the numbers of its effects; marked ones are named."""
    yield from train.items
    under: dict[str, int] = {}
    named: list[tuple[Point, KeyEntry]] = []
    lowest = 0.0
    for effect, entry in zip(effects, key, strict=True):
        for part in [site.part for site in effect.sites if site.axis == axis]:
            part = part if part in train.middles else JOINT
            if part == BODY or any(s.part == BODY for s in effect.sites):
                continue
            count = under.get(part, 0)
            under[part] = count + 1
            row, column = divmod(count, IN_A_ROW)
            at = (train.middles[part] + STEP * (column - 0.5), -0.95 - STEP * row)
            yield from balloon(at, entry.number, entry.marked)
            lowest = min(lowest, at[1])
            named += [(at, entry)] if entry.marked else []
    for count, (at, entry) in enumerate(named):
        y = lowest - 0.45 - ROW_OF_NAMES * count
        yield line((at[0], at[1] - 0.21), (at[0], y), weight="thin")
        yield Label((at[0], y), entry.title, (1.0, -0.4), marked=True)


def _beside(
    left: float,
    space: Space,
    sliding: Collection[str],
    effects: Sequence[Sited],
    key: Sequence[KeyEntry],
) -> Iterator[Item]:
    """The numbers of what sits on the base and on bodies: at centres of mass, else at the left."""
    found: dict[tuple[Point, Point | None], list[KeyEntry]] = {}
    for effect, entry in zip(effects, key, strict=True):
        for site in effect.sites:
            if site.part in (BASE, BODY):
                found.setdefault(_place(site, space, sliding), []).append(entry)
    for (at, beside), entries in found.items():
        if beside is not None:
            first = beside
        else:
            first = (left - 0.3 - STEP * (len(entries) - 1), at[1])
            yield line((left - 0.3 + 0.21, at[1]), at, weight="thin")
        for count, entry in enumerate(entries):
            x = first[0] + STEP * count
            yield from balloon((x, first[1]), entry.number, entry.marked)
        named = [entry for entry in entries if entry.marked]
        for count, entry in enumerate(named):
            y = first[1] - 0.45 - ROW_OF_NAMES * count
            yield Label((first[0] - 0.2, y), entry.title, (1.0, 0.0), marked=True)


def _place(site: Site, space: Space, sliding: Collection[str]) -> tuple[Point, Point | None]:
    """Where on paper the base or a body is; of a centre of mass, also where a number fits."""
    base, outer = space.frames[0], space.frames[-1]
    for centre in space.centres:
        if centre.body.name == site.name:
            (x0, y0), (x, y) = projected(centre.frame.origin), projected(centre.at)
            length = math.hypot(x - x0, y - y0) or 1.0
            across = (y0 - y) / length, (x - x0) / length
            return (x, y), (x + BESIDE * across[0], y + BESIDE * across[1])
    if site.part == BASE:
        return projected(base.origin - base.axes[:, 2] * LEG), None
    if outer.name == "tilt" == site.axis or outer.name in sliding:
        return projected(outer.origin - 0.5 * outer.axes[:, 0]), None
    height = ON_TABLE if site.axis == outer.name else ON_COLUMN
    return projected(base.origin - base.axes[:, 2] * (LEG - height)), None
