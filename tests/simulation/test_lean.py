"""Effects that are off are left out of a simulation, and nothing else changes.

The model is a pan drive with every candidate; what it does without them is known from a model that
never had any, and from the emitted functions as they are.
"""

import os
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from ptp_symbolic import simulate
from ptp_symbolic.models import emission, variants
from ptp_symbolic.numeric.simulation.inputs import stack, table
from ptp_symbolic.numeric.simulation.integration import Accuracy, geared_weights, integrate
from ptp_symbolic.numeric.simulation.kernels import specialised
from ptp_symbolic.platform import read_platform

PLATFORM = Path(__file__).parents[1] / "platforms" / "fieldlog_pan.toml"
TIMES = np.arange(0.0, 3.0, 0.005)
VOLTAGE = 8.0 * np.sin(5.0 * TIMES) + 3.0 * np.sin(17.0 * TIMES)  # V; reverses, crosses the gap
STATM = Path("/proc/self/statm")
HEATED = {"k_heat_pan": 0.05, "t_heat_pan": 4.0}


@pytest.fixture(scope="module")
def declared():
    return emission.emit(read_platform(PLATFORM))


@pytest.fixture(scope="module")
def union():
    """The platform with every candidate."""
    platform = read_platform(PLATFORM)
    others = variants.candidate_effects(platform)
    return emission.emit(replace(platform, effects=(*platform.effects, *others)))


@pytest.fixture
def at_once(monkeypatch):
    """Functions are compiled for the zeros of the first run that meets them."""
    monkeypatch.setattr(specialised, "PAYS_AFTER", 0)
    specialised.specialised.cache_clear()
    yield
    specialised.specialised.cache_clear()


def run(model, values, by=(), *, lean):
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
        lean=lean,
    )
    assert solution.status == 0
    shown = [model.state_names.index(name) for name in ("theta_pan", "omega_pan", "i_pan")]
    return solution.x[:, shown], solution.s[:, shown]


OFF = {}
ON = {"beta_base": 0.05, "alpha_base": 0.4, "T_sin_pan": 0.3, "n_cog_pan": 24.0}
BY = ("J_pan", "F_c_pan", "beta_base", "T_cos_pan")


@pytest.mark.parametrize("values", [OFF, ON, ON | HEATED], ids=["off", "two on", "heated too"])
def test_functions_compiled_for_zeros_give_the_same_bits(union, at_once, values) -> None:
    for by in ((), BY):
        lean, whole = (run(union, values, by, lean=lean) for lean in (True, False))
        np.testing.assert_array_equal(lean[0], whole[0])
        np.testing.assert_allclose(lean[1], whole[1], rtol=1e-9, atol=1e-12)


def test_a_model_with_every_effect_off_moves_as_one_without_any(declared, union, at_once) -> None:
    lean, plain = run(union, OFF, lean=True), run(declared, OFF, lean=False)
    np.testing.assert_allclose(lean[0], plain[0], rtol=0.0, atol=1e-9)


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


def test_derivatives_by_an_effect_that_is_off_are_not_lost(union, at_once) -> None:
    step = 1e-4
    by = ("beta_base", "k_heat_pan")
    _, tangents = run(union, OFF, by, lean=True)
    for column, name in enumerate(by):
        moved, here = (run(union, {name: v}, lean=True)[0] for v in (step, 0.0))
        slope = (moved - here)[:, 0] / step
        error = np.linalg.norm(tangents[:, 0, column] - slope)
        assert error < 0.02 * np.linalg.norm(slope)


def test_a_parameter_may_be_asked_for_twice(union, at_once) -> None:
    """As one that follows another one in a fit is."""
    twice = ("F_s_pan", "J_pan", "F_s_pan")
    lean, whole = (run(union, ON, twice, lean=lean) for lean in (True, False))
    np.testing.assert_allclose(lean[1], whole[1], rtol=1e-9, atol=1e-12)
    np.testing.assert_array_equal(lean[1][..., 0], lean[1][..., 2])


def test_it_is_compiled_once_and_only_where_it_pays(union, monkeypatch) -> None:
    specialised.specialised.cache_clear()
    monkeypatch.setattr(specialised, "PAYS_AFTER", 2 * len(TIMES))
    compiled = specialised.specialised(union.module)
    for runs, ready in ((1, 0), (2, 1), (3, 1)):
        run(union, OFF, lean=True)
        assert len(compiled.ready) == ready, runs
    specialised.specialised.cache_clear()


@pytest.mark.skipif(not STATM.exists(), reason="memory is read as Linux tells it")
def test_what_is_compiled_takes_little_memory(union, at_once) -> None:
    """In MB for every set of zeros: 2.8 with an engine for every function, 0.4 with one in all."""

    def resident() -> float:
        return int(STATM.read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 1e6

    steps, warm = [], 8
    for pair in list(pairwise(union.parameter_names))[: 3 * warm]:
        run(union, ON, pair, lean=True)
        steps.append(resident())
    compiled = len(specialised.specialised(union.module).ready)
    assert compiled == 3 * warm
    assert (steps[-1] - steps[warm - 1]) / (compiled - warm) < 1.0
