"""Shifted centre of mass: where the payload hangs, how fast it falls, what the inertia becomes."""

import math

import numpy as np
import pytest
import sympy as sp

from ptp_symbolic import simulate
from ptp_symbolic.models import emission
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.platform import EffectDeclaration, Platform
from ptp_symbolic.symbolic.derivation.assembly import assemble

EFFECTS = tuple(
    EffectDeclaration(e, None, None) for e in ("rigid_bodies", "payload", "payload_com_offset")
)
PLATFORM = Platform("shifted", "Shifted payload", ("tilt",), 9.81, EFFECTS, (), ())
# Tables 5.1 and 5.3 with erratum 18.
MASS, ARM, INERTIA = 4.992, 0.1, 6.5e-4 + 6.8e-3


@pytest.fixture(scope="module")
def model() -> Model:
    return emission.emit(PLATFORM)


def test_shift_grows_the_inertia_after_steiner() -> None:
    j, own, m, x, z = sp.symbols(
        "J_y_tilt J_y_payload m_payload c_x_payload c_z_payload", real=True
    )
    dx, dz = sp.symbols("dc_x_payload dc_z_payload", real=True)
    growth = m * (2 * x * dx + dx**2 + 2 * z * dz + dz**2)
    expected = j + own + m * (x**2 + z**2) + growth
    assert sp.expand(assemble(PLATFORM).mass_matrix[0] - expected) == 0


def test_payload_hangs_below_the_axis(model: Model) -> None:
    """With the centre of mass at x = 0.1, z = 0.04 it points down at tilt atan2(x, -z)."""
    rest = math.atan2(ARM, -0.04)
    found = simulate(model, 1.0, parameters={"dc_z_payload": 0.04}, initial={"theta_tilt": rest})
    assert np.ptp(found["theta_tilt"]) < 1e-12
    away = simulate(model, 0.1, parameters={"dc_z_payload": 0.04}, initial={"theta_tilt": 1.5})
    assert away["theta_tilt"][-1] > 1.5


@pytest.mark.parametrize("shift", [-0.1, -0.03, 0.05])
def test_a_level_payload_falls_with_its_arm(model: Model, shift: float) -> None:
    """A shift of -0.1 m balances the payload: gravity then moves nothing."""
    arm = ARM + shift
    acceleration = MASS * 9.81 * arm / (INERTIA + MASS * arm**2)
    p = model.parameter_vector({"dc_x_payload": shift})
    found = model.rhs(0.0, np.zeros(2), np.zeros(1), p)
    assert found[1] == pytest.approx(acceleration, rel=1e-12, abs=1e-14)
