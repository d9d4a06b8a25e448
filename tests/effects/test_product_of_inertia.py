"""Products of inertia: Euler's equations of the tilt body, and a pan axis that tilting turns."""

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import quad

from ptp_symbolic import simulate
from ptp_symbolic.models import emission
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.inputs import constant
from ptp_symbolic.platform import EffectDeclaration, Platform
from ptp_symbolic.symbolic.derivation.assembly import assemble

EFFECTS = tuple(EffectDeclaration(e, None, None) for e in ("rigid_bodies", "product_of_inertia"))
PLATFORM = Platform("skew", "Skew tilt body", ("pan", "tilt"), 9.81, EFFECTS, (), ())
J_PAN = 0.02
TENSOR = np.array([[0.03, 0.004, -0.006], [0.004, 0.05, 0.007], [-0.006, 0.007, 0.04]])
BODY = {"J_pan": J_PAN} | {
    f"J_{name}_tilt": TENSOR[i, j]
    for name, i, j in (
        ("x", 0, 0),
        ("y", 1, 1),
        ("z", 2, 2),
        ("xy", 0, 1),
        ("xz", 0, 2),
        ("yz", 1, 2),
    )
}


@pytest.fixture(scope="module")
def model() -> Model:
    return emission.emit(PLATFORM)


def test_coupling_inertia_of_erratum_27() -> None:
    """Angular momentum about y per pan rate: -J_xy sin + J_yz cos."""
    j_xy, j_yz, tilt = sp.symbols("J_xy_tilt J_yz_tilt theta_tilt", real=True)
    mass = assemble(PLATFORM).mass_matrix
    assert sp.simplify(mass[0, 1] - (-j_xy * sp.sin(tilt) + j_yz * sp.cos(tilt))) == 0
    assert mass[0, 1] == mass[1, 0]


def test_torques_of_eulers_equations_give_the_accelerations(model: Model) -> None:
    rng = np.random.default_rng(27)
    for _ in range(20):
        pan, tilt, pan_rate, tilt_rate, pan_acc, tilt_acc = rng.normal(size=6)
        s, c = np.sin(tilt), np.cos(tilt)
        spin = np.array([-pan_rate * s, tilt_rate, pan_rate * c])
        turning = np.array(
            [-pan_acc * s - pan_rate * tilt_rate * c, tilt_acc, pan_acc * c + spin[0] * tilt_rate]
        )
        moment = TENSOR @ turning + np.cross(spin, TENSOR @ spin)
        torques = np.array([J_PAN * pan_acc + moment @ [-s, 0.0, c], moment[1]])
        x = np.array([pan, tilt, pan_rate, tilt_rate])
        dx = model.rhs(0.0, x, torques, model.parameter_vector(BODY))
        assert dx == pytest.approx([pan_rate, tilt_rate, pan_acc, tilt_acc], rel=1e-10)


def test_tilting_a_free_platform_turns_its_pan_axis(model: Model) -> None:
    """No torque about z: its angular momentum stays zero, and the pan angle follows the tilt."""

    def slope(tilt: float) -> float:
        s, c = np.sin(tilt), np.cos(tilt)
        about_z = np.array([-s, 0.0, c])
        return float(-(about_z @ TENSOR[:, 1]) / (J_PAN + about_z @ TENSOR @ about_z))

    found = simulate(model, [0.0, 1.0], {"tau_tilt": constant(0.2)}, BODY, rtol=1e-11, atol=1e-12)
    tilt = found["theta_tilt"][-1]
    assert tilt > 1.0
    assert found["theta_pan"][-1] == pytest.approx(quad(slope, 0.0, tilt)[0], abs=1e-9)
