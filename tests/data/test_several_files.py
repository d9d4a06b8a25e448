"""One run in several files: cut one after the other, or one file for each group of signals."""

from pathlib import Path

import numpy as np
import pytest

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.data import read_inputs, read_log, read_logs, stored_at
from ptp_symbolic.platform import Platform, read_platform

TIME = 0.005 * np.arange(40)
VOLTAGE = np.round(1.5 * np.cos(0.3 * np.arange(40)), 3)
DEGREES = np.round(3.25 * np.arange(40) - 7.0, 3)
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


def write(path: Path, **columns: np.ndarray) -> Path:
    table = np.column_stack(list(columns.values()))
    np.savetxt(path, table, "%.6f", ",", header=",".join(columns), comments="")
    return path


def together(*paths: Path) -> str:
    return "+".join(map(str, paths))


def test_a_run_that_is_cut_reads_as_the_whole_in_any_order(
    tmp_path: Path, platform: Platform
) -> None:
    columns = {"time [s]": TIME, "volt": VOLTAGE, "angle": DEGREES}
    whole = read_log(write(tmp_path / "whole.csv", **columns), platform)
    parts = [
        write(tmp_path / f"part_{k}.csv", **{n: c[part] for n, c in columns.items()})
        for k, part in enumerate((slice(0, 15), slice(15, 40)))
    ]
    for order in (parts, parts[::-1]):
        log = read_log(together(*order), platform)
        np.testing.assert_array_equal(log.time, whole.time)
        np.testing.assert_array_equal(log.inputs, whole.inputs)
        np.testing.assert_array_equal(log.outputs, whole.outputs)
        assert log.steps == ()
    (log,) = read_logs([together(*parts)], platform)
    assert log.name == "part_0+part_1"
    assert stored_at(Path(together(*parts))) == parts


def test_groups_of_signals_on_one_clock_read_as_one_file(
    tmp_path: Path, platform: Platform
) -> None:
    given = write(tmp_path / "inputs.csv", **{"time [s]": TIME, "volt": VOLTAGE})
    seen = write(tmp_path / "encoder.csv", **{"time [s]": TIME, "angle": DEGREES})
    log = read_log(together(given, seen), platform)
    np.testing.assert_allclose(log.inputs[:, 0], VOLTAGE)
    np.testing.assert_allclose(np.degrees(log.outputs[:, 0]), DEGREES)
    assert log.steps == ()
    time, inputs = read_inputs(together(given, seen), platform)
    np.testing.assert_allclose(np.column_stack([time, inputs]), np.column_stack([TIME, VOLTAGE]))


def test_an_input_with_a_clock_of_its_own_acts_from_when_it_was_logged(
    tmp_path: Path, platform: Platform
) -> None:
    """A step of 1 V at 20 ms + 2 ms: it acts on three fifths of that encoder period."""
    own = 0.002 + 0.01 * np.arange(20)
    step = np.where(own > 0.02, 1.0, 0.0)
    given = write(tmp_path / "inputs.csv", **{"time [s]": own, "volt": step})
    seen = write(tmp_path / "encoder.csv", **{"time [s]": TIME, "angle": DEGREES})
    log = read_log(together(given, seen), platform)
    assert log.time[0] == 0.005  # no input is known before its first sample
    at = int(np.argmin(np.abs(log.time - 0.02)))
    np.testing.assert_allclose(log.inputs[at - 1 : at + 2, 0], [0.0, 0.6, 1.0], atol=1e-9)
    np.testing.assert_allclose(log.steps[0][0], own)
    np.testing.assert_allclose(np.degrees(log.outputs[:, 0]), DEGREES[1:])


def test_what_cannot_be_one_run_is_refused(tmp_path: Path, platform: Platform) -> None:
    columns = {"time [s]": TIME, "volt": VOLTAGE, "angle": DEGREES}
    first, again = (write(tmp_path / name, **columns) for name in ("a.csv", "b.csv"))
    with pytest.raises(InputError, match=r"b\.csv.*from 0 s to 0\.195 s overlap those of .*a\.csv"):
        read_log(together(first, again), platform)
    seen = write(tmp_path / "encoder.csv", **{"time [s]": TIME, "angle": DEGREES})
    with pytest.raises(InputError, match=r"'angle' is in .*a\.csv.* and in .*encoder\.csv"):
        read_log(together(first, seen), platform)
    with pytest.raises(InputError, match="signal 'volt' is missing; the log has time, angle"):
        read_log(together(seen, write(tmp_path / "c.csv", **{"time [s]": TIME})), platform)
    late = write(tmp_path / "late.csv", **{"time [s]": TIME + 9.0, "volt": VOLTAGE})
    with pytest.raises(InputError, match="no time at which all signals are logged"):
        read_log(together(seen, late), platform)
    with pytest.raises(InputError, match=r"missing\.csv: no such file"):
        read_log(together(seen, tmp_path / "missing.csv"), platform)


def test_a_name_with_a_plus_is_one_file(tmp_path: Path, platform: Platform) -> None:
    columns = {"time [s]": TIME, "volt": VOLTAGE, "angle": DEGREES}
    path = write(tmp_path / "gain+20.csv", **columns)
    assert read_log(path, platform).name == "gain+20"


@pytest.mark.parametrize("resolution", ["counts_per_revolution = 4096", "noise = 0.1"])
def test_a_second_sensor_at_other_times_comes_onto_the_clock_of_the_encoder(
    tmp_path: Path, resolution: str
) -> None:
    path = tmp_path / "two.toml"
    second = f'theta_tilt = {{ role = "output", column = "tilt", unit = "deg", {resolution} }}'
    path.write_text(PLATFORM.replace('["pan"]', '["pan", "tilt"]') + second + "\n")
    given = write(tmp_path / "pan.csv", **{"time [s]": TIME, "volt": VOLTAGE, "angle": DEGREES})
    own = TIME + 0.001
    seen = write(tmp_path / "tilt.csv", **{"time [s]": own, "tilt": 20.0 * np.sin(3.0 * own)})
    log = read_log(together(given, seen), read_platform(path))
    np.testing.assert_allclose(log.time, TIME[1:])
    expected = 20.0 * np.sin(3.0 * log.time)
    np.testing.assert_allclose(np.degrees(log.outputs[:, 1]), expected, atol=2e-6)


@pytest.mark.parametrize("shift", [0.0, 0.0003])
def test_the_slower_of_two_encoders_has_the_clock(tmp_path: Path, shift: float) -> None:
    """A value that was not measured is not counted as one: 38 samples, not 200. The input, a ramp
    that is held for 1 ms each, acts between them too.
    """
    path = tmp_path / "two.toml"
    second = 'theta_tilt = { role = "output", column = "tilt", unit = "rad", '
    second += "counts_per_revolution = 4096 }"
    path.write_text(PLATFORM.replace('["pan"]', '["pan", "tilt"]') + second + "\n")
    fast = 0.001 * np.arange(200)
    angle = 20.0 * np.sin(3.0 * fast)
    given = write(tmp_path / "a.csv", **{"time [s]": fast, "volt": fast, "angle": angle})
    own = TIME[1:-1] + shift
    seen = write(tmp_path / "b.csv", **{"time [s]": own, "tilt [rad]": own})
    log = read_log(together(given, seen), read_platform(path))
    np.testing.assert_allclose(log.time, own)
    np.testing.assert_allclose(np.degrees(log.outputs[:, 0]), 20.0 * np.sin(3.0 * own), atol=2e-6)
    np.testing.assert_allclose(log.inputs[:, 0], own + 0.002, atol=1e-9)  # of 0 to 4 ms more
    np.testing.assert_allclose(log.steps[0][0], fast)
    assert log.thinned == {"angle": pytest.approx(5.0)}


def test_the_run_ends_where_the_last_input_no_longer_holds(
    tmp_path: Path, platform: Platform
) -> None:
    """Inputs every 10 ms, the last at 92 ms: it holds to 102 ms, over the period from 95 ms on."""
    own = 0.002 + 0.01 * np.arange(10)
    given = write(tmp_path / "inputs.csv", **{"time [s]": own, "volt": np.ones(10)})
    seen = write(tmp_path / "encoder.csv", **{"time [s]": TIME, "angle": DEGREES})
    log = read_log(together(given, seen), platform)
    assert log.time[-1] == pytest.approx(0.095)
    assert len(log.time) == 19
