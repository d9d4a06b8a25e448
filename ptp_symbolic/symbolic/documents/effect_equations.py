"""What one effect does to the equations of a machine: by comparison with and without it."""

from typing import Any

import sympy as sp

from ptp_symbolic.platform import Platform
from ptp_symbolic.symbolic.derivation.assembly import assemble
from ptp_symbolic.symbolic.derivation.removal import without_effect
from ptp_symbolic.symbolic.documents.comparison import comparison
from ptp_symbolic.symbolic.documents.latex import latex_lines, mathml_lines, plain_text_of
from ptp_symbolic.symbolic.documents.statements import Statement, statements, with_definitions

MANY_TERMS = 12


def effect_equations(platform: Platform, effect: str, axis: str | None) -> list[dict[str, Any]]:
    """What one declared effect adds, and in whole every equation that it changes.

    Rows of title, effect, latex, text, mathml, and whether it is a detail. A friction law is shown
    with all its branches.
    """
    rest, _ = without_effect(platform, effect, axis)
    found = statements(assemble(platform))
    changes = {
        c.statement.key: c for c in comparison(statements(assemble(rest)), found) if not c.gone
    }
    changed = changes.keys()
    # a friction law is read as one, and with the torque that it acts against
    laws = {key[1] for key in changed if key[0] == "friction"}
    shown = [
        s
        for s in found
        if s.key in changed or (s.key[0] in ("friction", "torque") and s.key[1] in laws)
    ]
    rows = []
    for s in with_definitions(shown, found):
        change = changes.get(s.key)
        added = None if change is None else change.added
        if added is not None:
            rows.append(_addition(effect, s, added))
        title = s.name + (", in whole" if s.sums else "")
        # what a reader may skip: a long sum where what is added to it is shown, what names mean
        long = s.key[0] == "mass" or len(sp.Add.make_args(s.right)) > MANY_TERMS
        detail = s not in shown or bool(added is not None and long)
        rows.append(_row(effect, title, s.latex, s.text, s.mathml, detail))
    return rows


def _addition(effect: str, statement: Statement, added: sp.Expr) -> dict[str, Any]:
    """What is added to a sum, as a row."""
    lines = latex_lines(added)
    latex = " \\\\\n".join(lines)
    if len(lines) > 1:
        latex = f"\\begin{{gathered}}\n{latex}\n\\end{{gathered}}"
    mathml = "\n".join(mathml_lines(added))
    return _row(effect, f"added to {statement.name}", latex, plain_text_of(added), mathml)


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
