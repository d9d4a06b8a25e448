"""Kernels: functions of a model as named assignments, before any language."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import sympy as sp

from ptp_symbolic.symbolic.derivation.equations import Equations
from ptp_symbolic.symbolic.program.sharing import Line, share
from ptp_symbolic.symbolic.program.term_names import vocabulary

MODE_ARGUMENTS = "t, x, u, p, m"
ENTRY = re.compile(r"(\w+)\[(\d+)(?:, (\d+))?\]")


class Entry(NamedTuple):
    """An entry of an array that a kernel writes."""

    array: str
    indices: tuple[int, ...]


class Assignment(NamedTuple):
    """A named term, or an entry of an array, and what it is set to."""

    target: str | Entry
    expression: sp.Expr


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

    def shape(self, argument: str) -> tuple[int, ...]:
        """Shape of an array that is an argument of a kernel."""
        if argument in self.rows:
            return tuple(int(n) for n in self.rows[argument][0].split(", "))
        if len(argument) == 1:
            return (len(getattr(self, argument)),)
        array, variable = argument[:-1], argument[-1]
        return (int(self.rows[array][0]), len(getattr(self, variable)))


@dataclass(frozen=True, eq=False)
class Kernel:
    """A function that computes `lines` in turn: named terms, each before it is used, and entries of
    the arrays that it writes. Entries that are zero whatever the arguments are not written.

    `arguments` are the time and the names of arrays, whose entries `vectors` names.
    """

    name: str
    arguments: tuple[str, ...]
    doc: str
    vectors: Vectors
    lines: tuple[Line, ...]

    @property
    def written(self) -> tuple[str, ...]:
        """Arguments that it writes, in their order."""
        return tuple(a for a in self.arguments if a not in "txupm" and not self.reads(a))

    def reads(self, argument: str) -> bool:
        """Whether an argument is read: c is, except where it is prepared."""
        return argument == "c" and self.name != "prepare"

    @property
    def finds_modes(self) -> bool:
        """Whether it is of the modes that the state implies, which are no argument of it."""
        return "m" not in self.arguments and bool(used_names(self.lines) & set(self.vectors.m))

    @property
    def body(self) -> tuple[Assignment, ...]:
        """The lines with their targets parsed."""
        return tuple(Assignment(_target(name), e) for name, e in self.lines)

    @property
    def unpacked(self) -> tuple[tuple[str, str, int], ...]:
        """Names that the lines use and do not assign, with array and index, states first."""
        used = used_names(self.lines) - {name for name, _ in self.lines}
        return tuple(
            (name, array, index)
            for array in "xupmc"
            for index, name in enumerate(getattr(self.vectors, array))
            if name in used
        )

    def restricted(self, name: str, doc: str, arrays: Sequence[str]) -> "Kernel":
        """The kernel that writes some of the `arrays` alone, without the terms of the others."""
        kept: list[Line] = []
        needed: set[str] = set()
        for (target, expression), assignment in reversed(
            list(zip(self.lines, self.body, strict=True))
        ):
            place = assignment.target
            wanted = place.array in arrays if isinstance(place, Entry) else target in needed
            if wanted:
                kept.append((target, expression))
                needed |= {str(symbol) for symbol in expression.free_symbols}
        arguments = tuple(a for a in self.arguments if a not in self.written or a in arrays)
        return Kernel(name, arguments, doc, self.vectors, tuple(reversed(kept)))


def kernel(name: str, arguments: str, doc: str, vectors: Vectors, lines: Sequence[Line]) -> Kernel:
    """The kernel `name` of `arguments`, as they stand between parentheses."""
    return Kernel(name, tuple(arguments.split(", ")), doc, vectors, tuple(lines))


def _target(name: str) -> str | Entry:
    entry = ENTRY.fullmatch(name)
    if entry is None:
        return name
    return Entry(entry[1], tuple(int(k) for k in entry.groups()[1:] if k is not None))


def variables(
    equations: Equations,
) -> list[tuple[str, tuple[sp.Symbol, ...]]]:
    """The symbols by which kernels are differentiated, by the letter of their array."""
    parameters = tuple(p.symbol for p in equations.parameters)
    inputs = tuple(i.symbol for i in equations.inputs)
    return [("x", equations.state_symbols), ("u", inputs), ("p", parameters)]


def shared_lines(
    equations: Equations, definitions: Sequence[Line], outputs: Sequence[Line]
) -> list[Line]:
    """The lines that compute those of `outputs` that are not zero, with terms in common."""
    present = [(t, e) for t, e in outputs if e != 0]
    return share(definitions, present, vocabulary(equations))


def used_names(lines: Sequence[Line]) -> set[str]:
    """Names of the symbols that `lines` use."""
    return {str(symbol) for _, expression in lines for symbol in expression.free_symbols}
