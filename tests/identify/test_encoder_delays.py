"""Two encoders, one logged late by a part of a sample, of a machine that other code simulates."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from ptp_symbolic.platform import Platform, read_platform
from ptp_symbolic.workflows.fit import fit_platform
from tests.independent import two_axis_logs
from tests.independent.two_axis import simulate, two_axis

PLATFORM = read_platform(Path(__file__).parents[1] / "platforms" / "fieldlog_two_axis.toml")
FINE = 5  # parts of a sampling period
SAMPLES = 2000
LATE = 2  # parts by which the tilt encoder is logged late
FRICTION = {"b_pan": 0.09, "F_c_pan": 0.05, "b_tilt": 0.12, "F_c_tilt": 0.06}


pytestmark = pytest.mark.long  # the other simulator compiles for most of a minute


@pytest.fixture
def log(tmp_path: Path) -> Path:
    rng = np.random.default_rng(21)
    wanted = two_axis_logs.reference(rng)
    follow = two_axis_logs.controller(wanted)
    held = [np.zeros(2)]
    part = two_axis_logs.PERIOD / FINE

    def torque(time: float, theta: np.ndarray, omega: np.ndarray) -> np.ndarray:
        if round(time / part) % FINE == 0:
            held[0] = follow(time, theta, omega)
        return held[0]

    theta, omega, _ = wanted(0.0)
    model = two_axis(two_axis_logs.DECLARED | FRICTION)
    torques, angles, _ = simulate(model, theta, omega, torque, SAMPLES * FINE, part)
    at = FINE * np.arange(1, SAMPLES)
    seen = np.column_stack([angles[at, 0], angles[at - LATE, 1]])
    path = tmp_path / "tracking.csv"
    rows = two_axis_logs.log_rows(torques[at], seen, rng)
    path.write_text("\n".join([two_axis_logs.COLUMNS, *rows]) + "\n")
    return path


def with_delay(delay: float) -> Platform:
    signals = tuple(
        replace(s, delay=delay) if s.signal == "theta_tilt" else s for s in PLATFORM.signals
    )
    return replace(PLATFORM, signals=signals)


def test_a_declared_delay_of_one_encoder_leaves_rounding_alone(log: Path) -> None:
    found = fit_platform(with_delay(LATE * two_axis_logs.PERIOD / FINE), [log]).summary
    assert found["error"]["after"]["total"]["rmse_counts"] < 0.32
    for name, value in FRICTION.items():
        low, high = found["parameters"][name]["ci95"]
        assert abs(found["parameters"][name]["value"] - value) < 0.75 * (high - low), name
    assert not found["remarks"]
