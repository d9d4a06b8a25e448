"""Simplification in counted steps, and the base parameters."""

from ptp_symbolic.report.latex_text import escaped, numbered, table
from ptp_symbolic.symbolic.codegen.latex import symbol_latex
from ptp_symbolic.symbolic.derivation.equations import Equations
from ptp_symbolic.symbolic.simplify.steps import SimplifiedEquations, simplify_rigid


def simplified(equations: Equations) -> SimplifiedEquations:
    """The rigid equations of the machine, simplified step by step."""
    constant = equations.mass_matrix - equations.varying_inertia
    return simplify_rigid(equations.rigid_equations, constant, equations.forcing)


def simplification(found: SimplifiedEquations) -> str:
    """Section with the steps of the simplification and the base parameters."""
    rows = [
        [
            escaped(s.name),
            str(s.operations_before),
            str(s.operations_after),
            "yes" if s.proved else "no",
        ]
        for s in found.steps
    ]
    head = ["step", "operations before", "after", "proved"]
    parts = [r"\section{Simplification}", table("lrrl", head, rows)]
    base = [(symbol_latex(str(s)), e) for s, e in found.base_form.base_parameters if s != e]
    if base:
        parts.append(r"\par\noindent The base parameters are" + numbered(base))
    return "\n".join(parts)
