"""Geared DC motor: stall, no-load and loaded speed, time constant, step response."""

import numpy as np
import pytest
import sympy as sp
from scipy.linalg import expm

from ptp_symbolic import simulate
from ptp_symbolic.models import emission
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.inputs import constant
from ptp_symbolic.platform import EffectDeclaration, Platform
from ptp_symbolic.symbolic.derivation.assembly import assemble

EFFECTS = (
    EffectDeclaration("rigid_bodies", None, None),
    EffectDeclaration("viscous_friction", "pan", None),
    EffectDeclaration("dc_motor", "pan", None),
)
PLATFORM = Platform("motor", "Pan axis with motor", ("pan",), 9.81, EFFECTS, (), ())
# Table 5.7.
L, R, K_T, J_MOTOR, N = 6.9e-3, 12.9, 0.0724, 1.1e-5, 500.0
J_LOAD, VOLTS = 0.05, 24.0
FREE = {"J_pan": J_LOAD, "b_pan": 0.0}


@pytest.fixture(scope="module")
def model() -> Model:
    return emission.emit(PLATFORM)


def test_power_balance_over_the_gear() -> None:
    """Erratum 8 and Appendix C: the rotor counts N^2 times beside the load, 2.75 kg m^2."""
    j, rotor, n, k, b = sp.symbols("J_pan J_motor_pan N_pan K_t_pan b_pan", real=True)
    i, w = sp.symbols("i_pan omega_pan", real=True)
    equations = assemble(PLATFORM)
    assert sp.expand(equations.mass_matrix[0] - (j + rotor * n**2)) == 0
    assert sp.expand(equations.forcing[0] - (n * k * i - b * w)) == 0
    defaults = {p.name: p.default for p in equations.parameters}
    assert defaults["J_motor_pan"] * defaults["N_pan"] ** 2 == pytest.approx(2.75)


def test_blocked_motor_gives_the_stall_torque_after_its_time_constant(model: Model) -> None:
    """A load of 1e4 kg m^2 hardly moves: back-EMF takes 2e-4 A; its acceleration tells torque."""
    blocked = {"J_pan": 1e4, "b_pan": 0.0}
    found = simulate(model, 0.01, {"u_pan": constant(VOLTS)}, blocked)
    current = VOLTS / R * (1.0 - np.exp(-found.t * R / L))
    assert found["i_pan"] == pytest.approx(current, abs=3e-4)
    x, p = np.array([0.0, 0.0, VOLTS / R]), model.parameter_vector(blocked)
    dx = model.rhs(0.0, x, np.array([VOLTS]), p)
    assert dx[2] == pytest.approx(0.0, abs=1e-9)
    assert dx[1] * (1e4 + 2.75) == pytest.approx(N * K_T * VOLTS / R, rel=1e-12)


@pytest.mark.parametrize("damping", [0.0, 40.0])
def test_steady_speed(model: Model, damping: float) -> None:
    """u/(N K_t) without load, less with a viscous one."""
    loaded = {"J_pan": J_LOAD, "b_pan": damping}
    found = simulate(model, [0.0, 2.0], {"u_pan": constant(VOLTS)}, loaded)
    speed = N * K_T * VOLTS / (R * damping + (N * K_T) ** 2)
    assert found["omega_pan"][-1] == pytest.approx(speed, rel=1e-7)
    assert found["i_pan"][-1] == pytest.approx(damping * speed / (N * K_T), abs=1e-7)


def test_step_response_is_that_of_the_linear_system(model: Model) -> None:
    """Rate and current from Eq. 3.10 and the torque balance, by the matrix exponential."""
    inertia = J_LOAD + J_MOTOR * N**2
    a = np.array([[0.0, N * K_T / inertia], [-N * K_T / L, -R / L]])
    steady = np.linalg.solve(a, [0.0, -VOLTS / L])
    found = simulate(
        model, np.linspace(0.0, 0.1, 21), {"u_pan": constant(VOLTS)}, FREE, rtol=1e-11, atol=1e-12
    )
    for k, t in enumerate(found.t):
        assert found.x[k, 1:] == pytest.approx(steady - expm(a * t) @ steady, abs=1e-9)
