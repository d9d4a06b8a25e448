"""Sensitivities of a smooth model against the complex step, by another integrator."""

import cmath

import numpy as np
import pytest

import ptp_symbolic
from tests.effects.plain_python import as_python

STEP = 1e-30


def complex_derivative(model):
    """The emitted right-hand side with complex functions in place of real ones."""
    plain = as_python(model).module
    plain.math = cmath
    return plain.mode_derivative


@pytest.mark.parametrize("name", ["m_payload", "c_x_payload", "b_tilt", "J_pan"])
def test_against_runge_kutta_with_a_complex_step(name: str) -> None:
    model = ptp_symbolic.load("payload")
    start = {"theta_tilt": 0.4, "omega_pan": 1.0}
    found = ptp_symbolic.sensitivity(
        model, [0.0, 1.0], initial=start, by_parameters=[name], rtol=1e-11, atol=1e-12
    ).states[-1, :, 0]
    derivative = complex_derivative(model)
    p = model.parameter_vector().astype(complex)
    p[model.parameter_names.index(name)] += 1j * STEP
    x = np.array([start.get(n, 0.0) for n in model.state_names], dtype=complex)
    u, h = np.zeros(2, dtype=complex), 1.0 / 2000

    def slope(state):
        dx = np.zeros(4, dtype=complex)
        derivative(0.0, state, u, p, x, dx)
        return dx

    for _ in range(2000):
        k1 = slope(x)
        k2 = slope(x + h / 2 * k1)
        k3 = slope(x + h / 2 * k2)
        k4 = slope(x + h * k3)
        x = x + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    assert found == pytest.approx(x.imag / STEP, rel=1e-6, abs=1e-9)
