"""CSVS friction: Eq. 4.1 while sliding, rest below breakaway, Coulomb's braking distance."""

import math

import pytest
import sympy as sp

from ptp_symbolic import simulate
from ptp_symbolic.models import emission
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.inputs import constant, ramp
from ptp_symbolic.platform import EffectDeclaration, Platform
from ptp_symbolic.symbolic.derivation.assembly import assemble

EFFECTS = (
    EffectDeclaration("rigid_bodies", None, None),
    EffectDeclaration("csvs_friction", "pan", None),
)
PLATFORM = Platform("friction", "Pan axis with friction", ("pan",), 9.81, EFFECTS, (), ())
J = 0.05
# Table 4.1, omega > 0: N m, N m, rad/s, N m s/rad.
F_C, F_S, V_S, F_V = 0.2267, 0.5578, 0.0159, 13.5844
TABLE = {"J_pan": J, "F_c_pan": F_C, "F_s_pan": F_S, "v_s_pan": V_S, "F_v_pan": F_V}
RATES = [0.004, -0.02, 0.1, -0.5]


def equation_4_1(rate: float) -> float:
    stribeck = (F_S - F_C) * math.exp(-(abs(rate / V_S) ** 2))
    return (F_C + stribeck) * math.copysign(1.0, rate) + F_V * rate


@pytest.fixture(scope="module")
def model() -> Model:
    return emission.emit(PLATFORM)


@pytest.mark.parametrize("rate", RATES)
def test_declared_law_is_equation_4_1(rate: float) -> None:
    (friction,) = assemble(PLATFORM).frictions
    values = {**TABLE, "omega_pan": rate, "slide_pan": math.copysign(1.0, rate)}
    at = {sp.Symbol(name, real=True): value for name, value in values.items()}
    torque = values["slide_pan"] * float(friction.level.subs(at))
    assert torque == pytest.approx(equation_4_1(rate), rel=1e-14)
    assert float(friction.breakaway.subs(at)) == F_S


@pytest.mark.parametrize("rate", RATES)
def test_torque_of_equation_4_1_keeps_the_rate(model: Model, rate: float) -> None:
    driven = {"tau_pan": constant(equation_4_1(rate))}
    found = simulate(model, 0.05, driven, TABLE, {"omega_pan": rate})
    assert found["omega_pan"] == pytest.approx([rate] * len(found.t), rel=1e-9)
    assert found.events == ()


@pytest.mark.parametrize("torque", [0.999 * F_S, -0.999 * F_S])
def test_nothing_moves_below_breakaway(model: Model, torque: float) -> None:
    found = simulate(model, [0.0, 100.0], {"tau_pan": constant(torque)}, TABLE)
    assert found["theta_pan"][-1] == 0.0
    assert found["omega_pan"][-1] == 0.0


@pytest.mark.parametrize(("sign", "mode"), [(1.0, "slides forward"), (-1.0, "slides backward")])
def test_a_ramp_breaks_away_at_the_static_torque(model: Model, sign: float, mode: str) -> None:
    found = simulate(model, 1.0, {"tau_pan": ramp(0.0, sign, 0.0, 1.0)}, TABLE)
    (event,) = found.events
    assert event.mode == mode
    assert event.time == pytest.approx(F_S, abs=1e-8)
    assert sign * found["theta_pan"][-1] > 0.0


def test_coulomb_friction_alone_brakes_over_a_parabola(model: Model) -> None:
    """Stop after J w/F_c and J w^2/(2 F_c); then rest."""
    rate, coulomb = 1.5, 0.3
    dry = {"J_pan": J, "F_c_pan": coulomb, "F_s_pan": coulomb, "F_v_pan": 0.0}
    found = simulate(model, 0.5, parameters=dry, initial={"omega_pan": rate})
    (event,) = found.events
    assert (event.mode, event.time) == ("sticks", pytest.approx(J * rate / coulomb, abs=1e-8))
    assert found["theta_pan"][-1] == pytest.approx(J * rate**2 / (2 * coulomb), rel=1e-8)
    assert found["omega_pan"][-1] == 0.0
