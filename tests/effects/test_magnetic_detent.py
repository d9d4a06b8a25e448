"""A magnetic detent: a Gaussian well, its small swing, what it takes to get out, a driven run."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from ptp_symbolic import simulate
from ptp_symbolic.models import emission
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.platform import EffectDeclaration, Platform

EFFECTS = (
    EffectDeclaration("rigid_bodies", None, None),
    EffectDeclaration("magnetic_detent", "pan", None),
)
PLATFORM = Platform("detent", "Pan axis with a detent", ("pan",), 9.81, EFFECTS, (), ())
INERTIA, TORQUE, CENTRE, WIDTH = 0.02, 0.4, 0.3, 0.05
VALUES = {
    "J_pan": INERTIA,
    "T_detent_pan": TORQUE,
    "theta_detent_pan": CENTRE,
    "w_detent_pan": WIDTH,
}
DEPTH = TORQUE * WIDTH * math.sqrt(math.e)  # J; the integral of the torque from far away


@pytest.fixture(scope="module")
def model() -> Model:
    return emission.emit(PLATFORM)


def acceleration(angle: float) -> float:
    """Slope of the well over the inertia, from its depth and width alone."""
    off = angle - CENTRE
    return -DEPTH * off / WIDTH**2 * math.exp(-0.5 * (off / WIDTH) ** 2) / INERTIA


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_the_largest_torque_is_at_the_width_and_pulls_back(model: Model, side: float) -> None:
    p = model.parameter_vector(VALUES)
    at = [CENTRE + side * WIDTH * share for share in (0.9, 1.0, 1.1)]
    torques = [-side * INERTIA * model.rhs(0.0, np.array([a, 0.0]), np.zeros(1), p)[1] for a in at]
    assert torques[1] == pytest.approx(TORQUE, rel=1e-12)
    assert max(torques) == torques[1]


def test_a_small_swing_has_the_frequency_of_the_bottom(model: Model) -> None:
    swing = 1e-6
    frequency = math.sqrt(TORQUE * math.sqrt(math.e) / (WIDTH * INERTIA))
    start = {"theta_pan": CENTRE + swing}
    found = simulate(model, 2.0, None, VALUES, start, rtol=1e-11, atol=1e-15)
    expected = CENTRE + swing * np.cos(frequency * found.t)
    assert found["theta_pan"] == pytest.approx(expected, abs=1e-4 * swing)


@pytest.mark.parametrize(("share", "leaves"), [(0.999, False), (1.001, True)])
def test_it_takes_the_depth_of_the_well_to_leave_it(
    model: Model, share: float, leaves: bool
) -> None:
    escape = math.sqrt(2.0 * DEPTH / INERTIA)
    start = {"theta_pan": CENTRE, "omega_pan": share * escape}
    found = simulate(model, 3.0, None, VALUES, start, rtol=1e-10, atol=1e-12)
    assert (found["theta_pan"][-1] > CENTRE + 6.0 * WIDTH) == leaves
    assert np.ptp(found.stored) <= 1e-8 * DEPTH


def test_a_driven_run_against_another_integrator(model: Model) -> None:
    def slope(t: float, x: np.ndarray) -> list[float]:
        driving = 0.3 * math.sin(2.0 * math.pi * 1.7 * t)
        return [x[1], acceleration(x[0]) + driving / INERTIA]

    times = np.linspace(0.0, 1.5, 301)
    truth = solve_ivp(slope, (0.0, 1.5), [0.1, 0.0], "DOP853", times, rtol=1e-11, atol=1e-13)
    found = simulate(
        model, times, {"tau_pan": "multisine:0.3@1.7"}, VALUES, {"theta_pan": 0.1}, rtol=1e-10
    )
    assert found["theta_pan"] == pytest.approx(truth.y[0], abs=1e-6)
