"""The diagnosis with chosen constants scaled: what hangs on them?

The table of constants says of each where it comes from. Those that nothing derives are chosen: they
are multiplied by a factor, one or all of a section at once, before anything else of the package is
imported.
"""

import re
from pathlib import Path
from types import ModuleType
from typing import Any

LINE = re.compile(r"^([A-Z_0-9]+) = (.*?)  # (.*)$")
SOURCES = ("scaled", "stated", "usual", "tested")  # first words where nothing derives a constant


def sections(source: str) -> dict[str, list[str]]:
    """The chosen constants of every section of the table."""
    found: dict[str, list[str]] = {}
    section = ""
    for line in source.splitlines():
        if line.startswith("# "):
            section = line.removeprefix("# ").lower()
        row = LINE.match(line)
        if row and row[3].split("; ")[-1].startswith(SOURCES):
            found.setdefault(section, []).append(row[1])
    return found


def scaled(value: Any, factor: float) -> Any:
    """A number, or all numbers of a tuple, times `factor`; counts stay whole and above zero."""
    if isinstance(value, tuple):
        return tuple(scaled(part, factor) for part in value)
    return max(1, round(value * factor)) if isinstance(value, int) else value * factor


def scale_chosen(module: ModuleType, which: str, factor: float) -> None:
    """Set the constants of `module` anew, the chosen one of this name, or those of this section,
    scaled, and all that follow from them.

    Raises KeyError for what is neither a chosen constant nor a section that has any.
    """
    source = Path(str(module.__file__)).read_text(encoding="utf-8")
    every = sections(source)
    names = [which] if any(which in part for part in every.values()) else every[which]
    lines = []
    for line in source.splitlines():
        row = LINE.match(line)
        if row and row[1] in names:
            line = f"{row[1]} = _scaled({row[2]}, {factor})"
        lines.append(line)
    exec("\n".join(lines), module.__dict__ | {"_scaled": scaled}, module.__dict__)


def apply(text: str) -> None:
    """Scale constants of the package as `text`, "section=factor" or "NAME=factor", asks for."""
    from ptp_symbolic.numeric.identify import constants

    which, _, factor = text.partition("=")
    scale_chosen(constants, which, float(factor))
