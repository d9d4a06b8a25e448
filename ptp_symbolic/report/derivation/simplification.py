"""Simplification in counted steps, and the base parameters."""

import sympy as sp

from ptp_symbolic.report.latex_text import escaped, formulas, numbered, table
from ptp_symbolic.symbolic.derivation.equations import Equations
from ptp_symbolic.symbolic.documents.latex import symbol_latex
from ptp_symbolic.symbolic.simplify.operations import operation_count, written_operations
from ptp_symbolic.symbolic.simplify.steps import ENTRY_STEPS, SimplifiedEquations, simplify_rigid


def simplified(equations: Equations) -> SimplifiedEquations:
    """The rigid equations of the machine, simplified step by step."""
    constant = equations.mass_matrix - equations.varying_inertia
    return simplify_rigid(equations.rigid_at_rest, constant, equations.forcing)


def simplification(found: SimplifiedEquations, equations: Equations) -> str:
    """Section with the steps of the simplification, the base parameters, and what sharing saves in
    the whole machine.
    """
    base = [(symbol_latex(str(s)), e) for s, e in found.base_form.base_parameters if s != e]
    parts = [r"\section{Simplification}", _steps(found), _one_entry(equations)]
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


def _one_entry(equations: Equations) -> str:
    """The steps shown on the entry of the mass matrix that they shorten most; empty where none."""
    rigid = equations.rigid_equations
    state = {*rigid.coordinates, *rigid.rates}
    n = len(rigid.rates)
    best: tuple[int, str, list[sp.Expr]] = (0, "", [])
    for i in range(n):
        for j in range(i, n):
            forms = [sp.expand(rigid.mass_matrix[i, j])]
            for _, _, shorten in ENTRY_STEPS:
                forms.append(shorten(forms[-1], state))
            saved = written_operations(forms[0]) - written_operations(forms[-1])
            if saved > best[0]:
                best = (saved, rf"M_{{{i + 1},{j + 1}}}", forms)
    if not best[0]:
        return ""
    _, name, (derived, folded, collected) = best
    parts = [rf"\par\noindent As an example ${name}$. As derived, multiplied out:"]
    parts.append(formulas([(name, derived)], as_it_is=True))
    if folded != derived:
        words = r"With $\sin^2 + \cos^2 = 1$ wherever that leaves fewer terms:"
        parts += [words, formulas([(name, folded)], as_it_is=True)]
    if collected != folded:
        words = "What multiplies the same function of the motion collected:"
        parts += [words, formulas([(name, collected)])]
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
