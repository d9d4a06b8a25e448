"""Friction that grows with the load: lifting, lowering and breaking away under a known torque."""

import math

import pytest
from scipy.optimize import brentq

from ptp_symbolic import simulate
from ptp_symbolic.models import emission
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.inputs import constant, ramp
from ptp_symbolic.platform import EffectDeclaration, Platform

BODY = EffectDeclaration("rigid_bodies", None, None)
GEARED = tuple(
    EffectDeclaration(e, "pan", "gear" if e == "csvs_friction" else None)
    for e in (
        "dc_motor",
        "shaft_compliance",
        "csvs_friction",
        "load_dependent_friction",
        "constant_torque",
    )
)
RIGID = tuple(
    EffectDeclaration(e, "pan", None) for e in ("csvs_friction", "load_dependent_friction")
)
R, L, GAIN, SHAFT = 12.9, 6.9e-3, 0.0724 * 500.0, 5000.0
DRY, MU, LOAD = 0.6, 0.08, 9.0
GEAR = {
    "J_pan": 0.05,
    "F_c_pan": DRY,
    "F_s_pan": DRY,
    "F_v_pan": 0.0,
    "mu_load_pan": MU,
    "tau0_pan": -LOAD,
    "k_shaft_pan": SHAFT,
    "d_shaft_pan": 5.0,
}
SAGGED = {"theta_pan": -LOAD / SHAFT}


@pytest.fixture(scope="module")
def geared() -> Model:
    return emission.emit(Platform("load", "", ("pan",), 9.81, (BODY, *GEARED), (), ()))


@pytest.fixture(scope="module")
def rigid() -> Model:
    return emission.emit(Platform("load", "", ("pan",), 9.81, (BODY, *RIGID), (), ()))


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_lifting_takes_the_load_and_its_friction_lowering_takes_less(
    geared: Model, sign: float
) -> None:
    """The gear carries the load both ways; its friction F_c + mu load turns with the motion."""
    volts = 12.0 * sign
    current = (LOAD + sign * (DRY + MU * LOAD)) / GAIN
    start = SAGGED | {"omega_pan": 0.3 * sign, "omega_gear_pan": 0.3 * sign}
    found = simulate(geared, [0.0, 3.0], {"u_pan": constant(volts)}, GEAR, start)
    assert found["i_pan"][-1] == pytest.approx(current, rel=1e-6)
    assert found["omega_pan"][-1] == pytest.approx((volts - R * current) / GAIN, rel=1e-6)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_loaded_gear_breaks_away_beyond_its_load(geared: Model, sign: float) -> None:
    """A voltage ramp about the balance of the load; its current comes through R and L."""
    hold, slope = R * LOAD / GAIN, 1.0 * sign
    driven = {"u_pan": ramp(hold, hold + slope, 0.0, 1.0)}
    start = SAGGED | {"i_pan": LOAD / GAIN}
    found = simulate(geared, 1.0, driven, GEAR, start)

    def margin(t: float) -> float:
        return GAIN / R * (t - L / R * (1.0 - math.exp(-t * R / L))) - (DRY + MU * LOAD)

    assert found.events[0].time == pytest.approx(brentq(margin, 0.0, 1.0), abs=1e-6)


def test_a_directly_driven_axis_brakes_its_own_torque(rigid: Model) -> None:
    """Breaks away at F_s/(1 - mu); then J w' = tau (1 - mu) - F_c, and less when braked."""
    inertia = 0.05
    body = {"J_pan": inertia, "F_c_pan": DRY, "F_s_pan": DRY, "F_v_pan": 0.0, "mu_load_pan": MU}
    found = simulate(rigid, 1.0, {"tau_pan": ramp(0.0, 1.0, 0.0, 1.0)}, body)
    away = DRY / (1 - MU)
    assert found.events[0].time == pytest.approx(away, abs=1e-8)
    gained = ((1 - MU) * (1 - away**2) / 2 - DRY * (1 - away)) / inertia
    assert found["omega_pan"][-1] == pytest.approx(gained, rel=1e-6)
    braked = simulate(rigid, 0.1, {"tau_pan": constant(-2.0)}, body, {"omega_pan": 8.0})
    lost = (2.0 * (1 + MU) + DRY) * 0.1 / inertia
    assert braked["omega_pan"][-1] == pytest.approx(8.0 - lost, rel=1e-7)
