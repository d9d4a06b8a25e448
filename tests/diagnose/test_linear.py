"""Angles between what effects change in the residuals: closed forms, and SciPy's angles."""

import numpy as np
import pytest
from scipy.linalg import null_space, orth, subspace_angles

from ptp_symbolic.numeric.diagnose.responses import (
    canonical_correlation,
    compensated,
    projected_off,
)
from ptp_symbolic.numeric.identify.coordinates import free_parameter
from tests.identify.straight import finished

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


INERTIA, OFFSET = free_parameter("J", 0.02, 1e-3, 0.5), free_parameter("d", 0.1, -0.5, 0.5)
DAMPING, TWIN = free_parameter("b", 0.3, 0.0, 9.0), free_parameter("b2", 0.6, 0.0, 9.0)
SWINGING, SLIDING = np.linalg.qr(RNG.normal(size=(200, 2)))[0].T * 40.0
MASS = 5.0


def a_moved_mass(offset: float, twin: float = 0.0):
    """A fit of an inertia with a mass at some offset, which adds m d^2 to it, and of a damping;
    with a `twin` that does as much of what that does per unit.
    """
    by_value = np.column_stack([SWINGING, 2.0 * MASS * offset * SWINGING, SLIDING, twin * SLIDING])
    units = [0.02, OFFSET.scale, DAMPING.scale, TWIN.scale]
    values = {"J": 0.02, "d": offset, "b": 0.3, "b2": 0.6}
    free = (INERTIA, OFFSET, DAMPING, TWIN)
    slopes = by_value * units
    return finished([RNG.normal(size=200)], [slopes], None, free, values), slopes


def test_an_inertia_makes_up_for_a_mass_that_is_put_back() -> None:
    """By the slope 2 m d, in kg m^2, and not by a power of e; the damping stays."""
    fit, table = a_moved_mass(0.2)
    found = compensated(fit, {"d": 0.05}, ["J", "b", "b2"], table)
    assert found["J"] == pytest.approx(0.02 + 2.0 * MASS * 0.2 * 0.15)
    assert found["d"] == 0.05
    assert (found["b"], found["b2"]) == pytest.approx((0.3, 0.6))


def test_nothing_makes_up_for_an_effect_beyond_its_bounds_or_where_all_is_held() -> None:
    fit, table = a_moved_mass(0.5)
    assert compensated(fit, {"d": -0.5}, ["J", "b", "b2"], table)["J"] == INERTIA.upper
    assert compensated(fit, {"d": -0.5}, ["b", "b2"], table)["J"] == 0.02
    assert compensated(fit, {"d": -0.5}, [], table) == {"J": 0.02, "d": -0.5, "b": 0.3, "b2": 0.6}


def test_what_the_logs_do_not_tell_apart_moves_together() -> None:
    """An offset put back adds to an inertia, and here to its twin too: they share it, each by what
    it does per search coordinate, 0.02 and 0.04.
    """
    fit, table = a_moved_mass(0.2)
    table[:, 3] = 2.0 * table[:, 0]
    found = compensated(fit, {"d": 0.05}, ["J", "b2"], table)
    whole = 2.0 * MASS * 0.2 * 0.15
    assert found["J"] - 0.02 == pytest.approx(whole / 2.0)
    assert 0.04 * (found["b2"] - 0.6) / TWIN.scale == pytest.approx(whole / 2.0)


def test_a_twin_takes_over_whole() -> None:
    fit, table = a_moved_mass(0.2, twin=0.5)
    found = compensated(fit, {"b": 0.0}, ["J", "d", "b2"], table)
    assert found["b2"] == pytest.approx(0.6 + 0.3 / 0.5)
