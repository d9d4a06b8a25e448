"""Effects that are off change nothing, and their states stand still unless they are asked for.

The model is a pan drive with every candidate; what it does without them is known from a model that
never had any.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from ptp_symbolic import simulate
from ptp_symbolic.models import emission, variants
from ptp_symbolic.numeric.simulation.inputs import stack, table
from ptp_symbolic.numeric.simulation.integration import Accuracy, geared_weights, integrate
from ptp_symbolic.platform import read_platform

PLATFORM = Path(__file__).parents[1] / "platforms" / "fieldlog_pan.toml"
TIMES = np.arange(0.0, 3.0, 0.005)
VOLTAGE = 8.0 * np.sin(5.0 * TIMES) + 3.0 * np.sin(17.0 * TIMES)  # V; reverses, crosses the gap


@pytest.fixture(scope="module")
def declared():
    return emission.emit(read_platform(PLATFORM))


@pytest.fixture(scope="module")
def union():
    """The platform with every candidate."""
    platform = read_platform(PLATFORM)
    others = variants.candidate_effects(platform)
    return emission.emit(replace(platform, effects=(*platform.effects, *others)))


def run(model, values, by=()):
    """Angle, rate and current [k, 3] and their tangents by the parameters `by`."""
    p = model.parameter_vector(values)
    n = len(model.state_names)
    columns = np.array([model.parameter_names.index(name) for name in by], dtype=np.int64)
    solution = integrate(
        model,
        "rosenbrock",
        p,
        np.zeros(n),
        stack([table(TIMES, VOLTAGE)]),
        True,
        TIMES,
        TIMES,
        Accuracy(1e-6, 1e-8 * geared_weights(model), 1.0),
        np.zeros((n, len(columns))) if by else None,
        columns,
    )
    assert solution.status == 0
    shown = [model.state_names.index(name) for name in ("theta_pan", "omega_pan", "i_pan")]
    return solution.x[:, shown], solution.s[:, shown]


def test_a_model_with_every_effect_off_moves_as_one_without_any(declared, union) -> None:
    every, plain = run(union, {}), run(declared, {})
    np.testing.assert_allclose(every[0], plain[0], rtol=0.0, atol=1e-9)


def test_states_stand_still_while_their_effect_is_off_and_not_asked_for(union) -> None:
    p, none = union.parameter_vector({}), np.zeros(0, dtype=np.int64)
    count = len(union.state_names)
    assert union.state_names[-3:] == ("rest_time_pan", "heat_pan", "z_loss_pan")
    assert union.acting(p, none) == count - 3
    heat = np.array([union.parameter_names.index("k_heat_pan")], dtype=np.int64)
    assert union.acting(p, heat) == count - 1
    p[heat] = 0.01
    assert union.acting(p, none) == count - 1
    for parameter, acting in (("mu_avg_pan", count), ("a_rest_pan", count - 2)):
        assert union.acting(union.parameter_vector({parameter: 0.2}), none) == acting


def test_a_state_of_an_effect_that_is_off_stands_still_in_every_run(union) -> None:
    """The losses of a gear come up over an angle, whatever they are: at none, nothing is seen."""
    u = {"u_pan": table(TIMES, VOLTAGE)}
    off, on = (simulate(union, TIMES, u, {"mu_avg_pan": v})["z_loss_pan"] for v in (0.0, 0.1))
    assert not off.any()
    assert on.max() > 0.99 and on.min() < -0.99


def test_derivatives_by_an_effect_that_is_off_are_not_lost(union) -> None:
    step = 1e-4
    by = ("beta_base", "k_heat_pan")
    _, tangents = run(union, {}, by)
    for column, name in enumerate(by):
        moved, here = (run(union, {name: v})[0] for v in (step, 0.0))
        slope = (moved - here)[:, 0] / step
        error = np.linalg.norm(tangents[:, 0, column] - slope)
        assert error < 0.02 * np.linalg.norm(slope)
