"""A base that moves as sensors measure it: its motion is continuous, a torque is held by a drive.

The truth is SciPy's, with the continuous acceleration of the base and a torque that is constant
from sample to sample. A force on the mass m at the offset c of the centre of mass turns the pan
body: (J + m c^2) theta'' = tau - b theta' - m c a_y cos(theta).
"""

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp

import ptp_symbolic as ptp
from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.data import Log, read_log
from ptp_symbolic.numeric.data.latency import input_averages
from ptp_symbolic.numeric.identify.evaluate import Tolerance, evaluate
from ptp_symbolic.numeric.identify.run import thinned, with_inputs
from ptp_symbolic.numeric.identify.run_preparation import prepare_runs
from ptp_symbolic.platform import Platform, platform_text, read_platform

J, M, C, B = 0.3, 5.0, 0.05, 0.2  # SI
PERIOD, COUNT = 0.01, 400  # s between samples, a hundredth of a period of the base
# Lines are off by the trapezoidal rule's error h^2/12 of the change of a slope, at most twice the
# largest slope of the acceleration; a change of the rate is forgotten within J/b.
STEEPEST = 2.0 * np.pi * (1.5 + 0.3 * 0.5)  # m/s^3
BOUND = PERIOD**2 / 12 * 2 * STEEPEST * M * C / B  # rad
PLATFORM = """
platform = { name = "carriage", title = "Pan body on a carriage", axes = ["pan"] }
effects = [
    { effect = "rigid_bodies" },
    { effect = "viscous_friction", axis = "pan" },
    { effect = "pan_com_offset" },
    { effect = "base_acceleration" },
]

[parameters]
J_pan = { value = 0.3, unit = "kg m^2" }
b_pan = { value = 0.2, unit = "N m s/rad" }
m_pan_body = { value = 5.0, unit = "kg" }
c_x_pan = { start = 0.05, unit = "m" }
c_y_pan = { value = 0.0, unit = "m" }

[signals]
tau_pan = { role = "input", column = "torque", unit = "N m" }
acceleration_x_base = { role = "input", column = "ax", unit = "m/s^2" }
acceleration_y_base = { role = "input", column = "ay", unit = "m/s^2" }
acceleration_z_base = { role = "input", column = "az", unit = "m/s^2" }
theta_pan = { role = "output", column = "angle", unit = "rad", noise = 1e-5 }
"""
HELD = PLATFORM.replace('"m/s^2" }', '"m/s^2", interpolation = "hold" }')


def sway(t: float) -> float:
    """The acceleration of the base across the pan body at rest, in m/s^2."""
    return 1.5 * np.sin(2.0 * np.pi * t) + 0.5 * np.sin(2.0 * np.pi * 0.3 * t + 1.0)


@cache
def truth() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Times [k] in s, torques [k] in N m and angles [k] in rad."""
    torques = np.repeat(np.random.default_rng(4).normal(0.0, 0.3, COUNT // 20), 20)
    times, x, angles = PERIOD * np.arange(COUNT), np.zeros(2), []
    for t, torque in zip(times, torques, strict=True):
        angles.append(x[0])

        def slope(s: float, y: np.ndarray, torque: float = torque) -> list[float]:
            pull = -M * C * sway(s) * np.cos(y[0])
            return [y[1], (torque - B * y[1] + pull) / (J + M * C**2)]

        x = solve_ivp(slope, (t, t + PERIOD), x, rtol=1e-10, atol=1e-12).y[:, -1]
    return times, torques, np.array(angles)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with two platforms and a log."""
    place = tmp_path_factory.mktemp("carriage")
    (place / "lines.toml").write_text(PLATFORM, encoding="utf-8")
    (place / "held.toml").write_text(HELD, encoding="utf-8")
    times, torques, angles = truth()
    none = np.zeros(COUNT)
    rows = np.column_stack([times, torques, none, [sway(t) for t in times], none, angles])
    head = "time [s],torque,ax,ay,az,angle"
    np.savetxt(place / "run.csv", rows, "%.15g", ",", header=head, comments="")
    return place


def error_of(platform: Platform, log: Log, every: int = 1) -> float:
    """Largest error in rad of the angle at the true parameters, from rest at zero."""
    model = ptp.load(platform)
    (run,) = prepare_runs(model, platform, [log])
    run = replace(thinned(run, every), start=np.zeros(2), unknowns=())
    p, none = model.parameter_vector({"c_x_pan": C}), np.zeros(0, dtype=np.int64)
    found = evaluate(model, run, p, np.zeros(0), none, False, Tolerance(1e-8, 1e-9))
    assert found.failed is None
    return float(np.max(np.abs(found.residual))) / float(run.weight[0])


def test_the_motion_of_the_base_is_not_late(folder: Path) -> None:
    """A hold is late by half a sampling period, which a declared delay takes back."""
    lines, held = (read_platform(folder / f"{name}.toml") for name in ("lines", "held"))
    log = read_log(folder / "run.csv", lines)
    by_lines, by_steps = error_of(lines, log), error_of(held, log)
    assert by_lines < BOUND
    assert by_steps > 10 * BOUND
    half = f"delay = '{-500 * PERIOD} ms'"
    early = folder / "early.toml"
    early.write_text(HELD.replace('interpolation = "hold"', f'interpolation = "hold", {half}'))
    declared = read_platform(early)
    assert error_of(declared, read_log(folder / "run.csv", declared)) < BOUND


def test_a_delay_of_a_measured_input_moves_its_lines(folder: Path) -> None:
    """A sensor that shows the base 4 ms late, not a whole number of samples."""
    times, torques, angles = truth()
    late = np.column_stack([0 * times, [sway(t - 0.004) for t in times], 0 * times])
    rows = np.column_stack([times, torques, late, angles])
    head = "time [s],torque,ax,ay,az,angle"
    np.savetxt(folder / "late.csv", rows, "%.15g", ",", header=head, comments="")
    path = folder / "late.toml"
    path.write_text(PLATFORM.replace('"m/s^2" }', '"m/s^2", delay = "-4 ms" }'), encoding="utf-8")
    platform = read_platform(path)
    assert error_of(platform, read_log(folder / "late.csv", platform)) < BOUND


def test_fewer_samples_are_not_late_either(folder: Path) -> None:
    """With means over cells (h^2/24) at the ends of lines (h^2/12), three times as long."""
    platform = read_platform(folder / "lines.toml")
    bound = 9 * (1 + 1 / 2) * BOUND
    assert error_of(platform, read_log(folder / "run.csv", platform), 3) < bound


def test_samples_given_to_a_simulation_are_joined_by_lines(folder: Path) -> None:
    times, torques, angles = truth()
    samples = np.array([sway(t) for t in times])
    path = folder / "lines.toml"
    given = {"tau_pan": torques, "acceleration_y_base": samples}
    run = ptp.simulate(path, times, inputs=given, c_x_pan=C)
    assert np.max(np.abs(run["theta_pan"] - angles)) < BOUND
    from_log = ptp.simulate(path, times, inputs=folder / "run.csv", c_x_pan=C)
    assert np.max(np.abs(from_log["theta_pan"] - angles)) < BOUND
    between = run.inputs["acceleration_y_base"]
    assert np.array_equal(between, samples)


def test_the_offset_is_found_where_a_hold_would_hide_it(folder: Path) -> None:
    found = ptp.fit(folder / "lines.toml", [folder / "run.csv"]).parameters["c_x_pan"]
    assert found.value == pytest.approx(C, rel=1e-3)


@pytest.mark.parametrize("interpolation", ["hold", "linear"])
def test_averages_of_inputs(interpolation: str) -> None:
    rng = np.random.default_rng(2)
    time, values = np.sort(rng.uniform(0.0, 1.0, 9)), rng.normal(size=9)
    edges = np.sort(rng.uniform(-0.3, 1.3, 14))

    def signal(t: float) -> float:
        if interpolation == "linear":
            return float(np.interp(t, time, values))
        return float(values[max(0, np.searchsorted(time, t, side="right") - 1)])

    found = input_averages(time, values, edges, interpolation)
    for a, b, average in zip(edges[:-1], edges[1:], found, strict=True):
        inside = time[(time > a) & (time < b)]
        whole = quad(signal, a, b, points=inside if inside.size else None, epsabs=1e-12)[0]
        assert average == pytest.approx(whole / (b - a), abs=1e-9)


def test_other_values_keep_their_lines(folder: Path) -> None:
    """As the replays with more noise on the inputs have them."""
    platform = read_platform(folder / "lines.toml")
    (run,) = prepare_runs(ptp.load(platform), platform, [read_log(folder / "run.csv", platform)])
    assert run.interpolations == ("hold", "linear", "linear", "linear")
    again = with_inputs(run, run.held_inputs)
    assert np.array_equal(again.inputs.coefficients, run.inputs.coefficients)


def test_what_is_declared_is_written_and_refused(folder: Path) -> None:
    held = read_platform(folder / "held.toml")
    assert [s.between_samples for s in held.signals] == ["hold"] * 5
    path = folder / "copy.toml"
    path.write_text(platform_text(held), encoding="utf-8")
    assert replace(read_platform(path), source=None) == replace(held, source=None)
    for wrong, said in (
        (PLATFORM.replace('"N m" }', '"N m", interpolation = "cubic" }'), "hold, linear"),
        (PLATFORM.replace("noise = 1e-5", 'interpolation = "hold"'), "is for inputs"),
    ):
        path.write_text(wrong, encoding="utf-8")
        with pytest.raises(InputError, match=said):
            read_platform(path)
