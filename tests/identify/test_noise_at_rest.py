"""Slow noise of an encoder is there while the machine rests; what a model lacks is not."""

import numpy as np
import pytest
from scipy.signal import lfilter

from ptp_symbolic.numeric.identify.noise import is_missed_at_rest, stretches_at_rest
from tests.identify.curves import Floats

REST, TURN = 300, 500  # samples


def motion(turns: int, rest: int = REST) -> Floats:
    """A signal [n] that turns and rests, in turn."""
    parts, place = [], 0.0
    for _ in range(turns):
        parts.append(place + 40.0 * np.linspace(0.0, 1.0, TURN))
        place = parts[-1][-1]
        parts.append(np.full(rest, place))
    return np.concatenate(parts)


def slow_noise(rng: np.random.Generator, pole: float, size: int) -> Floats:
    """An autoregression [size] of variance 1, in its steady state."""
    driven = np.sqrt(1.0 - pole**2) * rng.standard_normal(size + 2000)
    return np.asarray(lfilter([1.0], [1.0, -pole], driven)[2000:])


def test_stretches_are_where_the_signal_stands_still() -> None:
    signal = motion(2)
    assert stretches_at_rest(signal) == [(499, 801), (1299, 1600)]
    assert stretches_at_rest(signal[:530]) == []  # short
    assert stretches_at_rest(np.linspace(0.0, 1.0, 500)) == []


@pytest.mark.parametrize("pole", [0.3, 0.8, 0.97])
@pytest.mark.parametrize("slow", [0.0, 0.5, 0.7, 3.0])
@pytest.mark.parametrize(("turns", "rest"), [(4, REST), (1, 70)])
def test_noise_that_goes_on_at_rest_is_hardly_ever_doubted(
    pole: float, slow: float, turns: int, rest: int
) -> None:
    rng, signal = np.random.default_rng(5), motion(turns, rest)
    doubted = 0
    for _ in range(300):
        noise = rng.standard_normal(len(signal)) + slow * slow_noise(rng, pole, len(signal))
        doubted += is_missed_at_rest([noise], [signal], slow, pole)
    assert doubted <= 8  # 1 % of 300, and three standard deviations


@pytest.mark.parametrize("slow", [1.0, 3.0])
def test_what_stands_still_at_rest_is_no_noise(slow: float) -> None:
    rng, signal = np.random.default_rng(6), motion(4)
    moving = np.concatenate([[True], np.diff(signal) != 0.0])
    found = 0
    for _ in range(50):
        lacking = slow_noise(rng, 0.97, len(signal))
        last = np.maximum.accumulate(np.where(moving, np.arange(len(signal)), 0))
        noise = rng.standard_normal(len(signal)) + slow * lacking[last]
        found += is_missed_at_rest([noise], [signal], slow, 0.97)
    assert found >= 45


def test_a_machine_that_never_rests_says_nothing() -> None:
    signal = np.linspace(0.0, 99.0, 4000)
    assert not is_missed_at_rest([np.zeros(4000)], [signal], 3.0, 0.97)
