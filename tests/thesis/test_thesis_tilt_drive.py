"""Figs. 5.9 to 5.14 and the linkage against a model in motor coordinates that shares no code."""

import math
from functools import cache

import numpy as np
import pytest

from ptp_symbolic.thesis import errata_drives, tilt_drive
from ptp_symbolic.thesis.tilt_drive import TIMES, TiltRun
from tests.independent import tilt_drive as independent
from tests.independent.tilt_drive import CURRENT, SPEED, TiltDrive

STROKES = {"40.5": 0.0405022, "48.5": 0.0485}
CORNERS, VOLTS = (0.0, 0.5, 3.0, 3.5), (0.0, 24.0, 24.0, 0.0)
# What each quantity of the figures may miss: m, m/s, N, A, rad/s, rad.
ALLOWED = {
    "stroke": 1e-9,
    "stroke_speed": 1e-9,
    "force": 1e-5,
    "current": 1e-7,
    "tilt_rate": 1e-8,
    "tilt_angle": 1e-8,
}


def volts(t: float) -> float:
    return float(np.interp(t, CORNERS, VOLTS))


def truth(stroke: float, times: np.ndarray) -> TiltRun:
    """The quantities of the figures from the model in motor coordinates."""
    drive = TiltDrive(s_start=stroke)
    states = independent.simulate(drive, volts, times, CORNERS)
    angle, rate = np.array([independent.joint(drive, x) for x in states]).T
    return TiltRun(
        times,
        stroke + drive.metres_per_radian * states[:, 0],
        drive.metres_per_radian * states[:, SPEED],
        np.array([independent.motion(drive, x, 1.0)[1] for x in states]),
        states[:, CURRENT],
        rate,
        angle,
    )


@cache
def coarse(name: str) -> TiltRun:
    return truth(STROKES[name], TIMES[::20])


@pytest.mark.long
@pytest.mark.parametrize("name", STROKES)
@pytest.mark.parametrize("quantity", ALLOWED)
def test_every_curve_against_a_simulation_in_motor_coordinates(name: str, quantity: str) -> None:
    found = getattr(tilt_drive.trapezoid_run(name), quantity)[::20]
    expected = getattr(coarse(name), quantity)
    assert np.max(np.abs(expected)) > 1e3 * ALLOWED[quantity]
    assert found == pytest.approx(expected, abs=ALLOWED[quantity])


@pytest.mark.parametrize(("name", "when"), [("40.5", 2.0786), ("48.5", 2.0849)])
def test_the_force_reverses_where_the_other_model_says(name: str, when: float) -> None:
    fine = truth(STROKES[name], np.array([0.0, *np.linspace(2.07, 2.09, 41)]))
    # falling through zero within half a millisecond
    root = np.interp(0.0, -fine.force[1:], fine.t[1:])
    assert tilt_drive.reversal(name) == pytest.approx(root, abs=1e-6)
    assert tilt_drive.reversal(name) == pytest.approx(when, abs=5e-5)


@pytest.mark.parametrize("name", STROKES)
def test_the_current_peaks_after_the_voltage_has_stopped_to_rise(name: str) -> None:
    fine = truth(STROKES[name], np.array([0.0, *np.linspace(0.5, 0.501, 201)]))
    time, peak = tilt_drive.extremum(name, "current")
    assert peak == pytest.approx(fine.current.max(), abs=1e-7)
    assert time == pytest.approx(fine.t[np.argmax(fine.current)], abs=6e-6)
    # a grid of a millisecond misses it by a quarter of a milliampere
    assert peak - tilt_drive.trapezoid_run(name).current.max() > 2e-4


def test_force_reverses_only_with_the_mass_above_the_axis() -> None:
    found = {
        direction: tilt_drive.reversal("40.5", direction) is not None
        for direction in tilt_drive.COM_DIRECTIONS
    }
    assert found == {"above": True, "ahead": False, "below": False, "behind": False}


def test_deviation_of_the_link_by_the_law_of_cosines() -> None:
    arm, ground, shortest = 0.0634133, 0.19755, 0.139
    for name, stroke in (("40.5", None), ("48.5", None), ("40.5", 0.0), ("48.5", 0.09)):
        length = shortest + (STROKES[name] if stroke is None else stroke)
        cosine = (arm**2 + length**2 - ground**2) / (2.0 * length * arm)
        expected = math.pi / 2.0 - math.acos(cosine)
        assert tilt_drive.deviation(name, stroke) == pytest.approx(expected, abs=1e-9)


def test_screw_factors_by_lead_and_friction_angle() -> None:
    slope, rub = math.atan(4e-3 / (math.pi * 8e-3)), math.atan(0.15)
    machine = tilt_drive.actuator("40.5")
    assert machine.raising == pytest.approx(4e-3 * math.tan(slope + rub))
    assert machine.lowering == pytest.approx(4e-3 * math.tan(rub - slope))


def test_screw_creep_by_hand() -> None:
    force = 6.3785 * 9.81 * 0.0876228 / 0.0634133
    assert force == pytest.approx(86.46, abs=0.01)
    open_circuit = 3.5766e-5 * force / 93 / 1.1696e-4 / 93 * 4e-3 / (2 * math.pi)
    assert errata_drives.creep_speed(shorted=False) == pytest.approx(open_circuit, rel=1e-4)


def test_the_screw_creeps_at_the_end_of_the_run() -> None:
    run = tilt_drive.trapezoid_run("40.5")
    # under 7.55 N, against motor friction and a shorted winding
    resistance = 1.1696e-4 + 0.044**2 / 17.0
    creep = 3.576592e-5 * abs(run.force[-1]) / 93 / resistance / 93 * 4e-3 / (2 * math.pi)
    assert run.stroke_speed[-1] == pytest.approx(creep, rel=1e-4)
