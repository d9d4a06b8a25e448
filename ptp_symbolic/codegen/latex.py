"""Formulas for documents: LaTeX, MathML and plain text, all printed from the expressions."""

import re
from dataclasses import replace
from typing import Any

import sympy as sp
from sympy.printing.mathml import mathml

from ptp_symbolic.derivation.assembly import assemble
from ptp_symbolic.derivation.equations import Equations
from ptp_symbolic.platform import Platform

GREEK = {"theta", "omega", "tau", "alpha", "beta"}
DERIVATIVES = {"dc": r"\Delta c", "dF": r"\Delta F"}


def symbol_latex(name: str) -> str:
    """LaTeX of a symbol name: ``theta_gear_pan`` becomes a theta with an upright subscript."""
    letter, *place = name.split("_")
    trailing = re.fullmatch(r"([A-Za-z]+)(\d+)", letter)
    if trailing:
        letter, place = trailing[1], [trailing[2], *place]
    head = DERIVATIVES.get(letter, rf"\{letter}" if letter in GREEK else letter)
    if not place:
        return head
    words = ",".join(rf"\mathrm{{{word}}}" for word in place)
    return f"{head}_{{{words}}}"


def latex_of(expression: sp.Expr) -> str:
    """LaTeX of an expression, symbols as `symbol_latex` writes them."""
    expression = _with_decimals(expression)
    names = {s: symbol_latex(str(s)) for s in expression.free_symbols}
    return str(sp.latex(expression, symbol_names=names, order="lex"))


def _with_decimals(expression: sp.Expr) -> sp.Expr:
    """`expression` with measured numbers such as 981/100 as decimals; simple fractions stay."""
    return expression.xreplace(
        {
            number: sp.sign(number) * sp.Symbol(repr(float(abs(number))))
            for number in expression.atoms(sp.Rational)
            if number.q % 10 == 0
        }
    )


def plain_text_of(expression: sp.Expr) -> str:
    """One line of text, names as in the emitted module."""
    return str(sp.sstr(_with_decimals(expression), order="lex"))


def mathml_of(expression: sp.Expr) -> str:
    """Presentation MathML of an expression."""
    return str(mathml(_with_decimals(expression), printer="presentation"))


def effect_equations(platform: Platform, effect: str, axis: str | None) -> list[dict[str, Any]]:
    """What one declared effect adds to the equations: the difference with and without it."""
    rest = tuple(e for e in platform.effects if (e.effect, e.axis) != (effect, axis))
    with_it = assemble(platform)
    own = {n for e in with_it.effects if (e.effect.id, e.axis) == (effect, axis)
           for n in e.parameters}  # fmt: skip
    kept = tuple(p for p in platform.parameters if p.name not in own)
    without = assemble(replace(platform, effects=rest, parameters=kept))
    rows = []
    for what, after, before in _pairs(with_it, without):
        difference = sp.factor_terms(sp.expand(after - before))
        if difference != 0:
            rows.append(
                {
                    "title": f"added to {what}",
                    "effect": effect,
                    "latex": latex_of(difference),
                    "text": plain_text_of(difference),
                    "mathml": mathml_of(difference),
                }
            )
    return rows


def _pairs(with_it: Equations, without: Equations) -> list[tuple[str, sp.Expr, sp.Expr]]:
    pairs = [
        (f"the torque on {rate}", a, b)
        for rate, a, b in zip(with_it.rates, with_it.forcing, without.forcing, strict=True)
    ]
    size = len(with_it.rates)
    pairs += [
        (f"the mass matrix, entry {i + 1}, {j + 1}", with_it.mass_matrix[i, j],
         without.mass_matrix[i, j])
        for i in range(size) for j in range(i, size)
    ]  # fmt: skip
    for a, b in zip(with_it.frictions, without.frictions, strict=False):
        pairs.append((f"the sliding friction on {a.rate}", a.level, b.level))
        pairs.append((f"the breakaway torque on {a.rate}", a.breakaway, b.breakaway))
    for c, d in zip(with_it.contacts, without.contacts, strict=False):
        pairs.append((f"the half gap of {c.axis}", c.half_gap, d.half_gap))
    return pairs
