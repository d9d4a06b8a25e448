"""Fits of one machine at the rates at which laboratories log, from rest and moving.

The truth is a set-valued integration of its own: implicit Euler steps of 10 us, in which dry
friction takes away what momentum it can (Moreau, 1988), 500 times finer than the finest window of
what is fitted; the command is held from sample to sample, the angle rounded to counts.
"""

from pathlib import Path

import numpy as np
import pytest
from numba import njit

from ptp_symbolic.errors import InputError
from ptp_symbolic.platform import read_platform
from ptp_symbolic.workflows.fit import fit_platform

TRUTH = {"J_pan": 0.26, "F_c_pan": 0.5, "F_v_pan": 0.4}
COUNTS, STEP, DURATION = 65536, 1e-5, 6.0
PLATFORM = """
[platform]
name = "bench"
axes = ["pan"]
[[effects]]
effect = "rigid_bodies"
[[effects]]
effect = "csvs_friction"
axis = "pan"
[parameters]
J_pan = { start = 0.1, bounds = [0.001, 10.0] }
F_c_pan = { start = 0.2, bounds = [0.0, 5.0] }
F_s_pan = { same_as = "F_c_pan" }
F_v_pan = { start = 0.1, bounds = [0.0, 10.0] }
[signals]
tau_pan = { role = "input", column = "torque", unit = "N m", noise = 0.0 }
[signals.theta_pan]
role = "output"
column = "angle"
unit = "rad"
counts_per_revolution = 65536
noise = 0.0
"""


@njit(cache=True)
def angles(torque, inertia, dry, viscous, rate, steps, step):
    """Angle in rad at every sample of a `torque` [k] in N m held for so many steps."""
    found, angle = np.zeros(len(torque)), 0.0
    for k in range(len(torque)):
        found[k] = angle
        for _ in range(steps):
            free = (rate + step * torque[k] / inertia) / (1.0 + step * viscous / inertia)
            most = step * dry / (inertia + step * viscous)
            after = np.sign(free) * max(abs(free) - most, 0.0)
            angle += 0.5 * step * (rate + after)
            rate = after
    return found


def write_logs(folder: Path, rate: int, moving: bool) -> list[Path]:
    """Three logs sampled at `rate` in Hz, that begin at rest or at 1.5 rad/s."""
    rng, paths = np.random.default_rng(7), []
    time = np.arange(round(DURATION * rate)) / rate
    for number in range(3):
        tones, phases = rng.uniform(0.2, 2.0, 4), rng.uniform(0.0, 2.0 * np.pi, 4)
        torque = np.sin(2.0 * np.pi * np.outer(time, tones) + phases).sum(axis=1)
        first = 1.5 * (-1.0) ** number if moving else 0.0
        truth = angles(torque, *TRUTH.values(), first, round(1.0 / rate / STEP), STEP)
        count = 2.0 * np.pi / COUNTS
        angle = np.rint((truth + rng.uniform(0.0, count)) / count) * count
        paths.append(folder / f"{number}.csv")
        header = "time [s],torque [N m],angle [rad]"
        table = np.column_stack([time, torque, angle])
        np.savetxt(paths[-1], table, delimiter=",", header=header, comments="", fmt="%.9g")
    return paths


def fitted(folder: Path, rate: int, moving: bool, settings: str = "") -> dict:
    path = folder / "bench.toml"
    path.write_text(PLATFORM + settings)
    return fit_platform(read_platform(path), write_logs(folder, rate, moving)).summary


@pytest.mark.parametrize("moving", [False, True])
@pytest.mark.parametrize("rate", [20, 50, 100, 250, 1000])
def test_a_machine_is_found_at_any_rate(rate: int, moving: bool, tmp_path: Path) -> None:
    """Begun a factor of 2.5 off. What is left is rounding, 0.289 counts."""
    found = fitted(tmp_path, rate, moving)
    for name, value in TRUTH.items():
        assert found["parameters"][name]["value"] == pytest.approx(value, rel=1e-3), name
    assert found["error"]["after"]["total"]["rmse_counts"] < 0.35
    assert found["error"]["noise_floor"]["total"]["rmse_counts"] == pytest.approx(0.289, rel=0.02)


@pytest.mark.parametrize(
    ("lost", "said"),
    [(33, "runs of their own"), (4, "missing at one place"), (1, "missing at one")],
)
def test_a_gap_in_which_nobody_knows_the_torque_is_no_error(
    lost: int, said: str, tmp_path: Path
) -> None:
    """A third of a second of every log is lost; held through it, the torque would be off by up to
    2 N m, the angle by a thousand counts. A single sample lost still leaves 10 counts.
    """
    path = tmp_path / "bench.toml"
    path.write_text(PLATFORM)
    logs = write_logs(tmp_path, 100, True)
    for log in logs:
        rows = log.read_text().splitlines(keepends=True)
        log.write_text("".join(rows[:250] + rows[250 + lost :]))
    found = fit_platform(read_platform(path), logs).summary
    for name, value in TRUTH.items():
        assert found["parameters"][name]["value"] == pytest.approx(value, rel=1e-3), name
    assert found["error"]["after"]["total"]["rmse_counts"] < 0.35
    assert sum(said in remark for remark in found["remarks"]) == 3


def test_the_length_of_windows_can_be_given(tmp_path: Path) -> None:
    found = fitted(tmp_path, 100, True, '[fit]\nwindow = "500 ms"\n')
    assert found["windows"]["count"] == 36
    assert found["windows"]["seconds"] == pytest.approx(0.5, rel=0.01)
    assert found["parameters"]["J_pan"]["value"] == pytest.approx(TRUTH["J_pan"], rel=2e-3)
    assert fitted(tmp_path, 100, True, '[fit]\nwindow = "1 min"\n')["windows"] is None
    with pytest.raises(InputError, match=r"fewer than 10 samples .* 0.01 s; give at least 0.1 s"):
        fitted(tmp_path, 100, True, '[fit]\nwindow = "50 ms"\n')
