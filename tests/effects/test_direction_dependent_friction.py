"""Friction by direction: both columns of Table 4.1 from their means and half differences."""

import math

import pytest

from ptp_symbolic import simulate
from ptp_symbolic.models import emission
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.inputs import constant, ramp
from ptp_symbolic.platform import EffectDeclaration, Platform

EFFECTS = (
    EffectDeclaration("rigid_bodies", None, None),
    EffectDeclaration("csvs_friction", "pan", None),
    EffectDeclaration("direction_dependent_friction", "pan", None),
)
PLATFORM = Platform("both_ways", "Friction by direction", ("pan",), 9.81, EFFECTS, (), ())
# Table 4.1: F_c, F_s in N m, v_s in rad/s, F_v in N m s/rad.
NAMES = ("F_c", "F_s", "v_s", "F_v")
FORWARD = (0.2267, 0.5578, 0.0159, 13.5844)
BACKWARD = (0.2535, 0.7922, 0.0161, 14.3004)
PARAMETERS = {"J_pan": 0.05}
for name, f, b in zip(NAMES, FORWARD, BACKWARD, strict=True):
    PARAMETERS |= {f"{name}_pan": (f + b) / 2, f"a_{name}_pan": (f - b) / (f + b)}


@pytest.fixture(scope="module")
def model() -> Model:
    return emission.emit(PLATFORM)


@pytest.mark.parametrize("rate", [0.005, -0.005, 0.03, -0.03, 0.4, -0.4])
def test_each_direction_has_its_own_column_of_table_4_1(model: Model, rate: float) -> None:
    coulomb, static, stribeck, viscous = FORWARD if rate > 0 else BACKWARD
    level = coulomb + (static - coulomb) * math.exp(-((rate / stribeck) ** 2))
    torque = math.copysign(level, rate) + viscous * rate
    found = simulate(model, 0.05, {"tau_pan": constant(torque)}, PARAMETERS, {"omega_pan": rate})
    assert found["omega_pan"] == pytest.approx([rate] * len(found.t), rel=1e-9)


@pytest.mark.parametrize(("sign", "static"), [(1.0, FORWARD[1]), (-1.0, BACKWARD[1])])
def test_breakaway_differs_by_direction(model: Model, sign: float, static: float) -> None:
    found = simulate(model, 1.0, {"tau_pan": ramp(0.0, sign, 0.0, 1.0)}, PARAMETERS)
    assert found.events[0].time == pytest.approx(static, abs=1e-8)
    assert sign * found["theta_pan"][-1] > 0.0


def test_braking_distance_differs_by_direction(model: Model) -> None:
    """Coulomb friction of 0.3 (1 +- 0.2) N m: J w^2 / (2 F)."""
    dry = {
        "J_pan": 0.05,
        "F_c_pan": 0.3,
        "F_s_pan": 0.3,
        "F_v_pan": 0.0,
        "a_F_c_pan": 0.2,
        "a_F_s_pan": 0.2,
    }
    for rate, torque in ((1.0, 0.36), (-1.0, 0.24)):
        found = simulate(model, 0.3, parameters=dry, initial={"omega_pan": rate})
        assert found["theta_pan"][-1] == pytest.approx(rate * 0.05 / (2 * torque), rel=1e-8)
