"""The source of one compiled function: what it unpacks, its named terms, what it writes."""

import textwrap
from collections.abc import Sequence
from dataclasses import dataclass

import sympy as sp

from ptp_symbolic.symbolic.codegen.literals import WIDTH
from ptp_symbolic.symbolic.codegen.printer import print_expression, quotient
from ptp_symbolic.symbolic.codegen.sharing import Line

MODE_ARGUMENTS = "t, x, u, p, m"


@dataclass(frozen=True)
class Vectors:
    """Names of the entries of the argument arrays of a kernel."""

    x: tuple[str, ...]
    u: tuple[str, ...]
    p: tuple[str, ...]
    m: tuple[str, ...]

    def unpack(self, lines: Sequence[Line]) -> list[str]:
        """Assignments that unpack what `lines` use, states first."""
        used = {str(symbol) for _, expression in lines for symbol in expression.free_symbols}
        return [
            f"{name} = {array}[{index}]"
            for array, names in (("x", self.x), ("u", self.u), ("p", self.p), ("m", self.m))
            for index, name in enumerate(names)
            if name in used
        ]


def kernel_text(
    name: str, arguments: str, doc: str, vectors: Vectors, lines: Sequence[Line]
) -> str:
    """A compiled function that unpacks what it uses and assigns `lines` in turn."""
    rows = [f'"""{doc}"""', *vectors.unpack(lines)]
    for target, expression in lines:
        rows.append(_assignment(target, expression))
    if not lines:
        rows.append("return")
    head = f'@njit(cache=True, error_model="numpy", nogil=True)\ndef {name}({arguments}):\n'
    return head + textwrap.indent("\n".join(rows), "    ")


def _assignment(target: str, expression: sp.Expr) -> str:
    source = print_expression(expression)
    if len(target) + len(source) + 7 <= WIDTH:
        return f"{target} = {source}"
    return "\n".join(_wrapped(target, expression))


def _wrapped(target: str, expression: sp.Expr) -> list[str]:
    """A long sum, one term per line; anything else in parentheses, broken at operators."""
    if expression.is_Add:
        terms = [print_expression(t) for t in expression.as_ordered_terms()]
        first, *rest = terms
        signed = [f"- {t[1:].strip()}" if t.startswith("-") else f"+ {t}" for t in rest]
        return [f"{target} = (", f"    {first}", *(f"    {t}" for t in signed), ")"]
    if not expression.is_Mul:
        return [f"{target} = {print_expression(expression)}"]
    negative, above, below = quotient(expression)
    rows = [f"    {'-' if negative else ''}{above[0]}", *(f"    * {f}" for f in above[1:])]
    return [f"{target} = (", *rows, *([f"    / {below}"] if below else []), ")"]
