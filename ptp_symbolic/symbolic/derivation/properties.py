"""Laws that every set of rigid equations must obey, as symbolic identities."""

from collections.abc import Mapping

import numpy as np
import sympy as sp

from ptp_symbolic.symbolic.derivation.trigonometry import normal_form
from ptp_symbolic.symbolic.mechanics.bodies import RigidEquations


def is_symmetric(equations: RigidEquations) -> bool:
    """True when the mass matrix equals its transpose."""
    difference = equations.mass_matrix - equations.mass_matrix.T
    return all(normal_form(entry) == 0 for entry in difference)


def coriolis_matrix(equations: RigidEquations) -> sp.ImmutableMatrix:
    """Matrix C [n, n] in kg m^2/s of Christoffel symbols: C q' are the Coriolis torques.

    Source: Murray, Li and Sastry, A Mathematical Introduction to Robotic Manipulation, 1994,
    Eq. 4.23.
    """
    mass, coordinates = equations.mass_matrix, equations.coordinates

    def entry(i: int, j: int) -> sp.Expr:
        symbols = (
            (mass[i, j].diff(q) + mass[i, k].diff(coordinates[j]) - mass[k, j].diff(coordinates[i]))
            * equations.rates[k]
            / 2
            for k, q in enumerate(coordinates)
        )
        return sp.Add(*symbols)

    n = len(coordinates)
    return sp.ImmutableMatrix(n, n, entry)


def is_passive(equations: RigidEquations) -> bool:
    """True when M' - 2C is skew and the forcing is -C q' less the slope of the potential.

    The Coriolis torques then do no work. Source: Murray, Li and Sastry 1994, Lemma 4.2.
    """
    coriolis = coriolis_matrix(equations)
    moving = list(zip(equations.coordinates, equations.rates, strict=True))
    mass_rate = sum((equations.mass_matrix.diff(q) * w for q, w in moving), 0 * coriolis)
    skew = mass_rate - 2 * coriolis
    torques = coriolis * sp.Matrix(equations.rates) + equations.forcing
    slopes = sp.Matrix([equations.potential.diff(q) for q in equations.coordinates])
    remainders = [*(skew + skew.T), *(torques + slopes)]
    return all(normal_form(remainder) == 0 for remainder in remainders)


def energy_remainder(equations: RigidEquations) -> sp.Expr:
    """Return d(T + V)/dt - tau q' in W in normal form: zero when the energy ledger closes.

    The accelerations are eliminated by M q'' = f + tau without inverting M, which needs the
    momenta dT/dq' to equal M q'; where they do not, their difference is returned in kg m^2/s.
    """
    rates = sp.Matrix(equations.rates)
    momenta = sp.Matrix([equations.kinetic.diff(rate) for rate in equations.rates])
    for difference in momenta - equations.mass_matrix * rates:
        remainder = normal_form(difference)
        if remainder != 0:
            return remainder
    energy = equations.kinetic + equations.potential
    slopes = sp.Matrix([energy.diff(coordinate) for coordinate in equations.coordinates])
    return normal_form((slopes + equations.forcing).dot(rates))


def smallest_eigenvalue(
    equations: RigidEquations, parameters: Mapping[sp.Symbol, float], angles: np.ndarray
) -> np.ndarray:
    """Smallest eigenvalue [k] of the mass matrix over its largest, at `angles` [k, n] in rad.

    Positive for every physically possible set of `parameters` (SI units).
    """
    arguments = [*equations.coordinates, *parameters]
    function = sp.lambdify(arguments, list(equations.mass_matrix), modules="numpy", cse=True)
    entries = function(*np.asarray(angles, dtype=float).T, *parameters.values())
    count, n = np.shape(angles)
    table = np.array([np.broadcast_to(entry, (count,)) for entry in entries], dtype=float).T
    eigenvalues = np.linalg.eigvalsh(table.reshape(count, n, n))
    return eigenvalues[:, 0] / eigenvalues[:, -1]
