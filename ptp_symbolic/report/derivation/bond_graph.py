"""The bond graph of the machine: drawn, with a table of its bonds and of their powers."""

import sympy as sp

from ptp_symbolic.platform import Platform
from ptp_symbolic.report.drawing.bond_graph import bond_graph_tikz, modulus_name, short_law
from ptp_symbolic.report.latex_text import escaped, formulas, table
from ptp_symbolic.symbolic.derivation.bond_graph import FLOW, Bond, BondGraph, Node, bond_graph
from ptp_symbolic.symbolic.derivation.equations import Equations
from ptp_symbolic.symbolic.documents.latex import latex_of, symbol_latex
from ptp_symbolic.symbolic.documents.statements import by_name
from ptp_symbolic.symbolic.mechanics import kinematics

LONGEST = 44  # characters in the table; longer ones stand below it
JUNCTIONS = ("0", "1", "TF", "MTF", "GY")
READING = (
    r"The bond graph (thesis section 2.1; Karnopp, Margolis and Rosenberg, 2012) shows where power"
    r" flows. At a $\mathsf{1}$ all bonds have one flow and their efforts add up to zero; at a"
    r" $\mathsf{0}$ they have one effort and their flows add up to zero. $\mathsf{I}$ and"
    r" $\mathsf{C}$ store energy, $\mathsf{R}$ takes it out, $\mathsf{Se}$ and $\mathsf{Sf}$ supply"
    r" it (modulated ones, $\mathsf{M}$, by the state or by time), $\mathsf{TF}$ is a transformer,"
    r" $\mathsf{GY}$ a gyrator; an element of several letters does several of these. Half an arrow"
    r" shows where positive power goes, the stroke the end on which the effort acts."
)


def bond_graph_section(platform: Platform, equations: Equations) -> str:
    """Section with the graph of `platform`, its bonds, and which of them make up the ledger."""
    graph = bond_graph(platform)
    picture = bond_graph_tikz(graph, equations.axes)
    parts = [
        r"\section{Bond graph}" + READING,
        rf"\par\medskip{{\centering {picture}\par}}\medskip",
        _bonds(graph, equations),
        _powers(graph),
        _dependent(graph),
    ]
    return "\n".join(part for part in parts if part)


def _bonds(graph: BondGraph, equations: Equations) -> str:
    """Effort and flow of every bond; what is long in formulas below, each once."""
    rows: list[list[str]] = []
    below: dict[sp.Expr, str] = {}

    def written(letter: str, number: int, value: sp.Expr) -> str:
        named = by_name(value, equations)
        if len(sp.sstr(named)) <= LONGEST:
            return latex_of(named)
        return below.setdefault(named, f"{letter}_{{{number}}}")

    for number, bond in enumerate(graph.bonds, 1):
        effort, flow = _behind_gear(bond, graph)
        if bond.head == "bodies":
            effort = _inertial(kinematics.place_of(bond.flow))
        if graph.node(bond.tail).kind == FLOW:
            effort = symbol_latex(f"T_motion_{bond.head}")
        effort = effort or written("e", number, bond.effort)
        flow = flow or written("f", number, bond.flow)
        rows.append([str(number), _between(bond, graph), f"${effort}$", f"${flow}$"])
    formulas_below = [(name, value) for value, name in below.items()]
    named = [n for n in graph.nodes if n.kind == "MTF" and short_law(n) == modulus_name(n)]
    formulas_below += [_modulus(node) for node in named]
    motions = [n.axis for n in graph.nodes if n.kind == FLOW]
    text = table("rL{70mm}L{44mm}L{36mm}", ["", "bond", "effort $e$", "flow $f$"], rows)
    for axis in motions:
        torque = symbol_latex(f"T_motion_{axis}")
        text += rf"\par\noindent ${torque}$ is what the prescribed motion of the {axis} axis takes."
    return text + (r"\par\noindent where" + formulas(formulas_below) if formulas_below else "")


def _modulus(node: Node) -> tuple[str, sp.Expr]:
    """The formula of a modulus; its reciprocal where that is the shorter one."""
    if sp.fraction(node.law)[0] == 1:
        return f"1/{modulus_name(node)}", 1 / node.law
    return modulus_name(node), node.law


def _inertial(at: str) -> str:
    """The effort of the bodies' inertia, as Lagrange's equation has it."""
    momentum, angle = symbol_latex(f"p_{at}"), symbol_latex(f"theta_{at}")
    return rf"\mathrm{{d}}{momentum}/\mathrm{{d}}t - \partial T/\partial {angle}"


def _behind_gear(bond: Bond, graph: BondGraph) -> tuple[str, str]:
    """Effort and flow behind a transformer, by those before it; the flow unless it is a rate."""
    tail = graph.node(bond.tail)
    if tail.kind not in ("TF", "MTF"):
        return "", ""
    before = next(k for k, b in enumerate(graph.bonds, 1) if b.head == tail.name)
    modulus = short_law(tail) or latex_of(tail.law)
    flow = rf"f_{{{before}}} / ({modulus})" if tail.law.is_Add or tail.law.is_Mul else ""
    flow = flow or rf"f_{{{before}}} / {modulus}"
    return rf"{_factor(tail.law, modulus)} e_{{{before}}}", "" if bond.flow.is_Symbol else flow


def _factor(law: sp.Expr, written: str) -> str:
    return rf"\left({written}\right)" if law.is_Add else written


def _between(bond: Bond, graph: BondGraph) -> str:
    """A bond in words: the element or, between junctions, both."""
    tail, head = graph.node(bond.tail), graph.node(bond.head)
    if head.kind not in JUNCTIONS:
        return _words(head)
    if tail.kind not in JUNCTIONS:
        return _words(tail)
    return f"{escaped(tail.meaning)} -- {escaped(head.meaning)}"


def _words(node: Node) -> str:
    return rf"$\mathsf{{{node.kind}}}$: {escaped(node.meaning)}"


def _powers(graph: BondGraph) -> str:
    """Which bonds make up the parts of the energy ledger."""
    supply: list[int] = []
    store: list[int] = []
    lose: list[int] = []
    mixed: list[int] = []
    for number, bond in enumerate(graph.bonds, 1):
        for node in (graph.node(bond.tail), graph.node(bond.head)):
            own = node.ledger
            parts = [own.power_in != 0, own.stored != 0, own.dissipated != 0]
            if sum(parts) == 1:
                (supply, store, lose)[parts.index(True)].append(number)
            elif any(parts):
                mixed.append(number)
    rows = []
    for left, numbers in (
        (r"P_{\mathrm{in}}", supply),
        (r"P_{\mathrm{diss}}", lose),
        (r"\mathrm{d}E/\mathrm{d}t", store),
    ):
        if numbers:
            rows.append(f"{left} = " + " + ".join(rf"e_{{{n}}}f_{{{n}}}" for n in numbers))
    text = (
        r"\par\noindent The powers of the bonds, effort $e$ times flow $f$, are those of the energy"
        r" ledger (section Energy):\[\begin{gathered}" + r" \\ ".join(rows) + r"\end{gathered}\]"
    )
    if mixed:
        listed = ", ".join(map(str, mixed))
        text += rf"beside bond {listed}, of whose power a part is stored and a part lost or given."
    return text


def _dependent(graph: BondGraph) -> str:
    """What stores in derivative causality, and why that is so."""
    if not graph.dependent:
        return (
            "All elements that store energy are in integral causality: each has a state of its own."
        )
    names = " and ".join(escaped(node.meaning) for node in graph.dependent)
    return (
        rf"In derivative causality: {names}. Its rate is that of the joint, to which it is geared"
        " rigidly, so that both inertias are one in the mass matrix."
    )
