"""Base that shakes sideways: inertial forces on the payload, and a pendulum that they drive."""

import numpy as np
import pytest
import sympy as sp

from ptp_symbolic import simulate
from ptp_symbolic.models import emission
from ptp_symbolic.platform import EffectDeclaration, Platform
from ptp_symbolic.symbolic.derivation.assembly import assemble
from ptp_symbolic.symbolic.mechanics.kinematics import TIME

EFFECTS = tuple(
    EffectDeclaration(e, None, None) for e in ("rigid_bodies", "payload", "base_motion")
)
MASS, ARM, GRAVITY = 4.992, 0.1, 9.81
SHAKE = {"a_base": 0.8, "f_base": 1.3, "phi_base": 0.4, "psi_base": 0.7}


def platform(*axes: str) -> Platform:
    return Platform("shaken", "Shaken base", axes, GRAVITY, EFFECTS, (), ())


def test_torques_are_those_of_weight_and_inertia_force() -> None:
    """The payload feels gravity and minus the acceleration a sin(2 pi f t + phi) along psi."""
    names = "m_payload a_base f_base phi_base psi_base theta_pan theta_tilt"
    m, a, f, phi, psi, pan, tilt = sp.symbols(names, real=True)
    arm = sp.Matrix(sp.symbols("c_x_payload c_y_payload c_z_payload", real=True))
    place = sp.rot_axis3(-pan) * sp.rot_axis2(-tilt) * arm
    push = a * sp.sin(2 * sp.pi * f * TIME + phi)
    force = m * sp.Matrix(
        [-push * sp.cos(psi), -push * sp.sin(psi), -sp.Symbol("gravity", real=True)]
    )
    still = sp.symbols("omega_pan omega_tilt tau_pan tau_tilt", real=True)
    forcing = assemble(platform("pan", "tilt")).forcing.xreplace(dict.fromkeys(still, 0))
    for torque, angle in zip(forcing, (pan, tilt), strict=True):
        assert sp.simplify(torque - place.diff(angle).dot(force)) == 0


def test_pan_axis_that_points_along_the_motion_stays_at_rest() -> None:
    along = {"theta_pan": SHAKE["psi_base"]}
    found = simulate(emission.emit(platform("pan")), [0.0, 3.0], None, SHAKE, along)
    assert found["theta_pan"][-1] == pytest.approx(SHAKE["psi_base"], abs=1e-12)


def test_hanging_payload_swings_like_a_driven_pendulum() -> None:
    """Small swing q about straight down (tilt pi/2): J q'' + m g c q = m c a sin(w t + phi)."""
    inertia = 0.02
    body = {"J_y_tilt": inertia, "m_payload": MASS, "c_x_payload": ARM, "J_y_payload": 0.0}
    total, driven, push = inertia + MASS * ARM**2, 2 * np.pi * 1.3, 1e-4
    own = np.sqrt(MASS * GRAVITY * ARM / total)
    swing = MASS * ARM * push / total / (own**2 - driven**2)
    shake = SHAKE | {"a_base": push, "psi_base": 0.0}
    found = simulate(
        emission.emit(platform("tilt")),
        np.linspace(0.0, 3.0, 31),
        None,
        body | shake,
        {"theta_tilt": np.pi / 2},
        rtol=1e-11,
        atol=1e-14,
    )
    steady = swing * np.sin(driven * found.t + 0.4)
    free = np.sin(0.4) * np.cos(own * found.t)
    free += driven * np.cos(0.4) * np.sin(own * found.t) / own
    assert found["theta_tilt"] - np.pi / 2 == pytest.approx(steady - swing * free, abs=1e-10)
