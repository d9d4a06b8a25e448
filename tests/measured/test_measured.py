"""Two real machines: what is known to be missing in them is named, and predicts other runs better.

The data are Janot, Gautier and Brunot (2019) and Duclusaud et al. (2025); both sources report which
friction their machine has beyond Coulomb and viscous friction.
"""

from pathlib import Path
from typing import Any

import pytest

from ptp_symbolic.machines.study import PLATFORMS, emps_logs, pendulum_logs
from ptp_symbolic.platform import read_platform
from ptp_symbolic.workflows.diagnosis import diagnose_platform

pytestmark = pytest.mark.long


@pytest.fixture
def measured(shared: Path) -> Path:
    folder = shared / "measured"
    if not folder.is_dir():
        pytest.skip(f"'{folder}' is not there")
    return folder


def diagnosed(name: str, logs: tuple[list[Path], list[Path]]) -> dict[str, Any]:
    return diagnose_platform(read_platform(PLATFORMS / f"{name}.toml"), *logs).summary


@pytest.mark.parametrize(
    ("name", "source", "logs", "effect", "share"),
    [
        ("emps", "emps", emps_logs, "direction_dependent_friction", 0.7),
        ("servo_pendulum", "servo_pendulum", pendulum_logs, "load_dependent_friction", 0.6),
    ],
)
def test_the_published_friction_is_named(
    name: str, source: str, logs: Any, effect: str, share: float, measured: Path
) -> None:
    found = diagnosed(name, logs(measured / source))
    assert found["verdict"] == "partly_explained"
    assert [added["effect"] for added in found["added"]] == [effect]
    assert found["held_out"]["share"] > share
    assert found["hints"]
