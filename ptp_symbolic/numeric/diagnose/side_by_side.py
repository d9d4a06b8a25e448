"""Work done side by side, each piece in a thread of its own that shares out its simulations."""

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar

Item = TypeVar("Item")
Result = TypeVar("Result")


def side_by_side(work: Callable[[Item], Result], items: Sequence[Item]) -> list[Result]:
    """What `work` makes of every item, in their order.

    Its threads only wait for what they hand to an executor, one worker per core: where there are
    three fits for two cores, the last of them does not hold one core idle.
    """
    if len(items) <= 1:
        return [work(item) for item in items]
    with ThreadPoolExecutor(len(items)) as threads:
        return list(threads.map(work, items))
