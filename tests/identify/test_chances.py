"""How likely values are found as far from zero as they are, told alone, together, or not."""

import numpy as np
import pytest
from scipy import stats

from ptp_symbolic.numeric.diagnose.fitted_model import FittedModel
from ptp_symbolic.numeric.diagnose.gain import p_value
from ptp_symbolic.numeric.identify.coordinates import free_parameter
from ptp_symbolic.numeric.identify.intervals import chance_of, chance_of_zero
from tests.identify.straight import finished


def test_a_coordinate_that_is_clear_by_itself_is_clear_beside_one_that_a_block_tells() -> None:
    """A hundred deviations with eleven degrees of freedom, beside one told by a single block; two
    that trade for each other, each unclear, whose sum is certain; and nothing.
    """
    one, few = np.eye(2), np.array([11.0, 1.5])
    assert chance_of(np.array([100.0, 0.0]), one, few) < 1e-10
    trading = np.array([[1.0, -0.999], [-0.999, 1.0]])
    assert chance_of(np.array([1.0, 1.0]), trading, np.full(2, 30.0)) < 1e-6
    assert chance_of(np.array([1.0, 1.0]), one, np.full(2, 30.0)) > 0.3
    rng = np.random.default_rng(4)
    drawn = [chance_of(rng.standard_normal(3), np.eye(3), np.full(3, np.inf)) for _ in range(2000)]
    assert 0.02 < np.mean(np.array(drawn) < 0.05) <= 0.06
    assert chance_of(np.array([2.0]), np.eye(1), np.array([9.0])) == pytest.approx(
        2.0 * stats.t.sf(2.0, 9.0)
    )


def test_a_coordinate_that_nothing_tells_has_no_error_and_is_not_clear() -> None:
    """Alone, it may be zero; beside one that is told, that alone counts; and of two that only their
    sum tells, neither is clear by itself.
    """
    one, two = np.array([9.0]), np.full(2, 30.0)
    assert chance_of(np.array([0.4]), np.zeros((1, 1)), one) == 1.0
    beside = chance_of(np.array([2.0, 0.4]), np.diag([1.0, 0.0]), two)
    assert beside == pytest.approx(2.0 * stats.t.sf(2.0, 30.0))
    sum_alone = 0.25 * np.ones((2, 2)) * 0.01  # of a sum that is known to 0.1
    opposite = np.array([5.0, -5.0])
    neither = np.zeros(2, dtype=np.bool_)
    assert chance_of(opposite, sum_alone, two, neither) > 0.9
    assert chance_of(np.array([5.0, 5.0]), sum_alone, two, neither) < 1e-6


def test_a_parameter_without_influence_cannot_be_told_from_zero() -> None:
    free = free_parameter("k", 1.0, -5.0, 5.0)
    noise = np.random.default_rng(3).standard_normal(600)
    blind = finished([noise], [np.zeros((600, 1))], None, (free,), {"k": 0.4})
    assert chance_of_zero(blind, {"k": 0.0}) == 1.0
    assert p_value(FittedModel((), blind), {"k": 0.0}) == 1.0
