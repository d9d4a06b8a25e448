"""Another exponent of the Stribeck curve: steady sliding, braking, and finite slopes at rest."""

import math

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp

from ptp_symbolic import simulate
from ptp_symbolic.models import emission
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.inputs import constant, ramp
from ptp_symbolic.platform import EffectDeclaration, Platform
from ptp_symbolic.symbolic.derivation.assembly import assemble
from tests.effects.plain_python import as_python

EFFECTS = (
    EffectDeclaration("rigid_bodies", None, None),
    EffectDeclaration("csvs_friction", "pan", None),
    EffectDeclaration("stribeck_exponent", "pan", None),
)
PLATFORM = Platform("curve", "Pan axis on a Stribeck curve", ("pan",), 9.81, EFFECTS, (), ())
J = 0.05
F_C, F_S, V_S, F_V = 0.2267, 0.5578, 0.0159, 13.5844
TABLE = {"J_pan": J, "F_c_pan": F_C, "F_s_pan": F_S, "v_s_pan": V_S, "F_v_pan": F_V}
EXPONENTS = [0.3, 0.5, 1.0, 2.0, 3.7]


def law(rate: float, exponent: float) -> float:
    """Eq. 2.11 of the thesis with erratum 3."""
    fall = math.exp(-(abs(rate / V_S) ** exponent))
    return (F_C + (F_S - F_C) * fall) * math.copysign(1.0, rate) + F_V * rate


@pytest.fixture(scope="module")
def model() -> Model:
    return emission.emit(PLATFORM)


@pytest.mark.parametrize("exponent", EXPONENTS)
@pytest.mark.parametrize("rate", [0.002, -0.02, 0.3])
def test_torque_of_the_law_keeps_the_rate(model: Model, rate: float, exponent: float) -> None:
    driven = {"tau_pan": constant(law(rate, exponent))}
    values = TABLE | {"gamma_pan": exponent}
    found = simulate(model, 0.02, driven, values, {"omega_pan": rate})
    assert found["omega_pan"] == pytest.approx([rate] * len(found.t), rel=1e-9)


@pytest.mark.parametrize("exponent", EXPONENTS)
def test_braking_takes_the_work_of_the_law(model: Model, exponent: float) -> None:
    """SciPy integrates rate, angle and lost energy of the law until the joint nearly rests."""
    values = TABLE | {"gamma_pan": exponent, "F_v_pan": 0.1}
    times = np.linspace(0.0, 0.006, 17)

    def slopes(t: float, y: np.ndarray) -> list[float]:
        torque = law(y[0], exponent) + (0.1 - F_V) * y[0]
        return [-torque / J, y[0], torque * y[0]]

    own = solve_ivp(
        slopes, (0.0, 0.006), [0.06, 0.0, 0.0], t_eval=times, rtol=1e-11, atol=1e-13, method="Radau"
    )
    found = simulate(model, times, None, values, {"omega_pan": 0.06}, rtol=1e-9, atol=1e-12)
    assert 0.0 < own.y[0][-1] < 0.04
    assert found["omega_pan"] == pytest.approx(own.y[0], abs=1e-8)
    assert found["theta_pan"] == pytest.approx(own.y[1], abs=1e-9)
    assert found.dissipated == pytest.approx(own.y[2], abs=1e-9)
    assert found.supplied == pytest.approx(np.zeros(len(times)), abs=1e-12)


@pytest.mark.parametrize("exponent", EXPONENTS)
def test_breakaway_is_the_static_torque_whatever_the_exponent(
    model: Model, exponent: float
) -> None:
    values = TABLE | {"gamma_pan": exponent}
    slow = {"tau_pan": ramp(0.0, 1.1 * F_S, 0.0, 1.1)}
    found = simulate(model, [0.0, 0.999, 1.001], slow, values)
    assert found["theta_pan"][1] == 0.0
    assert found["theta_pan"][2] > 0.0


def test_the_square_of_the_rate_is_no_logarithm_of_what_underflows() -> None:
    (friction,) = assemble(PLATFORM).frictions
    assert not friction.level.has(sp.log)


@pytest.mark.parametrize("exponent", EXPONENTS)
@pytest.mark.parametrize("slide", [-1.0, 0.0, 1.0])
def test_at_rest_every_derivative_is_finite(model: Model, exponent: float, slide: float) -> None:
    plain = as_python(model)
    p = plain.parameter_vector(TABLE | {"gamma_pan": exponent})
    x, u, m = np.zeros(2), np.zeros(1), np.array([slide])
    dx = np.zeros(2)
    plain.module.mode_derivative(0.0, x, u, p, m, dx)
    there = plain.derivatives(0.0, x, u, p, m)
    assert all(np.isfinite(found).all() for found in (dx, *there))
    assert dx[1] == pytest.approx(-slide * F_S / J, rel=4e-3)
