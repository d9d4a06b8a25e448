"""What an effect is: parameters, the values at which it vanishes, and what it adds.

An effect is plain data plus one function, `contribute`, that turns the place where the effect
sits into symbolic additions. Effects never name each other: they meet in *quantities*, named
placeholders such as ``winding_resistance_pan`` that one effect defines and others change.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import sympy as sp

from ptp_symbolic.symbolic.effects.conditions import Limit, Requirement
from ptp_symbolic.symbolic.mechanics import kinematics
from ptp_symbolic.symbolic.mechanics.bodies import Body
from ptp_symbolic.symbolic.parameters import Parameter

LOADS = ("driving_torque", "load_torque", "load_inertia")


def _unchanged(value: sp.Expr) -> sp.Expr:
    return value


@dataclass(frozen=True)
class Change:
    """What an effect does to a quantity: multiply by `factor`, add `addition`, send it `through`.

    Factors come first, then additions, then functions, each in catalogue order.
    """

    factor: sp.Expr = sp.Integer(1)
    addition: sp.Expr = sp.Integer(0)
    through: Callable[[sp.Expr], sp.Expr] = _unchanged


@dataclass(frozen=True)
class State:
    """A state of an effect: name, unit, meaning, time derivative, value at the start.

    `zero_at_rest_of` names the axis whose friction sets the state to zero when it comes to rest.
    """

    name: str
    unit: str
    meaning: str
    derivative: sp.Expr
    initial: float = 0.0
    zero_at_rest_of: str | None = None


@dataclass(frozen=True)
class Sampler:
    """Sets states that are held in between at the instants offset + (k + phase) period, in s.

    k counts from 0. `updates` gives the new values by state, all from what holds just before: time,
    states, inputs and the quantities ``reading_<state>`` of the sensors; `terms` are functions of
    those that the equations keep under their names, each of those before it. `period` and `offset`
    depend on parameters, `phase` also on held states as they are when the period starts: from 1 on
    there is no instant in this period. Where instants coincide the inputs have jumped already,
    samplers run in the order of the catalogue, each after what those before it have set, and modes
    of friction and contact follow last.
    """

    period: sp.Expr
    updates: Mapping[sp.Symbol, sp.Expr]
    offset: sp.Expr = sp.Integer(0)
    phase: sp.Expr = sp.Integer(0)
    terms: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)


@dataclass(frozen=True)
class Input:
    """An input of the machine: name, unit, meaning."""

    name: str
    unit: str
    meaning: str


@dataclass(frozen=True)
class Friction:
    """Set-valued dry friction that acts on one rate.

    `level` > 0 is the friction torque in N m while sliding, `breakaway` the torque that holds at
    rest; both may depend on the direction symbol ``slide_<axis>`` (-1, 0 or 1) and, where a drive
    works on `rate`, on the quantities ``driving_torque_<axis>`` of the drive, less what its own
    inertia takes as it changes, and ``load_torque_<axis>`` and ``load_inertia_<axis>`` of the rest
    of the machine, other joints free to follow. `terms` are functions of those that the equations
    keep under their names, each of those before it.
    """

    axis: str
    rate: sp.Symbol
    level: sp.Expr
    breakaway: sp.Expr
    terms: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)


@dataclass(frozen=True)
class Shaft:
    """A spring and damper between the gear output and the joint of `axis`."""

    axis: str
    stiffness: sp.Expr
    damping: sp.Expr


@dataclass(frozen=True)
class Play:
    """A gap of twice `half_gap` in rad between gear output and joint of `axis`, both rigid.

    Faces strike with the coefficient of `restitution`; joined, the two turn as one body until they
    would pull at each other. With `holds`, friction keeps the joint where it is while it crosses
    the gap, and at the face until the gear output turns back; assumed is that nothing but the gear
    output drives the joint, or contact may end and begin again without end.
    """

    axis: str
    half_gap: sp.Expr
    restitution: sp.Expr
    holds: bool = False


@dataclass(frozen=True)
class Drive:
    """A motor on `axis`: inertia in kg m^2 and torque in N m, both seen at the gear output.

    The inertia may depend on the joint angle (a linkage); it then moves along with the joint.
    `inputs` replaces the torque input of the axis; `power_in`, `stored` and `dissipated` are the
    electrical part of the energy ledger in W, J and W.
    """

    axis: str
    inertia: sp.Expr
    torque: sp.Expr
    inputs: tuple[Input, ...]
    power_in: sp.Expr
    stored: sp.Expr
    dissipated: sp.Expr


@dataclass(frozen=True)
class Contribution:
    """Everything that an effect may add to the machine.

    `terms` are functions that the equations keep under their names, each of those before it.
    `potential` is an energy of the coordinates, whose gradient acts as torques; `stored` an energy
    of the effect's own states, which its `torques` charge and discharge. `delays` hold back the
    inputs of an axis. `prescribed` gives joint rates an acceleration as input, in place of the
    torque on the joint; `commands` gives an axis other inputs than those of its drive. What a
    sensor shows is the quantity ``reading_<state>``.
    """

    quantities: Mapping[str, sp.Expr] = field(default_factory=dict)
    changes: Mapping[str, Change] = field(default_factory=dict)
    terms: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)
    bodies: tuple[Body, ...] = ()
    potential: sp.Expr = sp.Integer(0)
    stored: sp.Expr = sp.Integer(0)
    torques: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)
    frictions: tuple[Friction, ...] = ()
    shafts: tuple[Shaft, ...] = ()
    plays: tuple[Play, ...] = ()
    drives: tuple[Drive, ...] = ()
    states: tuple[State, ...] = ()
    samplers: tuple[Sampler, ...] = ()
    commands: Mapping[str, tuple[Input, ...]] = field(default_factory=dict)
    delays: Mapping[str, sp.Symbol] = field(default_factory=dict)
    limits: tuple[Limit, ...] = ()
    prescribed: Mapping[sp.Symbol, Input] = field(default_factory=dict)


@dataclass(frozen=True)
class Place:
    """Where an effect sits: axes of the machine, its own axis and site, axes with a shaft."""

    axes: tuple[str, ...]
    axis: str | None
    site: str | None
    shafts: frozenset[str]

    def named(self, parameters: tuple[Parameter, ...]) -> tuple[Parameter, ...]:
        """The `parameters` of an effect with the name of its axis filled in."""
        return tuple(p.at_axis(self.axis) for p in parameters)

    def parameter(self, template: str) -> sp.Symbol:
        """Symbol of the effect's parameter, e.g. ``k_shaft_{axis}``."""
        return sp.Symbol(template.format(axis=self.axis), real=True)

    def quantity(self, template: str) -> sp.Symbol:
        """Placeholder of a named quantity that other effects may change."""
        return quantity(template.format(axis=self.axis))

    @property
    def own_axis(self) -> str:
        """The axis of an effect that always sits on one."""
        if self.axis is None:
            raise ValueError("This effect sits on an axis; name one.")
        return self.axis

    @property
    def angle(self) -> sp.Symbol:
        """Joint angle of the effect's axis in rad."""
        return kinematics.angle(self.own_axis)

    @property
    def rate(self) -> sp.Symbol:
        """Joint rate of the effect's axis in rad/s."""
        return kinematics.rate(self.own_axis)

    @property
    def gear_rate(self) -> sp.Symbol:
        """Rate at the gear output: a coordinate of its own behind a shaft, else the joint rate."""
        if self.own_axis in self.shafts:
            return kinematics.gear_rate(self.own_axis)
        return self.rate

    @property
    def gear_angle(self) -> sp.Symbol:
        """Angle at the gear output: a coordinate of its own behind a shaft, else the joint's."""
        if self.own_axis in self.shafts:
            return kinematics.gear_angle(self.own_axis)
        return self.angle

    @property
    def slide(self) -> sp.Symbol:
        """Direction of sliding of the friction on the effect's axis: -1, 0 (at rest) or 1."""
        return slide(self.own_axis)

    @property
    def loads(self) -> tuple[sp.Symbol, sp.Symbol, sp.Symbol]:
        """What friction in the drive carries, see `Friction`: torques in N m, inertia in kg m^2."""
        driving, torque, inertia = (self.quantity(f"{name}_{{axis}}") for name in LOADS)
        return driving, torque, inertia

    @property
    def payload_frame(self) -> str:
        """Frame that carries a payload: the tilt body, or the pan body where there is no tilt."""
        return "tilt" if "tilt" in self.axes else "pan"


def quantity(name: str) -> sp.Symbol:
    """Placeholder symbol of the quantity `name`."""
    return sp.Symbol(f"quantity:{name}", real=True)


def slide(axis: str) -> sp.Symbol:
    """Direction symbol of the friction on `axis`."""
    return sp.Symbol(f"slide_{axis}", real=True)


def _without_conditions(place: Place) -> tuple[Requirement, ...]:
    return ()


@dataclass(frozen=True)
class Member:
    """A simpler version of an effect: the templates of the `parameters` that it has.

    The others stay where they vanish, or take the value of another one, as `tied` says. A search
    names an effect with the smallest member that the logs ask for.
    """

    title: str
    parameters: tuple[str, ...]
    tied: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class Effect:
    """A physical effect, complete in one file.

    `on_axis`: it sits on an axis, not on the whole platform. `needs`: quantities without which it
    has nothing to act on; `requires`: what its parameters must fulfil. `dissipative`: its torques
    only take energy out, which tests verify. `structural`: no parameter value makes it vanish (a
    motor, a body): declared, never searched for. `members` are nested versions of it, the simplest
    first and the whole last. Other `kinds` share its id; this is the usual one.
    """

    id: str
    title: str
    reference: str
    parameters: Callable[[Place], tuple[Parameter, ...]]
    contribute: Callable[[Place], Contribution]
    on_axis: bool = True
    dissipative: bool = False
    structural: bool = False
    splits_axis: bool = False
    needs: tuple[str, ...] = ()
    requires: Callable[[Place], tuple[Requirement, ...]] = _without_conditions
    separating_experiment: str = ""
    members: tuple[Member, ...] = ()
    kind: str | None = None
    kinds: tuple["Effect", ...] = ()
