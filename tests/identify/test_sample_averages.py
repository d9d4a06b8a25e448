"""Fewer samples of a run: inputs are averaged in between, nothing of them is lost, and they jump
where they did.
"""

from dataclasses import replace

import numpy as np
import pytest

from ptp_symbolic.numeric.identify.run import samples_within, thinned, with_inputs
from ptp_symbolic.numeric.simulation.inputs import InputSignal, sampled_signals
from tests.identify.straight import run_of


def steps_of(signal: InputSignal) -> tuple[np.ndarray, np.ndarray]:
    """Times and values of a zero-order hold."""
    return signal.breaks[:-1], signal.coefficients[:, 0]


def test_inputs_keep_their_integral() -> None:
    rng = np.random.default_rng(3)
    run = run_of(1003, 1, rng.standard_normal((1003, 2)))
    run = replace(run, time=np.sort(rng.uniform(0.0, 20.0, 1003)), measured=run.time[:, None])
    run = with_inputs(run, run.held_inputs)
    few = thinned(run, 5)
    assert np.array_equal(few.time, run.time[::5])
    assert np.array_equal(few.measured, run.measured[::5])
    last = int(np.searchsorted(run.time, few.time[-1]))
    for column, signal in enumerate(sampled_signals(few.inputs)):
        times, values = steps_of(signal)
        whole = np.sum(run.held_inputs[:last, column] * np.diff(run.time)[:last])
        kept = np.sum(values[:-1] * np.diff(times))
        assert kept == pytest.approx(whole, abs=1e-12)


def test_a_step_stays_where_it_was() -> None:
    """At sample 133 of 500, on noise of a five-hundredth; no sample that is kept falls there."""
    step = np.where(np.arange(500) < 133, 0.0, 1.0)
    noise = 0.002 * np.random.default_rng(1).standard_normal(500)
    run = run_of(500, 1, (step + noise)[:, None])
    run = with_inputs(run, run.held_inputs)
    (signal,) = sampled_signals(thinned(run, 5).inputs)
    times, values = steps_of(signal)
    assert set(times) == {*run.time[::5], run.time[133]}
    assert np.all(np.abs(values - (times >= run.time[133])) < 0.01)


def test_noise_alone_has_no_steps() -> None:
    run = run_of(500, 1, np.random.default_rng(2).standard_normal((500, 1)))
    run = with_inputs(run, run.held_inputs)
    (signal,) = sampled_signals(thinned(run, 5).inputs)
    times, _ = steps_of(signal)
    assert len(times) <= 103


@pytest.mark.parametrize(("period", "every"), [(0.03, 1), (0.04, 2), (0.1, 5), (1e-3, 1)])
def test_samples_within_a_time(period: float, every: int) -> None:
    run = run_of(100)  # at 50 Hz
    assert samples_within(run, period) == every
    assert thinned(run, 1) is run
