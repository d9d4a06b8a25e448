"""Logs arrive in SI and in the platform's order, and a bad file is refused with its line."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.data import Log, log_files, read_inputs, read_log, read_logs
from ptp_symbolic.platform import Platform, SignalDeclaration

PLATFORM = Platform(
    name="bench",
    title="bench",
    axes=("pan",),
    gravity=9.81,
    effects=(),
    parameters=(),
    signals=(
        SignalDeclaration("theta_pan", "pan_angle", "rad", "output", 7200),
        SignalDeclaration("u_pan", "pan_voltage", "V", "input"),
        SignalDeclaration("i_pan", "pan_current", "A", "output"),
    ),
)
HEADER = "time [s],pan_voltage [V],pan_current [A],pan_angle [rad]"
ROWS = [f"{0.005 * k:.4f},{1.5 * k:.2f},{-0.25 * k:.3f},{0.1 * k:.6f}" for k in range(12)]
GOOD = "\n".join([HEADER, *ROWS]) + "\n"


def write(folder: Path, text: str | bytes, name: str = "run.csv") -> Path:
    path = folder / name
    path.write_bytes(text.encode() if isinstance(text, str) else text)
    return path


def assert_good(log: Log) -> None:
    k = np.arange(12)
    np.testing.assert_allclose(log.time, 0.005 * k, rtol=0, atol=1e-15)
    np.testing.assert_allclose(log.inputs, (1.5 * k)[:, None], rtol=1e-15)
    np.testing.assert_allclose(log.outputs, np.stack([0.1 * k, -0.25 * k], axis=1), rtol=1e-14)
    for values in (log.time, log.inputs, log.outputs):
        assert values.dtype == np.float64
        assert values.flags.c_contiguous
        assert values.flags.writeable


def test_columns_come_in_the_order_of_the_platform(tmp_path: Path) -> None:
    log = read_log(write(tmp_path, GOOD), PLATFORM)
    assert log.name == "run"
    assert_good(log)


@pytest.mark.parametrize(
    "text",
    [
        "\ufeff" + GOOD,
        GOOD.replace("\n", "\r\n"),
        GOOD.replace("\n", "\r"),
        GOOD.rstrip("\n"),
        GOOD + "\n\n",
        GOOD.replace(",", " , "),
        GOOD.replace("1.50,", "+.15E+1,"),
        GOOD.replace(HEADER, '"time [s]","pan_voltage [V]","pan_current [A]","pan_angle [rad]"'),
    ],
)
def test_files_of_other_programs_read_the_same(tmp_path: Path, text: str) -> None:
    assert_good(read_log(write(tmp_path, text), PLATFORM))


def test_columns_that_the_platform_does_not_name_may_hold_anything(tmp_path: Path) -> None:
    rows = [f'{row},"ok, nan",' for row in ROWS]
    text = "\n".join([HEADER + ",note,temperature [K]", *rows])
    assert_good(read_log(write(tmp_path, text), PLATFORM))


def test_units_of_the_header_are_converted(tmp_path: Path) -> None:
    header = "time [s],pan_voltage [mV],pan_current [A],pan_angle [deg]"
    log = read_log(write(tmp_path, GOOD.replace(HEADER, header)), PLATFORM)
    k = np.arange(12)
    np.testing.assert_allclose(log.inputs[:, 0], 1.5e-3 * k, rtol=1e-14)
    np.testing.assert_allclose(log.outputs[:, 0], np.deg2rad(0.1 * k), rtol=1e-14)


def test_irregular_sampling_is_kept(tmp_path: Path) -> None:
    text = GOOD.replace("\n0.0100,", "\n0.0051,").replace("\n0.0550,", "\n7.5000,")
    log = read_log(write(tmp_path, text), PLATFORM)
    assert log.time[2] == 0.0051
    assert log.time[-1] == 7.5


def test_inputs_alone_drive_a_simulation(tmp_path: Path) -> None:
    text = "time [s],pan_voltage [V]\n" + "".join(f"{k},{-k}\n" for k in range(12))
    path = write(tmp_path, text)
    instants, inputs = read_inputs(path, PLATFORM)
    np.testing.assert_array_equal(instants, np.arange(12.0))
    np.testing.assert_array_equal(inputs, -np.arange(12.0)[:, None])
    with pytest.raises(InputError, match="signal 'pan_angle', 'pan_current' is missing; "):
        read_log(path, PLATFORM)


# (what is replaced, by what, what the refusal says); line 1 is the header, line 5 holds 4.50 V
HEADER_REFUSALS = [
    (
        "time [s]",
        "clock [s]",
        r"run.csv:1: column 'time \[s\]' is missing; the header has clock \[s\], ",
    ),
    (
        "time [s]",
        "time",
        r"no unit, and mostly steps of 0.005; write 'time \[s\]' where that is 0.0",
    ),
    ("time [s]", "time [rad]", r"run.csv:1: column 'time' is in rad, but time is in s; correct"),
    (HEADER + "\n", "", r"run.csv:1: begins with numbers; give a header row such as"),
    (HEADER, HEADER.replace(",", ";"), r"run.csv:1: the header has semicolons between columns and"),
    (
        HEADER,
        HEADER.replace(",", "\t"),
        r"the header has tabs between columns and the row below has",
    ),
    ("pan_angle", "angle", r"run.csv:1: signal 'pan_angle' is missing; .*, angle \[rad\]\.$"),
    ("[rad]", "[V]", r"run.csv:1: column 'pan_angle' is in V, but theta_pan is in rad; correct"),
    ("[rad]", "[count]", r"run.csv:1: column 'pan_angle' is in count, but theta_pan is in rad"),
    ("[rad]", "[rod/2/]", r"run.csv:1: column 'pan_angle': 'rod/2/' is not a unit"),
    ("[rad]", "[degC]", r"run.csv:1: column 'pan_angle': Unit 'degree_Celsius' has an offset"),
    ("pan_current [A]", "pan_angle [deg]", r"run.csv:1: column 'pan_angle' is there twice"),
    ("pan_current", "time", r"run.csv:1: column 'time' is there twice; remove one"),
    ("[rad]", "[rad", r"run.csv:1: heading 'pan_angle \[rad' is not of the form 'name \[unit\]'"),
    (HEADER, HEADER + ",x" * 1000, r"run.csv:1: has more than 1000 columns; leave out some"),
    (HEADER, HEADER + ",x" * 2, r"run.csv:1: column 'x' is there twice; remove one"),
    (HEADER, "x" * 100_001, r"run.csv:1: line has more than 100000 characters; is this a CSV"),
]
ROW_REFUSALS = [
    (",4.50,", ",", r"run.csv:5: has 3 cells where the header has 4; the row is truncated"),
    (",4.50,", ",4,50,", r"run.csv:5: has 5 cells where the header has 4"),
    (",4.50,", ",,", r"run.csv:5: 'pan_voltage' is missing; every row needs a value"),
    ("0.0150,4.50,", ",4.50,", r"run.csv:5: 'time' is missing; every row needs a value"),
    (",4.50,", ",nan,", r"run.csv:5: 'pan_voltage' is 'nan', not a finite .*remove the row"),
    (",4.50,", ",-inf,", r"run.csv:5: 'pan_voltage' is '-inf', not a finite"),
    (",4.50,", ",1e999,", r"run.csv:5: 'pan_voltage' is '1e999', not a finite"),
    (",4.50,", ",four,", r"run.csv:5: 'pan_voltage' is 'four', not a finite"),
    (",4.50,", ",4_5,", r"run.csv:5: 'pan_voltage' is '4_5', not a finite"),
    (",4.50,", ",٤,", r"run.csv:5: 'pan_voltage' is '٤', not a finite"),
    (",4.50,", ",0x1p3,", r"run.csv:5: 'pan_voltage' is '0x1p3', not a finite"),
    (",4.50,", ",4.5 0,", r"run.csv:5: 'pan_voltage' is '4.5 0', not a finite"),
    (",4.50,", ",--4,", r"run.csv:5: 'pan_voltage' is '--4', not a finite"),
    (",4.50,", ",1e,", r"run.csv:5: 'pan_voltage' is '1e', not a finite"),
    (",4.50,", ",=1+1,", r"run.csv:5: 'pan_voltage' is '=1\+1', not a finite"),
    (",4.50,", f",{'4' * 5000}x,", r"run.csv:5: 'pan_voltage' is '44+\.\.\., not a finite"),
    ("\n0.0150,", "\n\n0.0150,", r"run.csv:5: has 1 cells where the header has 4"),
    ("\n0.0150,", "\n0.0100,", r"run.csv:5: time 0.01 s repeats 0.01 s of the line before; time"),
    ("\n0.0150,", "\n0.0099,", r"run.csv:5: time 0.0099 s goes back from 0.01 s of the line"),
    (",1.100000\n", ",1.1000", r"run.csv:13: the last number has 4 decimals where all others have"),
    (",1.100000\n", ",1", r"run.csv:13: the last number has 0 decimals where all others have 6"),
    (",1.100000\n", ",", r"run.csv:13: 'pan_angle' is missing"),
    (",-2.750,1.100000\n", ",-2.7", r"run.csv:13: has 3 cells where the header has 4"),
    ("\n".join(ROWS[3:]), "", r"run.csv: has 3 rows of numbers; a log needs at least 10"),
    ("\n".join(ROWS), "", r"run.csv: has 0 rows of numbers"),
]


@pytest.mark.parametrize(("old", "new", "message"), HEADER_REFUSALS + ROW_REFUSALS)
def test_a_bad_log_is_refused_in_one_line(tmp_path: Path, old: str, new: str, message: str) -> None:
    assert GOOD.count(old) == 1
    path = write(tmp_path, GOOD.replace(old, new))
    with pytest.raises(InputError, match=message) as refusal:
        read_log(path, PLATFORM)
    assert "\n" not in str(refusal.value)
    assert str(refusal.value).startswith(str(path))
    assert len(str(refusal.value)) < len(str(path)) + 400


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", r"run.csv: is empty; give a CSV with a header row such as 'time \[s\]"),
        (b"\n \n", "run.csv: is empty"),
        (GOOD.encode().replace(b"4.50", b"4.\x000"), r"run.csv:5: is not text \(byte 0x00\)"),
        (GOOD.encode().replace(b"4.50", b"\xb0"), r"run.csv:5: 'pan_voltage' is '°', not a finite"),
        (GOOD.encode() + b"\x89PNG\r\n\x1a\n\0\0", r"run.csv:16: is not text \(byte 0x00\)"),
    ],
)
def test_a_file_that_is_no_csv_is_refused(tmp_path: Path, content: bytes, message: str) -> None:
    with pytest.raises(InputError, match=message):
        read_log(write(tmp_path, content), PLATFORM)


def test_time_may_be_in_any_unit_of_time(tmp_path: Path) -> None:
    rows = [f"{5.0 * k:.1f},{row.partition(',')[2]}" for k, row in enumerate(ROWS)]
    text = "\n".join([HEADER.replace("[s]", "[ms]"), *rows]) + "\n"
    assert_good(read_log(write(tmp_path, text), PLATFORM))
    path = write(tmp_path, text.replace("\n15.0,", "\n10.0,"))
    with pytest.raises(InputError, match=r"run.csv:5: time 10.0 ms repeats 10.0 ms of the line"):
        read_log(path, PLATFORM)


def test_missing_folder_and_oversized_files_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="no such file; give the path of a CSV log"):
        read_log(tmp_path / "none.csv", PLATFORM)
    with pytest.raises(InputError, match="is a folder; give a CSV log"):
        read_log(tmp_path, PLATFORM)
    with (tmp_path / "huge.csv").open("wb") as file:
        file.truncate(200_000_001)  # a file with a hole: takes no room on the disk
    with pytest.raises(InputError, match="is larger than 200 MB, the most for a CSV log"):
        read_log(tmp_path / "huge.csv", PLATFORM)


def test_a_platform_without_signals_of_a_role_is_refused(tmp_path: Path) -> None:
    path = write(tmp_path, GOOD)
    silent = Platform("bench", "bench", ("pan",), 9.81, (), (), ())
    with pytest.raises(InputError, match="'bench' has no output signal"):
        read_log(path, silent)
    with pytest.raises(InputError, match="'bench' has no input signal"):
        read_inputs(path, silent)
    free = Platform("bench", "bench", ("pan",), 9.81, (), (), PLATFORM.signals[:1])
    assert read_log(path, free).inputs.shape == (12, 0)


def test_an_error_far_into_a_long_log_is_found(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("ptp_symbolic.numeric.data.formats._CHUNK", 1000)
    rows = [f"{k / 200:.3f},{k % 7},{k % 5},{k % 3}" for k in range(20_000)]
    text = "\n".join([HEADER, *rows]) + "\n"
    whole = read_log(write(tmp_path, text), PLATFORM)
    np.testing.assert_array_equal(whole.inputs[:, 0], np.arange(20_000) % 7)
    path = write(tmp_path, text.replace("\n95.000,", "\n95.000,x"))
    with pytest.raises(InputError, match=r"run.csv:19002: 'pan_voltage' is 'x2', not"):
        read_log(path, PLATFORM)
    empty_line = write(tmp_path, text.replace("\n95.000,", "\n\n95.000,"))
    with pytest.raises(InputError, match=r"run.csv:19002: has 1 cells"):
        read_log(empty_line, PLATFORM)


def test_many_rows_are_read_as_numpy_reads_them(tmp_path: Path) -> None:
    random = np.random.default_rng(1)
    table = np.column_stack([np.arange(5000) / 200, random.normal(size=(5000, 3))])
    path = tmp_path / "run.csv"
    np.savetxt(path, table, delimiter=",", header=HEADER, comments="")
    log = read_log(path, PLATFORM)
    peer = np.loadtxt(path, delimiter=",", skiprows=1)
    np.testing.assert_array_equal(log.inputs[:, 0], peer[:, 1])
    np.testing.assert_array_equal(log.outputs, peer[:, [3, 2]])


def test_files_and_folders_are_read_in_order_with_names_of_their_own(tmp_path: Path) -> None:
    for name in ("train/step.csv", "train/crawl.csv", "validate/crawl.csv", "train/.hidden.csv"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        write(tmp_path, GOOD, name)
    write(tmp_path, "not a log", "train/notes.txt")
    logs = read_logs([tmp_path / "train", tmp_path / "validate" / "crawl.csv"], PLATFORM)
    assert [log.name for log in logs] == ["train/crawl", "step", "validate/crawl"]
    for log in logs:
        assert_good(log)
    for name in ("one/train/a.csv", "two/train/a.csv"):
        (tmp_path / name).parent.mkdir(parents=True)
        write(tmp_path, GOOD, name)
    logs = read_logs([tmp_path / "one" / "train", tmp_path / "two" / "train"], PLATFORM)
    assert [log.name for log in logs] == ["one/train/a", "two/train/a"]


def test_a_pattern_stands_for_the_logs_that_it_matches(tmp_path: Path) -> None:
    for name in ("b1.csv", "b2.csv", "c.csv", "more/b3.csv", "odd/a[1].csv"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        write(tmp_path, GOOD.replace("0.1", f"0.1{len(name)}"), name)

    def found(pattern: str) -> list[str]:
        return [file.relative_to(tmp_path).as_posix() for file in log_files([tmp_path / pattern])]

    assert found("b*.csv") == ["b1.csv", "b2.csv"]
    assert found("**/b?.csv") == ["b1.csv", "b2.csv", "more/b3.csv"]
    assert found("mo*") == ["more/b3.csv"]
    assert found("odd/a[1].csv") == ["odd/a[1].csv"]
    with pytest.raises(InputError, match=r"d\*\.csv: no file has such a name"):
        found("d*.csv")


def test_lists_without_logs_or_with_one_twice_are_refused(tmp_path: Path) -> None:
    path = write(tmp_path, GOOD)
    (tmp_path / "empty").mkdir()
    with pytest.raises(InputError, match="No log is given"):
        read_logs([], PLATFORM)
    with pytest.raises(InputError, match=r"empty: the folder has no logs \(\*\.csv, \*\.mat"):
        read_logs([tmp_path / "empty"], PLATFORM)
    with pytest.raises(InputError, match=r"run.csv: is given twice; name each log once"):
        read_logs([path, tmp_path], PLATFORM)


@settings(
    max_examples=200, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(
    st.lists(
        st.tuples(st.integers(0, len(GOOD) - 1), st.binary(max_size=3), st.integers(0, 30)),
        min_size=1,
        max_size=4,
    )
)
def test_a_damaged_log_is_read_or_refused_in_one_line(
    tmp_path: Path, damage: list[tuple[int, bytes, int]]
) -> None:
    content = GOOD.encode()
    for place, inserted, removed in damage:
        content = content[:place] + inserted + content[place + removed :]
    path = write(tmp_path, content)
    try:
        log = read_log(path, PLATFORM)
    except InputError as refusal:
        assert "\n" not in str(refusal)
        assert str(refusal).startswith(str(path))
    else:
        assert np.isfinite(np.hstack([log.inputs, log.outputs])).all()
        assert (np.diff(log.time) > 0).all()
