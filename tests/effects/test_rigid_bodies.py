"""Two balanced bodies: kinetic energy from the body rates of Eq. 3.1, and Euler's free motion."""

import numpy as np
import pytest
import sympy as sp

from ptp_symbolic import simulate
from ptp_symbolic.models import emission
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.inputs import constant
from ptp_symbolic.platform import EffectDeclaration, Platform
from ptp_symbolic.symbolic.derivation.assembly import assemble

EFFECTS = (EffectDeclaration("rigid_bodies", None, None),)
PLATFORM = Platform("bodies", "Two bodies", ("pan", "tilt"), 9.81, EFFECTS, (), ())
# Table 5.1, kg m^2.
J_PAN, J_X, J_Y, J_Z = 5.3e-4, 4.1e-4, 6.5e-4, 2.7e-4


@pytest.fixture(scope="module")
def model() -> Model:
    return emission.emit(PLATFORM)


def test_kinetic_energy_is_that_of_the_body_rates() -> None:
    pan, x, y, z = sp.symbols("J_pan J_x_tilt J_y_tilt J_z_tilt", real=True)
    theta, w_pan, w_tilt = sp.symbols("theta_tilt omega_pan omega_tilt", real=True)
    rates = (-w_pan * sp.sin(theta), w_tilt, w_pan * sp.cos(theta))  # Eq. 3.1
    twice = pan * w_pan**2 + sum(j * w**2 for j, w in zip((x, y, z), rates, strict=True))
    equations = assemble(PLATFORM)
    assert sp.simplify(equations.rigid_equations.kinetic - twice / 2) == 0
    assert sp.simplify(
        sp.hessian(twice / 2, equations.rates) - equations.mass_matrix
    ).is_zero_matrix


@pytest.mark.parametrize(("axis", "inertia"), [("pan", "J_pan"), ("tilt", "J_y_tilt")])
def test_one_axis_alone_is_one_inertia(axis: str, inertia: str) -> None:
    equations = assemble(Platform("one", "One axis", (axis,), 9.81, EFFECTS, (), ()))
    assert equations.mass_matrix == sp.ImmutableMatrix([[sp.Symbol(inertia, real=True)]])
    assert equations.forcing == sp.ImmutableMatrix([[sp.Symbol(f"tau_{axis}", real=True)]])


def test_free_motion_keeps_the_angular_momentum_about_the_vertical(model: Model) -> None:
    start = {"theta_tilt": 0.4, "omega_pan": 3.0, "omega_tilt": 5.0}
    found = simulate(model, 2.0, initial=start, rtol=1e-11, atol=1e-12)
    theta, w_pan, w_tilt = found["theta_tilt"], found["omega_pan"], found["omega_tilt"]
    about_vertical = J_PAN + J_X * np.sin(theta) ** 2 + J_Z * np.cos(theta) ** 2
    momentum = about_vertical * w_pan
    energy = (about_vertical * w_pan**2 + J_Y * w_tilt**2) / 2
    assert np.ptp(theta) > 5.0
    assert momentum == pytest.approx(np.full_like(theta, momentum[0]), rel=1e-8)
    assert energy == pytest.approx(np.full_like(theta, energy[0]), rel=1e-8)


def test_a_spinning_platform_swings_about_its_axis_of_larger_inertia(model: Model) -> None:
    """J_x > J_z: upright (tilt 90 deg) is stable, with the frequency spin sqrt((Jx - Jz)/Jy)."""
    spin, small = 10.0, 1e-4
    frequency = spin * np.sqrt((J_X - J_Z) / J_Y)
    start = {"theta_tilt": np.pi / 2 + small, "omega_pan": spin}
    found = simulate(model, 2.0, {"tau_pan": constant(0.0)}, initial=start, rtol=1e-11, atol=1e-14)
    swing = found["theta_tilt"] - np.pi / 2
    assert swing == pytest.approx(small * np.cos(frequency * found.t), abs=1e-4 * small)
