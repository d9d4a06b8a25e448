"""The steps of one route agree with those of another: d'Alembert, joint by joint."""

import pytest
import sympy as sp

from ptp_symbolic.platform import read_platform
from ptp_symbolic.symbolic.derivation.assembly import assemble
from ptp_symbolic.symbolic.derivation.kane import kane_with_steps
from ptp_symbolic.symbolic.derivation.newton_euler import newton_euler_steps


@pytest.mark.parametrize("name", ["thesis-payload", "thesis-tilt-drive"])
def test_the_generalized_forces_balance_the_joint_torques_of_newton_and_euler(name: str) -> None:
    rigid = assemble(read_platform(name)).rigid
    _, loads = newton_euler_steps(rigid)
    _, steps = kane_with_steps(rigid)
    for load, active, inertial in zip(loads, steps.active, steps.inertia, strict=True):
        left = sp.expand(load.joint_torque + active + inertial)
        assert sp.simplify(left) == 0
        assert load.joint_torque != 0
