"""Runs with equal inputs tell the noise of a machine without a model."""

from dataclasses import replace

import numpy as np
import pytest

from ptp_symbolic.numeric.identify.noise import repeatability
from ptp_symbolic.numeric.identify.run import Run
from tests.identify.straight import run_of

SAMPLES = 2000
TIME = np.arange(SAMPLES) / 50.0
DRIVEN = np.sin(0.7 * TIME)[:, None]


def repeated(seed: int, spread: float, name: str, drive: np.ndarray = DRIVEN) -> Run:
    """A run whose two signals spread about the same motion; inputs with noise of their own."""
    rng = np.random.default_rng(seed)
    run = run_of(SAMPLES, 2, drive + 0.02 * rng.standard_normal(drive.shape), name)
    sigma = spread * np.array([1.0, 3.0])
    measured = np.cos(TIME)[:, None] + sigma * rng.standard_normal((SAMPLES, 2))
    return replace(run, measured=measured, weight=1.0 / sigma)


def test_the_spread_of_every_signal_is_found() -> None:
    runs = [repeated(k, 0.01, f"run {k}") for k in range(3)]
    found = repeatability(runs)
    assert found is not None
    assert found.rms == pytest.approx([0.01, 0.03], rel=0.05)
    assert found.names == (("run 0", "run 1"), ("run 0", "run 2"), ("run 1", "run 2"))


def test_other_inputs_other_lengths_and_other_starts_do_not_count() -> None:
    one = repeated(1, 0.01, "one")
    other = repeated(2, 0.01, "other", 1.05 * DRIVEN)
    moved = replace(one, name="moved", measured=one.measured + 0.5)
    short = replace(
        one, time=one.time[:-1], held_inputs=one.held_inputs[:-1], measured=one.measured[:-1]
    )
    assert repeatability([one, other]) is None
    assert repeatability([one, moved]) is None
    assert repeatability([one, short]) is None
    assert repeatability([one]) is None


def test_inputs_without_noise_must_be_equal() -> None:
    one, other = (replace(repeated(k, 0.01, f"{k}"), held_inputs=DRIVEN) for k in (1, 2))
    assert repeatability([one, other]) is not None
    assert repeatability([one, replace(other, held_inputs=1.001 * DRIVEN)]) is None
