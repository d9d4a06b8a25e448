"""Intervals where tangents of a run have no bound."""

import numpy as np
import pytest

from ptp_symbolic.numeric.identify.coordinates import free_parameter
from ptp_symbolic.numeric.identify.intervals import chance_of_zero, estimates
from tests.identify.straight import finished


@pytest.mark.parametrize("lost", [np.nan, np.inf, 1e200])
def test_a_parameter_whose_derivatives_have_no_bound_is_not_identified(lost: float) -> None:
    """The other one keeps its interval: 1 +- 1.96 / (10 sqrt(400)) by its own column."""
    free = (free_parameter("a", 1.0, -10.0, 10.0), free_parameter("b", 1.0, -10.0, 10.0))
    rng, ones = np.random.default_rng(11), np.ones(200)
    slopes = [np.stack([lost * ones, -10.0 * free[1].scale * ones], axis=1)] * 2
    residuals = [r - r.mean() for r in (rng.standard_normal(200) for _ in range(2))]
    fit = finished(residuals, slopes, None, free, {"a": 1.0, "b": 1.0})
    a, b = estimates(fit)
    assert not a.identified and b.identified
    assert b.upper - b.lower == pytest.approx(2.0 * 1.96 / (10.0 * np.sqrt(400.0)), rel=0.5)
    assert chance_of_zero(fit, {"b": 0.0}) < 1e-3
    assert chance_of_zero(fit, {"a": 0.0}) > 0.05
