"""The bordered Levenberg-Marquardt against SciPy, which solves for all unknowns side by side."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import lsq_linear

from ptp_symbolic.numeric.identify.constants import LARGEST_STEP
from ptp_symbolic.numeric.identify.evaluate import Evaluation
from ptp_symbolic.numeric.identify.least_squares import (
    Optimum,
    Problem,
    cost_of,
    limited_step,
    minimise,
)
from tests.identify.curves import PHI, PRIOR, Curves, Floats, evaluation, measure

BEGIN = PHI * [1.4, 1.1, 0.6]


@pytest.fixture(scope="module")
def curves() -> Curves:
    return measure(runs=5)


def fitted(problem: Problem, curves: Curves) -> Optimum:
    return minimise(problem, BEGIN, curves.nowhere(), iterations=200, gain=1e-13, rejections=12)


def mean_square(found: Optimum) -> float:
    return float(np.mean(np.concatenate([e.residual for e in found.evaluations]) ** 2))


def test_five_runs_with_starts_of_their_own_end_where_scipy_ends(curves: Curves) -> None:
    problem = curves.problem()
    found = fitted(problem, curves)
    phi, z, cost = curves.dense(problem, BEGIN)
    assert found.failed is None
    assert found.phi == pytest.approx(phi, rel=1e-6)
    assert np.concatenate(found.z) == pytest.approx(np.concatenate(z), abs=1e-6)
    assert found.cost == pytest.approx(cost, rel=1e-9)
    assert found.phi == pytest.approx(PHI, rel=0.02)


@pytest.mark.parametrize(
    ("lower", "upper"),
    [((0.0, 0.0, 0.0), (9.0, 9.0, 1.3)), ((0.75, 0.0, 0.0), (9.0,) * 3), ((0.8,) * 3, (2.2,) * 3)],
)
def test_bounds_of_shared_parameters_hold_as_in_scipy(
    curves: Curves, lower: tuple[float, ...], upper: tuple[float, ...]
) -> None:
    problem = curves.problem(lower, upper)
    begin = np.clip(BEGIN, problem.lower + 1e-3, problem.upper - 1e-3)
    found = fitted(problem, curves)
    phi, z, cost = curves.dense(problem, begin, mean_square(found))
    assert np.any((found.phi == problem.lower) | (found.phi == problem.upper))
    assert found.phi == pytest.approx(phi, rel=1e-5)
    assert np.concatenate(found.z) == pytest.approx(np.concatenate(z), abs=1e-5)
    assert found.cost == pytest.approx(cost, rel=1e-8)


def test_bounds_of_start_unknowns_hold_as_in_scipy(curves: Curves) -> None:
    """What a start can no longer take up must bend the shared parameters as it does in SciPy."""
    problem = curves.problem(start_bound=0.5)
    found = fitted(problem, curves)
    phi, z, cost = curves.dense(problem, BEGIN, mean_square(found))
    at_bound = np.abs(np.concatenate(found.z)) == 0.5
    assert 2 <= at_bound.sum() < at_bound.size
    assert found.cost == pytest.approx(cost, rel=1e-6)
    assert found.phi == pytest.approx(phi, rel=1e-4)
    assert np.concatenate(found.z) == pytest.approx(np.concatenate(z), abs=1e-4)


def test_prior_weighs_as_much_as_the_mean_square_residual(curves: Curves) -> None:
    """At the end: precision times mean square. SciPy gets that weight and must agree with it."""
    problem = curves.problem(precision=(90.0, 0.0, 90.0))
    found = fitted(problem, curves)
    phi, _, _ = curves.dense(problem, BEGIN, mean_square(found))
    plain, _, _ = curves.dense(problem, BEGIN)
    assert found.phi == pytest.approx(phi, rel=1e-5)
    assert np.max(np.abs(phi / plain - 1.0)) > 0.01


@pytest.mark.parametrize("coupling", [0.0, 0.6, -0.6])
def test_one_parameter_that_wants_far_does_not_stop_the_others(coupling: float) -> None:
    """The first step is SciPy's minimum in the box of largest steps."""
    matrix = np.array([[1e-3, 0.0, 0.0], [1e-3 * coupling, 1.0, 0.0], [0.0, 0.3, 2.0]])
    target = np.array([7.0, 0.4, -0.5])
    far = np.full(3, 1e6)
    problem = Problem(
        lambda phi, z, tangents: [evaluation(target - matrix @ phi, -matrix, np.zeros((3, 0)))],
        -far,
        far,
        *[[np.zeros(0)]] * 3,
        np.zeros(3),
        np.zeros(3),
    )
    found = minimise(problem, np.zeros(3), [np.zeros(0)], iterations=1)
    exact = lsq_linear(matrix, target, (-LARGEST_STEP, LARGEST_STEP)).x
    assert found.phi == pytest.approx(exact, abs=2e-3)
    assert found.phi[0] == LARGEST_STEP


def straight(matrix: Floats, target: Floats) -> Problem:
    """As many residuals as parameters, linear, parameters above zero, no start unknowns."""
    zero, none = np.zeros(len(target)), [np.zeros(0)]
    return Problem(
        lambda phi, z, tangents: [evaluation(target - matrix @ phi, -matrix, zero[:, None][:, :0])],
        zero,
        zero + 1e6,
        none,
        none,
        none,
        zero,
        zero,
    )


def test_a_bound_is_neared_by_one_share_per_step_and_then_reached() -> None:
    """The first parameter wants to -1. In its logarithm the steps would be of length one too, but
    would never end at zero. Beyond 0.1 the second one, at 0.05 already, is not held up.
    """
    problem = straight(np.eye(2), np.array([-1.0, -1.0]))
    begin = np.array([1.0, 0.05])
    for steps, first in enumerate([np.exp(-1.0), np.exp(-2.0), np.exp(-3.0), 0.0], start=1):
        found = minimise(problem, begin, [np.zeros(0)], iterations=steps)
        assert found.phi[0] == pytest.approx(first, rel=1e-12, abs=0.0)
        assert found.phi[1] == 0.0


def test_what_a_bound_holds_up_the_others_make_good_at_once() -> None:
    """The first step is SciPy's minimum in the box that may be reached in one."""
    matrix, target = np.array([[1.0, 0.6], [0.6, 1.0]]), np.array([-1.0, 0.8])
    begin = np.array([0.5, 1.0])
    box = begin * np.exp(-1.0), begin + LARGEST_STEP
    exact = lsq_linear(matrix, target, box).x
    found = minimise(straight(matrix, target), begin, [np.zeros(0)], iterations=1)
    assert exact[0] == pytest.approx(box[0][0])
    assert box[0][1] < exact[1] < box[1][1]
    assert found.phi == pytest.approx(exact, abs=2e-3)


@pytest.mark.parametrize("size", [(1.0, 1.0, 1.0), (100.0, 0.01, 1.0)])
def test_what_is_fixed_at_its_bound_pulls_on_those_that_are_free(
    size: tuple[float, float, float],
) -> None:
    """The least of a quadratic in a box, two of three at their bounds, by hand: the third solves
    its own equation with what the others take; the scale of the parameters does not matter.
    """
    unscaled = np.array([[4.0, 3.0, 1.0], [3.0, 9.0, 2.0], [1.0, 2.0, 5.0]])
    scale = np.array(size)
    matrix, right = unscaled * np.outer(scale, scale), np.array([-10.0, 1.0, 9.0]) * scale
    low, high = np.array([-0.5, -9.0, -9.0]) / scale, np.array([9.0, 9.0, 1.0]) / scale
    step = limited_step(matrix, right, np.sqrt(np.diag(matrix)), low, high) * scale
    assert step == pytest.approx([-0.5, (1.0 - 3.0 * -0.5 - 2.0 * 1.0) / 9.0, 1.0], rel=1e-12)


def test_steps_into_a_failing_region_are_never_accepted(curves: Curves) -> None:
    """The simulation fails beyond phi_2 = 1.2, where the optimum (1.4) lies."""
    tried = []

    def fails(phi: Floats) -> bool:
        tried.append(phi[2])
        return bool(phi[2] > 1.2)

    found = fitted(curves.problem(fails=fails), curves)
    assert max(tried) > 1.2
    assert 0.84 < found.phi[2] <= 1.2
    assert found.failed is None
    assert not any(e.failed for e in found.evaluations)
    assert np.isfinite(found.cost)


def test_a_run_that_falls_off_a_cliff_with_its_start_keeps_it_and_the_others_move() -> None:
    """Two runs share phi, whose optimum is 2. The start of the first wants to 1, but its residual
    jumps by 1000 as soon as it leaves zero: its derivative misleads at every length of a step.
    """

    def evaluate(
        phi: Floats, z: Sequence[Floats], tangents: bool, only: Sequence[int] | None = None
    ) -> list[Evaluation]:
        slope, cliff = -np.ones((2, 1)), 1e3 * (z[0][0] != 0.0)
        runs = [
            evaluation(
                np.array([2.0 - phi[0], 1.0 - z[0][0] + cliff]),
                slope * [[1.0], [0.0]],
                slope * [[0.0], [1.0]],
            ),
            evaluation(np.array([2.0 - phi[0], 0.5]), slope * [[1.0], [0.0]], 0.0 * slope),
        ]
        return [runs[k] for k in (range(2) if only is None else only)]

    ends = [np.full(1, 9.0)] * 2
    far = np.full(1, 9.0)
    problem = Problem(evaluate, -far, far, [-e for e in ends], ends, ends, np.zeros(1), np.zeros(1))
    found = minimise(problem, np.zeros(1), [np.zeros(1), np.zeros(1)], gain=1e-9)
    assert found.phi[0] == pytest.approx(2.0, abs=1e-3)
    assert found.z[0][0] == 0.0


def test_a_start_that_fails_is_reported_and_left_as_it_is(curves: Curves) -> None:
    found = fitted(curves.problem(fails=lambda phi: True), curves)
    assert found.failed == "the model fails here"
    assert found.cost == np.inf
    assert np.array_equal(found.phi, BEGIN)


def test_residuals_without_end_or_with_absurd_slopes_cost_infinitely(curves: Curves) -> None:
    problem, z = curves.problem(), curves.nowhere()
    good = problem.evaluate(PHI, z, True)
    assert np.isfinite(cost_of(problem, good, z))
    for bad in (
        replace(good[0], residual=np.full(60, np.nan)),
        replace(good[0], by_start=1e16 * np.ones((60, 2))),
    ):
        assert cost_of(problem, [bad, *good[1:]], z) == np.inf


def test_starts_count_in_the_cost_by_their_prior(curves: Curves) -> None:
    problem = curves.problem()
    z = [np.full(n, 0.2) for n in curves.unknowns]
    runs = problem.evaluate(PHI, z, False)
    squares = sum(float(np.sum(e.residual**2)) for e in runs)
    expected = squares + 3.0 * sum(curves.unknowns) * (0.2 / PRIOR) ** 2
    assert cost_of(problem, runs, z, scale=3.0) == pytest.approx(expected, rel=1e-14)


def inertia_beside_damping(phi: Floats) -> tuple[Floats, Floats]:
    """Torques of a slow motion that its acceleration and its rate explain nearly alike, and their
    derivatives; the first coordinate is the logarithm of the inertia.
    """
    time = np.linspace(0.0, 2.0, 200)
    growing, exact = np.exp(0.5 * time), 0.02 * np.sin(7.0 * time)
    motion = np.column_stack([growing + exact, 2.0 * growing])
    inertia = np.exp(phi[0])
    residual = motion @ (np.array([inertia, phi[1]]) - np.array([2.0, 1.0]))
    return residual, motion * np.array([inertia, 1.0])


def test_an_inertia_and_the_damping_beside_it_trade_places_in_a_few_steps() -> None:
    """Linear in the values, as SciPy's bounded least squares finds it at once; in the logarithm of
    the inertia the valley bends, and steps that stay in it are short.
    """
    calls: list[bool] = []

    def evaluate(phi: Floats, z: object, tangents: bool) -> list[Evaluation]:
        calls.append(tangents)
        residual, slope = inertia_beside_damping(phi)
        return [evaluation(residual, slope, np.zeros((200, 0)))]

    far, none = np.full(2, 9.0), [np.zeros(0)]
    common = (evaluate, -far, far, none, none, none, np.zeros(2), np.zeros(2))
    begin = np.array([np.log(0.2), 1.9])
    bent = minimise(Problem(*common), begin, none, iterations=8)
    tried = len(calls)
    straight_on = minimise(
        Problem(*common, logarithmic=np.array([True, False])), begin, none, iterations=8
    )
    assert straight_on.phi == pytest.approx([np.log(2.0), 1.0], abs=1e-6)
    assert len(calls) - tried <= 9
    assert abs(bent.phi[0] - np.log(2.0)) > 0.1
