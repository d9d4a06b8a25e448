"""A scene as SVG to put into a page: in the colour and the font of the text around it."""

import math
from html import unescape

import sympy as sp
from markupsafe import escape

from ptp_symbolic.report.drawing.scene import Label, Point, Scene, Stroke, placed
from ptp_symbolic.symbolic.documents.latex import GREEK, letter_and_place

SCALE = 46.0  # user units per cm
MARGIN = 6.0
LETTER, INDEX, DROP = 13.0, 9.5, 3.5  # sizes of a letter and its index, in user units
WEIGHTS = {"thin": 0.8, "normal": 1.3, "bold": 2.4}
ARROW, HALF_ARROW = 9.0, 3.4
RIM = "rim"  # class of what lies under the letters
ACCENT = "mark"  # class of what is marked; without a style sheet it is told by its weight


def svg_text(scene: Scene) -> str:
    """The scene as an SVG element; all in `currentColor`, what is marked in the class `mark`.

    A page that knows its own colour gives labels a rim of it, which keeps lines off their letters:
    they are there twice for that, at first without colour, in the class `rim`.
    """
    left, bottom, right, top = scene.bounds()
    width, height = (right - left) * SCALE + 2 * MARGIN, (top - bottom) * SCALE + 2 * MARGIN

    def at(point: Point) -> Point:
        return (point[0] - left) * SCALE + MARGIN, (top - point[1]) * SCALE + MARGIN

    lines = [_stroke(stroke, [at(p) for p in stroke.points]) for stroke in scene.strokes]
    texts = [_label(label, at(placed(label))) for label in scene.labels]
    return "\n".join(
        [
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:.0f} {height:.0f}"'
            f' width="{width:.0f}" role="img" fill="none" stroke="currentColor"'
            ' stroke-linejoin="round">',
            f"<title>{escape(scene.description)}</title>",
            *lines,
            f'<g class="{RIM}" fill="none" aria-hidden="true">',
            *texts,
            '</g><g fill="currentColor">',
            *texts,
            "</g></svg>",
        ]
    )


def _stroke(stroke: Stroke, points: list[Point]) -> str:
    path = "M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in points) + ("Z" if stroke.closed else "")
    style = f'stroke-width="{WEIGHTS[stroke.weight]}"'
    if stroke.dashed:
        style += ' stroke-dasharray="5 4"'
    if stroke.shade:
        style += f' fill="currentColor" fill-opacity="{stroke.shade:g}"'
    tip = _tip(points[-2], points[-1]) if stroke.head else ""
    return f'<path d="{path}" {style}{_class(stroke.marked)}/>{tip}'


def _tip(before: Point, end: Point) -> str:
    """The filled triangle at the end of an arrow."""
    length = math.dist(before, end) or 1.0
    ux, uy = (end[0] - before[0]) / length, (end[1] - before[1]) / length
    x, y = end[0] - ARROW * ux, end[1] - ARROW * uy
    corners = (
        end,
        (x - HALF_ARROW * uy, y + HALF_ARROW * ux),
        (x + HALF_ARROW * uy, y - HALF_ARROW * ux),
    )
    path = "M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in corners) + "Z"
    return f'<path d="{path}" fill="currentColor" stroke="none"/>'


def _label(label: Label, at: Point) -> str:
    dx = label.direction[0]
    anchor = "start" if dx > 0.5 else "end" if dx < -0.5 else "middle"
    weight = ' font-weight="bold"' if label.marked else ""
    return (
        f'<text x="{at[0]:.1f}" y="{at[1] + LETTER / 3:.1f}" text-anchor="{anchor}"'
        f' font-size="{LETTER:g}" stroke="none"{weight}{_class(label.marked)}>'
        f"{_runs(label.text)}</text>"
    )


def _runs(text: sp.Expr | str) -> str:
    """Words as they are; of a sum of symbols every letter in italics, its index small and low."""
    if isinstance(text, str):
        return str(escape(text))
    terms = text.as_ordered_terms(order="lex")
    written = [(t.could_extract_minus_sign(), _symbol(str(abs_of(t)))) for t in terms]
    joined = "".join(f" {'−' if minus else '+'} {own}" for minus, own in written)
    return joined.removeprefix(" + ").removeprefix(" ")


def abs_of(term: sp.Expr) -> sp.Expr:
    """`term` without its sign."""
    return -term if term.could_extract_minus_sign() else term


def _symbol(name: str) -> str:
    letter, place = letter_and_place(name)
    head = unescape(f"&{letter};") if letter in GREEK else str(escape(letter.replace("dc", "Δc")))
    index = escape(",".join(place))
    low = f'<tspan font-size="{INDEX:g}" dy="{DROP:g}">{index}</tspan>'
    low += f'<tspan dy="-{DROP:g}">\u200b</tspan>'
    return f'<tspan font-style="italic">{head}</tspan>{low if place else ""}'


def _class(marked: bool) -> str:
    return f' class="{ACCENT}"' if marked else ""
