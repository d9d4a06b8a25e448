"""The joint confidence region: how often it holds the truth, and what lies closest in it."""

import numpy as np
import pytest
from scipy import optimize

from ptp_symbolic.numeric.identify.coordinates import free_parameter
from ptp_symbolic.numeric.identify.intervals import closest_in_ball, joint_region
from tests.identify.straight import finished


def test_within_reach_the_closest_is_that_of_least_squares() -> None:
    matrix = np.array([[2.0, 0.0], [0.0, 4.0], [0.0, 0.0]])
    assert closest_in_ball(matrix, np.array([1.0, 2.0, 9.0])) == pytest.approx([0.5, 0.5])


def test_out_of_reach_the_closest_lies_on_the_ball() -> None:
    """On a circle of radius one (equal columns) it points at the target."""
    target = np.array([3.0, 4.0])
    assert closest_in_ball(np.eye(2), target) == pytest.approx([0.6, 0.8])


def test_it_is_where_a_constrained_minimiser_ends() -> None:
    rng = np.random.default_rng(5)
    matrix, target = rng.standard_normal((30, 3)) * [0.1, 1.0, 10.0], rng.standard_normal(30) * 9.0
    found = closest_in_ball(matrix, target)
    other = optimize.minimize(
        lambda x: float(np.sum((matrix @ x - target) ** 2)),
        np.zeros(3),
        constraints={"type": "ineq", "fun": lambda x: 1.0 - x @ x},
        method="SLSQP",
        options={"ftol": 1e-14, "maxiter": 500},
    )
    assert np.linalg.norm(found) == pytest.approx(1.0)
    assert found == pytest.approx(other.x, abs=1e-5)


def test_columns_of_any_size_do_not_leave_the_ball() -> None:
    rng = np.random.default_rng(3)
    for _ in range(300):
        matrix = rng.standard_normal((12, 4)) * 10.0 ** rng.uniform(-9.0, 9.0, 4)
        target = rng.standard_normal(12) * 10.0 ** rng.uniform(-9.0, 9.0)
        found = closest_in_ball(matrix, target)
        assert np.linalg.norm(found) <= 1.0 + 1e-9


def test_a_direction_that_changes_nothing_stays() -> None:
    matrix = np.array([[1.0, 0.0], [1.0, 0.0]])
    assert closest_in_ball(matrix, np.array([0.5, 0.5])) == pytest.approx([0.5, 0.0])
    assert closest_in_ball(np.zeros((2, 1)), np.ones(2)) == pytest.approx([0.0])


@pytest.mark.parametrize(
    ("runs", "samples", "count"),
    [(30, 80, 3), (3, 800, 3), pytest.param(3, 800, 8, marks=pytest.mark.long), (3, 800, 13)],
)
def test_the_region_holds_the_truth_as_often_as_it_says(
    runs: int, samples: int, count: int
) -> None:
    """White noise of known size. In three long runs twelve blocks tell the spread of up to thirteen
    values, of which two change nearly the same. The region is no wider than it must be: it seldom
    holds what is three times as far off.
    """
    rng = np.random.default_rng(11)
    free = tuple(free_parameter(f"p{k}", 1.0, -1e3, 1e3) for k in range(count))
    mixing = np.diag(np.geomspace(0.2, 5.0, count))
    mixing[0, 1] = 0.2  # the second is nearly the first
    mixing[1, 1] = 0.01
    held, far, draws = 0, 0, 100
    for _ in range(draws):
        tables = [rng.standard_normal((samples, count)) @ mixing for _ in range(runs)]
        noise = [rng.standard_normal(samples) for _ in tables]
        found = np.linalg.lstsq(np.vstack(tables), np.concatenate(noise))[0]
        left = [n - t @ found for n, t in zip(noise, tables, strict=True)]
        values = {f.name: float(v) for f, v in zip(free, found, strict=True)}
        region = joint_region(finished(left, [-t for t in tables], None, free, values))
        away = float(np.linalg.norm(np.linalg.solve(region, found)))
        held += away <= 1.0
        far += 3.0 * away <= 1.0
    assert held >= 0.96 * draws
    assert far <= 0.7 * draws
