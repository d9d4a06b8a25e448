"""A bond graph as a TikZ picture: half arrows, causal strokes, the axes one below another.

A power bond ends in half an arrow at the end to which positive power flows, and has its causal
stroke at the end on which the effort acts. Bonds are numbered as in the graph.
"""

import math
from collections.abc import Iterator

import sympy as sp

from ptp_symbolic.report.drawing.scene import HALF_CHARACTER, Point
from ptp_symbolic.symbolic.derivation.bond_graph import BondGraph, Node
from ptp_symbolic.symbolic.documents.latex import latex_of, symbol_latex

PAGE = 16.8  # width of the text in cm
LONGEST_LAW = 14  # characters beside a letter; longer ones are in the table alone
STEP = 1.55  # between neighbours of a chain, in cm
REACH = 1.5  # from a junction to its elements, in cm
BESIDE = 2.6  # from the joints to the fields that they share, in cm
HALF_HEIGHT = 0.22  # of a letter with its room, in cm
GAP = 0.35  # between two labels side by side, in cm
SHORTEST = 0.75  # bond of a source, in cm
BELOW = 0.058  # half the width of a letter of what stands below a node, in cm
JUNCTIONS = ("0", "1")
TWO_PORTS = ("TF", "MTF", "GY")
BARB, STROKE, NUMBER_AWAY = 0.17, 0.15, 0.19  # cm
BESIDE_STROKE = 0.18  # cm, of what a junction has, beside a bond that goes down
CLEAR = 0.08  # cm, of a bond from a label


def label(node: Node) -> str:
    """What is written at a node, in LaTeX: a kind, for an element with its law if that is short."""
    law = short_law(node)
    if node.kind in (*JUNCTIONS, *TWO_PORTS) or not law:
        return rf"\mathsf{{{node.kind}}}"
    return rf"\mathsf{{{node.kind}}}:{law}"


def short_law(node: Node) -> str:
    """The law of a node in LaTeX, if it has one that is short enough to stand beside it."""
    short = len(sp.sstr(node.law)) <= LONGEST_LAW
    if node.kind == "MTF" and not short:
        return modulus_name(node)
    return latex_of(node.law) if node.law != 0 and short else ""


def modulus_name(node: Node) -> str:
    """The name of a transformer's modulus that is too long to stand beside it."""
    return symbol_latex(f"m_{node.name}".replace("gear_", ""))


def _half_width(node: Node) -> float:
    letters = len(node.kind) + 0.5
    if node.kind not in (*JUNCTIONS, *TWO_PORTS) and short_law(node):
        letters += 1 + len(sp.sstr(node.law).replace("_", ""))
    return max(0.2, letters * HALF_CHARACTER + 0.1)


def _beneath(node: Node) -> tuple[float, float]:
    """How far what stands below a node reaches to the left and to the right of it, in cm."""
    law = short_law(node)
    if not law or node.kind not in (*JUNCTIONS, *TWO_PORTS):
        return 0.0, 0.0
    letters = node.name if law == modulus_name(node) else sp.sstr(node.law)
    half = BELOW * (len(letters.replace("_", "")) + 1)
    if node.kind in TWO_PORTS:
        return half, half
    far = BESIDE_STROKE + 2 * half
    return (far, 0.0) if node.name == node.axis else (0.0, far)


def bond_graph_tikz(graph: BondGraph, axes: tuple[str, ...]) -> str:
    """The picture; one that is wider than the text is made smaller."""
    places = _places(graph, axes)
    lines = [
        line
        for node in graph.nodes
        for line in _node(node, places[node.name], _away(node.axis or "", axes))
    ]
    for number, bond in enumerate(graph.bonds, 1):
        ends = (graph.node(bond.tail), graph.node(bond.head))
        lines += _bond(number, ends, bond.at_head, places)
    picture = "\n".join([r"\begin{tikzpicture}[font=\small]", *lines, r"\end{tikzpicture}"])
    widths = [
        (x - _half_width(graph.node(n)), x + _half_width(graph.node(n)))
        for n, (x, _) in places.items()
    ]
    width = max(right for _, right in widths) - min(left for left, _ in widths)
    return rf"\resizebox{{\linewidth}}{{!}}{{{picture}}}" if width > PAGE else picture


def _places(graph: BondGraph, axes: tuple[str, ...]) -> dict[str, Point]:
    """Every chain on a line of its own, joints in one column, shared elements right of them."""
    places: dict[str, Point] = {}
    y = 0.0
    rows = [_row(graph, axis, _away(axis, axes)) for axis in axes]
    column = max(row[axis][0] for row, axis in zip(rows, axes, strict=True))
    for row, axis in zip(rows, axes, strict=True):
        top = max(py for _, py in row.values())
        if places:
            y -= top + 0.9
        shift = column - row[axis][0]
        places |= {name: (x + shift, y + py) for name, (x, py) in row.items()}
        y += min(py for _, py in row.values())
    shared = [node for node in graph.nodes if node.name not in places]
    heights = [places[axis][1] for axis in axes]
    for k, node in enumerate(shared, 1):
        height = heights[0] + (heights[-1] - heights[0]) * k / (len(shared) + 1)
        places[node.name] = (column + BESIDE, height)
    return places


def _away(axis: str, axes: tuple[str, ...]) -> float:
    """Up (1) or down (-1): from the joint of `axis`, away from the other axes."""
    return 1.0 if axis == axes[0] and len(axes) > 1 else -1.0


def _row(graph: BondGraph, axis: str, away: float) -> dict[str, Point]:
    """The chain of one axis on y = 0 with what hangs on it, but for elements of several axes.

    Bonds to those leave the joint to the right and not on the side `away`: so what hangs on it goes
    to the right there, where its rate is written to the left, and to the left on the other side.
    """
    chain = _chain(graph, axis)
    places: dict[str, Point] = {}
    x, room, below = 0.0, 0.0, 0.0
    for number, name in enumerate(chain):
        hanging = _hanging(graph, name, axis, chain)
        before = name == chain[0] and hanging and graph.node(hanging[0]).kind.endswith(("Se", "Sf"))
        left = hanging.pop(0) if before else None
        behind = name == axis and hanging and _single(graph)
        right = hanging.pop(0) if behind else None
        sides = hanging[::2], hanging[1::2]
        widths = [[_span(graph, n) for n in side] for side in sides]
        aside = name == axis and not _single(graph)
        turns = [
            ((w[0] - sum(w)) / 2 if up == away else (sum(w) - w[-1]) / 2) if aside and w else 0.0
            for w, up in zip(widths, (1.0, -1.0), strict=True)
        ]
        width = max(sum(w) / 2 + turn for w, turn in zip(widths, turns, strict=True))
        reach = _beneath(graph.node(name))
        x += max(STEP, room + width, below + reach[0] + GAP / 2) if number else 0.0
        room, below = width, reach[1]
        places[name] = (x, 0.0)
        for side, turn, up in zip(sides, turns, (1.0, -1.0), strict=True):
            places |= _beside(graph, side, x - turn, up, REACH)
        if left:
            ends = _half_width(graph.node(left)) + _half_width(graph.node(name))
            places[left] = (x - max(REACH, ends + SHORTEST), 0.0)
        if right:
            places[right] = (x + REACH + 0.2, 0.0)
    return places


def _single(graph: BondGraph) -> bool:
    """Whether no element is shared by several axes, so that there is room behind the joint."""
    return all(node.axis is not None for node in graph.nodes)


def _chain(graph: BondGraph, axis: str) -> list[str]:
    """Junctions and two-ports of `axis` from its source to its joint."""
    found = [axis]
    while True:
        before = [
            bond.tail
            for bond in graph.bonds
            if bond.head == found[0] and graph.node(bond.tail).kind in (*JUNCTIONS, *TWO_PORTS)
        ]
        if not before:
            return found
        found.insert(0, before[0])


def _hanging(graph: BondGraph, name: str, axis: str, chain: list[str]) -> list[str]:
    """What hangs on a junction: sources first, then in the order of the graph."""
    found = []
    for bond in graph.bonds:
        if name in (bond.tail, bond.head):
            other = bond.head if bond.tail == name else bond.tail
            if other not in chain and graph.node(other).axis == axis:
                found.append(other)
    return sorted(found, key=lambda n: not graph.node(n).kind.endswith(("Se", "Sf")))


def _span(graph: BondGraph, name: str) -> float:
    """The width that something hanging takes, with what hangs on it in turn."""
    own = 2 * _half_width(graph.node(name)) + GAP
    return max(own, sum(_span(graph, n) for n in _carried(graph, name)))


def _carried(graph: BondGraph, name: str) -> list[str]:
    """The elements on a junction that hangs itself, such as the twist of a shaft."""
    node = graph.node(name)
    if node.kind != "1" or node.axis is None:
        return []
    return [n for n in _hanging(graph, name, node.axis, []) if graph.node(n).kind not in JUNCTIONS]


def _beside(graph: BondGraph, names: list[str], x: float, up: float, y: float) -> dict[str, Point]:
    """Places of `names` side by side around `x`, at the height `y`, above (1) or below (-1)."""
    places: dict[str, Point] = {}
    left = x - sum(_span(graph, n) for n in names) / 2
    for name in names:
        span = _span(graph, name)
        middle, left = left + span / 2, left + span
        places[name] = (middle, up * y)
        places |= _beside(graph, _carried(graph, name), middle, up, y + REACH)
    return places


def _node(node: Node, place: Point, away: float) -> Iterator[str]:
    x, y = place
    yield rf"\node at ({x:.2f},{y:.2f}) {{${label(node)}$}};"
    law = short_law(node)
    if law and node.kind in (*JUNCTIONS, *TWO_PORTS):
        anchor, side = ("center", 0.0) if node.kind in TWO_PORTS else ("west", BESIDE_STROKE)
        lift = -0.36
        if node.name == node.axis:  # bonds of a joint go to the right
            anchor, side, lift = "east", -BESIDE_STROKE, 0.46 if away > 0.0 else lift
        at = f"({x + side:.2f},{y + lift:.2f})"
        yield rf"\node[anchor={anchor},inner sep=0.5pt,font=\scriptsize] at {at} {{${law}$}};"


def _bond(
    number: int, ends: tuple[Node, Node], at_head: bool, places: dict[str, Point]
) -> Iterator[str]:
    tail, head = (places[node.name] for node in ends)
    across, along = head[0] - tail[0], head[1] - tail[1]
    length = math.hypot(across, along)
    dx, dy = across / length, along / length
    start = _edge(ends[0], tail, (dx, dy))
    end = _edge(ends[1], head, (-dx, -dy))
    nx, ny = dy, -dx  # to the right of the direction of power
    yield _line(start, end)
    yield _line(end, (end[0] - BARB * dx + 0.7 * BARB * nx, end[1] - BARB * dy + 0.7 * BARB * ny))
    marked = end if at_head else start
    yield _line(
        (marked[0] - STROKE * nx, marked[1] - STROKE * ny),
        (marked[0] + STROKE * nx, marked[1] + STROKE * ny),
        "line width=1pt",
    )
    middle = ((start[0] + end[0]) / 2, (start[1] + end[1]) / 2)
    at = f"({middle[0] - NUMBER_AWAY * nx:.2f},{middle[1] - NUMBER_AWAY * ny:.2f})"
    yield rf"\node[font=\tiny,inner sep=0.5pt] at {at} {{{number}}};"


def _edge(node: Node, place: Point, direction: Point) -> Point:
    """Where a line that leaves a node in a direction comes out of its label."""
    dx, dy = direction
    reaches = [
        half / abs(part)
        for half, part in ((_half_width(node), dx), (HALF_HEIGHT, dy))
        if abs(part) > 1e-9
    ]
    reach = min(reaches) + CLEAR
    return place[0] + reach * dx, place[1] + reach * dy


def _line(start: Point, end: Point, options: str = "line width=0.5pt") -> str:
    return rf"\draw[{options}] ({start[0]:.3f},{start[1]:.3f}) -- ({end[0]:.3f},{end[1]:.3f});"
