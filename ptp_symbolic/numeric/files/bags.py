"""ROS bags and MCAP files: every topic is a part, with time stamps of its own.

Messages of a bag: the numbers in one by name, and the time of its header.

Messages in JSON in MCAP files, read with mcap.

Messages of ROS 1 and 2, read with rosbags.
"""

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain
from pathlib import Path
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.files.content import (
    MOST_NUMBERS,
    MOST_ROWS,
    WIDEST,
    Column,
    Part,
    in_a_line,
    lacking,
)

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


@dataclass(frozen=True)
class JsonMessages:
    """The messages of MCAP files, `paths` one after the other; errors call them `path`, and
    `topics` are those of their messages in JSON. `begin` is that of the first file, in ns.
    """

    path: Path
    paths: tuple[Path, ...]
    topics: Sequence[str]
    begin: int

    def numbers(self, topic: str) -> Iterator[dict[str, float]]:
        """The numbers of every message of a topic by name, `time` in s first.

        Raises InputError for a message that is not JSON, and for a damaged file.
        """
        from mcap.exceptions import McapError
        from mcap.reader import make_reader

        for path in self.paths:
            with path.open("rb") as file:
                try:
                    for _, _, message in make_reader(file).iter_messages(topics=[topic]):
                        found = json.loads(message.data)
                        yield numbers_of(topic, found, message.log_time, self.begin)
                except (McapError, ValueError) as error:
                    raise InputError(f"{path}: topic {topic}: {in_a_line(error)}.") from error


def json_messages(path: Path, paths: Sequence[Path]) -> JsonMessages | None:
    """The messages in JSON of a bag whose parts are all MCAP files; None where there are none.

    Messages of ROS beside them are left out: rosbags refuses such files. Raises InputError where
    mcap is not installed. A file that is damaged is left to rosbags, which says what is wrong.
    """
    if any(p.suffix.lower() != ".mcap" or not p.is_file() for p in paths):
        return None
    try:
        from mcap.exceptions import McapError
        from mcap.reader import make_reader
    except ImportError as error:
        raise InputError(lacking(path, "bag", "mcap", "bag")) from error
    topics: set[str] = set()
    starts: list[int] = []
    for part in paths:
        with part.open("rb") as file:
            try:
                summary = make_reader(file).get_summary()
            except (McapError, ValueError, OSError):
                return None
        if summary is None or summary.statistics is None:
            return None
        own = {c.topic for c in summary.channels.values() if c.message_encoding == "json"}
        topics |= own
        starts.append(summary.statistics.message_start_time)
    return JsonMessages(path, tuple(paths), sorted(topics), min(starts)) if topics else None


@dataclass(frozen=True)
class RosMessages:
    """The messages of a bag, of several `paths` (parts of one bag) together; errors call it `path`.

    Raises InputError for a bag that is missing or damaged, for messages that are not of ROS, and
    where rosbags is not installed.
    """

    path: Path
    paths: tuple[Path, ...]

    @property
    def topics(self) -> Sequence[str]:
        """Names of the topics, sorted."""
        with self._opened() as reader:
            return sorted({connection.topic for connection in reader.connections})

    def numbers(self, topic: str) -> Iterator[dict[str, float]]:
        """The numbers of every message of a topic by name, `time` in s first."""
        with self._opened() as reader:
            wanted = [c for c in reader.connections if c.topic == topic]
            for connection, recorded, raw in reader.messages(wanted):
                try:
                    message = reader.deserialize(raw, connection.msgtype)
                except Exception as error:  # whatever a damaged byte leads to
                    raise InputError(f"{self.path}: topic {topic}: {in_a_line(error)}.") from error
                yield numbers_of(topic, message, recorded, reader.start_time)

    def _opened(self) -> Any:
        try:
            from rosbags.highlevel import AnyReader, AnyReaderError
        except ImportError as error:
            raise InputError(lacking(self.path, "bag", "rosbags", "bag")) from error
        missing = [p for p in self.paths if not p.exists()]
        if missing:
            raise InputError(f"{missing[0]}: No such file or directory; give the path of a log.")
        try:
            with AnyReader(list(self.paths)):
                return AnyReader(list(self.paths))
        except (AnyReaderError, OSError, ValueError, AssertionError) as error:
            raise InputError(
                f"{self.path}: is not a bag that can be read: {in_a_line(error)}."
            ) from error


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
