"""What a target is: a language or a tool that a program is written for."""

import json
from collections.abc import Callable, Iterable, Mapping
from typing import Protocol, runtime_checkable

from ptp_symbolic.symbolic.derivation.equations import Equations
from ptp_symbolic.symbolic.mechanics.kinematics import place_of
from ptp_symbolic.symbolic.program.program import Program
from ptp_symbolic.symbolic.targets.words import WORDS


class Target(Protocol):
    """A target: its `name` on the command line, one line of what it writes, and how."""

    @property
    def name(self) -> str:
        """Name on the command line."""

    @property
    def summary(self) -> str:
        """What it writes, in one line."""

    def refuse(self, program: Program) -> str | None:
        """Why it cannot express a program, naming the effects; None where it can."""

    def remarks(self, program: Program) -> list[str]:
        """What its user should know of a program in it, such as what is lost."""

    def files(self, program: Program, name: str) -> Mapping[str, str]:
        """Texts of its files by name, for a program called `name`."""


@runtime_checkable
class Packed(Protocol):
    """What a target has too whose files are packed into others before they are written."""

    def pack(
        self, files: Mapping[str, str], name: str, say: Callable[[str], None]
    ) -> Mapping[str, bytes]:
        """Contents of the packed files by name, from the texts of a program called `name`; what
        takes long is said.
        """


def effects_of(program: Program) -> list[str]:
    """Keys of the effects of a program, such as ``backlash@pan``."""
    return [
        f"{placed.effect.id}@{placed.axis}" if placed.axis else placed.effect.id
        for placed in program.equations.effects
    ]


def state_units(equations: Equations) -> dict[str, str]:
    """Units of the states by name, in their order."""
    units = {str(q): equations.unit("rad") for q in equations.coordinates}
    units |= {str(w): equations.unit("rad/s") for w in equations.rates}
    units |= {state.name: state.unit for state in equations.extra_states}
    return {str(symbol): units[str(symbol)] for symbol in equations.state_symbols}


def state_meanings(equations: Equations) -> dict[str, str]:
    """Meanings of the states by name."""
    found = {}
    for q, w in zip(equations.coordinates, equations.rates, strict=True):
        place = place_of(q)
        axis = place.removeprefix("gear_")
        where = f"{axis} joint" if place == axis else f"{axis} gear output"
        found[str(q)] = equations.worded(f"angle of the {where}")
        found[str(w)] = f"rate of {q}"
    return found | {state.name: state.meaning for state in equations.extra_states}


def late_inputs(program: Program) -> list[str]:
    """That the caller delays inputs, where a parameter says that some are late."""
    equations = program.equations
    late = [
        f"{given.name} acts {delay} later than it is given: delay it before the call"
        for given, delay in zip(equations.inputs, equations.delays, strict=True)
        if delay is not None
    ]
    return late


def renamed(program: Program) -> list[str]:
    """That a variable has another name than its parameter, state or input, where that is a word of
    one of the languages.
    """
    equations = program.equations
    names = [p.name for p in equations.parameters]
    names += [*map(str, equations.state_symbols), *(i.name for i in equations.inputs)]
    taken = [name for name in names if name.rstrip("_") in WORDS]
    return [f"'{name}' is a word of a language: its variable is {name}_" for name in taken]


def remarks_of_functions(program: Program) -> list[str]:
    """What to know of functions that compute all of a program."""
    return [*late_inputs(program), *renamed(program)]


def literal(text: str) -> str:
    """`text` as a double-quoted literal of Python, whatever it holds: titles come from files."""
    quoted = json.dumps(text, ensure_ascii=False)
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in quoted)


def in_lines(items: Iterable[str], width: int = 96) -> list[str]:
    """Items, each with a comma behind it, on as many indented lines as they need."""
    lines, line = [], "   "
    for item in items:
        if len(line) + len(item) + 2 > width and line.strip():
            lines.append(line)
            line = "   "
        line += f" {item},"
    return [*lines, line]
