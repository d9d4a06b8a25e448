"""The rigid equations along three routes, and their comparison."""

import sympy as sp

from ptp_symbolic.report.derivation.kinematics import (
    carried_motion,
    energy_steps,
    inward_steps,
    projected_steps,
)
from ptp_symbolic.report.latex_text import numbered, table
from ptp_symbolic.symbolic.derivation.equations import Equations
from ptp_symbolic.symbolic.derivation.kane import kane, kane_with_steps
from ptp_symbolic.symbolic.derivation.lagrange import lagrange, lagrange_rows
from ptp_symbolic.symbolic.derivation.newton_euler import newton_euler, newton_euler_steps
from ptp_symbolic.symbolic.derivation.proof import compare_numerically, prove_equal
from ptp_symbolic.symbolic.derivation.properties import energy_remainder, is_passive, is_symmetric
from ptp_symbolic.symbolic.derivation.trigonometry import normal_form
from ptp_symbolic.symbolic.documents.latex import latex_of
from ptp_symbolic.symbolic.mechanics.bodies import RigidEquations
from ptp_symbolic.symbolic.mechanics.kinematics import TIME
from ptp_symbolic.symbolic.symbols import real

ROUTES = (("Newton--Euler", newton_euler), ("Kane", kane), ("Lagrange", lagrange))


def three_routes(equations: Equations) -> str:
    """Section that compares the rigid equations of Newton-Euler, Kane and Lagrange."""
    derived = {name: route(equations.rigid) for name, route in ROUTES}
    reference = derived["Lagrange"]
    numbers = {real(p.name): float(p.default) or 0.01 for p in equations.parameters}
    numbers[TIME] = 1.0  # any instant of a base that shakes
    numbers |= {given.symbol: 0.5 for given in equations.inputs}  # any motion of the base
    at_rest = equations.rigid_at_rest
    moved = at_rest.forcing != equations.rigid_equations.forcing
    rows = []
    for name in ("Newton--Euler", "Kane"):
        proof = prove_equal(derived[name], reference)
        worst = compare_numerically(derived[name], reference, numbers, states=10_000, seed=1)
        left = "0" if proof.equal else "not 0"
        rows.append([f"{name} -- Lagrange", f"${left}$", f"${_power(worst)}$"])
    motions, loads = newton_euler_steps(equations.rigid)
    spins = zip(equations.rigid.base_spin, equations.rigid.base_spin_rate, strict=True)
    slopes = lagrange_rows(
        reference.coordinates,
        reference.rates,
        reference.kinetic,
        reference.potential,
        {spin: slope for spin, slope in spins if spin.is_Symbol},
    )
    text = "\n".join(
        [
            carried_motion(equations.rigid, motions),
            r"\section{Three routes to the rigid equations}",
            inward_steps(loads),
            projected_steps(equations.axes, kane_with_steps(equations.rigid)[1]),
            energy_steps(reference.kinetic, reference.potential, slopes),
            r"\subsection{The equations that all three reach}",
            _by_origin(reference, at_rest),
        ]
    )
    head = ["routes", "symbolic difference", "largest relative difference / cond"]
    claims = [
        f"The mass matrix is {'symmetric' if is_symmetric(reference) else 'not symmetric'}",
        f"$\\dot M - 2C$ is {'skew' if is_passive(at_rest) else 'not skew'}",
        f"the energy ledger of the rigid part{' on a base at rest' if moved else ''} leaves"
        f" ${latex_of(energy_remainder(at_rest))}$",
    ]
    return text + (
        "The routes are compared symbolically (mass matrix and forcing, every entry) and at"
        r" 10\,000 random states:"
        + table("lll", head, rows)
        + r"\par\noindent "
        + "; ".join(claims)
        + "."
    )


def _by_origin(found: RigidEquations, at_rest: RigidEquations) -> str:
    """Mass matrix and forcing of the rigid bodies, the terms sorted by where they come from; what
    the forcing on a base `at_rest` lacks is of the base.
    """
    n = len(found.rates)
    rows = [
        (rf"M_{{{i + 1},{j + 1}}}", found.mass_matrix[i, j]) for i in range(n) for j in range(i, n)
    ]
    still = dict.fromkeys(found.rates, 0)
    moved = found.forcing - at_rest.forcing
    for axis, forcing, base in zip(found.axes, at_rest.forcing, moved, strict=True):
        gravity = forcing.xreplace(still)
        squares = sum((sp.diff(forcing, w, 2) * w**2 / 2 for w in found.rates), sp.Integer(0))
        mixed = forcing - gravity - squares
        for origin, part in (
            ("centrifugal", squares),
            ("Coriolis", mixed),
            ("gravity", gravity),
            ("base", base),
        ):
            rest = normal_form(part)
            if rest != 0:
                rows.append((rf"h_{{\mathrm{{{axis},{origin}}}}}", rest))
    return (
        r"$M(q)\,\dot\omega = h(q,\omega) + \tau$, where $h$ is the sum of the parts below, by"
        r" where they come from: squares of one rate (centrifugal), products of two (Coriolis),"
        rf" {'gravity, and the motion of the base' if any(moved) else 'and gravity'}."
        " Entries of $M$ off the diagonal couple the axes."
        + numbered(rows)
        + (_without_payload(found) if _payload(found) else "")
    )


def _payload(found: RigidEquations) -> dict[sp.Symbol, int]:
    """The parameters of the payload among the symbols of `found`, all zero."""
    used = found.mass_matrix.free_symbols | found.forcing.free_symbols
    return {s: 0 for s in used if str(s).endswith("_payload")}


def _without_payload(found: RigidEquations) -> str:
    """What is left when mass, inertias and offsets of the payload go to zero."""
    zero = _payload(found)
    n = len(found.rates)
    rows = [
        (rf"M_{{{i + 1},{j + 1}}}", normal_form(found.mass_matrix[i, j].xreplace(zero)))
        for i in range(n)
        for j in range(i, n)
    ]
    rows += [
        (rf"h_{{\mathrm{{{axis}}}}}", normal_form(forcing.xreplace(zero)))
        for axis, forcing in zip(found.axes, found.forcing, strict=True)
    ]
    source = " (thesis Eq.~3.8)" if n > 1 and not found.mass_matrix.xreplace(zero)[0, 1] else ""
    return rf"\par Where the payload goes to zero{source}, this becomes" + numbered(rows)


def _power(value: float) -> str:
    if value == 0.0:
        return "0"
    mantissa, exponent = f"{value:.1e}".split("e")
    return rf"{mantissa}\cdot 10^{{{int(exponent)}}}"
