"""Angles between what effects change in the residuals: closed forms, and SciPy's angles."""

import numpy as np
import pytest
from scipy.linalg import null_space, orth, subspace_angles

from ptp_symbolic.numeric.diagnose.linear import canonical_correlation, projected_off

RNG = np.random.default_rng(31)
COLUMNS = RNG.normal(size=(200, 3))
AWAY = RNG.normal(size=(200, 4)) * [1.0, 1e-6, 1e6, 0.0]  # units differ, and one does nothing


def test_what_lies_outside_is_the_remainder_of_a_least_squares_fit() -> None:
    used = AWAY[:, :3] * [1.0, 1e6, 1e-6]
    expected = COLUMNS - used @ np.linalg.lstsq(used, COLUMNS)[0]
    assert projected_off(COLUMNS, AWAY) == pytest.approx(expected, abs=1e-12)


@pytest.mark.parametrize("apart", [1e-2, 1e-5, 1e-7, 1e-9, 1e-12, 0.0])
def test_nothing_of_nearly_equal_columns_is_left(apart: float) -> None:
    """Directions less than 1e-8 of the largest apart count as one; no more than that is left."""
    away = np.column_stack([AWAY[:, 0], 1e3 * (AWAY[:, 0] + apart * RNG.normal(size=200))])
    unit = away / np.linalg.norm(away, axis=0)
    left = projected_off(COLUMNS, away)
    assert np.max(np.abs(unit.T @ left)) < 1e-8 * np.linalg.norm(COLUMNS)
    assert np.linalg.norm(left) > 0.98 * np.linalg.norm(COLUMNS)


def test_a_column_that_is_there_twice_counts_once() -> None:
    """What tells a copy from its original is rounding, which is no direction."""
    once, twice = AWAY[:, :2], AWAY[:, [0, 1, 0, 0, 1]] * [1.0, 1.0, 1 / 3, -7.0, 0.1]
    assert projected_off(COLUMNS, twice) == pytest.approx(projected_off(COLUMNS, once), abs=1e-10)
    expected = canonical_correlation(COLUMNS[:, 0], once)
    assert canonical_correlation(COLUMNS[:, 0], twice) == pytest.approx(expected, rel=1e-10)


def test_what_is_outside_stays_so_and_nothing_takes_nothing_away() -> None:
    left = projected_off(COLUMNS, AWAY)
    assert projected_off(left, AWAY) == pytest.approx(left, abs=1e-12)
    assert projected_off(COLUMNS, 0.0 * AWAY) == pytest.approx(COLUMNS)
    assert projected_off(COLUMNS, AWAY[:, :0]) == pytest.approx(COLUMNS)
    assert projected_off(AWAY[:, :2] @ [[1.0], [1e6]], AWAY) == pytest.approx(0.0, abs=1e-12)


def test_the_cosine_between_a_vector_and_a_plane() -> None:
    """30 degrees above the plane of x and y, which two oblique columns span."""
    target = np.array([np.cos(0.7), np.sin(0.7), np.tan(np.pi / 6)])
    plane = np.array([[1.0, 1.0], [0.0, 1e-3], [0.0, 0.0]])
    assert canonical_correlation(target, plane) == pytest.approx(np.sqrt(3.0) / 2.0, rel=1e-12)


def test_correlations_are_the_cosines_of_scipys_angles() -> None:
    for target in RNG.normal(size=(5, 200)):
        (angle,) = subspace_angles(target[:, None], COLUMNS)
        assert canonical_correlation(target, COLUMNS) == pytest.approx(np.cos(angle), rel=1e-10)


def test_a_vector_in_the_span_has_correlation_one_and_one_across_it_none() -> None:
    inside = COLUMNS @ [3.0, -0.2, 1e-3]
    across = null_space(COLUMNS.T)[:, 0]
    assert canonical_correlation(inside, COLUMNS) == pytest.approx(1.0, abs=1e-12)
    assert canonical_correlation(across, COLUMNS) == pytest.approx(0.0, abs=1e-12)


def test_units_of_the_columns_and_of_the_target_do_not_matter() -> None:
    target = COLUMNS @ [1.0, 2.0, 3.0] + 5.0 * RNG.normal(size=200)
    basis = orth(COLUMNS)
    expected = np.linalg.norm(basis.T @ target) / np.linalg.norm(target)
    for units in ([1.0, 1.0, 1.0], [1e-9, 1.0, -1e9], [1e-4, 1e-4, 1e-4]):
        assert canonical_correlation(target, COLUMNS * units) == pytest.approx(expected, rel=1e-9)
    assert canonical_correlation(-1e-7 * target, COLUMNS) == pytest.approx(expected, rel=1e-9)


def test_where_there_is_nothing_there_is_no_correlation() -> None:
    assert canonical_correlation(np.zeros(200), COLUMNS) == 0.0
    assert canonical_correlation(COLUMNS[:, 0], np.zeros((200, 2))) == 0.0
