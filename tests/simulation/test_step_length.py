"""How long the next step is planned after one that was accepted, cut short, or refused."""

import numpy as np
import pytest

from ptp_symbolic.numeric.simulation.hybrid import accept
from ptp_symbolic.numeric.simulation.kernels.records import LENGTH


def plan_after(error: float, length: float, planned: float) -> tuple[bool, float]:
    clock = np.zeros(2)
    clock[LENGTH] = planned
    return bool(accept.py_func(error, length, clock)), float(clock[LENGTH])


def test_a_step_cut_short_leaves_a_longer_plan_alone() -> None:
    """A pulse edge after a microsecond in a motion that allows ten milliseconds."""
    assert plan_after(1e-12, 1e-6, 1e-2) == (True, 1e-2)


def test_a_short_step_that_allows_more_than_was_planned_lengthens_the_plan() -> None:
    assert plan_after(1e-12, 4e-3, 1e-2) == (True, pytest.approx(2e-2))


@pytest.mark.parametrize(("error", "factor"), [(1e-12, 5.0), (0.9**5, 1.0), (1.0, 0.9)])
def test_a_whole_step_is_followed_by_what_its_error_of_order_five_allows(
    error: float, factor: float
) -> None:
    assert plan_after(error, 1e-2, 1e-2) == (True, pytest.approx(factor * 1e-2))


@pytest.mark.parametrize(("error", "factor"), [(1e9, 0.2), (32.0, 0.45), (np.nan, 0.2)])
def test_a_refused_step_is_repeated_shorter(error: float, factor: float) -> None:
    assert plan_after(error, 1e-3, 1e-2) == (False, pytest.approx(factor * 1e-3))
