"""The effects of the platform, with their references."""

from collections.abc import Sequence

from ptp_symbolic.report.latex_text import escaped, table
from ptp_symbolic.report.source import THESIS
from ptp_symbolic.symbolic.derivation.equations import Equations


def effects(equations: Equations) -> str:
    """Section with the effects, their axes and references."""
    rows: Sequence[Sequence[str]] = [
        [rf"\texttt{{{escaped(e.effect.id)}}}", e.axis or "", escaped(e.effect.reference)]
        for e in equations.effects
    ]
    source = rf"\section{{Effects}} \emph{{The thesis}} is {THESIS}"
    return source + table("llL{80mm}", ["effect", "axis", "reference"], rows)
