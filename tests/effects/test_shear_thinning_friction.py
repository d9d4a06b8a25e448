"""Shear-thinning friction: terminal rate, and coasting by Lambert's W function."""

import math

import numpy as np
import pytest
from scipy.special import lambertw

from ptp_symbolic import simulate
from ptp_symbolic.models import emission
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.inputs import constant
from ptp_symbolic.platform import EffectDeclaration, Platform

EFFECTS = (
    EffectDeclaration("rigid_bodies", None, None),
    EffectDeclaration("shear_thinning_friction", "pan", None),
)
PLATFORM = Platform("grease", "Pan axis in grease", ("pan",), 9.81, EFFECTS, (), ())
J, TORQUE, RATE = 0.05, 0.4, 0.3
GREASE = {"J_pan": J, "F_t_pan": TORQUE, "v_t_pan": RATE}


@pytest.fixture(scope="module")
def model() -> Model:
    return emission.emit(PLATFORM)


@pytest.mark.parametrize("torque", [0.1, -0.3])
def test_a_torque_below_the_level_ends_at_a_steady_rate(model: Model, torque: float) -> None:
    """Where tau = F v / (v_t + v); half of F at v_t."""
    found = simulate(model, [0.0, 10.0], {"tau_pan": constant(torque)}, GREASE)
    steady = RATE * abs(torque) / (TORQUE - abs(torque))
    assert found["omega_pan"][-1] == pytest.approx(math.copysign(steady, torque), rel=1e-6)


@pytest.mark.parametrize("rate", [2.0, -2.0])
def test_coasting_is_fast_at_first_and_exponential_at_last(model: Model, rate: float) -> None:
    """v_t log(v0/v) + v0 - v = F t / J: v = v_t W(v0/v_t exp((v0 - F t/J) / v_t))."""
    found = simulate(model, np.linspace(0.0, 0.6, 61), None, GREASE, {"omega_pan": rate})
    start = abs(rate)
    argument = start / RATE * np.exp((start - TORQUE * found.t / J) / RATE)
    expected = RATE * lambertw(argument).real
    assert found["omega_pan"] == pytest.approx(math.copysign(1.0, rate) * expected, rel=1e-6)
    lost = J / 2 * (rate**2 - found["omega_pan"] ** 2)
    assert found.dissipated == pytest.approx(lost, abs=1e-7)
