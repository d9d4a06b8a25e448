"""Axes that do not cross: against MuJoCo and the parallel axis theorem, and by three routes."""

import numpy as np
import pytest
import sympy as sp

from ptp_symbolic import simulate
from ptp_symbolic.errors import InputError
from ptp_symbolic.models import emission
from ptp_symbolic.platform import EffectDeclaration, Platform
from ptp_symbolic.symbolic.derivation.assembly import assemble
from ptp_symbolic.symbolic.derivation.kane import kane
from ptp_symbolic.symbolic.derivation.newton_euler import newton_euler
from ptp_symbolic.symbolic.derivation.proof import prove_equal

EFFECTS = tuple(
    EffectDeclaration(e, None, None)
    for e in ("rigid_bodies", "axis_offset", "payload", "base_tilt", "product_of_inertia")
)
PLATFORM = Platform("apart", "Axes apart", ("pan", "tilt"), 9.81, EFFECTS, (), ())
OFFSET, MASS = 0.12, 7.0
VALUES = {
    "J_pan": 0.3,
    "J_x_tilt": 0.05,
    "J_y_tilt": 0.04,
    "J_z_tilt": 0.06,
    "a_tilt": OFFSET,
    "m_tilt": MASS,
    "m_payload": 3.0,
    "J_x_payload": 0.02,
    "J_y_payload": 0.025,
    "J_z_payload": 0.03,
    "c_x_payload": 0.2,
    "c_y_payload": 0.05,
    "c_z_payload": -0.07,
}
MACHINE = f"""
<mujoco><compiler angle="radian"/><option gravity="0 0 -9.81"/><worldbody>
<body name="pan"><joint type="hinge" axis="0 0 1"/>
 <inertial pos="0 0 0" mass="1e-9" diaginertia="0.3 0.3 0.3"/>
 <body name="tilt" pos="{OFFSET} 0 0"><joint type="hinge" axis="0 1 0"/>
  <inertial pos="0 0 0" mass="{MASS}" diaginertia="0.05 0.04 0.06"/>
  <body pos="0.2 0.05 -0.07"><inertial pos="0 0 0" mass="3" diaginertia="0.02 0.025 0.03"/></body>
 </body></body></worldbody></mujoco>"""


def test_accelerations_are_those_of_mujoco() -> None:
    mujoco = pytest.importorskip("mujoco")
    machine = mujoco.MjModel.from_xml_string(MACHINE)
    data, model = mujoco.MjData(machine), emission.emit(PLATFORM)
    p, rng = model.parameter_vector(VALUES), np.random.default_rng(4)
    for _ in range(200):
        q, w, torque = rng.normal(size=(3, 2)) * np.array([[2.0], [3.0], [10.0]])
        data.qpos[:], data.qvel[:], data.qfrc_applied[:] = q, w, torque
        mujoco.mj_forward(machine, data)
        found = model.rhs(0.0, np.concatenate([q, w]), torque, p)[2:]
        assert found == pytest.approx(data.qacc, rel=1e-7, abs=1e-7)


def test_three_derivations_agree() -> None:
    equations = assemble(PLATFORM)
    for route in (kane, newton_euler):
        assert prove_equal(equations.rigid_equations, route(equations.rigid)).equal


def test_the_pan_axis_carries_all_mass_at_the_offset() -> None:
    """Parallel axis theorem: the tilt axis turns around the pan axis with all that hangs on it."""
    equations = assemble(PLATFORM)
    offset, tilt, payload = sp.symbols("a_tilt m_tilt m_payload", real=True)
    squared = sp.Poly(sp.expand(equations.mass_matrix[0, 0]), offset).coeff_monomial(offset**2)
    assert sp.expand(squared - tilt - payload) == 0


def test_the_energy_of_a_free_swing_stays() -> None:
    start = {"theta_tilt": 0.4, "omega_pan": 1.5, "omega_tilt": -0.7}
    found = simulate(emission.emit(PLATFORM), 3.0, None, VALUES, start, rtol=1e-10, atol=1e-12)
    assert np.ptp(found.stored) <= 1e-8 * np.ptp(found["theta_tilt"]) * 9.81


def test_a_single_axis_has_no_offset() -> None:
    effects = tuple(EffectDeclaration(e, None, None) for e in ("rigid_bodies", "axis_offset"))
    with pytest.raises(InputError, match="acts on 'tilt_axis_offset', which no declared effect"):
        assemble(Platform("one", "One axis", ("pan",), 9.81, effects, (), ()))
