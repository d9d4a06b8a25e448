"""Files as programs of this trade write them read as the numbers that were logged."""

import json
import struct
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.io import savemat

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.data import Log, read_log
from ptp_symbolic.numeric.data.formats import read_table, read_tables
from tests.data.files_of_formats import (
    ANGLE,
    COLUMNS,
    ROWS,
    TIME,
    VOLTAGE,
    bench,
    measurement,
    text,
    write_excel,
    write_tdms,
)

pytestmark = pytest.mark.usefixtures("in_this_process")


def assert_same(log: Log) -> None:
    np.testing.assert_allclose(log.time - log.time[0], TIME, atol=1e-6)
    np.testing.assert_allclose(log.inputs[:, 0], VOLTAGE, atol=1e-12)
    np.testing.assert_allclose(log.outputs[:, 0], ANGLE, atol=1e-12)


def written(folder: Path, content: str, name: str = "run.csv") -> Path:
    path = folder / name
    path.write_text(content, encoding="utf-8")
    return path


@pytest.mark.parametrize(
    "content",
    [
        "sep=;\n" + text(";"),
        "sep=,\n" + text(),
        "sep=;\n" + text(";").replace(".", ","),
        '"sep=;"\n' + text(";"),
        "\ufeffsep=;\r\n" + text(";").replace("\n", "\r\n"),
        text("|"),
        text(" "),
        text("   "),
        text(" ").replace(".", ","),
        "# " + text(" "),
        "% " + text(" ", form="{:.18e}"),
        text(" ", head="time [s],volt [V],angle [rad]"),
        "\n".join("  " + line + " " for line in text(" ").splitlines()) + "\n",
        measurement(),
        measurement(","),
        measurement().replace("\n", "\r\n"),
        measurement().replace("Separator\tTab", "Separator\tComma").replace("\t", ","),
    ],
)
def test_texts_of_spreadsheets_savetxt_and_labview(tmp_path: Path, content: str) -> None:
    assert_same(read_log(written(tmp_path, content), bench(tmp_path)))


def test_a_measurement_without_x_values_has_its_times_from_their_start_and_step(
    tmp_path: Path,
) -> None:
    without = measurement().replace("X_Columns\tOne", "X_Columns\tNo")
    head, rows = without.split("X_Value")
    first, *others = rows.splitlines()
    others = ["\t" + row.partition("\t")[2] for row in others]
    assert_same(
        read_log(written(tmp_path, head + "X_Value" + "\n".join([first, *others])), bench(tmp_path))
    )


def test_a_measurement_of_several_segments_says_which_lines_to_keep(tmp_path: Path) -> None:
    """Kept as the line says, the file is read."""
    lines = measurement().rstrip("\n").split("\n")
    short = [*lines[6:14], *lines[14:26]]
    content = "\n".join([*lines, "", *short, ""])
    end = len(lines)
    with pytest.raises(InputError) as error:
        read_log(written(tmp_path, content), bench(tmp_path))
    names = "X_Value, volt, angle, Comment"
    said = (
        f"has 2 segments: lines 8 to {end} ({ROWS} rows of {names}); lines {end + 3} to {end + 21}"
        f" (12 rows of {names}). Keep lines 1 to 7 and those of one segment, 8 to {end} for the"
        " longest,"
    )
    assert said in str(error.value)
    assert "\n" not in str(error.value)
    kept = content.split("\n")[:end]
    assert_same(read_log(written(tmp_path, "\n".join(kept) + "\n"), bench(tmp_path)))
    kept = [*lines[:7], *content.split("\n")[end + 2 : end + 21]]
    assert len(read_log(written(tmp_path, "\n".join(kept) + "\n"), bench(tmp_path)).time) == 12


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (measurement() + "\n" + measurement(), "save one measurement into each file"),
        (measurement().replace("X_Columns\tOne", "X_Columns\tMulti"), "with one X column"),
        ("LabVIEW Measurement\n1\t2\n", "this file 0 of channels; save one measurement"),
    ],
)
def test_other_measurements_of_labview_are_refused_with_the_way_round(
    tmp_path: Path, content: str, message: str
) -> None:
    with pytest.raises(InputError, match=rf"run\.csv: .*LabVIEW.*{message}") as error:
        read_log(written(tmp_path, content), bench(tmp_path))
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    "stamp",
    [
        lambda t: f"{t:.3f} sec",
        lambda t: f"{t * 1e3:g} ms",
        lambda t: f"{t / 60:.9f} min",
        lambda t: f"00:00:{t:06.3f}",
        lambda t: f"00:{t:06.3f}",
        lambda t: f"01:23:59:{t + 59.0:06.3f}",
        lambda t: f"03/30/2024 11:59:{59.9 + t:06.3f} AM" if t < 0.1 else "",
        lambda t: f"11:59:{59.0 + t:06.3f} PM",
        lambda t: f"30-Mar-2024 23:59:{59.0 + t:06.3f}",
        lambda t: f"2024/03/30 23:59:{59.0 + t:06.3f}",
    ],
)
def test_durations_and_clocks_of_matlab(tmp_path: Path, stamp: Any) -> None:
    rows = [",".join([stamp(t), f"{u}", f"{a}"]) for t, u, a in zip(*COLUMNS.values(), strict=True)]
    path = written(tmp_path, "\n".join(["Time,volt,angle", *rows]) + "\n")
    assert_same(read_log(path, bench(tmp_path)))


def test_a_clock_of_twelve_hours_goes_on_after_noon(tmp_path: Path) -> None:
    """12:59 PM is before 1:00 PM, and 11:59 AM before 12:00 PM."""
    for before, after in (
        ("12:59:59.950 PM", "01:00:00.{:03d} PM"),
        ("11:59:59.950 AM", "12:00:00.{:03d} PM"),
    ):
        rows = [f"05/07/2026 {before},0,0"]
        rows += [f"05/07/2026 {after.format(50 * k)},0,{k}" for k in range(12)]
        path = written(tmp_path, "\n".join(["time,volt,angle", *rows]) + "\n")
        time = read_log(path, bench(tmp_path)).time
        np.testing.assert_allclose(np.diff(time), 0.05, atol=1e-6)


def test_a_column_that_holds_no_numbers_is_not_answered_by_removing_every_row(
    tmp_path: Path,
) -> None:
    path = written(tmp_path, text(form="at {:.3f}"))
    with pytest.raises(InputError, match=r"'time' is 'at 0.000', and no row has a number") as error:
        read_log(path, bench(tmp_path))
    assert "remove" not in str(error.value)


def test_messages_that_rostopic_echoes(tmp_path: Path) -> None:
    """The header begins with a percent sign; rows hold names, and empty frame ids."""
    head = "%time,field.header.frame_id,field.name0,field.volt,field.angle"
    rows = [
        f"{1690000000000000000 + round(1e9 * t)},,pan,{u},{a}"
        for t, u, a in zip(*COLUMNS.values(), strict=True)
    ]
    path = written(tmp_path, "\n".join([head, *rows]) + "\n")
    for time in ("%time", "time"):
        platform = bench(tmp_path, "field.volt", "field.angle", time)
        platform_file = tmp_path / "bench.toml"
        platform_file.write_text(platform_file.read_text().replace('"s"', '"ns"'))
        from ptp_symbolic.platform import read_platform

        assert platform.clock.column == time
        assert_same(read_log(path, read_platform(platform_file)))


def test_columns_of_an_outer_join_have_samples_of_their_own(tmp_path: Path) -> None:
    """Angles every 10 ms, voltages 5 ms after them: each row has one of both."""
    count = 24
    angle = [f"{0.01 * k:.3f},,{0.02 * k:.4f}" for k in range(count)]
    volt = [f"{0.01 * k + 0.005:.3f},{k % 5},nan" for k in range(count)]
    joined = [row for pair in zip(angle, volt, strict=True) for row in pair]
    log = read_log(written(tmp_path, "\n".join(["time,volt,angle", *joined])), bench(tmp_path))
    np.testing.assert_allclose(log.time, 0.01 * np.arange(1, count), atol=1e-12)
    np.testing.assert_allclose(log.outputs[:, 0], 0.02 * np.arange(1, count), atol=1e-12)
    steps, values = log.steps[0]
    np.testing.assert_allclose(steps, 0.01 * np.arange(count) + 0.005, atol=1e-12)
    np.testing.assert_array_equal(values, np.arange(count) % 5)


def test_rows_of_other_columns_are_passed_over_and_a_lost_value_is_not(tmp_path: Path) -> None:
    rows = [f"{t},{u},{a}," for t, u, a in zip(*COLUMNS.values(), strict=True)]
    others = [f"{t + 0.002},,,7" for t in TIME]
    mixed = [row for pair in zip(rows, others, strict=True) for row in pair]
    path = written(tmp_path, "\n".join(["time,volt,angle,heat", *mixed]) + "\n")
    assert_same(read_log(path, bench(tmp_path)))
    lost = "\n".join(["time,volt,angle,heat", *mixed]).replace(f"{VOLTAGE[4]},", ",", 1)
    with pytest.raises(InputError, match=r"run.csv:10: 'volt' is missing; every row needs a value"):
        read_log(written(tmp_path, lost), bench(tmp_path))


def test_excel_and_tdms(tmp_path: Path) -> None:
    pytest.importorskip("openpyxl")
    pytest.importorskip("nptdms")
    platform = bench(tmp_path)
    assert_same(read_log(write_excel(tmp_path / "run.xlsx"), platform))
    assert_same(read_log(write_tdms(tmp_path / "run.tdms"), platform))
    waveform = {"wf_increment": 0.005, "wf_start_offset": 0.0}
    assert_same(read_log(write_tdms(tmp_path / "wave.tdms", **waveform), platform))


def test_structures_of_simulink(tmp_path: Path) -> None:
    """Times that Simulink logs are in s; columns of matrices are named as MATLAB splits them."""
    matrix = np.column_stack([VOLTAGE, ANGLE])
    signals = [{"values": VOLTAGE[:, None], "label": "volt"}, {"values": ANGLE, "label": "angle"}]
    named = {"time": TIME, "signals": np.array(signals, dtype=object), "blockName": "m/Scope"}
    scope = {"time": TIME, "signals": {"values": matrix, "label": "x", "dimensions": 2.0}}
    in_time = {"time": TIME, "signals": {"values": matrix.T.reshape(2, 1, ROWS), "label": ""}}
    for content, volt, angle in (
        ({"tout": TIME, "yout": matrix}, "yout_1", "yout_2"),
        ({"tout": TIME[None, :], "yout": matrix.T}, "yout_1", "yout_2"),
        ({"simout": named}, "volt", "angle"),
        ({"ScopeData": scope}, "x_1", "x_2"),
        ({"S": in_time}, "S.signals.values_1", "S.signals.values_2"),
    ):
        savemat(tmp_path / "run.mat", content)
        platform = bench(tmp_path, volt, angle)
        assert_same(read_log(tmp_path / "run.mat", platform))
        with pytest.raises(InputError) as error:
            read_log(tmp_path / "run.mat", bench(tmp_path, "none", angle))
        assert volt in str(error.value)


def test_structures_of_dspace(tmp_path: Path) -> None:
    x = {"Name": "host_service", "Data": TIME, "Unit": "s"}
    y = [
        {"Name": '"Model Root"/volt/In1', "Data": VOLTAGE, "XIndex": 1.0},
        {"Name": "Platform()://Model Root/angle/Out1", "Data": ANGLE, "XIndex": 1.0},
    ]
    record = {"X": x, "Y": np.array(y, dtype=object), "Description": "x"}
    savemat(tmp_path / "run.mat", {"exp_001": record})
    assert_same(read_log(tmp_path / "run.mat", bench(tmp_path)))
    alike = [
        {**part, "Name": f"{part['Name'].split('/')[0]}{k}/same/In1"} for k, part in enumerate(y)
    ]
    savemat(tmp_path / "run.mat", {"exp_001": {**record, "Y": np.array(alike, dtype=object)}})
    names = [name for name, _ in read_table(tmp_path / "run.mat").headings]
    assert names[0] == "time"
    assert all(name.endswith("/same/In1") for name in names[1:])


def test_matrices_of_matlab_7_3_are_those_of_older_files(tmp_path: Path) -> None:
    h5py = pytest.importorskip("h5py")
    with h5py.File(tmp_path / "run.mat", "w", userblock_size=512) as file:
        file["tout"] = TIME[None, :]
        file["yout"] = np.column_stack([VOLTAGE, ANGLE]).T
    assert_same(read_log(tmp_path / "run.mat", bench(tmp_path, "yout_1", "yout_2")))


def element(kind: int, content: bytes) -> bytes:
    """An element of a MATLAB 5 file, filled up to 8 bytes."""
    return struct.pack("<II", kind, len(content)) + content + b"\0" * (-len(content) % 8)


def test_objects_of_matlab_are_named_with_what_to_save(tmp_path: Path) -> None:
    """A timeseries is an opaque array (class 17) with its name, "MCOS" and its class in 5 to 7, and
    a dataset with the attribute MATLAB_object_decode in 7.3.
    """
    h5py = pytest.importorskip("h5py")
    reference = element(6, struct.pack("<II", 13, 0)) + element(5, struct.pack("<ii", 1, 6))
    reference += element(1, b"") + element(6, struct.pack("<6I", 3707764736, 2, 1, 1, 1, 1))
    names = b"".join(element(1, text) for text in (b"ts", b"MCOS", b"timeseries"))
    opaque = element(6, struct.pack("<II", 17, 0)) + names + element(14, reference)
    savemat(tmp_path / "old.mat", {"gain": 2.0})
    with (tmp_path / "old.mat").open("ab") as file:
        file.write(element(14, opaque))
    with h5py.File(tmp_path / "new.mat", "w", userblock_size=512) as file:
        file["ts"] = np.zeros((1, 6), dtype=np.uint32)
        file["ts"].attrs["MATLAB_object_decode"] = np.int32(3)
    for name in ("old.mat", "new.mat"):
        with pytest.raises(InputError, match=r"can be read by MATLAB alone.*save\('log.mat'") as no:
            read_log(tmp_path / name, bench(tmp_path))
        assert "no column of numbers" in str(no.value)
    savemat(tmp_path / "old.mat", COLUMNS)
    with (tmp_path / "old.mat").open("ab") as file:
        file.write(element(14, opaque))
    assert_same(read_log(tmp_path / "old.mat", bench(tmp_path)))


@pytest.mark.parametrize(
    ("begin", "words"),
    [
        (b"\xd0\xcf\x11\xe0\xa1\xb1", r"Excel file of before 2007 \(\.xls\); save it as \.xlsx"),
        (b"PK\x03\x04", "zip archive.*name it .xlsx"),
        (b"MDF     4.10", "MDF file"),
        (b"\x93NUMPY", "NumPy file"),
        (b"TDSm", "name it .tdms"),
    ],
)
def test_what_is_no_text_is_named_with_the_way_round(
    tmp_path: Path, begin: bytes, words: str
) -> None:
    for name in ("run.csv", "run.xls"):
        (tmp_path / name).write_bytes(begin + bytes(100))
        with pytest.raises(InputError, match=rf"{name}: is .*{words}.*, or save the log as CSV"):
            read_log(tmp_path / name, bench(tmp_path))


def test_dates_and_durations_of_parquet_are_times(tmp_path: Path) -> None:
    pyarrow = pytest.importorskip("pyarrow")
    from pyarrow import parquet

    since = np.rint(1e9 * TIME).astype("timedelta64[ns]")
    for time in (since, np.datetime64("2024-03-30T12:00:00", "ns") + since):
        table = pyarrow.table({**COLUMNS, "time": time})
        parquet.write_table(table, tmp_path / "run.parquet")
        assert_same(read_log(tmp_path / "run.parquet", bench(tmp_path)))


def test_groups_of_channels_are_tables_with_their_own_clocks(tmp_path: Path) -> None:
    nptdms = pytest.importorskip("nptdms")
    with nptdms.TdmsWriter(tmp_path / "run.tdms") as writer:
        channels = [
            nptdms.ChannelObject(group, name, COLUMNS[name], {"wf_increment": 0.005})
            for group, name in (("drive", "volt"), ("encoder", "angle"))
        ]
        writer.write_segment(channels)
    assert_same(read_log(tmp_path / "run.tdms", bench(tmp_path)))
    assert [t.head.rpartition(": ")[2] for t in read_tables(tmp_path / "run.tdms")] == [
        "group drive",
        "group encoder",
    ]
    with pytest.raises(InputError, match=r"holds 2 tables .*group drive.*; save one alone"):
        read_table(tmp_path / "run.tdms")


def test_a_column_that_a_spreadsheet_would_run_is_refused(tmp_path: Path) -> None:
    for name in ("=cmd|' /C calc'!A0", "+1", "-2", "@SUM(A1)"):
        with pytest.raises(InputError, match="a spreadsheet runs such a cell") as error:
            bench(tmp_path, name)
        assert json.dumps(name)[1:4].strip('"') in str(error.value)
