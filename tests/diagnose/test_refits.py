"""Fits that are stuck: parameters outside their prior range, places in a gap that followed them."""

from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest

from ptp_symbolic.numeric.diagnose.fitted_model import FittedModel, SearchProblem, fitted
from ptp_symbolic.numeric.diagnose.noise_floor import PropagatedNoise, leaves_white_noise
from ptp_symbolic.numeric.diagnose.refits import (
    _back_in_range,
    _with_windows_restarted,
    beside_declared,
    declared_from,
    is_near_noise_floor,
    outside_prior_range,
    restarted_fit,
)
from ptp_symbolic.numeric.identify.constants import SHORT
from ptp_symbolic.numeric.identify.coordinates import free_parameter
from ptp_symbolic.numeric.identify.fit import linked
from ptp_symbolic.numeric.identify.windows import split_run
from tests.identify.pan_runs import COUNT, FLOOR, KNOWN, MODEL, THREE, TRUTH, make_runs
from tests.independent.pan_drive import PanDrive

FREE = (
    free_parameter("J_pan", 0.05, 1e-3, 2.0),
    free_parameter("d_shaft_pan", 1.0, 0.0, 100.0),
)
NAMES = tuple(f.name for f in FREE)
NOTHING_CARRIED = PropagatedNoise(*[np.zeros(2)] * 3)


@pytest.fixture(scope="module")
def problem() -> Iterator[SearchProblem]:
    """Three runs of the independent drive with a gap, all known but inertia and shaft damping."""
    runs = make_runs(PanDrive(), [profile() for profile in THREE], 21).runs
    fixed = {**KNOWN, **TRUTH}
    with ThreadPoolExecutor(2) as executor:
        yield SearchProblem(
            MODEL,
            runs,
            runs,
            runs,
            (),
            (),
            (),
            FREE,
            fixed,
            (),
            executor,
            lambda text: None,
            (None,),
            frozenset(),
            FLOOR * COUNT,
        )


@pytest.mark.parametrize(
    ("inertia", "damping", "expected"),
    [(0.05, 1.0, []), (0.19, 0.26, []), (0.21, 0.26, ["J_pan"]), (0.012, 0.0, [*NAMES])],
)
def test_parameters_further_off_than_a_start_may_be_are_outside_their_prior_range(
    problem: SearchProblem, inertia: float, damping: float, expected: list[str]
) -> None:
    """Four times either way: 0.0125 to 0.2 kg m^2 and 0.25 to 4 N m s/rad."""
    found = outside_prior_range(problem, {"J_pan": inertia, "d_shaft_pan": damping})
    assert [f.name for f in found] == expected


def test_a_fit_whose_parameters_are_outside_their_range_is_restarted(
    problem: SearchProblem,
) -> None:
    stuck = fitted(problem, (), {**problem.fixed, "J_pan": 1e-3, "d_shaft_pan": 0.0}, None)
    assert not leaves_white_noise(stuck, NOTHING_CARRIED)
    found = restarted_fit(problem, stuck, NOTHING_CARRIED)
    assert leaves_white_noise(found, NOTHING_CARRIED)
    for name in NAMES:
        assert found.values[name] == pytest.approx(TRUTH[name], rel=0.1)


def test_a_declared_model_outside_its_prior_range_is_restarted_before_its_end_is_believed(
    problem: SearchProblem,
) -> None:
    """Nothing else is tried where nothing is outside, and nothing is gained by a restart."""
    outside = fitted(problem, (), {**problem.fixed, "J_pan": 1e-3, "d_shaft_pan": 0.0}, None)
    assert not is_near_noise_floor(outside)
    assert leaves_white_noise(_back_in_range(problem, outside), NOTHING_CARRIED)
    assert _back_in_range(replace(problem, material=1.0), outside) is outside
    wrong = fitted(problem, (), {**problem.fixed, "J_pan": 0.19}, None)
    assert not is_near_noise_floor(wrong)
    assert _back_in_range(problem, wrong) is wrong
    failed = replace(outside, fit=replace(outside.fit, failed="not finite", cost=np.inf))
    assert leaves_white_noise(
        _back_in_range(replace(problem, material=1.0), failed), NOTHING_CARRIED
    )


def test_a_trial_that_leaves_noise_alone_stays(problem: SearchProblem) -> None:
    at_truth: FittedModel = fitted(problem, (), problem.fixed, None, 12)
    assert leaves_white_noise(at_truth, NOTHING_CARRIED)
    assert restarted_fit(problem, at_truth, NOTHING_CARRIED) is at_truth


def test_a_declared_model_that_was_stuck_goes_where_a_set_leads_it(problem: SearchProblem) -> None:
    stuck = fitted(problem, (), {**problem.fixed, "J_pan": 1e-3, "d_shaft_pan": 0.0}, None)
    elsewhere = fitted(problem, (), {**problem.fixed, "J_pan": 0.08, "d_shaft_pan": 1.2}, None)
    found = declared_from(problem, elsewhere, stuck, NOTHING_CARRIED)
    assert found is not None and leaves_white_noise(found, NOTHING_CARRIED)
    assert declared_from(problem, stuck, found, NOTHING_CARRIED) is None
    strict = replace(problem, material=1.0)
    assert declared_from(strict, elsewhere, stuck, NOTHING_CARRIED) is None


def test_a_set_that_is_stuck_goes_where_the_declared_model_leads_it(problem: SearchProblem) -> None:
    stuck = fitted(problem, (), {**problem.fixed, "J_pan": 1e-3, "d_shaft_pan": 0.0}, None)
    declared = fitted(problem, (), problem.fixed, None, 12)
    found = beside_declared(problem, stuck, declared, NOTHING_CARRIED)
    assert leaves_white_noise(found, NOTHING_CARRIED)


def test_a_window_that_went_astray_is_begun_where_the_one_before_ends(
    problem: SearchProblem,
) -> None:
    """Its loss is robust: left alone, it tells nothing any more, and its error stays."""
    windows = tuple(w for run in problem.train for w in split_run(MODEL, run, SHORT))
    cut = replace(problem, train=windows)
    second = next(series[1] for series in linked(windows) if len(series) > 1)
    right = fitted(cut, (), problem.fixed, None, 4, executor=problem.executor)
    astray = [start.copy() for start in right.fit.z]
    astray[second][1] += 0.2
    wrong = fitted(cut, (), right.values, astray)
    assert np.max(_rms(wrong)) > 5.0 * np.median(_rms(wrong))
    found = _with_windows_restarted(cut, wrong)
    assert np.max(_rms(found)) < 1.5 * np.median(_rms(found))
    assert _with_windows_restarted(cut, found) is found
    assert _with_windows_restarted(problem, wrong) is wrong


def _rms(trial: FittedModel) -> list[float]:
    return [float(np.sqrt(np.mean(e.residual**2))) for e in trial.fit.evaluations]
