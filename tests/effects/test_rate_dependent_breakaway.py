"""Breakaway that grows with the time at rest: ramps, a pause, and a fresh start after sliding."""

import math

import pytest
from scipy.optimize import brentq

from ptp_symbolic import simulate
from ptp_symbolic.models import emission
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.inputs import constant, ramp, table
from ptp_symbolic.platform import EffectDeclaration, Platform

EFFECTS = (
    EffectDeclaration("rigid_bodies", None, None),
    EffectDeclaration("csvs_friction", "pan", None),
    EffectDeclaration("rate_dependent_breakaway", "pan", None),
)
PLATFORM = Platform("dwell", "Pan axis that settles", ("pan",), 9.81, EFFECTS, (), ())
J, F_C, F_S, GROWTH, SETTLING = 0.05, 0.3, 0.5, 0.25, 0.4
SETTLES = {
    "J_pan": J,
    "F_c_pan": F_C,
    "F_s_pan": F_S,
    "F_v_pan": 0.0,
    "a_rest_pan": GROWTH,
    "t_rest_pan": SETTLING,
}


def breakaway(rest: float) -> float:
    return F_S * (1.0 + GROWTH * math.log1p(rest / SETTLING))


@pytest.fixture(scope="module")
def model() -> Model:
    return emission.emit(PLATFORM)


@pytest.mark.parametrize("slope", [0.2, -2.0, 50.0])
def test_breakaway_falls_with_the_rate_of_the_torque(model: Model, slope: float) -> None:
    """Where the torque of the ramp meets the breakaway torque that has grown since the start."""
    meet = brentq(lambda t: abs(slope) * t - breakaway(t), 0.0, 20.0)
    driven = {"tau_pan": ramp(0.0, 1.05 * slope * meet, 0.0, 1.05 * meet)}
    found = simulate(model, 1.05 * meet, driven, SETTLES)
    assert found.events[0].time == pytest.approx(meet, abs=1e-6)


@pytest.mark.parametrize(("part", "count"), [(0.999, 0), (1.001, 1)])
def test_a_torque_after_a_pause_meets_the_grown_breakaway(
    model: Model, part: float, count: int
) -> None:
    pause = 3.0
    driven = {"tau_pan": table([0.0, pause], [0.0, part * breakaway(pause)])}
    found = simulate(model, [0.0, pause, pause + 1e-4], driven, SETTLES)
    assert len(found.events) == count


def test_a_fast_start_after_sliding_counts_the_rest_from_the_stop(model: Model) -> None:
    """A slide stops after J w/F_c; half a second later the ramp sets in."""
    dry = SETTLES | {"F_s_pan": F_C}
    stop, slope = J * 2.0 / F_C, 3.0
    begin = stop + 0.5

    def excess(t: float) -> float:
        return slope * (t - begin) - F_C / F_S * breakaway(t - stop)

    meet = brentq(excess, begin, begin + 5.0)
    driven = {"tau_pan": ramp(0.0, slope * 2.0, begin, begin + 2.0)}
    found = simulate(model, meet + 0.05, driven, dry, {"omega_pan": 2.0})
    assert [event.mode for event in found.events] == ["sticks", "slides forward"]
    assert [event.time for event in found.events] == pytest.approx([stop, meet], abs=1e-6)


def test_a_reversal_is_not_held_by_the_rest_before_it(model: Model) -> None:
    """No time passes at standstill: a torque just above F_s turns the slide round at once."""
    dry, rate, torque = SETTLES | {"F_s_pan": F_C}, 1.0, 1.05 * F_C
    start = {"omega_pan": rate, "rest_time_pan": 20.0}
    found = simulate(model, 0.3, {"tau_pan": constant(-torque)}, dry, start)
    turn = J * rate / (torque + F_C)
    back = (torque - F_C) / J * (0.3 - turn)
    assert found["omega_pan"][-1] == pytest.approx(-back, abs=1e-6)


def test_sliding_friction_is_that_without_the_effect(model: Model) -> None:
    start = {"omega_pan": 1.0}
    grown = simulate(model, 0.1, {"tau_pan": constant(0.1)}, SETTLES, start)
    plain = simulate(model, 0.1, {"tau_pan": constant(0.1)}, SETTLES | {"a_rest_pan": 0.0}, start)
    assert grown["omega_pan"] == pytest.approx(plain["omega_pan"], abs=1e-12)
    assert grown["rest_time_pan"] == pytest.approx(0.0, abs=0.0)
