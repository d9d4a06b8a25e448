"""Encoder off its centre: the reading, not the motion, is wrong once per turn."""

import math

import numpy as np
import pytest

from ptp_symbolic import simulate
from ptp_symbolic.models import emission
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.inputs import constant
from ptp_symbolic.platform import EffectDeclaration, Platform

BODY = EffectDeclaration("rigid_bodies", None, None)
DISC = EffectDeclaration("encoder_eccentricity", "pan", None)
PLATFORM = Platform("disc", "Disc off its centre", ("pan", "tilt"), 9.81, (BODY, DISC), (), ())
SIN, COS = 0.003, -0.004
OFF = {"e_sin_pan": SIN, "e_cos_pan": COS}


@pytest.fixture(scope="module")
def model() -> Model:
    return emission.emit(PLATFORM)


def reading(model: Model, pan: float, tilt: float = 0.0) -> dict[str, float]:
    y, x = np.zeros(len(model.output_names)), np.array([pan, tilt, 0.3, 0.2])
    model.module.outputs(0.0, x, np.zeros(2), model.parameter_vector(OFF), y)
    return dict(zip(model.output_names, y, strict=True))


def test_reading_of_the_turned_axis(model: Model) -> None:
    for angle in (-4.0, 0.0, 1.1, 2.9):
        seen = reading(model, angle, 0.7)
        assert seen["theta_pan"] == pytest.approx(
            angle + SIN * math.sin(angle) + COS * math.cos(angle), abs=1e-15
        )
        assert seen["theta_tilt"] == 0.7


def test_error_has_one_period_a_turn_and_the_amplitude_of_both_parts(model: Model) -> None:
    angles = 2 * math.pi * np.arange(720) / 720
    error = np.array([reading(model, a)["theta_pan"] - a for a in angles])
    spectrum = np.abs(np.fft.rfft(error)) / 360
    assert spectrum[1] == pytest.approx(0.005, rel=1e-10)
    assert np.delete(spectrum, 1) == pytest.approx(0.0, abs=1e-15)


def test_the_motion_knows_nothing_of_it(model: Model) -> None:
    driven = {"tau_pan": constant(0.01)}
    seen, true = (simulate(model, 0.5, driven, values) for values in (OFF, {}))
    assert np.array_equal(seen.x, true.x)
