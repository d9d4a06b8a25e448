"""Winding that heats: resistance after the first-order thermal law, at the loss i^2 R it feels."""

import math

import numpy as np
import pytest

from ptp_symbolic import simulate
from ptp_symbolic.models import emission
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.inputs import constant, step, table
from ptp_symbolic.platform import EffectDeclaration, Platform

EFFECTS = (
    EffectDeclaration("rigid_bodies", None, None),
    EffectDeclaration("dc_motor", "pan", None),
    EffectDeclaration("winding_heating", "pan", None),
)
PLATFORM = Platform("warm", "Pan axis with a warm motor", ("pan",), 9.81, EFFECTS, (), ())
R, RISE, SLOW = 12.9, 0.02, 2.0
# Next to no torque constant: the motor stands and makes no voltage.
STALLED = {"R_pan": R, "L_pan": 6.9e-3, "K_t_pan": 1e-9, "k_heat_pan": RISE, "t_heat_pan": SLOW}
TIMES = np.linspace(0.0, 3.0, 31)


@pytest.fixture(scope="module")
def model() -> Model:
    return emission.emit(PLATFORM)


def test_constant_stall_current_heats_exponentially(model: Model) -> None:
    """The loss grows with the resistance: rise k P/(1 - k P), time constant t/(1 - k P)."""
    current = 1.2
    part = RISE * current**2 * R
    fine = np.linspace(0.0, 3.0, 301)
    heat = part / (1 - part) * (1 - np.exp(-(1 - part) * fine / SLOW))
    driven = {"u_pan": table(fine, current * R * (1 + heat), "cubic")}
    found = simulate(model, TIMES, driven, STALLED, {"i_pan": current})
    assert found["heat_pan"] == pytest.approx(heat[::10], abs=1e-5)
    assert found["i_pan"] == pytest.approx([current] * len(TIMES), rel=1e-5)


def test_constant_voltage_settles_where_loss_and_cooling_meet(model: Model) -> None:
    """Loss u^2/(R (1 + h)) and rise h = k times it: h (1 + h) = k u^2/R."""
    volts = 24.0
    settled = (math.sqrt(1 + 4 * RISE * volts**2 / R) - 1) / 2
    found = simulate(model, [0.0, 30.0], {"u_pan": constant(volts)}, STALLED)
    assert found["heat_pan"][-1] == pytest.approx(settled, rel=1e-6)
    assert found["i_pan"][-1] == pytest.approx(volts / (R * (1 + settled)), rel=1e-6)


def test_it_cools_with_the_thermal_time_constant(model: Model) -> None:
    """From 0.1 s after the cut, when the current has died away."""
    found = simulate(model, TIMES, {"u_pan": step(24.0, 0.0, 1.0)}, STALLED)
    warm, since = found["heat_pan"][11], TIMES[11:] - TIMES[11]
    assert warm > 0.1
    assert found["heat_pan"][11:] == pytest.approx(warm * np.exp(-since / SLOW), rel=1e-6)
