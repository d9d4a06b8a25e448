"""The machine drawn: frames, drives, and where every effect sits."""

import math

from ptp_symbolic.platform import Platform
from ptp_symbolic.report.drawing import PlatformDrawing, drawn, tikz_text
from ptp_symbolic.report.drawing.space import POSE
from ptp_symbolic.report.latex_text import escaped, table
from ptp_symbolic.symbolic.derivation.equations import Equations
from ptp_symbolic.symbolic.documents.latex import symbol_latex

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
