"""The bond graph of a declared platform, from the contributions of its effects.

Every coordinate has a 1-junction, where the torques that act on it add up. What an effect adds is
an element on the junctions that it works on; its kind follows from its energy ledger: what stores
is an I (by its rate) or a C (by its place), what loses an R, what supplies a source. Motors are
gyrators, gears transformers, a shaft is a 0-junction of one torque. Source: Karnopp, Margolis and
Rosenberg, System Dynamics, 5th edition 2012, chapters 3, 4 and 9; thesis section 2.1.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import sympy as sp

from ptp_symbolic.platform import Platform
from ptp_symbolic.symbolic.derivation.causality import strokes
from ptp_symbolic.symbolic.derivation.contributions import slope_symbol
from ptp_symbolic.symbolic.derivation.equations import Ledger
from ptp_symbolic.symbolic.derivation.ledger import ledger_of
from ptp_symbolic.symbolic.derivation.machine import Machine, machine
from ptp_symbolic.symbolic.derivation.transmission import Transmission
from ptp_symbolic.symbolic.effect_interface.contribution import Contribution, Drive, Play
from ptp_symbolic.symbolic.effect_interface.effect import Effect
from ptp_symbolic.symbolic.effect_interface.place import slide
from ptp_symbolic.symbolic.mechanics import kinematics
from ptp_symbolic.symbolic.mechanics.kinematics import TIME
from ptp_symbolic.symbolic.symbols import ZERO, real

ONE, SHARED_EFFORT, TRANSFORMER, GYRATOR = "1", "0", "TF", "GY"
INERTIA, COMPLIANCE, RESISTOR, EFFORT, FLOW, SWITCH = "I", "C", "R", "Se", "Sf", "Sw"
MODULATED = "M"


@dataclass(frozen=True)
class Node:
    """A junction ("0", "1"), a transformer ("TF"), a gyrator ("GY") or an element.

    `law` is the flow of a 1-junction, the effort of a 0-junction, the modulus of a transformer or
    gyrator, what characterises an element. The `ledger` is that of an element: what comes in by its
    bonds and is supplied is stored or dissipated. `meaning` says in words what it is.
    """

    name: str
    kind: str
    law: sp.Expr
    meaning: str
    axis: str | None = None
    ledger: Ledger = field(default_factory=Ledger)


@dataclass(frozen=True)
class Bond:
    """Power effort times flow in W from `tail` to `head`; the stroke is `at_head`, or at the tail.

    The effort acts towards the end with the causal stroke.
    """

    tail: str
    head: str
    effort: sp.Expr
    flow: sp.Expr
    at_head: bool = True

    @property
    def power(self) -> sp.Expr:
        """Power in W."""
        return self.effort * self.flow


@dataclass(frozen=True)
class Motion:
    """How states move: the derivative of each, those of rates as symbols (see `acceleration`);
    `terms` are named functions of the angles, and their slopes.
    """

    rates: Mapping[sp.Symbol, sp.Expr]
    terms: Mapping[sp.Symbol, sp.Expr]

    def growth(self, expression: sp.Expr) -> sp.Expr:
        """The time derivative of `expression`, slopes of named functions by their names."""
        parts = [sp.diff(expression, TIME)]
        parts += [sp.diff(expression, state) * rate for state, rate in self.rates.items()]
        for term in sorted(expression.free_symbols & self.terms.keys(), key=str):
            for angle, rate in self.rates.items():
                if (slope := slope_symbol(term, angle)) in self.terms:
                    parts.append(sp.diff(expression, term) * slope * rate)
        return sp.Add(*parts)

    def moves(self, expression: sp.Expr) -> bool:
        """Whether `expression` depends on states or time."""
        return bool(expression.free_symbols & {*self.rates, *self.terms, TIME})


@dataclass(frozen=True)
class BondGraph:
    """Nodes and bonds of a machine that moves as `motion` says."""

    nodes: tuple[Node, ...]
    bonds: tuple[Bond, ...]
    motion: Motion

    def node(self, name: str) -> Node:
        """The node of that name."""
        return next(node for node in self.nodes if node.name == name)

    @property
    def ledger(self) -> Ledger:
        """The sum of the ledgers of all elements."""
        return sum((node.ledger for node in self.nodes), Ledger())

    def surplus(self, node: Node) -> sp.Expr:
        """Power in W that `node` takes by its bonds and neither passes on, stores nor loses: zero
        by the equations of motion.
        """
        flows = [bond.power for bond in self.bonds if bond.head == node.name]
        flows += [-bond.power for bond in self.bonds if bond.tail == node.name]
        own = node.ledger
        return sp.Add(*flows, own.power_in, -own.dissipated, -self.motion.growth(own.stored))

    @property
    def dependent(self) -> tuple[Node, ...]:
        """Elements that store what others make them store: those in derivative causality."""
        return tuple(n for n in self.nodes if self._is_dependent(n))

    def _is_dependent(self, node: Node) -> bool:
        inertial = node.kind == INERTIA
        if not inertial and COMPLIANCE not in node.kind:
            return False
        return any(b.at_head != inertial for b in self.bonds if b.head == node.name)


def acceleration(rate: sp.Symbol) -> sp.Symbol:
    """The symbol of the derivative of a joint's or gear output's rate."""
    return real(f"alpha_{kinematics.place_of(rate)}")


def bond_graph(platform: Platform) -> BondGraph:
    """The bond graph of `platform`, its causal strokes included.

    Raises InputError as `machine` does.
    """
    parts = machine(platform)
    found = _Parts(parts)
    for rate in parts.full.rates:
        found.junction(rate)
    _bodies(found)
    for (effect, _), own in zip(parts.placed, parts.contributions.by_effect, strict=True):
        _effect(found, effect, own)
    for drive in parts.contributions.drives:
        _drive(found, drive)
    for play in parts.contributions.plays:
        _play(found, play)
    _frictions(found)
    _sources(found)
    bonds = tuple(found.bonds)
    ends = [(bond.tail, bond.head) for bond in bonds]
    marks = strokes({node.name: node.kind for node in found.nodes}, ends)
    marked = tuple(replace(b, at_head=mark) for b, mark in zip(bonds, marks, strict=True))
    return BondGraph(tuple(found.nodes), marked, found.motion)


class _Parts:
    """Nodes and bonds as they are collected."""

    def __init__(self, parts: Machine) -> None:
        self.machine = parts
        self.contributions = parts.contributions
        self.resolve = parts.contributions.resolve
        self.nodes: list[Node] = []
        self.bonds: list[Bond] = []
        self.rate_of = dict(zip(parts.full.coordinates, parts.full.rates, strict=True))
        rates: dict[sp.Symbol, sp.Expr] = {**self.rate_of}
        rates |= {rate: acceleration(rate) for rate in parts.full.rates}
        for own in self.contributions.by_effect:
            rates |= {s.symbol: self.resolve(s.derivative) for s in own.states}
        self.motion = Motion(rates, self.contributions.terms)

    def junction(self, rate: sp.Symbol) -> None:
        at = kinematics.place_of(rate)
        linear = at in self.machine.rigid.sliding
        what = "gear output" if at.startswith("gear_") else "linear joint" if linear else "joint"
        axis = at.removeprefix("gear_")
        self.nodes.append(Node(at, ONE, rate, f"{axis} {what}", axis))

    def add(self, node: Node, efforts: Mapping[sp.Symbol, sp.Expr]) -> None:
        """An element with a bond from the junction of every rate on which its efforts act, or to
        it where it is a source.
        """
        source = node.kind.removeprefix(MODULATED) in (EFFORT, FLOW)
        self.nodes.append(node)
        for rate, effort in efforts.items():
            at = kinematics.place_of(rate)
            if source:
                self.bonds.append(Bond(node.name, at, -effort, rate))
            else:
                self.bonds.append(Bond(at, node.name, effort, rate))

    def source_kind(self, effort: sp.Expr) -> str:
        """A source of effort, modulated where the effort depends on the state or on time."""
        return MODULATED + EFFORT if self.motion.moves(effort) else EFFORT


def _bodies(found: _Parts) -> None:
    """Inertia and gravity of the rigid bodies, one field each over all joints, and what a base
    exerts on them whose motion is measured.
    """
    rigid, still = found.machine.full_rigid, found.machine.base.at_rest
    rigid = replace(
        rigid,
        forcing=rigid.forcing.xreplace(still),
        kinetic=rigid.kinetic.xreplace(still),
        potential=rigid.potential.xreplace(still),
    )
    speeds = [acceleration(rate) for rate in rigid.rates]
    inertial = rigid.mass_matrix * sp.Matrix(speeds) - rigid.forcing
    slopes = [sp.diff(rigid.potential, q) for q in rigid.coordinates]
    several = len(rigid.rates) > 1
    efforts = {
        rate: sp.expand(effort - slope)
        for rate, effort, slope in zip(rigid.rates, inertial, slopes, strict=True)
    }
    law = real("M") if several else sp.factor_terms(rigid.mass_matrix[0, 0])
    axis = None if several else rigid.axes[0]
    stored = Ledger(stored=rigid.kinetic)
    found.add(Node("bodies", INERTIA, law, "inertia of the bodies", axis, stored), efforts)
    if rigid.potential != 0:
        pulls = {w: slope for w, slope in zip(rigid.rates, slopes, strict=True) if slope != 0}
        gravity = Ledger(rigid.potential, sp.diff(rigid.potential, TIME))
        meaning = "weight of the bodies"
        meaning += " on the moving base" if gravity.power_in != 0 else ""
        axis = kinematics.place_of(next(iter(pulls))) if len(pulls) == 1 else None
        kind = COMPLIANCE if gravity.power_in == 0 else COMPLIANCE + "S"
        found.add(Node("gravity", kind, real("V"), meaning, axis, gravity), pulls)
    if pushes := found.machine.base_torques:
        ledger = Ledger(power_in=sp.Add(*(torque * rate for rate, torque in pushes.items())))
        axis = kinematics.place_of(next(iter(pushes))) if len(pushes) == 1 else None
        base = Node("base", MODULATED + EFFORT, real("T_base"), "moving base", axis, ledger)
        found.add(base, {rate: -torque for rate, torque in pushes.items()})


def _effect(found: _Parts, effect: Effect, own: Contribution) -> None:
    """What one effect adds beside its motor, its frictions and its bodies."""
    key = f"{effect.id}_{len(found.nodes)}"
    ledger = _own_ledger(found, effect, own)
    if own.shafts:
        for shaft in own.shafts:
            (given,) = (t for t in found.machine.transmissions if t.axis == shaft.axis)
            _shaft(found, given, effect.title, ledger)
        return
    for rate, inertia in own.inertias.items():
        stored, law = Ledger(stored=found.resolve(inertia) * rate**2 / 2), found.resolve(inertia)
        place = kinematics.place_of(rate).removeprefix("gear_")
        node = Node(f"inertia_{key}", INERTIA, law, f"{effect.title}, {place} axis", place, stored)
        found.add(node, {rate: law * acceleration(rate)})
    efforts = {rate: -found.resolve(torque) for rate, torque in own.torques.items()}
    potential = found.resolve(own.potential)
    for coordinate, rate in found.rate_of.items():
        if (slope := sp.diff(potential, coordinate)) != 0:
            efforts[rate] = efforts.get(rate, ZERO) + slope
    efforts = {rate: effort for rate, effort in efforts.items() if effort != 0}
    if not efforts:
        return
    kind = _kind(ledger)
    if kind == EFFORT:
        kind = found.source_kind(sp.Add(*efforts.values()))
    places = {kinematics.place_of(rate).removeprefix("gear_") for rate in efforts}
    axis = places.pop() if len(places) == 1 else None
    meaning = f"{effect.title}, {axis} axis" if axis else effect.title
    found.add(Node(key, kind, _law(kind, efforts), meaning, axis, ledger), efforts)


def _own_ledger(found: _Parts, effect: Effect, own: Contribution) -> Ledger:
    bare = replace(own, drives=(), inertias={})
    ledger = ledger_of(bare, found.contributions.drive_rate)
    stored, power_in, dissipated = map(found.resolve, ledger.parts)
    return Ledger(stored, power_in + sp.diff(stored, TIME), dissipated)


def _kind(ledger: Ledger) -> str:
    """The letters of an element with this ledger: R, C and S (a source), as many as it has."""
    if ledger.stored == 0 and ledger.dissipated == 0:
        return EFFORT
    pairs = ((ledger.dissipated, RESISTOR), (ledger.stored, COMPLIANCE), (ledger.power_in, "S"))
    return "".join(letter for part, letter in pairs if part != 0)


def _law(kind: str, efforts: Mapping[sp.Symbol, sp.Expr]) -> sp.Expr:
    """What to write beside an element: its coefficient, if it is linear, else nothing."""
    if len(efforts) != 1:
        return ZERO
    ((rate, effort),) = efforts.items()
    if kind == EFFORT:
        return -effort
    slope = sp.diff(effort, rate)
    return slope if kind == RESISTOR and sp.expand(effort - slope * rate) == 0 else ZERO


def _shaft(found: _Parts, shaft: Transmission, title: str, own: Ledger) -> None:
    """A torque that gear output and joint share; spring and damper of the twist between them."""
    axis, resolve = shaft.axis, found.resolve
    gear, joint = f"gear_{axis}", axis
    ratio, speed = resolve(shaft.ratio), resolve(shaft.speed)
    spring, loss = resolve(shaft.spring), resolve(shaft.loss)
    _, (_, transmitted) = shaft.torques
    torque, name = resolve(transmitted), f"shaft_{axis}"
    gear_rate, rate = kinematics.gear_rate(axis), kinematics.rate(axis)
    before = gear
    if ratio != 1:
        before = f"true_{axis}"
        error = Node(before, MODULATED + TRANSFORMER, 1 / ratio, "error of the gear", axis)
        found.nodes.append(error)
        found.bonds.append(Bond(gear, before, torque * ratio, gear_rate))
    found.nodes.append(Node(name, SHARED_EFFORT, real(f"T_shaft_{axis}"), title, axis))
    found.bonds.append(Bond(before, name, torque, gear_rate * ratio))
    found.bonds.append(Bond(name, joint, torque, rate))
    total = Ledger(*map(resolve, shaft.ledger.parts)) + own
    if own != Ledger():
        meaning = f"twist of the {title}"
        found.nodes.append(Node(f"twist_{axis}", _kind(total), ZERO, meaning, axis, total))
        found.bonds.append(Bond(name, f"twist_{axis}", torque, speed))
        return
    twist = f"twist_{axis}"
    found.nodes.append(Node(twist, ONE, speed, f"twist of the {axis} shaft", axis))
    found.bonds.append(Bond(name, twist, torque, speed))
    for part, kind, effort, ledger in (
        ("spring", COMPLIANCE, spring, Ledger(stored=total.stored)),
        ("damper", RESISTOR, loss, Ledger(dissipated=total.dissipated)),
    ):
        if effort != 0:
            slope = sp.diff(spring, kinematics.gear_angle(axis)) if kind == COMPLIANCE else ZERO
            law = 1 / slope if slope.is_Symbol else ZERO
            meaning = f"{part} of the {axis} shaft"
            found.nodes.append(Node(f"{part}_{axis}", kind, law, meaning, axis, ledger))
            found.bonds.append(Bond(twist, f"{part}_{axis}", effort, speed))


def _drive(found: _Parts, drive: Drive) -> None:
    """Winding, gyrator, rotor, and the transformers up to the gear output."""
    axis, current, speed = drive.axis, drive.current, found.resolve(drive.speed)
    winding, rotor, motor = f"winding_{axis}", f"rotor_{axis}", f"motor_{axis}"
    resistance, lost = found.resolve(drive.resistance), drive.damping * speed
    induced = sp.expand(drive.inductance * found.resolve(drive.current_slope))
    accelerating = drive.rotor * found.motion.growth(speed)
    voltage = found.resolve(drive.voltage)
    law = voltage if voltage.is_Symbol else real(f"u_motor_{axis}")

    def element(
        at: str, kind: str, law: sp.Expr, word: str, effort: sp.Expr, ledger: Ledger
    ) -> None:
        name = f"{word.replace(' ', '_')}_{axis}"
        ends = (name, at) if kind.endswith(EFFORT) else (at, name)
        found.nodes.append(Node(name, kind, law, f"{word} of the {axis} motor", axis, ledger))
        found.bonds.append(Bond(*ends, effort, current if at == winding else speed))

    found.nodes += [
        Node(winding, ONE, current, f"current of the {axis} motor", axis),
        Node(motor, GYRATOR, drive.constant, f"torque constant of the {axis} motor", axis),
        Node(rotor, ONE, speed, f"rotor of the {axis} motor", axis),
    ]
    supplied = Ledger(power_in=voltage * current)
    element(winding, found.source_kind(voltage), law, "voltage", voltage, supplied)
    magnetic = Ledger(stored=drive.stored)
    element(winding, INERTIA, drive.inductance, "inductance", induced, magnetic)
    heat = Ledger(dissipated=found.resolve(drive.loss))
    element(winding, RESISTOR, resistance, "resistance", resistance * current, heat)
    found.bonds.append(Bond(winding, motor, drive.constant * speed, current))
    found.bonds.append(Bond(motor, rotor, drive.constant * current, speed))
    kinetic = Ledger(stored=drive.rotor * speed**2 / 2)
    element(rotor, INERTIA, drive.rotor, "rotor inertia", accelerating, kinetic)
    if lost != 0:
        friction = Ledger(dissipated=lost * speed)
        element(rotor, RESISTOR, drive.damping, "rotor friction", lost, friction)
    _gears(found, drive, drive.constant * current - lost - accelerating)


def _gears(found: _Parts, drive: Drive, effort: sp.Expr) -> None:
    """Transformers from the rotor to the gear output, one for every factor of the ratio."""
    axis, rate = drive.axis, found.contributions.drive_rate(drive.axis)
    moduli = _stages(found, found.resolve(drive.ratio))
    before, flow = f"rotor_{axis}", found.resolve(drive.speed)
    for number, modulus in enumerate(moduli):
        name = f"gear_{number}_{axis}"
        kind = MODULATED + TRANSFORMER if found.motion.moves(modulus) else TRANSFORMER
        found.nodes.append(Node(name, kind, modulus, f"{axis} gear", axis))
        found.bonds.append(Bond(before, name, effort, flow))
        before, effort = name, effort * modulus
        flow = sp.Mul(*moduli[number + 1 :]) * rate
    found.bonds.append(Bond(before, kinematics.place_of(rate), effort, rate))


def _stages(found: _Parts, ratio: sp.Expr) -> list[sp.Expr]:
    """The factors of a gear ratio: gears, screws (turn per travel), what varies with the angle."""
    written = found.contributions.terms.get(ratio, ratio) if ratio.is_Symbol else ratio
    factors = sp.Mul.make_args(written)
    moving = sp.Mul(*(f for f in factors if found.motion.moves(f)))
    fixed = [f for f in factors if f.free_symbols and not found.motion.moves(f)]
    fixed.sort(key=lambda f: (sp.fraction(f)[0] == 1, str(f)))
    number = sp.Mul(*(f for f in factors if not f.free_symbols))
    if fixed and number.has(sp.pi):
        fixed[-1], number = fixed[-1] * 2 * sp.pi, number / (2 * sp.pi)
    rest = number * moving
    return [*fixed, rest] if rest != 1 or not fixed else fixed


def _play(found: _Parts, play: Play) -> None:
    """Rigid faces: one torque on both, which works only where the gap is open and it is zero."""
    axis = play.axis
    rate, gear = kinematics.rate(axis), kinematics.gear_rate(axis)
    torque, name, gap = real(f"T_contact_{axis}"), f"contact_{axis}", f"gap_{axis}"
    found.nodes.append(Node(name, SHARED_EFFORT, torque, f"faces of the {axis} gap", axis))
    found.nodes.append(Node(gap, SWITCH, ZERO, f"gap of the {axis} drive", axis))
    found.bonds += [
        Bond(f"gear_{axis}", name, torque, gear),
        Bond(name, axis, torque, rate),
        Bond(name, gap, torque, gear - rate),
    ]


def _frictions(found: _Parts) -> None:
    """Dry friction, one resistor for every rate; at rest it takes what acts, without power."""
    for friction in found.machine.frictions:
        meaning = f"dry friction: {_friction_titles(found, friction.rate)}"
        effort = slide(friction.axis) * friction.level
        ledger = Ledger(dissipated=effort * friction.rate)
        at = kinematics.place_of(friction.rate)
        node = Node(f"friction_{at}", RESISTOR, ZERO, meaning, friction.axis, ledger)
        found.add(node, {friction.rate: effort})


def _friction_titles(found: _Parts, rate: sp.Symbol) -> str:
    pairs = zip(found.machine.placed, found.contributions.by_effect, strict=True)
    return " and ".join(
        e.title for (e, _), own in pairs if any(f.rate == rate for f in own.frictions)
    )


def _sources(found: _Parts) -> None:
    """Torque inputs, and motions that are prescribed."""
    for axis in found.machine.rigid.axes:
        torque, rate = found.contributions.input_torque(axis), found.contributions.drive_rate(axis)
        if torque != 0:
            ledger = Ledger(power_in=torque * rate)
            law = torque if torque.is_Symbol else real(f"T_input_{axis}")
            where = "joint" if rate == kinematics.rate(axis) else "gear output"
            meaning = f"input of the {axis} {where}"
            kind = found.source_kind(torque)
            found.add(Node(f"input_{axis}", kind, law, meaning, axis, ledger), {rate: -torque})
    for rate, torque in found.machine.constraint_torques.items():
        given, at = found.contributions.prescribed[rate], kinematics.place_of(rate)
        ledger = Ledger(power_in=torque * rate)
        node = Node(f"input_{at}", FLOW, given.symbol, given.meaning, at, ledger)
        found.add(node, {rate: -torque})
