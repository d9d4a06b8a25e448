"""Observations on a residual: known answers, and how often noise draws one."""

from pathlib import Path

import numpy as np
import pytest
from scipy.signal import lfilter

from ptp_symbolic.numeric.data import log_files, read_logs
from ptp_symbolic.numeric.diagnose.hints import (
    LOOKED,
    LogRows,
    Recorded,
    _said_change,
    change_at_one_time,
    further_hints,
    input_ceiling,
    lost_motion,
    resonance,
)
from ptp_symbolic.numeric.diagnose.proposals import propose
from ptp_symbolic.numeric.diagnose.refits import fit_declared
from ptp_symbolic.numeric.diagnose.remainder import change_of
from ptp_symbolic.platform import read_platform
from ptp_symbolic.workflows.preparation import model_of, problem_for, workers

DRAWS = 200
PERIOD = 0.005  # s
COUNT = 2.0 * np.pi / 7200.0  # rad


def autoregression(rng: np.random.Generator, count: int, pole: float) -> np.ndarray:
    """AR(1) noise with a standard deviation of one, begun in its stationary state."""
    white = rng.standard_normal(count + 200) * np.sqrt(1.0 - pole**2)
    return lfilter([1.0], [1.0, -pole], white)[200:]


def steps_of(rng: np.random.Generator, count: int, longest: int) -> np.ndarray:
    """Levels between -1 and 1, each for up to `longest` samples."""
    levels = [np.full(rng.integers(longest // 3, longest), x) for x in rng.uniform(-1, 1, count)]
    return np.concatenate(levels)[:count]


def rows_of(rng: np.random.Generator, seconds: float, pole: float, step: float = 0.0) -> LogRows:
    """Rows every 0.02 s that follow the input, noise with a pole, and a `step` at 5 s."""
    time = np.arange(0.0, seconds, 0.02)
    given = steps_of(rng, len(time), 60)
    left = 0.5 * given + autoregression(rng, len(time), pole) + step * (time >= 5.0)
    return LogRows(time, left, np.column_stack([np.ones(len(time)), given]), given[:, None])


def test_what_is_switched_on_in_all_logs_is_found_at_its_time() -> None:
    rng = np.random.default_rng(1)
    lengths = (8.0, 9.0, 12.0, 20.0, 7.0)
    found = change_at_one_time([rows_of(rng, s, 0.8, step=4.0) for s in lengths])
    assert found is not None
    assert found.time == pytest.approx(5.0, abs=0.3)
    assert found.size == pytest.approx(4.0, rel=0.3)
    assert found.shown >= 4


def test_a_change_in_one_log_or_with_the_input_is_no_change_of_all() -> None:
    rng = np.random.default_rng(2)
    logs = [rows_of(rng, 9.0, 0.8, step=4.0 if k == 0 else 0.0) for k in range(5)]
    assert change_at_one_time(logs) is None
    stepped = []
    for _ in range(5):
        time = np.arange(0.0, 9.0, 0.02)
        given = np.where(time >= 5.0, rng.uniform(1.0, 2.0), 0.0)
        left = 2.0 * given**2 + autoregression(rng, len(time), 0.8)
        stepped.append(LogRows(time, left, np.ones((len(time), 1)), given[:, None]))
    assert change_at_one_time(stepped) is None


@pytest.mark.parametrize("pole", [0.0, 0.9, 0.97])
def test_noise_changes_at_no_common_time(pole: float) -> None:
    rng = np.random.default_rng(3)
    found = [
        change_at_one_time([rows_of(rng, s, pole) for s in (8.0, 9.0, 12.0)]) for _ in range(DRAWS)
    ]
    assert sum(f is not None for f in found) <= 2


def moving_rows(
    rng: np.random.Generator, seconds: float, pole: float, noise: float, taken_off: float = np.inf
) -> LogRows:
    """Rows of a turntable of 0.05 kg m^2 under a torque, declared with that inertia, from which a
    payload of 0.02 kg m^2 is `taken_off` at some time in s.
    """
    time = np.arange(0.0, seconds, 0.02)
    torque = steps_of(rng, len(time), 60)
    angle, rate, speeding = np.zeros((3, len(time)))
    for k, at in enumerate(time):
        speeding[k] = (torque[k] - 0.1 * rate[k]) / (0.05 if at < taken_off else 0.03)
        if k + 1 < len(time):
            rate[k + 1] = rate[k] + 0.02 * speeding[k]
            angle[k + 1] = angle[k] + 0.02 * rate[k]
    left = np.where(time < taken_off, 0.0, 0.02) * speeding
    left += noise * autoregression(rng, len(time), pole)
    moved = [np.ones(len(time)), angle, rate, np.sign(rate), rate * np.abs(rate)]
    beside = np.column_stack([*moved, torque, torque * np.abs(torque)])
    return LogRows(time, left, beside, torque[:, None])


def test_a_payload_that_is_taken_off_is_found_at_its_time_though_nothing_steps() -> None:
    """Without it the torque goes into more acceleration: from 10 s on the residual follows that."""
    rng = np.random.default_rng(4)
    logs = [moving_rows(rng, 20.0, 0.5, 0.02, taken_off=10.0) for _ in range(6)]
    found = change_at_one_time(logs)
    assert found is not None
    assert found.time == pytest.approx(10.0, abs=found.interval)
    assert found.shown >= 5
    assert found.column == 5
    (said,) = _said_change(found, "residual torque of pan", "N m", ("",) * 5 + ("tau_pan", ""))
    assert f"follows the tau_pan differently from then on, beginning at {found.time:.3g} s" in said


@pytest.mark.parametrize("pole", [0.0, 0.9, 0.97])
def test_a_log_of_noise_changes_nowhere_in_95_of_100(pole: float) -> None:
    """With all that a residual may follow beside it; the test of one log is at 5 %."""
    rng = np.random.default_rng(6)
    logs = [moving_rows(rng, 8.0, pole, 1.0) for _ in range(100)]
    shown = [change_of(log.time, log.left, log.beside, LOOKED) is not None for log in logs]
    assert sum(shown) <= 10  # 5 +- 2.2


def recorded(rng: np.random.Generator, log: int, left: np.ndarray) -> Recorded:
    """A run that moves at a speed of its own, with noise of 1e-3 rad in its angle."""
    given = np.repeat(rng.uniform(-1.0, 1.0, len(left) // 200 + 1), 200)[: len(left)]
    angle = np.cumsum(0.2 * (1.0 + log) * given) * PERIOD
    return Recorded(f"log {log}", PERIOD, angle, left, 1e-3, COUNT, given[:, None])


def ringing(rng: np.random.Generator, log: int, frequency: float, damping: float) -> Recorded:
    """What steps of the input leave: a mode that rings, beside noise with a pole of 0.95."""
    run = recorded(rng, log, 0.01 * autoregression(rng, 3000, 0.95))
    omega = 2.0 * np.pi * frequency
    state, rings = np.zeros(2), np.zeros(3000)
    for k in range(3000):
        force = omega**2 * (run.input[k, 0] - state[0]) - 2.0 * damping * omega * state[1]
        state[1] += PERIOD * force
        state[0] += PERIOD * state[1]
        rings[k] = state[0] - run.input[k, 0]
    left = run.left + 0.2 * rings
    return Recorded(run.log, PERIOD, run.measured, left, run.noise, run.count, run.input)


@pytest.mark.parametrize("frequency", [5.0, 12.0])
def test_a_mode_that_rings_in_all_logs_is_found_at_its_frequency(frequency: float) -> None:
    rng = np.random.default_rng(4)
    found = resonance([ringing(rng, log, frequency, 0.06) for log in range(5)])
    assert found is not None
    assert found.frequency == pytest.approx(frequency, rel=0.12)
    assert found.shown >= 3


def test_lines_that_follow_the_speed_or_the_input_are_no_resonance() -> None:
    rng = np.random.default_rng(5)
    time = PERIOD * np.arange(3000)
    locked, driven = [], []
    for log in range(5):
        run = recorded(rng, log, 0.01 * autoregression(rng, 3000, 0.95))
        wave = 0.05 * np.sin(2.0 * np.pi * 3.0 * (1.0 + 0.5 * log) * time)
        locked.append(
            Recorded(run.log, PERIOD, run.measured, run.left + wave, 1e-3, COUNT, run.input)
        )
        tone = np.sin(2.0 * np.pi * 6.0 * time)
        given, left = run.input + tone[:, None], run.left + 0.05 * tone
        driven.append(Recorded(run.log, PERIOD, run.measured, left, 1e-3, COUNT, given))
    assert resonance(locked) is None
    assert resonance(driven) is None


@pytest.mark.long
@pytest.mark.parametrize("pole", [0.0, 0.95])
def test_noise_does_not_ring(pole: float) -> None:
    rng = np.random.default_rng(6)
    found = [
        resonance([recorded(rng, k, 0.02 * autoregression(rng, 2000, pole)) for k in range(5)])
        for _ in range(DRAWS)
    ]
    assert sum(f is not None for f in found) <= 0.02 * DRAWS


def swinging(
    rng: np.random.Generator, log: int, gap: float, friction: float, pole: float = 0.9
) -> Recorded:
    """A joint that is swept to and fro behind a `gap` in rad; `friction` that is wrong by
    direction drifts by so many rad/s, and noise of a count.
    """
    time = PERIOD * np.arange(3000)
    swing = (0.4 + 0.1 * log) * np.sin(2.0 * np.pi * (0.25 + 0.05 * log) * time + log)
    behind = np.zeros(len(time))
    behind[0] = swing[0]
    for k in range(1, len(time)):
        behind[k] = np.clip(behind[k - 1], swing[k] - 0.5 * gap, swing[k] + 0.5 * gap)
    way = np.sign(np.gradient(swing))
    noise = COUNT * autoregression(rng, len(time), pole)
    left = behind - swing + friction * np.cumsum(way) * PERIOD + noise
    measured = np.rint((behind + 0.2 * noise) / COUNT) * COUNT
    return Recorded(f"log {log}", PERIOD, measured, left, 0.3 * COUNT, COUNT, way[:, None])


@pytest.mark.parametrize("friction", [0.0, 0.02])
def test_the_gap_is_the_lag_at_reversals_whatever_the_friction(friction: float) -> None:
    rng = np.random.default_rng(7)
    found = lost_motion([swinging(rng, log, 0.026, friction) for log in range(3)])
    assert found is not None
    assert found.lag == pytest.approx(0.026, rel=0.15)


@pytest.mark.parametrize("friction", [-0.05, 0.02, 0.1])
def test_friction_that_is_wrong_by_direction_is_no_lost_motion(friction: float) -> None:
    rng = np.random.default_rng(8)
    assert lost_motion([swinging(rng, log, 0.0, friction) for log in range(3)]) is None


@pytest.mark.parametrize("pole", [0.0, 0.9, 0.99])
def test_noise_is_no_lost_motion(pole: float) -> None:
    rng = np.random.default_rng(9)
    logs = [swinging(rng, log, 0.0, 0.0) for log in range(3)]
    found = []
    for _ in range(DRAWS):
        noise = [20.0 * COUNT * autoregression(rng, 3000, pole) for _ in logs]
        runs = [
            Recorded(r.log, PERIOD, r.measured, n, r.noise, COUNT, r.input)
            for r, n in zip(logs, noise, strict=True)
        ]
        found.append(lost_motion(runs))
    assert sum(f is not None for f in found) <= 1


def driven_rows(
    rng: np.random.Generator, pole: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Input of a drive [n], columns beside, levels, and the excess beyond each."""
    given = np.repeat(3.0 * rng.standard_normal(120).clip(-2.0, 2.0), 10)
    rate = autoregression(rng, len(given), 0.95)
    beside = np.column_stack([np.ones(len(given)), rate, np.sign(rate), given, given * abs(given)])
    levels = np.linspace(float(np.median(np.abs(given))), float(np.abs(given).max()), 41)[:-1]
    beyond = np.sign(given)[:, None] * np.maximum(np.abs(given)[:, None] - levels, 0.0)
    return given, beside, levels, beyond


def test_the_level_beyond_which_an_input_does_nothing_is_found() -> None:
    """Rows are what the motion takes minus what the model gives: a clipped input makes them fall
    below zero.
    """
    rng = np.random.default_rng(10)
    given, beside, levels, beyond = driven_rows(rng, 0.9)
    noise = 0.2 * autoregression(rng, len(given), 0.7)
    left = np.clip(given, -4.5, 4.5) - given + 0.3 * beside[:, 1] + noise
    found = input_ceiling(left, beside, levels, beyond, -1.0)
    assert found is not None
    assert found.level == pytest.approx(4.5, abs=0.3)
    assert input_ceiling(-left, beside, levels, beyond, -1.0) is None  # an input that does more


def test_a_wrong_gain_or_a_cubic_is_no_ceiling() -> None:
    rng = np.random.default_rng(11)
    given, beside, levels, beyond = driven_rows(rng, 0.9)
    noise = 0.2 * autoregression(rng, len(given), 0.7)
    for shape in (-0.3 * given, -0.02 * given * np.abs(given), -0.005 * given**3):
        assert input_ceiling(shape + noise, beside, levels, beyond, -1.0) is None


@pytest.mark.parametrize("pole", [0.0, 0.9, 0.97])
def test_noise_has_no_ceiling(pole: float) -> None:
    rng = np.random.default_rng(12)
    found = []
    for _ in range(DRAWS):
        given, beside, levels, beyond = driven_rows(rng, pole)
        left = autoregression(rng, len(given), pole)
        found.append(input_ceiling(left, beside, levels, beyond, -1.0))
    assert sum(f is not None for f in found) <= 0.02 * DRAWS


def test_the_gap_of_log_n_is_said_with_its_angle(shared: Path) -> None:
    """Declared with a rigid gear; the machine has a gap of 1.49 deg, 29.8 counts."""
    platform = read_platform(shared / "fieldlogs" / "rigid_gear.toml")
    logs = read_logs(log_files([shared / "fieldlogs" / "log-n" / "train"]), platform)
    with workers() as executor:
        problem = problem_for(
            platform, model_of(platform), logs, logs, (), executor, lambda _: None
        )
        proposals = propose(problem)
        problem, trial = fit_declared(problem, proposals)
        said = further_hints(trial, proposals.space)
    assert len(said) == 1
    assert "After pan turns back, its motion lags by 1.6" in said[0]
    assert "counts" in said[0]
