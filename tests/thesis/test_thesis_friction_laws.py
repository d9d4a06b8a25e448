"""Figs. 2.7 to 2.16 against closed forms and SciPy, with the numbers of Table 4.2 by hand."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from ptp_symbolic.thesis import friction_laws as laws

# Means of the five tests of Table 4.2, omega > 0; motor at the gear output and load.
F_S, F_C, V_S, F_V = 7.4448, 5.8206, 0.03754, 5.6368
INERTIA = 2.75 + 0.05
RATES = np.array([-0.2, -0.03, -1e-3, 1e-3, 0.03, 0.2])


def steady(rate: float) -> float:
    size = abs(rate)
    dry = F_C + (F_S - F_C) * math.exp(-((size / V_S) ** 2))
    return math.copysign(dry + F_V * size, rate)


def test_the_emitted_laws_of_figures_2_12_to_2_15() -> None:
    values = laws.dry_values
    whole = laws.sliding_friction(RATES, values())
    assert whole == pytest.approx([steady(v) for v in RATES], rel=1e-9)
    coulomb = laws.sliding_friction(RATES, values(F_s_pan=F_C, F_v_pan=0.0))
    assert coulomb == pytest.approx(F_C * np.sign(RATES), rel=1e-9)
    viscous = laws.sliding_friction(RATES, values(F_c_pan=0.0, F_s_pan=0.0, F_v_pan=0.0, b_pan=2.0))
    assert viscous == pytest.approx(2.0 * RATES)
    stribeck = laws.sliding_friction(RATES, values(F_c_pan=0.0, F_s_pan=F_S - F_C, F_v_pan=0.0))
    expected = (F_S - F_C) * np.exp(-((RATES / V_S) ** 2)) * np.sign(RATES)
    assert stribeck == pytest.approx(expected, rel=1e-9, abs=1e-12)
    assert laws.breakaway_torque(values()) == pytest.approx(F_S, abs=1e-8)


def test_least_friction_is_where_the_slope_vanishes() -> None:
    def slope(rate: float) -> float:
        return F_V - 2 * rate / V_S**2 * (F_S - F_C) * math.exp(-((rate / V_S) ** 2))

    rate = brentq(slope, V_S, 4 * V_S)
    assert laws.stribeck_minimum()[0] == pytest.approx(rate, abs=1e-6)
    assert laws.stribeck_minimum()[1] == pytest.approx(steady(rate))


def test_breakaway_where_the_ramp_meets_the_torque_that_grows_with_the_rest() -> None:
    for rate, found in zip(laws.TORQUE_RATES[::8], laws.breakaway_by_rate()[::8], strict=True):
        torque = brentq(
            lambda t, rate=rate: t - F_S * (1 + 0.1 * math.log(1 + t / rate / 0.01)), F_S, 100.0
        )
        assert found == pytest.approx(torque, rel=1e-7)


def test_stick_slip_against_a_slip_by_scipy() -> None:
    spring, speed = laws.SPRING, laws.DRAWING_SPEED

    def slope(_: float, x: np.ndarray) -> list[float]:
        # the stretch of the spring, and the rate of the body
        return [speed - x[1], (spring * x[0] - steady(max(x[1], 1e-300))) / INERTIA]

    def stopped(_: float, x: np.ndarray) -> float:
        return float(x[1])

    stopped.terminal, stopped.direction = True, -1.0  # type: ignore[attr-defined]
    run = solve_ivp(
        slope, (0.0, 20.0), [F_S / spring, 0.0], "DOP853", events=stopped, rtol=1e-11, atol=1e-13
    )
    slip, stretch = run.t[-1], run.y[0, -1]
    dwell = (F_S / spring - stretch) / speed
    assert laws.dwell_and_slip() == pytest.approx((dwell, slip), abs=1e-5)


def bristles(torque_or_rate, times, inertia: float | None = None) -> np.ndarray:
    """LuGre by SciPy: angle, rate and bend [3, k] under a torque, or the bend along a rate."""

    def bending(rate: float, bend: float) -> float:
        level = F_C + (F_S - F_C) * math.exp(-((rate / V_S) ** 2))
        return rate - 1e4 * abs(rate) / level * bend

    def slope(t: float, x: np.ndarray) -> list[float]:
        if inertia is None:
            return [bending(torque_or_rate(t), x[0])]
        friction = 1e4 * x[2] + 100.0 * bending(x[1], x[2]) + F_V * x[1]
        return [x[1], (torque_or_rate(t) - friction) / inertia, bending(x[1], x[2])]

    start = [0.0] if inertia is None else [0.0, 0.0, 0.0]
    return solve_ivp(
        slope, (0.0, times[-1]), start, "LSODA", times, rtol=1e-10, atol=1e-13, max_step=1e-2
    ).y


@pytest.mark.parametrize("share", [0.5, 0.95])
def test_presliding_loops_against_scipy(share: float) -> None:
    angle, friction = laws.presliding(share)
    times = np.linspace(0.0, 7.0, len(angle))

    def torque(t: float) -> float:
        return share * F_S * float(np.interp(t, [0, 1, 3, 5, 7], [0, 1, -1, 1, -1]))

    expected = bristles(torque, times, INERTIA)
    assert angle == pytest.approx(expected[0], abs=1e-7)
    # a loop: the same torque at another angle on the way back
    assert np.ptp(angle[np.abs(friction) < 0.02 * F_S]) > 1e-4


def test_bristles_bend_until_the_body_slides() -> None:
    run = laws.bristle_bend()
    expected = bristles(lambda t: 1.1 * F_S * min(t, 1.0), run.t, INERTIA)
    assert run["bristle_pan"] == pytest.approx(expected[2], abs=1e-7)
    assert run["theta_pan"] == pytest.approx(expected[0], abs=1e-6)


@pytest.mark.parametrize("frequency", laws.LAG_FREQUENCIES)
def test_friction_lags_behind_a_rate_that_swings(frequency: float) -> None:
    rate, friction = laws.frictional_lag(frequency)
    times = np.linspace(2.0, 3.0, 401) / frequency

    def imposed(t: float) -> float:
        return 0.04 + 0.035 * math.sin(2 * math.pi * frequency * t)

    bend = bristles(imposed, np.concatenate([[0.0], times]))[0, 1:]
    level = F_C + (F_S - F_C) * np.exp(-((rate / V_S) ** 2))
    expected = 1e4 * bend + 100.0 * (rate - 1e4 * rate / level * bend) + F_V * rate
    assert rate == pytest.approx([imposed(t) for t in times], abs=3e-4)
    assert friction == pytest.approx(expected, abs=0.02)
    # at one rate, friction is higher on the way up than on the way down
    down = 100 + np.argmin(np.abs(rate[100:300] - 0.03))
    up = 300 + np.argmin(np.abs(rate[300:] - 0.03))
    assert friction[up] > friction[down] + 0.02
