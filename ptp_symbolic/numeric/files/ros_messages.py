"""Messages of ROS 1 and 2, read with rosbags."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.files.content import in_a_line, lacking
from ptp_symbolic.numeric.files.messages import numbers_of


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
