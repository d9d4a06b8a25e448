"""The derivation of a platform's equations as a LaTeX document, printed from the expressions."""

import re
from collections.abc import Sequence

import sympy as sp

from ptp_symbolic.codegen.latex import latex_of, symbol_latex
from ptp_symbolic.derivation.admissible import refuse_impossible
from ptp_symbolic.derivation.assembly import assemble
from ptp_symbolic.derivation.equations import Contact, Equations
from ptp_symbolic.derivation.kane import kane
from ptp_symbolic.derivation.lagrange import lagrange
from ptp_symbolic.derivation.newton_euler import newton_euler
from ptp_symbolic.derivation.proof import compare_numerically, prove_equal
from ptp_symbolic.derivation.properties import energy_remainder, is_passive, is_symmetric
from ptp_symbolic.platform import Platform
from ptp_symbolic.report.latex_text import PREAMBLE, escaped, formula, table
from ptp_symbolic.simplify.steps import simplify_rigid

ROUTES = (("Newton--Euler", newton_euler), ("Kane", kane), ("Lagrange", lagrange))


def render_derivation(platform: Platform) -> dict[str, str | bytes]:
    """Return the document as ``derivation.tex``; it needs no other file."""
    equations = assemble(platform)
    refuse_impossible(equations)
    parts = [
        PREAMBLE,
        rf"\title{{{escaped(platform.title)}\\\large Derivation of the equations of motion}}",
        r"\author{}\date{}\begin{document}\maketitle",
        _frames(equations),
        _symbols(equations, platform),
        _routes(equations),
        _results(equations),
        _simplification(equations),
        _effects(equations),
        _energy(equations),
        r"\end{document}",
    ]
    return {"derivation.tex": "\n\n".join(parts) + "\n"}


def _frames(equations: Equations) -> str:
    return (
        r"""\section{Frames and signs}
The pan frame turns about the vertical $z$ axis of the base by $\theta_{\mathrm{pan}}$; the tilt
frame turns about the $y$ axis of the pan frame by $\theta_{\mathrm{tilt}}$. The boresight is the
$x$ axis of the tilt frame, and a positive tilt angle lowers it. The axes cross in the origin.
Gravity in the base frame is
"""
        + formula(r"\mathbf{g} = " + latex_of(equations.rigid.gravity))
        + (
            r"with the body rates $(-\omega_{\mathrm{pan}}\sin\theta_{\mathrm{tilt}},\;"
            r"\omega_{\mathrm{tilt}},\;\omega_{\mathrm{pan}}\cos\theta_{\mathrm{tilt}})$ of the"
            " tilt body (thesis Eq.~3.1)."
            if len(equations.axes) == 2
            else "in metres per second squared."
        )
    )


def _symbols(equations: Equations, platform: Platform) -> str:
    declared = {d.name: d for d in platform.parameters}
    rows = []
    for p in equations.parameters:
        d = declared.get(p.name)
        kind = "tied" if d and d.same_as else "free" if d and d.free else "known"
        rows.append(
            [
                f"${symbol_latex(p.name)}$",
                escaped(p.meaning),
                escaped(p.unit),
                f"{p.default:.6g}",
                kind,
            ]
        )
    states = [[f"${symbol_latex(str(s))}$", "state"] for s in equations.state_symbols]
    inputs = [[f"${symbol_latex(i.name)}$", f"{escaped(i.meaning)} in {escaped(i.unit)}"]
              for i in equations.inputs]  # fmt: skip
    head = ["symbol", "meaning", "unit", "value", ""]
    return (
        r"\section{Symbols}" + table("lp{68mm}lrl", head, rows)
        + r"\par\noindent " + table("ll", ["symbol", "meaning"], states + inputs)
    )  # fmt: skip


def _routes(equations: Equations) -> str:
    derived = {name: route(equations.rigid) for name, route in ROUTES}
    reference = derived["Lagrange"]
    numbers = {sp.Symbol(p.name, real=True): float(p.default) or 0.01 for p in equations.parameters}
    rows = []
    for name in ("Newton--Euler", "Kane"):
        proof = prove_equal(derived[name], reference)
        worst = compare_numerically(derived[name], reference, numbers, states=10_000, seed=1)
        left = "0" if proof.equal else "not 0"
        rows.append([f"{name} -- Lagrange", f"${left}$", f"${_power(worst)}$"])
    text = (
        r"""\section{Three routes to the rigid equations}
\emph{Newton--Euler}: rates and accelerations of every body are carried outward along the axes,
forces and moments inward; the joint torques are the moments about the axes. \emph{Kane}: partial
velocities of every body project its inertia and gravity forces. \emph{Lagrange}: kinetic and
potential energy give
"""
        + formula(rf"T = {latex_of(sp.expand(reference.kinetic))}", reference.kinetic, "T")
        + formula(rf"V = {latex_of(reference.potential)}", reference.potential, "V")
    )
    head = ["routes", "symbolic difference", "largest relative difference / cond"]
    claims = [
        f"The mass matrix is {'symmetric' if is_symmetric(reference) else 'not symmetric'}",
        f"$\\dot M - 2C$ is {'skew' if is_passive(reference) else 'not skew'}",
        f"the energy ledger of the rigid part leaves ${latex_of(energy_remainder(reference))}$",
    ]
    return text + (
        "The routes are compared symbolically (mass matrix and forcing, every entry) and at"
        r" 10\,000 random states:" + table("lll", head, rows) + r"\par\noindent "
        + "; ".join(claims) + "."
    )  # fmt: skip


def _power(value: float) -> str:
    if value == 0.0:
        return "0"
    mantissa, exponent = f"{value:.1e}".split("e")
    return rf"{mantissa}\cdot 10^{{{int(exponent)}}}"


def _results(equations: Equations) -> str:
    parts = [r"\section{Equations of motion}", r"$M(q)\,\dot\omega = f - $ friction, with"]
    size = len(equations.rates)
    for i in range(size):
        for j in range(i, size):
            entry = equations.mass_matrix[i, j]
            if entry != 0:
                parts.append(formula("", entry, f"M_{{{i + 1}{j + 1}}}"))
    for i, rate in enumerate(equations.rates):
        parts.append(formula("", equations.forcing[i], rf"f[{symbol_latex(str(rate))}]"))
    for symbol, term in equations.terms:
        parts.append(formula("", term, symbol_latex(str(symbol))))
    for friction in equations.frictions:
        name = symbol_latex(str(friction.rate))
        parts.append(
            rf"Dry friction acts on ${name}$ against the direction $s=\pm1$ of sliding and holds"
            " at rest up to the breakaway torque:"
        )
        parts.append(formula("", friction.level, r"F_{\mathrm{sliding}}"))
        parts.append(formula("", friction.breakaway, r"F_{\mathrm{breakaway}}"))
    for contact in equations.contacts:
        parts += _contact(contact)
        parts.append(formula("", contact.half_gap, r"\tfrac12\,\mathrm{gap}"))
    held = {str(symbol) for _, symbol, _ in equations.updates}
    for state in (s for s in equations.extra_states if s.name not in held):
        name = symbol_latex(state.name)
        parts.append(
            formula("", state.derivative, rf"\frac{{\mathrm{{d}}}}{{\mathrm{{d}}t}}{name}")
        )
    for sampler in equations.samplers:
        parts.append("Held in between, and set anew at the instants")
        start = sp.Symbol("k", real=True) + sampler.phase
        parts.append(formula("", sampler.offset + start * sampler.period, "t_k"))
        for symbol, term in sampler.terms.items():
            parts.append(formula("", term, symbol_latex(str(symbol))))
        for symbol, value in sampler.updates.items():
            parts.append(formula("", value, rf"{symbol_latex(str(symbol))}\big|_{{t_k}}"))
    return "\n".join(parts)


def _contact(contact: Contact) -> list[str]:
    if contact.restitution is None:
        return [
            rf"The shaft of the {contact.axis} axis has a dead zone; it cannot pull:",
            formula("", contact.torque, r"T_{\mathrm{shaft}}"),
        ]
    held = ", where friction holds the joint" if contact.holds else ""
    return [
        rf"Gear output and joint of the {contact.axis} axis are rigid; they cross a gap{held},"
        " strike with this restitution, and turn as one body while in contact:",
        formula("", contact.restitution, "e"),
    ]


def _simplification(equations: Equations) -> str:
    constant = equations.mass_matrix - equations.varying_inertia
    found = simplify_rigid(equations.rigid_equations, constant, equations.forcing)
    rows = [
        [escaped(s.name), str(s.operations_before), str(s.operations_after),
         "yes" if s.proved else "no"]
        for s in found.steps
    ]  # fmt: skip
    head = ["step", "operations before", "after", "proved"]
    parts = [r"\section{Simplification}", table("lrrl", head, rows)]
    parts.append(r"\par\noindent The base parameters are")
    for symbol, expression in found.base_form.base_parameters:
        if symbol != expression:
            parts.append(formula("", expression, rf"\mathrm{{{escaped(str(symbol))}}}"))
    return "\n".join(parts)


def _effects(equations: Equations) -> str:
    rows: Sequence[Sequence[str]] = [
        [rf"\texttt{{{escaped(e.effect.id)}}}", e.axis or "", escaped(e.effect.reference)]
        for e in equations.effects
    ]
    return r"\section{Effects}" + table("llp{80mm}", ["effect", "axis", "reference"], rows)


def _energy(equations: Equations) -> str:
    ledger = equations.ledger
    return r"\section{Energy}Stored energy, power in and dissipated power:" + "".join(
        formula("", expression, name)
        for name, expression in (
            (r"E", ledger.stored), (r"P_{\mathrm{in}}", ledger.power_in),
            (r"P_{\mathrm{diss}}", ledger.dissipated),
        )
    )  # fmt: skip


def has_warning(log: str) -> bool:
    """True when a LaTeX log reports a warning or a box that does not fit."""
    return re.search(r"Warning|Overfull|Underfull", log) is not None
