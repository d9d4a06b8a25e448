"""Dry friction that drifts: the momentum and energy that it takes, and a late breakaway."""

import math

import numpy as np
import pytest

from ptp_symbolic import simulate
from ptp_symbolic.models import emission
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.inputs import constant
from ptp_symbolic.platform import EffectDeclaration, Platform

EFFECTS = (
    EffectDeclaration("rigid_bodies", None, None),
    EffectDeclaration("csvs_friction", "pan", None),
    EffectDeclaration("friction_drift", "pan", None),
)
PLATFORM = Platform("drift", "Pan axis that runs in", ("pan",), 9.81, EFFECTS, (), ())
J, F, T = 0.05, 0.3, 2.0
DRY = {"J_pan": J, "F_c_pan": F, "F_s_pan": F, "F_v_pan": 0.0, "t_drift_pan": T}


@pytest.fixture(scope="module")
def model() -> Model:
    return emission.emit(PLATFORM)


@pytest.mark.parametrize("share", [-0.6, 0.5])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_momentum_falls_by_the_integral_of_the_drifting_torque(
    model: Model, share: float, sign: float
) -> None:
    """F (t + a (t - T (1 - exp(-t/T)))) is taken from the momentum, a rate at a time from the
    energy.
    """
    start = {"omega_pan": sign * 30.0}
    times = np.linspace(0.0, 3.0, 31)
    found = simulate(model, times, None, DRY | {"a_drift_pan": share}, start, rtol=1e-10)
    taken = F * (times + share * (times - T * (1.0 - np.exp(-times / T))))
    rate = sign * (30.0 - taken / J)
    assert np.all(rate * sign > 0.0)
    assert found["omega_pan"] == pytest.approx(rate, abs=1e-8)
    assert found.dissipated == pytest.approx(J / 2 * (900.0 - rate**2), abs=1e-7)
    assert found.supplied == pytest.approx(np.zeros(len(times)), abs=1e-9)


def test_a_joint_breaks_away_when_friction_has_fallen_to_the_torque(model: Model) -> None:
    """At 1 - 0.6 (1 - exp(-t/T)) = 0.8 of the static torque: t = T log(3/2)."""
    leaves = T * math.log(1.5)
    pushed = {"tau_pan": constant(0.8 * F)}
    values = DRY | {"a_drift_pan": -0.6}
    found = simulate(model, [0.0, leaves - 1e-3, leaves + 1e-3, 3.0], pushed, values)
    assert found["theta_pan"][1] == 0.0
    assert found["omega_pan"][2] > 0.0
    (event,) = found.events
    assert event.time == pytest.approx(leaves, abs=1e-6)


def test_viscous_friction_stays(model: Model) -> None:
    values = DRY | {"F_c_pan": 0.0, "F_s_pan": 0.0, "F_v_pan": 0.1, "a_drift_pan": -0.6}
    found = simulate(model, [0.0, 1.0], None, values, {"omega_pan": 2.0})
    assert found["omega_pan"][-1] == pytest.approx(2.0 * math.exp(-0.1 / J), rel=1e-6)
