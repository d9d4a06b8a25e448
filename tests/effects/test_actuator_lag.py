"""An actuator of first order: its step response, its gain and phase, and the work that it does."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from ptp_symbolic import inverse_dynamics, simulate
from ptp_symbolic.models import emission
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.inputs import constant, multisine, ramp
from ptp_symbolic.platform import EffectDeclaration, Platform

BODY = EffectDeclaration("rigid_bodies", None, None)
J, B, T = 0.05, 0.3, 0.02
LAG = {"J_pan": J, "t_actuator_pan": T}


def machine(*effects: str) -> Model:
    own = tuple(EffectDeclaration(e, "pan", None) for e in effects)
    return emission.emit(
        Platform("lag", "Pan axis behind a lag", ("pan",), 9.81, (BODY, *own), (), ())
    )


@pytest.fixture(scope="module")
def model() -> Model:
    return machine("actuator_lag")


@pytest.mark.parametrize("torque", [0.8, -0.05])
def test_a_step_comes_up_as_an_exponential(model: Model, torque: float) -> None:
    found = simulate(model, 0.2, {"tau_pan": constant(torque)}, LAG)
    up = 1.0 - np.exp(-found.t / T)
    assert found["tau_actuator_pan"] == pytest.approx(torque * up, rel=1e-6, abs=1e-10)
    assert found["omega_pan"] == pytest.approx(torque / J * (found.t - T * up), rel=1e-6, abs=1e-9)
    assert found.supplied == pytest.approx(J / 2 * found["omega_pan"] ** 2, abs=1e-7)


def test_a_sine_comes_through_smaller_and_late(model: Model) -> None:
    """Gain 1/sqrt(1 + (w T)^2) and phase -atan(w T), once the start is forgotten."""
    frequency = 12.0
    found = simulate(
        model, np.linspace(0.0, 1.0, 401), {"tau_pan": multisine([0.7], [frequency])}, LAG
    )
    late = found.t > 20.0 * T
    angle = 2.0 * math.pi * frequency
    wave = 0.7 * np.sin(angle * found.t - math.atan(angle * T)) / math.hypot(1.0, angle * T)
    assert found["tau_actuator_pan"][late] == pytest.approx(wave[late], abs=1e-6)


def test_inverse_dynamics_gives_the_torque_that_acts() -> None:
    own = tuple(EffectDeclaration(e, "pan", None) for e in ("torque_saturation", "actuator_lag"))
    platform = Platform("lag", "Pan axis behind a lag", ("pan",), 9.81, (BODY, *own), (), ())
    motion = ([[0.0]], [[1.0]], [[2.0]])
    assert inverse_dynamics(platform, motion, {"J_pan": J}) == pytest.approx(np.array([[2.0 * J]]))


def test_the_actuator_lags_a_command_that_ends_at_a_ceiling() -> None:
    """SciPy integrates the two first-order equations and the powers; torque and motion agree."""
    limit, slope = 0.5, 10.0
    model = machine("viscous_friction", "torque_saturation", "actuator_lag")
    values = LAG | {"b_pan": B, "tau_max_pan": limit}
    times = np.linspace(0.0, 0.4, 41)
    found = simulate(model, times, {"tau_pan": ramp(0.0, 4.0, 0.0, 0.4)}, values, rtol=1e-9)

    def slopes(t: float, y: np.ndarray) -> list[float]:
        torque, rate = y[:2]
        command = min(slope * t, limit)
        return [(command - torque) / T, (torque - B * rate) / J, torque * rate, B * rate**2]

    own = solve_ivp(
        slopes, (0.0, 0.4), np.zeros(4), t_eval=times, rtol=1e-11, atol=1e-12, max_step=1e-3
    )
    for values_found, expected in zip(
        (found["tau_actuator_pan"], found["omega_pan"], found.supplied, found.dissipated),
        own.y,
        strict=True,
    ):
        assert values_found == pytest.approx(expected, abs=1e-6)


def test_a_motor_behind_a_slow_amplifier() -> None:
    """SciPy integrates voltage, current and rate of a rotor on its gear."""
    lag, volts = 0.03, 6.0
    effects = (
        BODY,
        EffectDeclaration("dc_motor", "pan", None),
        EffectDeclaration("actuator_lag", "pan", None, "voltage"),
    )
    model = emission.emit(Platform("lag", "Slow amplifier", ("pan",), 9.81, effects, (), ()))
    own = {"L": 7e-3, "R": 12.9, "K_t": 0.0724, "J_motor": 1.1e-5, "N": 500.0}
    values = {f"{n}_pan": v for n, v in own.items()} | {"J_pan": J, "t_actuator_pan": lag}
    times = np.linspace(0.0, 0.3, 31)
    found = simulate(model, times, {"u_pan": constant(volts)}, values, rtol=1e-9)
    inertia = J + own["J_motor"] * own["N"] ** 2

    def slopes(t: float, y: np.ndarray) -> list[float]:
        voltage, current, rate = y
        back = own["K_t"] * own["N"] * rate
        pushed = own["K_t"] * own["N"] * current / inertia
        return [(volts - voltage) / lag, (voltage - own["R"] * current - back) / own["L"], pushed]

    ends = (0.0, 0.3)
    known = solve_ivp(slopes, ends, np.zeros(3), "Radau", times, rtol=1e-10, atol=1e-12).y
    assert found["u_actuator_pan"] == pytest.approx(known[0], abs=1e-6)
    assert found["i_pan"] == pytest.approx(known[1], abs=1e-7)
    assert found["omega_pan"] == pytest.approx(known[2], abs=1e-7)
