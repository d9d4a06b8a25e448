"""The equations linearised: operating points, poles, natural frequencies, Bode plots."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ptp_symbolic.report.derivation.bode import (
    BodeLine,
    bode_figure,
    frequencies,
    frequency_response,
)
from ptp_symbolic.report.latex_text import displayed, number_latex, table, unit_latex
from ptp_symbolic.symbolic.derivation.equations import Equations
from ptp_symbolic.symbolic.derivation.linearisation import (
    LinearModel,
    OperatingPoint,
    linear_models,
)
from ptp_symbolic.symbolic.documents.latex import symbol_latex
from ptp_symbolic.symbolic.mechanics import kinematics

LOWEST, HIGHEST = 0.01, 1000.0  # Hz that a Bode plot shows at most
ROUNDING = 1e-10  # size of a pole that is zero, relative to A
MOST_COLUMNS = 6  # of a matrix that is printed
BALANCED = 1e-6  # rate of change at an operating point that counts as none


@dataclass(frozen=True)
class Pole:
    """A pole in 1/s, and how often it is one; of a pair the one above the real axis."""

    value: complex
    count: int = 1


def linearised(
    equations: Equations, points: Sequence[OperatingPoint]
) -> tuple[str, dict[str, bytes]]:
    """Section with poles and Bode plots about `points`, and the files of its figures."""
    models = linear_models(equations, points)
    names = [_name(equations, point) for point in points]
    rows = [
        row
        for name, model in zip(names, models, strict=True)
        for row in _pole_rows(name, poles(model), equations)
    ]
    head = ["operating point", "pole in 1/s", "natural frequency", "damping ratio", ""]
    plots, files = _plots(equations, models, names)
    text = [
        r"\section{Linearisation}" + _mode_words(equations, points),
        table("L{36mm}rrrl", head, rows),
        _held(models, names),
        _matrices(models[0], names[0]),
        *plots,
    ]
    return "\n".join(filter(None, text)), files


def poles(model: LinearModel) -> list[Pole]:
    """The poles of `model`, slowest first; those that only rounding keeps from zero are zero.

    Angles on which nothing depends are integrators, and counted before eigenvalues are taken: a
    double pole at zero would be torn apart by rounding.
    """
    A, free = model.A, 0
    while len(A) and (still := np.flatnonzero(~A.any(axis=0))).size:
        A = np.delete(np.delete(A, still, axis=0), still, axis=1)
        free += len(still)
    values = np.linalg.eigvals(A) if len(A) else np.zeros(0)
    zero = np.abs(values) <= ROUNDING * np.linalg.norm(model.A)
    count = free + int(np.count_nonzero(zero))
    rest = [complex(v) for v in values[~zero] if v.imag >= 0.0]
    rest.sort(key=lambda v: (abs(v), v.real))
    return [*([Pole(0j, count)] if count else []), *map(Pole, rest)]


def _name(equations: Equations, point: OperatingPoint) -> str:
    """An operating point in a few words of LaTeX."""
    sliding = equations.rigid.sliding
    angles = [
        rf"${symbol_latex(f'theta_{axis}')}={_angle(value, axis in sliding)}$"
        for axis, value in point.angles.items()
        if axis in equations.axes and (value or axis == "tilt")
    ]
    rates = [
        rf"${symbol_latex(f'omega_{axis}')}={rate:g}$\,{unit_latex(equations.unit('rad/s'))}"
        for axis, rate in point.rates.items()
        if rate
    ]
    return ", ".join([*angles, *(rates or ["at rest"])])


def _angle(value: float, linear: bool) -> str:
    return rf"{value:g}\,\mathrm{{m}}" if linear else rf"{math.degrees(value):.4g}^\circ"


def _mode_words(equations: Equations, points: Sequence[OperatingPoint]) -> str:
    """What is linearised, and in which mode."""
    words = [
        r"Small deviations $x$ of the states and $u$ of the inputs from an operating point follow"
        r" $\dot x = A\,x + B\,u$; $A$ and $B$ are the derivatives of the equations above. Inputs"
        " and internal states are those that hold the rates given; where an angle then grows, the"
        " linear model is that of the instant."
    ]
    if equations.frictions:
        sliding = any(p.sliding for p in points)
        words.append(
            " Dry friction has no derivative at rest: there it is left out, as if it were less than"
            " what moves the machine."
        )
        if sliding:
            words.append(
                " Where rates are given it slides forwards, and counts with its slope over them."
            )
    if equations.contacts:
        words.append(" Gaps are closed at their upper face: within them the load is free.")
    if equations.switches:
        words.append(" Elements that slip stick.")
    if equations.samplers:
        words.append(" What samplers set is an input: the loop is open.")
    if any(delay is not None for delay in equations.delays):
        words.append(" Delays of inputs show in the phase alone.")
    return "".join(words)


def _pole_rows(name: str, found: Sequence[Pole], equations: Equations) -> list[list[str]]:
    rows: list[list[str]] = []
    for pole in found:
        s, size = pole.value, abs(pole.value)
        if s == 0:
            times = "" if pole.count == 1 else rf", {pole.count} times"
            cells = ["$0$", "", "", f"integrates{times}"]
        elif s.imag:
            sign = r"\pm"
            written = rf"${number_latex(s.real)} {sign} {number_latex(s.imag)}\,\mathrm{{i}}$"
            kind = "oscillates" if s.real < 0 else "grows, oscillating"
            cells = [written, _hertz(size), f"{-s.real / size:.3f}", kind]
        else:
            kind = "decays" if s.real < 0 else "grows"
            time = rf"{kind} in ${number_latex(1.0 / size)}$\,s"
            cells = [f"${number_latex(s.real)}$", "", "", time]
        rows.append(["" if rows else rf"\addlinespace {name}", *cells])
    return rows


def _hertz(size: float) -> str:
    return rf"${number_latex(size / (2.0 * math.pi))}$\,Hz"


def _held(models: Sequence[LinearModel], names: Sequence[str]) -> str:
    """Where no input holds an operating point."""
    loose = [n for n, m in zip(names, models, strict=True) if m.unbalanced > BALANCED]
    if not loose:
        return ""
    return rf"\par No input holds the machine at {'; '.join(loose)}: there it accelerates."


def _matrices(model: LinearModel, name: str) -> str:
    """A and B in numbers, at the first operating point; empty of a machine with many states."""
    if len(model.states) > MOST_COLUMNS:
        return ""
    states, inputs = (
        ",\\; ".join(symbol_latex(str(s)) for s in own) for own in (model.states, model.inputs)
    )
    order = rf"$x=({states})$" + (rf" and $u=({inputs})$" if model.inputs else "")
    both = [("A", model.A), ("B", model.B)][: 1 + bool(model.inputs)]
    written = r",\qquad ".join(rf"{letter} = {_matrix(values)}" for letter, values in both)
    where = name if name.startswith("at ") else f"at {name}"
    return rf"\par {where[:1].upper()}{where[1:]}, with {order}:{{\small{displayed(written)}}}"


def _matrix(values: np.ndarray) -> str:
    rows = (" & ".join(number_latex(value) for value in row) for row in values + 0.0)
    inside = r" \\ ".join(rows)
    return rf"\begin{{bmatrix}}{inside}\end{{bmatrix}}"


def _plots(
    equations: Equations, models: Sequence[LinearModel], names: Sequence[str]
) -> tuple[list[str], dict[str, bytes]]:
    """A Bode plot for every input, from it to the angle of its axis."""
    units = {i.name: i.unit for i in equations.inputs}
    units |= {s.name: s.unit for s in equations.extra_states}
    late = {i.symbol: delay for i, delay in zip(equations.inputs, equations.delays, strict=True)}
    values = {p.symbol: p.default for p in equations.parameters}
    texts, files = [], {}
    for given in models[0].inputs:
        axis = next((a for a in equations.axes if given.name.endswith(f"_{a}")), equations.axes[0])
        angle = kinematics.angle(axis)
        every = [p.value for m in models for p in poles(m)]
        at = frequencies(every, LOWEST, HIGHEST)
        delay = late.get(given)
        seconds = 0.0 if delay is None else float(delay.xreplace(values))
        lines = []
        for model, name in zip(models, names, strict=True):
            column = model.B[:, model.inputs.index(given)]
            row = model.states.index(angle)
            response = frequency_response(model.A, column, row, at, seconds)
            if np.any(response):
                lines.append(BodeLine(_plot_words(name), response))
        written = rf"${symbol_latex(str(angle))}$ per ${symbol_latex(given.name)}$"
        if not lines:
            texts.append(rf"\par {written}: no answer, the drive is in its dead band.")
            continue
        unit = f"{equations.unit('rad')}/{units[given.name]}".replace("N m", "(N m)")
        name = f"bode-{given.name.replace('_', '-')}"
        files[f"{name}.pdf"] = bode_figure(written, unit, at, lines)
        texts.append(
            rf"\par\noindent\begin{{minipage}}{{\linewidth}}\centering"
            rf"\includegraphics{{{name}.pdf}}\end{{minipage}}"
        )
    return texts, files


def _plot_words(name: str) -> str:
    """The name of an operating point for a legend of matplotlib."""
    return name.replace(r"\,", " ")
