"""Values between samples against closed forms: smooth, rounded, with jitter, gaps, jumps, kinks."""

import numpy as np
import pytest

from ptp_symbolic.numeric.data.latency import Samples, jumps

PERIOD = 0.01
COUNT = 2.0 * np.pi / 4096
TIME = PERIOD * np.arange(600)
BETWEEN = TIME[10:-10] + 0.37 * PERIOD


def swing(time: np.ndarray) -> np.ndarray:
    return np.sin(5.0 * time)


def rounded(values: np.ndarray) -> np.ndarray:
    return np.rint(values / COUNT) * COUNT


def jittered(share: float) -> np.ndarray:
    rng = np.random.default_rng(3)
    return np.sort(TIME + share * PERIOD * rng.normal(size=len(TIME)))


def test_a_cubic_is_off_by_the_fourth_derivative() -> None:
    samples = Samples(TIME, swing(TIME))
    middle = TIME[:-1] + 0.5 * PERIOD
    off = np.abs(samples.at(middle) - swing(middle))
    largest = PERIOD**4 * 5.0**4
    assert 0.9 * largest / 42.7 < off[1:-1].max() < largest / 42.6
    assert off.max() < largest / 24.0
    assert samples.at(TIME[3:9]) == pytest.approx(swing(TIME[3:9]), abs=0.0)


@pytest.mark.parametrize("share", [0.0, 0.02, 0.2, 0.3])
def test_rounded_values_scatter_no_more_than_their_samples(share: float) -> None:
    """Each by a twelfth of a squared count, whatever the jitter."""
    time = jittered(share)
    samples = Samples(time, rounded(0.2 * time), COUNT)
    known = BETWEEN[samples.is_known(BETWEEN)]
    assert len(known) >= 0.99 * len(BETWEEN)
    off = (samples.at(known) - 0.2 * known) / COUNT
    assert 0.5 / np.sqrt(12.0) < np.std(off) < 1.0 / np.sqrt(12.0)
    assert np.abs(off).max() < 0.75


def test_a_stamp_next_to_another_does_no_harm() -> None:
    time = np.sort(np.append(TIME, TIME[300] + 1e-5))
    values = rounded(0.2 * time)
    values[301] += COUNT
    off = Samples(time, values, COUNT).at(BETWEEN) - 0.2 * BETWEEN
    assert np.abs(off).max() < 1.6 * COUNT


def test_nothing_is_known_where_samples_were_lost() -> None:
    kept = np.r_[0:200, 230:600]
    samples = Samples(TIME[kept], swing(TIME[kept]))
    is_known = samples.is_known(BETWEEN)
    lost = np.abs(BETWEEN - 0.5 * (TIME[199] + TIME[230])) < 15.5 * PERIOD
    np.testing.assert_array_equal(is_known, ~lost)
    assert samples.at(BETWEEN[is_known]) == pytest.approx(swing(BETWEEN[is_known]), abs=4e-7)
    assert samples.is_known(TIME[[199, 230]]).all()
    assert not samples.is_known(np.array([-PERIOD, 7.0])).any()


@pytest.mark.parametrize("fraction", [0.1, 0.37, 0.5, 0.9])
def test_an_encoder_set_anew_jumps_as_before(fraction: float) -> None:
    """Both sides as they were, none of the jump between them, and the jump is found there."""
    clock = TIME[10:-10] + fraction * PERIOD
    step = np.where(TIME >= 3.0, 1.5, 0.0)
    samples = Samples(TIME, rounded(swing(TIME) + step), COUNT)
    known = clock[samples.is_known(clock)]
    assert len(known) == len(clock) - 1
    values = samples.at(known)
    off = values - swing(known) - np.where(known >= 3.0, 1.5, 0.0)
    assert np.abs(off).max() < COUNT
    assert list(jumps(values, known, COUNT)) == [np.searchsorted(known, 3.0)]


@pytest.mark.parametrize("kink", [3.0, 3.0019, 3.005, 3.0083])
@pytest.mark.parametrize(("size", "power"), [(500.0, 2), (20.0, 1)])
def test_what_a_sudden_change_leaves_is_told(kink: float, size: float, power: int) -> None:
    """An acceleration or a rate that jumps, at a sample or between: the order of the error."""

    def motion(time: np.ndarray) -> np.ndarray:
        return size * np.maximum(time - kink, 0.0) ** power

    samples = Samples(TIME, motion(TIME))
    fine = np.linspace(2.9, 3.1, 1001)
    off = np.abs(samples.at(fine) - motion(fine)).max()
    assert 0.3 * off < samples.uncertainty < 7.0 * off


def test_smooth_motion_and_noise_leave_less_than_a_count() -> None:
    noise = 5.0 * COUNT * np.random.default_rng(4).normal(size=len(TIME))
    assert Samples(TIME, rounded(swing(TIME)), COUNT).uncertainty < COUNT
    assert Samples(TIME, rounded(swing(TIME) + noise), COUNT).uncertainty < COUNT
    kept = np.r_[0:200, 230:600]
    assert Samples(TIME[kept], rounded(swing(TIME[kept])), COUNT).uncertainty < COUNT
