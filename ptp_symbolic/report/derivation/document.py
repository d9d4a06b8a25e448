"""The derivation of a platform's equations as a LaTeX document, printed from the expressions.

Title of the derivation report: platform, date, version, and the module that it belongs to.

The machine drawn: frames, drives, and where every effect sits.

The energy ledger.

The equations as the emitted module computes them.
"""

import math
import os
import re
from collections.abc import Sequence
from dataclasses import replace
from datetime import UTC, datetime
from hashlib import sha256

from ptp_symbolic import __version__
from ptp_symbolic.platform import Platform
from ptp_symbolic.report.derivation.bond_graph import bond_graph_section
from ptp_symbolic.report.derivation.coupling import coupled_axes
from ptp_symbolic.report.derivation.curves import PACKAGES as CURVES
from ptp_symbolic.report.derivation.effects import effects
from ptp_symbolic.report.derivation.linear import linearised
from ptp_symbolic.report.derivation.modes import PACKAGES as AUTOMATA
from ptp_symbolic.report.derivation.modes import modes
from ptp_symbolic.report.derivation.operating_points import usual_points
from ptp_symbolic.report.derivation.results import equations_of_motion
from ptp_symbolic.report.derivation.routes import three_routes
from ptp_symbolic.report.derivation.simplification import simplification, simplified
from ptp_symbolic.report.derivation.symbols import frames, symbols
from ptp_symbolic.report.drawing import PlatformDrawing, drawn, tikz_text
from ptp_symbolic.report.drawing.space import POSE
from ptp_symbolic.report.latex_text import PREAMBLE, escaped, numbered, table
from ptp_symbolic.symbolic.derivation.admissible import refuse_impossible
from ptp_symbolic.symbolic.derivation.assembly import assemble
from ptp_symbolic.symbolic.derivation.equations import Equations
from ptp_symbolic.symbolic.derivation.linearisation import OperatingPoint
from ptp_symbolic.symbolic.documents.latex import rate_latex, symbol_latex
from ptp_symbolic.symbolic.documents.statements import by_name
from ptp_symbolic.symbolic.program.dynamics import solve_accelerations, state_rates
from ptp_symbolic.symbolic.simplify.base_parameters import BaseForm
from ptp_symbolic.symbolic.targets.numba.module import module_text


def title_block(platform: Platform, equations: Equations) -> str:
    """Title, date, version, hash of the mathematics and SHA-256 of the module of `platform`.

    The date is today's, or that of SOURCE_DATE_EPOCH, in UTC.
    """
    text = module_text(equations)
    digest = sha256(text.encode()).hexdigest()
    header = re.search(r'^MODEL_HASH = "(\w+)"', text, re.MULTILINE)
    mathematics = header[1] if header else ""
    given = os.environ.get("SOURCE_DATE_EPOCH", "")
    now = datetime.fromtimestamp(int(given), UTC) if given.isdigit() else datetime.now(UTC)
    return "\n".join(
        [
            rf"\title{{\vspace{{-15mm}}{escaped(platform.title)}\\",
            r"\large Derivation of the equations of motion}",
            rf"\author{{\small ptp-symbolic {__version__}}}\date{{\small {now:%Y-%m-%d}}}",
            r"\begin{document}\maketitle",
            r"\noindent This document belongs to the module whose \texttt{MODEL\_HASH} is",
            rf"\texttt{{{mathematics}}}; the SHA-256 of its text, as emitted, is\\",
            rf"\texttt{{{digest}}}.",
        ]
    )


PACKAGES = "\\usepackage{graphicx}\n\\usepackage{tikz}\n\\usetikzlibrary{arrows.meta}"
HOW = (
    r" Arrows point the positive way. Directions are those of the declared numbers; lengths are not"
    r" to scale, but what is longer is drawn longer, and an offset of zero is not drawn."
)


def drawing(platform: Platform, equations: Equations) -> str:
    """Section with the drawing of the frames, the drive of every axis, and the key."""
    found = drawn(platform, equations)
    pictures = [found.frames, *found.drives]
    figures = [rf"\par\smallskip{{\centering{tikz_text(scene)}\par}}" for scene in pictures]
    return "\n".join(
        [r"\section{The machine}", _pose(equations) + HOW, *figures, _key(found)],
    )


def _pose(equations: Equations) -> str:
    """At which joint angles the machine is drawn, and which of the drawings shows what."""
    turning = [axis for axis in equations.axes if axis not in equations.rigid.sliding]
    angles = [rf"{symbol_latex(f'theta_{a}')}={math.degrees(POSE[a]):.0f}^\circ" for a in turning]
    given = r",\; ".join(angles)
    pose = f"drawn at ${given}$" if angles else "drawn away from the origin"
    return (
        f"First the frames, {pose}, then the drive of every axis from its input to its encoder."
        r" Numbers are those of the effects in the table."
    )


def _key(found: PlatformDrawing) -> str:
    rows = [
        [
            str(e.number),
            escaped(e.title),
            escaped(e.where),
            ", ".join(f"${symbol_latex(name)}$" for name in e.parameters),
        ]
        for e in found.key
    ]
    return table("rL{52mm}L{48mm}L{52mm}", ["", "effect", "where it sits", "parameters"], rows)


def energy(equations: Equations) -> str:
    """Section with stored energy, power in and dissipated power."""
    ledger = equations.ledger
    return r"\section{Energy}Stored energy, power in and dissipated power:" + numbered(
        [
            (r"E", by_name(ledger.stored, equations)),
            (r"P_{\mathrm{in}}", by_name(ledger.power_in, equations)),
            (r"P_{\mathrm{diss}}", by_name(ledger.dissipated, equations)),
        ]
    )


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


LINKS = r"\usepackage[hidelinks,bookmarksnumbered]{hyperref}"


def render_derivation(
    platform: Platform, points: Sequence[OperatingPoint] = ()
) -> dict[str, str | bytes]:
    """Return the document as ``derivation.tex``, and the figures that it includes.

    It linearises about `points`, without any about those of `usual_points`. Raises InputError for
    a platform that cannot be derived or a machine that cannot exist.
    """
    equations = assemble(platform)
    refuse_impossible(equations)
    found = simplified(equations)
    linear, figures = linearised(equations, points or usual_points(equations))
    parts = [
        PREAMBLE,
        PACKAGES,
        CURVES,
        AUTOMATA,
        LINKS,
        title_block(platform, equations),
        r"\tableofcontents",
        drawing(platform, equations),
        frames(equations),
        symbols(equations, platform),
        three_routes(equations),
        coupled_axes(equations),
        bond_graph_section(platform, equations),
        equations_of_motion(equations),
        modes(equations),
        simplification(found, equations),
        effects(platform, equations),
        energy(equations),
        linear,
        emitted(equations, found.base_form),
        r"\end{document}",
    ]
    return {"derivation.tex": "\n\n".join(part for part in parts if part) + "\n", **figures}
