"""Constant torque: uniform acceleration, balance with a drive and with the weight of a payload."""

import numpy as np
import pytest

from ptp_symbolic import simulate
from ptp_symbolic.models import emission
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.inputs import constant
from ptp_symbolic.platform import EffectDeclaration, Platform

EFFECTS = (
    EffectDeclaration("rigid_bodies", None, None),
    EffectDeclaration("payload", None, None),
    EffectDeclaration("constant_torque", "tilt", None),
)
PLATFORM = Platform("preload", "Tilt axis with a preload", ("tilt",), 9.81, EFFECTS, (), ())
MASS, ARM, INERTIA, TORQUE = 4.992, 0.1, 6.5e-4 + 6.8e-3, 0.013
BALANCED = {"c_x_payload": 0.0, "tau0_tilt": TORQUE}


@pytest.fixture(scope="module")
def model() -> Model:
    return emission.emit(PLATFORM)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_balanced_axis_accelerates_uniformly(model: Model, sign: float) -> None:
    found = simulate(model, 1.0, parameters=BALANCED | {"tau0_tilt": sign * TORQUE})
    assert found["omega_tilt"] == pytest.approx(sign * TORQUE / INERTIA * found.t, rel=1e-9)
    angle = sign * TORQUE / INERTIA * found.t**2 / 2
    assert found["theta_tilt"] == pytest.approx(angle, rel=1e-9)


def test_an_opposite_drive_torque_cancels_it(model: Model) -> None:
    found = simulate(model, 1.0, {"tau_tilt": constant(-TORQUE)}, BALANCED)
    assert np.ptp(found["theta_tilt"]) == 0.0


def test_a_counterweight_holds_the_payload_where_it_balances_gravity(model: Model) -> None:
    """The weight turns the tilt axis with m g c cos(theta): half of it holds at 60 deg."""
    held = {"tau0_tilt": -MASS * 9.81 * ARM / 2}
    found = simulate(model, 0.5, parameters=held, initial={"theta_tilt": np.pi / 3})
    assert np.ptp(found["theta_tilt"]) < 1e-12
