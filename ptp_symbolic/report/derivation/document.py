"""The derivation of a platform's equations as a LaTeX document, printed from the expressions."""

from ptp_symbolic.platform import Platform
from ptp_symbolic.report.derivation.curves import PACKAGES
from ptp_symbolic.report.derivation.effects import effects
from ptp_symbolic.report.derivation.emitted import emitted
from ptp_symbolic.report.derivation.energy import energy
from ptp_symbolic.report.derivation.modes import PACKAGES as AUTOMATA
from ptp_symbolic.report.derivation.modes import modes
from ptp_symbolic.report.derivation.results import equations_of_motion
from ptp_symbolic.report.derivation.routes import three_routes
from ptp_symbolic.report.derivation.simplification import simplification, simplified
from ptp_symbolic.report.derivation.symbols import frames, symbols
from ptp_symbolic.report.derivation.title import title_block
from ptp_symbolic.report.latex_text import PREAMBLE
from ptp_symbolic.symbolic.derivation.admissible import refuse_impossible
from ptp_symbolic.symbolic.derivation.assembly import assemble

LINKS = r"\usepackage[hidelinks,bookmarksnumbered]{hyperref}"


def render_derivation(platform: Platform) -> dict[str, str | bytes]:
    """Return the document as ``derivation.tex``; it needs no other file.

    Raises InputError for a platform that cannot be derived or a machine that cannot exist.
    """
    equations = assemble(platform)
    refuse_impossible(equations)
    found = simplified(equations)
    parts = [
        PREAMBLE,
        PACKAGES,
        AUTOMATA,
        LINKS,
        title_block(platform, equations),
        r"\tableofcontents",
        frames(equations),
        symbols(equations, platform),
        three_routes(equations),
        equations_of_motion(equations),
        modes(equations),
        simplification(found),
        effects(platform, equations),
        energy(equations),
        emitted(equations, found.base_form),
        r"\end{document}",
    ]
    return {"derivation.tex": "\n\n".join(part for part in parts if part) + "\n"}
