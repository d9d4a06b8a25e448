"""A carriage on a spindle moves as hand-written equations in m, N and kg say."""

from pathlib import Path

import numpy as np
import pytest

import ptp_symbolic
from tests.independent.carriage import MACHINE, MOTOR, POSITION, VOLTAGE, truth


def test_a_voltage_moves_the_carriage_as_newton_says(tmp_path: Path) -> None:
    platform = tmp_path / "carriage.toml"
    platform.write_text(MACHINE + MOTOR + VOLTAGE + POSITION)
    model = ptp_symbolic.load(str(platform))
    assert [model.units[n] for n in model.state_names] == ["m", "m/s", "A"]
    times = np.linspace(0.0, 2.0, 401)
    inputs = {"u_pan": "sweep:12@0.2..1.5"}
    found = ptp_symbolic.simulate(model, times, inputs, rtol=1e-9, atol=1e-11)
    wanted = truth(times, motor=True)
    for column, name in enumerate(model.state_names):
        size = np.ptp(wanted[:, column])
        assert found[name] == pytest.approx(wanted[:, column], abs=1e-6 * size), name
