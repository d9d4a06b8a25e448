"""What is said of logs before anything is fitted."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.data import Log, refuse_motionless, refuse_wrapped_angles, remarks
from ptp_symbolic.platform import read_platform

PLATFORM = read_platform(Path(__file__).parents[1] / "platforms" / "fieldlog_pan.toml")
COUNT = 2.0 * np.pi / 7200.0
TIME = np.arange(400) * 0.005
VOLTAGE = 6.0 * np.sin(3.0 * TIME)


def log(angle: np.ndarray, voltage: np.ndarray = VOLTAGE, time: np.ndarray = TIME) -> Log:
    names = [s.signal for s in PLATFORM.signals if s.role == "output"]
    columns = [angle if name == "theta_pan" else 0.1 * np.cos(3.0 * time) for name in names]
    return Log("run", time, voltage[:, None], np.column_stack(columns))


MOVING = np.round(np.sin(2.0 * TIME) / COUNT) * COUNT


def test_an_ordinary_log_gets_no_remark() -> None:
    refuse_wrapped_angles([log(MOVING)], PLATFORM)
    refuse_motionless([log(MOVING)], PLATFORM)
    assert remarks([log(MOVING)], PLATFORM) == ()


@pytest.mark.parametrize(("factor", "counts"), [(0.5, 14400), (0.25, 28800), (4.0, 1800)])
def test_steps_of_another_count_than_the_declared_one_are_noted(factor: float, counts: int) -> None:
    step = factor * COUNT
    (text,) = remarks([log(np.round(np.sin(2.0 * TIME) / step) * step)], PLATFORM)
    assert f"{counts} per revolution; counts_per_revolution says 7200" in text


def test_a_smooth_angle_has_no_count_to_compare() -> None:
    assert remarks([log(np.round(np.sin(2.0 * TIME), 9))], PLATFORM) == ()


def test_a_wrapped_angle_is_refused_with_its_time() -> None:
    turning = 4.0 * TIME + 2.0
    wrapped = np.angle(np.exp(1j * turning))
    first = TIME[np.flatnonzero(np.abs(np.diff(wrapped)) > 1.0)[0] + 1]
    with pytest.raises(InputError, match=rf"jumps by -6\.\d+ rad at {first:.6g} s.*unwrap"):
        refuse_wrapped_angles([log(wrapped)], PLATFORM)
    refuse_wrapped_angles([log(turning)], PLATFORM)


def test_logs_without_motion_are_refused() -> None:
    resting = np.where(np.arange(400) % 2 == 0, 0.0, COUNT)
    with pytest.raises(InputError, match="within 3 counts in all logs"):
        refuse_motionless([log(resting)], PLATFORM)
    refuse_motionless([log(resting), log(MOVING)], PLATFORM)


def test_an_encoder_between_samples_is_noted_where_that_costs_a_count() -> None:
    slight, sudden = (
        replace(log(MOVING), interpolated={"pan_angle": counts * COUNT}) for counts in (0.9, 33.0)
    )
    assert remarks([slight], PLATFORM) == ()
    (text,) = remarks([sudden], PLATFORM)
    assert "'pan_angle' is interpolated" in text and "off by some 33 counts" in text


def test_samples_that_are_left_out_are_noted() -> None:
    (text,) = remarks([replace(log(MOVING), thinned={"pan_angle": 5.0})], PLATFORM)
    assert "'pan_angle' is logged 5 times as fast as the slowest encoder" in text


def test_constant_inputs_are_noted() -> None:
    (text,) = remarks([log(MOVING, np.full(400, 3.0))], PLATFORM)
    assert "No input changes" in text
    step = np.where(TIME < 1.0, 0.0, 3.0)
    assert remarks([log(MOVING, step)], PLATFORM) == ()


def test_a_saturated_signal_is_noted_and_a_switched_one_is_not() -> None:
    (text,) = remarks([log(np.clip(3.0 * MOVING, -0.5, 0.5))], PLATFORM)
    assert "pan_angle" in text and "saturated" in text
    assert remarks([log(MOVING, np.sign(VOLTAGE))], PLATFORM) == ()


def test_an_encoder_that_is_set_anew_is_noted_with_time_and_size() -> None:
    """A jump of 900 counts within one sample; an impact that only turns the motion is none."""
    jumped = MOVING + np.where(TIME >= 0.5, 900.0 * COUNT, 0.0)
    (text,) = remarks([log(jumped)], PLATFORM)
    assert "'pan_angle' jumps by 90" in text and "at 0.5 s" in text and "reset, at an index" in text
    spiked = MOVING.copy()
    spiked[120] += 1.0
    (text,) = remarks([log(spiked)], PLATFORM)
    assert "at 0.6 s and 1 more times; a new window begins there" in text
    bouncing = np.round(np.abs(np.sin(2.0 * TIME)) / COUNT) * COUNT
    starting = np.where(TIME < 1.0, 0.0, np.round((TIME - 1.0) / COUNT) * COUNT)
    assert remarks([log(bouncing), log(starting)], PLATFORM) == ()


def test_pauses_and_jitter_are_noted() -> None:
    paused = TIME + np.where(TIME > 1.0, 0.4, 0.0)
    (text,) = remarks([log(MOVING, time=paused)], PLATFORM)
    assert "no samples from 1 s to 1.405 s" in text
    gone = [100, 101, 250]
    lacking = np.delete(TIME, gone)
    (text,) = remarks([log(np.delete(MOVING, gone), np.delete(VOLTAGE, gone), lacking)], PLATFORM)
    assert "samples are missing at 2 places, for up to 0.015 s" in text
    shaken = TIME + 0.002 * np.random.default_rng(1).uniform(-1.0, 1.0, 400)
    (text,) = remarks([log(MOVING, time=shaken)], PLATFORM)
    assert "sampling period varies" in text


def test_degrees_under_the_name_of_rad_are_said_and_rad_under_that_of_degrees() -> None:
    """By the steps of the encoder, 0.05 deg or 8.7e-4 rad; without one, by rates of no joint."""
    counts = np.round(np.degrees(np.sin(2.0 * TIME)) / 0.05)
    (text,) = remarks([log(0.05 * counts)], PLATFORM)
    assert "'pan_angle' looks like degrees under the name of rad: it goes over 100 rad" in text
    assert "at up to 120 rad/s. Write 'pan_angle [deg]'" in text  # 2 rad/s, 12 counts a sample
    (text,) = remarks([log(np.radians(COUNT * counts))], PLATFORM)
    assert "'pan_angle' looks like rad under the name of deg" in text
    signals = [replace(s, counts_per_revolution=None) if s.count else s for s in PLATFORM.signals]
    unknown = replace(PLATFORM, signals=tuple(signals))
    (text,) = remarks([log(np.degrees(np.sin(2.0 * TIME)))], unknown)
    assert "looks like degrees" in text
    assert remarks([log(20.0 * TIME)], unknown) == ()
