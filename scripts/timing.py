"""The shortest of several runs."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import numpy as np

Row = dict[str, Any]


def best(run: Callable[[], Any], repeats: int = 7) -> tuple[float, Any]:
    """Shortest time in s of a run, and what it returned; the first, untimed run compiles."""
    result, shortest = run(), np.inf
    for _ in range(repeats):
        start = time.perf_counter()
        result = run()
        shortest = min(shortest, time.perf_counter() - start)
    return float(shortest), result
