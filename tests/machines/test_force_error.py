"""The force error against the figures that its authors publish, and of a motion that is known."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from ptp_symbolic.errors import InputError
from ptp_symbolic.machines.study import EMPS_FILES, PLATFORMS, force_error, machines
from ptp_symbolic.numeric.data import read_log
from ptp_symbolic.platform import EffectDeclaration, read_platform
from ptp_symbolic.report.machines import render_machines

PLATFORM = read_platform(PLATFORMS / "emps.toml")


def test_the_error_is_the_share_of_the_force_that_a_wrong_mass_makes() -> None:
    """A sine of 2 Hz without friction: the force goes with the mass, far below the filter, whose
    ends leave 0.12 %.
    """
    time = np.arange(0.0, 5.0, 1e-3)
    position = 0.1 * np.sin(4.0 * np.pi * time)
    force = -(100.0 * (4.0 * np.pi) ** 2) * position
    free = {"F_c_pan": 0.0, "F_s_pan": 0.0, "F_v_pan": 0.0}
    for mass, percent in ((100.0, 0.0), (97.0, 3.0), (110.0, 10.0)):
        found = force_error(PLATFORM, {"m_pan": mass, **free}, time, force, position)
        assert found == pytest.approx(percent, abs=0.15)


def test_a_force_that_is_held_acts_between_its_samples() -> None:
    """100 kg under a force that is held for 1 ms each: speed and position are sums in closed form.
    Read at its samples, the force is half a period late: 0.628 % at 2 Hz.
    """
    time = np.arange(0.0, 5.0, 1e-3)
    force = 1000.0 * np.sin(4.0 * np.pi * (time + 0.5e-3))
    speed = np.append(0.0, np.cumsum(force[:-1]) * 1e-5) - 1000.0 / 100.0 / (4.0 * np.pi)
    step = 1e-3 * speed[:-1] + 0.5e-6 * force[:-1] / 100.0
    position = np.append(0.0, np.cumsum(step))
    values = {"m_pan": 100.0, "F_c_pan": 0.0, "F_s_pan": 0.0, "F_v_pan": 0.0}
    late, held = (
        force_error(PLATFORM, values, time, force, position, hold) for hold in (False, True)
    )
    assert held < 0.15
    assert late**2 - held**2 == pytest.approx(0.628**2, rel=0.1)


def test_a_force_that_acts_late_is_compared_with_what_is_needed_then() -> None:
    """A sine of 2 Hz that the logged force leads by 5 ms: 6.28 % unless the model knows it."""
    time = np.arange(0.0, 5.0, 1e-3)
    position = 0.1 * np.sin(4.0 * np.pi * time)
    force = -10.0 * (4.0 * np.pi) ** 2 * np.sin(4.0 * np.pi * (time + 5e-3))
    values = {"m_pan": 100.0, "F_c_pan": 0.0, "F_s_pan": 0.0, "F_v_pan": 0.0}
    late = EffectDeclaration("input_delay", "pan", None)
    platform = replace(PLATFORM, effects=(*PLATFORM.effects, late))
    for delay, percent in ((0.0, 6.28), (5e-3, 0.0)):
        found = force_error(platform, values | {"t_delay_pan": delay}, time, force, position)
        assert found == pytest.approx(percent, abs=0.15)


def test_the_published_model_of_emps_has_the_published_error(shared: Path) -> None:
    """4.0834 % and 5.9824 % with an offset of -3.1648 N, which is added to the force here."""
    folder = shared / "measured" / "emps"
    if not folder.is_dir():
        pytest.skip(f"'{folder}' is not there")
    values = {"m_pan": 95.1089, "F_v_pan": 203.5034, "F_c_pan": 20.3935, "F_s_pan": 20.3935}
    for name, published in zip(EMPS_FILES, (4.0834, 5.9824), strict=True):
        log = read_log(folder / name, PLATFORM)
        force = log.inputs[:, 0]
        found = force_error(PLATFORM, values, log.time, force + 3.1648, log.outputs[:, 0])
        scale = np.linalg.norm(force + 3.1648) / np.linalg.norm(force)
        assert found * scale == pytest.approx(published, rel=0.02)


def test_a_folder_without_machines_is_refused_and_one_with_drives_alone_gives_a_page(
    tmp_path: Path, shared: Path
) -> None:
    with pytest.raises(InputError, match="has none of the folders emps, servo_pendulum"):
        machines(tmp_path)
    drives = shared / "measured" / "screw_drives"
    if not drives.is_dir():
        pytest.skip(f"'{drives}' is not there")
    (tmp_path / "screw_drives").symlink_to(drives)
    page = render_machines(machines(tmp_path))
    assert "Coulomb, Stribeck, viscous" in page
    assert "EMPS" not in page
