"""The diagnosis with a section of its chosen constants scaled: what hangs on them?

The table of constants says of each where it comes from. Those that were chosen are multiplied by a
factor, all of a section at once, before anything else of the package is imported; a number that
stands for a ratio just above one is scaled in what it has above one.
"""

import re
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any

LINE = re.compile(r"^([A-Z_0-9]+) = (.*?)  # (.*)$")
SCALED = "scaled"  # first word of the source of a constant that was chosen
RATIOS = {"ABOVE_NOISE", "HELD_OUT_ABOVE", "OVERLAP_CORRELATION"}


def sections(source: str) -> dict[str, list[str]]:
    """The chosen constants of every section of the table."""
    found: dict[str, list[str]] = {}
    section = ""
    for line in source.splitlines():
        if line.startswith("# "):
            section = line.removeprefix("# ").lower()
        row = LINE.match(line)
        if row and row[3].split("; ")[-1].startswith(SCALED):
            found.setdefault(section, []).append(row[1])
    return found


def scaled(value: Any, factor: float) -> Any:
    """A number, or all numbers of a tuple, times `factor`; counts stay whole and above zero."""
    if isinstance(value, tuple):
        return tuple(scaled(part, factor) for part in value)
    return max(1, round(value * factor)) if isinstance(value, int) else value * factor


def scale_of(name: str, factor: float) -> Callable[[Any], Any]:
    """What a constant becomes."""
    if name in RATIOS:
        return lambda value: 1.0 + scaled(value - 1.0, factor)
    return lambda value: scaled(value, factor)


def scale_section(module: ModuleType, section: str, factor: float) -> None:
    """Set the constants of `module` anew, those of a section scaled, and all that follow from them.

    Raises KeyError for a section without chosen constants.
    """
    source = Path(str(module.__file__)).read_text(encoding="utf-8")
    names = sections(source)[section]
    lines = []
    for line in source.splitlines():
        row = LINE.match(line)
        if row and row[1] in names:
            line = f"{row[1]} = _scale_of({row[1]!r}, {factor})({row[2]})"
        lines.append(line)
    exec("\n".join(lines), module.__dict__ | {"_scale_of": scale_of}, module.__dict__)


def apply(text: str) -> None:
    """Scale the constants of the package as `text`, "section=factor", asks for."""
    from ptp_symbolic.numeric.identify import constants

    section, _, factor = text.partition("=")
    scale_section(constants, section, float(factor))
