"""Prediction-error filters of known processes, and what generalized least squares makes of them."""

import numpy as np
import pytest
from scipy import signal, stats

from ptp_symbolic.numeric.diagnose.fitted_model import FittedModel
from ptp_symbolic.numeric.diagnose.gain import gain, gain_in_innovations
from ptp_symbolic.numeric.identify.constants import MATERIAL
from ptp_symbolic.numeric.identify.coordinates import free_parameter
from ptp_symbolic.numeric.identify.noise import innovations, prediction_error_filter
from tests.identify.curves import Floats
from tests.identify.straight import finished

AR2 = np.array([1.0, -1.6, 0.8])


def process(seed: int, runs: int, n: int) -> list[Floats]:
    """Runs [n] of an autoregression of order two with innovations of size one."""
    rng = np.random.default_rng(seed)
    return [signal.lfilter([1.0], AR2, rng.standard_normal(n + 200))[200:] for _ in range(runs)]


def test_the_filter_of_an_autoregression_leaves_its_innovations() -> None:
    """Of 20,000 samples: their square to three standard errors, sqrt(2 / n) = 0.01; coefficients of
    higher orders trade for those of the process.
    """
    runs = process(1, 10, 2000)
    found = prediction_error_filter(runs)
    assert found[:3] == pytest.approx(AR2, abs=0.05)
    left = [innovations(run[:, None], [found])[len(found) :] for run in runs]
    assert np.mean(np.concatenate(left) ** 2) == pytest.approx(1.0, abs=0.03)


def test_white_noise_and_nothing_are_left_as_they_are() -> None:
    """Akaike's criterion takes an order too many in one case of six or so, never by much."""
    rng = np.random.default_rng(2)
    found = [prediction_error_filter([rng.standard_normal(3000)]) for _ in range(20)]
    assert sum(len(f) == 1 for f in found) >= 10
    assert max(float(np.max(np.abs(f[1:]), initial=0.0)) for f in found) < 0.08
    assert np.array_equal(prediction_error_filter([np.zeros(50)]), [1.0])


def test_short_runs_allow_few_coefficients() -> None:
    assert len(prediction_error_filter(process(3, 40, 30))) <= 3


def test_a_short_run_beside_long_ones_changes_nothing() -> None:
    runs = process(1, 10, 2000)
    assert np.array_equal(
        prediction_error_filter([*runs, *process(5, 1, 11)]), prediction_error_filter(runs)
    )


def test_innovations_are_white_and_begin_when_the_longest_filter_is_full() -> None:
    (one,) = process(4, 1, 4000)
    table = np.column_stack([one, np.arange(4000.0)]).reshape(-1, 1)
    found = innovations(table, [AR2, np.array([1.0, -1.0])])[:, 0].reshape(-1, 2)
    assert np.all(found[:2] == 0.0)
    assert np.all(found[2:, 1] == 1.0)
    white = found[2:, 0]
    assert np.std(white) == pytest.approx(1.0, abs=0.04)
    assert abs(stats.pearsonr(white[1:], white[:-1]).statistic) < 0.05


def trial(residuals: list[Floats], columns: list[Floats]) -> FittedModel:
    """A fit of one parameter that leaves `residuals`, `columns` [k] its derivative."""
    free = [free_parameter("b", 1.0, -9.0, 9.0)]
    return FittedModel((), finished(residuals, [-c[:, None] for c in columns], None, free))


def drifting(pattern: list[Floats], size: float, seed: int) -> tuple[FittedModel, FittedModel]:
    """Runs with `size` times a pattern and a random walk of steps of one; with the pattern fitted
    by least squares, and without.
    """
    rng = np.random.default_rng(seed)
    walks = [np.cumsum(rng.standard_normal(len(p))) for p in pattern]
    seen = [size * p + w for p, w in zip(pattern, walks, strict=True)]
    amount = sum(p @ s for p, s in zip(pattern, seen, strict=True)) / sum(p @ p for p in pattern)
    left = [s - amount * p for s, p in zip(seen, pattern, strict=True)]
    return trial(left, pattern), trial(seen, [0.0 * p for p in pattern])


def test_what_follows_a_drift_gains_in_least_squares_and_nothing_in_innovations() -> None:
    """One run of a random walk, and half a wave that is not in it: least squares takes a third of
    its square, from one sample to the next the wave tells nothing.
    """
    slow = [np.sin(np.pi * np.arange(2000) / 2000)]
    shares = [
        (gain(*drifting(slow, 0.0, seed)).share, gain_in_innovations(*drifting(slow, 0.0, seed)))
        for seed in range(20)
    ]
    assert np.mean([s for s, _ in shares]) > 0.1
    assert np.mean([g.share for _, g in shares]) < 0.01
    assert max(g.share for _, g in shares) < MATERIAL


def test_what_is_there_is_told_apart_from_the_drift() -> None:
    """A wave of 20 samples, a tenth of the size of the walk: hidden in least squares, clear in
    innovations, whose share is that of its own steps, 0.5 (0.3 * 6)^2 / (1 + that).
    """
    quick = [6.0 * np.sin(2.0 * np.pi * np.arange(2000) / 20.0)] * 4
    larger, smaller = drifting(quick, 1.0, 7)
    steps = 0.5 * (6.0 * 2.0 * np.sin(np.pi / 20.0)) ** 2
    found = gain_in_innovations(larger, smaller)
    assert found.share == pytest.approx(steps / (1.0 + steps), abs=0.05)
    assert found.is_significant(1000)
    assert gain(larger, smaller).share < 0.1
