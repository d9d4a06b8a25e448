"""Supply rails: clipped speed, clipped current, and rails that an offset cannot pass."""

import math

import numpy as np
import pytest

from ptp_symbolic import simulate
from ptp_symbolic.models import emission
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.inputs import constant, ramp
from ptp_symbolic.platform import EffectDeclaration, Platform

BODY = EffectDeclaration("rigid_bodies", None, None)
R, L, K_T, N, LIMIT = 12.9, 6.9e-3, 0.0724, 500.0, 12.0


def drive(*stages: str) -> Model:
    effects = (BODY, *(EffectDeclaration(e, "pan", None) for e in ("dc_motor", *stages)))
    return emission.emit(Platform("rails", "Pan axis and supply", ("pan",), 9.81, effects, (), ()))


@pytest.fixture(scope="module")
def model() -> Model:
    return drive("voltage_saturation")


@pytest.mark.parametrize("command", [11.9, 24.0, -24.0])
def test_no_load_speed_ends_at_the_supply(model: Model, command: float) -> None:
    found = simulate(model, [0.0, 2.0], {"u_pan": constant(command)}, {"u_max_pan": LIMIT})
    volts = math.copysign(min(abs(command), LIMIT), command)
    assert found["omega_pan"][-1] == pytest.approx(volts / (N * K_T), rel=1e-7)


def test_current_of_a_blocked_motor_under_a_ramp_into_the_rail(model: Model) -> None:
    """The response to a ramp, less the same ramp from the moment it meets the rail."""
    slope, blocked = 400.0, {"u_max_pan": LIMIT, "K_t_pan": 1e-9}

    def response(since: np.ndarray) -> np.ndarray:
        after = np.maximum(since, 0.0)
        return slope / R * (after - L / R * (1.0 - np.exp(-after * R / L)))

    found = simulate(model, 0.06, {"u_pan": ramp(0.0, 24.0, 0.0, 0.06)}, blocked, atol=1e-12)
    current = response(found.t) - response(found.t - LIMIT / slope)
    assert found["i_pan"] == pytest.approx(current, abs=1e-7)
    assert found["i_pan"][-1] == pytest.approx(LIMIT / R, rel=1e-6)


@pytest.mark.parametrize(
    "stages",
    [
        ("drive_deadband", "voltage_offset", "voltage_saturation"),
        ("voltage_saturation", "drive_deadband", "voltage_offset"),
    ],
)
def test_neither_offset_nor_dead_band_moves_the_rail(stages: tuple[str, ...]) -> None:
    """Far beyond the rail the motor gets the supply, in whatever order the effects are declared."""
    values = {"u_max_pan": LIMIT, "u0_pan": 0.5, "u_dead_pan": 0.7}
    for command in (24.0, -24.0):
        found = simulate(drive(*stages), [0.0, 2.0], {"u_pan": constant(command)}, values)
        speed = math.copysign(LIMIT, command) / (N * K_T)
        assert found["omega_pan"][-1] == pytest.approx(speed, rel=1e-7)
