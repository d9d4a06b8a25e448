"""Offset of the drive: it creeps at zero command, and the command is shifted by as much."""

import numpy as np
import pytest

from ptp_symbolic import simulate
from ptp_symbolic.models import emission
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.inputs import constant, multisine
from ptp_symbolic.platform import EffectDeclaration, Platform

EFFECTS = (
    EffectDeclaration("rigid_bodies", None, None),
    EffectDeclaration("viscous_friction", "pan", None),
    EffectDeclaration("dc_motor", "pan", None),
    EffectDeclaration("voltage_offset", "pan", None),
)
PLATFORM = Platform("creep", "Pan axis with an offset", ("pan",), 9.81, EFFECTS, (), ())
R, K_T, N, OFFSET, DAMPING = 12.9, 0.0724, 500.0, -0.35, 8.0


@pytest.fixture(scope="module")
def model() -> Model:
    return emission.emit(PLATFORM)


def steady_speed(volts: float) -> float:
    return N * K_T * volts / (R * DAMPING + (N * K_T) ** 2)


@pytest.mark.parametrize("command", [0.0, 6.0, -6.0])
def test_steady_speed_is_that_of_command_plus_offset(model: Model, command: float) -> None:
    values = {"u0_pan": OFFSET, "b_pan": DAMPING}
    found = simulate(model, [0.0, 2.0], {"u_pan": constant(command)}, values)
    assert found["omega_pan"][-1] == pytest.approx(steady_speed(command + OFFSET), rel=1e-7)
    assert found["i_pan"][-1] * N * K_T == pytest.approx(
        DAMPING * steady_speed(command + OFFSET), rel=1e-6
    )


def test_the_command_that_cancels_it_keeps_the_axis_still(model: Model) -> None:
    found = simulate(model, 1.0, {"u_pan": constant(-OFFSET)}, {"u0_pan": OFFSET})
    assert np.all(found.x == 0.0)


def test_motions_add_up(model: Model) -> None:
    """The drive is linear: command and offset together move it by the sum of what each does."""
    command, values = {"u_pan": multisine([5.0], [3.0])}, {"b_pan": DAMPING}
    both = simulate(model, 0.5, command, values | {"u0_pan": OFFSET}, atol=1e-12)
    parts = [simulate(model, 0.5, command, values, atol=1e-12)]
    parts.append(simulate(model, 0.5, None, values | {"u0_pan": OFFSET}, atol=1e-12))
    assert both.x == pytest.approx(parts[0].x + parts[1].x, abs=1e-7)
