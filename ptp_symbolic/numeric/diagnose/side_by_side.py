"""Fits side by side, in threads of their own that share out their simulations."""

import os
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar

Item = TypeVar("Item")
Result = TypeVar("Result")


def usable_cores() -> int:
    """Cores that the process may use."""
    affinity = getattr(os, "sched_getaffinity", None)  # Linux alone has one
    return len(affinity(0)) if affinity else os.cpu_count() or 1


def side_by_side(work: Callable[[Item], Result], items: Sequence[Item]) -> list[Result]:
    """What `work` makes of every item, in their order.

    Simulations that it hands to an executor of one worker per core go on while another piece is
    between two of its own, so that the last of three fits for two cores keeps both at work. One
    piece more than cores is enough for that.
    """
    if len(items) <= 1:
        return [work(item) for item in items]
    with ThreadPoolExecutor(min(len(items), 1 + usable_cores())) as threads:
        return list(threads.map(work, items))
