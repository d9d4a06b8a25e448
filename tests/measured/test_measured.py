"""Two real machines: what is known to be missing in them is named, and predicts other runs better.

The data are Janot, Gautier and Brunot (2019) and Duclusaud et al. (2025); both sources report which
friction their machine has beyond Coulomb and viscous friction.
"""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.io import loadmat, savemat

from ptp_symbolic.machines.study import EMPS_FILES, PLATFORMS, emps_logs, pendulum_logs
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


STIFFNESS, MIDDLE = 7.26, 0.123  # N/m and m: 0.6 N rms over the stroke of the training file
FORCE = 35.1507  # N per volt


def test_a_spring_put_into_the_force_is_found(measured: Path, tmp_path: Path) -> None:
    """A machine with a spring needs its force besides for the same motion: added to that of EMPS,
    whose own friction differs by direction.
    """
    for name in EMPS_FILES:
        content = loadmat(measured / "emps" / name)
        columns = {k: np.asarray(v) for k, v in content.items() if not k.startswith("__")}
        spring = STIFFNESS * (columns["qm"] - MIDDLE)
        columns["vir"] = columns["vir"] + spring / FORCE
        savemat(tmp_path / name, columns)
    found = diagnosed("emps", emps_logs(tmp_path))
    named = {added["effect"]: added["parameters"] for added in found["added"]}
    assert sorted(named) == ["cable_spring", "direction_dependent_friction"]
    low, high = named["cable_spring"]["k1_cable_pan"]["ci95"]
    assert low < STIFFNESS < high
