"""A log that begins, or goes on after a gap, while the machine moves: the gear has a rate of its
own then, in flight or as it rings against a face.
"""

import numpy as np
import pytest

from ptp_symbolic.numeric.data import Log
from ptp_symbolic.numeric.identify.fit import fit_parameters
from ptp_symbolic.numeric.identify.run_preparation import prepare_runs
from tests.identify.pan_runs import (
    FINE_STEPS,
    FLOOR,
    KNOWN,
    MODEL,
    PLATFORM,
    TRUTH,
    make_runs,
    sine,
)
from tests.independent.pan_drive import PanDrive

LONG = 40  # samples that are lost, 0.2 s


@pytest.mark.parametrize("first", [60, 198, 205, 212, 401, 408])
def test_what_follows_a_gap_is_told_to_rounding(first: int) -> None:
    """The lost parts end all over the cycle of a drive that crosses its gap twice a period."""
    (whole,) = make_runs(PanDrive(), [sine()], 3).runs
    kept = np.r_[0:first, first + LONG : len(whole.time)]
    log = Log("sine#3", whole.time[kept], whole.held_inputs[kept], whole.measured[kept])
    parts = prepare_runs(MODEL, PLATFORM, [log])
    assert [run.name for run in parts] == ["sine#3#1", "sine#3#2"]
    assert [run.source for run in parts] == ["sine#3"] * 2
    judged = fit_parameters(MODEL, parts, (), {**KNOWN, **TRUTH}, None, FINE_STEPS)
    after = judged.evaluations[1].residual.reshape(parts[1].measured.shape)[:, 1]
    assert np.sqrt(np.mean(after**2)) * FLOOR < 1.15 * FLOOR


def test_what_stays_within_its_noise_after_a_gap_may_turn_back_there() -> None:
    """A log that begins at rest has no rate to be found; after a gap nothing tells rest."""
    (whole,) = make_runs(PanDrive(), [sine()], 3).runs
    still = np.tile(whole.measured[:1], (len(whole.time), 1))
    kept = np.r_[0:200, 200 + LONG : len(whole.time)]
    log = Log("still", whole.time[kept], whole.held_inputs[kept], still[kept])
    before, after = ({u.name for u in run.unknowns} for run in prepare_runs(MODEL, PLATFORM, [log]))
    assert before == {"theta_pan", "gap_place_0"}
    assert after == {"theta_pan", "omega_pan", "omega_gear_pan", "gap_place_0"}
