"""What an effect may add to the machine: plain records of symbolic expressions."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import sympy as sp

from ptp_symbolic.symbolic.effect_interface.conditions import Limit
from ptp_symbolic.symbolic.mechanics.bodies import Body
from ptp_symbolic.symbolic.symbols import ZERO, real


def _unchanged(value: sp.Expr) -> sp.Expr:
    return value


@dataclass(frozen=True)
class Change:
    """What an effect does to a quantity: multiply by `factor`, add `addition`, send it `through`.

    Factors come first, then additions, then functions, each in catalogue order.
    """

    factor: sp.Expr = sp.Integer(1)
    addition: sp.Expr = ZERO
    through: Callable[[sp.Expr], sp.Expr] = _unchanged


@dataclass(frozen=True)
class State:
    """A state of an effect: name, unit, meaning, time derivative, value at the start.

    `zero_at_rest_of` names the axis whose friction sets the state to zero when it comes to rest.
    What `turns` is of a motor, which does so before a linear joint too.
    """

    name: str
    unit: str
    meaning: str
    derivative: sp.Expr
    initial: float = 0.0
    zero_at_rest_of: str | None = None
    turns: bool = False

    @property
    def symbol(self) -> sp.Symbol:
        """The symbol of the state."""
        return real(self.name)


@dataclass(frozen=True)
class Sampler:
    """Sets states at the sampling instants offset + (k + phase) period, in s; they are constant in
    between.

    k counts from 0. `updates` gives the new values by state, all from what holds just before: time,
    states, inputs and the quantities ``reading_<state>`` of the sensors; `terms` are functions of
    those, named intermediate expressions in evaluation order. `period` and `offset` depend on
    parameters, `phase` also on sampled states as they are when the period starts: from 1 on there
    is no instant in this period. Where instants coincide the inputs have jumped already,
    samplers run in the order of the catalogue, each after what those before it have set, and modes
    of friction and contact follow last.
    """

    period: sp.Expr
    updates: Mapping[sp.Symbol, sp.Expr]
    offset: sp.Expr = ZERO
    phase: sp.Expr = ZERO
    terms: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)


@dataclass(frozen=True)
class Input:
    """An input of the machine: name, unit, meaning."""

    name: str
    unit: str
    meaning: str

    @property
    def symbol(self) -> sp.Symbol:
        """The symbol of the input."""
        return real(self.name)


@dataclass(frozen=True)
class Sensor:
    """What may be measured beside joint angles and states: name, unit, meaning, value.

    It is an output of the platforms that declare a signal of that name.
    """

    name: str
    unit: str
    meaning: str
    value: sp.Expr


@dataclass(frozen=True)
class Friction:
    """Set-valued dry friction that acts on one rate.

    `level` > 0 is the friction torque in N m while sliding, `breakaway` the torque that holds at
    rest; both may depend on the direction symbol ``slide_<axis>`` (-1, 0 or 1), on the quantity
    ``driving_torque_<axis>`` of what drives `rate` (a drive, less what its own inertia takes as it
    changes, the shaft before a joint, or a torque input), and on ``load_torque_<axis>`` and
    ``load_inertia_<axis>`` of the rest of the machine, other joints free to follow. `terms` are
    functions of those that the equations keep under their names, each of those before it.
    """

    axis: str
    rate: sp.Symbol
    level: sp.Expr
    breakaway: sp.Expr
    terms: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)


@dataclass(frozen=True)
class Shaft:
    """A flexible shaft between the gear output and the joint of `axis`.

    Its `energy` in J is a function of the quantity ``twist_<axis>``, zero at zero twist; its slope
    is the torque of the spring. The torque of its `losses` in N m, against the twist, depends on
    ``twist_rate_<axis>``, on the twist and on states of the effect, whose energy is in `stored` of
    the contribution. Play lies outside of both: in a gap the twist rests.
    """

    axis: str
    energy: sp.Expr
    losses: sp.Expr


@dataclass(frozen=True)
class Switch:
    """Something that switches on at a threshold and off where it is no longer driven.

    Beyond plus or minus the `threshold` (positive) of the `deviation` it is on while `drive` has
    the sign of the deviation. It may be off beyond the threshold; back between, it is ready again.
    Equations read the modes `side(name)` (-1, 0 between, 1) and `active(name)` (1 on, 0 off).
    A slipping element of friction is one: its deflection reaches the most it can carry, and the
    rate drives it further. All three are of the state, continuous across the switch.
    """

    name: str
    deviation: sp.Expr
    threshold: sp.Expr
    drive: sp.Expr


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
    """A motor on `axis`: it turns `ratio` times as fast as the gear output does at its `rate`.

    Its winding takes a `voltage` in V at a `current`; of this the `resistance` in ohm turns `loss`
    in W to heat (the product of both and the current, unless something shares it). A rotor of
    inertia `rotor` in kg m^2 turns against `damping` in N m s/rad. The ratio may depend on the
    joint angle (a linkage); the inertia seen at the gear output then moves along with the joint.
    `inputs` replaces the torque input of the axis.
    """

    axis: str
    rate: sp.Symbol
    ratio: sp.Expr
    current: sp.Symbol
    voltage: sp.Expr
    inductance: sp.Expr
    resistance: sp.Expr
    loss: sp.Expr
    constant: sp.Expr
    rotor: sp.Expr
    damping: sp.Expr
    inputs: tuple[Input, ...]

    @property
    def speed(self) -> sp.Expr:
        """Rate of the rotor in rad/s."""
        return self.ratio * self.rate

    @property
    def back_emf(self) -> sp.Expr:
        """Voltage in V that the turning rotor induces."""
        return self.constant * self.speed

    @property
    def current_slope(self) -> sp.Expr:
        """Rate of change of the current in A/s."""
        drop = self.resistance * self.current + self.back_emf
        return (self.voltage - drop) / self.inductance

    @property
    def inertia(self) -> sp.Expr:
        """Inertia of the rotor in kg m^2, seen at the gear output."""
        return self.rotor * self.ratio**2

    @property
    def torque(self) -> sp.Expr:
        """Torque in N m at the gear output, before the rotor takes of it."""
        return self.ratio * (self.constant * self.current - self.damping * self.speed)

    @property
    def power_in(self) -> sp.Expr:
        """Electrical power in W."""
        return self.voltage * self.current

    @property
    def stored(self) -> sp.Expr:
        """Energy of the winding in J."""
        return self.inductance * self.current**2 / 2

    @property
    def dissipated(self) -> sp.Expr:
        """Power in W lost in winding and rotor."""
        return self.loss + self.damping * self.speed**2


@dataclass(frozen=True)
class Contribution:
    """Everything that an effect may add to the machine.

    `terms` are functions that the equations keep under their names, each of those before it.
    `potential` is an energy of the coordinates, whose gradient acts as torques; `stored` an energy
    of the effect's own states, which its `torques` charge and discharge; what else those take out
    is dissipated. Supplied is the `power_in` of drives alone: a torque that no input drives has a
    potential. `inertias` in kg m^2 turn with a rate. `delays` hold back the
    inputs of an axis. `prescribed` gives joint rates an acceleration as input, in place of the
    torque on the joint; `commands` gives an axis other inputs than those of its drive; `inputs` are
    those that drive no axis, such as a temperature. What a sensor shows is the quantity
    ``reading_<state>``, or ``reading_<name>`` of one of the `sensors`.
    """

    quantities: Mapping[str, sp.Expr] = field(default_factory=dict)
    changes: Mapping[str, Change] = field(default_factory=dict)
    terms: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)
    bodies: tuple[Body, ...] = ()
    potential: sp.Expr = ZERO
    stored: sp.Expr = ZERO
    torques: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)
    inertias: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)
    frictions: tuple[Friction, ...] = ()
    shafts: tuple[Shaft, ...] = ()
    plays: tuple[Play, ...] = ()
    switches: tuple[Switch, ...] = ()
    drives: tuple[Drive, ...] = ()
    states: tuple[State, ...] = ()
    samplers: tuple[Sampler, ...] = ()
    commands: Mapping[str, tuple[Input, ...]] = field(default_factory=dict)
    delays: Mapping[str, sp.Symbol] = field(default_factory=dict)
    limits: tuple[Limit, ...] = ()
    prescribed: Mapping[sp.Symbol, Input] = field(default_factory=dict)
    inputs: tuple[Input, ...] = ()
    sensors: tuple[Sensor, ...] = ()
