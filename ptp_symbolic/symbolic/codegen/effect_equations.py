"""What one effect does to the equations of a machine: by comparison with and without it."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import sympy as sp
from sympy.simplify.fu import TR10i

from ptp_symbolic.platform import Platform
from ptp_symbolic.symbolic.codegen.latex import latex_lines, mathml_lines, plain_text_of
from ptp_symbolic.symbolic.codegen.statements import Statement, statements, with_definitions
from ptp_symbolic.symbolic.derivation.assembly import assemble

MANY_TERMS = 12


def effect_equations(platform: Platform, effect: str, axis: str | None) -> list[dict[str, Any]]:
    """What one declared effect adds, and in whole every equation that it changes.

    Rows of title, effect, latex, text, mathml, and whether it is a detail. A friction law is shown
    with all its branches.
    """
    rest = tuple(e for e in platform.effects if (e.effect, e.axis) != (effect, axis))
    with_it = assemble(platform)
    own = {
        n for e in with_it.effects if (e.effect.id, e.axis) == (effect, axis) for n in e.parameters
    }
    kept = tuple(p for p in platform.parameters if p.name not in own)
    before = {
        s.key: s for s in statements(assemble(replace(platform, effects=rest, parameters=kept)))
    }
    found = statements(with_it)
    changed = {s.key for s in found if _differs(s, before)}
    # a friction law is read as one, and with the torque that it acts against
    laws = {key[1] for key in changed if key[0] == "friction"}
    shown = [
        s
        for s in found
        if s.key in changed or (s.key[0] in ("friction", "torque") and s.key[1] in laws)
    ]
    rows = []
    for s in with_definitions(shown, found):
        added = _change(s, before) if s.key in changed else []
        rows += [_row(effect, *printed) for printed in added]
        title = s.name + (", in whole" if s.sums else "")
        # what a reader may skip: a long sum where what is added to it is shown, what names mean
        long = s.key[0] == "mass" or len(sp.Add.make_args(s.right)) > MANY_TERMS
        detail = s not in shown or bool(added and long)
        rows.append(_row(effect, title, s.latex, s.text, s.mathml, detail))
    return rows


def _differs(statement: Statement, before: Mapping[tuple[str, ...], Statement]) -> bool:
    old = before.get(statement.key)
    if old is None:
        return bool(statement.right != 0)
    return bool(old.right != statement.right and sp.expand(statement.right - old.right) != 0)


def _change(
    statement: Statement, before: Mapping[tuple[str, ...], Statement]
) -> list[tuple[str, str, str, str]]:
    """What is added to a sum: title, LaTeX, text, MathML; none where all of it is new."""
    old = before.get(statement.key)
    if not statement.sums or old is None or old.right == 0:
        return []
    new, gone = (set(sp.Add.make_args(e)) for e in (statement.right, old.right))
    as_written = sp.Add(*(new - gone)) - sp.Add(*(gone - new))
    difference = sp.expand(statement.right - old.right)
    # sums and differences of angles as one: sin a cos b + cos a sin b
    of_sums = sp.factor_terms(TR10i(difference))
    added = min(as_written, sp.factor_terms(difference), of_sums, key=sp.count_ops)
    lines = latex_lines(added)
    latex = " \\\\\n".join(lines)
    if len(lines) > 1:
        latex = f"\\begin{{gathered}}\n{latex}\n\\end{{gathered}}"
    return [
        (f"added to {statement.name}", latex, plain_text_of(added), "\n".join(mathml_lines(added)))
    ]


def _row(
    effect: str, title: str, latex: str, text: str, mathml: str, detail: bool = False
) -> dict[str, Any]:
    return {
        "title": title,
        "effect": effect,
        "latex": latex,
        "text": text,
        "mathml": mathml,
        "detail": detail,
    }
