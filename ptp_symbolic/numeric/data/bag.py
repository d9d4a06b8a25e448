"""ROS bags and MCAP files: every topic is a table, with time stamps of its own."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.data.array_table import ArrayTable
from ptp_symbolic.numeric.data.table import MOST_ROWS, Table
from ptp_symbolic.platform import Clock

SUFFIXES = (".bag", ".mcap", ".db3")
METADATA = "metadata.yaml"  # what makes a folder a bag of ROS 2
FAR = 10**15  # ns, 12 days: stamps that far from the time of recording are of another clock
LONGEST_LIST = 100  # numbers in a field that are columns


@dataclass(frozen=True)
class TopicTable(Table):
    """The messages of one topic of a bag: `time [s]`, and every number under the names of its
    fields, such as `/imu/angular_velocity/z`, `/joint_states/position/0` or, where a message has a
    list `name` of the same length, `/joint_states/position/pan`.
    """

    paths: tuple[Path, ...]
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
        for number, found in enumerate(_messages(self.path, self.paths, self.topic)):
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

    Raises InputError for a bag that is missing or damaged, for messages that are not of ROS, and
    where rosbags is not installed.
    """
    tables = []
    with _opened(path, paths) as reader:
        topics = sorted({connection.topic for connection in reader.connections})
    for topic in topics:
        first = next(_messages(path, paths, topic), None)
        if first is not None and len(first) > 1:
            tables.append(TopicTable(path, tuple((n, None) for n in first), tuple(paths), topic))
    if not tables:
        raise InputError(f"{path}: has no messages with numbers; give the bag of a run.")
    return tables


def _opened(path: Path, paths: Sequence[Path]) -> Any:
    try:
        from rosbags.highlevel import AnyReader, AnyReaderError
    except ImportError as error:
        raise InputError(
            f"{path}: a bag needs rosbags; run pip install 'ptp-symbolic[bag]', or save the log as"
            " CSV."
        ) from error
    missing = [p for p in paths if not p.exists()]
    if missing:
        raise InputError(f"{missing[0]}: No such file or directory; give the path of a log.")
    try:
        with AnyReader(list(paths)):
            return AnyReader(list(paths))
    except (AnyReaderError, OSError, ValueError, AssertionError) as error:
        raise InputError(f"{path}: is not a bag that can be read: {_line(error)}.") from error


def _messages(path: Path, paths: Sequence[Path], topic: str) -> Iterator[dict[str, float]]:
    """The numbers of every message of a topic by name, `time` in s first."""
    with _opened(path, paths) as reader:
        wanted = [c for c in reader.connections if c.topic == topic]
        for connection, recorded, raw in reader.messages(wanted):
            try:
                message = reader.deserialize(raw, connection.msgtype)
            except Exception as error:  # whatever a damaged byte leads to
                raise InputError(f"{path}: topic {topic}: {_line(error)}.") from error
            stamp = _stamp(message) or recorded
            origin = reader.start_time if abs(stamp - reader.start_time) < FAR else 0
            yield {"time": 1e-9 * (stamp - origin), **dict(_numbers(topic, message, []))}


def _stamp(message: Any) -> int:
    """The time of measurement in ns from the header of a message; 0 where there is none."""
    stamp = getattr(getattr(message, "header", None), "stamp", None)
    return 0 if stamp is None else int(stamp.sec) * 10**9 + int(stamp.nanosec)


def _numbers(name: str, value: Any, names: Sequence[str]) -> Iterator[tuple[str, float]]:
    """The numbers within a value of a message; `names` are those of the elements of lists."""
    if isinstance(value, bool | int | float | np.number):
        yield name, float(value)
    elif isinstance(value, list | np.ndarray) and len(value) <= LONGEST_LIST:
        own = names if len(names) == len(value) else []
        for key, element in chain(enumerate(value), zip(own, value, strict=False)):
            yield from _numbers(f"{name}/{key}", element, [])
    elif hasattr(value, "__dataclass_fields__"):
        given = getattr(value, "name", [])
        own = given if isinstance(given, list) else []
        for key in value.__dataclass_fields__:
            if key not in ("header", "__msgtype__"):
                yield from _numbers(f"{name}/{key}", getattr(value, key), own)


def _line(error: Exception) -> str:
    return " ".join(str(error).split()).rstrip(".") or type(error).__name__
