"""Accelerations from M a = f without inverting M symbolically.

A joint by itself is divided by its inertia; two coupled ones are solved by Cramer's rule with one
division. What is proved and what is emitted is solved here.
"""

from collections.abc import Sequence

import sympy as sp

from ptp_symbolic.symbolic.simplify.operations import Line
from ptp_symbolic.symbolic.symbols import real


def partner_of(mass: sp.MatrixBase, row: int) -> int:
    """The row that `mass` [n, n] couples with `row`, or that itself; ValueError for more."""
    others = [j for j in range(mass.rows) if j != row and mass[row, j] != 0]
    if len(others) > 1:
        raise ValueError(f"{len(others) + 1} coupled joints; this solver takes one or two.")
    return others[0] if others else row


def inverse_values(
    mass: sp.MatrixBase, inertias: Sequence[sp.Expr], free: Sequence[sp.Expr]
) -> list[sp.Expr]:
    """Per row 1 / inertia, or 1 / determinant of the pair that it belongs to.

    `inertias` [n] stand on the diagonal of `mass` [n, n]; `free` [n] is 0 where a row is locked.
    """
    values = []
    for row, inertia in enumerate(inertias):
        partner, divisor = partner_of(mass, row), inertia
        if partner != row:
            coupling = mass[row, partner] * free[row] * free[partner]
            divisor = inertia * inertias[partner] - coupling**2
        values.append(1 / divisor)
    return values


def solved(
    mass: sp.MatrixBase,
    inertias: Sequence[sp.Expr],
    free: Sequence[sp.Expr],
    inverses: Sequence[sp.Expr],
    right: Sequence[sp.Expr],
) -> list[sp.Expr]:
    """Return a [n] in M a = `right` [n]; `inverses` stand for `inverse_values`."""
    result = []
    for row, inverse in enumerate(inverses):
        partner, top = partner_of(mass, row), right[row]
        if partner != row:
            coupling = mass[row, partner] * free[row] * free[partner]
            top = inertias[partner] * right[row] - coupling * right[partner]
        result.append(free[row] * top * inverse)
    return result


def accelerations(
    mass_matrix: sp.MatrixBase, forcing: sp.MatrixBase
) -> tuple[list[Line], list[sp.Expr]]:
    """Return named entries and the accelerations [n], in terms of them, of n = 1 or 2 joints."""
    n = mass_matrix.rows
    mass, lines = sp.zeros(n, n), []
    for i in range(n):
        for j in range(i, n):
            if mass_matrix[i, j] != 0:
                mass[i, j] = mass[j, i] = real(f"mass_{i}{j}")
                lines.append((mass[i, j], mass_matrix[i, j]))
    force = [real(f"force_{i}") for i in range(n)]
    lines += zip(force, forcing, strict=True)
    inertias, free = mass.diagonal(), [sp.Integer(1)] * n
    inverses = []
    for row, value in enumerate(inverse_values(mass, inertias, free)):
        inverses.append(real(f"inverse_{min(row, partner_of(mass, row))}"))
        if partner_of(mass, row) >= row:
            lines.append((inverses[row], value))
    return lines, solved(mass, inertias, free, inverses, force)
