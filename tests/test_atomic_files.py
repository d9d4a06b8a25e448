"""Outputs are whole or not there at all, also when a write fails or the process is killed."""

import os
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path

import pytest

from ptp_symbolic import atomic_files
from ptp_symbolic.atomic_files import check_writable, write_files_atomically, write_text_if_changed
from ptp_symbolic.errors import InputError


def everything_in(folder: Path) -> list[str]:
    return sorted(str(path.relative_to(folder)) for path in folder.rglob("*"))


def test_a_new_folder_holds_text_and_bytes_and_nothing_else(tmp_path: Path) -> None:
    out = tmp_path / "runs" / "first"
    write_files_atomically(out, {"a.json": "ä\n", "plots/b.png": b"\x00\x01"})
    assert (out / "a.json").read_bytes() == "ä\n".encode()
    assert (out / "plots" / "b.png").read_bytes() == b"\x00\x01"
    assert everything_in(tmp_path) == [
        "runs",
        "runs/first",
        "runs/first/a.json",
        "runs/first/plots",
        "runs/first/plots/b.png",
    ]


def test_an_existing_folder_keeps_its_other_files(tmp_path: Path) -> None:
    (tmp_path / "mine.txt").write_text("stays")
    (tmp_path / "a.txt").write_text("old")
    write_files_atomically(tmp_path, {"a.txt": "new"})
    assert (tmp_path / "mine.txt").read_text() == "stays"
    assert (tmp_path / "a.txt").read_text() == "new"
    assert everything_in(tmp_path) == ["a.txt", "mine.txt"]


def test_the_new_folder_gets_the_usual_permissions(tmp_path: Path) -> None:
    (tmp_path / "usual").mkdir()
    write_files_atomically(tmp_path / "out", {"a.txt": ""})
    assert (tmp_path / "out").stat().st_mode == (tmp_path / "usual").stat().st_mode


def test_a_disk_that_fills_up_leaves_the_old_files(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(_: int) -> None:
        raise OSError(28, "No space left on device")

    (tmp_path / "a.txt").write_text("old")
    monkeypatch.setattr(atomic_files.os, "fsync", full)
    with pytest.raises(InputError, match="cannot be written: No space left on device"):
        write_files_atomically(tmp_path, {"a.txt": "new", "b.txt": "new"})
    with pytest.raises(InputError, match="No space left"):
        write_files_atomically(tmp_path / "out", {"a.txt": "new"})
    assert everything_in(tmp_path) == ["a.txt"]
    assert (tmp_path / "a.txt").read_text() == "old"


def test_a_folder_below_a_file_is_refused(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    for folder in (tmp_path / "file", tmp_path / "file" / "out"):
        with pytest.raises(InputError, match="cannot be written") as refusal:
            write_files_atomically(folder, {"a.txt": ""})
        assert "\n" not in str(refusal.value)
        with pytest.raises(InputError, match="is not a folder"):
            check_writable(folder)
    assert everything_in(tmp_path) == ["file"]


def test_a_read_only_folder_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def denied(*_: object, **__: object) -> None:
        raise PermissionError(13, "Permission denied")

    if hasattr(os, "geteuid") and os.geteuid() == 0:  # permissions do not bind this user
        monkeypatch.setattr(Path, "mkdir", denied)
    tmp_path.chmod(0o500)
    try:
        with pytest.raises(InputError, match="Permission denied"):
            write_files_atomically(tmp_path, {"a.txt": ""})
        with pytest.raises(InputError, match="Permission denied"):
            check_writable(tmp_path / "out")
    finally:
        tmp_path.chmod(0o700)
    assert everything_in(tmp_path) == []


def test_a_writable_folder_passes_without_a_trace(tmp_path: Path) -> None:
    check_writable(tmp_path)
    check_writable(tmp_path / "a" / "b")
    assert everything_in(tmp_path) == []


@pytest.mark.parametrize("name", ["", "..", "../a", "a/../../b", "/etc/a", "a\\b", "C:a"])
def test_names_that_leave_the_folder_are_refused(tmp_path: Path, name: str) -> None:
    with pytest.raises(ValueError, match="not a relative file name"):
        write_files_atomically(tmp_path / "out", {name: ""})
    assert everything_in(tmp_path) == []


def test_a_link_that_leads_out_of_the_folder_is_refused(tmp_path: Path) -> None:
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "plots").symlink_to(tmp_path / "elsewhere")
    with pytest.raises(InputError, match="a link leads out of the folder"):
        write_files_atomically(tmp_path / "out", {"a.txt": "", "plots/b.png": b""})
    assert everything_in(tmp_path / "elsewhere") == []
    assert everything_in(tmp_path / "out") == ["plots"]


def test_a_folder_in_the_place_of_a_file_is_refused_before_anything_moves(tmp_path: Path) -> None:
    (tmp_path / "b.txt").mkdir()
    with pytest.raises(InputError, match="a folder has the name of the file"):
        write_files_atomically(tmp_path, {"a.txt": "", "b.txt": ""})
    assert everything_in(tmp_path) == ["b.txt"]


def test_the_leavings_of_a_dead_process_are_removed_and_those_of_others_kept(
    tmp_path: Path,
) -> None:
    dead = subprocess.Popen([sys.executable, "-c", ""])
    dead.wait()
    stem = f".{tmp_path.name}.{socket.gethostname()}."
    left = tmp_path / f"{stem}{dead.pid}.0011aabb.tmp"
    alive = tmp_path / f"{stem}{os.getpid()}.0011aabb.tmp"
    foreign = tmp_path / ".something.tmp"
    for folder in (left, alive, foreign):
        folder.mkdir()
    write_files_atomically(tmp_path, {"a.txt": ""})
    assert not left.exists()
    assert alive.exists()
    assert foreign.exists()


def test_text_is_written_only_if_it_changed(tmp_path: Path) -> None:
    path = tmp_path / "generated" / "ideal.py"
    assert write_text_if_changed(path, "a = 1\n")
    before = path.stat()
    assert not write_text_if_changed(path, "a = 1\n")
    assert path.stat().st_mtime_ns == before.st_mtime_ns
    assert write_text_if_changed(path, "a = 2\n")
    assert path.read_bytes() == b"a = 2\n"
    assert everything_in(path.parent) == ["ideal.py"]


WRITER = """
import sys
from pathlib import Path
from ptp_symbolic.atomic_files import write_files_atomically
for count in range(10**9):
    text = str(count % 10) * 200_000
    write_files_atomically(Path(sys.argv[1]), {"a.txt": text, "b.txt": text})
"""


def test_a_killed_process_leaves_whole_files_and_one_temporary_folder_at_most(
    tmp_path: Path,
) -> None:
    root = Path(atomic_files.__file__).parents[1]
    environment = {**os.environ, "PYTHONPATH": str(root)}
    for kill in range(8):
        process = subprocess.Popen(
            [sys.executable, "-c", WRITER, str(tmp_path / "out")], env=environment
        )
        deadline = time.monotonic() + 20
        while not (tmp_path / "out" / "b.txt").exists() and time.monotonic() < deadline:
            time.sleep(0.005)
        time.sleep(0.02 + 0.013 * kill)
        process.send_signal(signal.SIGKILL)
        process.wait()
        found = [p.read_text() for n in ("a.txt", "b.txt") if (p := tmp_path / "out" / n).exists()]
        assert all(len(text) == 200_000 and len(set(text)) == 1 for text in found)
        assert len(found) == 1 or found[0] == found[1], "b.txt stands beside another run's a.txt"
        assert len(list((tmp_path / "out").glob(".*.tmp"))) <= 1
    write_files_atomically(tmp_path / "out", {"a.txt": "end", "b.txt": "end"})
    assert everything_in(tmp_path) == ["out", "out/a.txt", "out/b.txt"]


@pytest.mark.parametrize("exists", [True, False])
def test_what_a_killed_check_leaves_is_removed_by_the_next_run(
    exists: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    out = tmp_path / "out"
    if exists:
        out.mkdir()
    ended = subprocess.Popen([sys.executable, "-c", ""])
    ended.wait()
    with monkeypatch.context() as killed:
        killed.setattr(atomic_files.os, "getpid", lambda: ended.pid)
        killed.setattr(Path, "rmdir", lambda _: None)
        check_writable(out)
    assert len(everything_in(tmp_path)) == 1 + exists
    check_writable(out)
    assert everything_in(tmp_path) == ["out"] * exists


def test_the_last_file_is_there_only_beside_files_of_its_own_call(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A run that dies between files leaves a folder without its summary: no mixture has one."""
    write_files_atomically(tmp_path, {"a.csv": "old", "b.csv": "old", "summary.json": "old"})
    replace, moved = os.replace, []

    def die_after_one(source: Path, target: Path) -> None:
        if moved:
            raise KeyboardInterrupt
        moved.append(target)
        replace(source, target)

    monkeypatch.setattr(os, "replace", die_after_one)
    with pytest.raises(KeyboardInterrupt):
        write_files_atomically(tmp_path, {"a.csv": "new", "b.csv": "new", "summary.json": "new"})
    assert everything_in(tmp_path) == ["a.csv", "b.csv"]
    assert (tmp_path / "a.csv").read_text() == "new"
