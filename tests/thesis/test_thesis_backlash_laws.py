"""Figs. 2.18 and 2.19 and the impact across the gap, against closed forms."""

import math

import numpy as np
import pytest

from ptp_symbolic.thesis import backlash_laws as laws
from ptp_symbolic.thesis.backlash_laws import HALF_GAP, HYSTERESIS_TIMES

GAP, STIFFNESS, LOAD = math.radians(1.49), 5000.0, 0.05


def test_transmitted_torque_is_the_dead_zone_of_equation_2_16() -> None:
    twist = np.array([-0.03, -0.014, -0.012, 0.0, 0.012, 0.014, 0.03])
    beyond = np.sign(twist) * np.maximum(np.abs(twist) - GAP / 2, 0.0)
    assert laws.transmitted_torque(twist) == pytest.approx(STIFFNESS * beyond, abs=2e-2)


def test_a_load_held_by_friction_is_the_play_operator() -> None:
    run = laws.hysteresis("hysteresis_friction")
    assert run["theta_gear_pan"] == pytest.approx(np.sin(2 * math.pi * HYSTERESIS_TIMES), abs=5e-4)
    expected = [-HALF_GAP]
    for drive in run["theta_gear_pan"][1:]:
        expected.append(min(max(expected[-1], drive - HALF_GAP), drive + HALF_GAP))
    assert run["theta_pan"] == pytest.approx(np.array(expected), abs=1e-6)


def test_a_coasting_load_meets_the_other_face() -> None:
    run = laws.hysteresis("hysteresis_inertia")
    # pushed from the start, it leaves at once with 2 pi rad/s, since the drive only decelerates,
    # and meets the other face where 2 pi t - sin(2 pi t) is the whole gap
    met = next(e.time for e in run.events if "touches" in e.mode)
    assert 2 * math.pi * met - math.sin(2 * math.pi * met) == pytest.approx(2 * HALF_GAP, abs=1e-4)
    coasting = (run.t > 1e-3) & (run.t < met - 1e-3)
    assert run["omega_pan"][coasting] == pytest.approx(2 * math.pi, rel=1e-4)


def test_equation_2_18_as_printed_holds_the_load_like_equation_2_17() -> None:
    held = laws.hysteresis("hysteresis_friction")["theta_pan"]
    assert laws.printed_inertia_driven() == pytest.approx(held, abs=2e-3)


@pytest.mark.parametrize("friction", [0.0, 2.0])
def test_restitution_of_a_damped_half_swing(friction: float) -> None:
    ratio = friction / (2 * math.sqrt(STIFFNESS * LOAD))
    half_swing = math.exp(-math.pi * ratio / math.sqrt(1 - ratio**2))
    assert laws.restitution(friction) == pytest.approx(half_swing, rel=1e-6)


@pytest.mark.parametrize("coefficient", [0.0, 0.5, 1.0])
def test_rates_after_rigid_impacts_are_powers_of_the_restitution(coefficient: float) -> None:
    rate = laws.rigid_impact(coefficient)["omega_pan"]
    allowed = [(-coefficient) ** k for k in range(8)]
    assert all(min(abs(r - a) for a in allowed) < 1e-3 for r in rate)
    assert rate[-1] != pytest.approx(1.0, abs=1e-3) or coefficient == 1.0
