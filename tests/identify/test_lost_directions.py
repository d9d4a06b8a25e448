"""Parameters of which the data see a combination alone are not given an interval each."""

import numpy as np
import pytest

from ptp_symbolic.numeric.identify.coordinates import free_parameter
from ptp_symbolic.numeric.identify.fit import Fit
from ptp_symbolic.numeric.identify.intervals import estimates
from tests.identify.straight import finished

TIME = np.arange(0.0, 20.0, 0.01)


def straight_line(columns: dict[str, np.ndarray], noise: float, seed: int = 5) -> Fit:
    """A finished fit of y = sum of columns, every coefficient 2, with white noise."""
    free = tuple(free_parameter(name, 2.0, 0.0, 50.0) for name in columns)
    matrix = np.column_stack(list(columns.values()))
    residual = noise * np.random.default_rng(seed).standard_normal(len(TIME))
    return finished([residual], [-2.0 * matrix], None, free, dict.fromkeys(columns, 2.0))


def test_two_frictions_in_one_joint_are_known_as_a_sum_only() -> None:
    rate, angle = np.sin(TIME), np.cos(3.0 * TIME)
    found = {e.name: e for e in estimates(straight_line({"b": rate, "F_v": rate, "k": angle}, 0.1))}
    assert not found["b"].identified and not found["F_v"].identified
    assert found["b"].only_with == ("F_v",) and found["F_v"].only_with == ("b",)
    assert (found["b"].lower, found["b"].upper) == (0.0, 50.0)
    assert found["k"].identified and found["k"].only_with == ()


def test_what_the_data_hardly_see_may_be_lost_with_what_they_see_well() -> None:
    """Drag that fades far beyond the rates of the log: where it fades is not known either."""
    rate, fades = np.sin(TIME), 1e-3 * np.sin(3.0 * TIME)
    columns = {"c": rate - fades, "w0": 10.0 * fades, "b": rate, "k": np.cos(3.0 * TIME)}
    found = {e.name: e for e in estimates(straight_line(columns, 1e-4))}
    assert set(found["w0"].only_with) == {"b", "c"} and not found["w0"].identified
    assert (found["w0"].lower, found["w0"].upper) == (0.0, 50.0)
    assert found["k"].identified and found["k"].only_with == ()


def test_the_interval_of_what_is_seen_stays_that_of_the_textbook() -> None:
    """Of 20 draws the usual one: blocks of the residual may widen it, never narrow it."""
    angle = np.cos(3.0 * TIME)
    columns = {"b": np.sin(TIME), "k": angle, "idle": 0.0 * TIME}
    half_widths = []
    for seed in range(20):
        found = {e.name: e for e in estimates(straight_line(columns, 1.0, seed))}
        half_widths.append(0.5 * (found["k"].upper - found["k"].lower))
        assert not found["idle"].identified and found["idle"].only_with == ()
    textbook = 1.96 / np.linalg.norm(angle)
    assert min(half_widths) > 0.99 * textbook
    assert np.median(half_widths) == pytest.approx(textbook, rel=0.25)
