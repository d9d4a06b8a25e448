"""A scene as a TikZ picture."""

import sympy as sp

from ptp_symbolic.report.drawing.scene import Label, Point, Scene, Stroke, placed
from ptp_symbolic.report.latex_text import escaped
from ptp_symbolic.symbolic.documents.latex import latex_of

WEIGHTS = {"thin": "0.3pt", "normal": "0.55pt", "bold": "1.1pt"}


def tikz_text(scene: Scene) -> str:
    """The scene as a `tikzpicture`, in cm; it needs the library arrows.meta."""
    lines = [*map(_stroke, scene.strokes), *map(_label, scene.labels)]
    begin = r"\begin{tikzpicture}[line join=round,>={Stealth[length=1.9mm,width=1.4mm]}]"
    return "\n".join([begin, *lines, r"\end{tikzpicture}"])


def _stroke(stroke: Stroke) -> str:
    options = [f"line width={WEIGHTS[stroke.weight]}"]
    if stroke.dashed:
        options.append("dash pattern=on 2.2pt off 1.6pt")
    if stroke.head:
        options.append("->")
    if stroke.shade:
        options += ["fill=black", f"fill opacity={stroke.shade:g}"]
    path = " -- ".join(map(_point, stroke.points))
    return rf"\draw[{','.join(options)}] {path}{' -- cycle' if stroke.closed else ''};"


def _label(label: Label) -> str:
    dx = label.direction[0]
    anchor = "west" if dx > 0.5 else "east" if dx < -0.5 else "center"
    text = _text(label.text)
    text = rf"\bfseries {text}" if label.marked else text
    where = _point(placed(label))
    paper = "fill=white,fill opacity=0.8,text opacity=1"  # keeps lines off the letters
    options = rf"anchor={anchor},inner sep=0.6pt,{paper},font=\footnotesize"
    return rf"\node[{options}] at {where} {{{text}}};"


def _text(text: sp.Expr | str) -> str:
    return escaped(text) if isinstance(text, str) else f"${latex_of(text)}$"


def _point(point: Point) -> str:
    return f"({point[0]:.3f},{point[1]:.3f})"
