"""Whiteness and independence of residuals: false alarms over runs of unequal lengths, and finds."""

from typing import Any

import numpy as np
import pytest
from scipy.signal import lfilter

from ptp_symbolic.numeric.diagnose.remainder import correlations, residual_tests
from ptp_symbolic.numeric.identify.constants import LAGS
from tests.identify.curves import Floats
from tests.identify.straight import finished

LENGTHS = (200, 500, 3000)
INPUTS = ("u_pan", "u_tilt")


def white(rng: np.random.Generator, signals: int = 1) -> list[Floats]:
    """White residuals [k, signals] of every run."""
    return [rng.standard_normal((k, signals)) for k in LENGTHS]


def judged(residuals: list[Floats], inputs: list[Floats]) -> dict[tuple[str, str], dict[str, Any]]:
    """Rows by name and signal."""
    rows = residual_tests(finished(residuals, inputs=inputs), INPUTS[: inputs[0].shape[1]])
    return {(row["name"], row["signal"]): row for row in rows}


def test_perfect_fits_fail_one_test_in_a_hundred_whatever_the_lengths_of_the_runs() -> None:
    """300 fits with six tests each: 18 alarms are expected, with a standard error of 4.2.

    The plain mean over runs, in which 200 samples count as much as 3000, has twice the deviation
    that the threshold is made for: it fails in two fits of three.
    """
    rng = np.random.default_rng(41)
    alarms = 0
    for _ in range(300):
        rows = judged(white(rng, 2), white(rng, 2))
        assert len(rows) == 6
        alarms += sum(not row["passed"] for row in rows.values())
    assert 6 <= alarms <= 31


def test_a_lag_correlates_as_often_as_its_standard_deviation_says() -> None:
    """One over the root of all samples, for every lag."""
    rng = np.random.default_rng(42)
    pairs = [[[r[:, 0] for r in white(rng)] for _ in range(2)] for _ in range(300)]
    found = np.array([correlations(*pair)[0] for pair in pairs])
    assert found.std(axis=0) * np.sqrt(sum(LENGTHS)) == pytest.approx(np.ones(LAGS + 1), rel=0.15)


@pytest.mark.parametrize("pole", [0.5, 0.8, 0.95])
def test_slow_residuals_beside_a_slow_input_fail_no_more_often(pole: float) -> None:
    """An input with a pole of 0.95. Held to white series, they failed in 14, 46 and 68 %."""
    rng = np.random.default_rng(45)

    def slow(a: float) -> list[Floats]:
        return [lfilter([1.0], [1.0, -a], r, axis=0) for r in white(rng)]

    rows = [judged(slow(pole), slow(0.95))["independence of u_pan", "y0"] for _ in range(300)]
    assert sum(not row["passed"] for row in rows) <= 12


def test_correlations_of_one_run_are_numpys() -> None:
    rng = np.random.default_rng(43)
    a, b = rng.standard_normal((2, 300))
    found, size = correlations([a], [b])
    a, b = (a - a.mean()) / a.std(), (b - b.mean()) / b.std()
    assert size == 300
    assert found == pytest.approx(np.correlate(a, b, "full")[299 : 299 + LAGS + 1] / 300)


def test_a_residual_that_follows_an_input_is_found_in_that_signal_and_input_alone() -> None:
    """A sixth of the residual follows pan's input three samples later."""
    rng = np.random.default_rng(44)
    residuals, inputs = white(rng, 2), white(rng, 2)
    for r, u in zip(residuals, inputs, strict=True):
        r[3:, 0] += 0.17 * u[:-3, 0]
    rows = judged(residuals, inputs)
    assert [key for key, row in rows.items() if not row["passed"]] == [
        ("independence of u_pan", "y0")
    ]
    assert rows["independence of u_pan", "y0"]["statistic"] == pytest.approx(0.17, abs=0.05)


def test_a_residual_that_remembers_itself_is_not_white() -> None:
    rng = np.random.default_rng(45)
    residuals = white(rng)
    for r in residuals:
        r[1:] += 0.2 * r[:-1]
    row = judged(residuals, white(rng))["whiteness", "y0"]
    assert not row["passed"]
    assert row["statistic"] == pytest.approx(0.2 / 1.04, abs=0.05)


def test_the_size_of_the_residual_of_one_run_does_not_matter() -> None:
    rng = np.random.default_rng(46)
    residuals, inputs = white(rng), white(rng)
    louder = [1e4 * residuals[0] + 7.0, *residuals[1:]]
    for key, row in judged(residuals, inputs).items():
        other = judged(louder, inputs)[key]
        assert other["statistic"] == pytest.approx(row["statistic"], rel=1e-9)
        assert other["threshold"] == pytest.approx(row["threshold"], rel=1e-9)


def test_runs_too_short_for_the_lags_are_left_out() -> None:
    rng = np.random.default_rng(47)
    ramp = np.arange(4.0 * LAGS)[:, None]
    assert residual_tests(finished([ramp]), INPUTS[:1]) == []
    residuals, inputs = white(rng), white(rng)
    assert judged([ramp, *residuals], [ramp, *inputs]) == judged(residuals, inputs)


def test_a_residual_of_nothing_passes() -> None:
    assert all(row["passed"] for row in judged([np.zeros((500, 1))], [np.ones((500, 1))]).values())


def test_what_never_changes_is_not_tested() -> None:
    """An axis that rests leaves a residual that says nothing, as an input that is constant does."""
    rng = np.random.default_rng(5)
    residuals, inputs = white(rng, 2), white(rng, 2)
    for left, given in zip(residuals, inputs, strict=True):
        left[:, 0], given[:, 1] = 0.1, 3.0
    rows = judged(residuals, inputs)
    assert set(rows) == {("whiteness", "y1"), ("independence of u_pan", "y1")}
