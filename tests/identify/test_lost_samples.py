"""Logs of which samples are missing: closed form of a free axis under a torque that is held."""

from dataclasses import replace

import numpy as np
import pytest

from ptp_symbolic.numeric.data.latency import after_lost
from ptp_symbolic.numeric.diagnose.cut_runs import parted_at_lost_samples
from ptp_symbolic.numeric.identify.run import Run
from tests.identify.curves import Floats
from tests.identify.test_windows import FREE, INERTIA, MODEL, run_of

PERIOD = 0.01
TIME = PERIOD * np.arange(400)
P = MODEL.parameter_vector(FREE)
LOST = slice(200, 203)


def moved(torque: Floats) -> Run:
    """A run of the free pan axis under a `torque` [400] in N m, without three samples after 2 s."""
    rate = np.concatenate([[0.0], np.cumsum(torque[:-1]) * PERIOD / INERTIA])
    steps = rate * PERIOD + 0.5 * torque * PERIOD**2 / INERTIA
    angle = np.concatenate([[0.0], np.cumsum(steps[:-1])])
    whole = run_of(angle, 0.0 * TIME, torque, PERIOD)
    kept = np.delete(np.arange(400), LOST)
    return run_of(angle[kept], 0.0 * kept, torque[kept], PERIOD, whole.time[kept])


def test_where_a_torque_changed_meanwhile_a_new_part_begins() -> None:
    """Held 30 ms too long, half a newton metre is 0.75 rad/s more at 0.02 kg m^2."""
    run = moved(np.where(TIME < 2.0, 0.5, -0.5))
    first, second = parted_at_lost_samples(MODEL, run, P)
    assert (first.source, second.source) == (run.source, run.source)
    assert (first.time[-1], second.time[0]) == pytest.approx((1.99, 2.03))
    assert len(first.time) + len(second.time) == len(run.time)
    assert np.array_equal(np.vstack([first.measured, second.measured]), run.measured)
    assert np.array_equal(np.vstack([first.held_inputs, second.held_inputs]), run.held_inputs)
    rates = [u for u in second.unknowns if u.name == "omega_pan"]
    assert len(rates) == 1


def test_where_the_torque_stays_the_run_stays_whole() -> None:
    run = moved(np.where(TIME < 1.0, 0.5, -0.5))
    assert parted_at_lost_samples(MODEL, run, P) == (run,)


def test_a_change_that_moves_no_signal_by_its_noise_leaves_the_run_whole() -> None:
    """A thousandth of the torque is 0.5 counts a second later; noise of 20 counts hides it."""
    run = moved(np.where(TIME < 2.0, 5e-4, -5e-4))
    coarse = replace(run, weight=run.weight / 20.0)
    assert parted_at_lost_samples(MODEL, coarse, P) == (coarse,)
    assert len(parted_at_lost_samples(MODEL, run, P)) == 2


@pytest.mark.parametrize(("jitter", "lost"), [(0.0, 1), (0.05, 1), (0.05, 3)])
def test_a_missing_sample_is_told_from_jitter(jitter: float, lost: int) -> None:
    rng = np.random.default_rng(8)
    time = np.delete(TIME + PERIOD * rng.uniform(-jitter, jitter, 400), slice(200, 200 + lost))
    assert list(after_lost(time)) == [200]


def test_uneven_sampling_misses_nothing() -> None:
    """Steps from half the usual to one and a half times."""
    rng = np.random.default_rng(9)
    assert after_lost(np.cumsum(rng.uniform(0.5, 1.5, 2000))).size == 0
