"""Whatever bytes a file holds: a table, or a refusal in one line, and never a dead process."""

import os
import random
import signal
import struct
import sys
import time
import warnings
from collections.abc import Iterable, Sequence
from itertools import repeat
from pathlib import Path
from typing import IO

import numpy as np
import pytest
from scipy.io import savemat

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.data import read_log
from ptp_symbolic.numeric.data.formats import read_table
from ptp_symbolic.numeric.files import child, matlab
from ptp_symbolic.numeric.files import content as file_content
from ptp_symbolic.numeric.files.child import excel_text, parquet_parts, tdms_parts
from ptp_symbolic.platform import Platform
from tests.data.files_of_formats import (
    ANGLE,
    COLUMNS,
    ROWS,
    bench,
    write_binary_files,
    write_text_files,
)

VARIANTS = 25  # of every file
OF_FORKS = 2_500_000_000  # bytes: a fork holds what this process holds, too
LONGEST_MESSAGE = 1500
ENDS = 60  # s after which a reader that goes on for ever is ended


def damaged(content: bytes, rng: random.Random) -> bytes:
    """Cut off, with bytes put in or taken out, or with some of them changed."""
    kind, place = rng.random(), rng.randrange(len(content))
    if kind < 0.15:
        return content[:place]
    if kind < 0.25:
        return content[:place] + rng.randbytes(rng.randrange(1, 9)) + content[place:]
    if kind < 0.35:
        return content[:place] + content[place + rng.randrange(1, 20) :]
    changed = bytearray(content)
    for _ in range(rng.choice([1, 1, 2, 4, 16])):
        place = rng.randrange(len(content))
        changed[place] = rng.choice([0, 255, rng.randrange(256), changed[place] ^ 1])
    return bytes(changed)


def assert_read_or_refused(path: Path, platform: Platform) -> bool:
    """Whether it was read."""
    try:
        log = read_log(path, platform)
    except InputError as refusal:
        assert "\n" not in str(refusal)
        assert str(refusal).startswith(str(path))
        assert len(str(refusal)) < LONGEST_MESSAGE
        return False
    assert np.isfinite(log.time).all()
    assert np.isfinite(log.inputs).all()
    assert np.isfinite(log.outputs).all()
    return True


def in_a_fork(command: Sequence[str], output: IO[bytes], patience: float) -> int | None:
    """The reading process as a copy of this one, which has imported the libraries already."""
    process = os.fork()
    if process == 0:
        try:
            os.dup2(output.fileno(), 1)
            os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
            signal.alarm(ENDS)
            sys.argv = ["child", command[-1]]
            child.main()
            os._exit(0)
        finally:
            os._exit(1)
    return os.waitstatus_to_exitcode(os.waitpid(process, 0)[1])


def test_damaged_texts(tmp_path: Path) -> None:
    platform = bench(tmp_path)
    read = 0
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for number, whole in enumerate(write_text_files(tmp_path)):
            rng, content = random.Random(number), whole.read_bytes()
            for _ in range(2 * VARIANTS):
                path = tmp_path / f"damaged{whole.suffix}"
                path.write_bytes(damaged(content, rng))
                read += assert_read_or_refused(path, platform)
    assert read > 0


@pytest.mark.long
@pytest.mark.skipif(not hasattr(os, "fork"), reason="forks are what makes this fast")
def test_damaged_files_of_libraries(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for library in ("h5py", "pyarrow.parquet", "nptdms", "openpyxl", "rosbags.highlevel", "mcap"):
        pytest.importorskip(library)
    monkeypatch.setattr(file_content, "_run", in_a_fork)
    monkeypatch.setattr(child, "ROOM", OF_FORKS)
    topics, columns = bench(tmp_path, "volt/data", "angle/data"), bench(tmp_path)
    read = 0
    for number, whole in enumerate(write_binary_files(tmp_path)):
        platform = topics if whole.suffix in (".bag", ".mcap") else columns
        assert assert_read_or_refused(whole, platform)
        rng, content = random.Random(number), whole.read_bytes()
        for _ in range(VARIANTS):
            path = tmp_path / f"damaged{whole.suffix}"
            path.write_bytes(damaged(content, rng))
            read += assert_read_or_refused(path, platform)
    assert read > 0


def test_a_file_on_which_the_library_crashes_is_refused_in_one_line(tmp_path: Path) -> None:
    """SciPy 1.17 ends the process by a segmentation fault where the flags of an array of 8 bytes
    are said to have the type of a pointer.
    """
    path = tmp_path / "run.mat"
    savemat(path, COLUMNS)
    content = bytearray(path.read_bytes())
    for value in (8, 12, 14, 255):
        content[145] = value
        path.write_bytes(content)
        assert not assert_read_or_refused(path, bench(tmp_path))


def test_a_reader_that_dies_or_does_not_end_is_said(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "run.mat"
    savemat(path, COLUMNS)
    run = file_content._run
    for code, words in (
        ("import os, signal; os.kill(os.getpid(), signal.SIGKILL)", r"ended the process .*code -9"),
        ("import time; time.sleep(60)", "did not end"),
        ("print('[1, 2]')", "ended the process"),
    ):
        command = [sys.executable, "-c", code]
        with monkeypatch.context() as patched:
            patched.setattr(file_content, "_run", lambda _, file, __, c=command: run(c, file, 1.0))
            with pytest.raises(InputError, match=rf"run\.mat: is damaged: .*{words}"):
                read_log(path, bench(tmp_path))


def test_links_of_hdf5_lead_nowhere_or_round_in_a_circle(tmp_path: Path) -> None:
    h5py = pytest.importorskip("h5py")
    with h5py.File(tmp_path / "secret.h5", "w") as file:
        file["secret"] = ANGLE
    with h5py.File(tmp_path / "run.mat", "w", userblock_size=512) as file:
        for name, column in COLUMNS.items():
            file[f"log/{name}"] = column[None, :]
        file["log/again"] = file["/"]
        file["log/itself"] = file["log"]
        file["gone"] = h5py.SoftLink("/not/there")
        file["elsewhere"] = h5py.ExternalLink(str(tmp_path / "secret.h5"), "/secret")
        file["virtual"] = [1.0]
    assert assert_read_or_refused(tmp_path / "run.mat", bench(tmp_path))
    names = [name for name, _ in read_table(tmp_path / "run.mat").headings]
    assert sorted(names) == ["angle", "time", "volt"]


@pytest.mark.parametrize("rows", [7_000_000, 11_000_000, 10**12])
def test_sizes_are_refused_before_anything_is_unfolded(tmp_path: Path, rows: int) -> None:
    """8 TB in 3 kB; and three columns that hold 21 million numbers, of which 20 are allowed."""
    h5py = pytest.importorskip("h5py")
    with h5py.File(tmp_path / "run.mat", "w") as file:
        for name in COLUMNS:
            file.create_dataset(name, (1, rows), "f8", chunks=(1, 10**6), compression="gzip")
    assert (tmp_path / "run.mat").stat().st_size < 20_000
    words = "more than 10000000; split" if rows > 10**7 else "hold 21000000 numbers, more than 2000"
    with pytest.raises(InputError, match=words):
        read_log(tmp_path / "run.mat", bench(tmp_path))


def test_rows_of_parquet_and_of_old_matlab_are_counted_first(tmp_path: Path) -> None:
    pyarrow = pytest.importorskip("pyarrow")
    from pyarrow import parquet as writer

    many = pyarrow.array(np.zeros(10_000_001, dtype=bool))
    writer.write_table(pyarrow.table(dict.fromkeys(COLUMNS, many)), tmp_path / "run.parquet")
    with pytest.raises(InputError, match="has 10000001 rows, more than 10000000"):
        read_log(tmp_path / "run.parquet", bench(tmp_path))
    savemat(tmp_path / "run.mat", COLUMNS)
    content, most = (tmp_path / "run.mat").read_bytes(), struct.pack("<ii", 1, 2**31 - 1)
    (tmp_path / "run.mat").write_bytes(content.replace(struct.pack("<ii", 1, ROWS), most))
    with pytest.raises(InputError, match="has 2147483647 rows, more than 10000000"):
        read_log(tmp_path / "run.mat", bench(tmp_path))


def packed_sheet(path: Path, part: str, pieces: Iterable[bytes]) -> Path:
    """An Excel file with a part made of `pieces`."""
    openpyxl = pytest.importorskip("openpyxl")
    from zipfile import ZIP_DEFLATED, ZipFile

    openpyxl.Workbook().save(path.with_suffix(".whole"))
    with ZipFile(path.with_suffix(".whole")) as whole, ZipFile(path, "w", ZIP_DEFLATED) as packed:
        for entry in whole.infolist():
            if entry.filename != part:
                packed.writestr(entry, whole.read(entry), ZIP_DEFLATED)
        with packed.open(part, "w") as file:
            for piece in pieces:
                file.write(piece)
    return path


SHEET = "xl/worksheets/sheet1.xml"
SPACE = b"http://schemas.openxmlformats.org/spreadsheetml/2006/main"
BEGIN, END = b'<worksheet xmlns="%s"><sheetData>' % SPACE, b"</sheetData></worksheet>"
NOISE = b"".join(b"%d " % (k * 2654435761 % 2**32) for k in range(40_000))


@pytest.mark.parametrize(
    ("part", "pieces", "said"),
    [
        ("xl/sharedStrings.xml", repeat(b" " * 1_000_000, 450), r"45. MB, and 400 MB are allowed"),
        (
            SHEET,
            [BEGIN, *repeat(b"<row><c><v>0</v></c></row>" * 10_000, 100), END],
            r"sheet1\.xml unfolds into \d+ times its size, and 100 times are allowed",
        ),
        pytest.param(
            SHEET,
            [BEGIN, *repeat(NOISE + b"<row/>" * 2_100_000, 10), END],
            r"more than 5000000 cells",
            marks=pytest.mark.long,
        ),
        (
            SHEET,
            [BEGIN, b'<row r="1"><c r="A1"><v>0</v></c></row><row r="2000000"/>', END],
            r"row 1048577, column 0, and 1048576 rows, 1000 columns",
        ),
        pytest.param(
            SHEET,
            [BEGIN, *(b'<row><c r="ALL%d"><v>0</v></c></row>' % k for k in range(1, 21_000)), END],
            r"row 20001, column 1000",
            marks=pytest.mark.long,
        ),
        (SHEET, [BEGIN, b'<row><c r="XFD1"><v>0</v></c></row>', END], r"row 1, column 16384"),
    ],
    ids=["bytes", "ratio", "tags", "gap", "padded", "column"],
)
def test_a_sheet_that_unfolds_is_refused(
    part: str, pieces: Iterable[bytes], said: str, tmp_path: Path
) -> None:
    """Files of a few MB at most that took more than a minute, or memory, to be refused."""
    path = packed_sheet(tmp_path / "run.xlsx", part, pieces)
    started = time.process_time() + os.times().children_user
    with pytest.raises(InputError, match=said):
        read_log(path, bench(tmp_path))
    assert time.process_time() + os.times().children_user - started < 30.0


def test_without_the_library_the_extra_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As the process that reads a file finds it."""
    for library, read, extra in (
        ("h5py", matlab.hdf5_parts, "matlab"),
        ("pyarrow", parquet_parts, "parquet"),
        ("nptdms", tdms_parts, "tdms"),
        ("openpyxl", excel_text, "excel"),
    ):
        monkeypatch.setitem(sys.modules, library, None)
        with pytest.raises(InputError, match=rf"run pip install 'ptp-symbolic\[{extra}\]'"):
            read(tmp_path / "run")


@pytest.mark.parametrize("suffix", [".mat", ".parquet", ".tdms", ".xlsx", ".bag", ".mcap", ".lvm"])
def test_what_is_no_file_is_refused(tmp_path: Path, suffix: str) -> None:
    platform, path = bench(tmp_path), tmp_path / f"run{suffix}"
    assert not assert_read_or_refused(path, platform)
    path.write_bytes(b"")
    assert not assert_read_or_refused(path, platform)
    path.unlink()
    path.mkdir()
    assert not assert_read_or_refused(path, platform)
