"""A small drawing of the law of an effect over its range, as vectors."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import sympy as sp

from ptp_symbolic.report.derivation.loops import loop
from ptp_symbolic.report.derivation.ranges import (
    RATES,
    FloatArray,
    Setting,
    evaluated,
    extent,
    setting,
    unit_of,
)
from ptp_symbolic.report.latex_text import unit_latex
from ptp_symbolic.symbolic.derivation.equations import Contact, Equations
from ptp_symbolic.symbolic.documents.comparison import Change
from ptp_symbolic.symbolic.documents.latex import latex_of, symbol_latex
from ptp_symbolic.symbolic.documents.laws import Law
from ptp_symbolic.symbolic.documents.statements import shaft_torque
from ptp_symbolic.symbolic.effect_interface.contribution import Friction
from ptp_symbolic.symbolic.effect_interface.place import slide
from ptp_symbolic.symbolic.mechanics import kinematics
from ptp_symbolic.symbolic.symbols import real

PACKAGES = r"""\usepackage{pgfplots}
\pgfplotsset{compat=1.15}
\pgfplotsset{law/.style={width=80mm, height=46mm, axis lines=left, tick label style={font=\small},
  label style={font=\small}, no markers, enlargelimits=0.06, scaled ticks=true,
  every axis plot/.append style={thick}}}"""
POINTS = 121
THINNED = 40  # of a loop, every so many points are drawn
WITH, WITHOUT, STUCK = "black", "black!55, dashed", "black, densely dotted"
Line = tuple[FloatArray, FloatArray, str]  # abscissa, ordinate, style


@dataclass(frozen=True)
class Drawing:
    """Lines over an abscissa, the labels of the two axes in LaTeX, and what the lines are."""

    lines: tuple[Line, ...]
    across: str
    up: str
    caption: str


def curve(law: Law, added: Sequence[Change], equations: Equations) -> str:
    """The law drawn, with a line below that says what is drawn; empty where nothing varies."""
    drawing = drawing_of(law, added, equations)
    if drawing is None:
        return ""
    plots = [
        rf"\addplot[{style}] coordinates {{{_coordinates(x, y)}}};" for x, y, style in drawing.lines
    ]
    return "\n".join(
        [
            r"\par\nopagebreak\smallskip\begin{tikzpicture}",
            rf"\begin{{axis}}[law, xlabel={{{drawing.across}}}, ylabel={{{drawing.up}}}]",
            *plots,
            r"\end{axis}\end{tikzpicture}\par\nopagebreak",
            rf"{{\small {drawing.caption}}}\par",
        ]
    )


def drawing_of(law: Law, added: Sequence[Change], equations: Equations) -> Drawing | None:
    """The curve that shows the law best; None where nothing varies. `added` are the changes of the
    equations where the effect is added.
    """
    given = setting(law, equations)
    drawing = next((d for d in _drawings(law, added, equations, given) if _varies(d)), None)
    if drawing is None or not given.replaced:
        return drawing
    starts = ", ".join(
        f"${symbol_latex(p.name)} = {p.starts[-1]:g}$ {unit_latex(p.unit)}".rstrip()
        for p in given.replaced
        if p.starts[-1]
    )
    note = f"{drawing.caption} As declared it vanishes; it is drawn with {starts}."
    return replace(drawing, caption=note)


def _varies(drawing: Drawing) -> bool:
    return any(np.ptp(y) > 1e-12 * max(1e-300, np.abs(y).max()) for _, y, _ in drawing.lines)


def _coordinates(x: FloatArray, y: FloatArray) -> str:
    return " ".join(f"({a:.5g},{b:.5g})" for a, b in zip(x, y, strict=True))


def _label(symbol: str, unit: str) -> str:
    set_unit = unit_latex(unit)
    return f"${symbol}$ in {set_unit}" if set_unit else f"${symbol}$"


def _drawings(
    law: Law, added: Sequence[Change], equations: Equations, given: Setting
) -> Iterator[Drawing]:
    """What there is to draw, the most telling first."""
    own = law.contribution
    for before, after in law.frictions:
        yield _friction(before, after, given, equations)
    for contact in equations.contacts:
        if own.plays or f"half_gap_{contact.axis}" in own.changes:
            yield from _dead_zone(contact, given, equations)
    torques = [r for r in law.rows if str(r.left).startswith("T_")]
    for row in torques:
        yield from _hysteresis(law, row.left, row.right, given, equations)
    for row in torques:
        yield from _over(row.left, row.right, None, equations.unit("N m"), given, equations)
    for before, after in law.changes.values():
        unit = unit_of(before, equations) if before.is_Symbol else ""
        name = before if before.is_Symbol else real("change")
        yield from _over(name, after, before, unit, given, equations)
    for state in own.states:
        name = sp.Symbol(str(state.symbol))
        yield from _over(
            name, state.derivative, None, f"{state.unit}/s", given, equations, r"\dot "
        )
    for change in added:
        if change.statement.sums:
            value = change.statement.right if change.added is None else change.added
            unit = "kg m^2" if change.statement.key[0] == "mass" else "N m"
            left = change.statement.left
            yield from _over(left, value, None, equations.unit(unit), given, equations, r"\Delta ")


def _over(
    left: sp.Symbol,
    right: sp.Expr,
    before: sp.Expr | None,
    unit: str,
    given: Setting,
    equations: Equations,
    mark: str = "",
) -> Iterator[Drawing]:
    """`right` over each symbol that it varies with, the others at zero; `before` beside, if any."""
    fixed = {*given.values, *equations.mode_symbols}
    variables = sorted(right.free_symbols - fixed, key=_by_kind)
    for variable in variables:
        span = np.linspace(*extent(variable, right, given, equations), POINTS)
        lines: list[Line] = [(span, evaluated(right, {variable: span}, given), WITH)]
        if before is not None:
            lines.insert(0, (span, evaluated(before, {variable: span}, given), WITHOUT))
        across = _label(latex_of(variable), unit_of(variable, equations))
        others = [f"${latex_of(s)}$" for s in variables if s != variable]
        at_zero = f" {', '.join(others)} at zero." if others else ""
        words = f"${mark}{latex_of(left)}$ over ${latex_of(variable)}$."
        if before is not None and lines[0][1].any():
            words = f"With the effect (solid) and without (dashed), over ${latex_of(variable)}$."
        yield Drawing(
            tuple(lines), across, _label(f"{mark}{latex_of(left)}", unit), words + at_zero
        )


def _by_kind(symbol: sp.Symbol) -> tuple[bool, bool, str]:
    """Rates first, then angles, then all else."""
    name = str(symbol)
    return not name.startswith("omega"), not name.startswith("theta"), name


def _friction(
    before: Friction | None, after: Friction, given: Setting, equations: Equations
) -> Drawing:
    """Dry friction over its rate, for both directions, and at rest up to breakaway."""
    direction, rate = slide(after.axis), after.rate
    span = np.array(extent(rate, after.level, given, equations))
    lines: list[Line] = []
    branches = [(after, WITH)] if before is None else [(before, WITHOUT), (after, WITH)]
    for friction, style in branches:
        for end in (-1.0, 1.0):
            x = np.linspace(0.0, end * np.abs(span).max(), POINTS // 2)
            y = evaluated(friction.level, {rate: x, direction: np.full_like(x, end)}, given)
            lines.append((x, end * y, style))
    rest = np.zeros(2)
    ends = {rate: rest, direction: np.array([-1.0, 1.0])}
    lines.append((rest, ends[direction] * evaluated(after.breakaway, ends, given), STUCK))
    names = latex_of(direction), latex_of(rate)
    caption = rf"Friction ${names[0]} F$ over the rate ${names[1]}$; dotted, what it holds at rest."
    if before is not None:
        caption += " Dashed: without the effect."
    up = _label(f"{names[0]} F", equations.unit("N m"))
    return Drawing(tuple(lines), _label(names[1], equations.unit("rad/s")), up, caption)


def _dead_zone(contact: Contact, given: Setting, equations: Equations) -> Iterator[Drawing]:
    """What a shaft with play transmits over the angle across it, at rest."""
    if contact.rigid:
        return
    half = float(evaluated(contact.half_gap, {real("unused"): np.zeros(1)}, given)[0])
    apart = 2.0 * half * np.linspace(-1.0, 1.0, POINTS)
    touched = np.sign(apart) * (np.abs(apart) > half)
    gear = kinematics.gear_angle(contact.axis)
    torque = evaluated(contact.torque, {gear: apart, contact.side: touched}, given)
    lines = ((apart, np.where(touched == 0.0, 0.0, torque), WITH),)
    symbol = symbol_latex(f"separation_{contact.axis}")
    name = latex_of(shaft_torque(contact))
    caption = rf"${name}$, which the shaft transmits at rest, over the angle across the gap."
    units = equations.unit("rad"), equations.unit("N m")
    yield Drawing(lines, _label(symbol, units[0]), _label(name, units[1]), caption)


def _hysteresis(
    law: Law, left: sp.Symbol, right: sp.Expr, given: Setting, equations: Equations
) -> Iterator[Drawing]:
    """A torque that depends on states of the effect, along a slow oscillation."""
    own = law.contribution
    states = tuple(s for s in own.states if right.has(s.symbol))
    rates = {real(f"twist_rate_{law.axis}"), *RATES}
    driving = sorted({r for s in states for r in s.derivative.free_symbols & rates}, key=str)
    if len(driving) != 1:
        return
    found = loop(states, own.switches, driving[0], given)
    if found is None:
        return
    position = real(str(driving[0]).replace("omega", "theta").replace("twist_rate", "twist"))
    points: Mapping[sp.Symbol, FloatArray] = {**found.points, position: found.position}
    drawn = found.position[::THINNED], evaluated(right, points, given)[::THINNED]
    lines = ((*drawn, WITH),)
    words = (
        f"${latex_of(left)}$ over ${latex_of(position)}$ along a slow oscillation that begins with"
        " all states at zero."
    )
    across = _label(latex_of(position), equations.unit("rad"))
    yield Drawing(lines, across, _label(latex_of(left), equations.unit("N m")), words)
