"""A bag that rosbags has written: topics with clocks of their own become one log."""

import json
import sys
from pathlib import Path

import numpy as np
import pytest

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.data import log_files, read_log, stored_at
from ptp_symbolic.numeric.files.bags import parts
from ptp_symbolic.platform import Platform, read_platform

pytest.importorskip("rosbags")
pytest.importorskip("mcap")

from mcap.writer import Writer as JsonWriter
from rosbags.rosbag1 import Writer as Writer1
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

pytestmark = pytest.mark.usefixtures("in_this_process")

START = 1_700_000_000_123_456_789  # ns
PERIOD = 5_000_000  # ns
ANGLES = np.round(np.linspace(-0.2, 0.6, 60), 4)
VOLTAGES = np.round(np.sin(0.2 * np.arange(60)), 4)
PLATFORM = """
[platform]
name = "bench"
axes = ["pan"]
[[effects]]
effect = "rigid_bodies"
[signals]
u_pan = { role = "input", column = "/drive/voltage/data", unit = "V", noise = 0.0 }
"""
ANGLE = (
    'theta_pan = { role = "output", column = "NAME", unit = "rad", counts_per_revolution = 7200 }'
)


@pytest.fixture
def platform(tmp_path: Path) -> Platform:
    return platform_with(tmp_path, "/joint_states/position/pan")


def platform_with(folder: Path, column: str) -> Platform:
    path = folder / "bench.toml"
    path.write_text(PLATFORM + ANGLE.replace("NAME", column) + "\n")
    return read_platform(path)


def write_bag(folder: Path, storage: StoragePlugin = StoragePlugin.MCAP) -> Path:
    """Joint states, recorded 1 ms after their stamps; voltages 2 ms after the stamps, no header."""
    types = get_typestore(Stores.ROS2_HUMBLE)
    states, header, stamp, number = (
        types.types[name]
        for name in (
            "sensor_msgs/msg/JointState",
            "std_msgs/msg/Header",
            "builtin_interfaces/msg/Time",
            "std_msgs/msg/Float64",
        )
    )
    with Writer(folder, version=9, storage_plugin=storage) as bag:
        joints = bag.add_connection("/joint_states", states.__msgtype__, typestore=types)
        drive = bag.add_connection("/drive/voltage", number.__msgtype__, typestore=types)
        note = bag.add_connection("/note", "std_msgs/msg/String", typestore=types)
        text = types.types["std_msgs/msg/String"]("begin")
        bag.write(note, START, types.serialize_cdr(text, "std_msgs/msg/String"))
        none = np.zeros(0)
        for k, (angle, voltage) in enumerate(zip(ANGLES, VOLTAGES, strict=True)):
            at = START + k * PERIOD
            when = header(stamp(at // 10**9, at % 10**9), "base")
            message = states(when, ["tilt", "pan"], np.array([9.0, angle]), none, none)
            raw = types.serialize_cdr(message, states.__msgtype__)
            bag.write(joints, at + 1_000_000, raw)
            raw = types.serialize_cdr(number(voltage), number.__msgtype__)
            bag.write(drive, at + 2_000_000, raw)
    return folder


@pytest.mark.parametrize("storage", [StoragePlugin.MCAP, StoragePlugin.SQLITE3])
@pytest.mark.parametrize("field", ["pan", "1"])
def test_a_bag_is_read_on_the_stamps_of_the_encoder(
    tmp_path: Path, storage: StoragePlugin, field: str
) -> None:
    platform = platform_with(tmp_path, f"/joint_states/position/{field}")
    log = read_log(write_bag(tmp_path / "run", storage), platform)
    # the first voltage comes 2 ms after the first angle: from the second on all is known
    np.testing.assert_allclose(log.time, 0.005 * np.arange(1, 60), atol=1e-9)
    np.testing.assert_allclose(log.outputs[:, 0], ANGLES[1:], atol=1e-12)
    mean = 0.4 * VOLTAGES[:-1] + 0.6 * VOLTAGES[1:]  # held: 2 ms of the last, 3 ms of the next
    np.testing.assert_allclose(log.inputs[:-1, 0], mean[:-1], atol=1e-6)
    np.testing.assert_allclose(log.steps[0][0], 0.002 + 0.005 * np.arange(60), atol=1e-9)
    np.testing.assert_allclose(log.steps[0][1], VOLTAGES)


def test_a_process_of_its_own_reads_the_same(
    tmp_path: Path, platform: Platform, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.undo()
    log = read_log(write_bag(tmp_path / "run"), platform)
    np.testing.assert_allclose(log.outputs[:, 0], ANGLES[1:], atol=1e-12)


def test_a_bag_of_ros_1(tmp_path: Path) -> None:
    """Two topics without headers, each recorded at once: the times are those of the recording."""
    types = get_typestore(Stores.ROS1_NOETIC)
    name = "std_msgs/msg/Float64"
    with Writer1(tmp_path / "run.bag") as bag:
        places = [
            bag.add_connection(t, name, typestore=types) for t in ("/angle", "/drive/voltage")
        ]
        for k, pair in enumerate(zip(ANGLES, VOLTAGES, strict=True)):
            for place, number in zip(places, pair, strict=True):
                raw = types.serialize_ros1(types.types[name](number), name)
                bag.write(place, START + k * PERIOD, raw)
    log = read_log(tmp_path / "run.bag", platform_with(tmp_path, "/angle/data"))
    np.testing.assert_allclose(log.time, 0.005 * np.arange(60), atol=1e-9)
    np.testing.assert_allclose(log.outputs[:, 0], ANGLES, atol=1e-12)
    np.testing.assert_allclose(log.inputs[:, 0], VOLTAGES, atol=1e-12)
    assert log.steps == ()


def test_a_bag_is_a_file_or_a_folder(tmp_path: Path, platform: Platform) -> None:
    bag = write_bag(tmp_path / "logs" / "run")
    (stored,) = bag.glob("*.mcap")
    whole, alone = read_log(bag, platform), read_log(stored, platform)
    np.testing.assert_array_equal(whole.outputs, alone.outputs)
    assert log_files([tmp_path / "logs"]) == [bag]
    assert log_files([bag]) == [bag]
    assert stored_at(bag) == sorted([bag / "metadata.yaml", stored])


def test_what_a_bag_lacks_is_named_with_what_it_has(tmp_path: Path) -> None:
    bag = write_bag(tmp_path / "run")
    platform = platform_with(tmp_path, "/joint_states/position/roll")
    with pytest.raises(InputError, match=r"position/roll' is missing; .*position/0.*position/pan"):
        read_log(bag, platform)


def test_a_damaged_bag_is_refused_in_one_line(tmp_path: Path, platform: Platform) -> None:
    (stored,) = write_bag(tmp_path / "run").glob("*.mcap")
    whole = stored.read_bytes()
    for name, content in (("cut", whole[: len(whole) // 2]), ("text", b"time,volt\n1,2\n")):
        path = tmp_path / f"{name}.mcap"
        path.write_bytes(content)
        with pytest.raises(InputError, match=f"{name}.mcap: is not a bag that can be") as error:
            read_log(path, platform)
        assert "\n" not in str(error.value)
    with pytest.raises(InputError, match=r"none\.mcap: No such file"):
        read_log(tmp_path / "none.mcap", platform)


def test_without_the_library_the_extra_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As the process that reads a bag finds it."""
    bag = write_bag(tmp_path / "run")
    monkeypatch.setitem(sys.modules, "rosbags.highlevel", None)
    with pytest.raises(InputError, match=r"pip install 'ptp-symbolic\[bag\]'"):
        parts(bag, [bag])
    monkeypatch.setitem(sys.modules, "mcap.reader", None)
    alone = write_json(tmp_path / "run.mcap")
    with pytest.raises(InputError, match=r"needs mcap; run pip install 'ptp-symbolic\[bag\]'"):
        parts(alone, [alone])


def write_json(path: Path, stamped: bool = True, broken: bool = False) -> Path:
    """The same run in JSON: joint states with stamps, voltages without; one message cut short."""
    with path.open("wb") as file:
        bag = JsonWriter(file)
        bag.start()
        schema = bag.register_schema("state", "jsonschema", b'{"type": "object"}')
        joints, drive = (bag.register_channel(t, "json", schema) for t in ("/joints", "/drive"))
        for k, (angle, voltage) in enumerate(zip(ANGLES, VOLTAGES, strict=True)):
            at = START + k * PERIOD
            state: dict[str, object] = {"name": ["tilt", "pan"], "position": [9.0, angle]}
            if stamped:
                state["timestamp"] = {"sec": at // 10**9, "nsec": at % 10**9}
            text = json.dumps(state)[: -1 if broken and k == 30 else None].encode()
            bag.add_message(joints, at + 1_000_000, text, at)
            text = json.dumps({"voltage": {"data": voltage}, "note": "-"}).encode()
            bag.add_message(drive, at + 2_000_000, text, at)
        bag.finish()
    return path


@pytest.mark.parametrize("field", ["pan", "1"])
def test_messages_in_json_are_read_as_those_of_ros(tmp_path: Path, field: str) -> None:
    platform = platform_with(tmp_path, f"/joints/position/{field}")
    log = read_log(write_json(tmp_path / "run.mcap"), platform)
    ros = read_log(
        write_bag(tmp_path / "run"), platform_with(tmp_path, f"/joint_states/position/{field}")
    )
    np.testing.assert_allclose(log.time - log.time[0], ros.time - ros.time[0], atol=1e-9)
    np.testing.assert_array_equal(log.outputs, ros.outputs)
    np.testing.assert_allclose(log.inputs, ros.inputs, atol=1e-6)


def test_messages_in_json_without_a_stamp_have_the_time_of_recording(tmp_path: Path) -> None:
    platform = platform_with(tmp_path, "/joints/position/pan")
    log = read_log(write_json(tmp_path / "run.mcap", stamped=False), platform)
    # voltages come 1 ms after angles: 1 ms of the one before, 4 ms of the next
    mean = 0.2 * VOLTAGES[:-1] + 0.8 * VOLTAGES[1:]
    np.testing.assert_allclose(log.inputs[:-1, 0], mean[:-1], atol=1e-6)


def test_a_message_that_is_no_json_is_refused_with_its_topic(tmp_path: Path) -> None:
    platform = platform_with(tmp_path, "/joints/position/pan")
    path = write_json(tmp_path / "run.mcap", broken=True)
    with pytest.raises(InputError, match=r"run\.mcap: topic /joints: ") as error:
        read_log(path, platform)
    assert "\n" not in str(error.value)
