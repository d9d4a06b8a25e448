"""LuGre friction: elastic and plastic presliding, the Stribeck curve when sliding, passivity."""

import math

import numpy as np
import pytest

from ptp_symbolic import simulate
from ptp_symbolic.models import emission
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.inputs import constant, multisine, ramp
from ptp_symbolic.platform import EffectDeclaration, Platform

EFFECTS = (
    EffectDeclaration("rigid_bodies", None, None),
    EffectDeclaration("lugre_friction", "pan", None),
)
PLATFORM = Platform("bristles", "Pan axis on bristles", ("pan",), 9.81, EFFECTS, (), ())
J, F_C, F_S, V_S, S0, S1, S2 = 0.05, 0.24, 0.65, 0.016, 1000.0, 1.0, 0.7
BRISTLES = {
    "J_pan": J,
    "F_c_pan": F_C,
    "F_s_pan": F_S,
    "v_s_pan": V_S,
    "sigma0_pan": S0,
    "sigma1_pan": S1,
    "sigma2_pan": S2,
}


def curve(rate: float) -> float:
    """Eq. 3 of the reference: Coulomb torque plus what the Stribeck effect adds at slow rates."""
    return F_C + (F_S - F_C) * math.exp(-((rate / V_S) ** 2))


@pytest.fixture(scope="module")
def model() -> Model:
    return emission.emit(PLATFORM)


@pytest.mark.parametrize("rate", [0.004, -0.02, 0.3])
def test_steady_sliding_takes_the_torque_of_the_stribeck_curve(model: Model, rate: float) -> None:
    torque = math.copysign(curve(rate), rate) + S2 * rate
    start = {"omega_pan": rate, "bristle_pan": math.copysign(curve(rate), rate) / S0}
    found = simulate(model, 0.02, {"tau_pan": constant(torque)}, BRISTLES, start)
    assert found["omega_pan"] == pytest.approx([rate] * len(found.t), rel=1e-6)
    assert found["bristle_pan"] == pytest.approx([start["bristle_pan"]] * len(found.t), rel=1e-6)


def test_a_small_bend_swings_back_like_a_damped_spring(model: Model) -> None:
    """Stiffness sigma0, damping sigma1 + sigma2, as long as the bend is far below F_s/sigma0."""
    bend = 1e-8
    decay = (S1 + S2) / (2 * J)
    frequency = math.sqrt(S0 / J - decay**2)
    start = {"theta_pan": bend, "bristle_pan": bend}
    found = simulate(model, 0.1, None, BRISTLES, start, rtol=1e-10, atol=1e-17)
    wave = np.cos(frequency * found.t) + decay / frequency * np.sin(frequency * found.t)
    expected = bend * np.exp(-decay * found.t) * wave
    assert found["theta_pan"] == pytest.approx(expected, abs=1e-4 * bend)


def test_slow_loading_bends_along_dahls_curve(model: Model) -> None:
    """Torque F_s (1 - exp(-sigma0 theta/F_s)) where inertia, damping and Stribeck do nothing."""
    torque, duration = 0.5, 20.0
    slow = BRISTLES | {"J_pan": 1e-3, "v_s_pan": 10.0, "sigma1_pan": 0.1, "sigma2_pan": 0.0}
    driven = {"tau_pan": ramp(0.0, torque, 0.0, duration)}
    found = simulate(model, np.linspace(0.0, duration, 6), driven, slow)
    loads = torque * found.t / duration
    bends = -F_S / S0 * np.log1p(-loads / F_S)
    assert found["theta_pan"][1:] == pytest.approx(bends[1:], rel=1e-3)
    assert found["bristle_pan"][1:] == pytest.approx(loads[1:] / S0, rel=1e-3)


def test_energy_only_leaves_when_the_condition_for_passivity_holds(model: Model) -> None:
    """sigma2 >= sigma1 (F_s - F_c)/F_c; Barabanov and Ortega (2000). Bend at most F_s/sigma0."""
    passive = BRISTLES | {"sigma2_pan": S1 * (F_S - F_C) / F_C}
    driven = {"tau_pan": multisine([0.9, 0.5], [1.1, 6.7])}
    found = simulate(model, 2.0, driven, passive)
    assert np.all(np.diff(found.dissipated) >= -1e-12)
    assert np.all(np.abs(found["bristle_pan"]) <= F_S / S0)
    assert np.ptp(found["theta_pan"]) > 10 * F_S / S0
    stored = J / 2 * found["omega_pan"] ** 2 + S0 / 2 * found["bristle_pan"] ** 2
    assert stored == pytest.approx(found.supplied - found.dissipated, abs=1e-7)
