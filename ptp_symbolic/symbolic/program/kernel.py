"""Kernels: functions of a model as named assignments, before any language."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple

import sympy as sp

from ptp_symbolic.symbolic.derivation.equations import Equations
from ptp_symbolic.symbolic.program.sharing import Line, share
from ptp_symbolic.symbolic.program.term_names import vocabulary

GIVEN = "given_"  # before the names of accelerations that are arguments
MODE_ARGUMENTS = "t, x, u, p, m"
ENTRY = re.compile(r"(\w+)\[(\d+)(?:, (\d+))?\]")


class Entry(NamedTuple):
    """An entry of an array that a kernel writes."""

    array: str
    indices: tuple[int, ...]

    def place(self, shape: Sequence[int]) -> int:
        """Its place in an array of this shape that is stored by rows."""
        place = 0
        for size, index in zip(shape, self.indices, strict=True):
            place = place * size + index
        return place

    def __str__(self) -> str:
        return f"{self.array}[{', '.join(map(str, self.indices))}]"


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

    def unpacked(self, lines: Sequence[Line]) -> tuple[tuple[str, str, int], ...]:
        """Names that `lines` use and do not assign, with array and index, states first."""
        used = used_names(lines) - {name for name, _ in lines}
        return tuple(
            (name, array, index)
            for array in "xupmc"
            for index, name in enumerate(getattr(self, array))
            if name in used
        )

    def shape(self, argument: str) -> tuple[int, ...]:
        """Shape of an array that is an argument of a kernel."""
        if argument in self.rows:
            return tuple(int(n) for n in self.rows[argument][0].split(", "))
        if len(argument) == 1:
            return (len(getattr(self, argument)),)
        array, variable = argument[:-1], argument[-1]
        return (int(self.rows[array][0]), len(getattr(self, variable)))


@dataclass(frozen=True, eq=False)
class Part:
    """Lines that kernels have in common: a function of `arguments` that returns the `results`."""

    name: str
    arguments: tuple[str, ...]
    doc: str
    vectors: Vectors
    lines: tuple[Line, ...]
    results: tuple[str, ...]

    @property
    def unpacked(self) -> tuple[tuple[str, str, int], ...]:
        """Names that the lines use and do not assign, with array and index, states first."""
        return self.vectors.unpacked(self.lines)


@dataclass(frozen=True, eq=False)
class Kernel:
    """A function that computes `lines` in turn: named terms, each before it is used, and entries of
    the arrays that it writes. Entries that are zero whatever the arguments are not written. What
    `parts` compute comes before its `own` lines.

    `arguments` are the time and the names of arrays, whose entries `vectors` names. Where an array
    of `optional` is empty, neither it nor those after it are asked for.
    """

    name: str
    arguments: tuple[str, ...]
    doc: str
    vectors: Vectors
    own: tuple[Line, ...]
    optional: tuple[str, ...] = ()
    parts: tuple[Part, ...] = ()

    @cached_property
    def lines(self) -> tuple[Line, ...]:
        """All lines: those of the parts that are needed, then its own."""
        return (*needed([line for part in self.parts for line in part.lines], self.own), *self.own)

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
        return _parsed(self.lines)

    def sections(
        self, lines: Sequence[Line]
    ) -> tuple[tuple[str | None, tuple[Assignment, ...]], ...]:
        """Some of its `lines` in parts: what is always computed, then what is computed where an
        optional array is asked for, with the name of the array.
        """
        order, body = self.arguments, _parsed(lines)
        starts: list[tuple[str | None, int]] = [(None, 0)]
        for array in self.optional:
            ends = [
                place + 1
                for place, (target, _) in enumerate(body)
                if isinstance(target, Entry) and order.index(target.array) < order.index(array)
            ]
            starts.append((array, max(ends, default=0)))
        stops = [*(start for _, start in starts[1:]), len(body)]
        parts = [(a, body[start:stop]) for (a, start), stop in zip(starts, stops, strict=True)]
        return tuple((array, part) for array, part in parts if part)

    @property
    def unpacked(self) -> tuple[tuple[str, str, int], ...]:
        """Names that the lines use and do not assign, with array and index, states first."""
        return self.vectors.unpacked(self.lines)

    def restricted(self, name: str, doc: str, arrays: Sequence[str]) -> "Kernel":
        """The kernel that writes some of the `arrays` alone, without the terms of the others."""
        own = [
            line
            for line, (target, _) in zip(self.lines, self.body, strict=True)
            if isinstance(target, Entry) and target.array in arrays
        ]
        arguments = tuple(a for a in self.arguments if a not in self.written or a in arrays)
        return Kernel(name, arguments, doc, self.vectors, tuple(with_needed(self.lines, own)))


def kernel(name: str, arguments: str, doc: str, vectors: Vectors, lines: Sequence[Line]) -> Kernel:
    """The kernel `name` of `arguments`, as they stand between parentheses."""
    return Kernel(name, tuple(arguments.split(", ")), doc, vectors, tuple(lines))


def _parsed(lines: Sequence[Line]) -> tuple[Assignment, ...]:
    return tuple(Assignment(_target(name), e) for name, e in lines)


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


def needed(lines: Sequence[Line], by: Sequence[Line]) -> list[Line]:
    """Those of `lines` that compute what the lines `by` use."""
    wanted, kept = used_names(by), []
    for name, expression in reversed(lines):
        if name in wanted:
            kept.append((name, expression))
            wanted |= {str(symbol) for symbol in expression.free_symbols}
    return kept[::-1]


def with_needed(lines: Sequence[Line], own: Sequence[Line]) -> list[Line]:
    """Those of `lines` that are `own` or that compute what these use."""
    kept = {name for name, _ in (*own, *needed(lines, own))}
    return [line for line in lines if line[0] in kept]
