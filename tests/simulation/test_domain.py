"""A simulation that leaves the domain of its equations stops: time, state, what to do."""

import re

import numpy as np
import pytest

import ptp_symbolic
from ptp_symbolic.errors import InputError
from ptp_symbolic.simulation.inputs import constant
from ptp_symbolic.simulation.run import SimulationError

MODEL = ptp_symbolic.load("tilt_drive")


def message(volts: float, duration: float, **options: dict[str, float]) -> str:
    with pytest.raises(SimulationError) as stopped:
        ptp_symbolic.simulate(MODEL, duration, {"u_tilt": constant(volts)}, **options)
    assert "\n" not in str(stopped.value) and "nan" not in str(stopped.value)
    return str(stopped.value)


@pytest.mark.parametrize("volts", [24.0, -24.0])
def test_the_stroke_end_stops_the_run(volts: float) -> None:
    bounds = MODEL.domain(MODEL.parameter_vector())[1]
    text = message(volts, 60.0)
    found = re.match(r"Stopped at (\S+) s with theta_tilt = (\S+) rad: past the (.*?), wh", text)
    assert found is not None
    assert found[3] == "stroke end of the tilt actuator"
    assert float(found[2]) == pytest.approx(bounds[0 if volts > 0 else 1], abs=1e-3)
    before = ptp_symbolic.simulate(MODEL, float(found[1]) - 0.01, {"u_tilt": constant(volts)})
    assert bounds[0] <= before["theta_tilt"].min() and before["theta_tilt"].max() <= bounds[1]


def test_a_dead_centre_stops_the_run_where_the_stroke_reaches_it() -> None:
    """With a stroke of 150 mm the linkage folds flat first."""
    long = {"s_max_tilt": 0.15}
    bounds = MODEL.domain(MODEL.parameter_vector(long))
    assert bounds[0, 0] == pytest.approx(bounds[1, 0], abs=1e-7)
    start = {"theta_tilt": bounds[0, 0] + 0.05}
    assert "dead centre of the tilt linkage" in message(24.0, 60.0, parameters=long, initial=start)


def test_a_start_outside_is_refused_at_once() -> None:
    text = message(0.0, 1.0, initial={"theta_tilt": 1.0})
    assert text.startswith("Stopped at 0 s with theta_tilt = 1 rad: past the stroke end")
    assert "allows -1.04329 to 0.796883 rad" in text


@pytest.mark.parametrize(
    ("model", "values", "text"),
    [
        ("tilt_drive", {"s_start_tilt": 0.13, "s_max_tilt": 0.2}, "closes, off its dead centres"),
        ("tilt_drive", {"s_max_tilt": 0.04}, "s_start is at most s_max"),
        (
            "pan_drive",
            {"F_s_pan": 0.1},
            r"F_c_pan = 0\.2401 N m \(default\), F_s_pan = 0\.1 N m: F_s is",
        ),
    ],
)
def test_changed_parameters_must_fit_each_other(
    model: str, values: dict[str, float], text: str
) -> None:
    with pytest.raises(InputError, match=text):
        ptp_symbolic.simulate(ptp_symbolic.load(model), 1.0, None, values)


def test_models_without_limits_have_none() -> None:
    free = ptp_symbolic.load("payload")
    assert free.limits == () and free.domain(free.parameter_vector()).shape == (0, 2)
    assert np.all(np.isfinite(MODEL.domain(MODEL.parameter_vector())))
