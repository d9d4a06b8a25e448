"""Jumps of an encoder: told from a motion, from impacts and from breakaways."""

import numpy as np
import pytest

from ptp_symbolic.numeric.data.latency import jumps, parted, pauses, unwrapped
from ptp_symbolic.platform import SignalDeclaration

PERIOD = 0.01
TIME = PERIOD * np.arange(800)
COUNT = 2.0 * np.pi / 65536
WAVE = np.sin(2.0 * TIME)


def rounded(angle: np.ndarray) -> np.ndarray:
    return np.rint(angle / COUNT) * COUNT


@pytest.mark.parametrize("degrees", [7.0, -7.0, 90.0])
@pytest.mark.parametrize("at", [300, 471])
def test_an_encoder_that_is_set_anew_jumps_in_motion_too(degrees: float, at: int) -> None:
    """At 2 rad/s a sample is a degree apart from the next; at 471 the motion turns back."""
    jumped = rounded(WAVE + np.where(np.arange(800) >= at, np.radians(degrees), 0.0))
    assert list(jumps(jumped, TIME, COUNT)) == [at]


def test_a_single_wrong_sample_is_left_out() -> None:
    wrong = rounded(WAVE)
    wrong[300] += 0.7
    found = jumps(wrong, TIME, COUNT)
    assert list(found) == [300, 301]
    assert parted(TIME, found) == [slice(0, 300), slice(301, 800)]


def slipping() -> np.ndarray:
    """Rest, and a slip of 3 degrees within a sample every second."""
    return np.radians(3.0) * np.floor(TIME)


@pytest.mark.parametrize(
    "angle",
    [
        WAVE,
        np.abs(WAVE),
        np.maximum(TIME - 1.0, 0.0),
        slipping(),
        np.where(TIME < 4.0, 0.0, np.radians(0.1)),
    ],
    ids=["motion", "impact", "breakaway", "slips", "little"],
)
def test_what_a_machine_does_is_no_jump(angle: np.ndarray) -> None:
    assert jumps(rounded(angle), TIME, COUNT).size == 0


def test_samples_that_are_missing_are_no_jump() -> None:
    kept = np.delete(np.arange(800), [300, 301, 302])
    assert jumps(rounded(WAVE[kept]), TIME[kept], COUNT).size == 0


@pytest.mark.parametrize(
    ("bits", "cpr"), [(12, 3000), (14, 3000), (16, 3000), (24, 2**22 + 7), (32, 2**30 + 7)]
)
def test_a_counter_that_runs_over_goes_on_by_its_own_span(bits: int, cpr: int) -> None:
    """A register of 2^bits counts begins anew after 2^bits of them, no more and no fewer: of twice
    the span there is no register for 12, 14, 24 and 32 bits. All span more than a turn and no whole
    number of turns.
    """
    span = 2.0**bits * 2.0 * np.pi / cpr
    whole = 2.2 * span * np.sin(0.4 * TIME)
    declared = SignalDeclaration("theta_pan", "angle", "rad", "output", counts_per_revolution=cpr)
    found, wraps = unwrapped(np.mod(whole, span), declared)
    assert found == pytest.approx(whole, abs=1e-9)
    assert wraps is not None and wraps.span == pytest.approx(span, rel=1e-12)
    assert wraps.count == np.count_nonzero(np.diff(np.floor(whole / span)))


def test_a_short_pause_beside_a_long_one_is_one() -> None:
    """Of ten and more usual sampling periods each, however long others are."""
    step = np.full(99, PERIOD)
    step[30], step[60] = 5.0, 30.0 * PERIOD
    step[80] = 9.0 * PERIOD
    assert list(pauses(np.concatenate([[0.0], np.cumsum(step)]))) == [31, 61]
