"""Flexible shaft: two masses that swing against each other, and what its damper takes."""

import numpy as np
import pytest
import sympy as sp

from ptp_symbolic import simulate
from ptp_symbolic.models import emission
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.platform import EffectDeclaration, Platform
from ptp_symbolic.symbolic.derivation.assembly import assemble

EFFECTS = (
    EffectDeclaration("rigid_bodies", None, None),
    EffectDeclaration("dc_motor", "pan", None),
    EffectDeclaration("shaft_compliance", "pan", None),
)
PLATFORM = Platform("shaft", "Pan axis behind a shaft", ("pan",), 9.81, EFFECTS, (), ())
# Table 5.7; the torque constant is next to nothing, so that rotor and load swing freely.
J_GEAR, J_LOAD, K = 1.1e-5 * 500.0**2, 0.05, 5000.0
FREE = {"J_pan": J_LOAD, "K_t_pan": 1e-9, "k_shaft_pan": K, "d_shaft_pan": 0.0}
TWIST, SPIN = 1e-3, 0.5
START = {"theta_gear_pan": TWIST, "omega_gear_pan": SPIN, "omega_pan": SPIN}


@pytest.fixture(scope="module")
def model() -> Model:
    return emission.emit(PLATFORM)


def test_torque_opposes_twist_and_relative_speed() -> None:
    """Eq. 2.15 with erratum 4, the same on both ends."""
    k, d = sp.symbols("k_shaft_pan d_shaft_pan", real=True)
    gear, load = sp.symbols("theta_gear_pan theta_pan", real=True)
    gear_rate, load_rate, i = sp.symbols("omega_gear_pan omega_pan i_pan", real=True)
    motor = sp.Symbol("N_pan", real=True) * sp.Symbol("K_t_pan", real=True) * i
    torque = k * (gear - load) + d * (gear_rate - load_rate)
    on_load, on_gear = assemble(PLATFORM).forcing
    assert sp.expand(on_load - torque) == 0
    assert sp.expand(on_gear - (motor - torque)) == 0


def test_free_frequency_of_two_masses(model: Model) -> None:
    frequency = np.sqrt(K * (1 / J_GEAR + 1 / J_LOAD))
    found = simulate(model, 0.1, parameters=FREE, initial=START, rtol=1e-11, atol=1e-13)
    twist = found["theta_gear_pan"] - found["theta_pan"]
    assert twist == pytest.approx(TWIST * np.cos(frequency * found.t), abs=1e-7 * TWIST)
    centre = (J_GEAR * found["theta_gear_pan"] + J_LOAD * found["theta_pan"]) / (J_GEAR + J_LOAD)
    drift = J_GEAR * TWIST / (J_GEAR + J_LOAD) + SPIN * found.t
    assert centre == pytest.approx(drift, abs=1e-10)


def test_damped_swing(model: Model) -> None:
    """Decay d/(2 mu) with the reduced inertia mu."""
    damping, reduced = 2.0, J_GEAR * J_LOAD / (J_GEAR + J_LOAD)
    decay = damping / (2 * reduced)
    frequency = np.sqrt(K / reduced - decay**2)
    found = simulate(
        model,
        0.1,
        parameters=FREE | {"d_shaft_pan": damping},
        initial=START,
        rtol=1e-11,
        atol=1e-13,
    )
    wave = np.cos(frequency * found.t) + decay / frequency * np.sin(frequency * found.t)
    twist = found["theta_gear_pan"] - found["theta_pan"]
    assert twist == pytest.approx(TWIST * np.exp(-decay * found.t) * wave, abs=1e-7 * TWIST)
