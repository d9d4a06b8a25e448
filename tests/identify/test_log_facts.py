"""What a log holds, of signals whose facts are known."""

from dataclasses import replace

import numpy as np
import pytest

from ptp_symbolic.numeric.identify.run_preparation import facts_of
from tests.identify.straight import run_of

COUNT = 1e-3  # rad
UNITS = {"u_pan": "V", "theta_pan": "rad"}


def test_a_ramp_after_a_rest_with_a_pause_in_the_clock() -> None:
    """Half of the time at rest, then 0.5 rad/s; 100 Hz, but for one period of 0.11 s."""
    time = 0.01 * np.arange(400.0)
    time[300:] += 0.1
    angle = np.rint(0.5 * np.maximum(time - 2.0, 0.0) / COUNT) * COUNT
    voltage = np.where(time < 2.0, 0.0, 3.0) + 0.02 * np.random.default_rng(3).normal(size=400)
    run = replace(
        run_of(400, 1, voltage[:, None]),
        time=time,
        measured=angle[:, None],
        weight=np.array([np.sqrt(12.0) / COUNT]),
        signals=("theta_pan",),
    )
    facts = facts_of(run, UNITS)
    assert (facts.samples, facts.rate) == (400, pytest.approx(100.0))
    assert facts.duration == pytest.approx(4.09)
    assert facts.longest_period == pytest.approx(0.11)
    assert facts.jitter == pytest.approx(10.0 / np.sqrt(399), rel=1e-6)
    applied, turned = facts.signals
    assert (applied.role, applied.resting, applied.fastest, applied.step) == ("input", *[None] * 3)
    assert applied.noise == pytest.approx(0.02, rel=0.15)
    assert (turned.role, turned.lowest) == ("output", 0.0)
    assert turned.step == pytest.approx(COUNT, rel=0.01) or turned.step % COUNT < 1e-9
    assert turned.at_ends == pytest.approx(201 / 400, abs=0.01)
    assert turned.resting == pytest.approx(0.5, abs=0.02)
    assert turned.fastest == pytest.approx(0.5, rel=0.02)


def test_a_signal_that_never_changes_is_at_its_ends() -> None:
    run = replace(run_of(50, 1, np.zeros((50, 1))), signals=("theta_pan",))
    still = facts_of(run, UNITS).signals[1]
    assert (still.at_ends, still.resting, still.step, still.fastest) == (1.0, 1.0, None, 0.0)
