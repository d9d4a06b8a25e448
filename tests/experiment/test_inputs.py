"""Inputs that a machine can play, and limits as people write them."""

import math
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import ptp_symbolic
from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.experiment.machine import Limit, excess, read_limits
from ptp_symbolic.numeric.experiment.prediction import FAMILIES, Family, Found, search, wave_of
from tests.identify.curves import Floats

T = np.arange(1001) * 0.01


@pytest.mark.parametrize("family", FAMILIES, ids=lambda f: f.name)
def test_every_input_stays_within_its_limits_and_begins_and_ends_at_rest(family: Family) -> None:
    for point in np.random.default_rng(2).random((50, 2 * family.size)):
        wave = wave_of(family, point, T, 2)
        assert wave.shape == (len(T), 2)
        assert np.max(np.abs(wave)) <= 1.0
        assert not np.any(wave[T < 0.195]) and not np.any(wave[T > 9.805])


def test_slow_reversals_are_as_slow_as_the_run() -> None:
    """Both periods at their longest: one period, up and down again."""
    reversals = next(f for f in FAMILIES if f.name == "reversals")
    wave = wave_of(reversals, np.array([0.0, 0.0, 1.0, 1.0, 0.5, 0.5]), T, 1)[:, 0]
    moving = wave[np.abs(wave) > 0.0]
    assert np.count_nonzero(np.diff(np.sign(moving))) == 1


def test_the_search_finds_the_frequency_that_is_asked_for() -> None:
    """Worth is the power at 1.5 Hz; a sine of full size has a half."""

    def worth(wave: Floats) -> float:
        return abs(np.mean(wave[:, 0] * np.exp(-2j * math.pi * 1.5 * T))) ** 2

    told: list[int] = []

    def progress(count: int, best: Found) -> None:
        told.append(count)

    with ThreadPoolExecutor(2) as executor:
        found = search(worth, T, 1, 1500, 3, executor, progress)
        again = search(worth, T, 1, 1500, 3, executor, progress)
    assert found[0].worth > 0.5 * 0.25
    assert np.array_equal(found[0].wave, again[0].wave)
    assert told[-1] <= 1500 and [f.worth for f in found] == sorted(f.worth for f in found)[::-1]


def test_limits_are_read_in_any_unit_that_fits() -> None:
    model = ptp_symbolic.load("payload")
    inputs = ("tau_pan=12 N cm", "tau_tilt=-1..2N m")
    limits = read_limits([*inputs, "theta_pan=-90..45deg", "omega_tilt=.5"], model)
    assert limits["tau_pan"] == Limit("tau_pan", pytest.approx(-0.12), pytest.approx(0.12))
    assert limits["tau_tilt"] == Limit("tau_tilt", -1.0, 2.0)
    assert limits["theta_pan"].lower == pytest.approx(-math.pi / 2)
    assert limits["omega_tilt"] == Limit("omega_tilt", -0.5, 0.5)


@pytest.mark.parametrize(
    ("texts", "message"),
    [
        (("tau_pan=1",), "Input tau_tilt has no limit; say how far it may go in N m"),
        (("tau_pam=1",), "Unknown signal 'tau_pam': did you mean 'tau_pan'"),
        (("tau_pan=1 V", "tau_tilt=1"), "V does not fit N m, the unit of tau_pan"),
        (("tau_pan=much", "tau_tilt=1"), "write tau_pan=HIGH or tau_pan=LOW..HIGH"),
        (("tau_pan=2..1", "tau_tilt=1"), "leaves no room from 2 to 1 N m"),
        (("tau_pan=0", "tau_tilt=1"), "leaves no room from -0 to 0 N m"),
    ],
)
def test_limits_that_mean_nothing_are_refused(texts: tuple[str, ...], message: str) -> None:
    with pytest.raises(InputError) as refused:
        read_limits(texts, ptp_symbolic.load("payload"))
    assert message in str(refused.value) and "\n" not in str(refused.value)


def test_excess_is_counted_from_where_a_signal_begins() -> None:
    limits = {"a": Limit("a", -1.0, 3.0), "b": Limit("b", -1.0, 1.0)}
    signals = {"a": np.array([1.0, 2.0, -3.0]), "b": np.array([0.0, 0.5, 0.0])}
    assert excess(limits, signals) == (2.0, "a")
    outside = {**signals, "b": np.array([1.5, 0.0, 0.0])}
    assert excess(limits, outside) == (np.inf, "b")
