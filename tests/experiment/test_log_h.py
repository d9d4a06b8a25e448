"""The loop closed: logs that leave a group, the run that is designed for it, played by another
machine, and the group is gone.

The machine of log-h has an encoder off its centre; on a drive this stiff the logs cannot tell that
from a gear out of true. The machine that plays the run is the event-driven simulator of
tests/independent, with the sensors of the field logs; its parameters are those that were fitted to
log-h, as nobody has written down the true ones. Takes a quarter of an hour.
"""

import shutil
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest

from ptp_symbolic.atomic_files import write_files_atomically
from ptp_symbolic.platform import read_platform
from ptp_symbolic.workflows.diagnosis import diagnose_platform
from ptp_symbolic.workflows.experiment_design import Request, design_experiment
from ptp_symbolic.workflows.experiment_group import group_of
from tests.benchmark.pan_machine import KNOWN, PAN_DRIVE
from tests.benchmark.truth_drive import reading
from tests.identify.curves import Floats
from tests.independent import pan_drive, pan_logs

PLATFORM = Path(__file__).parents[1] / "platforms" / "fieldlog_pan.toml"
ENCODER, GEAR = "encoder_eccentricity", "gear_eccentricity@pan"


def play(path: Path, values: Mapping[str, float], volts: Floats, seed: int) -> None:
    """Write the log of a run from rest, begun anywhere in the gap, near zero of the encoder."""
    rng = np.random.default_rng(seed)
    drive = PAN_DRIVE.drive(values)
    joint = rng.uniform(-0.45, 0.45) * pan_logs.COUNT - values["e_cos_pan"]
    gear = joint + rng.uniform(-0.45, 0.45) * drive.gap
    start = np.array([joint, 0.0, gear, 0.0, 0.0, 0.0])
    states, _ = pan_drive.simulate(drive, volts, start)
    states[:, pan_drive.LOAD_ANGLE] = reading(values, "pan", states[:, pan_drive.LOAD_ANGLE])
    rows = pan_logs.log_rows(states, volts, rng)
    path.write_text("\n".join([pan_logs.COLUMNS, *rows]) + "\n")


@pytest.mark.long
def test_one_designed_run_separates_the_group_of_log_h(shared: Path, tmp_path: Path) -> None:
    platform, logs = read_platform(PLATFORM), shared / "fieldlogs" / "log-h"
    first = diagnose_platform(platform, [logs / "train"], [logs / "validate"])
    assert first.summary["verdict"] == "explained_up_to_group"
    write_files_atomically(tmp_path / "first", first.files)
    group, fitted = group_of(tmp_path / "first", platform)
    assert group == (f"{ENCODER}@pan", GEAR)
    limits = ("u_pan=24 V", "theta_pan=-150..150deg")
    request = Request(group, (), limits, 20.0, None, {}, fitted, 120, 1)
    designed = design_experiment(platform, request, [logs / "train"])
    assert designed.summary["separable"]
    told = {p["machine"]: p for p in designed.summary["separation"]}[group[0]]
    assert told["share_before"] < designed.summary["share_needed"] < told["share_after"]
    write_files_atomically(tmp_path / "next", designed.files)
    volts = np.loadtxt(tmp_path / "next" / "input.csv", delimiter=",", skiprows=1)[:, 1]
    found = {n: p["value"] for n, p in first.summary["fit"]["after"]["parameters"].items()}
    for seed, part in enumerate(("train", "validate")):
        shutil.copytree(logs / part, tmp_path / part)
        (tmp_path / part).chmod(0o755)
        play(tmp_path / part / f"designed_{part}.csv", KNOWN | found, volts, 11 + seed)
    again = diagnose_platform(platform, [tmp_path / "train"], [tmp_path / "validate"]).summary
    named = {added["effect"]: added["confusable_with"] for added in again["added"]}
    assert (again["verdict"], named) == ("explained", {ENCODER: []})
