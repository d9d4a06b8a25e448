"""Fits that are stuck: off a bound, and off places in a gap that have followed the parameters."""

from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from ptp_symbolic.diagnose.floor import leaves_white_noise
from ptp_symbolic.diagnose.refits import at_bounds, started_anew
from ptp_symbolic.diagnose.trial import Task, Trial, fitted
from ptp_symbolic.identify.coordinates import free_parameter
from tests.identify.pan_runs import COUNT, FLOOR, KNOWN, MODEL, THREE, TRUTH, make_runs
from tests.identify.straight import finished
from tests.independent.pan_drive import PanDrive

FREE = (
    free_parameter("J_pan", 0.05, 1e-3, 2.0),
    free_parameter("d_shaft_pan", 1.0, 0.0, 100.0),
)
NOTHING_CARRIED = np.zeros(2)


@pytest.fixture(scope="module")
def task() -> Iterator[Task]:
    """Three runs of the independent drive with a gap, all known but inertia and shaft damping."""
    runs = make_runs(PanDrive(), [profile() for profile in THREE], 21).runs
    fixed = {**KNOWN, **TRUTH}
    with ThreadPoolExecutor(2) as executor:
        yield Task(
            MODEL, runs, runs, (), (), FREE, fixed, (), executor, lambda text: None,
            (None,), frozenset(), FLOOR * COUNT,
        )  # fmt: skip


def test_parameters_at_bounds_are_told_from_others() -> None:
    """Within a tenth of the start, or of the value where that is searched by its logarithm."""
    values = {"J_pan": 1.05e-3, "d_shaft_pan": 0.2}
    fit = finished([np.ones(9)], [np.ones((9, 2))], None, FREE, values)
    assert at_bounds(fit) == {"J_pan"}
    fit = finished([np.ones(9)], [np.ones((9, 2))], None, FREE, {"J_pan": 1.2e-3, "d_shaft_pan": 0})
    assert at_bounds(fit) == {"d_shaft_pan"}


def test_a_fit_that_ended_at_bounds_is_led_away_from_them(task: Task) -> None:
    stuck = fitted(task, (), {**task.fixed, "J_pan": 1e-3, "d_shaft_pan": 0.0}, None)
    assert not leaves_white_noise(stuck, NOTHING_CARRIED)
    found = started_anew(task, stuck, NOTHING_CARRIED)
    assert leaves_white_noise(found, NOTHING_CARRIED)
    for name in ("J_pan", "d_shaft_pan"):
        assert found.values[name] == pytest.approx(TRUTH[name], rel=0.1)


def test_a_trial_that_leaves_noise_alone_stays(task: Task) -> None:
    at_truth: Trial = fitted(task, (), task.fixed, None, 12)
    assert leaves_white_noise(at_truth, NOTHING_CARRIED)
    assert started_anew(task, at_truth, NOTHING_CARRIED) is at_truth
