"""ROS bags and MCAP files: every topic is a table, with time stamps of its own."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.data.array_table import ArrayTable
from ptp_symbolic.numeric.data.json_messages import json_messages
from ptp_symbolic.numeric.data.messages import Messages
from ptp_symbolic.numeric.data.ros_messages import RosMessages
from ptp_symbolic.numeric.data.table import MOST_ROWS, Table
from ptp_symbolic.platform import Clock

SUFFIXES = (".bag", ".mcap", ".db3")
METADATA = "metadata.yaml"  # what makes a folder a bag of ROS 2


@dataclass(frozen=True)
class TopicTable(Table):
    """The messages of one topic of a bag: `time [s]`, and every number under the names of its
    fields, such as `/imu/angular_velocity/z`, `/joint_states/position/0` or, where a message has a
    list `name` of the same length, `/joint_states/position/pan`.
    """

    messages: Messages
    topic: str

    @property
    def head(self) -> str:
        """The bag and the topic."""
        return f"{self.path}: topic {self.topic}"

    def row(self, number: int) -> str:
        """The message `number`, counted from zero."""
        return f"{self.head}: message {number + 1}"

    def clock(self, declared: Clock) -> tuple[int, str | None]:
        """The column of times: the stamps of the headers, else when messages were recorded."""
        return 0, "s"

    def numbers(self, columns: Sequence[int]) -> NDArray[np.float64]:
        """The given columns as [n, len(columns)], the time from the beginning of the bag.

        Raises InputError for numbers that are missing in a message or not finite, for messages that
        cannot be read, and for more than ten million of them.
        """
        names = [self.headings[k][0] for k in columns]
        rows = []
        for number, found in enumerate(self.messages.numbers(self.topic)):
            if number == MOST_ROWS:
                raise InputError(f"{self.head}: has more than {MOST_ROWS} messages; split the bag.")
            missing = [name for name in names if name not in found]
            if missing:
                raise InputError(f"{self.row(number)}: has no '{missing[0]}'; correct the log.")
            rows.append([found[name] for name in names])
        table = np.array(rows).reshape(len(rows), len(names))
        headings = tuple((name, None) for name in names)
        return ArrayTable(self.path, headings, tuple(table.T)).numbers(range(len(names)))


def is_bag(path: Path) -> bool:
    """Whether a path is a bag: a file by the end of its name, or a folder with its metadata."""
    return path.suffix.lower() in SUFFIXES or (path / METADATA).is_file()


def read_topics(path: Path, paths: Sequence[Path]) -> list[TopicTable]:
    """The topics of a bag that hold numbers; of several `paths` (parts of one bag) together, which
    messages call `path`.

    Raises InputError for a bag that is missing or damaged, for messages that are neither of ROS nor
    in JSON, and where the library that reads them is not installed.
    """
    messages: Messages = json_messages(path, paths) or RosMessages(path, tuple(paths))
    tables = []
    for topic in messages.topics:
        first = next(iter(messages.numbers(topic)), None)
        if first is not None and len(first) > 1:
            tables.append(TopicTable(path, tuple((n, None) for n in first), messages, topic))
    if not tables:
        raise InputError(f"{path}: has no messages with numbers; give the bag of a run.")
    return tables
