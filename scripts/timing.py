"""The shortest of several runs, in time of the processor: other programs count little."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import numpy as np
from rich.console import Console
from rich.table import Table

Row = dict[str, Any]


def best(run: Callable[[], Any], repeats: int = 7) -> tuple[float, Any]:
    """Shortest time in s of a run, of all its threads, and what it returned; the first, untimed run
    compiles.
    """
    result, shortest = run(), np.inf
    for _ in range(repeats):
        start = time.process_time()
        result = run()
        shortest = min(shortest, time.process_time() - start)
    return float(shortest), result


def columns_of(rows: list[Row]) -> list[str]:
    """Every column that any of the rows has, in the order in which they come."""
    return list(dict.fromkeys(key for row in rows for key in row))


def written(value: Any) -> str:
    """A cell: numbers with three digits."""
    return f"{value:.3g}" if isinstance(value, float) else str(value)


def print_table(rows: list[Row]) -> None:
    """Print rows with every column that any of them has."""
    columns = columns_of(rows)
    shown = Table(*columns)
    for row in rows:
        shown.add_row(*(written(row.get(c, "")) for c in columns))
    Console(width=150).print(shown)
