"""The rigid equations along three routes, and their comparison."""

import sympy as sp

from ptp_symbolic.report.latex_text import numbered, table
from ptp_symbolic.symbolic.codegen.latex import latex_of
from ptp_symbolic.symbolic.derivation.equations import Equations
from ptp_symbolic.symbolic.derivation.kane import kane
from ptp_symbolic.symbolic.derivation.lagrange import lagrange
from ptp_symbolic.symbolic.derivation.newton_euler import newton_euler
from ptp_symbolic.symbolic.derivation.proof import compare_numerically, prove_equal
from ptp_symbolic.symbolic.derivation.properties import energy_remainder, is_passive, is_symmetric
from ptp_symbolic.symbolic.symbols import real

ROUTES = (("Newton--Euler", newton_euler), ("Kane", kane), ("Lagrange", lagrange))


def three_routes(equations: Equations) -> str:
    """Section that compares the rigid equations of Newton-Euler, Kane and Lagrange."""
    derived = {name: route(equations.rigid) for name, route in ROUTES}
    reference = derived["Lagrange"]
    numbers = {real(p.name): float(p.default) or 0.01 for p in equations.parameters}
    rows = []
    for name in ("Newton--Euler", "Kane"):
        proof = prove_equal(derived[name], reference)
        worst = compare_numerically(derived[name], reference, numbers, states=10_000, seed=1)
        left = "0" if proof.equal else "not 0"
        rows.append([f"{name} -- Lagrange", f"${left}$", f"${_power(worst)}$"])
    sliding = equations.rigid.sliding
    joints = "force is that along it" if sliding else "torques are the moments about the axes"
    text = (
        r"""\section{Three routes to the rigid equations}
\emph{Newton--Euler}: rates and accelerations of every body are carried outward along the axes,
forces and moments inward; the joint """
        + joints
        + r""". \emph{Kane}: partial
velocities of every body project its inertia and gravity forces. \emph{Lagrange}: kinetic and
potential energy give
"""
        + numbered([("T", sp.expand(reference.kinetic)), ("V", reference.potential)])
    )
    head = ["routes", "symbolic difference", "largest relative difference / cond"]
    claims = [
        f"The mass matrix is {'symmetric' if is_symmetric(reference) else 'not symmetric'}",
        f"$\\dot M - 2C$ is {'skew' if is_passive(reference) else 'not skew'}",
        f"the energy ledger of the rigid part leaves ${latex_of(energy_remainder(reference))}$",
    ]
    return text + (
        "The routes are compared symbolically (mass matrix and forcing, every entry) and at"
        r" 10\,000 random states:"
        + table("lll", head, rows)
        + r"\par\noindent "
        + "; ".join(claims)
        + "."
    )


def _power(value: float) -> str:
    if value == 0.0:
        return "0"
    mantissa, exponent = f"{value:.1e}".split("e")
    return rf"{mantissa}\cdot 10^{{{int(exponent)}}}"
