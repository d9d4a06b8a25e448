"""Dry friction of the assembled machine: what it carries, and several frictions on one rate."""

from collections.abc import Iterable
from dataclasses import dataclass, replace

import sympy as sp

from ptp_symbolic.errors import InputError
from ptp_symbolic.symbolic.derivation.contributions import Contributions, slope_symbol
from ptp_symbolic.symbolic.effect_interface.contribution import Drive, Friction
from ptp_symbolic.symbolic.effect_interface.place import LOADS, quantity, slide
from ptp_symbolic.symbolic.mechanics import kinematics
from ptp_symbolic.symbolic.symbols import ZERO, real

FOLLOWING = ("follower_coupling", "follower_inertia", "follower_torque")
Term = tuple[sp.Symbol, sp.Expr]


@dataclass(frozen=True)
class Mechanics:
    """Mass matrix and forcing over joints and gear outputs."""

    coordinates: tuple[sp.Symbol, ...]
    rates: tuple[sp.Symbol, ...]
    mass: sp.ImmutableMatrix
    forcing: sp.ImmutableMatrix


def driving_torque(drive: Drive, contributions: Contributions, coordinate: sp.Symbol) -> sp.Expr:
    """Torque in N m of `drive` on its row, less what its own inertia takes where it changes."""
    inertia, rate = contributions.resolve(drive.inertia), contributions.drive_rate(drive.axis)
    slope = sp.diff(inertia, coordinate)
    for term in contributions.terms:
        if slope_symbol(term, coordinate) in contributions.terms:
            slope += sp.diff(inertia, term) * slope_symbol(term, coordinate)
    return contributions.resolve(drive.torque) - slope * rate**2 / 2


def resolved_frictions(
    contributions: Contributions, mechanics: Mechanics
) -> tuple[tuple[Friction, ...], tuple[Term, ...]]:
    """The frictions, one per rate, and as named functions the loads that some of them carry.

    Raises InputError when the frictions of two coupled joints, or two on one rate, each depend on
    their load.
    """
    frictions = [
        replace(
            f,
            level=contributions.resolve(f.level),
            breakaway=contributions.resolve(f.breakaway),
            terms={symbol: contributions.resolve(term) for symbol, term in f.terms.items()},
        )
        for f in contributions.frictions
    ]
    merged: dict[sp.Symbol, Friction] = {}
    terms: list[Term] = []
    for friction in frictions:
        found = friction
        if is_loaded(friction):
            _refuse_second(friction, frictions)
            terms += _loads(friction, frictions, contributions, mechanics)
            found = _loaded(friction, frictions)
        terms += found.terms.items()
        before = merged.get(found.rate, replace(found, level=ZERO, breakaway=ZERO))
        merged[found.rate] = replace(
            found, level=before.level + found.level, breakaway=before.breakaway + found.breakaway
        )
    return tuple(merged.values()), tuple(terms)


def _carried(friction: Friction) -> dict[sp.Symbol, sp.Symbol]:
    """Quantities of the load of `friction`, each with the name that it keeps in the equations."""
    names = [f"{name}_{friction.axis}" for name in LOADS]
    return {quantity(name): real(name) for name in names}


def is_loaded(friction: Friction) -> bool:
    """Whether `friction` depends on what it carries."""
    return bool(_carried(friction).keys() & _written_with(friction))


def _written_with(friction: Friction) -> set[sp.Basic]:
    """The symbols in the laws of `friction`."""
    laws = (friction.level, friction.breakaway, *friction.terms.values())
    return {symbol for law in laws for symbol in law.free_symbols}


def _loaded(friction: Friction, frictions: Iterable[Friction]) -> Friction:
    """`friction` with the load put in; other frictions on its rate are a part of the load."""
    beside = [f for f in frictions if f.rate == friction.rate and f is not friction]
    named, direction = _carried(friction), slide(friction.axis)
    load = quantity(f"load_torque_{friction.axis}")
    sliding = named[load] - direction * sum((f.level for f in beside), ZERO)
    resting = named[load] - direction * sum((f.breakaway for f in beside), ZERO)
    return replace(
        friction,
        level=friction.level.xreplace({**named, load: sliding}),
        breakaway=friction.breakaway.xreplace({**named, load: resting}),
        terms={s: e.xreplace({**named, load: sliding}) for s, e in friction.terms.items()},
    )


def _loads(
    friction: Friction,
    frictions: Iterable[Friction],
    contributions: Contributions,
    mechanics: Mechanics,
) -> list[Term]:
    """Torque of the drive, and torque and inertia of the rest, other joints eliminated."""
    row, mass = mechanics.rates.index(friction.rate), mechanics.mass
    rotor, driving = _driven_by(friction.rate, contributions, mechanics.coordinates[row])
    inertia, torque = mass[row, row] - rotor, mechanics.forcing[row] - driving
    by_rate = {f.rate: f for f in frictions}
    beside: list[Term] = []
    for other, rate in enumerate(mechanics.rates):
        if other == row or mass[row, other] == 0:
            continue
        force, free = mechanics.forcing[other], sp.Integer(1)
        if rate in by_rate:
            _refuse_circle(by_rate[rate])
            direction = slide(by_rate[rate].axis)
            force, free = force - direction * by_rate[rate].level, direction**2
        names = [real(f"{word}_{friction.axis}") for word in FOLLOWING]
        beside += zip(names, (mass[row, other], mass[other, other], force), strict=True)
        coupling, other_inertia, other_torque = names
        inertia -= free * coupling**2 / other_inertia
        torque -= free * coupling * other_torque / other_inertia
    loads = zip(_carried(friction).items(), (driving, torque, inertia), strict=True)
    wanted = _written_with(friction)
    return [*beside, *((own, value) for (load, own), value in loads if load in wanted)]


def _driven_by(
    rate: sp.Symbol, contributions: Contributions, coordinate: sp.Symbol
) -> tuple[sp.Expr, sp.Expr]:
    """Inertia and torque of what drives `rate`: a drive, the shaft before a joint, or an input."""
    for drive in contributions.drives:
        if contributions.drive_rate(drive.axis) == rate:
            torque = driving_torque(drive, contributions, coordinate)
            return contributions.resolve(drive.inertia), torque
    axis, inertia = kinematics.place_of(rate), contributions.inertia_on(rate)
    if axis in contributions.split_axes:
        return inertia, contributions.resolve(quantity(f"shaft_torque_{axis}"))
    return inertia, contributions.input_torque(axis.removeprefix("gear_"))


def _refuse_second(friction: Friction, frictions: Iterable[Friction]) -> None:
    if any(is_loaded(f) for f in frictions if f.rate == friction.rate and f is not friction):
        raise InputError(
            f"Two frictions on the {friction.axis} axis depend on the load there, of a lead screw"
            " or of a gear; declare one of them."
        )


def _refuse_circle(friction: Friction) -> None:
    if is_loaded(friction):
        raise InputError(
            "Two coupled joints have friction that depends on the load, of a lead screw or of a"
            " gear; declare shaft_compliance on one of them, or that friction on one of them alone."
        )
