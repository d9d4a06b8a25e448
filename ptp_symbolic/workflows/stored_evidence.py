"""The evidence of a diagnosis in a file: kept while it goes on, and read to go on from it."""

import io
import json
import threading
import time
import zipfile
from collections.abc import Mapping
from dataclasses import dataclass, field
from hashlib import sha256
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.atomic_files import write_files_atomically
from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.identify.evidence import Entry, Evidence
from ptp_symbolic.platform import Platform, platform_text

FILE = "evidence.npz"
FORMAT = 1  # of the file
EVERY = 10.0  # s; between two writings, or so many times as long as one takes
SHARE = 20.0  # 1; of time that is not spent on writing, over that which is


@dataclass(frozen=True)
class Header:
    """What evidence rests on: the `version` of the program, the SHA-256 of the `platform` and, by
    part and name, of the `logs`; and the `options`, which may change.
    """

    version: str
    platform: str
    logs: Mapping[str, str]
    options: Mapping[str, Any]

    @classmethod
    def of(
        cls, platform: Platform, sources: Mapping[str, Any], options: Mapping[str, Any]
    ) -> "Header":
        """The header of a diagnosis whose `provenance` are `sources`."""
        logs = {f"{log['part']} {log['file']}": log["sha256"] for log in sources["logs"]}
        text = platform_text(platform).encode()
        return cls(sources["version"], sha256(text).hexdigest(), logs, options)

    def refuse_other(self, path: Path, here: "Header") -> None:
        """Raise InputError where this, of the file at `path`, is not that of `here`."""
        again = "run diagnose without resuming"
        if self.version != here.version:
            raise InputError(
                f"'{path}': is evidence of version {self.version}, this is {here.version}; {again}."
            )
        if self.platform != here.platform:
            raise InputError(
                f"'{path}': is evidence of another platform file, or of the same before it was"
                f" changed; {again}."
            )
        if self.logs != here.logs:
            differ = {k for k, _ in set(self.logs.items()) ^ set(here.logs.items())}
            raise InputError(
                f"'{path}': is evidence of other logs: '{min(differ)}' is not the same; give the"
                f" logs of then, or {again}."
            )


@dataclass(eq=False)
class Keeper:
    """Writes evidence into a `folder` (None: nowhere) while it grows, whole each time."""

    header: Header
    evidence: Evidence
    folder: Path | None
    _due: float = field(default_factory=lambda: time.monotonic() + EVERY)
    _lock: threading.Lock = field(default_factory=threading.Lock, repr=False)

    def write_if_due(self) -> None:
        """Write, unless another thread does, or it is too early."""
        if self.folder is None or time.monotonic() < self._due:
            return
        if self._lock.acquire(blocking=False):
            try:
                self._write(self.folder)
            finally:
                self._lock.release()

    def write(self) -> None:
        """Write what there is now."""
        if self.folder is not None and self.evidence.fresh:
            with self._lock:
                self._write(self.folder)

    def _write(self, folder: Path) -> None:
        begun = time.monotonic()
        write_files_atomically(folder, {FILE: self.content()})
        ended = time.monotonic()
        self._due = ended + max(EVERY, SHARE * (ended - begun))

    def content(self) -> bytes:
        """The content of the file."""
        return written(self.header, self.evidence.entries())


def keeper_of(header: Header, resume: Path | None, keep: Path | None) -> Keeper:
    """What keeps the evidence of a diagnosis in a folder, with all that is known of it from
    before. Raises InputError where that is of something else.
    """
    if resume is None:
        return Keeper(header, Evidence(), keep)
    path, before, entries = read_evidence(resume)
    before.refuse_other(path, header)
    return Keeper(header, Evidence(entries), keep)


def written(header: Header, entries: Mapping[str, Entry]) -> bytes:
    """A file of NumPy (npz) with the header and the entries as JSON, and the arrays of real numbers
    one after the other.
    """
    arrays = _Arrays()
    rows = {key: [e.samples, _without_arrays(e.value, arrays)] for key, e in entries.items()}
    head = {"format": FORMAT, **vars(header)}
    numbers = np.concatenate([np.zeros(0), *arrays.every])
    file = io.BytesIO()
    np.savez_compressed(file, header=_bytes_of(head), entries=_bytes_of(rows), numbers=numbers)
    return file.getvalue()


def read_evidence(source: Path) -> tuple[Path, Header, dict[str, Entry]]:
    """The path, header and entries of a file, or of that in a folder.

    Raises InputError for what holds no evidence, or in another format.
    """
    path = source / FILE if source.is_dir() else source
    try:
        with np.load(path, allow_pickle=False) as file:
            head, rows = (json.loads(file[name].tobytes()) for name in ("header", "entries"))
            numbers = file["numbers"]
        number = head.pop("format")
        header = Header(**head)
        entries = {
            key: Entry(_with_arrays(value, numbers), samples)
            for key, (samples, value) in rows.items()
        }
    except (OSError, ValueError, KeyError, TypeError, EOFError, zipfile.BadZipFile) as error:
        raise InputError(
            f"'{path}': holds no evidence of a diagnosis; name the folder that was given as --out,"
            f" or the {FILE} in it."
        ) from error
    if number != FORMAT:
        raise InputError(f"'{path}': has format {number}, this reads {FORMAT}; run diagnose again.")
    return path, header, entries


def _bytes_of(value: Any) -> NDArray[np.uint8]:
    return np.frombuffer(json.dumps(value).encode(), dtype=np.uint8)


@dataclass(eq=False)
class _Arrays:
    """Arrays one after the other, and how many numbers they have."""

    every: list[NDArray[np.float64]] = field(default_factory=list)
    size: int = 0

    def put(self, array: NDArray[np.float64]) -> int:
        """Where an array begins that is put behind the others."""
        self.every.append(array.ravel())
        self.size += array.size
        return self.size - array.size


def _without_arrays(value: Any, arrays: _Arrays) -> Any:
    """Plain data with each array of real numbers put among `arrays`: where it begins, and its
    shape; others as lists.
    """
    match value:
        case np.ndarray():
            if value.dtype != np.float64:
                return {"list": value.tolist(), "type": value.dtype.str}
            return {"first": arrays.put(value), "shape": value.shape}
        case list():
            return [_without_arrays(one, arrays) for one in value]
        case dict():
            return {key: _without_arrays(one, arrays) for key, one in value.items()}
        case _:
            return value


def _with_arrays(value: Any, numbers: NDArray[np.float64]) -> Any:
    """What `_without_arrays` was given."""
    match value:
        case {"list": items, "type": kind}:
            return np.array(items, dtype=kind)
        case {"first": first, "shape": shape}:
            return numbers[first : first + int(np.prod(shape))].reshape(shape)
        case list():
            return [_with_arrays(one, numbers) for one in value]
        case dict():
            return {key: _with_arrays(one, numbers) for key, one in value.items()}
        case _:
            return value
