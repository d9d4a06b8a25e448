"""Rigid faces in steps of fixed length, against closed forms and located events."""

import numpy as np
import pytest

from ptp_symbolic import simulate
from ptp_symbolic.models import emission
from ptp_symbolic.numeric.simulation.inputs import constant
from tests.effects.test_backlash_kinds import (
    DRY,
    FREE,
    GAP,
    KINDS,
    PUSHED,
    VOLTAGE,
    approach,
    platform,
)


@pytest.mark.parametrize("e", [0.5, 1.0])
def test_bounces_come_late_by_less_the_shorter_the_step(e: float) -> None:
    model = emission.emit(platform("elastic_impact"))
    speed, powers = 0.3, e ** np.arange(1.0, 9.0)
    times = GAP / 2 / speed + GAP / speed * np.cumsum([0.0, *1.0 / powers[:-1]])
    after, late = times + GAP / speed / powers / 2, []
    for step in (1e-3, 1e-4):
        found = simulate(
            model,
            [0.0, *after],
            None,
            {**FREE, "e_gap_pan": e},
            {"omega_gear_pan": speed},
            method="fixed_step",
            step=step,
        )
        struck = [event.time for event in found.events if "bounces" in event.mode]
        late.append(np.abs(np.array(struck) - times).max())
        assert np.abs(approach(found)[1:]) == pytest.approx(speed * powers, rel=1e-12)
    assert 0.0 < late[1] < 0.2 * late[0] < 5e-3


@pytest.mark.parametrize("e", [0.0, 0.3, 0.8])
def test_bounces_that_end_leave_the_faces_together(e: float) -> None:
    """They neither sink into each other nor bounce on below the length of a step."""
    model, step = emission.emit(platform("elastic_impact")), 1e-4
    given = ({"u_pan": constant(500.0)}, {**PUSHED, "e_gap_pan": e}, {"i_pan": 50.0})
    found = simulate(model, 1.0, *given, method="fixed_step", step=step)
    located = simulate(model, 1.0, *given)
    assert found.events[-1].mode == located.events[-1].mode == "touches the upper face"
    assert found.events[-1].time == pytest.approx(located.events[-1].time, abs=50 * step)
    joined = found.t > found.events[-1].time
    assert np.ptp(approach(found)[joined]) < 1e-12
    assert np.ptp((found["theta_gear_pan"] - found["theta_pan"])[joined]) < 1e-12
    late = 0.3 * step  # rad, at the speed of the first strike
    assert found.x[-1, :4] == pytest.approx(located.x[-1, :4], abs=late)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("site", ["gear", "joint"])
def test_dry_friction_beside_rigid_faces(kind: str, site: str) -> None:
    model = emission.emit(platform(kind, "csvs_friction", site=site))
    located = simulate(model, 4.0, VOLTAGE, DRY)
    angles, missing = [], []
    for step in (1e-4, 1e-5):
        found = simulate(model, 4.0, VOLTAGE, DRY, method="fixed_step", step=step)
        angles.append(np.abs(found.x - located.x)[:, [0, 2]].max())
        ledger = found.stored - found.stored[0] - found.supplied + found.dissipated
        missing.append(np.abs(ledger).max() / found.supplied.max())
        assert np.diff(found.dissipated).min() >= 0.0
    assert angles[1] < min(2e-4, 0.2 * angles[0])
    assert missing[1] < min(1e-8, 0.2 * missing[0])
    pressed = simulate(model, 20.0, {"u_pan": constant(0.4)}, DRY, method="fixed_step", step=1e-3)
    assert np.ptp(pressed["theta_pan"][-1000:]) == 0.0
