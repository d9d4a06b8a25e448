"""Count the operations of expressions, written out or with common subexpressions shared."""

from collections.abc import Iterable, Sequence

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
    terms = [term for _, term in shared]
    names = sp.numbered_symbols("shared_", real=True)
    replacements, reduced = sp.cse([*terms, *expressions], symbols=names, order="canonical")
    named = zip((name for name, _ in shared), reduced[: len(terms)], strict=True)
    return _in_order_of_use([*replacements, *named]), list(reduced[len(terms) :])


def _in_order_of_use(lines: Sequence[Line]) -> list[Line]:
    """The same lines, each after all those that it uses."""
    by_name = dict(lines)
    ordered: dict[sp.Symbol, sp.Expr] = {}

    def visit(name: sp.Symbol) -> None:
        if name in ordered:
            return
        for used in sorted(by_name[name].free_symbols & by_name.keys(), key=str):
            visit(used)
        ordered[name] = by_name[name]

    for name, _ in lines:
        visit(name)
    return list(ordered.items())
