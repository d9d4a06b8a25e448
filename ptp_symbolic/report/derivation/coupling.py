"""How the axes of a two-axis platform act on each other, and which distributions decouple them."""

import sympy as sp

from ptp_symbolic.report.latex_text import number_latex, numbered, table
from ptp_symbolic.symbolic.derivation.coupling import (
    ALWAYS,
    AT_SPEED,
    DISTRIBUTIONS,
    MassDistribution,
    conditions,
    coupling,
    distributed,
    distribution_of,
    linearity,
    strongest,
)
from ptp_symbolic.symbolic.derivation.equations import Equations
from ptp_symbolic.symbolic.derivation.trigonometry import normal_form
from ptp_symbolic.symbolic.documents.latex import latex_of

IN_WORDS = {ALWAYS: "at any speed", AT_SPEED: "in motion"}
AXES = 2


def coupled_axes(equations: Equations) -> str:
    """Section with what couples the axes, here and by distribution of mass; empty of one axis."""
    if len(equations.axes) != AXES:
        return ""
    values = {p.symbol: p.default for p in equations.parameters}
    found = conditions(equations.rigid_at_rest)
    numbers = [float(c.expression.xreplace(values)) for c in found]
    kind = strongest(c.kind for c, n in zip(found, numbers, strict=True) if n)
    own = distribution_of(equations.rigid, values)
    rows = [
        [f"${_name(k)}$", f"${number_latex(n)}$", IN_WORDS[c.kind] if n else "not here"]
        for k, (c, n) in enumerate(zip(found, numbers, strict=True), start=1)
    ]
    return "\n".join(
        [
            r"\section{Coupling of the axes}The axes act on each other through $M_{1,2}$, and where"
            r" $h$ of one depends on angle or rate of the other. Both are sums of different"
            r" functions of angles and rates. The axes are uncoupled where the coefficients of all"
            r" of them vanish, which are, up to a number,",
            numbered([(_name(k), c.expression) for k, c in enumerate(found, start=1)]),
            "With the values of this platform:",
            table("lrl", ["", "in SI units", "couples"], rows),
            rf"\par The axes of this platform are {kind}. All that tilts here is {own.name}. The"
            r" table has the other distributions of mass of thesis Table~2.2, derived anew with one"
            r" body of mass $m$, centre of mass $c$ and inertia $J$ about it as all that tilts;"
            r" base and axes are those of this platform. A machine is linear where $M$ is constant"
            r" and $h$ linear. Symmetric means that the principal axes lie along the joints,"
            r" completely so with $J_{\mathrm{x}}=J_{\mathrm{z}}$ too; balanced, that the centre of"
            r" mass is where the tilt axis meets the pan frame's $x$ axis.",
            table(
                "L{50mm}lL{40mm}L{50mm}",
                ["mass that tilts", "", "axes", "$M_{1,2}$"],
                [_row(equations, d, kind if d == own else "") for d in DISTRIBUTIONS],
            ),
        ]
    )


def _row(equations: Equations, mass: MassDistribution, own: str) -> list[str]:
    """A distribution of mass; of the one here with its `own` kind of coupling, by its numbers."""
    found = distributed(equations.bodies_at_rest, mass)
    name = rf"\textbf{{{mass.name}}} (here)" if own else mass.name
    entry = sp.collect(normal_form(found.mass_matrix[0, 1]), _functions(found.mass_matrix[0, 1]))
    coupled = coupling(found)
    if own and own != coupled:
        coupled += rf"\newline (with these numbers {own})"
    return [name, linearity(found), coupled, f"${latex_of(entry)}$"]


def _functions(expression: sp.Expr) -> list[sp.Expr]:
    return sorted(expression.atoms(sp.sin, sp.cos), key=sp.default_sort_key)


def _name(number: int) -> str:
    return rf"k_{{{number}}}"
