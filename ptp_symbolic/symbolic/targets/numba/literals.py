"""Python literals of an emitted module, formatted as the project formats its own code."""

import textwrap
from collections.abc import Iterable

from ptp_symbolic.symbolic.targets.target import literal

TEXT_WIDTH = 80
WIDTH = 100


def long_text(value: str) -> str:
    """A literal over as many lines as it needs."""
    lines = textwrap.wrap(value, TEXT_WIDTH, drop_whitespace=False) or [""]
    return "\n        ".join(literal(line) for line in lines)


def named_tuple_text(name: str, items: Iterable[str]) -> str:
    """The constant `name`, a tuple: on one line, or one item a line."""
    items = list(items)
    line = f"{name} = ({listed(items)})"
    if len(line) <= WIDTH:
        return line
    return f"{name} = (\n" + "".join(f"    {item},\n" for item in items) + ")"


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
