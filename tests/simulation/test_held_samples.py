"""Exponential steps over the samples of held inputs: against the explicit method, and closed forms.

The machine is the pan drive of the field logs, its voltage held from sample to sample: the winding
has a time constant of a millisecond, beside a sampling period of five.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.linalg import expm

from ptp_symbolic.models import emission, variants
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.inputs import delay_columns, delayed, stack, table
from ptp_symbolic.numeric.simulation.integration import (
    Accuracy,
    Solution,
    geared_weights,
    integrate,
)
from ptp_symbolic.platform import EffectDeclaration, Platform, read_platform

PLATFORM = Path(__file__).parents[1] / "platforms" / "fieldlog_pan.toml"
PERIOD = 5e-3
TIMES = PERIOD * np.arange(601)
VOLTAGE = 8.0 * np.sin(5.0 * TIMES) + 3.0 * np.sin(17.0 * TIMES)  # V; reverses, crosses the gap
BY = ("J_pan", "F_c_pan", "F_v_pan", "d_shaft_pan", "b_pan")


@pytest.fixture(scope="module")
def drive() -> Model:
    return emission.emit(read_platform(PLATFORM))


def run(
    model: Model,
    tolerance: float,
    times: np.ndarray = TIMES,
    by: tuple[str, ...] = (),
    method: str = "rosenbrock",
    rough: bool = False,
    values: dict[str, float] | None = None,
    voltage: np.ndarray | None = None,
    most_steps: int = 10**6,
) -> Solution:
    """The drive from rest, the voltage held between `times`."""
    n = len(model.state_names)
    columns = np.array([model.parameter_names.index(name) for name in by], dtype=np.int64)
    voltage = np.interp(times, TIMES, VOLTAGE) if voltage is None else voltage
    found = integrate(
        model,
        method,
        model.parameter_vector(values),
        np.zeros(n),
        stack([table(times, voltage)]),
        True,
        times,
        times,
        Accuracy(tolerance, 0.01 * tolerance * geared_weights(model), 1.0, most_steps),
        np.zeros((n, len(by))) if by else None,
        columns,
        rough_tangents=rough,
        event_room=500,
    )
    assert found.status == 0
    return found


def test_most_samples_are_one_step_and_the_motion_is_that_of_the_explicit_method(
    drive: Model, figure
) -> None:
    exact, found = run(drive, 1e-10, method="runge_kutta"), run(drive, 1e-6)
    assert figure("error, rad", np.abs(found.x[:, 0] - exact.x[:, 0]).max()) < 1e-6
    assert len(exact.events) == len(found.events) >= 10
    np.testing.assert_array_equal(found.events[:, 1:], exact.events[:, 1:])
    assert figure("steps per sample", found.steps / (len(TIMES) - 1)) < 2.5


@pytest.mark.parametrize(("size", "seed"), [(6.0, 4), (9.0, 3)])
def test_what_turns_back_twice_within_a_sample_is_not_missed(
    drive: Model, size: float, seed: int, figure
) -> None:
    """A voltage that jumps at every sample by `size` V rms: a gear that hardly turns follows the
    winding, and stops before the sample is over. An event that is missed is felt for good.
    """
    voltage = size * np.random.default_rng(seed).standard_normal(len(TIMES))
    exact = run(drive, 1e-10, method="runge_kutta", voltage=voltage)
    found = run(drive, 1e-4, voltage=voltage)
    assert figure("error, rad", np.abs(found.x[:, 0] - exact.x[:, 0]).max()) < 1e-4
    assert len(found.events) == len(exact.events)


@pytest.mark.parametrize(("kind", "damping"), [("waves", 1.0), ("waves", 0.2), ("steps", 1.0)])
def test_a_gear_that_bounces_in_less_than_a_sample_loses_no_face(
    drive: Model, kind: str, damping: float, figure
) -> None:
    """The load, 0.05 + 0.05 kg m^2, swings on its shaft by sqrt(5000 / 0.1) = 224 rad/s, two thirds
    of a turn in a sample of 20 ms: the gear leaves a face and is back between two states of a step.
    """
    times = 0.02 * np.arange(301)
    waves = 8.0 * np.sin(5.0 * times) + 3.0 * np.sin(17.0 * times)
    voltage = waves if kind == "waves" else 6.0 * np.sign(np.sin(4.0 * times + 0.3))
    values = {"d_shaft_pan": damping}
    exact = run(drive, 1e-10, times, method="runge_kutta", voltage=voltage, values=values)
    found = run(drive, 1e-5, times, voltage=voltage, values=values)
    assert len(found.events) == len(exact.events) > 100
    assert figure("error, rad", np.abs(found.x[:, 0] - exact.x[:, 0]).max()) < 1e-6


def test_samples_at_uneven_times_are_left_to_the_adaptive_method(drive: Model) -> None:
    shaken = TIMES.copy()
    shaken[1:-1] += 1e-4 * np.random.default_rng(4).uniform(-1.0, 1.0, len(TIMES) - 2)
    exact, found = run(drive, 1e-10, shaken, method="runge_kutta"), run(drive, 1e-6, shaken)
    assert np.abs(found.x[:, 0] - exact.x[:, 0]).max() < 1e-6
    assert found.steps > 2 * (len(TIMES) - 1)


def test_heat_of_what_a_winding_does_between_samples_is_counted(figure) -> None:
    """The current follows every change of the voltage in a fifth of a sample."""
    model = emission.emit(variants.with_candidates(read_platform(PLATFORM)))
    heated, heat = {"k_heat_pan": 0.05, "t_heat_pan": 4.0}, model.state_names.index("heat_pan")
    exact = run(model, 1e-9, method="runge_kutta", values=heated)
    found = run(model, 1e-4, values=heated)
    error = np.abs(found.x[:, heat] - exact.x[:, heat]).max() / np.abs(exact.x[:, heat]).max()
    assert figure("error of the heat", error) < 1e-3


def test_rough_tangents_are_good_to_some_thousandths(drive: Model, figure) -> None:
    """Those that follow every step of the adaptive method are exact, at a fine tolerance."""
    exact = run(drive, 1e-8, by=BY)
    found = run(drive, 1e-5, by=BY, rough=True)
    assert found.steps < 0.5 * exact.steps
    for column, name in enumerate(BY):
        error = np.linalg.norm(found.s[:, 0, column] - exact.s[:, 0, column])
        assert figure(name, error / np.linalg.norm(exact.s[:, 0, column])) < 4e-3


def test_tangents_that_must_be_good_are_not_taken_by_exponential_steps(drive: Model) -> None:
    exact, found = run(drive, 1e-8, by=BY), run(drive, 1e-7, by=BY)
    for column in range(len(BY)):
        error = np.linalg.norm(found.s[:, 0, column] - exact.s[:, 0, column])
        assert error < 1e-5 * np.linalg.norm(exact.s[:, 0, column])


DELAY = 2.3e-3  # s; within a sample


def late_run(
    late: Model, delay: float, tolerance: float, method: str, by: tuple[str, ...] = ()
) -> Solution:
    """The drive with its voltage late by `delay` in s, and rough tangents."""
    n, shifted = len(late.state_names), delayed(stack([table(TIMES, VOLTAGE)]), np.array([delay]))
    columns = np.array([late.parameter_names.index(name) for name in by], dtype=np.int64)
    found = integrate(
        late,
        method,
        late.parameter_vector({"t_delay_pan": delay}),
        np.zeros(n),
        shifted,
        True,
        shifted.with_stops(TIMES),
        TIMES,
        Accuracy(tolerance, 0.01 * tolerance * geared_weights(late), 1.0, 10**6),
        np.zeros((n, len(by))) if by else None,
        columns,
        delay_columns(late, columns),
        rough_tangents=True,
    )
    assert found.status == 0
    return found


@pytest.fixture(scope="module")
def late() -> Model:
    platform = read_platform(PLATFORM)
    effects = (*platform.effects, EffectDeclaration("input_delay", "pan", None))
    return emission.emit(replace(platform, effects=effects))


def test_a_late_voltage_is_followed_by_steps_of_two_lengths(late: Model, figure) -> None:
    """From a sample to where the voltage jumps, and from there to the next."""
    exact = late_run(late, DELAY, 1e-10, "runge_kutta")
    found = late_run(late, DELAY, 1e-6, "rosenbrock")
    assert figure("error, rad", np.abs(found.x[:, 0] - exact.x[:, 0]).max()) < 1e-6
    assert figure("steps per sample", found.steps / (len(TIMES) - 1)) < 3.5


def test_tangents_by_a_delay_are_those_of_differences(late: Model, figure) -> None:
    """Central differences of the explicit method; where the voltage jumps, the tangent does."""
    step = 2e-5
    after, before = (
        late_run(late, DELAY + change, 1e-10, "runge_kutta").x[:, 0] for change in (step, -step)
    )
    truth = (after - before) / (2.0 * step)
    found = late_run(late, DELAY, 1e-5, "rosenbrock", by=("J_pan", "t_delay_pan")).s[:, 0, 1]
    assert figure("error", np.linalg.norm(found - truth) / np.linalg.norm(truth)) < 1e-2


def test_a_linear_drive_moves_as_the_exponential_says(figure) -> None:
    """Motor and load alone: x' = A x + b u, held from sample to sample, and its tangent by J."""
    names = ("rigid_bodies", "dc_motor", "viscous_friction")
    axes = (None, "pan", "pan")
    effects = tuple(EffectDeclaration(n, a, None) for n, a in zip(names, axes, strict=True))
    model = emission.emit(Platform("motor", "Motor", ("pan",), 9.81, effects, (), ()))
    n, p = len(model.state_names), model.parameter_vector(None)
    assert model.input_names == ("u_pan",)

    def matrices(inertia: float) -> tuple[np.ndarray, np.ndarray]:
        q = p.copy()
        q[model.parameter_names.index("J_pan")] = inertia
        a = [model.rhs(0.0, x, np.zeros(1), q) for x in np.eye(n)]
        return np.column_stack(a), model.rhs(0.0, np.zeros(n), np.ones(1), q)

    def moved(inertia: float) -> np.ndarray:
        a, b = matrices(inertia)
        whole = np.zeros((n + 1, n + 1))
        whole[:n, :n], whole[:n, n] = a, b
        step = expm(PERIOD * whole)
        x, found = np.zeros(n), [np.zeros(n)]
        for u in VOLTAGE[:-1]:
            x = step[:n, :n] @ x + step[:n, n] * u
            found.append(x)
        return np.array(found)

    inertia = float(p[model.parameter_names.index("J_pan")])
    found = run(model, 1e-6, by=("J_pan",), rough=True)
    assert found.steps < len(TIMES) + 10
    with pytest.raises(AssertionError):  # the run is exhausted
        run(model, 1e-6, most_steps=100)
    assert figure("error, rad", np.abs(found.x - moved(inertia)).max()) < 1e-9
    small = 1e-5 * inertia
    slope = (moved(inertia + small) - moved(inertia - small))[:, 0] / (2.0 * small)
    error = np.linalg.norm(found.s[:, 0, 0] - slope) / np.linalg.norm(slope)
    assert figure("error of the tangent", error) < 3e-4
