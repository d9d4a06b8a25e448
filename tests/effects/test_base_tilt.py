"""Base that is not level: torques from the height of the payload, and the swing about alpha."""

import numpy as np
import pytest
import sympy as sp
from scipy.special import ellipk

from ptp_symbolic import simulate
from ptp_symbolic.models import emission
from ptp_symbolic.platform import EffectDeclaration, Platform
from ptp_symbolic.symbolic.derivation.assembly import assemble

EFFECTS = tuple(EffectDeclaration(e, None, None) for e in ("rigid_bodies", "payload", "base_tilt"))
M, C = sp.symbols("m_payload c_x_payload", real=True)
BETA, ALPHA = sp.symbols("beta_base alpha_base", real=True)
PAN, TILT = sp.symbols("theta_pan theta_tilt", real=True)
WEIGHT = M * sp.Symbol("gravity", real=True)


def platform(*axes: str) -> Platform:
    return Platform("tilted", "Tilted base", axes, 9.81, EFFECTS, (), ())


def gravity_torques(*axes: str) -> sp.Matrix:
    """Forcing at rest with the payload on the boresight."""
    zeros = "omega_pan omega_tilt tau_pan tau_tilt c_y_payload c_z_payload"
    return assemble(platform(*axes)).forcing.xreplace({s: 0 for s in sp.symbols(zeros, real=True)})


def test_pan_torque_pulls_the_payload_to_the_azimuth() -> None:
    expected = -WEIGHT * C * sp.sin(BETA) * sp.sin(PAN - ALPHA)
    assert sp.simplify(gravity_torques("pan")[0] - expected) == 0


def test_two_axes_feel_the_slope_of_the_height_of_the_payload() -> None:
    """Gravity (sin b cos a, sin b sin a, -cos b) on a payload lowered by a positive tilt."""
    place = (sp.cos(TILT) * sp.cos(PAN), sp.cos(TILT) * sp.sin(PAN), -sp.sin(TILT))
    down = (sp.sin(BETA) * sp.cos(ALPHA), sp.sin(BETA) * sp.sin(ALPHA), -sp.cos(BETA))
    potential = -WEIGHT * C * sum(p * d for p, d in zip(place, down, strict=True))
    for torque, angle in zip(gravity_torques("pan", "tilt"), (PAN, TILT), strict=True):
        assert sp.simplify(torque + potential.diff(angle)) == 0


def test_pan_axis_swings_about_the_azimuth_like_a_pendulum() -> None:
    mass, arm, inertia, beta, alpha, amplitude = 4.992, 0.1, 5.3e-4 + 6.8e-3, 0.1, 0.8, 1.2
    slow = np.sqrt(mass * 9.81 * arm * np.sin(beta) / (inertia + mass * arm**2))
    half_period = 2.0 * ellipk(np.sin(amplitude / 2) ** 2) / slow
    found = simulate(
        emission.emit(platform("pan")),
        [0.0, half_period],
        initial={"theta_pan": alpha - amplitude},
        parameters={"beta_base": beta, "alpha_base": alpha},
        rtol=1e-11,
        atol=1e-12,
    )
    assert found["theta_pan"][-1] == pytest.approx(alpha + amplitude, abs=1e-8)
    assert found["omega_pan"][-1] == pytest.approx(0.0, abs=1e-7)
