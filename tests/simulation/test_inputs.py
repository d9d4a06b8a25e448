"""Input signals against closed forms, at jumps from both sides, and packed for compiled code."""

import math
import re
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline
from scipy.signal import chirp

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.simulation.input_values import evaluate_inputs
from ptp_symbolic.numeric.simulation.inputs import (
    InputSignal,
    constant,
    cubic_transition,
    multisine,
    parse_profile,
    ramp,
    sine_sweep,
    stack,
    step,
    table,
    trapezoid,
)

TIMES = np.linspace(-1.0, 12.0, 1301)


def sample(
    signals: InputSignal | list[InputSignal], times: NDArray[np.float64], side: int = 1
) -> NDArray[np.float64]:
    """Values [n] of one signal, or [n, nu] of several, at times [n]."""
    several = isinstance(signals, list)
    packed = stack(signals if isinstance(signals, list) else [signals])
    cursor = packed.new_cursor()
    values = np.empty((len(times), len(cursor)))
    for row, t in zip(values, times, strict=True):
        evaluate_inputs(t, side, *packed.arrays, cursor, row)
    return values if several else values[:, 0]


def both_sides(signal: InputSignal, t: float) -> tuple[float, float]:
    at = np.array([t])
    return float(sample(signal, at, -1)[0]), float(sample(signal, at, +1)[0])


def test_constant_is_the_same_for_ever_and_never_stops_the_integrator() -> None:
    assert np.all(sample(constant(-3.5), TIMES) == -3.5)
    assert stack([constant(-3.5)]).stops.size == 0


def test_step_is_right_continuous_and_has_its_left_limit() -> None:
    signal = step(-1.0, 24.0, 0.5)
    assert both_sides(signal, 0.5) == (-1.0, 24.0)
    assert both_sides(signal, np.nextafter(0.5, 0.0)) == (-1.0, -1.0)
    assert both_sides(signal, 1e9) == (24.0, 24.0)
    assert stack([signal]).stops.tolist() == [0.5]


def test_ramp_of_the_thesis_falls_to_zero_at_its_end() -> None:
    signal = ramp(0.0, 24.0, 0.0, 10.0, then=0.0)
    expected = np.where((TIMES >= 0.0) & (TIMES < 10.0), 2.4 * TIMES, 0.0)
    np.testing.assert_allclose(sample(signal, TIMES), expected, atol=1e-12)
    assert both_sides(signal, 10.0) == pytest.approx((24.0, 0.0))
    assert both_sides(ramp(0.0, 24.0, 0.0, 10.0), 11.0) == (24.0, 24.0)
    assert stack([signal]).stops.tolist() == [0.0, 10.0]


def test_trapezoid_matches_linear_interpolation_of_its_corners() -> None:
    signal = trapezoid(24.0, 0.5, 2.5, 0.5, start=1.0)
    corners = [1.0, 1.5, 4.0, 4.5]
    expected = np.interp(TIMES, corners, [0.0, 24.0, 24.0, 0.0])
    np.testing.assert_allclose(sample(signal, TIMES), expected, atol=1e-12)
    assert stack([signal]).stops.tolist() == corners
    assert sample(signal, np.array([100.0]))[0] == 0.0


def test_trapezoid_without_flanks_is_a_pulse() -> None:
    signal = trapezoid(2.0, 0.0, 1.0, 0.0)
    assert both_sides(signal, 0.0) == (0.0, 2.0)
    assert both_sides(signal, 1.0) == (2.0, 0.0)


def test_cubic_transition_starts_and_ends_at_rest_half_way_in_the_middle() -> None:
    signal = cubic_transition(-2.0, 10.0, 2.0, 2.5)
    ends = np.array([1.0, 2.0, 2.25, 2.5, 9.0])
    np.testing.assert_allclose(sample(signal, ends), [-2.0, -2.0, 4.0, 10.0, 10.0], rtol=1e-14)
    step_size = 1e-6
    for t, slope in ((2.0, 0.0), (2.5, 0.0), (2.25, 1.5 * 12.0 / 0.5)):
        low, high = sample(signal, np.array([t - step_size, t + step_size]))
        assert (high - low) / (2 * step_size) == pytest.approx(slope, abs=1e-3)


def test_sine_sweep_matches_scipy_chirp_and_is_zero_outside() -> None:
    signal = sine_sweep(14.0, 0.1, 5.0, 1.0, 9.0)
    inside = TIMES[(TIMES > 1.0) & (TIMES < 9.0)]
    expected = 14.0 * chirp(inside - 1.0, 0.1, 8.0, 5.0, phi=-90.0)
    np.testing.assert_allclose(sample(signal, inside), expected, atol=1e-9)
    assert np.all(sample(signal, np.array([-1.0, 0.99, 9.01])) == 0.0)
    turns = 0.5 * (0.1 + 5.0) * 8.0
    assert both_sides(signal, 9.0) == pytest.approx((14.0 * math.sin(2 * math.pi * turns), 0.0))
    assert stack([signal]).stops.tolist() == [1.0, 9.0]


def test_multisine_is_the_sum_of_its_sines() -> None:
    expected = 2.0 * np.sin(2 * np.pi * 0.3 * TIMES + 0.5) - 3.0 * np.cos(2 * np.pi * 1.1 * TIMES)
    signal = multisine([2.0, 3.0], [0.3, 1.1], [0.5, -math.pi / 2])
    np.testing.assert_allclose(sample(signal, TIMES), expected, atol=1e-12)
    assert sample(multisine([2.0, 3.0], [0.3, 1.1]), np.array([0.0]))[0] == 0.0


def test_held_table_keeps_each_sample_until_the_next() -> None:
    signal = table([0.0, 0.005, 0.01], [1.0, 2.0, -4.0])
    assert both_sides(signal, 0.005) == (1.0, 2.0)
    assert both_sides(signal, 0.01) == (2.0, -4.0)
    assert both_sides(signal, -1.0) == (1.0, 1.0)
    assert both_sides(signal, 7.0) == (-4.0, -4.0)
    assert sample(table([3.0], [5.0]), np.array([0.0, 3.0, 9.0])).tolist() == [5.0, 5.0, 5.0]


def test_equal_neighbours_in_a_held_table_do_not_stop_the_integrator() -> None:
    packed = stack([table([0.0, 1.0, 2.0, 3.0], [7.0, 7.0, 8.0, 8.0]), step(0.0, 1.0, 2.0)])
    assert packed.stops.tolist() == [2.0]


def test_linear_and_cubic_tables_match_numpy_and_scipy() -> None:
    at = np.array([0.0, 0.7, 1.1, 4.0, 6.5])
    values = np.array([1.0, -2.0, 0.5, 3.0, 2.0])
    inside = np.linspace(0.0, 6.5, 200)
    np.testing.assert_allclose(
        sample(table(at, values, "linear"), TIMES), np.interp(TIMES, at, values), atol=1e-12
    )
    np.testing.assert_allclose(
        sample(table(at, values, "cubic"), inside), CubicSpline(at, values)(inside), atol=1e-12
    )
    assert sample(table(at, values, "cubic"), np.array([9.0]))[0] == 2.0


@given(
    times=st.lists(st.integers(-1000, 1000), min_size=1, max_size=40, unique=True).map(sorted),
    queries=st.lists(st.integers(-1100, 1100), min_size=1, max_size=40),
    seed=st.integers(0, 100),
    side=st.sampled_from([-1, 1]),
)
def test_cursor_finds_the_held_sample_in_any_order_of_queries(
    times: list[int], queries: list[int], seed: int, side: int
) -> None:
    values = np.random.default_rng(seed).normal(size=len(times))
    # half steps put the queries on the samples and between them
    asked = np.array(queries) / 2.0
    found = sample(table(np.array(times, float), values), asked, side)
    index = np.searchsorted(times, asked, "right" if side > 0 else "left") - 1
    assert np.all(found == values[np.maximum(index, 0)])


@given(
    start=st.floats(-1e3, 1e3),
    end=st.floats(-1e3, 1e3),
    t0=st.floats(-10, 10),
    length=st.floats(1e-3, 10),
)
def test_transitions_are_continuous_monotone_and_bounded(
    start: float, end: float, t0: float, length: float
) -> None:
    slack = 1e-11 * (abs(start) + abs(end) + 1.0)
    for profile in (ramp, cubic_transition):
        signal = profile(start, end, t0, t0 + length)
        for t in signal.breaks:
            left, right = both_sides(signal, t)
            assert abs(left - right) <= slack
        values = sample(signal, np.linspace(t0 - 1.0, t0 + length + 1.0, 50))
        assert np.all(np.diff(values) * np.sign(end - start) >= -slack)
        assert values[0] == start and values[-1] == end


def test_stacked_signals_keep_their_own_pieces() -> None:
    signals = [
        table(np.arange(50) * 0.2, np.sin(np.arange(50.0))),
        multisine([1.0], [0.5]),
        trapezoid(3.0, 1.0, 2.0, 1.0),
        sine_sweep(2.0, 0.0, 1.0, 0.0, 5.0),
    ]
    together = sample(signals, TIMES)
    for column, signal in zip(together.T, signals, strict=True):
        assert np.all(column == sample(signal, TIMES))
    assert np.all(np.diff(stack(signals).stops) > 0)
    assert stack([]).stops.size == 0


def test_cursor_makes_the_walk_through_a_long_log_cheap() -> None:
    """The cursor stands at the sample just found, so that the next call starts there."""
    packed = stack([table(np.arange(5000) * 0.005, np.arange(5000.0))])
    cursor, u = packed.new_cursor(), np.empty(1)
    for k in (0, 1, 2, 4000, 4001, 3999):
        evaluate_inputs(k * 0.005 + 0.001, 1, *packed.arrays, cursor, u)
        assert cursor[0] == k and u[0] == k


def test_signals_cannot_be_changed_afterwards() -> None:
    signal = constant(1.0)
    with pytest.raises(ValueError, match="read-only"):
        signal.coefficients[0, 0] = 2.0


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: constant(math.nan), "NaN or infinity"),
        (lambda: ramp(0.0, 1.0, 2.0, 2.0), "from 2 s to 2 s; give strictly increasing"),
        (lambda: trapezoid(1.0, -0.5, 1.0, 1.0), "rise lasts -0.5 s"),
        (lambda: table([0.0, 0.0], [1.0, 2.0]), "times of the table go from 0 s to 0 s"),
        (lambda: table([0.0, 1.0], [1.0]), "give as many of each"),
        (lambda: table([0.0, 1.0], [1.0, 2.0], "quintic"), "choose hold, linear or cubic"),
        (lambda: table([0.0, 1.0], [1.0, math.inf], "cubic"), "NaN or infinity"),
        (lambda: multisine([1.0], [1.0, 2.0]), "1 amplitudes, 2 frequencies"),
        (lambda: sine_sweep(1.0, -1.0, 2.0, 0.0, 1.0), "frequencies of zero or more"),
        (lambda: sine_sweep(1.0, 1.0, 2.0, 1.0, 0.0), "ends before it starts"),
        (lambda: InputSignal(np.zeros(2), np.zeros((2, 4))), "one break more"),
        (lambda: InputSignal(np.arange(2.0), np.zeros((1, 3))), "coefficients has shape"),
    ],
)
def test_signals_that_make_no_sense_are_refused(
    make: Callable[[], InputSignal], message: str
) -> None:
    with pytest.raises(InputError, match=message):
        make()


@pytest.mark.parametrize(
    ("text", "signal"),
    [
        ("constant:3", constant(3.0)),
        ("constant:-2.5e-1", constant(-0.25)),
        ("step:24@0.5", step(0.0, 24.0, 0.5)),
        ("step:-3..24@0.5", step(-3.0, 24.0, 0.5)),
        ("ramp:0..24@0..10", ramp(0.0, 24.0, 0.0, 10.0)),
        ("ramp:0..-24@.5..10,0", ramp(0.0, -24.0, 0.5, 10.0, 0.0)),
        ("trapezoid:24,0.5,2.5,0.5", trapezoid(24.0, 0.5, 2.5, 0.5)),
        ("trapezoid:24,0.5,2.5,0.5@1", trapezoid(24.0, 0.5, 2.5, 0.5, 1.0)),
        ("cubic:0..10@0..0.5", cubic_transition(0.0, 10.0, 0.0, 0.5)),
        ("sweep:14@0.1..5", sine_sweep(14.0, 0.1, 5.0, 0.0, 20.0)),
        ("multisine:12@0.3,0.7,1.1", multisine([12.0] * 3, [0.3, 0.7, 1.1])),
        (" multisine:12@0.3 ", multisine([12.0], [0.3])),
    ],
)
def test_typed_profiles_are_the_profiles_they_name(text: str, signal: InputSignal) -> None:
    assert np.all(sample(parse_profile(text, 20.0), TIMES) == sample(signal, TIMES))


@pytest.mark.parametrize(
    "text",
    [
        "",
        "24",
        "step",
        "step:",
        "step:24",
        "step:24@0.5@1",
        "square:3",
        "constant:nan",
        "constant:1e999",
        "constant:1_000",
        "constant:٣",
        "ramp:0..24@10..0",
        "constant:3;x",
        "trapezoid:24,-1,2,1",
        "sweep:14@-1..5",
        "multisine:12@",
        "__import__('os'):1",
        "cubic:0..10@0..1e-320",
        "constant:" + "9" * 5000,
    ],
)
def test_any_other_text_is_refused_in_one_line_with_the_forms(text: str) -> None:
    with pytest.raises(InputError, match=re.escape("multisine:12@0.3,0.7,1.1")) as refused:
        parse_profile(text, 20.0)
    assert "\n" not in str(refused.value)
    assert "constant:3" in str(refused.value) and len(str(refused.value)) < 700
