"""Backlash: the dead zone of Eq. 2.16, the way lost in it, and an impact across it."""

import math

import numpy as np
import pytest

from ptp_symbolic import simulate
from ptp_symbolic.models import emission
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.platform import EffectDeclaration, Platform
from ptp_symbolic.symbolic.derivation.assembly import assemble

EFFECTS = (
    EffectDeclaration("rigid_bodies", None, None),
    EffectDeclaration("dc_motor", "pan", None),
    EffectDeclaration("shaft_compliance", "pan", None),
    EffectDeclaration("backlash", "pan", None),
)
PLATFORM = Platform("play", "Pan axis with play", ("pan",), 9.81, EFFECTS, (), ())
# Table 5.7; the torque constant is next to nothing, so that rotor and load move freely.
GAP, K, J_GEAR, J_LOAD = math.radians(1.49), 5000.0, 1.1e-5 * 500.0**2, 0.05
FREE = {
    "J_pan": J_LOAD,
    "K_t_pan": 1e-9,
    "k_shaft_pan": K,
    "d_shaft_pan": 0.0,
    "gap_pan": GAP,
}
FACES = {1.0: "upper", -1.0: "lower"}


@pytest.fixture(scope="module")
def model() -> Model:
    return emission.emit(PLATFORM)


def test_default_gap_is_the_mean_reading_of_table_5_7() -> None:
    (gap,) = [p for p in assemble(PLATFORM).parameters if p.name == "gap_pan"]
    assert gap.default == pytest.approx(GAP, abs=1e-6)


@pytest.mark.parametrize("beyond", [-2e-3, -1e-9, 1e-9, 2e-3])
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_torque_is_the_dead_zone_of_equation_2_16(model: Model, side: float, beyond: float) -> None:
    names = model.state_names
    x = np.zeros(len(names))
    x[names.index("theta_gear_pan")] = side * (GAP / 2 + beyond)
    dx = model.rhs(0.0, x, np.zeros(1), model.parameter_vector(FREE))
    torque = side * K * max(beyond, 0.0)
    assert J_LOAD * dx[names.index("omega_pan")] == pytest.approx(torque, rel=1e-6, abs=1e-15)
    assert J_GEAR * dx[names.index("omega_gear_pan")] == pytest.approx(-torque, rel=1e-6, abs=1e-9)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_lost_motion_is_the_whole_gap(model: Model, side: float) -> None:
    """From just inside one face to the other at a steady rate, while the load stands still."""
    rate, inside = 0.2, 1e-9
    start = {"theta_gear_pan": -side * (GAP / 2 - inside), "omega_gear_pan": side * rate}
    found = simulate(model, 0.2, parameters=FREE, initial=start)
    first = found.events[0]
    assert first.mode == f"touches the {FACES[side]} face"
    assert first.time == pytest.approx((GAP - inside) / rate, abs=1e-7)
    before = found.t < first.time
    assert np.all(found["theta_pan"][before] == 0.0)
    assert side * found["omega_pan"][-1] > 0.0


def test_an_undamped_impact_gives_all_energy_back(model: Model) -> None:
    """Half a swing in contact (erratum 26), then the rates of the elastic impact."""
    rate, total = 0.2, J_GEAR + J_LOAD
    start = {"theta_gear_pan": GAP / 2 - 1e-4, "omega_gear_pan": rate}
    found = simulate(model, 0.03, parameters=FREE, initial=start, rtol=1e-10, atol=1e-12)
    touch, leave = found.events[:2]
    half_swing = math.pi / math.sqrt(K * (1 / J_GEAR + 1 / J_LOAD))
    assert leave.time - touch.time == pytest.approx(half_swing, abs=1e-7)
    assert found["omega_gear_pan"][-1] == pytest.approx(rate * (J_GEAR - J_LOAD) / total, rel=1e-6)
    assert found["omega_pan"][-1] == pytest.approx(rate * 2 * J_GEAR / total, rel=1e-6)
