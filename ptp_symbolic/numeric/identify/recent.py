"""What is costly to make and may be asked for again."""

from collections import OrderedDict
from collections.abc import Callable, Hashable
from typing import Generic, TypeVar

Key = TypeVar("Key", bound=Hashable)
Kept = TypeVar("Kept")


class Recent(Generic[Key, Kept]):
    """The values that were made last, by key; threads may share it."""

    def __init__(self) -> None:
        self._values: OrderedDict[Key, Kept] = OrderedDict()

    def of(self, key: Key, made: Callable[[], Kept], most: int) -> Kept:
        """The value of a key, `made` where it is not kept; of more than `most` the oldest go."""
        found = self._values.get(key)
        if found is None:
            found = self._values[key] = made()
        while len(self._values) > most:
            self._values.popitem(last=False)
        return found

    def clear(self) -> None:
        """Keep nothing."""
        self._values.clear()
