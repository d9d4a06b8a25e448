"""Explicit accelerations without inverting the mass matrix symbolically."""

import sympy as sp

from ptp_symbolic.symbolic.simplify.operations import Line
from ptp_symbolic.symbolic.symbols import real


def accelerations(mass_matrix: sp.MatrixBase, forcing: sp.MatrixBase) -> tuple[list[Line], list]:
    """Return named entries and the accelerations [n], in terms of them, of n = 1 or 2 joints.

    Two joints are solved by Cramer's rule with one division. Raises ValueError for more.
    """
    n = mass_matrix.rows
    if n > 2:
        raise ValueError(f"{n} coupled joints; this solver takes one or two.")
    mass = sp.Matrix(n, n, lambda i, j: real(f"mass_{min(i, j)}{max(i, j)}"))
    force = [real(f"force_{i}") for i in range(n)]
    inverse = real("inverse_determinant")
    lines = [(mass[i, j], mass_matrix[i, j]) for i in range(n) for j in range(i, n)]
    lines += zip(force, forcing, strict=True)
    if n == 1:
        return lines, [force[0] / mass[0, 0]]
    lines.append((inverse, 1 / (mass[0, 0] * mass[1, 1] - mass[0, 1] ** 2)))
    pan = (mass[1, 1] * force[0] - mass[0, 1] * force[1]) * inverse
    tilt = (mass[0, 0] * force[1] - mass[0, 1] * force[0]) * inverse
    return lines, [pan, tilt]
