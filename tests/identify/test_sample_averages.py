"""Fewer samples of a run: the inputs in between are averaged, nothing of them is lost."""

from dataclasses import replace

import numpy as np
import pytest

from ptp_symbolic.numeric.identify.sample_averages import thinned
from tests.identify.straight import run_of


def test_inputs_keep_their_integral() -> None:
    rng = np.random.default_rng(3)
    run = run_of(1003, 1, rng.standard_normal((1003, 2)))
    run = replace(run, time=np.sort(rng.uniform(0.0, 20.0, 1003)), measured=run.time[:, None])
    few = thinned(run, 5.0 * float(np.median(np.diff(run.time))))
    assert np.array_equal(few.time, run.time[::5])
    assert np.array_equal(few.measured, run.measured[::5])
    last = int(np.searchsorted(run.time, few.time[-1]))
    for column in range(2):
        whole = np.sum(run.held_inputs[:last, column] * np.diff(run.time)[:last])
        kept = np.sum(few.held_inputs[:-1, column] * np.diff(few.time))
        assert kept == pytest.approx(whole, abs=1e-12)


def test_a_slow_run_stays() -> None:
    run = run_of(100)  # at 50 Hz
    assert thinned(run, 0.03) is run
