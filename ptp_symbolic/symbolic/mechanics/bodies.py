"""Rigid bodies, the rigid part of a machine, and its equations of motion, as plain data."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import sympy as sp

from ptp_symbolic.symbolic.mechanics import kinematics
from ptp_symbolic.symbolic.mechanics.kinematics import AXES

NO_SPIN = sp.ImmutableMatrix([0, 0, 0])


@dataclass(frozen=True)
class Body:
    """A rigid body carried by the pan or the tilt frame.

    `mass` in kg; `com` [3] in m from the origin of that frame; `inertia` [3, 3] in kg m^2 about the
    body's own centre of mass, a tensor (products with a minus sign); both in the carrying frame.
    """

    name: str
    frame: str
    mass: sp.Expr
    com: sp.ImmutableMatrix
    inertia: sp.ImmutableMatrix

    def __post_init__(self) -> None:
        if self.frame not in AXES:
            raise ValueError(f"Body '{self.name}': frame '{self.frame}'; choose from {AXES}.")
        if self.com.shape != (3, 1) or self.inertia.shape != (3, 3):
            raise ValueError(f"Body '{self.name}': com must be [3] and inertia [3, 3].")
        if self.inertia != self.inertia.T:
            raise ValueError(f"Body '{self.name}': the inertia tensor must be symmetric.")


@dataclass(frozen=True)
class RigidConfiguration:
    """The rigid part of a machine: its axes, the bodies they carry, gravity [3] in m/s^2.

    `gravity` is given in the base frame; a base that is not level tilts this vector. `axes` is
    ('pan', 'tilt'), ('pan',) or ('tilt',). `offsets` [3] in m are where the origins behind joints
    lie in the frames before them, in the origin unless given. Joints in `sliding` do not turn: the
    frame behind them moves along the x axis of the one before. A base that turns has the rate
    `base_spin` [3] in rad/s and the angular acceleration `base_spin_rate` [3] in rad/s^2, and
    `gravity` is less the acceleration of the origin; all in the base frame.
    """

    axes: tuple[str, ...]
    bodies: tuple[Body, ...]
    gravity: sp.ImmutableMatrix
    offsets: Mapping[str, sp.ImmutableMatrix] = field(default_factory=dict)
    sliding: tuple[str, ...] = ()
    base_spin: sp.ImmutableMatrix = NO_SPIN
    base_spin_rate: sp.ImmutableMatrix = NO_SPIN

    def offset(self, axis: str) -> sp.ImmutableMatrix:
        """Where [3] the origin behind the joint of `axis` lies in the frame before it, in m."""
        still = self.offsets.get(axis, sp.ImmutableMatrix([0, 0, 0]))
        return still + kinematics.ALONG * kinematics.angle(axis) if axis in self.sliding else still

    def rotation(self, axis: str) -> sp.ImmutableMatrix:
        """Rotation [3, 3] that turns vectors behind the joint of `axis` into the frame before."""
        if axis in self.sliding:
            return sp.ImmutableMatrix(sp.eye(3))
        return kinematics.joint_rotation(axis)

    def rotation_to_base(self, frame: str) -> sp.ImmutableMatrix:
        """Rotation [3, 3] that turns vectors of `frame` ('pan' or 'tilt') into the base frame."""
        rotation = sp.ImmutableMatrix(sp.eye(3))
        for axis in kinematics.joints_up_to(self.axes, frame):
            rotation = rotation * self.rotation(axis)
        return rotation

    def __post_init__(self) -> None:
        if not self.axes or self.axes != tuple(axis for axis in AXES if axis in self.axes):
            raise ValueError(f"Axes {self.axes}; choose one or both of {AXES}, in this order.")
        if self.gravity.shape != (3, 1):
            raise ValueError("Gravity must be a vector [3].")
        if self.sliding and self.base_spin != NO_SPIN:
            raise ValueError("A base that turns carries joints that turn, no sliding ones.")


@dataclass(frozen=True)
class RigidEquations:
    """Equations of motion M(q) q'' = f(q, q') + tau of n joints, and the energies behind them.

    `mass_matrix` [n, n] in kg m^2, `forcing` [n] in N m (Coriolis, centrifugal and gravity
    torques, without the joint torques tau), of sliding joints in kg and N; `kinetic` and
    `potential` in J, of the motion relative to the origin of the base, in axes that do not turn.
    """

    axes: tuple[str, ...]
    coordinates: tuple[sp.Symbol, ...]
    rates: tuple[sp.Symbol, ...]
    mass_matrix: sp.ImmutableMatrix
    forcing: sp.ImmutableMatrix
    kinetic: sp.Expr
    potential: sp.Expr
