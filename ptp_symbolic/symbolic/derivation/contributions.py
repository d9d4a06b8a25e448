"""What the placed effects contribute, flattened, with every named quantity resolved."""

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from graphlib import CycleError, TopologicalSorter

import sympy as sp

from ptp_symbolic.errors import InputError
from ptp_symbolic.symbolic.derivation.differentiation import derivative
from ptp_symbolic.symbolic.effect_interface.contribution import (
    Contribution,
    Drive,
    Friction,
    Input,
    Play,
    Sensor,
    Shaft,
    Switch,
)
from ptp_symbolic.symbolic.effect_interface.effect import Effect
from ptp_symbolic.symbolic.effect_interface.linear import linear_sensor
from ptp_symbolic.symbolic.effect_interface.place import Place, quantity_name
from ptp_symbolic.symbolic.effect_interface.place import quantity as quantity_symbol
from ptp_symbolic.symbolic.mechanics import kinematics
from ptp_symbolic.symbolic.symbols import ZERO, real

GRAVITY_QUANTITIES = ("gravity_tilt", "gravity_azimuth")
BASE_ACCELERATION = tuple(f"base_acceleration_{k}" for k in "xyz")
GRAVITY_SHARE = "gravity_share"  # 0 where what is measured on the base has gravity in it
BASE_SPIN = tuple(f"base_spin_{k}" for k in "xyz")
BASE_SPIN_RATE = tuple(f"base_spin_rate_{k}" for k in "xyz")
AXIS_OFFSET = "tilt_axis_offset"  # of the tilt axis from the pan axis, along x, in m
PLATFORM_QUANTITIES = (
    *GRAVITY_QUANTITIES,
    GRAVITY_SHARE,
    *BASE_ACCELERATION,
    *BASE_SPIN,
    *BASE_SPIN_RATE,
)
OFF_AXIS_MASS = "off_axis_mass"  # on which gravity and an accelerated base act
TORQUES = ("input_torque_{axis}", "command_torque_{axis}")  # each from the next, then the input


@dataclass(frozen=True)
class Contributions:
    """Contributions of all effects, values of quantities, and the sensors that are read."""

    by_effect: tuple[Contribution, ...]
    values: Mapping[sp.Symbol, sp.Expr]
    sensors: tuple[Sensor, ...] = ()

    def resolve(self, expression: sp.Expr) -> sp.Expr:
        """Replace quantity placeholders, also inside other quantities."""
        while True:
            present = expression.free_symbols & self.values.keys()
            if not present:
                return expression
            expression = expression.subs({symbol: self.values[symbol] for symbol in present})

    @property
    def terms(self) -> dict[sp.Symbol, sp.Expr]:
        """Named functions of all effects, each followed by its slopes in the angles."""
        found: dict[sp.Symbol, sp.Expr] = {}
        for contribution in self.by_effect:
            for symbol, term in contribution.terms.items():
                found[symbol] = self.resolve(term)
                found.update(_slopes(symbol, found))
        return found

    @property
    def frictions(self) -> list[Friction]:
        """Set-valued frictions of all effects."""
        return [f for c in self.by_effect for f in c.frictions]

    @property
    def shafts(self) -> list[Shaft]:
        """Shafts of all effects."""
        return [s for c in self.by_effect for s in c.shafts]

    @property
    def switches(self) -> list[Switch]:
        """Switches of all effects."""
        return [s for c in self.by_effect for s in c.switches]

    @property
    def plays(self) -> list[Play]:
        """Gaps between rigid bodies of all effects."""
        return [p for c in self.by_effect for p in c.plays]

    @property
    def split_axes(self) -> list[str]:
        """Axes whose gear output has a coordinate of its own."""
        found = [shaft.axis for shaft in self.shafts]
        return found + [p.axis for p in self.plays if p.axis not in found]

    @property
    def drives(self) -> list[Drive]:
        """Drives of all effects."""
        return [d for c in self.by_effect for d in c.drives]

    @property
    def prescribed(self) -> dict[sp.Symbol, Input]:
        """Acceleration inputs of joint rates whose motion is prescribed."""
        return {rate: i for c in self.by_effect for rate, i in c.prescribed.items()}

    def input_torque(self, axis: str) -> sp.Expr:
        """Torque in N m that the input of `axis` exerts; zero where it takes none."""
        return self.resolve(self.values.get(quantity_symbol(TORQUES[0].format(axis=axis)), ZERO))

    def drive_rate(self, axis: str) -> sp.Symbol:
        """The rate that a drive of `axis` works on, or its torque input: of the gear output if it
        has its own, else of the joint.
        """
        if axis in self.split_axes:
            return kinematics.gear_rate(axis)
        return kinematics.rate(axis)

    def inertia_on(self, rate: sp.Symbol) -> sp.Expr:
        """Inertia in kg m^2 that effects put on a rate, apart from drives."""
        own = (c.inertias.get(rate, ZERO) for c in self.by_effect)
        return self.resolve(sum(own, ZERO))


def _slopes(term: sp.Symbol, found: Mapping[sp.Symbol, sp.Expr]) -> dict[sp.Symbol, sp.Expr]:
    """Derivatives of `term` by the angles, also by way of the functions in it."""
    slopes: dict[sp.Symbol, sp.Expr] = {}
    for angle in (q(a) for q in (kinematics.angle, kinematics.gear_angle) for a in kinematics.AXES):
        slope = derivative(found[term], angle)
        for inner in sorted(found[term].free_symbols & found.keys(), key=str):
            if slope_symbol(inner, angle) in found:
                slope += derivative(found[term], inner) * slope_symbol(inner, angle)
        if slope != 0:
            slopes[slope_symbol(term, angle)] = slope
    return slopes


def slope_symbol(term: sp.Symbol, variable: sp.Symbol) -> sp.Symbol:
    """Name of the derivative of the named function `term` by `variable`."""
    return real(f"{term}_by_{variable}")


def sensors_on(
    axes: Iterable[str], contributions: Sequence[Contribution], linear: Collection[str] = ()
) -> list[Sensor]:
    """The sensors that a machine may have: rates of its joints, torques of its shafts (forces of
    `linear` ones), rates of its bodies in their own axes (thesis Eq. 3.1), and those of its
    effects.
    """
    rates = [
        (
            axis,
            Sensor(
                str(kinematics.rate(axis)),
                "rad/s",
                f"rate of the {axis} joint, by a gyro or tachometer",
                kinematics.rate(axis),
            ),
        )
        for axis in axes
    ]
    torques = [
        (
            shaft.axis,
            Sensor(
                f"tau_shaft_{shaft.axis}",
                "N m",
                f"torque in the {shaft.axis} shaft",
                quantity_symbol(f"torque_in_shaft_{shaft.axis}"),
            ),
        )
        for contribution in contributions
        for shaft in contribution.shafts
    ]
    own = [linear_sensor(s) if axis in linear else s for axis, s in (*rates, *torques)]
    gyros = [
        Sensor(
            f"omega_{k}_{axis}",
            "rad/s",
            f"rate of the {axis} body about its {k} axis, by a gyro",
            quantity_symbol(f"spin_{k}_{axis}"),
        )
        for axis in axes
        if axis not in linear
        for k in "xyz"
    ]
    return [*own, *gyros, *(s for c in contributions for s in c.sensors)]


def collect(
    axes: Iterable[str], placed: Iterable[tuple[Effect, Place]], measured: Collection[str] = ()
) -> Contributions:
    """Let every placed effect contribute, and apply all changes to the quantities.

    Of the sensors that the machine may have those named in `measured` are read.

    Raises InputError where two effects define one quantity; ValueError for an effect that changes
    one which nothing defines, and where one refers to itself.
    """
    placed, axes = list(placed), tuple(axes)
    contributions = tuple(effect.contribution_at(place) for effect, place in placed)
    linear = {str(place.axis) for _, place in placed if place.linear}
    sensors = tuple(s for s in sensors_on(axes, contributions, linear) if s.name in measured)
    values: dict[str, sp.Expr] = {name: ZERO for name in PLATFORM_QUANTITIES}
    values[GRAVITY_SHARE] = sp.Integer(1)
    values |= input_torques(axes, contributions)
    for axis in axes:
        values[f"transmitted_torque_{axis}"] = _transmitted(axis, contributions)
        values[f"transmission_error_{axis}"] = ZERO
        values[f"motor_lead_{axis}"] = sp.Integer(1)  # rate over that before a gear that runs true
        values[f"reading_{kinematics.angle(axis)}"] = kinematics.angle(axis)
    for word in ("reading", "measured"):
        values.update({f"{word}_{sensor.name}": sensor.value for sensor in sensors})
    _refuse_second_definitions(placed, contributions)
    for contribution in contributions:
        values.update(contribution.quantities)
        for word in ("reading", "measured"):
            values.update({f"{word}_{s.name}": s.symbol for s in contribution.states})
    changes = [item for c in contributions for item in c.changes.items()]
    _refuse_changes_of_nothing(placed, contributions, values)
    for name, change in changes:
        values[name] = values[name] * change.factor
    for name, change in changes:
        values[name] = values[name] + change.addition
    for name, change in changes:
        values[name] = change.through(values[name])
    symbols = {quantity_symbol(name): value for name, value in values.items()}
    _refuse_circles(symbols)
    return Contributions(contributions, symbols, sensors)


def _refuse_second_definitions(
    placed: Iterable[tuple[Effect, Place]], contributions: Iterable[Contribution]
) -> None:
    owners: dict[str, str] = {}
    for (effect, _), contribution in zip(placed, contributions, strict=True):
        for name in contribution.quantities:
            other = owners.setdefault(name, effect.id)
            if other != effect.id:
                raise InputError(
                    f"Effects '{other}' and '{effect.id}' both define '{name}'; declare one of"
                    " them."
                )


def _refuse_changes_of_nothing(
    placed: Iterable[tuple[Effect, Place]],
    contributions: Iterable[Contribution],
    values: Mapping[str, sp.Expr],
) -> None:
    for (effect, _), contribution in zip(placed, contributions, strict=True):
        for name in contribution.changes:
            if name not in values:
                raise ValueError(
                    f"Effect '{effect.id}' changes '{name}', which nothing defines: name it in"
                    " the effect's `needs`."
                )


def _refuse_circles(values: Mapping[sp.Symbol, sp.Expr]) -> None:
    """Raise ValueError where a quantity refers to itself, directly or by way of others."""
    graph = {symbol: value.free_symbols & values.keys() for symbol, value in values.items()}
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as error:
        names = " -> ".join(quantity_name(symbol) for symbol in error.args[1])
        raise ValueError(f"A quantity refers to itself: {names}; break the circle.") from error


def _transmitted(axis: str, contributions: Iterable[Contribution]) -> sp.Expr:
    """Torque that reaches the joint: of its shaft, else of its drive, else the torque input."""
    contributions = list(contributions)
    shafts = {shaft.axis for c in contributions for shaft in c.shafts}
    if axis in shafts | {play.axis for c in contributions for play in c.plays}:
        return quantity_symbol(f"shaft_torque_{axis}")
    for contribution in contributions:
        for drive in contribution.drives:
            if drive.axis == axis:
                return drive.torque
    return quantity_symbol(TORQUES[0].format(axis=axis))


def machine_quantities(axes: Iterable[str], contributions: Sequence[Contribution]) -> set[str]:
    """Names of the quantities on the axes that are there whatever effect defines others: torque
    inputs, torques that reach a joint (but by its prescribed motion, or rigid backlash), the
    errors of gears (of a shaft that may have play, or of a motor without a shaft), and whether a
    mass lies off the axes.
    """
    axes = tuple(axes)
    found = set(input_torques(axes, contributions))
    found |= {OFF_AXIS_MASS} if _has_off_axis_mass(contributions) else set()
    prescribed = {kinematics.place_of(rate) for c in contributions for rate in c.prescribed}
    loose = {play.axis for c in contributions for play in c.plays}
    found |= {f"transmitted_torque_{a}" for a in axes if a not in prescribed | loose}
    true = {axis for axis in axes for c in contributions if f"half_gap_{axis}" in c.quantities}
    split = loose | {shaft.axis for c in contributions for shaft in c.shafts}
    true |= {drive.axis for c in contributions for drive in c.drives} - split
    return found | {f"transmission_error_{axis}" for axis in true}


def _has_off_axis_mass(contributions: Sequence[Contribution]) -> bool:
    """Whether a body has a mass, and its centre or its frame lies off an axis."""
    changed = {name for c in contributions for name in c.changes}
    defined = {name: v for c in contributions for name, v in c.quantities.items()}
    zero = {quantity_symbol(n): ZERO for n, v in defined.items() if v == 0 and n not in changed}
    apart = AXIS_OFFSET in defined and quantity_symbol(AXIS_OFFSET) not in zero
    return any(
        body.mass.xreplace(zero) != 0
        and (any(body.com.xreplace(zero)) or (apart and body.frame == "tilt"))
        for contribution in contributions
        for body in contribution.bodies
    )


def input_torques(axes: Iterable[str], contributions: Sequence[Contribution]) -> dict[str, sp.Expr]:
    """The quantities of the torque inputs: of the joints without a drive or a prescribed motion."""
    driven = {drive.axis for c in contributions for drive in c.drives}
    driven |= {kinematics.place_of(rate) for c in contributions for rate in c.prescribed}
    found: dict[str, sp.Expr] = {}
    for axis in axes:
        if axis not in driven:
            acting, command = (name.format(axis=axis) for name in TORQUES)
            found |= {acting: quantity_symbol(command), command: kinematics.torque(axis)}
    return found
