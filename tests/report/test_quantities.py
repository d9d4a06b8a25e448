"""How numbers, intervals and units are written in a report."""

import math
from typing import Any

import pytest

from ptp_symbolic.report.quantities import estimate, gain, in_degrees, interval, number, unit


def _quantity(value: float, half: float, unit: str) -> dict[str, Any]:
    return {"value": value, "ci95": [value - half, value + half], "unit": unit}


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (29.8123, "29.8"),
        (0.28912, "0.289"),
        (1.2e-12, "1.20 × 10⁻¹²"),
        (-3.0, "−3.00"),
        (123456.0, "123456"),
        (0.99999, "1.00"),
        (0.0, "0"),
        (None, "–"),
        (math.inf, "–"),
    ],
)
def test_numbers_have_three_digits(value: float | None, text: str) -> None:
    assert number(value) == text


def test_intervals_set_the_digits_of_their_value() -> None:
    assert estimate(_quantity(0.087266, 0.00032, "rad")) == "0.08727"
    assert interval(_quantity(0.087266, 0.00032, "rad")) == "0.08695 to 0.08759"
    assert interval(_quantity(13.42, 2.6, "N m")) == "10.8 to 16.0"
    assert interval({"value": 1.0, "ci95": [None, 2.0]}) == "–"
    assert in_degrees(_quantity(math.radians(5.0), 0.001, "rad")) == "5.00°"
    assert in_degrees(_quantity(5.0, 0.1, "N m")) == ""
    assert unit("N m/rad^3") == "N m/rad³"


@pytest.mark.parametrize(
    ("share", "bounds", "text"),
    [
        (0.9873, [0.9851, 0.9894], "98.7 % (98.5 to 98.9 %)"),
        (-0.012, [-0.05, 0.021], "−1.2 % (−5.0 to 2.1 %)"),
        (0.5, None, "50.0 %"),
        (-1e-10, None, "0.0 %"),
        (-2.5e4, [None, 0.1], "−2.50 × 10⁶ %"),
        (math.nan, [0.0, 1.0], "–"),
    ],
)
def test_gains_are_written_in_tenths_of_a_percent(share: float, bounds: Any, text: str) -> None:
    assert gain({"share": share, "ci95": bounds}) == text.replace(" %", "\u00a0%")


def test_no_gain_is_a_dash() -> None:
    assert gain(None) == "–"
