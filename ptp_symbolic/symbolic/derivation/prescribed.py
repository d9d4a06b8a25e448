"""Joints that follow a given acceleration: their rows, and the torques that their motion takes."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import sympy as sp

from ptp_symbolic.errors import InputError
from ptp_symbolic.symbolic.derivation.contributions import Contributions
from ptp_symbolic.symbolic.derivation.friction import Mechanics
from ptp_symbolic.symbolic.effect_interface.contribution import Friction, Input
from ptp_symbolic.symbolic.effect_interface.place import slide
from ptp_symbolic.symbolic.mechanics import kinematics
from ptp_symbolic.symbolic.mechanics.bodies import RigidEquations
from ptp_symbolic.symbolic.symbols import ZERO


def released(contributions: Contributions) -> Contributions:
    """`contributions` without the dry friction of prescribed joints, which the motion overcomes.

    Raises InputError where a motor or a shaft works on such a joint.
    """
    rates = contributions.prescribed
    axes = [kinematics.place_of(rate) for rate in rates]
    busy = {drive.axis for drive in contributions.drives} | set(contributions.split_axes)
    for axis in axes:
        if axis in busy:
            raise InputError(
                f"The motion of axis '{axis}' is prescribed, and a motor or a shaft works on it;"
                " remove prescribed_motion, or motor and shaft."
            )
    kept = tuple(
        replace(c, frictions=tuple(f for f in c.frictions if f.rate not in rates))
        for c in contributions.by_effect
    )
    still = {slide(axis): ZERO for axis in axes}
    return replace(contributions, by_effect=kept, values={**contributions.values, **still})


def reduced(
    mechanics: Mechanics, rigid: RigidEquations, inputs: Mapping[sp.Symbol, Input]
) -> tuple[Mechanics, RigidEquations]:
    """Give prescribed joints the rows ``rate' = input``; what they do to others joins the forcing.

    The rigid equations lose their rows too; their energies stay.
    """
    mass, forcing = sp.Matrix(mechanics.mass), sp.Matrix(mechanics.forcing)
    rigid_mass, rigid_forcing = sp.Matrix(rigid.mass_matrix), sp.Matrix(rigid.forcing)
    for rate, given in inputs.items():
        row, acceleration = mechanics.rates.index(rate), given.symbol
        for other in range(mass.rows):
            forcing[other] -= mass[other, row] * acceleration
        forcing[row] = acceleration
        rigid_forcing[row] = ZERO
        for matrix, own in ((mass, sp.Integer(1)), (rigid_mass, ZERO)):
            matrix[row, :] = sp.zeros(1, matrix.cols)
            matrix[:, row] = sp.zeros(matrix.rows, 1)
            matrix[row, row] = own
    return (
        replace(mechanics, mass=mass.as_immutable(), forcing=forcing.as_immutable()),
        replace(rigid, mass_matrix=rigid_mass.as_immutable(), forcing=rigid_forcing.as_immutable()),
    )


def constraint_torques(
    full: Mechanics,
    free: Mechanics,
    frictions: Sequence[Friction],
    inputs: Mapping[sp.Symbol, Input],
) -> dict[sp.Symbol, sp.Expr]:
    """Torques in N m that the prescribed motion takes, by the rates of its joints."""
    by_rate = {f.rate: f for f in frictions}
    accelerations = []
    for row, rate in enumerate(full.rates):
        acceleration = free.forcing[row] / free.mass[row, row]
        if rate in by_rate:
            direction = slide(by_rate[rate].axis)
            friction = direction * by_rate[rate].level / free.mass[row, row]
            acceleration = direction**2 * (acceleration - friction)
        accelerations.append(acceleration)
    torques = full.mass * sp.Matrix(accelerations) - full.forcing
    return {rate: torques[full.rates.index(rate)] for rate in inputs}
