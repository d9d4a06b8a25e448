"""The field logs, where they are at hand, read with the platforms that declare their machines."""

import math
import os
from pathlib import Path

import numpy as np
import pytest

from ptp_symbolic.numeric.data import read_logs
from ptp_symbolic.platform import read_platform


def shared_folder() -> Path:
    beside = Path(__file__).parents[3] / "shared"
    return Path(os.environ.get("PTP_SYMBOLIC_SHARED", beside)) / "fieldlogs"


@pytest.mark.skipif(not shared_folder().is_dir(), reason="the field logs are not here")
@pytest.mark.parametrize(
    ("platform", "logs", "runs"),
    [
        ("fieldlog_pan", "abcd", 14),
        ("fieldlog_pan_dc", "ef", 14),
        ("fieldlog_two_axis", "g", 5),
    ],
)
def test_the_field_logs_read_with_their_platforms(platform: str, logs: str, runs: int) -> None:
    declared = read_platform(Path(__file__).parents[1] / "platforms" / f"{platform}.toml")
    for letter in logs:
        folder = shared_folder() / f"log-{letter}"
        read = read_logs([folder / "train", folder / "validate"], declared)
        assert len(read) == runs
        for log in read:
            counts = log.outputs[:, -1] * 7200 / (2 * math.pi)
            np.testing.assert_allclose(counts, np.round(counts), rtol=0, atol=2e-3)
            np.testing.assert_allclose(np.diff(log.time), 0.005, rtol=0, atol=1e-9)
