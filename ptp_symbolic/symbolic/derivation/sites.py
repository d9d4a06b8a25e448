"""Where on the machine every effect sits, from what it contributes.

An effect says it by the rate that its torque works on, the coordinate of its potential, the bodies,
drives and shafts that it brings, and the quantities that it changes, which sit where the effect
does that defines them.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import sympy as sp

from ptp_symbolic.platform import Platform
from ptp_symbolic.symbolic.derivation.contributions import PLATFORM_QUANTITIES
from ptp_symbolic.symbolic.derivation.placement import place_effects
from ptp_symbolic.symbolic.effect_interface.contribution import Contribution
from ptp_symbolic.symbolic.effect_interface.effect import Effect
from ptp_symbolic.symbolic.effect_interface.place import Place, quantity
from ptp_symbolic.symbolic.mechanics import kinematics
from ptp_symbolic.symbolic.mechanics.bodies import Body

BASE, COMMAND, MOTOR, GEAR, SHAFT, JOINT, BODY, SENSOR = (
    "base",
    "command",
    "motor",
    "gear",
    "shaft",
    "joint",
    "body",
    "sensor",
)
OF_READINGS = ("reading_", "measured_")
OF_INPUTS = ("input_torque_", "command_torque_")
OF_GEARS = ("transmission_error_", "transmitted_torque_")


@dataclass(frozen=True)
class Site:
    """A part of the machine: of the drive of `axis`, or the body `name` behind its joint."""

    part: str
    axis: str | None = None
    name: str | None = None


@dataclass(frozen=True)
class Sited:
    """An effect, its axis, the names of its parameters there, what it adds, and where it sits."""

    effect: Effect
    axis: str | None
    parameters: tuple[str, ...]
    added: Contribution
    sites: tuple[Site, ...]


def sited_effects(platform: Platform) -> tuple[Sited, ...]:
    """The declared effects of `platform` with their sites, in the order of the catalogue.

    A rate of the gear output counts as one on every axis with a drive, flexible shaft or not.
    Raises InputError as `place_effects` does.
    """
    placed = place_effects(platform)
    driven = {d.axis for e, p in placed for d in e.turning_contribution_at(p).drives}
    apart = [
        (effect, replace(place, shafts=place.shafts | {*driven}))
        if place.axis in driven
        else (effect, place)
        for effect, place in placed
    ]
    added = [effect.contribution_at(place) for effect, place in apart]
    return tuple(
        Sited(
            effect.worded_at(place),
            place.axis,
            tuple(p.name for p in effect.parameters_at(place)),
            own,
            tuple(dict.fromkeys(_sites(own, place, apart, added))),
        )
        for (effect, place), own in zip(apart, added, strict=True)
    )


def _sites(
    own: Contribution,
    place: Place,
    placed: Sequence[tuple[Effect, Place]],
    added: Sequence[Contribution],
) -> Iterator[Site]:
    """The sites of what `own` adds; those of the quantities that it changes where it adds none."""
    found = tuple(_own_sites(own, place))
    yield from found
    for name in () if found else own.changes:
        yield from _of_quantity(name, place, placed, added)


def _own_sites(own: Contribution, place: Place) -> Iterator[Site]:
    for body in own.bodies:
        yield Site(BODY, body.frame, body.name)
    if own.sensors and place.axis is None:
        yield Site(BODY, place.payload_frame, f"{place.payload_frame}_body")
    for drive in own.drives:
        yield Site(MOTOR, drive.axis)
    for axis in (*(s.axis for s in own.shafts), *(p.axis for p in own.plays)):
        yield Site(SHAFT, axis)
    for rate in (*(f.rate for f in own.frictions), *own.torques, *own.inertias, *own.prescribed):
        yield _of_motion(rate)
    moved = own.potential.free_symbols
    for axis in place.axes:
        for coordinate in (kinematics.angle(axis), kinematics.gear_angle(axis)):
            if coordinate in moved:
                yield _of_motion(coordinate)
    for axis in (*own.commands, *own.delays):
        yield Site(COMMAND, axis)


def _of_motion(symbol: sp.Symbol) -> Site:
    """The joint or the gear output, whose coordinate or rate `symbol` is."""
    where, _, axis = kinematics.place_of(symbol).rpartition("_")
    return Site(GEAR if where else JOINT, axis)


def _of_quantity(
    name: str,
    place: Place,
    placed: Sequence[tuple[Effect, Place]],
    added: Sequence[Contribution],
) -> Iterator[Site]:
    """Where the quantity `name` is: with the machine itself, or the effect that defines it."""
    if name in PLATFORM_QUANTITIES:
        yield Site(BASE)
    elif name.startswith(OF_READINGS):
        yield Site(SENSOR, place.axis)
    elif name.startswith(OF_INPUTS):
        yield Site(COMMAND, place.axis)
    elif name.startswith(OF_GEARS):
        yield Site(GEAR, place.axis)
    for (_, there), contribution in zip(placed, added, strict=True):
        if name not in contribution.quantities:
            continue
        sites = tuple(_own_sites(contribution, there))
        holding = {b.name for b in contribution.bodies if quantity(name) in _symbols(b)}
        if holding:
            yield from (s for s in sites if s.name in holding)
        else:
            yield from sites[-1:] if contribution.bodies else sites[:1]


def _symbols(body: Body) -> set[sp.Symbol]:
    return {s for e in (body.mass, *body.com, *body.inertia) for s in e.free_symbols}
