"""The joint confidence region: how often it holds the truth, and what lies closest in it."""

import numpy as np
import pytest
from scipy import optimize

from ptp_symbolic.numeric.identify.coordinates import free_parameter
from ptp_symbolic.numeric.identify.joint_region import closest_in_ball, joint_region
from tests.identify.straight import finished

NAMES = ("p0", "p1", "p2")


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


def test_a_direction_that_changes_nothing_stays() -> None:
    matrix = np.array([[1.0, 0.0], [1.0, 0.0]])
    assert closest_in_ball(matrix, np.array([0.5, 0.5])) == pytest.approx([0.5, 0.0])
    assert closest_in_ball(np.zeros((2, 1)), np.ones(2)) == pytest.approx([0.0])


def test_the_region_holds_the_truth_as_often_as_it_says() -> None:
    """White noise of known size, 30 runs: 99 % with the chi squared of three values."""
    rng = np.random.default_rng(11)
    free = tuple(free_parameter(name, 0.0, -1e3, 1e3) for name in NAMES)
    scales = np.array([f.scale for f in free])
    held, draws = 0, 400
    for _ in range(draws):
        tables = [rng.standard_normal((80, 3)) @ np.diag([1.0, 0.2, 5.0]) for _ in range(30)]
        noise = [rng.standard_normal(80) for _ in tables]
        found = np.linalg.lstsq(np.vstack(tables), np.concatenate(noise))[0]
        values = {name: float(v) for name, v in zip(NAMES, found, strict=True)}
        fit = finished(
            [n - t @ found for n, t in zip(noise, tables, strict=True)],
            [-t * scales for t in tables],
            None,
            free,
            values,
        )
        inside = np.linalg.solve(joint_region(fit), found / scales)
        held += float(np.linalg.norm(inside)) <= 1.0
    assert held / draws == pytest.approx(0.99, abs=0.015)
