"""Sensitivities by both methods: closed forms, central differences, events, samples."""

import math

import numpy as np
import pytest

import ptp_symbolic
from ptp_symbolic.numeric.simulation.inputs import InputSignal, multisine, ramp, step, table
from tests.simulation.block import F_C, F_S, J, K, block

METHODS = ("rosenbrock", "runge_kutta")


@pytest.fixture(scope="module")
def drive():
    return ptp_symbolic.load("pan_drive")


@pytest.mark.parametrize("method", METHODS)
def test_where_a_block_stops_by_closed_form(method: str) -> None:
    """Way = J omega^2 / (2 F_c): the jump of the tangents at rest makes or breaks it."""
    found = ptp_symbolic.sensitivity(
        block(),
        [0.0, 5.0],
        None,
        {"k": 0.0},
        {"omega_pan": 2.0},
        ["J", "F_c"],
        ["omega_pan"],
        method=method,
    )
    exact = [2.0**2 / (2.0 * F_C), -J * 2.0**2 / (2.0 * F_C**2), J * 2.0 / F_C]
    assert found.states[-1, 0] == pytest.approx(exact, rel=1e-8)
    assert np.all(found.states[-1, 1] == 0.0)


@pytest.mark.parametrize("method", METHODS)
def test_when_a_block_breaks_away_by_closed_form(method: str) -> None:
    """Pulled by a ramp, it starts at F_s / slope; then it moves as an oscillator does."""
    slope, t, rate = 0.4, 2.0, math.sqrt(K / J)
    found = ptp_symbolic.sensitivity(
        block(),
        [0.0, t],
        {"tau_pan": ramp(0.0, 10.0 * slope, 0.0, 10.0)},
        by_parameters=["F_s", "F_c"],
        method=method,
    )

    def angle(breakaway: float, sliding: float) -> float:
        late = t - breakaway / slope
        step_part = (breakaway - sliding) / K * (1.0 - math.cos(rate * late))
        return step_part + slope / K * (late - math.sin(rate * late) / rate)

    h = 1e-5
    exact = [
        (angle(F_S + h, F_C) - angle(F_S - h, F_C)) / (2.0 * h),
        (angle(F_S, F_C + h) - angle(F_S, F_C - h)) / (2.0 * h),
    ]
    assert found.x[-1, 0] == pytest.approx(angle(F_S, F_C), abs=1e-8)
    assert found.states[-1, 0] == pytest.approx(exact, rel=1e-6)


@pytest.mark.parametrize(
    ("signal", "end", "events"),
    [(multisine([2.0], [0.15]), 5.0, 20), (multisine([5.0, 4.0, 3.0], [0.3, 0.9, 2.1]), 7.0, 100)],
    ids=["crawl", "multisine"],
)
def test_differences_come_to_the_derivatives_through_vanishing_bounces(
    drive, signal: InputSignal, end: float, events: int
) -> None:
    """No jump is missing: what differences miss falls with the square of their step.

    The map bends sharply near bounces, so that a thousandth of the gap is too much for them.
    """
    times, inputs, name = np.linspace(0.0, end, 201), {"u_pan": signal}, "gap_pan"
    tight = {"rtol": 1e-11, "atol": 1e-12}
    found = ptp_symbolic.sensitivity(drive, times, inputs, by_parameters=[name], **tight)
    exact = found.states[:, 0, 0]
    assert len(ptp_symbolic.simulate(drive, end, inputs).events) > events
    off = []
    for relative in (1e-3, 1e-4, 1e-5):
        h = relative * drive.defaults[name]
        ends = [
            ptp_symbolic.simulate(
                drive, times, inputs, {name: drive.defaults[name] + s * h}, **tight
            )["theta_pan"]
            for s in (1.0, -1.0)
        ]
        off.append(np.abs((ends[0] - ends[1]) / (2.0 * h) - exact).max() / np.abs(exact).max())
    assert off[0] > 5e-5
    assert off[1] < 0.02 * off[0]
    assert off[2] < 2e-6


@pytest.mark.parametrize("tolerance", [1e-6, 1e-8, 1e-12])
def test_tangents_of_the_explicit_method_stay_below_its_limit_of_stability(
    drive, tolerance: float
) -> None:
    """The winding's own motion, a thousand times faster, has died out in the states alone."""
    names, end = ["F_c_pan", "R_pan", "F_v_pan"], 5.0
    for signal in (ramp(0.0, 4.0, 0.0, 10.0), multisine([2.0], [0.15])):
        one, other = (
            ptp_symbolic.sensitivity(
                drive,
                [0.0, end],
                {"u_pan": signal},
                by_parameters=names,
                rtol=rtol,
                atol=0.1 * rtol,
                method=method,
            ).states[-1, 0]
            for method, rtol in (("runge_kutta", tolerance), ("rosenbrock", 1e-11))
        )
        assert one == pytest.approx(other, rel=max(2e-6, 100.0 * tolerance))


@pytest.mark.parametrize("method", METHODS)
def test_six_parameters_through_stick_slip_and_gap(drive, method: str) -> None:
    """At 1e-6 relative, against differences of fourth order of runs a thousand times as exact."""
    names = ("F_c_pan", "J_pan", "gap_pan", "k_shaft_pan", "R_pan", "F_v_pan")
    times, inputs = [0.0, 2.0], {"u_pan": step(0.0, 24.0, 0.5)}
    given = {"by_parameters": names, "method": method}
    found = ptp_symbolic.sensitivity(drive, times, inputs, rtol=1e-10, atol=1e-11, **given)
    loose = ptp_symbolic.sensitivity(drive, times, inputs, **given)
    for index, name in enumerate(names):
        h = 3e-4 * drive.defaults[name]
        ends = [
            ptp_symbolic.simulate(
                drive,
                times,
                inputs,
                {name: drive.defaults[name] + s * h},
                rtol=1e-13,
                atol=1e-14,
            )["theta_pan"][-1]
            for s in (-2.0, -1.0, 1.0, 2.0)
        ]
        difference = (ends[0] - 8.0 * ends[1] + 8.0 * ends[2] - ends[3]) / (12.0 * h)
        assert found.states[-1, 0, index] == pytest.approx(difference, rel=1e-6)
        assert loose.states[-1, 0, index] == pytest.approx(difference, rel=1e-5)


def test_both_methods_agree_over_samples_of_a_held_input(drive) -> None:
    """Behind 400 jumps at the tolerances of every run, and more closely at tighter ones."""
    time = np.arange(400) * 5e-3
    volts = 10.0 + 6.0 * np.sin(2 * math.pi * 0.9 * time)

    def tangents(rtol: float, method: str) -> np.ndarray:
        return ptp_symbolic.sensitivity(
            drive,
            time,
            {"u_pan": table(time, volts, "hold")},
            by_parameters=["R_pan", "F_v_pan"],
            by_initial=["theta_gear_pan"],
            rtol=rtol,
            atol=rtol / 10,
            method=method,
        ).states[:, 0]

    exact = tangents(1e-12, "runge_kutta")
    size = np.abs(exact).max(axis=0)
    for rtol, close in ((1e-8, 2e-6), (1e-10, 5e-8)):
        for method in METHODS:
            off = np.abs(tangents(rtol, method) - exact).max(axis=0)
            assert np.all(off < close * size)


def test_a_smooth_model_by_the_implicit_method() -> None:
    model = ptp_symbolic.load("payload")
    arguments = ([0.0, 1.0], {"tau_tilt": multisine([0.5], [1.0])}, None, {"theta_tilt": 0.4})
    one, other = (
        ptp_symbolic.sensitivity(model, *arguments, rtol=1e-11, atol=1e-12, method=method)
        for method in METHODS
    )
    assert one.states[-1] == pytest.approx(other.states[-1], rel=1e-6, abs=1e-10)
