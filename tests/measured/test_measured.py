"""Two real machines: what is known to be missing in them is named, and predicts other runs better.

The data are Janot, Gautier and Brunot (2019) and Duclusaud et al. (2025); both sources report which
friction their machine has beyond Coulomb and viscous friction.
"""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.io import loadmat, savemat
from scipy.signal import butter, filtfilt

from ptp_symbolic.machines.study import EMPS_FILES, PLATFORMS, emps_logs, pendulum_logs
from ptp_symbolic.platform import read_platform
from ptp_symbolic.workflows.diagnosis import diagnose_platform

pytestmark = pytest.mark.long

Array = NDArray[np.float64]


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


FORCE = 35.1507  # N per volt
SMALL = 0.6 * np.sqrt(2.0)  # N; the amplitude of a wave of 0.6 N rms
STIFFNESS, MIDDLE = 7.26, 0.123  # N/m and m: 0.6 N rms over the stroke of the training file
TURN, BEND = 0.02, 0.1  # m; a turn of the screw, and of what bends the guide
COULOMB = 20.39  # N, as published


def spring(position: Array, rate: Array) -> Array:
    """Force [k, 1] in N."""
    return STIFFNESS * (position - MIDDLE)


def detents(position: Array, rate: Array) -> Array:
    """Force [k, 1] in N that comes back once per turn of the screw."""
    return SMALL * np.sin(2.0 * np.pi * position / TURN)


def bent_guide(position: Array, rate: Array) -> Array:
    """Dry friction [k, 1] in N that goes with the position."""
    return SMALL * np.sin(2.0 * np.pi * position / BEND) * np.sign(rate)


@pytest.mark.parametrize(
    ("force", "effect", "parameters", "size"),
    [
        (spring, "cable_spring", ("k1_cable_pan",), STIFFNESS),
        (detents, "cogging", ("T_sin_pan", "T_cos_pan"), SMALL),
        (bent_guide, "position_dependent_friction", ("f_sin_pan", "f_cos_pan"), SMALL / COULOMB),
    ],
)
def test_an_effect_of_half_a_newton_is_found(
    force: Callable[[Array, Array], Array],
    effect: str,
    parameters: tuple[str, ...],
    size: float,
    measured: Path,
    tmp_path: Path,
) -> None:
    """A machine with a further effect needs its force besides for the same motion: added to that of
    EMPS, whose own friction differs by direction. 0.6 N rms are 3 % of its friction.
    """
    for name in EMPS_FILES:
        content = loadmat(measured / "emps" / name)
        columns = {k: np.asarray(v) for k, v in content.items() if not k.startswith("__")}
        smooth = filtfilt(*butter(4, 0.04), columns["qm"], axis=0)  # 20 Hz of 1 kHz
        more = force(columns["qm"], np.gradient(smooth, axis=0))
        columns["vir"] = columns["vir"] + more / FORCE
        savemat(tmp_path / name, columns)
    found = diagnosed("emps", emps_logs(tmp_path))
    named = {added["effect"]: added["parameters"] for added in found["added"]}
    assert sorted(named) == sorted([effect, "direction_dependent_friction"])
    amounts = [named[effect][name]["value"] for name in parameters]
    assert np.linalg.norm(amounts) == pytest.approx(size, rel=0.2)
