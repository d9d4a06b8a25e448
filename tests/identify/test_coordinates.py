"""Coordinates of a search: there and back, slopes against differences, angles that wrap."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ptp_symbolic.numeric.identify.coordinates import (
    FreeParameter,
    free_parameter,
    limits,
    slopes,
    to_search,
    to_values,
    wrapped,
)

SIZES = st.floats(1e-6, 1e6)
SIGNED = st.one_of(st.just(0.0), SIZES, SIZES.map(lambda size: -size))


@st.composite
def parameters(draw: st.DrawFn) -> tuple[FreeParameter, float]:
    """A free parameter above zero, from zero on or of either sign, and a value it may take."""
    smallest = draw(st.sampled_from([1e-6, 0.0, None]))
    if smallest is not None:
        start = draw(SIZES)
        free = free_parameter("J", start, smallest * start, 1e3 * start)
        return free, start * draw(st.floats(smallest, 1e3))
    start, value = draw(SIGNED), draw(SIGNED)
    reach = 2.0 * max(abs(start), abs(value), 1.0)
    return free_parameter("J", start, -reach, reach), value


@given(parameters())
def test_there_and_back_is_the_same_value(pair: tuple[FreeParameter, float]) -> None:
    free, value = pair
    back = to_values([free], to_search([free], {"J": value}))["J"]
    assert back == pytest.approx(value, rel=1e-13)


@given(parameters())
def test_slopes_are_what_differences_give(pair: tuple[FreeParameter, float]) -> None:
    """At a bound, where values end, beside it: the difference reaches h to either side."""
    free, value = pair
    (low, high), h = limits([free]), 1e-6
    phi = np.clip(to_search([free], {"J": value}), low + h, high - h)
    above, below = (to_values([free], phi + step)["J"] for step in (h, -h))
    size = max(abs(value), free.scale)
    assert slopes([free], phi)[0] == pytest.approx((above - below) / (2 * h), abs=1e-8 * size)


@given(parameters())
def test_every_allowed_value_lies_within_the_limits(pair: tuple[FreeParameter, float]) -> None:
    free, value = pair
    (low,), (high,) = limits([free])
    (phi,) = to_search([free], {"J": value})
    assert low - 1e-12 <= phi <= high + 1e-12
    assert to_values([free], np.array([high]))["J"] == pytest.approx(free.upper, rel=1e-12)
    assert to_values([free], np.array([low]))["J"] == pytest.approx(free.lower, rel=1e-12)


@pytest.mark.parametrize(
    ("start", "lower", "upper", "logarithmic", "scale"),
    [
        (0.05, 0.0, 1.0, False, 0.05),
        (0.05, 0.01, 1.0, True, 0.05),
        (0.05, -1.0, 1.0, False, 0.05),
        (-0.4, -1.0, 1.0, False, 0.4),
        (0.0, 0.0, 50.0, False, 1.0),
        (0.0, -0.2, 0.2, False, 0.04),
    ],
)
def test_choice_of_the_coordinate(
    start: float, lower: float, upper: float, logarithmic: bool, scale: float
) -> None:
    free = free_parameter("a", start, lower, upper)
    assert free.logarithmic is logarithmic
    assert free.scale == pytest.approx(scale, rel=1e-12)


def test_several_parameters_side_by_side_by_hand() -> None:
    free = (free_parameter("J", 0.05, 0.01, 1.0), free_parameter("tau0", -0.4, -2.0, 2.0))
    phi = to_search(free, {"J": 0.1, "tau0": 0.6})
    assert phi == pytest.approx([math.log(2.0), 1.5])
    assert slopes(free, phi) == pytest.approx([0.1, 0.4])
    low, high = limits(free)
    assert low == pytest.approx([math.log(0.2), -5.0])
    assert high == pytest.approx([math.log(20.0), 5.0])


def test_zero_is_reached_where_it_is_a_bound() -> None:
    free = free_parameter("F_s", 0.5, 0.0, 30.0)
    assert to_search([free], {"F_s": 0.0})[0] == limits([free])[0][0] == 0.0
    assert to_values([free], np.zeros(1))["F_s"] == 0.0
    assert slopes([free], np.zeros(1))[0] == 0.5


def test_next_to_zero_is_a_millionth_of_the_start_where_logarithms_are_used() -> None:
    free = free_parameter("J", 0.5, 1e-12, 30.0)
    assert to_search([free], {"J": 1e-12})[0] == pytest.approx(math.log(1e-6))
    assert limits([free])[0][0] == pytest.approx(math.log(1e-6))


@given(st.floats(-1e3, 1e3), st.sampled_from([1.0, 2 * math.pi, 360.0]))
def test_a_wrapped_value_is_the_same_angle_in_the_middle_turn(value: float, period: float) -> None:
    free = replace(free_parameter("alpha", 0.1, -100.0, 100.0), period=period)
    found = wrapped(free, value)
    assert -period / 2 - 1e-9 <= found <= period / 2 + 1e-9
    turns = (value - found) / period
    assert turns == pytest.approx(round(turns), abs=1e-9)


def test_wrapping_by_hand_and_only_where_there_is_a_period() -> None:
    free = free_parameter("alpha", 0.1, -10.0, 10.0)
    assert wrapped(free, 7.0) == 7.0
    turning = replace(free, period=2.0)
    expected = {0.3: 0.3, 1.0: 1.0, -1.0: 1.0, 1.25: -0.75, 7.0: 1.0, -2.5: -0.5}
    assert {v: wrapped(turning, v) for v in expected} == pytest.approx(expected)
