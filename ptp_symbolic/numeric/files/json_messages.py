"""Messages in JSON in MCAP files, read with mcap."""

import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.files.content import in_a_line, lacking
from ptp_symbolic.numeric.files.messages import numbers_of


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
