"""Python text of an emitted module, its lines filled."""

import re
import textwrap
from collections.abc import Iterable, Sequence

from ptp_symbolic.symbolic.targets.target import literal

TEXT_WIDTH = 80
WIDTH = 100
INNER_WIDTH = WIDTH - 4
# Without its memory manager numba refuses to compile a function that allocates.
COMPILED = '@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)\n'
INLINED = COMPILED.replace("_nrt", "forceinline=True, _nrt")
UNBROKEN = "\0"  # stands for a space at which a line must not end
LITERAL = re.compile(r'"(?:[^"\\]|\\.)*"')
TERMS = re.compile(r" (?![-+] |if |else )")  # the spaces that are not before such an operator
OPERANDS = re.compile(r" (?![-+*/] |if |else )")


def function_text(options: str, name: str, arguments: Sequence[str], rows: Sequence[str]) -> str:
    """A compiled function with these `rows` in it."""
    head = f"{options}def {name}({', '.join(arguments)}):\n"
    return head + textwrap.indent("\n".join(rows), "    ")


def long_text(value: str) -> str:
    """A literal, or several beside each other that are one."""
    lines = textwrap.wrap(value, TEXT_WIDTH, drop_whitespace=False) or [""]
    return " ".join(literal(line) for line in lines)


def named_tuple_text(name: str, items: Iterable[str]) -> str:
    """The constant `name`, a tuple: on one line, or filled, with every tuple in it on its own."""
    items = list(items)
    line = f"{name} = ({listed(items)})"
    if len(line) <= WIDTH:
        return line
    rows = [f"{item}," for item in items]
    if not items[0].startswith("("):
        rows = [" ".join(rows)]
    return "\n".join([f"{name} = (", *(_filled_row(row) for row in rows), ")"])


def number_text(value: float | None) -> str:
    """A float in full, or None."""
    return "None" if value is None else repr(float(value))


def numbers_text(values: tuple[float, ...]) -> str:
    """A tuple of floats in full."""
    return f"({listed(map(number_text, values))})"


def listed(items: Iterable[str]) -> str:
    """Items of a tuple, without its parentheses."""
    found = list(items)
    return f"{found[0]}," if len(found) == 1 else ", ".join(found)


def assignment_text(target: str, source: str, width: int, meaning: str = "") -> str:
    """An assignment in lines of `width`, broken before plus and minus, elsewhere where that does
    not do; the `meaning` of the target is a comment.
    """
    if len(target) + len(source) + 3 <= width:
        return _commented(f"{target} = {source}", meaning, width)
    source = f"({source})"
    for operands in (TERMS, OPERANDS):
        text = _wrapped(operands.sub(UNBROKEN, f"{target} = {source}"), width, "", "    ")
        if max(map(len, text.split("\n"))) <= width:
            return _commented(text, meaning, width)
    text = _wrapped(OPERANDS.sub(UNBROKEN, source[1:]), width, "    ", "    ")
    return _commented(f"{target} = (\n{text}", meaning, width)


def _commented(text: str, meaning: str, width: int) -> str:
    """`text` with a comment behind its last line, or above it where there is no room."""
    if not meaning:
        return text
    last = text.rpartition("\n")[2]
    comment = f"# {meaning}"
    return f"{text}  {comment}" if len(last) + len(comment) + 2 <= width else f"{comment}\n{text}"


def tuple_text(before: str, items: Iterable[str], width: int, after: str = "") -> str:
    """A tuple of names in lines of `width`, between two texts; in parentheses where it must be."""
    found = list(items)
    bare = f"{before}{', '.join(found)}{after}"
    if len(found) > 1 and len(bare) <= width:
        return bare.replace(UNBROKEN, " ")
    return _wrapped(f"{before}({listed(found)}){after}", width, "", "    ")


def filled(text: str, width: int) -> str:
    """A statement in lines of `width`, broken at any space."""
    return _wrapped(text, width, "", "    ")


def unpacking_text(entries: Iterable[tuple[str, str, int]], width: int) -> list[str]:
    """Assignments of names from array entries, those of an array together in lines of `width`."""
    lines: list[tuple[list[str], list[str], str]] = []
    for name, array, index in entries:
        entry = f"{array}[{index}]"
        if lines and lines[-1][2] == array:
            names, values = [*lines[-1][0], name], [*lines[-1][1], entry]
            if len(f"{', '.join(names)} = {', '.join(values)}") <= width:
                lines[-1] = (names, values, array)
                continue
        lines.append(([name], [entry], array))
    return [f"{', '.join(names)} = {', '.join(values)}" for names, values, _ in lines]


def _filled_row(row: str) -> str:
    literals = LITERAL.sub(lambda found: found[0].replace(" ", UNBROKEN), row)
    further = 5 if row.startswith("(") else 4
    return _wrapped(literals, WIDTH, 4 * " ", further * " ")


def _wrapped(text: str, width: int, first: str, further: str) -> str:
    lines = textwrap.wrap(
        text,
        width,
        initial_indent=first,
        subsequent_indent=further,
        break_long_words=False,
        break_on_hyphens=False,
    )
    return "\n".join(lines).replace(UNBROKEN, " ")
