"""What noise of the inputs leaves of runs: closed forms of a free axis, which integrates its torque
twice.
"""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
from scipy import stats

from ptp_symbolic.numeric.diagnose import noise_floor as module
from ptp_symbolic.numeric.diagnose.confirm import _examined
from ptp_symbolic.numeric.diagnose.fitted_model import FittedModel
from ptp_symbolic.numeric.diagnose.noise_floor import (
    PropagatedNoise,
    bound_of,
    normalised_residual,
    propagated_input_noise,
)
from ptp_symbolic.numeric.diagnose.stepwise import StepwiseSearch
from ptp_symbolic.numeric.identify.constants import FALSE_ALARM, TEST_ALARM
from ptp_symbolic.numeric.identify.fit import Fit
from ptp_symbolic.numeric.identify.intervals import chance_of_zero
from tests.identify.straight import finished
from tests.identify.test_replays import SIGMA, accelerated, drifts

NOISE = 0.004  # N m
RUNS = 3


def problem_of(fit: Fit, *noise: float | None) -> Any:
    """The problem to fit so many equal runs, with `noise` (N m) of the torques."""
    return SimpleNamespace(
        model=fit.model,
        every_sample=fit.runs,
        train=fit.runs,
        windows=(),
        input_noise=noise,
        executor=None,
    )


def propagated(noise: float) -> PropagatedNoise:
    """What `noise` of the torque (N m) leaves of so many equal runs."""
    fit = accelerated(RUNS)
    return propagated_input_noise(problem_of(fit, noise, 0.0), fit)


def test_what_inputs_carry_is_the_noise_integrated_twice() -> None:
    """Of runs that a start follows, the drift beside a straight line is left."""
    found = propagated(NOISE)
    paths = drifts(NOISE, 3000) / SIGMA
    each = [
        normalised_residual(finished(list(paths[:, k : k + RUNS].T)))[0]
        for k in range(0, 3000, RUNS)
    ]
    assert found.median[0] == pytest.approx(np.median(each), rel=0.25)
    assert 0.85 < np.mean(each <= found.rare[0]) <= 0.99
    assert 0.9 < np.mean(each <= found.most[0]) <= 1.0
    assert found.most[1] < 1e-4


@pytest.mark.parametrize(
    ("noise", "own"), [((NOISE, 0.0), True), ((0.0, 0.0), False), ((None, 0.0), False)]
)
def test_declared_noise_excuses_no_more_of_what_is_left_than_of_an_effect(
    noise: tuple[float | None, float], own: bool
) -> None:
    """The trial itself carries it, whatever others did; what the samples show may be no noise."""
    fit = accelerated(RUNS)
    others = PropagatedNoise(*[np.full(2, 0.1)] * 3)
    stepwise = cast(
        Any, SimpleNamespace(problem=problem_of(fit, *noise), propagated=others, followed=None)
    )
    found = StepwiseSearch.input_noise_for(stepwise, FittedModel((), fit))
    assert found is others if not own else found.median[0] == propagated(NOISE).median[0] > 1.0


@pytest.mark.parametrize("freedom", [1, 4, 30])
def test_the_most_of_a_mean_square_is_rarely_exceeded(freedom: int) -> None:
    """One in thirty exceeds what eight others foretell at 99 %: that is not known exactly."""
    rng = np.random.default_rng(freedom)
    bounds = [bound_of(rng.chisquare(freedom, 8), TEST_ALARM) for _ in range(400)]
    above = np.mean([stats.chi2.sf(bound, freedom) for bound in bounds])
    assert 0.005 < above < 0.04
    assert np.median(bounds) < 1.5 * stats.chi2.ppf(0.99, freedom)


def test_a_replay_that_sticks_elsewhere_does_not_hide_what_is_missing() -> None:
    """Seven that leave next to nothing, and one that leaves a hundred."""
    assert bound_of(np.array([1e-4] * 7 + [100.0]), TEST_ALARM) < 1.0
    assert bound_of(np.full(8, 2.0), TEST_ALARM) == pytest.approx(2.0, rel=1e-3)


def test_silent_inputs_carry_nothing() -> None:
    assert np.all(propagated(0.0).most < 1e-4)


def test_many_windows_count_without_the_worst_tenth_and_few_runs_by_their_mean() -> None:
    """Of 40 windows of which 15 are in motion, and leave ten times the noise there, four are left
    out: 36 * x^2 = 25 + 11 * 100.
    """
    wave = np.where(np.arange(40) % 2, 1.0, -1.0)
    many = [wave] * 21 + [50.0 * wave] * 2
    assert normalised_residual(finished(many)) == pytest.approx([1.0])
    moving = [wave] * 25 + [10.0 * wave] * 15
    assert normalised_residual(finished(moving)) == pytest.approx([np.sqrt(1125.0 / 36.0)])
    assert normalised_residual(finished([wave, 2.0 * wave])) == pytest.approx([np.sqrt(2.5)])
    failed = finished([wave])
    gone = replace(failed.evaluations[0], failed="stopped")
    assert normalised_residual(replace(failed, evaluations=(gone,))) == pytest.approx([np.inf])


def test_a_replay_that_cannot_be_simulated_leaves_what_the_others_of_its_run_leave(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Half of the replays of every run fail; of one run all do, and it tells nothing."""
    squares = np.random.default_rng(64).chisquare(4, (8, 3, 1)) / 4.0
    fit = finished([np.zeros(50)] * 3)

    def bounds(table: np.ndarray[Any, Any], runs: int) -> list[float]:
        monkeypatch.setattr(module, "replayed_squares", lambda *_: table)
        part = replace(fit, runs=fit.runs[:runs])
        found = propagated_input_noise(problem_of(part, 1.0, 0.0), part)
        return [float(b[0]) for b in (found.median, found.rare, found.most)]

    failed = squares.copy()
    failed[::2] = np.nan
    assert bounds(failed, 3) == pytest.approx(bounds(squares, 3), rel=0.5)
    alone = squares.copy()
    alone[:, 2] = np.nan
    assert bounds(alone, 3) == pytest.approx(bounds(squares[:, :2], 2), rel=1e-12)
    assert bounds(np.full_like(squares, np.nan), 3)[2] < 1e-4


@pytest.mark.parametrize(("noise", "known"), [(0.0, True), (NOISE, False)])
def test_an_amount_is_known_no_better_than_the_noise_of_the_inputs_allows(
    noise: float, known: bool
) -> None:
    """Beside more than noise: the inertia is five percent off where it would vanish, and noise of
    the torque as large as that shifts it by more.
    """
    fit = accelerated(RUNS)
    rng = np.random.default_rng(65)
    noisy = [
        replace(e, residual=e.residual + 3.0 * rng.standard_normal(e.residual.size))
        for e in fit.evaluations
    ]
    trial = FittedModel((), replace(fit, evaluations=tuple(noisy)))
    problem = problem_of(fit, noise, 0.0)
    problem.white, problem.declared_noise = True, frozenset()
    stepwise = cast(
        Any, SimpleNamespace(problem=problem, propagated=PropagatedNoise(*[np.zeros(2)] * 3))
    )
    examined = _examined(stepwise, trial)
    zero = {"J_pan": fit.values["J_pan"] * 1.05}
    assert (chance_of_zero(examined, zero) < FALSE_ALARM) is known


def test_a_fit_that_leaves_noise_alone_is_examined_without_replays() -> None:
    fit = accelerated(RUNS)
    problem = problem_of(fit, NOISE, 0.0)
    problem.white, problem.declared_noise = True, frozenset()
    stepwise = cast(
        Any, SimpleNamespace(problem=problem, propagated=PropagatedNoise(*[np.zeros(2)] * 3))
    )
    assert _examined(stepwise, FittedModel((), fit)).by_input_noise == ()
