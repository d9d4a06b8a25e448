"""Write output files whole or not at all.

Everything goes to a temporary folder first, is flushed to disk, and is then moved into place with
`os.replace`. A process that is killed leaves the old files intact and at most one temporary folder,
which the next call for the same target removes.
"""

import os
import secrets
import shutil
import socket
import time
from collections.abc import Mapping
from pathlib import Path, PurePosixPath

from ptp_symbolic.errors import InputError

_DAY = 86400.0


def write_files_atomically(folder: Path, files: Mapping[str, str | bytes]) -> None:
    """Write `files` (relative name -> content, text as UTF-8) into `folder`, which may be new.

    A new folder appears in one rename, complete; in an existing one each file is replaced in one
    rename after all of them are safely on disk. The file named last is removed first and comes
    last: where it is, those beside it are of the same call. Files that are not named stay.
    Raises InputError if the folder cannot be written, ValueError for a name that leaves it.
    """
    names = [_checked_name(name) for name in files]
    folder = Path(folder)
    try:
        _check_targets(folder, names)
        is_new = not folder.exists()
        if is_new:
            folder.parent.mkdir(parents=True, exist_ok=True)
        # Inside an existing folder, beside a new one: a mounted folder often has a parent that is
        # read-only or lies on another file system.
        temporary = _new_temporary(folder, folder.parent if is_new else folder)
        try:
            for name, content in zip(names, files.values(), strict=True):
                _write_synced(temporary / name, content)
            _put_in_place(temporary, folder, names, is_new)
        finally:
            shutil.rmtree(temporary, ignore_errors=True)
    except OSError as error:
        raise InputError(_refusal(folder, error.strerror or str(error))) from error


def write_text_if_changed(path: Path, text: str) -> bool:
    """Make the file at `path` hold `text` (UTF-8); return whether it had to be written.

    Raises InputError if the folder of `path` cannot be written.
    """
    path = Path(path)
    content = text.encode()
    try:
        if path.is_file() and path.read_bytes() == content:
            return False
    except OSError as error:
        raise InputError(_refusal(path, error.strerror or str(error))) from error
    write_files_atomically(path.parent, {path.name: content})
    return True


def check_writable(folder: Path) -> None:
    """Refuse `folder` now if `write_files_atomically` would refuse it later; leaves no trace.

    Meant for the start of a long job. Raises InputError.
    """
    folder = Path(folder)
    existing = folder
    while not os.path.lexists(existing) and existing != existing.parent:
        existing = existing.parent
    if not existing.is_dir():
        raise InputError(_refusal(folder, f"'{existing}' is not a folder"))
    try:
        _new_temporary(folder, existing).rmdir()
    except OSError as error:
        raise InputError(_refusal(folder, error.strerror or str(error))) from error


def _refusal(path: Path, reason: str) -> str:
    return f"'{path}' cannot be written: {reason}. Give a folder that exists or can be made."


def _checked_name(name: str) -> str:
    parts = PurePosixPath(name).parts
    if not parts or ".." in parts or parts[0] == "/" or "\\" in name or ":" in name:
        raise ValueError(f"{name!r} is not a relative file name inside the folder")
    return name


def _check_targets(folder: Path, names: list[str]) -> None:
    if folder.exists() and not folder.is_dir():
        raise InputError(_refusal(folder, "it is a file, not a folder"))
    root = folder.resolve()
    for name in names:
        target = folder / name
        if not target.parent.resolve().is_relative_to(root):
            raise InputError(_refusal(target, "a link leads out of the folder"))
        if target.is_dir():
            raise InputError(_refusal(target, "a folder has the name of the file"))


def _new_temporary(folder: Path, base: Path) -> Path:
    """Make a temporary folder for `folder` in `base` and drop those of dead processes."""
    stem = f".{folder.resolve().name}.{socket.gethostname()}."
    for stale in base.glob(".*.tmp"):
        if stale.name.startswith(stem) and stale.is_dir() and _is_stale(stale, stem):
            shutil.rmtree(stale, ignore_errors=True)
    temporary = base / f"{stem}{os.getpid()}.{secrets.token_hex(4)}.tmp"
    temporary.mkdir()
    return temporary


def _is_stale(temporary: Path, stem: str) -> bool:
    process = temporary.name[len(stem) :].split(".")[0]
    # os.kill(pid, 0) only probes on POSIX; on Windows it would end the process.
    if os.name == "posix" and process.isdecimal():
        try:
            os.kill(int(process), 0)
        except ProcessLookupError:
            return True
        except (OSError, OverflowError):
            pass
    try:
        return time.time() - temporary.stat().st_mtime > _DAY
    except OSError:
        return False


def _write_synced(path: Path, content: str | bytes) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("wb") as file:
        file.write(content.encode() if isinstance(content, str) else content)
        file.flush()
        os.fsync(file.fileno())


def _put_in_place(temporary: Path, folder: Path, names: list[str], is_new: bool) -> None:
    if is_new:
        for written in {(temporary / name).parent for name in names}:
            _sync_folder(written)
        try:
            os.rename(temporary, folder)
            _sync_folder(folder.parent)
            return
        except OSError:
            # Someone else made the folder meanwhile: fill it file by file.
            folder.mkdir(exist_ok=True)
    if len(names) > 1:
        (folder / names[-1]).unlink(missing_ok=True)
    for name in names:
        target = folder / name
        target.parent.mkdir(parents=True, exist_ok=True)
        os.replace(temporary / name, target)
    for written in {(folder / name).parent for name in names}:
        _sync_folder(written)


def _sync_folder(folder: Path) -> None:
    if os.name != "posix":
        return
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
