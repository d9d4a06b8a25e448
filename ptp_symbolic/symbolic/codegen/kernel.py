"""The source of one compiled function: what it unpacks, its named terms, what it writes."""

import textwrap
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import sympy as sp

from ptp_symbolic.symbolic.codegen.literals import WIDTH
from ptp_symbolic.symbolic.codegen.printer import print_expression, quotient
from ptp_symbolic.symbolic.codegen.sharing import Line

MODE_ARGUMENTS = "t, x, u, p, m"
DOC_WIDTH = WIDTH - 4


@dataclass(frozen=True)
class Vectors:
    """Names of the entries of the argument arrays of a kernel, and what it writes.

    `rows` has shape and unit by array; those of derivatives have the
    letter of the variable appended, ``gx`` to ``g``.
    """

    x: tuple[str, ...]
    u: tuple[str, ...]
    p: tuple[str, ...]
    m: tuple[str, ...]
    c: tuple[str, ...]
    rows: Mapping[str, tuple[str, str]] = field(default_factory=dict)

    def describe(self, argument: str) -> str:
        """Shape and unit of an argument of a kernel."""
        given = {
            "t": "t in s",
            "x": f"x [{len(self.x)}] in STATE_UNITS",
            "u": f"u [{len(self.u)}] in INPUT_UNITS",
            "p": f"p [{len(self.p)}] in the units of PARAMETERS",
            "m": f"m [{len(self.m)}], see MODE_NAMES",
            "c": f"c [{len(self.c)}] of prepare",
        }
        if argument in given:
            return given[argument]
        if argument in self.rows:
            shape, unit = self.rows[argument]
            return f"{argument} [{shape}] in {unit}"
        array, variable = argument[:-1], argument[-1]
        return f"{argument} [{self.rows[array][0]}, {len(getattr(self, variable))}]"

    def unpack(self, lines: Sequence[Line]) -> list[str]:
        """Assignments that unpack what `lines` use and do not assign, states first."""
        used = {str(symbol) for _, expression in lines for symbol in expression.free_symbols}
        used -= {name for name, _ in lines}
        return [
            f"{name} = {array}[{index}]"
            for array in "xupmc"
            for index, name in enumerate(getattr(self, array))
            if name in used
        ]


def kernel_text(
    name: str,
    arguments: str,
    doc: str,
    vectors: Vectors,
    lines: Sequence[Line],
    first: Sequence[str] = (),
) -> str:
    """A compiled function that runs the statements `first`, unpacks what it uses and assigns
    `lines` in turn.
    """
    shapes = "; ".join(vectors.describe(argument) for argument in arguments.split(", "))
    shapes = textwrap.fill(f"{shapes}.", DOC_WIDTH)
    rows = [f'"""{doc}\n\n{shapes}\n"""', *first, *vectors.unpack(lines)]
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
