"""Friction and contact as complementarity: modes, what ends them, and the transitions, drawn."""

from collections.abc import Sequence
from dataclasses import dataclass

import sympy as sp

from ptp_symbolic.report.latex_text import escaped, numbered, table
from ptp_symbolic.symbolic.derivation.equations import Contact, Equations
from ptp_symbolic.symbolic.documents.latex import latex_of, rate_latex
from ptp_symbolic.symbolic.documents.statements import by_name, friction_statements, shaft_torque
from ptp_symbolic.symbolic.effect_interface.contribution import Friction, Switch
from ptp_symbolic.symbolic.effect_interface.place import active, side, slide
from ptp_symbolic.symbolic.mechanics.kinematics import place_of
from ptp_symbolic.symbolic.program.dynamics import guard_expressions, solve_accelerations
from ptp_symbolic.symbolic.symbols import real

PACKAGES = r"""\usepackage{tikz}
\usetikzlibrary{automata,positioning}
\tikzset{modes/.style={auto, node distance=42mm, font=\small, >=stealth,
  every state/.style={rectangle, rounded corners=2mm, draw, align=center, minimum height=9mm,
  inner sep=4pt}}}"""
FRICTION_GUARDS = 3  # guards of one friction
APART = 62  # mm between two modes that are drawn


@dataclass(frozen=True)
class Mode:
    """One mode: its name, the values of its symbols, what holds in it and how long, in LaTeX."""

    name: str
    values: str
    holds: str
    lasts: str


@dataclass(frozen=True)
class Transition:
    """From one mode to another, by number, where `when` comes true; `bend` of the arrow drawn."""

    start: int
    end: int
    when: str
    bend: str = "bend left=12"


@dataclass(frozen=True)
class Automaton:
    """The modes of one friction, contact or switch, drawn in this order from left to right."""

    title: str
    modes: tuple[Mode, ...]
    transitions: tuple[Transition, ...]
    rows: tuple[tuple[str, sp.Expr], ...] = ()
    complementarity: str = ""
    words: str = ""


def modes(equations: Equations) -> str:
    """Section with the modes of the machine; empty for a smooth one."""
    found = automata(equations)
    if not found:
        return ""
    counts = [len(own.modes) for own in found]
    product = r" \cdot ".join(map(str, counts))
    opening = (
        r"\section{Modes of friction and contact}Each friction, contact and switch is in one of its"
        rf" modes, ${product} = {sp.prod(counts)}$ in all; in every combination the equations are"
        " smooth. Where a condition comes true the mode changes, at a located instant: first rates"
        " that reversed come to rest, then contacts switch, then what rests breaks away or sticks."
        if len(found) > 1
        else r"\section{Modes of friction and contact}In each of these modes the equations are"
        " smooth; where a condition comes true the mode changes, at a located instant."
    )
    return "\n".join([opening, *map(_written, found)])


def automata(equations: Equations) -> list[Automaton]:
    """The modes of every friction, contact and switch, with the conditions that a run watches."""
    if not equations.mode_symbols:
        return []
    solve = solve_accelerations(equations)
    places = [real(f"alpha_{place_of(rate)}") for rate in equations.rates]
    names: dict[sp.Expr, sp.Expr] = dict(zip(solve.accelerations, places, strict=True))
    masses = {symbol for symbol in solve.mass.free_symbols if symbol not in names}
    names |= {real(name): e for name, e in solve.definitions if real(name) in masses}
    guards = [e.xreplace(names) for e in guard_expressions(equations, solve)]
    guards = [by_name(_with_sum(e, equations), equations) for e in guards]
    guards = [
        e.xreplace({part: part.args[0] for part in e.atoms(sp.UnevaluatedExpr)}) for e in guards
    ]
    found, at = [], 0
    for friction in equations.frictions:
        found.append(_friction(friction, guards[at : at + FRICTION_GUARDS]))
        at += FRICTION_GUARDS
    for contact in equations.contacts:
        own = _rigid_contact if contact.rigid else _sprung_contact
        found.append(own(contact))
    return found + [_switch(switch) for switch in equations.switches]


def _with_sum(guard: sp.Expr, equations: Equations) -> sp.Expr:
    """`guard` with the torque on a rate as one sum in it, where that is most of it."""
    for torque in equations.forcing:
        whole = sp.expand(torque)
        rest = sp.expand(sp.expand(guard) - whole)
        if len(sp.Add.make_args(rest)) < len(sp.Add.make_args(whole)) // 2:
            return rest + sp.UnevaluatedExpr(whole) if rest != 0 else guard
    return guard


def _friction(friction: Friction, guards: Sequence[sp.Expr]) -> Automaton:
    direction, rate = latex_of(slide(friction.axis)), latex_of(friction.rate)
    at = place_of(friction.rate)
    sliding, _, breakaway = (latex_of(s.left) for s in friction_statements(friction))
    holding, taken, limit, ahead, back = (
        latex_of(real(f"{name}_{at}"))
        for name in ("F_sticking", "F_friction", "F_limit", "F_ahead", "F_back")
    )
    return Automaton(
        f"Friction on ${rate}$",
        (
            Mode("slip back", f"{direction} = -1", f"+{sliding}", f"{rate} < 0"),
            Mode("stick", f"{direction} = 0", f"-{holding}", rf"-{back} \le {holding} \le {ahead}"),
            Mode("slip ahead", f"{direction} = 1", f"-{sliding}", f"{rate} > 0"),
        ),
        (
            Transition(0, 1, f"{rate} = 0"),
            Transition(1, 0, f"{holding} < -{back}"),
            Transition(1, 2, f"{holding} > {ahead}"),
            Transition(2, 1, f"{rate} = 0"),
        ),
        ((holding, guards[0]), (ahead, guards[1]), (back, guards[2])),
        rf"0 \le {direction}\,{rate} \;\perp\; {limit} - {direction}\,{taken} \ge 0",
        rf"Friction takes up ${taken}$ of the torque that acts: at most ${limit}$, which is"
        rf" ${breakaway}$ at rest and ${sliding}$ while it slides, and all of that while it does.",
    )


def _sprung_contact(contact: Contact) -> Automaton:
    face, on = latex_of(contact.side), latex_of(contact.active)
    apart, half, passed = (
        latex_of(real(f"{name}_{contact.axis}"))
        for name in ("separation", "half_gap", "T_transmitted")
    )
    torque = latex_of(shaft_torque(contact))
    return Automaton(
        f"Contact in the {contact.axis} drive, with a shaft",
        (
            Mode("gap", rf"{face} = 0,\ {on} = 0", "0", rf"|{apart}| \le {half}"),
            Mode("contact", rf"{face} = \pm 1,\ {on} = 1", torque, rf"{face}\,{torque} \ge 0"),
            Mode(
                "off its face",
                rf"{face} = \pm 1,\ {on} = 0",
                "0",
                rf"{face}\,{torque} \le 0,\ {face}\,{apart} \ge {half}",
            ),
        ),
        (
            Transition(0, 1, rf"|{apart}| > {half}"),
            Transition(1, 2, rf"{face}\,{torque} < 0"),
            Transition(2, 1, rf"{face}\,{torque} > 0"),
            Transition(2, 0, rf"{face}\,{apart} < {half}", "bend left=35"),
        ),
        ((apart, contact.separation), (half, contact.half_gap), (torque, contact.torque)),
        rf"0 \le {face}\,{passed} \;\perp\; {face}\,({passed} - {torque}) \ge 0",
        rf"The shaft transmits ${passed}$, which is ${torque}$ where that pushes; it cannot pull.",
    )


def _rigid_contact(contact: Contact) -> Automaton:
    face, on = latex_of(contact.side), latex_of(contact.active)
    apart, half, passed, bounce = (
        latex_of(real(f"{name}_{contact.axis}"))
        for name in ("separation", "half_gap", "T_transmitted", "e")
    )
    rate = rate_latex(f"separation_{contact.axis}")
    away = f"{face}\\,{passed} < 0"
    strike = rf"|{apart}| = {half}"
    return Automaton(
        f"Contact in the {contact.axis} drive, rigid",
        (
            Mode("gap", f"{on} = 0", "0", rf"|{apart}| \le {half}"),
            Mode("contact", f"{face} = \\pm 1,\\ {on} = 1", passed, rf"{face}\,{passed} \ge 0"),
        ),
        (
            Transition(0, 0, rf"{strike}:\ {rate} \to -{bounce}\,{rate}", "loop left"),
            Transition(0, 1, rf"{strike},\ {rate} = 0"),
            Transition(1, 0, away),
        ),
        ((apart, contact.separation), (half, contact.half_gap), (bounce, contact.restitution)),
        rf"0 \le {half} - {face}\,{apart} \;\perp\; {face}\,{passed} \ge 0",
        rf"What is transmitted, ${passed}$, follows from the motion and cannot pull.",
    )


def _switch(switch: Switch) -> Automaton:
    deviation, threshold, drive = map(latex_of, (switch.deviation, switch.threshold, switch.drive))
    beyond, on = latex_of(side(switch.name)), latex_of(active(switch.name))
    return Automaton(
        rf"Switch \texttt{{{escaped(switch.name)}}}",
        (
            Mode("off", f"{on} = 0", "", rf"|{deviation}| \le {threshold}"),
            Mode("on", f"{beyond} = \\pm 1,\\ {on} = 1", "", rf"{beyond}\,{drive} > 0"),
        ),
        (
            Transition(0, 1, rf"{beyond}\,{deviation} > {threshold},\ {beyond}\,{drive} > 0"),
            Transition(1, 0, rf"{beyond}\,{drive} < 0"),
        ),
    )


def _written(own: Automaton) -> str:
    """The complementarity, the table of modes, the drawing, and what the letters stand for."""
    parts = [rf"\subsection*{{{own.title}}}"]
    if own.complementarity:
        parts.append(f"{own.words}\\begin{{align}}{own.complementarity}\\end{{align}}")
    told = any(m.holds for m in own.modes)
    head = ["mode", "values", *(["torque"] if told else []), "lasts while"]
    rows = [
        [m.name, f"${m.values}$", *([f"${m.holds}$"] if told else []), f"${m.lasts}$"]
        for m in own.modes
    ]
    parts += [table("l" * len(head), head, rows), _drawn(own)]
    if own.rows:
        parts.append("where" + numbered(own.rows))
    return "\n".join(parts)


def _drawn(own: Automaton) -> str:
    """The automaton in TikZ, modes from left to right."""
    lines = [r"\par\medskip\begin{center}\begin{tikzpicture}[modes]"]
    for k, mode in enumerate(own.modes):
        text = rf"{mode.name}\\${mode.values}$"
        lines.append(rf"\node[state] (m{k}) at ({APART * k}mm,0) {{{text}}};")
    for t in own.transitions:
        arrow = rf"\path[->] (m{t.start}) edge[{t.bend}] node {{${t.when}$}} (m{t.end});"
        lines.append(arrow)
    return "\n".join([*lines, r"\end{tikzpicture}\end{center}\par"])
