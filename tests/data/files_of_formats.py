"""One short run of a bench, written in every format that logs come in."""

import json
from pathlib import Path

import numpy as np
from scipy.io import savemat

from ptp_symbolic.platform import Platform, read_platform

ROWS = 20
TIME = 0.005 * np.arange(ROWS)
VOLTAGE = np.round(1.5 * np.cos(np.arange(ROWS)), 3)
ANGLE = np.round(0.05 * np.arange(ROWS) - 0.1, 4)
COLUMNS = {"time": TIME, "volt": VOLTAGE, "angle": ANGLE}
SIGNALS = """
[platform]
name = "bench"
axes = ["pan"]
[[effects]]
effect = "rigid_bodies"
[signals]
u_pan = { role = "input", column = "volt", unit = "V", noise = 0.0 }
theta_pan = { role = "output", column = "angle", unit = "rad", counts_per_revolution = 4096 }
[log]
time_unit = "s"
"""


def bench(folder: Path, volt: str = "volt", angle: str = "angle", time: str = "") -> Platform:
    """The platform whose signals have these columns; `time` is that of the times, if not usual."""
    text = SIGNALS.replace('"volt"', json.dumps(volt)).replace('"angle"', json.dumps(angle))
    path = folder / "bench.toml"
    path.write_text(text + (f"time = {json.dumps(time)}\n" if time else ""))
    return read_platform(path)


def text(separator: str = ",", head: str = "time,volt,angle", form: str = "{:.3f}") -> str:
    rows = (
        separator.join([form.format(t), f"{u:.3f}", f"{a:.4f}"])
        for t, u, a in zip(TIME, VOLTAGE, ANGLE, strict=True)
    )
    return "\n".join([head.replace(",", separator), *rows]) + "\n"


def measurement(decimal: str = ".") -> str:
    """A LabVIEW measurement with a header of its own and one of its channels."""
    head = [
        "LabVIEW Measurement\t",
        "Writer_Version\t2",
        "Separator\tTab",
        f"Decimal_Separator\t{decimal}",
        "X_Columns\tOne",
        "***End_of_Header***\t",
        "\t",
        "Channels\t2\t\t",
        f"Samples\t{ROWS}\t{ROWS}\t",
        "Y_Unit_Label\tV\trad\t",
        "X0\t0\t0\t",
        "Delta_X\t0.005\t0.005\t",
        "***End_of_Header***\t\t\t",
        "X_Value\tvolt\tangle\tComment",
    ]
    rows = text("\t").replace(".", decimal).split("\n", 1)[1]
    return "\n".join(head) + "\n" + rows


def write_text_files(folder: Path) -> list[Path]:
    files = {
        "run.csv": text(),
        "run.txt": text(" "),
        "run.lvm": measurement(),
        "excel.csv": "sep=;\n" + text(";").replace(".", ","),
        "stamped.csv": text(form="00:00:{:06.3f}"),
    }
    for name, content in files.items():
        (folder / name).write_text(content)
    return [folder / name for name in files]


def write_tdms(path: Path, **properties: float) -> Path:
    from nptdms import ChannelObject, TdmsWriter

    with TdmsWriter(path) as writer:
        columns = {n: c for n, c in COLUMNS.items() if n != "time" or not properties}
        writer.write_segment(
            [ChannelObject("run", name, column, properties) for name, column in columns.items()]
        )
    return path


def write_excel(path: Path) -> Path:
    from openpyxl import Workbook

    book = Workbook()
    sheet = book.active
    sheet.append(["time [s]", "volt [V]", "angle [rad]"])
    for row in zip(*(column.tolist() for column in COLUMNS.values()), strict=True):
        sheet.append(row)
    book.save(path)
    return path


def write_json_bag(path: Path) -> Path:
    """The topics of this bag are named as the columns are."""
    from mcap.writer import Writer

    with path.open("wb") as file:
        bag = Writer(file)
        bag.start()
        schema = bag.register_schema("state", "jsonschema", b'{"type": "object"}')
        channels = {n: bag.register_channel(n, "json", schema) for n in ("volt", "angle")}
        for k, at in enumerate((1e9 * TIME).astype(int)):
            for name, channel in channels.items():
                content = json.dumps({"data": COLUMNS[name][k]}).encode()
                bag.add_message(channel, int(at) + 10**18, content, int(at) + 10**18)
        bag.finish()
    return path


def write_ros_bag(path: Path) -> Path:
    from rosbags.rosbag1 import Writer
    from rosbags.typesys import Stores, get_typestore

    types = get_typestore(Stores.ROS1_NOETIC)
    name = "std_msgs/msg/Float64"
    with Writer(path) as bag:
        topics = {t: bag.add_connection(t, name, typestore=types) for t in ("volt", "angle")}
        for k, at in enumerate((1e9 * TIME).astype(int)):
            for topic, place in topics.items():
                raw = types.serialize_ros1(types.types[name](COLUMNS[topic][k]), name)
                bag.write(place, int(at) + 10**18, raw)
    return path


def write_binary_files(folder: Path) -> list[Path]:
    import h5py
    import pyarrow
    from pyarrow import parquet

    savemat(folder / "new.mat", COLUMNS)
    savemat(folder / "packed.mat", {"log": COLUMNS, "gain": 2.0}, do_compression=True)
    savemat(folder / "old.mat", COLUMNS, format="4")
    with h5py.File(folder / "newest.mat", "w", userblock_size=512) as file:
        for name, column in COLUMNS.items():
            file[f"log/{name}"] = column[None, :]
    with h5py.File(folder / "chunked.mat", "w", libver="latest") as file:
        for name, column in COLUMNS.items():
            file.create_dataset(name, data=column[None, :], chunks=(1, 10), compression="gzip")
    parquet.write_table(pyarrow.table(COLUMNS), folder / "run.parquet")
    plain = {"compression": "NONE", "use_dictionary": False, "write_statistics": False}
    parquet.write_table(pyarrow.table(COLUMNS), folder / "plain.parquet", **plain)
    write_tdms(folder / "run.tdms")
    write_excel(folder / "run.xlsx")
    write_json_bag(folder / "run.mcap")
    write_ros_bag(folder / "run.bag")
    suffixes = (".mat", ".parquet", ".tdms", ".xlsx", ".mcap", ".bag")
    return sorted(path for path in folder.iterdir() if path.suffix in suffixes)


def write_all(folder: Path) -> tuple[list[Path], Platform]:
    return [*write_text_files(folder), *write_binary_files(folder)], bench(folder)
