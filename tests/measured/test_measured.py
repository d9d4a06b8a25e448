"""Two real machines: what is known to be missing in them is named, and predicts other runs better.

The data are Janot, Gautier and Brunot (2019) and Duclusaud et al. (2025); both sources report which
friction their machine has beyond Coulomb and viscous friction.
"""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy.io

from ptp_symbolic.platform import read_platform
from ptp_symbolic.workflows.diagnosis import diagnose_platform

pytestmark = pytest.mark.long
HERE = Path(__file__).parent


def positioning_system(source: Path, folder: Path) -> tuple[list[Path], list[Path]]:
    """Force and position of the carriage as logs."""
    paths = []
    for name in ("DATA_EMPS", "DATA_EMPS_PULSES"):
        data = scipy.io.loadmat(source / f"{name}.mat")
        force = float(data["gtau"].item()) * data["vir"].ravel()
        table = np.column_stack([data["t"].ravel(), force, data["qm"].ravel()])
        paths.append(folder / f"{name}.csv")
        header = "time [s],force [N],position [m]"
        np.savetxt(paths[-1], table, delimiter=",", header=header, comments="", fmt="%.9g")
    return paths[:1], paths[1:]


def pendulum(source: Path, folder: Path) -> tuple[list[Path], list[Path]]:
    """Voltage and angle of the servo; without the runs in which it was switched off."""
    parts = []
    for part in ("train", "validate"):
        paths = []
        for log in sorted((source / part).glob("*.csv")):
            if not log.name.startswith("lift_and_drop"):
                rows = [line.split(",")[:3] for line in log.read_text().splitlines()]
                paths.append(folder / f"{part}_{log.name}")
                paths[-1].write_text("".join(",".join(row) + "\n" for row in rows))
        parts.append(paths)
    return parts[0], parts[1]


@pytest.fixture
def measured(shared: Path) -> Path:
    folder = shared / "measured"
    if not folder.is_dir():
        pytest.skip(f"'{folder}' is not there")
    return folder


def diagnosed(name: str, logs: tuple[list[Path], list[Path]]) -> dict[str, Any]:
    return diagnose_platform(read_platform(HERE / f"{name}.toml"), *logs).summary


@pytest.mark.parametrize(
    ("name", "source", "logs", "effect", "share"),
    [
        ("emps", "emps", positioning_system, "direction_dependent_friction", 0.7),
        ("servo_pendulum", "servo_pendulum", pendulum, "load_dependent_friction", 0.6),
    ],
)
def test_the_published_friction_is_named(
    name: str, source: str, logs: Any, effect: str, share: float, measured: Path, tmp_path: Path
) -> None:
    found = diagnosed(name, logs(measured / source, tmp_path))
    assert found["verdict"] == "partly_explained"
    assert [added["effect"] for added in found["added"]] == [effect]
    assert found["held_out"]["share"] > share
    assert found["hints"]
