"""ROS bags and MCAP files: every topic is a part, with time stamps of its own."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.files.content import MOST_NUMBERS, MOST_ROWS, Column, Part
from ptp_symbolic.numeric.files.messages import Messages, RosMessages, json_messages


def parts(path: Path, paths: Sequence[Path]) -> list[Part]:
    """The topics of a bag that hold numbers; of several `paths` (parts of one bag) together, which
    messages call `path`.

    The first column of a topic is the time, from the beginning of the bag: the stamps of the
    headers, else when messages were recorded. The others have the names of fields, such as
    `/imu/angular_velocity/z`, `/joint_states/position/0` or, where a message has a list `name` of
    the same length, `/joint_states/position/pan`. Raises InputError for a bag that is missing or
    damaged, for messages that are neither of ROS nor in JSON, and where the library that reads them
    is not installed.
    """
    messages: Messages = json_messages(path, paths) or RosMessages(path, tuple(paths))
    found = []
    for topic in messages.topics:
        first = next(iter(messages.numbers(topic)), None)
        if first is not None and len(first) > 1:
            columns = [Column(name, "s" if name == "time" else None, None) for name in first]
            found.append(Part(topic, columns, _loader(path, messages, topic)))
    if not found:
        raise InputError(f"{path}: has no messages with numbers; give the bag of a run.")
    return found


def _loader(path: Path, messages: Messages, topic: str) -> Any:
    def load(names: Sequence[str]) -> Iterator[NDArray[Any]]:
        rows = []
        head = f"{path}: topic {topic}"
        for number, found in enumerate(messages.numbers(topic)):
            if number == MOST_ROWS or number * len(names) > MOST_NUMBERS:
                raise InputError(f"{head}: has more than {number} messages; split the bag.")
            missing = [name for name in names if name not in found]
            if missing:
                raise InputError(
                    f"{head}: message {number + 1}: has no '{missing[0]}'; correct the log."
                )
            rows.append(np.array([found[name] for name in names]))
        yield from np.array(rows).reshape(len(rows), len(names)).T

    return load
