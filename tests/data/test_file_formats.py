"""One log as many programs write it reads as the same numbers."""

from pathlib import Path

import numpy as np
import pytest
from scipy.io import savemat

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.data import read_log, remarks
from ptp_symbolic.numeric.data.formats import read_table
from ptp_symbolic.platform import Platform, platform_text, read_platform

ROWS = 20
TIME = 0.005 * np.arange(ROWS)
VOLTAGE = np.round(1.5 * np.cos(np.arange(ROWS)), 3)
DEGREES = np.round(3.25 * np.arange(ROWS) - 7.0, 3)
PLATFORM = """
[platform]
name = "bench"
axes = ["pan"]
[[effects]]
effect = "rigid_bodies"
[signals]
u_pan = { role = "input", column = "volt", unit = "V", noise = 0.0 }
theta_pan = { role = "output", column = "angle", unit = "deg", counts_per_revolution = 4096 }
"""


@pytest.fixture
def platform(tmp_path: Path) -> Platform:
    path = tmp_path / "bench.toml"
    path.write_text(PLATFORM)
    return read_platform(path)


def rows(separator: str = ",", point: str = ".", milliseconds: bool = False) -> str:
    time = 1e3 * TIME if milliseconds else TIME
    lines = (f"{t:.4f}|{u:.3f}|{a:.3f}" for t, u, a in zip(time, VOLTAGE, DEGREES, strict=True))
    return "\n".join(line.replace(".", point).replace("|", separator) for line in lines) + "\n"


def assert_same(path: Path, platform: Platform) -> None:
    log = read_log(path, platform)
    np.testing.assert_allclose(log.time, TIME, atol=1e-12)
    np.testing.assert_allclose(log.inputs[:, 0], VOLTAGE, atol=1e-12)
    np.testing.assert_allclose(log.outputs[:, 0], np.deg2rad(DEGREES), atol=1e-12)


@pytest.mark.parametrize(
    "text",
    [
        "time [s],volt [V],angle [deg]\n" + rows(),
        "t [ms];volt [V];angle [deg]\n" + rows(";", ",", milliseconds=True),
        "Time (ms)\tvolt (V)\tangle (deg)\n" + rows("\t", milliseconds=True),
        "\ufefft [s];volt;angle\n" + rows(";", ","),
        "# bench 3\n% second run\n\ntime [s],volt [V],angle\n" + rows(),
        "# time [s],volt [V],angle [deg]\n" + rows(),
        "time,volt,angle\ns,V,deg\n" + rows(),
        "time;volt;angle\n[ms];[V];-\n" + rows(";", ",", milliseconds=True),
        '"time [s]";"volt [V]";"angle [deg]"\n' + rows(";", ","),
        "time [s],volt [mV],angle [rad]\n"
        + "".join(
            f"{t!r},{1e3 * u!r},{np.deg2rad(a)!r}\n"
            for t, u, a in zip(TIME.tolist(), VOLTAGE.tolist(), DEGREES.tolist(), strict=True)
        )
        .replace("np.float64(", "")
        .replace(")", ""),
    ],
)
def test_texts_of_many_programs_read_the_same(
    tmp_path: Path, platform: Platform, text: str
) -> None:
    path = tmp_path / "run.csv"
    path.write_text(text, encoding="utf-8")
    assert_same(path, platform)


COLUMNS = {"t": TIME, "volt": VOLTAGE, "angle": DEGREES}


def test_matlab_of_both_kinds(tmp_path: Path, platform: Platform) -> None:
    """The names have no units: the platform gives them."""
    path = tmp_path / "units.toml"
    path.write_text(platform_text(platform) + '[log]\ntime = "t"\ntime_unit = "s"\n')
    platform = read_platform(path)
    savemat(tmp_path / "run.mat", {**COLUMNS, "gain": 3.0, "note": "second run"})
    h5py = pytest.importorskip("h5py")
    with h5py.File(tmp_path / "new.mat", "w", userblock_size=512) as file:
        for name, column in COLUMNS.items():
            file[name] = column[None, :]
    savemat(tmp_path / "structure.mat", {"log": COLUMNS, "gain": 3.0})
    with h5py.File(tmp_path / "group.mat", "w", userblock_size=512) as file:
        for name, column in COLUMNS.items():
            file[f"log/{name}"] = column[None, :]
    for name in ("run.mat", "new.mat", "structure.mat", "group.mat"):
        assert_same(tmp_path / name, platform)


def test_fields_that_share_a_name_keep_that_of_their_structure(
    tmp_path: Path, platform: Platform
) -> None:
    savemat(tmp_path / "two.mat", {"first": COLUMNS, "second": COLUMNS})
    names = [name for name, _ in read_table(tmp_path / "two.mat").headings]
    assert names == ["t", "volt", "angle", "second.t", "second.volt", "second.angle"]
    savemat(tmp_path / "none.mat", {"note": "empty"})
    with pytest.raises(InputError, match="the file holds no column of numbers"):
        read_log(tmp_path / "none.mat", platform)


def test_parquet(tmp_path: Path, platform: Platform) -> None:
    pyarrow = pytest.importorskip("pyarrow")
    from pyarrow import parquet

    table = pyarrow.table({"time [s]": TIME, "volt": VOLTAGE, "angle [deg]": DEGREES})
    parquet.write_table(table, tmp_path / "run.parquet")
    assert_same(tmp_path / "run.parquet", platform)


def test_a_damaged_file_is_refused_in_one_line(tmp_path: Path, platform: Platform) -> None:
    for name in ("run.mat", "run.parquet"):
        (tmp_path / name).write_bytes(b"MATLAB 5.0 MAT-file" + bytes(range(200)))
        with pytest.raises(InputError, match=rf"{name}: is not a .* file that can") as error:
            read_log(tmp_path / name, platform)
        assert "\n" not in str(error.value)


@pytest.mark.parametrize("bits", [None, 16])
def test_an_angle_that_wraps_goes_on_and_is_noted(
    tmp_path: Path, platform: Platform, bits: int | None
) -> None:
    """A turn, or a counter of 16 bits at 4096 counts a turn: 16 turns."""
    span = 360.0 if bits is None else 2.0**bits / 4096.0 * 360.0
    angle = np.round(70.0 * np.arange(200) - 900.0, 3)
    wrapped = np.mod(angle + span / 2.0, span) - span / 2.0
    assert np.abs(np.diff(wrapped)).max() > 180.0
    lines = [f"{0.005 * k},0.0,{a:.3f}" for k, a in enumerate(wrapped)]
    path = tmp_path / "run.csv"
    path.write_text("time [s],volt [V],angle [deg]\n" + "\n".join(lines) + "\n")
    log = read_log(path, platform)
    moved = np.degrees(log.outputs[:, 0]) - wrapped[0]
    np.testing.assert_allclose(moved, angle - angle[0], atol=1e-8)
    assert any(f"by {span:g} deg" in text for text in remarks([log], platform))


def test_times_in_ms_that_are_declared_as_s_are_refused_with_the_cure(
    tmp_path: Path, platform: Platform
) -> None:
    text = "time [s],volt [V],angle [deg]\n" + rows(milliseconds=True)
    path = tmp_path / "run.csv"
    path.write_text(text)
    with pytest.raises(InputError, match=r"one sample every 5 s.*write 'time \[ms\]'"):
        read_log(path, platform)
    fast = [f"{k},0.0,{a:.9f}" for k, a in enumerate(DEGREES)]
    path.write_text("time [s],volt [V],angle [deg]\n" + "\n".join(fast) + "\n")
    with pytest.raises(InputError, match=r"one sample every 1 s.*write 'time \[ms\]'"):
        read_log(path, platform)
    path.write_text(text.replace("time [s]", "time [ms]"))
    assert_same(path, platform)


def test_a_clock_without_a_unit_is_asked_for_with_both_answers(
    tmp_path: Path, platform: Platform
) -> None:
    text = "time,volt [V],angle [deg]\n" + rows(milliseconds=True)
    path = tmp_path / "run.csv"
    path.write_text(text)
    with pytest.raises(InputError, match=r"steps of 5; write 'time \[s\]' .* 'time \[ms\]' where"):
        read_log(path, platform)
    path.write_text(text.replace("time,", "time [ms],"))
    assert_same(path, platform)


def test_a_column_without_a_unit_has_that_of_the_platform_after_a_round_trip_too(
    tmp_path: Path, platform: Platform
) -> None:
    path = tmp_path / "run.csv"
    path.write_text("time [s],volt,angle\n" + rows())
    assert_same(path, platform)
    again = tmp_path / "again.toml"
    again.write_text(platform_text(platform))
    assert_same(path, read_platform(again))
