"""Equations in LaTeX, with words above them, and those in which two machines differ."""

import re
from collections.abc import Sequence
from itertools import groupby

import sympy as sp

from ptp_symbolic.report.latex_text import escaped, numbered
from ptp_symbolic.symbolic.derivation.equations import Equations
from ptp_symbolic.symbolic.documents.comparison import Change
from ptp_symbolic.symbolic.documents.latex import symbol_latex
from ptp_symbolic.symbolic.documents.statements import MANY_TERMS, RELATIONS, Statement


def displayed_rows(rows: Sequence[Statement], equations: Equations) -> str:
    """Formulas with what they say in words above them, and the quantities of others they name."""
    parts = []
    for name, group in groupby(rows, key=lambda s: s.name):
        for relation, own in groupby(group, key=lambda s: s.relation):
            words = in_words(equations.worded(name[:1].upper() + name[1:]))
            formulas = numbered([(s.left_latex, s.right) for s in own], RELATIONS[relation][0])
            parts.append(rf"\par {words}:{formulas}")
    named = {symbol for s in rows for symbol in s.right.free_symbols}
    meant = [(symbol_latex(n), e) for n, e in equations.quantities if n in map(str, named)]
    if meant:
        parts.append("where" + numbered(meant))
    return "\n".join(parts)


def in_words(text: str) -> str:
    """Escaped text, names of symbols in it as they are printed in formulas."""
    return re.sub(
        r"\b([A-Za-z0-9]+(?:\\_[A-Za-z0-9]+)+)\b",
        lambda found: f"${symbol_latex(found[1].replace(chr(92), ''))}$",
        escaped(text).replace("±", r"$\pm$"),
    )


def displayed_changes(changes: Sequence[Change], elsewhere: str = "") -> str:
    """What one machine has that another has not, equation by equation; a sum of many terms by its
    name alone, where all equations of the machine stand in the section `elsewhere`.
    """
    parts = []
    for change in changes:
        statement, added = change.statement, _added(change)
        left, relation = statement.left_latex, RELATIONS[statement.relation][0]
        words = in_words(statement.name)
        if change.gone:
            gone = numbered([(left, change.statement.right)], relation)
            parts.append(rf"\par Gone: {words}:" + gone)
        elif added is not None:
            parts.append(
                rf"\par Added to {words}:" + numbered([(rf"\Delta {left}", added)], relation)
            )
        else:
            new = "New" if change.before is None else "Now"
            if elsewhere and len(sp.Add.make_args(statement.right)) > MANY_TERMS:
                parts.append(rf"\par {new}: {words}, as in section {elsewhere}.")
                continue
            parts.append(rf"\par {new}: {words}:" + numbered([(left, statement.right)], relation))
    return "\n".join(parts)


def _added(change: Change) -> sp.Expr | None:
    """What a statement gained, where that is a sum, or shorter than the whole by half."""
    if change.added is not None or change.before is None or change.gone:
        return change.added
    difference = sp.expand(change.statement.right - change.before)
    whole = len(sp.Add.make_args(change.statement.right))
    return difference if len(sp.Add.make_args(difference)) <= whole // 2 else None
