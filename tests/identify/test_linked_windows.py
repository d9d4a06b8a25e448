"""Windows of a drive that rattles in its gap: each begins where the one before it ended.

The logs are those of the independent pan drive, at its true parameters: what is left is due to the
starts alone.
"""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from numpy.typing import NDArray

from ptp_symbolic.numeric.identify.evaluate import Tolerance, evaluate, start_state
from ptp_symbolic.numeric.identify.fit import Fit, carried_start, fit_parameters, has_linked, linked
from ptp_symbolic.numeric.identify.run import Run
from ptp_symbolic.numeric.identify.windows import cut_where_errors_grow, split_run
from tests.identify.pan_runs import (
    FINE_STEPS,
    KNOWN,
    MODEL,
    TRUTH,
    crawl,
    make_runs,
    seconds,
    stairs,
)
from tests.independent.pan_drive import PanDrive

Floats = NDArray[np.float64]

AT_TRUTH = {**KNOWN, **TRUTH}
P = MODEL.parameter_vector(AT_TRUTH)
NONE = np.zeros(0, dtype=np.int64)
ANGLE = 1  # column of the encoder


def rattle(seed: int) -> Floats:
    """Voltage [k] of several sines that turns around before the gap is crossed calmly."""
    t = seconds(8.0)
    sines = zip(
        (0.7, 1.9, 3.1, 5.3, 7.9), np.random.default_rng(seed).uniform(0.0, 6.28, 5), strict=True
    )
    swelling = 7.0 * np.minimum(t, 1.0)
    return swelling * np.sum([np.sin(2.0 * np.pi * f * t + shift) for f, shift in sines], axis=0)


@pytest.fixture(scope="module")
def runs() -> tuple[Run, ...]:
    """A drive that rattles, one that climbs stairs, one that creeps."""
    return make_runs(PanDrive(), [rattle(1), stairs(), crawl()], 12).runs


def judged(windows: tuple[Run, ...]) -> Fit:
    """The starts of windows fitted at the true parameters."""
    return fit_parameters(MODEL, windows, (), AT_TRUTH, None, FINE_STEPS)


def left(fit: Fit) -> Floats:
    """Root mean square [windows] of the angle's residual, over its noise."""
    tables = [e.residual.reshape(r.measured.shape)[:, ANGLE] for r, e in fit.pairs()]
    return np.array([np.sqrt(np.mean(table**2)) for table in tables])


def test_windows_of_one_run_are_a_series_and_whole_runs_are_not(runs: tuple[Run, ...]) -> None:
    windows = (*split_run(MODEL, runs[0], 2.0), runs[1], *split_run(MODEL, runs[2], 4.0))
    assert linked(windows) == [[0, 1, 2, 3], [4], [5, 6]]
    assert linked(windows[::2]) == [[0], [1], [2], [3]]
    assert has_linked(windows)
    assert not has_linked(runs)


def test_every_window_of_a_rattling_drive_is_told_to_its_noise(runs: tuple[Run, ...]) -> None:
    """Begun alone, by a guess from the angles around, some end on the wrong side of the gap."""
    windows = split_run(MODEL, runs[0], 1.0)
    alone = np.array([left(judged((window,)))[0] for window in windows])
    assert np.count_nonzero(alone > 1.5) >= 2
    assert np.all(left(judged(windows)) < 1.15)


def test_a_window_goes_on_as_the_run_would_have(runs: tuple[Run, ...]) -> None:
    """Where what is seen is as simulated, the propagated start is the state of the whole run."""
    run = runs[0]
    z = judged((run,)).z[0]
    tight = Tolerance(1e-9, 1e-11)
    for window in split_run(MODEL, run, 2.0)[1:]:
        k = int(np.searchsorted(run.time, window.time[0]))
        until = replace(run, time=run.time[: k + 1], measured=run.measured[: k + 1])
        until = replace(until, held_inputs=run.held_inputs[: k + 1])
        before = evaluate(MODEL, until, P, z, NONE, False, tight)
        assert before.end is not None
        begun, _ = start_state(MODEL, window, P, carried_start(MODEL, window, P, before.end), NONE)
        mechanical = [MODEL.state_names.index(f"{x}_pan") for x in ("theta", "omega")]
        mechanical += [MODEL.state_names.index(f"{x}_gear_pan") for x in ("theta", "omega")]
        assert begun[mechanical] == pytest.approx(before.end[mechanical], abs=1e-6)


def test_a_run_that_rattles_is_cut_and_no_other(runs: tuple[Run, ...]) -> None:
    """Without any noise of the input: it is the place in the gap whose error grows."""
    fit = judged(runs)
    nothing_left = np.zeros((len(runs), 2))
    found = cut_where_errors_grow(MODEL, runs, fit.z, nothing_left, P, (0.0,))
    assert [run.source for run in found] == [runs[0].name] * 8 + [runs[1].name, runs[2].name]


def test_the_first_window_begins_as_the_run_and_the_others_on_the_move(
    runs: tuple[Run, ...],
) -> None:
    """A creeping joint stays within its noise for the tenth of a second that tells rest."""
    windows = split_run(MODEL, runs[2], 1.0)
    assert windows[0].unknowns == runs[2].unknowns
    for window in windows[1:]:
        assert [u.name for u in window.unknowns] == [
            "theta_pan",
            "omega_pan",
            "omega_gear_pan",
            "gap_place_0",
        ]
    for before, after in pairwise(windows):
        assert before.time[-1] == after.time[0]


def test_a_joint_near_rest_may_rest_or_turn_back(runs: tuple[Run, ...]) -> None:
    omega = MODEL.state_names.index("omega_pan")
    slow = [w for w in split_run(MODEL, runs[2], 1.0)[1:] if len(w.guesses) > 1]
    assert slow
    for window in slow:
        rates = [start_state(MODEL, window, P, z, NONE)[0][omega] for z in window.guesses]
        assert rates == pytest.approx([rates[0], 0.0, -rates[0]], abs=1e-15)
