"""The equations as the emitted module computes them."""

from dataclasses import replace

from ptp_symbolic.report.latex_text import escaped, numbered, table
from ptp_symbolic.symbolic.derivation.equations import Equations
from ptp_symbolic.symbolic.documents.latex import rate_latex, symbol_latex
from ptp_symbolic.symbolic.documents.statements import by_name
from ptp_symbolic.symbolic.program.dynamics import solve_accelerations, state_rates
from ptp_symbolic.symbolic.simplify.base_parameters import BaseForm

LAST_LINES = 14  # on the last page at least


def emitted(equations: Equations, form: BaseForm) -> str:
    """The assignments of the emitted module, before it shares what they have in common."""
    regrouped = replace(
        equations, mass_matrix=form.mass_matrix + equations.varying_inertia, forcing=form.forcing
    )
    solve = solve_accelerations(regrouped)
    named = {str(symbol) for symbol, _ in equations.terms}
    lines = [(str(s), e) for s, e in form.shared_terms if s != e]
    lines += [line for line in solve.definitions if line[0] not in named]
    rows = [(symbol_latex(name), by_name(e, equations)) for name, e in lines]
    rates = zip(equations.state_symbols, state_rates(equations, solve), strict=True)
    # what samplers set is constant in between
    rows += [(rate_latex(str(s)), e) for s, e in rates if e != 0]
    used = {str(s) for _, e in lines for s in e.free_symbols} | {name for name, _ in lines}
    own = {str(s) for s in (*equations.state_symbols, *equations.mode_symbols)}
    own |= {p.name for p in equations.parameters} | {i.name for i in equations.inputs} | named
    names = [
        [f"${symbol_latex(name)}$", rf"\texttt{{{escaped(name)}}}"] for name in sorted(used - own)
    ]
    return (
        r"\section{Final equations}The rate of change of every state as the emitted module"
        r" computes it: simplified and in base parameters. What the lines have in"
        r" common the module computes once; the functions named above it uses as they are."
        + table("ll", ["symbol", "name in the module"], names)
        + numbered(rows, together=LAST_LINES)
    )
