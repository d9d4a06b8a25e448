"""The noise of a measured signal: rounding of its encoder and what is declared, or seen, of it."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

import ptp_symbolic
from ptp_symbolic.numeric.data import Log
from ptp_symbolic.numeric.identify.run_preparation import prepare_runs
from ptp_symbolic.platform import Platform, SignalDeclaration
from tests.identify.curves import Floats

COUNT = 2 * np.pi / 7200
ROUNDING = 2.5191e-4  # rad: 0.05 degrees over the root of 12
SIGNALS = tuple(
    SignalDeclaration(f"{what}_{axis}", f"{axis}_{what}", unit, role, counts)
    for what, unit, role, counts in (
        ("tau", "N m", "input", None),
        ("theta", "rad", "output", 7200),
    )
    for axis in ("pan", "tilt")
)
MODEL = ptp_symbolic.load("payload")
TIME = np.arange(4000) / 200
MOTION = np.column_stack([0.9 * np.sin(2.1 * TIME), 0.4 * np.cos(1.3 * TIME)])


def sigma(pan: SignalDeclaration, logs: Sequence[Floats]) -> tuple[float, float]:
    """Standard deviations of the pan and of the tilt angle; the latter has an encoder alone."""
    signals = (*SIGNALS[:2], pan, SIGNALS[3])
    platform = Platform("both", "Both axes", ("pan", "tilt"), 9.81, (), (), signals)
    made = [Log("run", TIME[: len(a)], np.zeros((len(a), 2)), a) for a in logs]
    runs = prepare_runs(MODEL, platform, made)
    assert all(np.array_equal(run.weight, runs[0].weight) for run in runs)
    pan_weight, tilt_weight = runs[0].weight
    return 1.0 / pan_weight, 1.0 / tilt_weight


ENCODER = SIGNALS[2]
ANALOG = replace(ENCODER, counts_per_revolution=None, noise=3e-4)
REST = np.zeros((400, 2))


def noisy(rms: float, seed: int) -> Floats:
    """The motion with white noise before it is rounded to counts."""
    noise = rms * np.random.default_rng(seed).standard_normal(MOTION.shape)
    return np.rint((MOTION + noise) / COUNT) * COUNT


def test_an_encoder_at_rest_has_the_noise_of_its_rounding() -> None:
    assert sigma(ENCODER, [REST]) == pytest.approx((ROUNDING, ROUNDING), rel=1e-4)


def test_declared_noise_adds_to_rounding_as_variances_do() -> None:
    """3, 4 and 5 are the sides of a right triangle."""
    declared = replace(ENCODER, noise=4 / 3 * ROUNDING)
    assert sigma(declared, [REST])[0] == pytest.approx(5 / 3 * ROUNDING, rel=1e-4)


def test_a_signal_without_counts_has_its_declared_noise_alone() -> None:
    assert sigma(ANALOG, [REST])[0] == pytest.approx(3e-4, rel=1e-12)


def test_noise_that_is_not_declared_is_seen_in_the_log_with_the_rounding_in_it() -> None:
    """A standard error of 2.5 %; rounding is not counted twice."""
    expected = np.hypot(ROUNDING, 6e-4)
    assert sigma(ENCODER, [noisy(6e-4, 1)]) == pytest.approx((expected, expected), rel=0.1)
    assert sigma(ENCODER, [noisy(0.0, 1)]) == pytest.approx((ROUNDING, ROUNDING), rel=0.1)


def test_declared_noise_counts_whatever_the_log_shows() -> None:
    declared = replace(ENCODER, noise=4 / 3 * ROUNDING)
    assert sigma(declared, [noisy(6e-3, 1)])[0] == pytest.approx(5 / 3 * ROUNDING, rel=1e-4)


def test_one_rough_log_of_three_does_not_set_the_noise_of_all() -> None:
    logs = [noisy(6e-4, 1), noisy(6e-2, 2), noisy(6e-4, 3)]
    expected = np.hypot(ROUNDING, 6e-4)
    assert sigma(ENCODER, logs) == pytest.approx((expected, expected), rel=0.1)
