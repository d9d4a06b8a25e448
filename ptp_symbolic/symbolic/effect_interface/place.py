"""Where an effect sits, and the symbols that it finds there."""

from collections.abc import Iterable
from dataclasses import dataclass

import sympy as sp

from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.mechanics import kinematics
from ptp_symbolic.symbolic.symbols import real

QUANTITY = "quantity:"  # before the names of placeholders, which no parameter has
LOADS = ("driving_torque", "load_torque", "load_inertia")


@dataclass(frozen=True)
class Place:
    """Where an effect sits: axes of the machine, its own axis and site, axes with a shaft, and
    whether the joint is a linear one, and whether the base turns.
    """

    axes: tuple[str, ...]
    axis: str | None
    site: str | None
    shafts: frozenset[str]
    linear: bool = False
    base_turns: bool = False

    def symbols(self, parameters: Iterable[Parameter]) -> tuple[sp.Symbol, ...]:
        """Symbols of `parameters` of the effect, the name of its axis filled in."""
        return tuple(p.at_axis(self.axis).symbol for p in parameters)

    def parameter(self, template: str) -> sp.Symbol:
        """Symbol of the effect's parameter, e.g. ``k_shaft_{axis}``."""
        return real(template.format(axis=self.axis))

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
    def friction_rate(self) -> sp.Symbol:
        """Rate on which friction acts: of the joint where its site says so, else of the gear."""
        return self.rate if self.site == "joint" else self.gear_rate

    @property
    def twist(self) -> sp.Symbol:
        """Twist in rad of the shaft on the effect's axis, beyond the gap where it has play."""
        return self.quantity("twist_{axis}")

    @property
    def twist_rate(self) -> sp.Symbol:
        """Rate of that twist in rad/s; zero while the shaft crosses a gap."""
        return self.quantity("twist_rate_{axis}")

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
    return real(f"{QUANTITY}{name}")


def quantity_name(symbol: sp.Symbol) -> str:
    """The name of the quantity whose placeholder `symbol` is."""
    return symbol.name.removeprefix(QUANTITY)


def slide(axis: str) -> sp.Symbol:
    """Mode of the friction on `axis`: the direction of sliding (-1, 0 at rest, 1)."""
    return real(f"slide_{axis}")


def side(name: str) -> sp.Symbol:
    """Mode of the contact or switch `name`: the threshold it is beyond (-1, 0 between, 1)."""
    return real(f"side_{name}")


def active(name: str) -> sp.Symbol:
    """Mode of the contact or switch `name`: whether it is on (1), or off (0)."""
    return real(f"active_{name}")
