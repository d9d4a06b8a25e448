"""The equations of a machine, ready for simplification, emission and documents."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import sympy as sp

from ptp_symbolic.symbolic.effect_interface.conditions import Limit, Requirement
from ptp_symbolic.symbolic.effect_interface.contribution import (
    Friction,
    Input,
    Sampler,
    State,
    Switch,
)
from ptp_symbolic.symbolic.effect_interface.effect import Effect
from ptp_symbolic.symbolic.effect_interface.linear import linear_unit, linear_words
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effect_interface.place import active, side, slide
from ptp_symbolic.symbolic.mechanics.bodies import NO_SPIN, RigidConfiguration, RigidEquations
from ptp_symbolic.symbolic.symbols import ZERO


@dataclass(frozen=True)
class Contact:
    """A dead zone of `half_gap` in a shaft; beyond it a spring and damper that cannot pull.

    `separation` is the angle across the gap in rad. The mode symbols ``side_<axis>`` (-1, 0, 1)
    and ``active_<axis>`` (0, 1) tell which face is touched and whether it transmits torque.

    With a coefficient of `restitution` the two bodies are rigid: they strike, and while active turn
    as one (``torque`` is then zero: what the contact transmits follows from the motion). With
    `holds` the joint rests in the gap.
    """

    axis: str
    separation: sp.Expr
    half_gap: sp.Expr
    torque: sp.Expr
    side: sp.Symbol
    active: sp.Symbol
    restitution: sp.Expr | None = None
    holds: bool = False

    @property
    def rigid(self) -> bool:
        """Whether bodies strike each other, without a spring between."""
        return self.restitution is not None


@dataclass(frozen=True)
class Ledger:
    """Energy in J and powers in W: d(stored)/dt = power_in - dissipated, in every mode."""

    stored: sp.Expr = ZERO
    power_in: sp.Expr = ZERO
    dissipated: sp.Expr = ZERO

    @property
    def parts(self) -> tuple[sp.Expr, sp.Expr, sp.Expr]:
        """Stored energy, incoming and dissipated power."""
        return self.stored, self.power_in, self.dissipated

    def __add__(self, other: "Ledger") -> "Ledger":
        return Ledger(*(a + b for a, b in zip(self.parts, other.parts, strict=True)))

    def __sub__(self, other: "Ledger") -> "Ledger":
        return Ledger(*(a - b for a, b in zip(self.parts, other.parts, strict=True)))


@dataclass(frozen=True)
class PlacedEffect:
    """An effect at its place, the names of its parameters there, the keys (``effect`` or
    ``effect@axis``) of the effects that define what it needs, and the names of its states.
    """

    effect: Effect
    axis: str | None
    parameters: tuple[str, ...]
    acts_on: tuple[str, ...] = ()
    states: tuple[str, ...] = ()


@dataclass(frozen=True)
class Equations:
    """M(q) q'' = forcing, sliding friction apart, and the states of drives and effects.

    Set-valued friction and contact enter through mode symbols, so that the equations are smooth
    in every mode. `forcing` holds everything but the friction torques. `terms` are named functions
    in which they are written, each of those before it. `switches` belong to effects,
    `quantities` are what these call expressions in the equations. `samplers` set
    states at instants. `delays`
    gives for every input the time by which it is late, if it can be. The equations hold within
    `limits`, for parameters that meet the `requirements`.
    """

    name: str
    title: str
    axes: tuple[str, ...]
    coordinates: tuple[sp.Symbol, ...]
    rates: tuple[sp.Symbol, ...]
    mass_matrix: sp.ImmutableMatrix
    forcing: sp.ImmutableMatrix
    terms: tuple[tuple[sp.Symbol, sp.Expr], ...]
    extra_states: tuple[State, ...]
    samplers: tuple[Sampler, ...]
    inputs: tuple[Input, ...]
    delays: tuple[sp.Symbol | None, ...]
    parameters: tuple[Parameter, ...]
    frictions: tuple[Friction, ...]
    contacts: tuple[Contact, ...]
    switches: tuple[Switch, ...]
    outputs: tuple[tuple[str, str, sp.Expr], ...]
    quantities: tuple[tuple[str, sp.Expr], ...]
    limits: tuple[Limit, ...]
    requirements: tuple[Requirement, ...]
    ledger: Ledger
    effects: tuple[PlacedEffect, ...]
    rigid: RigidConfiguration
    rigid_equations: RigidEquations

    def unit(self, rotary: str) -> str:
        """The unit here of what has the unit `rotary` on a rotary joint."""
        return linear_unit(rotary) if self.rigid.sliding else rotary

    def worded(self, rotary: str) -> str:
        """A text about a rotary joint in the words of the joints here."""
        return linear_words(rotary) if self.rigid.sliding else rotary

    @property
    def bodies_at_rest(self) -> RigidConfiguration:
        """The bodies on a base whose measured motion, if it has any, is zero."""
        zero = {given.symbol: ZERO for given in self.inputs}
        gravity = self.rigid.gravity.xreplace(zero)
        return replace(self.rigid, gravity=gravity, base_spin=NO_SPIN, base_spin_rate=NO_SPIN)

    @property
    def rigid_at_rest(self) -> RigidEquations:
        """The rigid equations on a base whose measured motion, if it has any, is zero."""
        zero = {given.symbol: ZERO for given in self.inputs}
        rigid = self.rigid_equations
        return replace(
            rigid,
            forcing=rigid.forcing.xreplace(zero),
            kinetic=rigid.kinetic.xreplace(zero),
            potential=rigid.potential.xreplace(zero),
        )

    @property
    def state_symbols(self) -> tuple[sp.Symbol, ...]:
        """States in the order of the emitted module: joints, drives, effects that can vanish (last
        those that have a motion of their own while they do), what samplers set.
        """
        joints = len(self.axes)
        gears = [
            symbol
            for pair in zip(self.coordinates[joints:], self.rates[joints:], strict=True)
            for symbol in pair
        ]
        sampled = {symbol for _, symbol, _ in self.updates}
        idle = self.idle_states
        extra = sorted(
            self.extra_states,
            key=lambda state: (state.symbol in sampled, state.name in idle, self._goes_on(state)),
        )
        return (
            *self.coordinates[:joints],
            *self.rates[:joints],
            *gears,
            *(s.symbol for s in extra),
        )

    def _goes_on(self, state: State) -> bool:
        """Whether the state of an effect at its vanishing values leaves zero, on a course that
        depends on where it is: to integrate that takes steps of its own.
        """
        names = self.idle_states.get(state.name, ())
        off = {p.symbol: sp.nsimplify(p.vanishes) for p in self.parameters if p.name in names}
        rate = state.derivative.subs(off)
        return bool(names and rate.has(state.symbol) and rate.subs(state.symbol, 0) != 0)

    @property
    def idle_states(self) -> dict[str, tuple[str, ...]]:
        """States of effects that can vanish: without influence while these parameters, by their
        names, are at their vanishing values.
        """
        vanishing = {p.name for p in self.parameters if p.vanishes is not None}
        found = {}
        for placed in self.effects:
            off = tuple(name for name in placed.parameters if name in vanishing)
            found.update(dict.fromkeys(placed.states if off else (), off))
        return found

    def written_out(self, expression: sp.Expr) -> sp.Expr:
        """Return `expression` with the named functions put in."""
        for symbol, term in reversed(self.terms):
            expression = expression.xreplace({symbol: term})
        return expression

    @property
    def varying_inertia(self) -> sp.ImmutableMatrix:
        """What drives behind a varying transmission add to the mass matrix [n, n], in kg m^2."""
        named = {symbol for symbol, _ in self.terms}
        return self.mass_matrix.applyfunc(
            lambda entry: sp.Add(*(a for a in sp.Add.make_args(entry) if a.free_symbols & named))
        )

    @property
    def updates(self) -> tuple[tuple[int, sp.Symbol, sp.Expr], ...]:
        """What samplers set: index of the sampler, the state, its new value."""
        return tuple(
            (index, symbol, value)
            for index, sampler in enumerate(self.samplers)
            for symbol, value in sampler.updates.items()
        )

    @property
    def motion_symbols(self) -> set[sp.Symbol]:
        """What the motion between samples and its energy ledger depend on."""
        still = replace(self, samplers=(), outputs=(), limits=(), delays=())
        return {symbol for e in still.expressions() for symbol in e.free_symbols}

    def expressions(self) -> Iterator[sp.Expr]:
        """All expressions of the equations, each once."""
        yield from (*self.mass_matrix, *self.forcing)
        yield from (term for _, term in self.terms)
        for f in self.frictions:
            yield from (f.level, f.breakaway)
        for c in self.contacts:
            yield from (c.separation, c.half_gap, c.torque)
            yield from () if c.restitution is None else (c.restitution,)
        for s in self.switches:
            yield from (s.deviation, s.threshold, s.drive)
        yield from (state.derivative for state in self.extra_states)
        for sampler in self.samplers:
            yield from (sampler.period, sampler.offset, sampler.phase)
            yield from (*sampler.updates.values(), *sampler.terms.values())
        yield from (reading for _, _, reading in self.outputs)
        for limit in self.limits:
            yield from (limit.lower, limit.upper)
        yield from (self.ledger.stored, self.ledger.power_in, self.ledger.dissipated)
        yield from (delay for delay in self.delays if delay is not None)

    @property
    def mode_symbols(self) -> tuple[sp.Symbol, ...]:
        """Direction of every friction, then side and activity of every contact and switch."""
        slides = [slide(friction.axis) for friction in self.frictions]
        contacts = [symbol for c in self.contacts for symbol in (c.side, c.active)]
        switches = [symbol for s in self.switches for symbol in (side(s.name), active(s.name))]
        return (*slides, *contacts, *switches)
