"""Friction that falls with a measured temperature: found in logs of a machine that warms up.

The truth is written by hand and integrated by SciPy between reversals, which its events locate: a
torque that keeps sliding one way or the other turns a load against Coulomb and viscous friction.
"""

from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from ptp_symbolic import simulate
from ptp_symbolic.models import emission
from ptp_symbolic.platform import platform_text, read_platform
from ptp_symbolic.workflows.fit import fit_platform

TRUTH = {
    "J_pan": 0.05,
    "F_c_pan": 0.2,
    "F_v_pan": 0.3,
    "k_T_dry_pan": 0.004,
    "k_T_viscous_pan": 0.02,
}
REFERENCE, PERIOD, HOLD, DURATION, COUNTS = 20.0, 0.01, 0.5, 10.0, 65536
PLATFORM = """
[platform]
name = "bench"
axes = ["pan"]
[[effects]]
effect = "rigid_bodies"
[[effects]]
effect = "csvs_friction"
axis = "pan"
[[effects]]
effect = "temperature_dependent_friction"
axis = "pan"
[parameters]
J_pan = { start = 0.1, bounds = [0.001, 10.0] }
F_c_pan = { start = 0.4, bounds = [0.0, 5.0] }
F_s_pan = { same_as = "F_c_pan" }
F_v_pan = { start = 0.1, bounds = [0.0, 5.0] }
k_T_dry_pan = { start = 0.0 }
k_T_viscous_pan = { start = 0.0 }
[signals]
tau_pan = { role = "input", column = "torque", unit = "N m", noise = 0.0 }
[signals.temperature_pan]
role = "input"
column = "oil"
unit = "K"
scale = 1.0
offset = 20
noise = 0.0
[signals.theta_pan]
role = "output"
column = "angle"
unit = "rad"
counts_per_revolution = 65536
noise = 0.0
"""


def celsius(time: np.ndarray, first: float) -> np.ndarray:
    return first + 25.0 * (1.0 - np.exp(-time / 8.0))


def motion(torque: np.ndarray, warm: np.ndarray) -> np.ndarray:
    """Angle in rad at every sample of torque [n] in N m and temperature [n] in deg C, both held."""
    t, state, angles = TRUTH, [0.0, 0.0], [0.0]
    for tau, oil in zip(torque[:-1], warm[:-1], strict=True):
        dry = t["F_c_pan"] * np.exp(-t["k_T_dry_pan"] * (oil - REFERENCE))
        viscous = t["F_v_pan"] * np.exp(-t["k_T_viscous_pan"] * (oil - REFERENCE))
        left = PERIOD
        while left > 1e-12:
            way = np.sign(state[1]) or np.sign(tau)
            assert abs(tau) > dry, "the torque is to break it away at once"

            def rates(_, y, way=way, tau=tau, dry=dry, viscous=viscous):
                return [y[1], (tau - way * dry - viscous * y[1]) / t["J_pan"]]

            def stops(at, y, way=way):
                return y[1] if at > 1e-9 else way

            stops.terminal, stops.direction = True, -way
            found = solve_ivp(rates, (0.0, left), state, events=stops, rtol=1e-9, atol=1e-12)
            state = found.y[:, -1]
            if found.status == 1:
                state[1] = 0.0
            left -= found.t[-1]
        angles.append(state[0])
    return np.array(angles)


def write_logs(folder: Path) -> list[Path]:
    paths, time = [], PERIOD * np.arange(round(DURATION / PERIOD))
    for number, first in enumerate((5.0, 30.0)):
        rng = np.random.default_rng(number)
        size = rng.uniform(0.5, 1.5, round(DURATION / HOLD)) * (-1.0) ** np.arange(20)
        torque = np.repeat(size, round(HOLD / PERIOD))
        warm = np.round(celsius(time, first), 1)
        count = 2.0 * np.pi / COUNTS
        angle = np.rint(motion(torque, warm) / count) * count
        paths.append(folder / f"{number}.csv")
        table = np.column_stack([time, torque, warm, angle])
        header = "time [s],torque [N m],oil [degC],angle [rad]"
        np.savetxt(paths[-1], table, delimiter=",", header=header, comments="", fmt="%.9g")
    return paths


@pytest.mark.long
def test_both_falls_are_found_with_the_friction_that_they_act_on(tmp_path: Path) -> None:
    """Begun without any, and a factor of two to three off in the rest."""
    path = tmp_path / "bench.toml"
    path.write_text(PLATFORM, encoding="utf-8")
    logs = write_logs(tmp_path)
    found = fit_platform(read_platform(path), logs)
    for name, value in TRUTH.items():
        estimate = found.summary["parameters"][name]
        assert estimate["value"] == pytest.approx(value, rel=0.02), name
        low, high = estimate["ci95"]
        assert low - 0.5 * (high - low) <= value <= high + 0.5 * (high - low), name
    assert found.summary["error"]["after"]["total"]["rmse_counts"] < 0.35

    path.write_text(str(found.files["platform.toml"]), encoding="utf-8")
    again = read_platform(path)
    oil = next(s for s in again.signals if s.signal == "temperature_pan")
    assert (oil.scale, oil.offset) == (1.0, 20.0)
    assert platform_text(again) == found.files["platform.toml"]

    cold = PLATFORM.replace("k_T_dry_pan = { start", "k_T_dry_pan = { value")
    cold = cold.replace("k_T_viscous_pan = { start", "k_T_viscous_pan = { value")
    path.write_text(cold, encoding="utf-8")
    without = fit_platform(read_platform(path), logs).summary
    assert without["error"]["after"]["total"]["rmse_counts"] > 30.0


@pytest.mark.parametrize("warmer", [-15.0, 0.0, 30.0])
def test_a_steady_speed_follows_the_temperature(tmp_path: Path, warmer: float) -> None:
    """At rest acceleration is zero: torque less dry friction, over viscous friction."""
    path = tmp_path / "bench.toml"
    path.write_text(PLATFORM.replace("start =", "value ="), encoding="utf-8")
    model = emission.emit(read_platform(path))
    run = simulate(
        model,
        20.0,
        {"tau_pan": "constant:1.0", "temperature_pan": f"constant:{warmer}"},
        parameters={**TRUTH, "F_s_pan": TRUTH["F_c_pan"]},
    )
    dry = TRUTH["F_c_pan"] * np.exp(-TRUTH["k_T_dry_pan"] * warmer)
    viscous = TRUTH["F_v_pan"] * np.exp(-TRUTH["k_T_viscous_pan"] * warmer)
    assert run["omega_pan"][-1] == pytest.approx((1.0 - dry) / viscous, rel=1e-6)
