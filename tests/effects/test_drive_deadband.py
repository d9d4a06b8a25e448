"""Dead band of the drive: nothing below it, the command less its half width above."""

import math

import numpy as np
import pytest

from ptp_symbolic import simulate
from ptp_symbolic.models import emission
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.inputs import constant, ramp
from ptp_symbolic.platform import EffectDeclaration, Platform

EFFECTS = (
    EffectDeclaration("rigid_bodies", None, None),
    EffectDeclaration("dc_motor", "pan", None),
    EffectDeclaration("drive_deadband", "pan", None),
)
PLATFORM = Platform("lazy", "Pan axis with a lazy drive", ("pan",), 9.81, EFFECTS, (), ())
R, L, K_T, N, DEAD = 12.9, 6.9e-3, 0.0724, 500.0, 0.7


@pytest.fixture(scope="module")
def model() -> Model:
    return emission.emit(PLATFORM)


@pytest.mark.parametrize("command", [0.699, -0.699, 0.3])
def test_nothing_moves_inside_the_band(model: Model, command: float) -> None:
    found = simulate(model, 1.0, {"u_pan": constant(command)}, {"u_dead_pan": DEAD})
    assert np.all(found.x == 0.0)


@pytest.mark.parametrize("command", [0.9, -5.0, 24.0])
def test_no_load_speed_lacks_the_half_width(model: Model, command: float) -> None:
    found = simulate(model, [0.0, 2.0], {"u_pan": constant(command)}, {"u_dead_pan": DEAD})
    speed = math.copysign(abs(command) - DEAD, command) / (N * K_T)
    assert found["omega_pan"][-1] == pytest.approx(speed, rel=1e-7)


def test_current_of_a_blocked_motor_under_a_ramp_through_the_band(model: Model) -> None:
    """Zero until the ramp leaves the band at `late`, then that of a ramp into R and L."""
    slope, blocked = 20.0, {"u_dead_pan": DEAD, "K_t_pan": 1e-9}
    found = simulate(model, 0.1, {"u_pan": ramp(0.0, 2.0, 0.0, 0.1)}, blocked, atol=1e-12)
    since = np.maximum(found.t - DEAD / slope, 0.0)
    current = slope / R * (since - L / R * (1.0 - np.exp(-since * R / L)))
    assert found["i_pan"] == pytest.approx(current, abs=1e-7)
