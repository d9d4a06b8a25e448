"""An encoder behind a filter of first order: steady lag, response to a sine, untouched motion."""

import math

import numpy as np
import pytest

from ptp_symbolic import simulate
from ptp_symbolic.models import emission
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.run import Trajectory
from ptp_symbolic.platform import EffectDeclaration, Platform

BODIES = EffectDeclaration("rigid_bodies", None, None)
LAGGING = (BODIES, EffectDeclaration("measurement_lag", "pan", None))
TIME = 0.03  # s
VALUES = {"J_pan": 0.2, "t_lag_pan": TIME}


def platform(*effects: EffectDeclaration) -> Platform:
    return Platform("lagging", "Pan axis behind a filter", ("pan",), 9.81, effects, (), ())


@pytest.fixture(scope="module")
def model() -> Model:
    return emission.emit(platform(*LAGGING))


def reading(model: Model, found: Trajectory) -> np.ndarray:
    """What the encoder shows along a run [k]."""
    p, y = model.parameter_vector(VALUES), np.zeros(len(model.output_names))
    shown = []
    for t, x in zip(found.t, found.x, strict=True):
        model.module.outputs(t, x, np.zeros(1), p, y)
        shown.append(y[model.output_names.index("theta_pan")])
    return np.array(shown)


def test_a_steady_rate_is_read_late_by_the_time_constant(model: Model) -> None:
    """From rest of the filter the lag settles as 1 - exp(-t/T)."""
    rate = 0.7
    found = simulate(model, 0.5, None, VALUES, {"theta_pan": 0.2, "omega_pan": rate})
    late = rate * TIME * (1.0 - np.exp(-found.t / TIME))
    assert reading(model, found) == pytest.approx(0.2 + rate * found.t - late, abs=1e-8)


@pytest.mark.parametrize("frequency", [1.0, 5.0, 20.0])
def test_a_sine_is_read_smaller_and_later(model: Model, frequency: float) -> None:
    turn, inertia = 2.0 * math.pi * frequency, VALUES["J_pan"]
    start = {"omega_pan": -1.0 / (inertia * turn)}  # so that the angle is a sine without drift
    end = 20.0 * TIME + 3.0 / frequency
    found = simulate(
        model, end, {"tau_pan": f"multisine:1@{frequency}"}, VALUES, start, rtol=1e-10, atol=1e-13
    )
    assert found["theta_pan"] == pytest.approx(
        -np.sin(turn * found.t) / (inertia * turn**2), abs=1e-8
    )
    size = 1.0 / math.hypot(1.0, turn * TIME)
    settled = found.t > 16.0 * TIME
    phase = turn * found.t[settled] - math.atan(turn * TIME)
    expected = -size * np.sin(phase) / (inertia * turn**2)
    assert reading(model, found)[settled] == pytest.approx(expected, abs=1e-6 / turn)


def test_the_motion_knows_nothing_of_it(model: Model) -> None:
    bare = emission.emit(platform(BODIES))
    driving = {"tau_pan": "multisine:0.4@0.9,2.3"}
    seen = simulate(model, 1.0, driving, VALUES, rtol=1e-10, atol=1e-12)
    true = simulate(bare, 1.0, driving, {"J_pan": VALUES["J_pan"]}, rtol=1e-10, atol=1e-12)
    assert seen["theta_pan"] == pytest.approx(true["theta_pan"], abs=1e-9)
