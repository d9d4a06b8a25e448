"""Friction that depends on the angle: breakaway at an angle, braking work, and no force at rest."""

import math

import numpy as np
import pytest

from ptp_symbolic import simulate
from ptp_symbolic.models import emission
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.inputs import constant, ramp
from ptp_symbolic.platform import EffectDeclaration, Platform

EFFECTS = (
    EffectDeclaration("rigid_bodies", None, None),
    EffectDeclaration("csvs_friction", "pan", None),
    EffectDeclaration("position_dependent_friction", "pan", None),
)
PLATFORM = Platform("uneven", "Pan axis with uneven friction", ("pan",), 9.81, EFFECTS, (), ())
J, DRY, SIN, COS = 0.05, 0.3, 0.4, -0.25
UNEVEN = {
    "J_pan": J,
    "F_c_pan": DRY,
    "F_s_pan": DRY,
    "F_v_pan": 0.0,
    "f_sin_pan": SIN,
    "f_cos_pan": COS,
}


def friction(angle: float | np.ndarray) -> float | np.ndarray:
    return DRY * (1.0 + SIN * np.sin(angle) + COS * np.cos(angle))


@pytest.fixture(scope="module")
def model() -> Model:
    return emission.emit(PLATFORM)


@pytest.mark.parametrize("angle", [-2.0, 0.0, 0.9, 4.0])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_breakaway_is_that_of_the_angle_both_ways(model: Model, angle: float, sign: float) -> None:
    driven = {"tau_pan": ramp(0.0, sign, 0.0, 1.0)}
    found = simulate(model, 0.6, driven, UNEVEN, {"theta_pan": angle})
    assert found.events[0].time == pytest.approx(friction(angle), abs=1e-8)


def test_static_friction_goes_with_the_angle_by_the_same_share(model: Model) -> None:
    """What presses the surfaces together is in both levels: F = mu N."""
    static = UNEVEN | {"F_s_pan": 2.0 * DRY}
    found = simulate(model, 0.9, {"tau_pan": ramp(0.0, 1.0, 0.0, 1.0)}, static, {"theta_pan": 0.9})
    assert found.events[0].time == pytest.approx(2.0 * friction(0.9), abs=1e-8)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_coasting_loses_the_work_of_friction_along_the_way(model: Model, sign: float) -> None:
    """Half J w^2 falls by the integral of F over the angle, whatever the direction; then rest."""
    start, rate = 0.5, 5.0 * sign
    moving = {"theta_pan": start, "omega_pan": rate}
    found = simulate(model, 2.0, None, UNEVEN, moving, rtol=1e-11)
    angle = found["theta_pan"]
    way = angle - start
    sine, cosine = np.cos(start) - np.cos(angle), np.sin(angle) - np.sin(start)
    work = DRY * (way + SIN * sine + COS * cosine)
    energy = J / 2 * rate**2 - sign * work
    assert J / 2 * found["omega_pan"] ** 2 == pytest.approx(energy, abs=1e-8)
    assert [event.mode for event in found.events] == ["sticks"]
    assert math.isclose(energy[-1], 0.0, abs_tol=1e-8)
    assert abs(way[-1]) > 1.0


@pytest.mark.parametrize("torque", [0.0, 0.05])
def test_friction_that_changes_more_than_its_mean_never_drives(model: Model, torque: float) -> None:
    """Where the law would turn negative the surfaces are free: what moves it is the torque."""
    patchy = UNEVEN | {"f_sin_pan": 3.0, "f_cos_pan": 0.0}
    start = {"theta_pan": -1.5}
    found = simulate(model, 0.1, {"tau_pan": constant(torque)}, patchy, start)
    assert found["omega_pan"] == pytest.approx(torque / J * found.t, abs=1e-8)
    assert found.dissipated[-1] >= 0.0
