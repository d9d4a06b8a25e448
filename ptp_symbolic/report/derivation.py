"""The derivation of a platform's equations as a LaTeX document, printed from the expressions."""

import re
from collections.abc import Sequence
from dataclasses import replace
from itertools import groupby

import sympy as sp

from ptp_symbolic.platform import Platform
from ptp_symbolic.report.derivation_symbols import frames, symbols
from ptp_symbolic.report.latex_text import PREAMBLE, escaped, formulas, table
from ptp_symbolic.report.source import THESIS
from ptp_symbolic.symbolic.codegen.dynamics import solve_accelerations, state_rates
from ptp_symbolic.symbolic.codegen.latex import latex_of, rate_latex, symbol_latex
from ptp_symbolic.symbolic.codegen.statements import (
    RELATIONS,
    Statement,
    by_name,
    friction_statements,
    statements,
)
from ptp_symbolic.symbolic.derivation.admissible import refuse_impossible
from ptp_symbolic.symbolic.derivation.assembly import assemble
from ptp_symbolic.symbolic.derivation.equations import Contact, Equations
from ptp_symbolic.symbolic.derivation.kane import kane
from ptp_symbolic.symbolic.derivation.lagrange import lagrange
from ptp_symbolic.symbolic.derivation.newton_euler import newton_euler
from ptp_symbolic.symbolic.derivation.proof import compare_numerically, prove_equal
from ptp_symbolic.symbolic.derivation.properties import energy_remainder, is_passive, is_symmetric
from ptp_symbolic.symbolic.effect_interface.place import active, slide
from ptp_symbolic.symbolic.simplify.base_parameters import BaseForm
from ptp_symbolic.symbolic.simplify.steps import SimplifiedEquations, simplify_rigid
from ptp_symbolic.symbolic.symbols import real

LAST_LINES = 14  # on the last page at least
ROUTES = (("Newton--Euler", newton_euler), ("Kane", kane), ("Lagrange", lagrange))


def render_derivation(platform: Platform) -> dict[str, str | bytes]:
    """Return the document as ``derivation.tex``; it needs no other file.

    Raises InputError for a platform that cannot be derived or a machine that cannot exist.
    """
    equations = assemble(platform)
    refuse_impossible(equations)
    simplified = _simplified(equations)
    parts = [
        PREAMBLE,
        rf"\title{{\vspace{{-15mm}}{escaped(platform.title)}\\"
        r"\large Derivation of the equations of motion}",
        r"\author{}\date{}\begin{document}\maketitle",
        frames(equations),
        symbols(equations, platform),
        _routes(equations),
        _results(equations),
        _simplification(simplified),
        _effects(equations),
        _energy(equations),
        _emitted(equations, simplified.base_form),
        r"\end{document}",
    ]
    return {"derivation.tex": "\n\n".join(parts) + "\n"}


def _routes(equations: Equations) -> str:
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
        + formulas([("T", sp.expand(reference.kinetic)), ("V", reference.potential)])
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


def _results(equations: Equations) -> str:
    found = statements(equations)
    sums = [s for s in found if s.sums and s.right != 0]
    parts = [r"\section{Equations of motion}", r"$M(q)\,\dot\omega = f$, with", _displayed(sums)]
    for friction in equations.frictions:
        rate, direction = (symbol_latex(str(s)) for s in (friction.rate, slide(friction.axis)))
        parts.append(
            rf"Dry friction acts on ${rate}$ against the direction ${direction}=\pm1$ of sliding;"
            rf" at rest, ${direction}=0$, it takes up the {equations.worded('torque')} that acts,"
            " up to breakaway:"
        )
        parts.append(_displayed(friction_statements(friction)))
    for contact in equations.contacts:
        own = [s for s in found if s.key[:2] == ("contact", contact.axis)]
        parts += [_contact(contact), _displayed(own)]
    for switch in equations.switches:
        on = symbol_latex(str(active(switch.name)))
        words = (
            rf"${on}=1$ from where the deviation reaches the threshold, of either sign, until what"
            r" drives it changes sign; it is ready again between the thresholds:"
        )
        parts += [words, _displayed([s for s in found if s.key[:2] == ("switch", switch.name)])]
    for words, kinds in (
        ("The functions named in these equations are", ("term",)),
        ("Drives and effects have states of their own:", ("state",)),
        (
            "Held in between, and set anew at the instants $t_k$, from the values before them:",
            ("sampler",),
        ),
        ("Inputs that act late, and what sensors show:", ("input", "output")),
    ):
        own = [s for s in found if s.key[0] in kinds]
        if own:
            parts += [words, _displayed(own)]
    return "\n".join(parts)


def _displayed(rows: Sequence[Statement]) -> str:
    """Statements one below another, each with its own relation."""
    groups = groupby(rows, key=lambda s: s.relation)
    return "".join(
        formulas([(s.left_latex, s.right) for s in group], RELATIONS[relation][0])
        for relation, group in groups
    )


def _contact(contact: Contact) -> str:
    if contact.restitution is None:
        return rf"The shaft of the {contact.axis} axis has a dead zone; it cannot pull:"
    stuck = ", where the joint sticks" if contact.holds else ""
    return (
        rf"Gear output and joint of the {contact.axis} axis are rigid; they cross a gap{stuck},"
        " strike with this restitution, and turn as one body while in contact:"
    )


def _simplified(equations: Equations) -> SimplifiedEquations:
    constant = equations.mass_matrix - equations.varying_inertia
    return simplify_rigid(equations.rigid_equations, constant, equations.forcing)


def _simplification(found: SimplifiedEquations) -> str:
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
        parts.append(r"\par\noindent The base parameters are" + formulas(base))
    return "\n".join(parts)


def _effects(equations: Equations) -> str:
    rows: Sequence[Sequence[str]] = [
        [rf"\texttt{{{escaped(e.effect.id)}}}", e.axis or "", escaped(e.effect.reference)]
        for e in equations.effects
    ]
    source = rf"\section{{Effects}} \emph{{The thesis}} is {THESIS}"
    return source + table("llL{80mm}", ["effect", "axis", "reference"], rows)


def _energy(equations: Equations) -> str:
    ledger = equations.ledger
    return r"\section{Energy}Stored energy, power in and dissipated power:" + formulas(
        [
            (r"E", by_name(ledger.stored, equations)),
            (r"P_{\mathrm{in}}", by_name(ledger.power_in, equations)),
            (r"P_{\mathrm{diss}}", by_name(ledger.dissipated, equations)),
        ]
    )


def _emitted(equations: Equations, form: BaseForm) -> str:
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
    return (
        r"\section{Final equations}The rate of change of every state as the emitted module"
        r" computes it: simplified, in base parameters and under its names. What the lines have in"
        r" common the module computes once; the functions named above it uses as they are."
        + formulas(rows, together=LAST_LINES)
    )


def has_warning(log: str) -> bool:
    """True when a LaTeX log reports a warning or a box that does not fit."""
    return re.search(r"Warning|Overfull|Underfull", log) is not None
