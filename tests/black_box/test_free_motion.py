"""A learned torque in free simulation: a joint on a spring that only the torque knows."""

from pathlib import Path

import numpy as np
import pytest

from ptp_symbolic.models import emission
from ptp_symbolic.numeric.black_box import FreeRuns, free_error, simulated
from ptp_symbolic.numeric.data import Log
from ptp_symbolic.numeric.identify.evaluate import Tolerance
from ptp_symbolic.numeric.identify.run_preparation import prepare_runs
from ptp_symbolic.platform import read_platform

PLATFORM = """
[platform]
name = "spring_bench"
axes = ["pan"]
[[effects]]
effect = "rigid_bodies"
[[effects]]
effect = "constant_torque"
axis = "pan"
[parameters]
J_pan = { value = 0.5, unit = "kg m^2" }
tau0_pan = { value = 0.0, unit = "N m" }
[signals]
tau_pan = { role = "input", column = "torque", unit = "N m", noise = 0.0 }
theta_pan = { role = "output", column = "angle", unit = "rad", counts_per_revolution = 7200 }
"""
J, SPRING, PERIOD = 0.5, 2.0, 0.01  # kg m^2, N m/rad, s
COUNT = 2.0 * np.pi / 7200.0


def held_spring(samples: int, push: float) -> np.ndarray:
    """Angle [n] in rad of J theta'' = push - k theta(t_n) from sample to sample, in closed form."""
    angle, rate, angles = 0.3, 0.0, []
    for _ in range(samples):
        angles.append(angle)
        acceleration = (push - SPRING * angle) / J
        angle += PERIOD * rate + 0.5 * PERIOD**2 * acceleration
        rate += PERIOD * acceleration
    return np.array(angles)


@pytest.fixture(scope="module")
def free(tmp_path_factory: pytest.TempPathFactory) -> FreeRuns:
    path: Path = tmp_path_factory.mktemp("platform") / "spring_bench.toml"
    path.write_text(PLATFORM)
    platform = read_platform(path)
    model = emission.emit(platform)
    logs = [
        Log(name, PERIOD * np.arange(n), np.full((n, 1), push), held_spring(n, push)[:, None])
        for name, n, push in (("long", 300, 0.1), ("short", 120, -0.2))
    ]
    runs = prepare_runs(model, platform, logs)
    starts = [np.zeros(len(run.unknowns)) for run in runs]
    return FreeRuns(
        model, runs, model.parameter_vector(model.defaults), (starts,), Tolerance(1e-9, 1e-10)
    )


def rested(free: FreeRuns) -> FreeRuns:
    """All runs from rest, as the closed form is."""
    for run in free.runs:
        run.start[free.model.state_names.index("omega_pan")] = 0.0
    return free


def test_a_torque_acts_from_sample_to_sample_on_runs_of_any_length(free: FreeRuns) -> None:
    rested(free)
    found = simulated(free, free.starts[0], {"pan": lambda seen: -SPRING * seen[:, 0]})
    angle = free.model.state_names.index("theta_pan")
    for states, run, push in zip(found, free.runs, (0.1, -0.2), strict=True):
        np.testing.assert_allclose(states[:, angle], held_spring(len(run.time), push), atol=1e-6)


def test_the_error_is_that_of_all_samples_from_the_better_start(free: FreeRuns) -> None:
    rested(free)
    right = free_error(free, {"pan": lambda seen: -SPRING * seen[:, 0]})
    none = free_error(free, {"pan": lambda seen: np.zeros(len(seen))})
    assert right is not None and none is not None
    assert right["rmse"] < 1e-6
    # without a spring the joint is pushed away: theta = 0.3 + push t^2 / (2 J)
    left = [
        held_spring(len(run.time), push) - 0.3 - push * run.time**2 / (2.0 * J)
        for run, push in zip(free.runs, (0.1, -0.2), strict=True)
    ]
    rms = float(np.sqrt(np.mean(np.concatenate(left) ** 2)))
    assert none["rmse"] == pytest.approx(rms, rel=1e-5)
    assert none["rmse_counts"] == pytest.approx(rms / COUNT, rel=1e-5)
    both = FreeRuns(
        free.model,
        free.runs,
        free.p,
        ([z + 1e-3 for z in free.starts[0]], free.starts[0]),
        free.tolerance,
    )
    better = free_error(both, {"pan": lambda seen: -SPRING * seen[:, 0]})
    assert better is not None and better["rmse"] == pytest.approx(right["rmse"])


def test_a_torque_that_throws_the_machine_away_has_no_error(free: FreeRuns) -> None:
    thrown = free_error(free, {"pan": lambda seen: np.full(len(seen), np.nan)})
    assert thrown is None
    assert free_error(free, {"tilt": lambda seen: np.zeros(len(seen))}) is None
