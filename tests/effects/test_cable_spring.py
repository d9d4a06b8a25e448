"""Cable wrap: equilibrium, small swings about it, and the wide swing of a cubic spring."""

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
    EffectDeclaration("cable_spring", "pan", None),
)
PLATFORM = Platform("cable", "Pan axis with a cable", ("pan",), 9.81, EFFECTS, (), ())
J, K1, K3, REST = 0.05, 0.8, 0.5, -0.3
WRAP = {"J_pan": J, "k1_cable_pan": K1, "k3_cable_pan": K3, "theta0_cable_pan": REST}


@pytest.fixture(scope="module")
def model() -> Model:
    return emission.emit(PLATFORM)


@pytest.mark.parametrize("twist", [0.0, 0.6, -1.5])
def test_equilibrium_and_small_swing_under_a_constant_torque(model: Model, twist: float) -> None:
    """k1 a + k3 a^3 holds the twist a; about it the stiffness is k1 + 3 k3 a^2."""
    held = {"tau_pan": constant(K1 * twist + K3 * twist**3)}
    still = simulate(model, 1.0, held, WRAP, {"theta_pan": REST + twist})
    assert still["theta_pan"] == pytest.approx(np.full_like(still.t, REST + twist), abs=1e-10)
    small, frequency = 1e-5, math.sqrt((K1 + 3 * K3 * twist**2) / J)
    start = {"theta_pan": REST + twist + small}
    swing = simulate(model, 2.0, held, WRAP, start, rtol=1e-11, atol=1e-15)
    expected = small * np.cos(frequency * swing.t)
    assert swing["theta_pan"] - REST - twist == pytest.approx(expected, abs=2e-3 * small)


def test_a_purely_cubic_spring_swings_faster_the_wider(model: Model) -> None:
    """Period Gamma(1/4)^2 / sqrt(pi) / amplitude * sqrt(J/k3), here half of it."""
    cubic = WRAP | {"k1_cable_pan": 0.0}
    for amplitude in (0.5, 1.5):
        period = math.gamma(0.25) ** 2 / math.sqrt(math.pi) / amplitude * math.sqrt(J / K3)
        found = simulate(
            model, [0.0, period / 2], None, cubic, {"theta_pan": REST + amplitude}, 1e-11, 1e-13
        )
        assert found["theta_pan"][-1] == pytest.approx(REST - amplitude, abs=1e-8)
        assert found["omega_pan"][-1] == pytest.approx(0.0, abs=1e-7)


def test_the_spring_is_odd_about_its_rest(model: Model) -> None:
    p = model.parameter_vector(WRAP)
    for twist in (0.4, 2.0):
        torque = -(K1 * twist + K3 * twist**3)
        for side in (1.0, -1.0):
            x = np.array([REST + side * twist, 0.0])
            assert J * model.rhs(0.0, x, np.zeros(1), p)[1] == pytest.approx(side * torque)
