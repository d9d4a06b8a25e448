"""Simplification in counted steps, and the base parameters."""

from ptp_symbolic.report.latex_text import escaped, numbered, table
from ptp_symbolic.symbolic.codegen.latex import symbol_latex
from ptp_symbolic.symbolic.derivation.equations import Equations
from ptp_symbolic.symbolic.simplify.operations import operation_count, written_operations
from ptp_symbolic.symbolic.simplify.steps import SimplifiedEquations, simplify_rigid


def simplified(equations: Equations) -> SimplifiedEquations:
    """The rigid equations of the machine, simplified step by step."""
    constant = equations.mass_matrix - equations.varying_inertia
    return simplify_rigid(equations.rigid_equations, constant, equations.forcing)


def simplification(found: SimplifiedEquations, equations: Equations) -> str:
    """Section with the steps of the simplification, the base parameters, and what sharing saves in
    the whole machine.
    """
    base = [(symbol_latex(str(s)), e) for s, e in found.base_form.base_parameters if s != e]
    parts = [r"\section{Simplification}", _steps(found)]
    if base:
        parts.append(r"\par\noindent The base parameters are" + numbered(base))
    every = list(equations.expressions())
    written = sum(written_operations(e) for e in every)
    parts.append(
        r"\par\noindent All expressions of the machine, with its drives, friction and energies,"
        f" take {written} operations as they are written here, and {operation_count(every)} in the"
        " module, which computes once what appears twice; sines and cosines are not counted."
    )
    return "\n".join(parts)


def _steps(found: SimplifiedEquations) -> str:
    """The steps with their counts; one sentence where none changes anything."""
    counts = {n for s in found.steps for n in (s.operations_before, s.operations_after)}
    if len(counts) == 1:
        return (
            f"The rigid equations take {counts.pop()} operations as derived, and no step of the"
            " simplification makes them shorter."
        )
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
    return table("lrrl", head, rows)
