"""A limit that nothing reaches where it vanishes: it begins where the logs meet it, and comes ever
closer to their largest value until its response is small enough to tell.
"""

from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from ptp_symbolic.numeric.diagnose import responses
from ptp_symbolic.numeric.diagnose.candidates import Candidate, within_reach
from ptp_symbolic.numeric.diagnose.confirm import is_amount_known
from ptp_symbolic.numeric.diagnose.fitted_model import FittedModel
from ptp_symbolic.numeric.diagnose.gain import p_value
from ptp_symbolic.numeric.diagnose.responses import effect_of, response_columns
from ptp_symbolic.numeric.identify.coordinates import free_parameter
from tests.identify.straight import finished, run_of

LARGEST = 24.0  # V
TIME = np.linspace(0.0, 1.0, 101)
LIMIT = Candidate(
    "voltage_saturation",
    "pan",
    "a limit",
    "",
    (free_parameter("u_max_pan", 10.0, 1e-3, 1e6),),
    {"u_max_pan": 1e6},
)
MODEL = cast(
    Any,
    SimpleNamespace(
        input_names=("voltage_tilt", "voltage_pan"),
        units={
            "voltage_tilt": "V",
            "voltage_pan": "V",
            "u_max_pan": "V",
            "u0": "V",
            "k_stop_pan": "N m/rad",
        },
    ),
)


def test_a_limit_begins_just_below_the_largest_value_of_its_axis() -> None:
    limit = within_reach(LIMIT, MODEL, np.array([100.0, LARGEST]))
    (f,) = limit.free
    assert 0.9 * LARGEST < f.start < LARGEST
    assert limit.is_limit(f)


def test_a_limit_that_cuts_little_off_is_told_from_none_by_little() -> None:
    """From the largest value on it does nothing: at half of it, the effect is by one half, not by
    how much less it is than the million at which it is off in the equations; and a limit that is
    known to 70 % is not told from none.
    """
    limit = within_reach(LIMIT, MODEL, np.array([0.0, LARGEST]))
    (f,) = limit.free
    slope = np.sin(0.1 * np.arange(300))
    rng = np.random.default_rng(5)
    residual = rng.standard_normal(300)
    residual -= slope * (slope @ residual) / (slope @ slope)
    for size, told in ((0.12, False), (3.0, True)):  # sqrt(150) * 0.12 = 1.5 deviations
        table = [size * slope[:, None]]
        fit = finished([residual], table, None, (f,), {"u_max_pan": 0.5 * LARGEST})
        effect = effect_of(fit, limit.vanishing, table[0])
        assert effect == pytest.approx(-size * slope)
        assert is_amount_known(fit, limit) is told
        assert (p_value(FittedModel((limit,), fit), limit.vanishing) < 0.01) is told


def test_other_parameters_begin_where_they_did() -> None:
    offset = Candidate(
        "voltage_offset", "pan", "", "", (free_parameter("u0", 0.3, -9.0, 9.0),), {"u0": 0.0}
    )
    assert within_reach(offset, MODEL, np.array([100.0, LARGEST])) == offset


@pytest.mark.parametrize("most", [1e9, 20.0, 2.0, 0.2])
def test_a_response_stays_below_what_is_asked(monkeypatch: pytest.MonkeyPatch, most: float) -> None:
    """A ramp up to 24 V: what a limit cuts off is its excess, so that the response is known."""
    ramp = LARGEST * TIME

    def cut_off(problem: Any, fit: Any, values: dict[str, float], executor: Any) -> list[Any]:
        left = np.maximum(ramp - values.get("u_max_pan", 1e6), 0.0)
        return [SimpleNamespace(residual=left, failed=None)]

    monkeypatch.setattr(responses, "simulated", cut_off)
    monkeypatch.setattr(responses, "stacked", lambda fit, columns: columns[0])
    run = run_of(len(TIME))
    plain = SimpleNamespace(residual=np.zeros(len(TIME)))
    trial = cast(
        Any, SimpleNamespace(keys=(), fit=SimpleNamespace(runs=(run,), evaluations=[plain]))
    )
    limit = within_reach(LIMIT, MODEL, np.array([0.0, LARGEST]))
    problem = cast(Any, SimpleNamespace(candidates=(limit,)))
    found = response_columns(problem, trial, limit, {}, most)
    assert found is not None
    value = found.values(np.array([-5.0]))["u_max_pan"]
    assert limit.free[0].start <= value < LARGEST
    expected = np.maximum(ramp - value, 0.0)
    assert np.linalg.norm(expected) <= most
    assert found.table[:, 0] * (value - LARGEST) == pytest.approx(expected)


STOPS = Candidate(
    "end_stop",
    "pan",
    "stops",
    "",
    (
        free_parameter("theta_stop_upper_pan", 0.5, -1e4, 1e4),
        free_parameter("theta_stop_lower_pan", 0.0, -1e4, 1e4),
        free_parameter("k_stop_pan", 100.0, 1e-3, 1e9),
    ),
    {"theta_stop_upper_pan": 1e4, "theta_stop_lower_pan": -1e4},
)


@pytest.mark.parametrize("ends", [(-0.3, 0.9), (0.4, 0.9), (-2.0, -1.0), (0.0, 1.0)])
def test_a_stop_vanishes_at_the_end_of_the_measured_angles(ends: tuple[float, float]) -> None:
    """Whatever their sign: an angle has no zero of its own, unlike a voltage."""
    angles = {"pan": ends, "tilt": (-50.0, 50.0)}
    limit = within_reach(STOPS, MODEL, np.array([100.0, LARGEST]), angles)
    upper, lower, stiffness = limit.free
    vanishing = limit.vanishing[lower.name], limit.vanishing[upper.name]
    assert vanishing == pytest.approx(ends, abs=1e-5)
    assert ends[0] < lower.start < upper.start < ends[1]
    assert limit.is_limit(upper)
    assert limit.is_limit(lower)
    assert stiffness == STOPS.free[2]
    assert (limit.met_at(lower), limit.met_at(upper)) == vanishing
