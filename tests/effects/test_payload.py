"""Payload: Steiner's theorem, the gravity torque, and the physical pendulum."""

import numpy as np
import pytest
import sympy as sp
from scipy.special import ellipk

from ptp_symbolic import simulate
from ptp_symbolic.models import emission
from ptp_symbolic.platform import EffectDeclaration, Platform
from ptp_symbolic.symbolic.derivation.assembly import assemble

EFFECTS = tuple(EffectDeclaration(e, None, None) for e in ("rigid_bodies", "payload"))
G = sp.Symbol("gravity", real=True)
M, X, Y, Z = sp.symbols("m_payload c_x_payload c_y_payload c_z_payload", real=True)
JX, JY, JZ = sp.symbols("J_x_payload J_y_payload J_z_payload", real=True)
THETA = sp.Symbol("theta_tilt", real=True)


def platform(*axes: str) -> Platform:
    return Platform("payload", "Payload", axes, 9.81, EFFECTS, (), ())


def test_steiner_on_one_axis() -> None:
    pan, tilt = sp.symbols("J_pan J_y_tilt", real=True)
    found = assemble(platform("pan")).mass_matrix[0]
    assert sp.expand(found - (pan + JZ + M * (X**2 + Y**2))) == 0
    found = assemble(platform("tilt")).mass_matrix[0]
    assert sp.expand(found - (tilt + JY + M * (X**2 + Z**2))) == 0


def test_inertia_about_the_vertical_at_any_tilt() -> None:
    """A point of the tilt body is x cos + z sin ahead of the pan axis and y beside it."""
    pan, jx, jz = sp.symbols("J_pan J_x_tilt J_z_tilt", real=True)
    cos, sin = sp.cos(THETA), sp.sin(THETA)
    distance_sq = (X * cos + Z * sin) ** 2 + Y**2
    expected = pan + (jx + JX) * sin**2 + (jz + JZ) * cos**2 + M * distance_sq
    assert sp.simplify(assemble(platform("pan", "tilt")).mass_matrix[0, 0] - expected) == 0


def test_gravity_pulls_the_payload_down_and_leaves_a_level_pan_axis_alone() -> None:
    still = {s: 0 for s in sp.symbols("omega_pan omega_tilt tau_pan tau_tilt", real=True)}
    pan, tilt = assemble(platform("pan", "tilt")).forcing.xreplace(still)
    assert sp.simplify(pan) == 0
    assert sp.simplify(tilt - M * G * (X * sp.cos(THETA) + Z * sp.sin(THETA))) == 0


def test_a_wide_swing_has_the_period_of_the_physical_pendulum() -> None:
    """From 1 rad beside the lowest place (tilt 90 deg) to 1 rad on the other side."""
    mass, arm, inertia, amplitude = 4.992, 0.1, 6.5e-4 + 6.8e-3, 1.0
    slow = np.sqrt(mass * 9.81 * arm / (inertia + mass * arm**2))
    half_period = 2.0 * ellipk(np.sin(amplitude / 2) ** 2) / slow
    model = emission.emit(platform("tilt"))
    start = {"theta_tilt": np.pi / 2 - amplitude}
    found = simulate(model, [0.0, half_period], initial=start, rtol=1e-11, atol=1e-12)
    assert found["theta_tilt"][-1] == pytest.approx(np.pi / 2 + amplitude, abs=1e-8)
    assert found["omega_tilt"][-1] == pytest.approx(0.0, abs=1e-7)
