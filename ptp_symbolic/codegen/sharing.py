"""Share common subexpressions among definitions and outputs, and name them readably."""

import re
from collections.abc import Iterable, Iterator, Sequence

import sympy as sp

Line = tuple[str, sp.Expr]
MAX_NAME = 32


def share(definitions: Sequence[Line], outputs: Sequence[Line]) -> list[Line]:
    """Return the assignments that compute `outputs`, each name assigned before it is used.

    `definitions` name intermediate results (a determinant, an acceleration) that outputs may use;
    those that nothing uses are dropped. Targets of outputs keep their text, e.g. ``dx[0]``.
    """
    expressions = [expression for _, expression in (*definitions, *outputs)]
    replacements, reduced = sp.cse(expressions, symbols=_numbered(), order="canonical")
    named = [(str(symbol), expression) for symbol, expression in replacements]
    count = len(definitions)
    defined = [(name, e) for (name, _), e in zip(definitions, reduced[:count], strict=True)]
    final = [(name, e) for (name, _), e in zip(outputs, reduced[count:], strict=True)]
    ordered = _ordered([*named, *defined], final)
    return _renamed(ordered, {name for name, _ in definitions})


def _numbered() -> Iterator[sp.Symbol]:
    number = 0
    while True:
        yield sp.Symbol(f"shared:{number}", real=True)
        number += 1


def _ordered(available: Sequence[Line], final: Sequence[Line]) -> list[Line]:
    """Depth-first from the outputs: only what is needed, each before its use."""
    by_name = dict(available)
    done: dict[str, sp.Expr] = {}

    def visit(expression: sp.Expr) -> None:
        for symbol in sorted(expression.free_symbols, key=_natural):
            name = str(symbol)
            if name in by_name and name not in done:
                visit(by_name[name])
                done[name] = by_name[name]

    lines: list[Line] = []
    for target, expression in final:
        before = len(done)
        visit(expression)
        lines.extend(list(done.items())[before:])
        lines.append((target, expression))
    return lines


def _natural(symbol: sp.Symbol) -> list[object]:
    parts = re.split(r"(\d+)", str(symbol))
    return [(0, int(part), "") if part.isdigit() else (1, 0, part) for part in parts]


def _renamed(lines: Iterable[Line], kept: set[str]) -> list[Line]:
    lines = list(lines)
    final_use = _first_target(lines)
    names: dict[sp.Symbol, sp.Symbol] = {}
    taken = {str(s) for _, e in lines for s in e.free_symbols} | kept
    result: list[Line] = []
    for name, expression in lines:
        expression = expression.xreplace(names)
        if not name.startswith("shared:"):
            result.append((name, expression))
            continue
        readable = _unused(_describe(expression) or f"part_of_{final_use[name]}", taken)
        taken.add(readable)
        names[sp.Symbol(name, real=True)] = sp.Symbol(readable, real=True)
        result.append((readable, expression))
    return result


def _first_target(lines: Sequence[Line]) -> dict[str, str]:
    """For every shared term, a word for what it is first used in."""
    first: dict[str, str] = {}
    for name, expression in reversed(lines):
        word = first.get(name, name) if name.startswith("shared:") else name
        word = re.sub(r"\W+", "_", word).strip("_")
        for symbol in expression.free_symbols:
            first[str(symbol)] = word
    return first


def _unused(name: str, taken: set[str]) -> str:
    if name not in taken:
        return name
    number = 2
    while f"{name}_{number}" in taken:
        number += 1
    return f"{name}_{number}"


def _describe(expression: sp.Expr) -> str | None:
    """A name such as ``cos_tilt`` or ``omega_pan_sq``, or None where none would be readable."""
    if isinstance(expression, sp.sin | sp.cos | sp.exp) and expression.args[0].is_Symbol:
        word = type(expression).__name__
        return f"{word}_{str(expression.args[0]).removeprefix('theta_')}"
    if expression.is_Pow and expression.base.is_Symbol:
        suffix = {2: "sq", 3: "cubed", -1: "inverse"}.get(expression.exp)
        return None if suffix is None else f"{expression.base}_{suffix}"
    if expression.is_Mul and all(a.is_Symbol or a == -1 for a in expression.args):
        factors = [str(a) for a in expression.args if a.is_Symbol]
        sign = "minus_" if len(factors) < len(expression.args) else ""
        name = sign + "_".join(sorted(factors))
        return name if len(name) <= MAX_NAME else None
    return None
