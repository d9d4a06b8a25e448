"""The law of every effect of a platform, as its file states it, and the power that it takes."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations_with_replacement

import sympy as sp

from ptp_symbolic.platform import Platform
from ptp_symbolic.symbolic.derivation.contributions import Contributions, collect
from ptp_symbolic.symbolic.derivation.differentiation import derivative
from ptp_symbolic.symbolic.derivation.equations import Ledger
from ptp_symbolic.symbolic.derivation.ledger import ledger_of
from ptp_symbolic.symbolic.derivation.placement import place_effects
from ptp_symbolic.symbolic.documents.statements import Statement, friction_statements, rate_of, tidy
from ptp_symbolic.symbolic.effect_interface.contribution import Contribution, Friction, Switch
from ptp_symbolic.symbolic.effect_interface.effect import Effect
from ptp_symbolic.symbolic.effect_interface.place import (
    QUANTITY,
    Place,
    quantity,
    quantity_name,
    slide,
)
from ptp_symbolic.symbolic.mechanics import kinematics
from ptp_symbolic.symbolic.mechanics.bodies import Body
from ptp_symbolic.symbolic.mechanics.kinematics import place_of
from ptp_symbolic.symbolic.symbols import ZERO, real

Values = Mapping[sp.Symbol, sp.Expr]
COORDINATES = tuple(
    of(axis) for axis in kinematics.AXES for of in (kinematics.angle, kinematics.gear_angle)
)
DIRECTIONS = "xyz"


@dataclass(frozen=True)
class Law:
    """What one effect states: `contribution`, quantities of its own written out, those of others
    by their names; `rows` are its formulas.

    `ledger` is its own energy and power; `frictions` are those that it brings or changes, each as
    it is without the effect (None if it brings it) and with it. `changes` are quantities of
    others, by name, before and after. `changed_ledger` is the ledger of the effects whose
    quantities it changes.
    """

    effect: Effect
    place: Place
    contribution: Contribution
    rows: tuple[Statement, ...]
    ledger: Ledger
    frictions: tuple[tuple[Friction | None, Friction], ...]
    changes: Mapping[str, tuple[sp.Expr, sp.Expr]]
    changed_ledger: Ledger

    @property
    def axis(self) -> str | None:
        """The axis on which the effect sits, if on one."""
        return self.place.axis


def laws(platform: Platform) -> list[Law]:
    """The laws of all effects of `platform`, each as if no other one changed it.

    Raises InputError as `assemble` does.
    """
    placed = place_effects(platform)
    plain = collect(platform.axes, [(_unchanging(effect), place) for effect, place in placed])
    return [_law(effect, place, placed, plain) for effect, place in placed]


def _unchanging(effect: Effect) -> Effect:
    """`effect` without the changes that it makes to quantities of others."""
    return replace(
        effect, contribute=lambda at: replace(effect.turning_contribution_at(at), changes={})
    )


def _law(
    effect: Effect, place: Place, placed: Sequence[tuple[Effect, Place]], plain: Contributions
) -> Law:
    added = effect.contribution_at(place)
    values = _known(added, plain)
    own = Contributions((added,), values)
    changes = {}
    for name, change in added.changes.items():
        before = _named(own.resolve(quantity(name)))
        after = change.through(before * change.factor + change.addition)
        changes[name] = (before, _named(own.resolve(after)))
    bringing = [
        (other, there, other.contribution_at(there))
        for other, there in placed
        if other is not effect or there != place
    ]
    bringing = [each for each in bringing if each[2].quantities.keys() & added.changes.keys()]
    frictions: list[tuple[Friction | None, Friction]] = [(None, f) for f in _frictions(added, own)]
    ledger, changed = _ledger(added, own, place), Ledger()
    for _, there, other in bringing:
        known = Contributions((other,), _known(other, plain))
        after = {quantity(name): value for name, (_, value) in changes.items()}
        with_it = replace(known, values={**known.values, **after})
        pairs = zip(_frictions(other, known), _frictions(other, with_it), strict=True)
        frictions += [pair for pair in pairs if pair[0] != pair[1]]
        if _ledger(other, known, there) != (new := _ledger(other, with_it, there)):
            changed += new
    return Law(
        effect.worded_at(place),
        place,
        _stated(added, own),
        (
            *_derived(effect, place, own),
            *(row for row in _rows(added, own, changes) if row.right not in (0, row.left)),
        ),
        ledger,
        tuple(frictions),
        changes,
        changed,
    )


def _known(own: Contribution, plain: Contributions) -> dict[sp.Symbol, sp.Expr]:
    """Values of the quantities of `own`, and of those that are a symbol or a number in the end."""
    simple = {symbol: plain.resolve(value) for symbol, value in plain.values.items()}
    known = {
        s: e for s, e in simple.items() if (e.is_Symbol and not _placeholder(e)) or e.is_number
    }
    return known | {quantity(name): value for name, value in own.quantities.items()}


def _placeholder(symbol: sp.Expr) -> bool:
    return str(symbol).startswith(QUANTITY)


def _named(expression: sp.Expr) -> sp.Expr:
    """`expression` with quantities of others as symbols of their names."""
    left = [s for s in expression.free_symbols if _placeholder(s)]
    return expression.xreplace({s: real(quantity_name(s)) for s in left})


def _stated(added: Contribution, own: Contributions) -> Contribution:
    """`added` with its torques, energy, states and switches in symbols alone."""

    def named(expression: sp.Expr) -> sp.Expr:
        return _named(own.resolve(expression))

    return replace(
        added,
        potential=named(added.potential),
        torques={rate: named(torque) for rate, torque in added.torques.items()},
        states=tuple(replace(s, derivative=named(s.derivative)) for s in added.states),
        switches=tuple(
            Switch(s.name, *map(named, (s.deviation, s.threshold, s.drive))) for s in added.switches
        ),
    )


def _frictions(added: Contribution, own: Contributions) -> list[Friction]:
    return [
        replace(
            f,
            level=_named(own.resolve(f.level)),
            breakaway=_named(own.resolve(f.breakaway)),
            terms={s: _named(own.resolve(e)) for s, e in f.terms.items()},
        )
        for f in added.frictions
    ]


def _ledger(added: Contribution, own: Contributions, place: Place) -> Ledger:
    """Energy and power of one effect, the power of a friction in the direction that it slides."""
    found = ledger_of(added, lambda _: place.gear_rate)
    stored, dissipated = found.stored, found.dissipated
    for friction in added.frictions:
        dissipated += slide(friction.axis) * friction.level * friction.rate
    for shaft in added.shafts:
        stored += shaft.energy
        dissipated += shaft.losses * quantity(f"twist_rate_{shaft.axis}")
    parts = (stored, found.power_in, dissipated)
    if not added.drives:
        parts = (stored, ZERO, dissipated - found.power_in)
    return Ledger(*(_named(own.resolve(part)) for part in parts))


def _derived(effect: Effect, place: Place, own: Contributions) -> Iterator[Statement]:
    """The steps from a principle to the law of an effect, as it states them."""
    for words, left, right in effect.derived(place):
        sides = _named(own.resolve(left)), _named(own.resolve(right))
        yield Statement(("step", str(sides[0])), words, *sides)


def _rows(
    added: Contribution,
    own: Contributions,
    changes: Mapping[str, tuple[sp.Expr, sp.Expr]],
) -> Iterator[Statement]:
    """The formulas of an effect, in the order in which one reads them."""

    def row(name: str, left: sp.Expr, right: sp.Expr, relation: str = "=") -> Statement:
        written = tidy(_named(own.resolve(right)))
        return Statement(("law", str(left)), name, left, written, relation)

    for name, (before, after) in changes.items():
        if before.is_Symbol:
            yield row("it changes", before, after, "->")
        else:
            yield row(f"it changes the {name.replace('_', ' ')}", real(name), after)
    for symbol, term in added.terms.items():
        yield row("named functions", symbol, term)
    for rate, torque in added.torques.items():
        yield row("its torque", _torque(place_of(rate)), torque)
    if added.potential != 0:
        yield row("its energy", real("V"), added.potential)
        for coordinate in COORDINATES:
            if added.potential.has(coordinate):
                slope = derivative(added.potential, coordinate)
                yield row("the torque that follows from it", _torque(place_of(coordinate)), -slope)
    for friction in _frictions(added, own):
        for symbol, term in friction.terms.items():
            yield row("named functions", symbol, term)
        yield from friction_statements(friction)
    for shaft in added.shafts:
        twist = quantity(f"twist_{shaft.axis}")
        yield row("energy of its twist", real("V"), shaft.energy)
        torque = derivative(shaft.energy, twist) + shaft.losses
        yield row("the torque that it transmits", real(f"T_shaft_{shaft.axis}"), torque)
    for play in added.plays:
        yield row("half of the gap", real(f"half_gap_{play.axis}"), play.half_gap)
        yield row("the coefficient of restitution", real(f"e_{play.axis}"), play.restitution)
    for drive in added.drives:
        yield row("torque and inertia at the gear output", _torque(drive.axis), drive.torque)
        yield row("inertia", real(f"J_drive_{drive.axis}"), drive.inertia)
    for rate, inertia in added.inertias.items():
        yield row("inertia on the rate", rate, inertia)
    for body in added.bodies:
        for symbol, value in _body(body):
            yield row("mass, centre of mass and inertia of the body", symbol, value)
    if added.stored != 0:
        yield row("energy in its states", real("E"), added.stored)
    for sensor in added.sensors:
        yield row("what may be measured", real(sensor.name), sensor.value)
    for rate, given in added.prescribed.items():
        yield row("the motion that it prescribes", rate_of(rate), given.symbol)
    for axis, delay in added.delays.items():
        late = sp.Function(f"input_{axis}")(kinematics.TIME - delay)
        yield row("an input, as it acts", real(f"input_{axis}_acting"), late)


def _body(body: Body) -> Iterator[tuple[sp.Symbol, sp.Expr]]:
    """What is not zero of mass, centre of mass and inertia, each with its symbol."""
    if body.mass != 0:
        yield real(f"m_{body.name}"), body.mass
    for k, direction in enumerate(DIRECTIONS):
        if body.com[k] != 0:
            yield real(f"c_{body.name}_{direction}"), body.com[k]
    for i, j in combinations_with_replacement(range(3), 2):
        if body.inertia[i, j] != 0:
            yield real(f"J_{body.name}_{DIRECTIONS[i]}{DIRECTIONS[j]}"), body.inertia[i, j]


def _torque(at: str) -> sp.Symbol:
    return real(f"T_{at}")
