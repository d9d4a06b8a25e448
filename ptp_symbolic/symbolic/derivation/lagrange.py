"""Equations of motion by Lagrange's equations of the second kind.

The energies are written from the rotation matrices and their derivatives alone; no acceleration
and no constraint force is ever formed.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import sympy as sp

from ptp_symbolic.symbolic.derivation.trigonometry import normal_form
from ptp_symbolic.symbolic.mechanics import kinematics
from ptp_symbolic.symbolic.mechanics.bodies import Body, RigidConfiguration, RigidEquations
from ptp_symbolic.symbolic.symbols import real


@dataclass(frozen=True)
class LagrangeRow:
    """The terms of Lagrange's equation of one coordinate.

    `momentum` is dT/dq'; `transport` its rate of change at constant rates; `kinetic_slope` is
    dT/dq, `potential_slope` dV/dq.
    """

    coordinate: sp.Symbol
    rate: sp.Symbol
    momentum: sp.Expr
    transport: sp.Expr
    kinetic_slope: sp.Expr
    potential_slope: sp.Expr


def lagrange_rows(
    coordinates: tuple[sp.Symbol, ...],
    rates: tuple[sp.Symbol, ...],
    kinetic: sp.Expr,
    potential: sp.Expr,
    given: Mapping[sp.Symbol, sp.Expr] | None = None,
) -> list[LagrangeRow]:
    """Lagrange's equations of `kinetic` and `potential` in J, term by term; `given` are rates of
    change of what else the momenta depend on.
    """
    rows = []
    changing = {**dict(zip(coordinates, rates, strict=True)), **(given or {})}
    for coordinate, rate in zip(coordinates, rates, strict=True):
        momentum = sp.diff(kinetic, rate)
        transport = (sp.diff(momentum, q) * w for q, w in changing.items())
        slopes = (sp.diff(energy, coordinate) for energy in (kinetic, potential))
        rows.append(LagrangeRow(coordinate, rate, momentum, sp.Add(*transport), *slopes))
    return rows


def lagrange(configuration: RigidConfiguration) -> RigidEquations:
    """Return M q'' = f + tau of `configuration` by Lagrange's equations.

    The entries stay as the energies leave them, multiplied out but not reduced. Source: Goldstein,
    Poole and Safko, Classical Mechanics, 3rd edition 2002, Eq. 1.53.
    """
    spin, spin_rate = configuration.base_spin, configuration.base_spin_rate
    turning = sp.ImmutableMatrix([real(f"base_spin:{k}") if spin[k] != 0 else 0 for k in range(3)])
    given = {turning[k]: spin_rate[k] for k in range(3) if turning[k] != 0}
    put_in = {turning[k]: spin[k] for k in range(3) if turning[k] != 0}
    configuration = replace(configuration, base_spin=turning)
    coordinates = tuple(kinematics.angle(axis) for axis in configuration.axes)
    rates = tuple(kinematics.rate(axis) for axis in configuration.axes)
    energies = [_energies(body, configuration) for body in configuration.bodies]
    kinetic = sp.Add(*(kinetic for kinetic, _ in energies))
    potential = sp.Add(*(potential for _, potential in energies))
    mass_matrix = sp.hessian(kinetic, rates)
    rows = lagrange_rows(coordinates, rates, kinetic, potential, given)
    forcing = [
        sp.expand((row.kinetic_slope - row.potential_slope - row.transport).xreplace(put_in))
        for row in rows
    ]
    return RigidEquations(
        configuration.axes,
        coordinates,
        rates,
        sp.ImmutableMatrix(mass_matrix.applyfunc(sp.expand)),
        sp.ImmutableMatrix(forcing),
        kinetic.xreplace(put_in),
        potential,
    )


def _energies(body: Body, configuration: RigidConfiguration) -> tuple[sp.Expr, sp.Expr]:
    """Kinetic and potential energy of `body` in J; the potential is zero in the origin."""
    axes = configuration.axes
    rotation = configuration.rotation_to_base(body.frame)
    origin = _origin(configuration, body.frame)
    spin = sp.zeros(3, 3)
    for axis in axes:
        spin += rotation.T * rotation.diff(kinematics.angle(axis)) * kinematics.rate(axis)
    spin = spin.applyfunc(normal_form)
    base_spin = sp.Matrix(configuration.base_spin)
    angular = sp.Matrix([spin[2, 1], spin[0, 2], spin[1, 0]]) + rotation.T * base_spin
    carried = rotation.T * base_spin.cross(sp.Matrix(origin))
    for axis in axes:
        carried += rotation.T * origin.diff(kinematics.angle(axis)) * kinematics.rate(axis)
    velocity = carried.applyfunc(normal_form) + angular.cross(sp.Matrix(body.com))
    kinetic = body.mass * velocity.dot(velocity) + angular.dot(body.inertia * angular)
    potential = -body.mass * configuration.gravity.dot(origin + rotation * body.com)
    return sp.expand(kinetic / 2), sp.expand(potential)


def _origin(configuration: RigidConfiguration, frame: str) -> sp.Matrix:
    """Origin [3] of `frame` in the base frame in m."""
    rotation, origin = sp.eye(3), sp.zeros(3, 1)
    for axis in kinematics.joints_up_to(configuration.axes, frame):
        origin += rotation * configuration.offset(axis)
        rotation = rotation * configuration.rotation(axis)
    return origin
