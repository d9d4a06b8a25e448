"""How well Tables 4.1 and 4.2 are determined, against closed forms, finite differences, refits."""

import math
import statistics
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import curve_fit

from ptp_symbolic.thesis import precision, printed, ramp_test
from ptp_symbolic.thesis.friction import SPEEDS
from ptp_symbolic.thesis.precision import FloatArray, Precision


def test_the_bound_of_a_straight_line_is_the_closed_form() -> None:
    # y = a + b t: var b = s^2 / sum (t - mean)^2, corr(a, b) = -mean / rms
    t = np.array([1.0, 2.0, 4.0, 7.0, 11.0])
    deviation, correlation = precision.fisher_bound(np.column_stack([np.ones(5), t]), 0.3)
    assert deviation[1] == pytest.approx(0.3 / math.sqrt(66.0))  # mean 5, squares 16 9 1 4 36
    assert deviation[0] == pytest.approx(0.3 * math.sqrt(191.0 / (5 * 66.0)))
    assert correlation[0, 1] == pytest.approx(-5.0 / math.sqrt(191.0 / 5))
    assert np.diag(correlation) == pytest.approx(np.ones(2))


def steady(v: FloatArray, F_c: float, F_s: float, v_s: float, F_v: float) -> FloatArray:
    return np.asarray(F_c + (F_s - F_c) * np.exp(-((v / v_s) ** 2)) + F_v * v)


@pytest.mark.parametrize("direction", printed.DIRECTIONS)
def test_the_bound_of_table_4_1_by_derivatives_of_eq_4_1(direction: str) -> None:
    f = printed.TABLE_4_1[direction]
    e = np.exp(-((SPEEDS / f.v_s) ** 2))
    slopes = [1.0 - e, e, (f.F_s - f.F_c) * e * 2.0 * SPEEDS**2 / f.v_s**3, SPEEDS]
    covariance = np.linalg.inv(np.array(slopes) @ np.array(slopes).T) * 0.05**2
    found = precision.map_precision(direction)
    assert found.parameters == ("F_c", "F_s", "v_s", "F_v")
    assert found.fisher == pytest.approx(np.sqrt(np.diag(covariance)), rel=1e-3)
    size = np.sqrt(np.diag(covariance))
    assert found.correlation == pytest.approx(covariance / np.outer(size, size), abs=1e-3)


def test_fits_of_noisy_maps_scatter_as_the_bound_says() -> None:
    f, random = printed.TABLE_4_1["negative"], np.random.default_rng(7)
    truth = (f.F_c, f.F_s, f.v_s, f.F_v)
    clean = steady(SPEEDS, *truth)
    fits = [
        curve_fit(steady, SPEEDS, clean + 0.005 * random.standard_normal(24), truth)[0]
        for _ in range(400)
    ]
    # a tenth of the noise, so that the Stribeck speed stays within its linear range
    spread = 10.0 * np.std(fits, axis=0, ddof=1)
    found = precision.map_precision("negative")
    assert found.fisher == pytest.approx(spread, rel=0.15)
    assert found.spread == pytest.approx(spread, rel=0.35)


def shifted(test: printed.RampTest, name: str, change: float) -> printed.RampTest:
    if name == "J":
        return replace(test, J=test.J + change)
    value = getattr(test.friction, name) + change
    return replace(test, friction=replace(test.friction, **{name: value}))


def test_the_bound_of_table_4_2_by_differences_of_scipy_solutions() -> None:
    test = printed.TABLE_4_2["negative"][2]
    slopes = ramp_test.sensitivities(test, "theta_pan")
    columns = []
    for k, (name, step) in enumerate(
        {"J": 1e-3, "F_c": 1e-4, "F_s": 1e-4, "v_s": 1e-5, "F_v": 1e-4}.items()
    ):
        ahead, behind = (ramp_test.true_angle(shifted(test, name, s * step)) for s in (1.0, -1.0))
        difference = (ahead - behind) / (2.0 * step)
        assert slopes[:, k] == pytest.approx(difference, abs=2e-3 * np.abs(difference).max()), name
        columns.append(difference)
    # errors of rounding are uniform over one of 7200 counts
    count = 2.0 * math.pi / 7200
    covariance = np.linalg.inv(np.array(columns) @ np.transpose(columns)) * count**2 / 12.0
    deviation = np.sqrt(np.diag(covariance))
    assert precision.ramp_precision("negative", 3).fisher == pytest.approx(deviation, rel=0.02)


@pytest.mark.parametrize(("direction", "number"), [("positive", 1), ("negative", 4)])
def test_fits_with_white_noise_scatter_as_the_bound_of_table_4_2(
    direction: str, number: int
) -> None:
    test, random = printed.TABLE_4_2[direction][number - 1], np.random.default_rng(3)
    count = 2.0 * math.pi / 7200
    clean = ramp_test.true_angle(test)
    fits = [
        ramp_test.fit(
            clean + count / math.sqrt(12.0) * random.standard_normal(len(clean)),
            bounded=False,
            start=ramp_test.row(test),
        ).x
        for _ in range(60)
    ]
    found = precision.ramp_precision(direction, number)
    # sixty fits tell their standard deviation to 9 %
    assert found.fisher == pytest.approx(np.std(fits, axis=0, ddof=1), rel=0.3)
    assert found.correlation == pytest.approx(np.corrcoef(np.transpose(fits)), abs=0.3)


@pytest.mark.long
def test_the_tests_agree_on_the_inertia_better_than_their_data_allow() -> None:
    for direction in printed.DIRECTIONS:
        inertias = [t.J for t in printed.TABLE_4_2[direction]]
        spread = precision.spread_of_tests(direction)[0]
        assert spread == pytest.approx(statistics.stdev(inertias))
        assert spread < precision.least_inertia_deviation() / 10
    assert all(p.on_bound[0] for p in precision.all_precisions() if p.test is not None)
    assert not any(p.on_bound.any() for p in precision.all_precisions() if p.test is None)


def test_an_estimate_lies_on_a_bound_within_a_thousandth_of_their_distance() -> None:
    zero = np.zeros(3)
    found = Precision(
        "table_4_2",
        "positive",
        1,
        ("a", "b", "c"),
        zero,
        np.array([1.0005, 1.002, 1.9999]),
        np.ones(3),
        np.full(3, 2.0),
        zero,
        np.eye(3),
        zero,
    )
    assert found.on_bound.tolist() == [True, False, True]
