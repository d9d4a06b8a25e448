"""A carriage on a spindle moves as hand-written equations in m, N and kg say."""

from pathlib import Path

import numpy as np
import pytest

import ptp_symbolic
from ptp_symbolic.platform import read_platform
from ptp_symbolic.workflows.diagnosis import diagnose_platform
from tests.independent.carriage import (
    COUNTS,
    FORCE,
    MACHINE,
    MOTOR,
    PITCH,
    POSITION,
    VOLTAGE,
    force_at,
    truth,
)


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


@pytest.mark.long
def test_a_force_that_repeats_with_the_magnets_is_named_with_their_pitch(tmp_path: Path) -> None:
    """Of 3 N, every 24 mm; one log to fit, and the other, which starts 5 s later, to judge by."""
    platform = tmp_path / "carriage.toml"
    platform.write_text(MACHINE.replace("m_pan = { value", "m_pan = { start") + FORCE + POSITION)
    times = np.arange(0.0, 10.0, 2e-3)
    position = np.round(truth(times, motor=False, ripple=3.0)[:, 0] * COUNTS) / COUNTS
    force = np.array([force_at(t + 1e-3) for t in times])  # held over the next two milliseconds
    table = np.column_stack([times, force, position])
    logs = []
    for name, part in (("train", table[:2500]), ("validate", table[2500:])):
        logs.append(tmp_path / f"{name}.csv")
        head = "time [s],force [N],position [m]"
        np.savetxt(logs[-1], part, delimiter=",", header=head, comments="", fmt="%.12g")
    found = diagnose_platform(read_platform(platform), logs[:1], logs[1:]).summary
    cogging = next(added for added in found["added"] if added["effect"] == "cogging")
    number = cogging["parameters"]["n_cog_pan"]
    assert number["unit"] == "rad/m"
    assert number["value"] == pytest.approx(2.0 * np.pi / PITCH, rel=1e-4)
    assert cogging["parameters"]["T_sin_pan"]["value"] == pytest.approx(3.0, rel=1e-2)
    assert found["error"]["validate"]["after"]["total"]["rmse_counts"] < 2.0
