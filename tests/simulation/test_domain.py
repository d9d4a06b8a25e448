"""A simulation that leaves the domain of its equations stops: time, state, what to do."""

import re
from typing import Any

import numpy as np
import pytest

import ptp_symbolic
from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.identify.evaluate import Tolerance, evaluate
from ptp_symbolic.numeric.identify.run import Run
from ptp_symbolic.numeric.simulation.inputs import constant, stack, table
from ptp_symbolic.numeric.simulation.run import SimulationError

MODEL = ptp_symbolic.load("tilt_drive")


METHODS = ("rosenbrock", "runge_kutta")


def message(volts: float, duration: float, **options: Any) -> str:
    with pytest.raises(SimulationError) as stopped:
        ptp_symbolic.simulate(MODEL, duration, {"u_tilt": constant(volts)}, **options)
    assert "\n" not in str(stopped.value) and "nan" not in str(stopped.value)
    return str(stopped.value)


def time_and_angle(text: str) -> tuple[float, float]:
    form = r"Stopped at (\S+) s with theta_tilt = (\S+) rad: past the stroke end of the tilt actua"
    found = re.match(form, text)
    assert found is not None
    assert re.search(r"shorten the input, .* there: theta_tilt \S+, omega_tilt \S+, i_tilt", text)
    return float(found[1]), float(found[2])


@pytest.mark.parametrize("volts", [24.0, -24.0])
def test_the_stroke_end_stops_the_run_where_it_is_reached(volts: float) -> None:
    """Located, not seen at the next output: the run up to just before it ends at the bound."""
    bounds = MODEL.domain(MODEL.parameter_vector())[1]
    inputs = {"u_tilt": constant(volts)}
    times = []
    for method in METHODS:
        time, angle = time_and_angle(message(volts, 60.0, method=method))
        times.append(time)
        assert angle == pytest.approx(bounds[0 if volts > 0 else 1], abs=5e-6)
    assert times[0] == times[1]
    assert message(volts, 60.0) == message(volts, 2000.0)
    before = ptp_symbolic.simulate(MODEL, [0.0, times[0] - 1e-3], inputs).x[-1]
    left = bounds[0 if volts > 0 else 1] - before[0] - 1e-3 * before[1]
    assert bounds[0] < before[0] < bounds[1]
    assert abs(left) < 1e-4 * abs(before[1]) + 1e-6
    fixed, angle = time_and_angle(message(volts, 60.0, method="fixed_step", step=2e-3))
    assert fixed == pytest.approx(times[0], abs=1e-3)
    assert angle == pytest.approx(bounds[0 if volts > 0 else 1], abs=5e-6)


def test_a_stroke_end_that_is_only_touched_within_a_step_stops_the_run() -> None:
    """Outputs lie before the swing past the end and after it, far inside."""
    lower = MODEL.domain(MODEL.parameter_vector())[1, 0]
    start = {"theta_tilt": -1.0428, "omega_tilt": -0.2, "i_tilt": 5.0}
    times, inputs = [0.0, 0.1], {"u_tilt": constant(-24.0)}
    longer = ptp_symbolic.simulate(MODEL, 0.1, inputs, {"s_max_tilt": 0.12}, start)
    assert longer["theta_tilt"].min() < lower < longer["theta_tilt"][-1]
    for method in METHODS:
        with pytest.raises(SimulationError, match="past the stroke end"):
            ptp_symbolic.simulate(MODEL, times, inputs, None, start, method=method)


@pytest.mark.parametrize("method", METHODS)
def test_sensitivities_stop_there_too(method: str) -> None:
    with pytest.raises(SimulationError) as stopped:
        ptp_symbolic.sensitivity(
            MODEL,
            [0.0, 30.0, 60.0],
            {"u_tilt": constant(24.0)},
            by_parameters=["R_tilt"],
            method=method,
        )
    assert time_and_angle(str(stopped.value))[0] == time_and_angle(message(24.0, 60.0))[0]


def test_an_evaluation_of_a_fit_that_leaves_the_domain_has_failed() -> None:
    time = np.linspace(0.0, 40.0, 401)
    none = np.zeros(0, dtype=np.int64)
    ran = {}
    for volts in (2.0, 24.0):
        held = np.full((len(time), 1), volts)
        run = Run(
            "log",
            "log",
            time,
            stack([table(time, held[:, 0], "hold")]),
            held,
            np.zeros((len(time), 1)),
            np.array([MODEL.output_names.index("theta_tilt")]),
            np.ones(1),
            np.full(1, np.nan),
            ("theta_tilt",),
            np.zeros(3),
            (),
        )
        ran[volts] = evaluate(
            MODEL, run, MODEL.parameter_vector(), np.zeros(0), none, True, Tolerance()
        )
    assert ran[2.0].failed is None and np.all(np.isfinite(ran[2.0].residual))
    assert ran[24.0].failed is not None and ran[24.0].failed.startswith("log: stopped at 32.3")


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
