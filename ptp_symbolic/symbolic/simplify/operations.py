"""Count the operations of expressions, written out or with common subexpressions shared."""

from collections.abc import Iterable, Sequence
from graphlib import TopologicalSorter

import sympy as sp

Line = tuple[sp.Symbol, sp.Expr]


def operation_count(expressions: Iterable[sp.Expr], shared: Sequence[Line] = ()) -> int:
    """Operations of `expressions` after joint sharing of common subexpressions.

    `shared` are named terms that the expressions may use; they count too. A division or a power
    counts one, sine and cosine count nothing: they are one call of sincos for all.
    """
    lines, outputs = share_subexpressions(expressions, shared)
    return sum(written_operations(e) for e in (*(term for _, term in lines), *outputs))


def written_operations(expression: sp.Expr) -> int:
    """Operations of `expression` as it is written, sine and cosine not counted."""
    functions = expression.atoms(sp.sin, sp.cos)
    opaque = {f: sp.Dummy() for f in functions if f.args[0].is_Symbol}
    return int(sp.count_ops(expression.xreplace(opaque)))


def share_subexpressions(
    expressions: Iterable[sp.Expr], shared: Sequence[Line] = ()
) -> tuple[list[Line], list[sp.Expr]]:
    """Return lines, each using those before it alone, and `expressions` in terms of the lines.

    `shared` are named terms, in order of use, that appear in `expressions`; they become lines.
    """
    found, named, reduced = common_subexpressions(
        [term for _, term in shared], expressions, "shared_"
    )
    lines = dict([*found, *zip((name for name, _ in shared), named, strict=True)])
    uses = {n: sorted(e.free_symbols & lines.keys(), key=str) for n, e in lines.items()}
    return [(name, lines[name]) for name in TopologicalSorter(uses).static_order()], reduced


def common_subexpressions(
    terms: Iterable[sp.Expr], expressions: Iterable[sp.Expr], prefix: str
) -> tuple[list[Line], list[sp.Expr], list[sp.Expr]]:
    """What `terms` and `expressions` have in common, named by `prefix` and a number, and both
    written with it.
    """
    terms = list(terms)
    names = sp.numbered_symbols(prefix, real=True)
    found, reduced = sp.cse([*terms, *expressions], symbols=names, order="canonical")
    return list(found), list(reduced[: len(terms)]), list(reduced[len(terms) :])
