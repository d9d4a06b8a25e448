"""An encoder at the motor shows the gear output; the motion knows nothing of it."""

import numpy as np
import pytest

from ptp_symbolic.models import emission
from ptp_symbolic.platform import EffectDeclaration, Platform

JOINT, GEAR = 0.3, 0.7


def machine(*effects: str) -> Platform:
    body = EffectDeclaration("rigid_bodies", None, None)
    own = tuple(EffectDeclaration(e, "pan", None) for e in effects)
    return Platform("encoder", "Encoder at the motor", ("pan",), 9.81, (body, *own), (), ())


@pytest.mark.parametrize("motor", ["dc_motor", "rotor_inertia"])
def test_it_shows_the_gear_output_behind_which_the_joint_may_lag(motor: str) -> None:
    model = emission.emit(machine(motor, "shaft_compliance", "motor_encoder"))
    x, p = np.zeros(len(model.state_names)), model.parameter_vector()
    x[model.state_names.index("theta_pan")] = JOINT
    x[model.state_names.index("theta_gear_pan")] = GEAR
    row = model.output_names.index("theta_pan")
    shown, by_state = np.zeros(len(model.output_names)), np.zeros((len(model.output_names), len(x)))
    by_parameter = np.zeros((len(model.output_names), len(p)))
    model.module.outputs(0.0, x, np.zeros(1), p, shown)
    model.module.output_jacobian(0.0, x, np.zeros(1), p, by_state, by_parameter)
    assert shown[row] == pytest.approx(GEAR, abs=1e-15)
    assert by_state[row, model.state_names.index("theta_gear_pan")] == pytest.approx(1.0)
    assert by_state[row, model.state_names.index("theta_pan")] == pytest.approx(0.0, abs=1e-15)


def test_without_a_shaft_it_shows_the_joint() -> None:
    model = emission.emit(machine("motor_encoder"))
    shown = np.zeros(len(model.output_names))
    model.module.outputs(0.0, np.array([JOINT, 0.0]), np.zeros(1), model.parameter_vector(), shown)
    assert shown[model.output_names.index("theta_pan")] == JOINT
