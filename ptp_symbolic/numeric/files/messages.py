"""Messages of a bag: the numbers in one by name, and the time of its header."""

from collections.abc import Iterator, Mapping, Sequence
from itertools import chain
from typing import Any, Protocol

import numpy as np

from ptp_symbolic.numeric.files.content import WIDEST

FAR = 10**15  # ns, 12 days: stamps that far from the time of recording are of another clock
STAMPS = ("header", "stamp", "timestamp", "__msgtype__")  # fields that are no measurements
UNDER_A_SECOND = ("nanosec", "nsec", "nsecs")  # ns of a time, by convention


class Messages(Protocol):
    """The messages of a bag, by topic."""

    @property
    def topics(self) -> Sequence[str]:
        """Names of the topics, sorted."""

    def numbers(self, topic: str) -> Iterator[dict[str, float]]:
        """The numbers of every message of a topic by name, `time` in s first."""


def numbers_of(topic: str, message: Any, recorded: int, begin: int) -> dict[str, float]:
    """The numbers of a message by name; `time` in s first, from the `begin` of the bag in ns where
    the clock of its header is that of the recording, `recorded` in ns where it has no header.
    """
    stamp = _stamp(message) or recorded
    origin = begin if abs(stamp - begin) < FAR else 0
    return {"time": 1e-9 * (stamp - origin), **dict(_numbers(topic, message, []))}


def _fields(value: Any) -> Mapping[str, Any] | None:
    """The fields of a message of ROS or of an object of JSON; None for anything else."""
    if isinstance(value, Mapping):
        return value
    names = getattr(value, "__dataclass_fields__", None)
    return None if names is None else {name: getattr(value, name) for name in names}


def _stamp(message: Any) -> int:
    """The time of measurement in ns from the header of a message; 0 where there is none."""
    fields = _fields(message) or {}
    header = _fields(fields.get("header")) or fields
    for name in ("stamp", "timestamp"):
        time = _fields(header.get(name))
        if time is not None and "sec" in time:
            part = next((time[n] for n in UNDER_A_SECOND if n in time), 0)
            return int(time["sec"]) * 10**9 + int(part)
    return 0


def _numbers(name: str, value: Any, names: Sequence[str]) -> Iterator[tuple[str, float]]:
    """The numbers within a value of a message; `names` are those of the elements of lists."""
    if isinstance(value, bool | int | float | np.number):
        yield name, float(value)
    elif isinstance(value, list | np.ndarray) and len(value) <= WIDEST:
        own = names if len(names) == len(value) else []
        for key, element in chain(enumerate(value), zip(own, value, strict=False)):
            yield from _numbers(f"{name}/{key}", element, [])
    elif (fields := _fields(value)) is not None:
        given = fields.get("name", [])
        own = [str(n) for n in given] if isinstance(given, list) else []
        for key, element in fields.items():
            if key not in STAMPS or isinstance(element, int | float):
                yield from _numbers(f"{name}/{key}", element, own)
