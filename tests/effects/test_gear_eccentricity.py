"""Gear out of true: the joint leads and lags the gear once per turn, and no energy is lost."""

import numpy as np
import pytest

from ptp_symbolic import simulate
from ptp_symbolic.models import emission
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.platform import EffectDeclaration, Platform

EFFECTS = (
    EffectDeclaration("rigid_bodies", None, None),
    *(
        EffectDeclaration(e, "pan", None)
        for e in (
            "viscous_friction",
            "dc_motor",
            "shaft_compliance",
            "backlash",
            "gear_eccentricity",
        )
    ),
)
PLATFORM = Platform("wheel", "Pan axis with a gear out of true", ("pan",), 9.81, EFFECTS, (), ())
# The torque constant is next to nothing, so that rotor and load move freely.
J_GEAR, J_LOAD, K, GAP = 2.75, 0.05, 5000.0, 0.02
SIN, COS = 0.008, -0.006
WHEEL = {
    "J_pan": J_LOAD,
    "b_pan": 0.0,
    "K_t_pan": 1e-9,
    "J_motor_pan": J_GEAR / 500.0**2,
    "k_shaft_pan": K,
    "d_shaft_pan": 0.0,
    "gap_pan": GAP,
    "g_sin_pan": SIN,
    "g_cos_pan": COS,
}


def error(angle: float | np.ndarray) -> float | np.ndarray:
    return SIN * np.sin(angle) + COS * np.cos(angle)


@pytest.fixture(scope="module")
def model() -> Model:
    return emission.emit(PLATFORM)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_flywheel_drags_the_joint_through_the_error_of_every_turn(
    model: Model, sign: float
) -> None:
    """Behind the face by the twist b w/k: an error of 0.01 rad, once per turn."""
    rate, damping = 0.8 * sign, 1.0
    heavy = WHEEL | {"J_motor_pan": 100.0, "b_pan": damping, "d_shaft_pan": 1.0}
    behind = sign * GAP / 2 + damping * rate / K
    start = {
        "omega_gear_pan": rate,
        "omega_pan": rate * (1 + SIN),
        "theta_pan": COS - behind,
    }
    found = simulate(model, np.linspace(0.0, 16.0, 161), None, heavy, start)
    gear = found["theta_gear_pan"]
    assert gear == pytest.approx(rate * found.t, abs=1e-5)
    lead = found["theta_pan"] - gear + behind
    assert lead == pytest.approx(error(gear), abs=5e-6)
    assert np.ptp(lead) == pytest.approx(0.02, rel=2e-3)
    assert found.events == ()


@pytest.mark.parametrize("gear", [-2.0, 0.3, 1.7])
@pytest.mark.parametrize(("beyond", "side"), [(-1e-6, 1.0), (1e-3, 1.0), (1e-3, -1.0)])
def test_the_gap_lies_about_the_error(
    model: Model, gear: float, beyond: float, side: float
) -> None:
    """The reaction on the gear carries its slope, so that power in equals power out."""
    names = model.state_names
    x = np.zeros(len(names))
    x[names.index("theta_gear_pan")] = gear
    x[names.index("theta_pan")] = gear + error(gear) - side * (GAP / 2 + beyond)
    dx = model.rhs(0.0, x, np.zeros(1), model.parameter_vector(WHEEL))
    torque, slope = side * K * max(beyond, 0.0), 1 + SIN * np.cos(gear) - COS * np.sin(gear)
    assert J_LOAD * dx[names.index("omega_pan")] == pytest.approx(torque, abs=1e-9)
    assert J_GEAR * dx[names.index("omega_gear_pan")] == pytest.approx(-slope * torque, abs=1e-9)


def test_energy_stays_while_the_load_rattles(model: Model) -> None:
    large = WHEEL | {"g_sin_pan": 0.16, "g_cos_pan": -0.12}
    start = {"omega_gear_pan": 2.0, "theta_pan": -0.12}
    found = simulate(model, 2.0, None, large, start, rtol=1e-11, atol=1e-12)
    gear = found["theta_gear_pan"]
    twist = gear + 20 * error(gear) - found["theta_pan"]
    beyond = np.maximum(np.abs(twist) - GAP / 2, 0.0)
    energy = J_GEAR / 2 * found["omega_gear_pan"] ** 2 + J_LOAD / 2 * found["omega_pan"] ** 2
    assert energy + K / 2 * beyond**2 == pytest.approx([J_GEAR / 2 * 4.0] * len(gear), abs=1e-6)
    assert len(found.events) > 4
