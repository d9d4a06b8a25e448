"""End stops: depth and rebound of a strike, bouncing between both, rest against a stop."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from ptp_symbolic import simulate
from ptp_symbolic.errors import InputError
from ptp_symbolic.models import emission
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.inputs import constant, multisine
from ptp_symbolic.platform import EffectDeclaration, Platform

EFFECTS = (
    EffectDeclaration("rigid_bodies", None, None),
    EffectDeclaration("end_stop", "pan", None),
)
PLATFORM = Platform("stops", "Pan axis between stops", ("pan",), 9.81, EFFECTS, (), ())
J, K, C, UPPER, LOWER = 0.05, 400.0, 0.4, 0.3, -0.2
STOPS = {
    "J_pan": J,
    "k_stop_pan": K,
    "c_stop_pan": C,
    "theta_stop_upper_pan": UPPER,
    "theta_stop_lower_pan": LOWER,
}


def spent(rate: float) -> float:
    """Integral of w / (1 + c w): k/(2 J) times depth squared between two rates in one strike."""
    return rate / C - math.log1p(C * rate) / C**2


@pytest.fixture(scope="module")
def model() -> Model:
    return emission.emit(PLATFORM)


@pytest.mark.parametrize("speed", [0.5, 3.0])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_strike_goes_as_deep_and_comes_back_as_fast_as_the_phase_plane_says(
    model: Model, speed: float, sign: float
) -> None:
    """J w dw = -k d (1 + c w) dd separates: depth and rebound follow from integrals of the rate.
    What the ledger keeps in the spring and what is lost follow from both.
    """
    stop = UPPER if sign > 0.0 else LOWER
    start = {"theta_pan": stop, "omega_pan": sign * speed}
    times = np.linspace(0.0, 0.08, 801)
    found = simulate(model, times, None, STOPS, start, rtol=1e-10, atol=1e-12)
    depth = sign * (found["theta_pan"] - stop)
    deepest = math.sqrt(2.0 * J / K * spent(speed))
    back = brentq(lambda w: spent(-w) - spent(speed), 0.0, min(speed, 0.999999 / C))
    assert depth.max() == pytest.approx(deepest, rel=1e-4)
    assert sign * found["omega_pan"][-1] == pytest.approx(-back, rel=1e-6)
    at = int(np.argmax(depth))
    lost = J / 2.0 * speed**2 - K / 2.0 * deepest**2
    assert found.dissipated[at] == pytest.approx(lost, rel=1e-3)
    assert found.dissipated[-1] == pytest.approx(J / 2.0 * (speed**2 - back**2), rel=1e-6)
    assert found.stored[at] == pytest.approx(K / 2.0 * deepest**2, rel=1e-3)
    assert np.all(np.diff(found.dissipated) >= -1e-12)


def test_a_joint_driven_to_and_fro_bounces_between_both(model: Model) -> None:
    """SciPy integrates the torque of the reference, clipped where it would pull, and the powers."""
    amplitude, frequency = 1.5, 1.3
    times = np.linspace(0.0, 1.5, 61)

    def push(depth: float, sinking: float) -> float:
        return K * depth * max(1.0 + C * sinking, 0.0) if depth > 0.0 else 0.0

    def slopes(t: float, y: np.ndarray) -> list[float]:
        q, w = y[:2]
        tau = amplitude * math.sin(2.0 * math.pi * frequency * t)
        stop = push(LOWER - q, -w) - push(q - UPPER, w)
        spring = K * max(LOWER - q, 0.0) - K * max(q - UPPER, 0.0)
        return [w, (tau + stop) / J, tau * w, -(stop - spring) * w]

    own = solve_ivp(
        slopes, (0.0, 1.5), np.zeros(4), t_eval=times, rtol=1e-11, atol=1e-12, max_step=5e-4
    )
    driven = {"tau_pan": multisine([amplitude], [frequency])}
    found = simulate(model, times, driven, STOPS, rtol=1e-10, atol=1e-12)
    assert own.y[0].max() > UPPER
    assert own.y[0].min() < LOWER
    assert found["theta_pan"] == pytest.approx(own.y[0], abs=1e-5)
    assert found["omega_pan"] == pytest.approx(own.y[1], abs=1e-3)
    assert found.supplied == pytest.approx(own.y[2], abs=1e-4)
    assert found.dissipated == pytest.approx(own.y[3], abs=1e-4)


@pytest.mark.parametrize("torque", [0.8, -0.8])
def test_a_torque_holds_the_joint_beyond_the_stop_by_its_share_of_the_stiffness(
    model: Model, torque: float
) -> None:
    soft = STOPS | {"c_stop_pan": 5.0}
    stop = UPPER if torque > 0.0 else LOWER
    start = {"theta_pan": stop + 1.1 * torque / K}
    found = simulate(model, [0.0, 400.0], {"tau_pan": constant(torque)}, soft, start)
    assert found["theta_pan"][-1] == pytest.approx(stop + torque / K, abs=2e-5)


def test_stops_that_cross_are_refused(model: Model) -> None:
    with pytest.raises(InputError, match="the lower stop lies below the upper; change one angle"):
        simulate(model, 0.1, None, STOPS | {"theta_stop_upper_pan": -0.5})
