"""Raw columns become signals as their platform says: scaled, turned, zeroed, moved in time."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.data import read_inputs, read_log
from ptp_symbolic.platform import Platform, SignalDeclaration, read_platform

HEAD = """[platform]
name = "bench"
axes = ["pan"]
[[effects]]
effect = "rigid_bodies"
[signals]
"""
PERIOD = 0.01


def platform_of(folder: Path, *signals: str) -> Platform:
    path = folder / "bench.toml"
    path.write_text(HEAD + "\n".join(signals) + "\n", encoding="utf-8")
    return read_platform(path)


def log_of(folder: Path, columns: dict[str, np.ndarray]) -> Path:
    rows = np.column_stack(list(columns.values()))
    path = folder / "run.csv"
    lines = [",".join(columns), *(",".join(f"{v:.17g}" for v in row) for row in rows)]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


ANGLE = 'theta_pan = { role = "output", column = "angle", unit = "rad", noise = 1e-3 }'
TIMES = PERIOD * np.arange(40)


@pytest.mark.parametrize(
    ("line", "heading", "numbers", "expected"),
    [
        # unsigned, 8 bits: 128 stands, 0 and 255 are full voltage either way
        ("unit = 'V', scale = 0.1875, offset = 128", "x", [0, 128, 255], [-24.0, 0.0, 23.8125]),
        # signed, and the bridge wired the other way round
        ("unit = 'V', scale = -0.1875", "x [counts]", [-128, 0, 127], [24.0, 0.0, -23.8125]),
        ("unit = 'V', scale = 0.24", "x [%]", [-100, 0, 50], [-24.0, 0.0, 12.0]),
        ("unit = 'mV', scale = 2.0, offset = 1.0", "x", [0, 1, 501], [-0.002, 0.0, 1.0]),
        ("unit = 'V', scale = -1.0", "x [V]", [3, 0, -2], [-3.0, 0.0, 2.0]),
        ("unit = 'mV', scale = -1.0", "x [mV]", [3000, 0, -2], [-3.0, 0.0, 0.002]),
        ("unit = 'mV', offset = 20.0", "x [V]", [0.02, 0.0, 1.0], [0.0, -0.02, 0.98]),
    ],
)
def test_numbers_of_a_column_become_volts(
    tmp_path: Path, line: str, heading: str, numbers: list[float], expected: list[float]
) -> None:
    text = f'u_pan = {{ role = "input", column = "x", {line} }}'.replace("'", '"')
    platform = platform_of(tmp_path, text, ANGLE)
    column = np.resize(numbers, 40)
    path = log_of(tmp_path, {"time [s]": TIMES, heading: column, "angle [rad]": TIMES})
    found = read_log(path, platform).inputs[:, 0]
    assert found == pytest.approx(np.resize(expected, 40), rel=1e-15, abs=1e-15)
    assert read_inputs(path, platform)[1][:, 0] == pytest.approx(found, rel=0)


def test_a_rate_in_counts_and_a_temperature_in_celsius(tmp_path: Path) -> None:
    gyro = (
        'omega_pan = { role = "output", column = "gyro", unit = "deg/s", scale = -0.0609,'
        " offset = 12, noise = 0.05 }"
    )
    warm = (
        'temperature_pan = { role = "input", column = "T", unit = "K", scale = 1.0,'
        " offset = -273.15 }"
    )
    platform = platform_of(tmp_path, gyro, warm)
    assert platform.signals[0].noise == pytest.approx(np.radians(0.05))
    counts, celsius = np.arange(40.0) - 8, np.linspace(-10, 45, 40)
    path = log_of(tmp_path, {"time [s]": TIMES, "gyro [LSB]": counts, "T [degC]": celsius})
    log = read_log(path, platform)
    assert log.outputs[:, 0] == pytest.approx(np.radians(-0.0609 * (counts - 12)), rel=1e-14)
    assert log.inputs[:, 0] == pytest.approx(celsius + 273.15, rel=1e-15)


@pytest.mark.parametrize(
    ("line", "heading", "message"),
    [
        (
            'unit = "V", scale = -1.0',
            "x [mV]",
            'its scale makes -1 V each; write unit = "mV"',
        ),
        ('unit = "V"', "x [%]", "is in %, but u_pan is in V"),
    ],
)
def test_a_column_that_cannot_be_converted_is_refused(
    tmp_path: Path, line: str, heading: str, message: str
) -> None:
    platform = platform_of(tmp_path, f'u_pan = {{ role = "input", column = "x", {line} }}', ANGLE)
    path = log_of(tmp_path, {"time [s]": TIMES, heading: TIMES, "angle [rad]": TIMES})
    with pytest.raises(InputError, match=re.escape(message)):
        read_log(path, platform)


@pytest.mark.parametrize(
    ("line", "message"),
    [
        (
            "scale = 0",
            "u_pan.scale: is zero, which leaves nothing of the column; give V per",
        ),
        ('scale = "0.1"', "u_pan.scale: '0.1' is not a number"),
        ("offset = true", "u_pan.offset: True is not a number"),
        ("delay = 0.005", 'u_pan.delay: 0.005 is not a time; write "0.5 s" or "500 ms"'),
        ('delay = "5 m"', "u_pan.delay: '5 m' is not a time"),
        ('delay = "5000 s"', "u_pan.delay: 5000 s is more than 10 s; correct its unit"),
    ],
)
def test_a_wrong_scale_or_delay_is_refused(tmp_path: Path, line: str, message: str) -> None:
    with pytest.raises(InputError, match=re.escape(message)):
        platform_of(tmp_path, f'u_pan = {{ role = "input", column = "x", unit = "V", {line} }}')


def smooth(time: np.ndarray) -> np.ndarray:
    return 0.3 * time + 0.1 * np.sin(7.0 * time)


def timed(delays: dict[str, float], counts: dict[str, int]) -> Platform:
    """Two encoders, a gyro and a voltage with `delays` in s."""
    names = {"u_pan": "V", "theta_pan": "rad", "theta_tilt": "rad", "omega_pan": "rad/s"}
    signals = tuple(
        SignalDeclaration(
            name,
            name,
            unit,
            "input" if name == "u_pan" else "output",
            counts.get(name),
            1e-3,
            delay=delays.get(name, 0.0),
        )
        for name, unit in names.items()
    )
    return Platform("bench", "bench", ("pan", "tilt"), 9.81, (), (), signals)


def late_log(folder: Path, delays: dict[str, float], jump: float) -> Path:
    """What a logger writes of a machine that gets 1 V from `jump` s on: every column late."""

    def at(name: str) -> np.ndarray:
        return TIMES - delays.get(name, 0.0)

    return log_of(
        folder,
        {
            "time [s]": TIMES,
            "u_pan [V]": (TIMES + delays.get("u_pan", 0.0) >= jump - 1e-9).astype(float),
            "theta_pan [rad]": smooth(at("theta_pan")),
            "theta_tilt [rad]": -smooth(at("theta_tilt")),
            "omega_pan [rad/s]": 2.0 * at("omega_pan"),
        },
    )


COUNTS = {"theta_pan": 7200, "theta_tilt": 7200}


def test_outputs_that_are_equally_late_keep_their_samples(tmp_path: Path) -> None:
    late = {"theta_pan": 0.0234, "theta_tilt": 0.0234, "omega_pan": 0.0234}
    log = read_log(late_log(tmp_path, late, 0.2), timed(late, COUNTS))
    assert len(log.time) == 37  # those before the first input are left out
    assert log.outputs[:, 0] == pytest.approx(smooth(log.time), abs=1e-12)
    assert log.outputs[:, 1] == pytest.approx(-smooth(log.time), abs=1e-12)
    written = smooth(TIMES - 0.0234)
    assert np.isin(log.outputs[:, 0], written).all()


@pytest.mark.parametrize("delay", [0.03, 0.0137, -0.02])
def test_an_input_acts_later_by_its_delay(tmp_path: Path, delay: float) -> None:
    late = {"u_pan": delay}
    log = read_log(late_log(tmp_path, late, 0.2 + delay % PERIOD), timed(late, COUNTS))
    assert log.outputs[:, 0] == pytest.approx(smooth(log.time), abs=1e-12)
    given = np.concatenate([[0.0], np.cumsum(log.inputs[:-1, 0] * np.diff(log.time))])
    exact = np.maximum(0.0, log.time - (0.2 + delay % PERIOD))
    aside = np.abs(log.time - 0.2) > 1.5 * PERIOD
    assert given[aside] == pytest.approx(exact[aside], abs=1e-12)


@pytest.mark.parametrize("delay", [0.03, -0.03])
def test_a_log_begins_where_its_late_input_begins_to_act(tmp_path: Path, delay: float) -> None:
    """Before, what acted was given before the log; its last value acts on to the end."""
    late = {"u_pan": delay}
    log = read_log(late_log(tmp_path, {}, 0.2), timed(late, COUNTS))
    first, last = max(TIMES[0] + delay, TIMES[0]), min(TIMES[-1] + delay, TIMES[-1])
    assert log.time[0] == pytest.approx(first, abs=1e-9)
    assert log.time[-1] == pytest.approx(last, abs=1e-9)
    acted = log.inputs[:, 0] > 0.5
    assert log.time[acted][0] == pytest.approx(0.2 + delay, abs=1e-9)


def test_a_gyro_of_another_delay_comes_onto_the_clock_of_the_encoder(tmp_path: Path) -> None:
    late = {"theta_pan": 0.004, "theta_tilt": 0.004, "omega_pan": 0.0173}
    log = read_log(late_log(tmp_path, late, 0.2), timed(late, COUNTS))
    assert log.outputs[:, 0] == pytest.approx(smooth(log.time), abs=1e-12)
    assert log.outputs[:, 2] == pytest.approx(2.0 * log.time, abs=1e-12)


def test_encoders_of_other_delays_come_onto_one_clock(tmp_path: Path) -> None:
    """By whole samples as they are; between samples by cubics."""
    late = {"theta_pan": 0.004, "theta_tilt": 0.024}
    log = read_log(late_log(tmp_path, late, 0.2), timed(late, COUNTS))
    assert log.outputs[:, 1] == pytest.approx(-smooth(log.time), abs=1e-12)
    assert set(log.interpolated) == {"omega_pan"}
    between = late | {"theta_tilt": 0.0073}
    log = read_log(late_log(tmp_path, between, 0.2), timed(between, COUNTS))
    assert set(log.interpolated) == {"theta_tilt", "omega_pan"}
    assert log.outputs[:, 0] == pytest.approx(smooth(log.time), abs=1e-12)
    assert log.outputs[:, 1] == pytest.approx(-smooth(log.time), abs=PERIOD**4 * 0.1 * 7.0**4 / 24)


@pytest.mark.parametrize("kept", [np.r_[0:15, 22:40], np.r_[0:2, 20:22, 30:40]])
def test_no_value_is_made_up_where_samples_were_lost(tmp_path: Path, kept: np.ndarray) -> None:
    late = {"theta_tilt": 0.0041}
    columns = {"time [s]": TIMES, "u_pan [V]": TIMES, "theta_pan [rad]": smooth(TIMES)}
    columns |= {"theta_tilt [rad]": -smooth(TIMES - 0.0041), "omega_pan [rad/s]": TIMES}
    log = read_log(
        log_of(tmp_path, {name: column[kept] for name, column in columns.items()}),
        timed(late, COUNTS),
    )
    own = kept[np.append(np.diff(kept) == 1, False)]
    assert log.time == pytest.approx(TIMES[own])
    assert log.outputs[:, 1] == pytest.approx(-smooth(log.time), abs=1e-4)
    held = np.cumsum(np.append(0.0, TIMES[kept][:-1] * np.diff(TIMES[kept])))  # input, integrated
    given = np.sum(log.inputs[:-1, 0] * np.diff(log.time))
    at = np.searchsorted(TIMES[kept], log.time[[0, -1]] - 1e-9)
    assert given == pytest.approx(held[at[1]] - held[at[0]], abs=1e-12)


def test_a_log_shorter_than_its_delays_is_refused(tmp_path: Path) -> None:
    late = {"u_pan": 0.39}
    with pytest.raises(InputError, match="shorter than the delays of its signals"):
        read_log(late_log(tmp_path, {}, 0.2), timed(late, COUNTS))


def test_a_driven_simulation_gets_its_input_late(tmp_path: Path) -> None:
    platform = timed({"u_pan": 0.03}, COUNTS)
    path = late_log(tmp_path, {}, 0.2)
    time, values = read_inputs(path, platform)
    assert values[:, 0] == pytest.approx((time >= 0.23 - 1e-9).astype(float))
    plain = replace(platform, signals=tuple(replace(s, delay=0.0) for s in platform.signals))
    assert read_inputs(path, plain)[1][:, 0] == pytest.approx((time >= 0.2 - 1e-9).astype(float))
