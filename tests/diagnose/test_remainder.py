"""Maps and lines of what is left: closed answers for noise, functions and waves."""

import numpy as np
import pytest

from ptp_symbolic.numeric.diagnose.remainder import binned, hints, strongest_line
from ptp_symbolic.numeric.identify.constants import ROWS_PER_WINDOW


def overlapping_noise(rng: np.random.Generator, count: int) -> np.ndarray:
    """Rows whose windows overlap: averages of as many independent numbers as a window has rows."""
    white = rng.standard_normal(count + ROWS_PER_WINDOW - 1)
    return np.convolve(white, np.ones(ROWS_PER_WINDOW), "valid") / np.sqrt(ROWS_PER_WINDOW)


def test_noise_depends_on_nothing() -> None:
    rng = np.random.default_rng(5)
    x = np.sin(0.01 * np.arange(4000))
    shares = [binned(x, overlapping_noise(rng, 4000))["share"] for _ in range(100)]
    # what noise gives by chance is cut at zero from below: half of the spread of the share
    assert np.mean(shares) < 0.02
    assert np.max(shares) < 0.1


def test_means_of_noise_lie_within_their_bars() -> None:
    rng = np.random.default_rng(6)
    x = np.linspace(-1.0, 1.0, 4000)
    z = []
    for _ in range(100):
        found = binned(x, overlapping_noise(rng, 4000))
        z += (np.array(found["mean"]) / found["error"]).tolist()
    assert np.std(z) == pytest.approx(1.0, abs=0.12)


def test_a_function_of_the_side_is_all_of_the_variance() -> None:
    rng = np.random.default_rng(7)
    x = rng.uniform(-2.0, 2.0, 4000)
    found = binned(x, x**3 + 0.1 * rng.standard_normal(4000))
    assert found["share"] > 0.95
    assert found["mean"][0] == pytest.approx(found["at"][0] ** 3, rel=0.1)
    half = binned(np.where(x > 0.0, x, np.nan), x**3)
    assert min(half["at"]) > 0.0


@pytest.mark.parametrize("frequency", [1.7, 4.2])
def test_a_wave_is_found_whatever_its_phase_in_every_run(frequency: float) -> None:
    rng = np.random.default_rng(8)
    runs = np.repeat([0, 1, 2], 400)
    time = np.tile(np.sort(rng.uniform(0.0, 10.0, 400)), 3)
    phase = np.array([0.3, 2.0, 4.4])[runs]
    left = np.sin(2.0 * np.pi * frequency * time + phase) + 0.5 * rng.standard_normal(1200)
    found = strongest_line(time, left, runs, 0.08, np.ones(1200))
    assert found is not None
    assert found[0] == pytest.approx(frequency, abs=0.05)
    assert found[1] == pytest.approx(0.5 / 0.75, abs=0.1)


def test_too_short_a_range_has_no_line() -> None:
    angle = np.linspace(0.0, 0.2, 300)
    none = np.zeros(300, dtype=np.int64)
    assert strongest_line(angle, angle, none, 0.08, np.full(300, 20.0 / (2.0 * np.pi))) is None


def test_noise_has_no_line_and_a_constant_side_explains_nothing() -> None:
    rng = np.random.default_rng(9)
    runs = np.zeros(480, dtype=np.int64)
    time = np.linspace(0.0, 12.0, 480)
    shares = []
    for _ in range(40):
        left = overlapping_noise(rng, 480)
        found = strongest_line(time, left, runs, 0.08, np.ones(480))
        assert found is not None
        shares.append(found[1])
    assert np.mean(np.array(shares) > 0.1) < 0.2
    slow = np.sin(0.02 * np.arange(480))
    assert binned(np.zeros(480), slow)["share"] < 0.05
    level = np.where(slow > 0.0, 1.0, -1.0)
    assert len(binned(level, slow)["at"]) == 2


def test_a_joint_that_rests_has_lines_within_two_rows_of_a_cycle() -> None:
    angle = np.cumsum(np.r_[np.zeros(200), np.full(200, 0.01)])
    left = np.sin(2.0 * np.pi * 9.0 * angle)
    rate = np.r_[np.zeros(200), np.full(200, 0.5)]
    found = strongest_line(angle, left, np.zeros(400, np.int64), 0.08, rate / (2.0 * np.pi))
    assert found is not None
    assert found[0] == pytest.approx(9.0, abs=0.2)


def test_a_side_without_values_gives_no_hint() -> None:
    empty = binned(np.full(50, np.nan), np.ones(50))
    assert (
        hints({"unit": "N m", "maps": [{"axis": "pan", "against": "rate", **empty}], "lines": []})
        == []
    )


def test_hints_name_the_strongest_first() -> None:
    m = {"axis": "pan", "against": "angle", "mean": [0.5, -2.0], "share": 0.4}
    weak = {**m, "against": "rate", "share": 0.05}
    line = {"axis": "pan", "frequency": 2.4, "unit": "Hz", "share": 0.6}
    said = hints({"unit": "N m", "maps": [m, weak], "lines": [line]})
    assert ["2.4 Hz" in said[0], "angle (40 %" in said[1], len(said)] == [True, True, 2]
    assert hints(None) == []
