"""Quadratic drag: terminal rate, the way there, and coasting."""

import math

import numpy as np
import pytest

from ptp_symbolic import simulate
from ptp_symbolic.models import emission
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.inputs import constant
from ptp_symbolic.platform import EffectDeclaration, Platform

EFFECTS = (
    EffectDeclaration("rigid_bodies", None, None),
    EffectDeclaration("quadratic_drag", "pan", None),
)
PLATFORM = Platform("drag", "Pan axis in air", ("pan",), 9.81, EFFECTS, (), ())
J, DRAG = 0.05, 0.3
AIR = {"J_pan": J, "c_drag_pan": DRAG}


@pytest.fixture(scope="module")
def model() -> Model:
    return emission.emit(PLATFORM)


@pytest.mark.parametrize("torque", [0.8, -0.8])
def test_constant_torque_approaches_the_terminal_rate(model: Model, torque: float) -> None:
    """Rate sqrt(tau/c) tanh(t sqrt(tau c)/J), angle J/c log cosh of the same argument."""
    size, sign = abs(torque), math.copysign(1.0, torque)
    found = simulate(model, [0.0, 0.05, 0.1, 2.0], {"tau_pan": constant(torque)}, AIR)
    phase = found.t * math.sqrt(size * DRAG) / J
    terminal = sign * math.sqrt(size / DRAG)
    assert found["omega_pan"] == pytest.approx(terminal * np.tanh(phase), rel=1e-6)
    angle = sign * J / DRAG * np.log(np.cosh(phase))
    assert found["theta_pan"] == pytest.approx(angle, rel=1e-6)
    assert found["omega_pan"][-1] == pytest.approx(terminal, rel=1e-6)


@pytest.mark.parametrize("rate", [4.0, -4.0])
def test_coasting_slows_like_a_hyperbola(model: Model, rate: float) -> None:
    """One over the rate grows by c/J per second; the drag takes c |w|^3."""
    found = simulate(model, 3.0, None, AIR, {"omega_pan": rate})
    slowing = 1.0 + DRAG * abs(rate) * found.t / J
    assert found["omega_pan"] == pytest.approx(rate / slowing, rel=1e-6)
    assert found["theta_pan"] == pytest.approx(
        math.copysign(J / DRAG, rate) * np.log(slowing), rel=1e-6
    )
    lost = J / 2 * (rate**2 - found["omega_pan"] ** 2)
    assert found.dissipated == pytest.approx(lost, abs=1e-7)
