"""Where a delay begins, on the rows of a current and of a torque in closed form.

A winding settles within a sample: the current that is sampled at a time is the one that the voltage
asked for then, a delay ago. A torque follows a smooth input, and its rows a small delay.
"""

from collections.abc import Callable, Mapping
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from ptp_symbolic.numeric.diagnose.candidates import Candidate
from ptp_symbolic.numeric.diagnose.proposals import at_best_delays
from ptp_symbolic.numeric.diagnose.signatures import _signature
from ptp_symbolic.numeric.identify.coordinates import free_parameter

PERIOD = 0.01  # s
TIME = np.arange(0.0, 20.0, PERIOD)
WEIGHT = np.ones(len(TIME))
LATE = Candidate(
    "input_delay",
    "pan",
    "delay of the input",
    "",
    (free_parameter("t_delay_pan", 0.002, 0.0, 1.0),),
    {"t_delay_pan": 0.0},
)
SPRING = Candidate(
    "cable_spring", "pan", "", "", (free_parameter("k1", 1.0, 0.0, 10.0),), {"k1": 0.0}
)
Signal = Callable[[NDArray[np.float64]], NDArray[np.float64]]


def staircase(time: NDArray[np.float64]) -> NDArray[np.float64]:
    """Held for 0.7 s each, one step after the other of another size."""
    levels = np.random.default_rng(1).uniform(-1.0, 1.0, 40)
    levels[0] = 0.0
    return np.asarray(levels[np.clip(time / 0.7, 0, 39).astype(int)])


def held(time: NDArray[np.float64]) -> NDArray[np.float64]:
    """The staircase as a sampled command holds it: it changes at samples only."""
    return staircase(np.floor(time / PERIOD + 1e-6) * PERIOD)


def smooth(time: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.asarray(np.sin(2.0 * np.pi * 1.3 * time) + 0.4 * np.sin(2.0 * np.pi * 3.1 * time))


def begun(
    signal: Signal, truth: float, windows: float = 0.22, candidates: tuple[Candidate, ...] = (LATE,)
) -> tuple[Candidate, ...]:
    """Candidates begun by rows of `signal`, which arrives late by `truth` s."""
    space: Any = SimpleNamespace(
        model=SimpleNamespace(
            parameter_names=("k1", "t_delay_pan"), input_delays=np.array([-1, 1])
        ),
        runs=(SimpleNamespace(time=TIME),),
        half_width=windows,
    )

    def rows(changed: Mapping[str, float]) -> NDArray[np.float64]:
        return signal(TIME - truth) - signal(TIME - changed.get("t_delay_pan", 0.0))

    return at_best_delays(space, candidates, rows, WEIGHT)


@pytest.mark.parametrize("truth", [0.01, 0.03, 0.07, 0.15, 0.21])
def test_a_delay_begins_at_its_number_of_samples_where_the_rows_are_stairs(truth: float) -> None:
    (late,) = begun(held, truth + 0.4 * PERIOD)
    (f,) = late.free
    # The first sample that sees a command which came 0.4 samples late is the next one.
    assert f.start == pytest.approx(truth + PERIOD, abs=1e-9)
    assert f.scale == f.start
    assert late.whole_only == {"t_delay_pan"}


def test_a_small_delay_of_a_smooth_input_is_left_to_its_tangent() -> None:
    (late,) = begun(smooth, 0.1 * PERIOD)
    assert late is LATE


def test_a_large_delay_of_a_smooth_input_is_found_too() -> None:
    (late,) = begun(smooth, 0.083)
    assert late.free[0].start == pytest.approx(0.08, abs=1e-9)


@pytest.mark.parametrize("signal", [held, smooth])
def test_without_a_delay_none_is_begun(signal: Signal) -> None:
    assert begun(signal, 0.0) == (LATE,)


def test_a_delay_stays_within_the_windows() -> None:
    (late,) = begun(held, 0.15, windows=0.1)
    assert late.whole_only == {"t_delay_pan"}
    assert 0.05 < late.free[0].start <= 0.1 + 1e-9


def test_a_declared_delay_that_may_be_wrong_begins_where_it_is_declared() -> None:
    declared = replace(
        LATE,
        id="declared_value:t_delay_pan",
        free=(free_parameter("t_delay_pan", 0.02, 0.01, 0.04),),
        vanishing={"t_delay_pan": 0.02},
    )
    assert begun(held, 0.05, candidates=(declared,)) == (declared,)


def test_a_delay_at_its_whole_amount_is_its_signature() -> None:
    """Of the rows before and after the delay, not of a difference quotient at zero."""
    rows, change = np.array([1.0, 2.0, 4.0]), np.array([0.0, 3.0, 1.0])
    found = _signature(
        replace(LATE, whole_only=frozenset({"t_delay_pan"})),
        {},
        lambda changed: rows + change * (changed.get("t_delay_pan", 0.0) >= 0.002),
        np.ones(3),
    )
    assert found.finite == {"t_delay_pan"}
    assert np.allclose(found.slopes[0][0], change / 0.002)


def test_other_candidates_are_left_alone() -> None:
    spring, _ = begun(held, 0.05, candidates=(SPRING, LATE))
    assert spring is SPRING
