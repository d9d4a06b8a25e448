"""The derivation of a platform's equations as a LaTeX document, printed from the expressions."""

from collections.abc import Sequence

from ptp_symbolic.platform import Platform
from ptp_symbolic.report.derivation.bond_graph import bond_graph_section
from ptp_symbolic.report.derivation.coupling import coupled_axes
from ptp_symbolic.report.derivation.curves import PACKAGES as CURVES
from ptp_symbolic.report.derivation.drawing import PACKAGES, drawing
from ptp_symbolic.report.derivation.effects import effects
from ptp_symbolic.report.derivation.emitted import emitted
from ptp_symbolic.report.derivation.energy import energy
from ptp_symbolic.report.derivation.linear import linearised
from ptp_symbolic.report.derivation.modes import PACKAGES as AUTOMATA
from ptp_symbolic.report.derivation.modes import modes
from ptp_symbolic.report.derivation.operating_points import usual_points
from ptp_symbolic.report.derivation.results import equations_of_motion
from ptp_symbolic.report.derivation.routes import three_routes
from ptp_symbolic.report.derivation.simplification import simplification, simplified
from ptp_symbolic.report.derivation.symbols import frames, symbols
from ptp_symbolic.report.derivation.title import title_block
from ptp_symbolic.report.latex_text import PREAMBLE
from ptp_symbolic.symbolic.derivation.admissible import refuse_impossible
from ptp_symbolic.symbolic.derivation.assembly import assemble
from ptp_symbolic.symbolic.derivation.linearisation import OperatingPoint

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
