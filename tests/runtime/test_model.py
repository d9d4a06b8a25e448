"""The Python front door: what a model refuses, and what the package offers."""

import inspect
import math
from pathlib import Path

import numpy as np
import pytest

import ptp_symbolic
from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.runtime.model import Model


@pytest.fixture(scope="module")
def ideal() -> Model:
    return ptp_symbolic.load("ideal")


@pytest.mark.parametrize(
    ("x", "u", "p", "message"),
    [
        (
            3,
            2,
            0,
            r"State x has shape \(3,\); give \[4\]: theta_pan, theta_tilt, omega_pan, omega_t",
        ),
        (5, 2, 0, r"State x has shape \(5,\); give \[4\]"),
        (4, 1, 0, r"Input u has shape \(1,\); give \[2\]: tau_pan, tau_tilt\."),
        (
            4,
            2,
            1,
            r"Parameters p has shape \(7,\); give \[6\]: .*; parameter_vector\(\) makes them",
        ),
    ],
)
def test_arrays_of_another_shape_are_refused(
    ideal: Model, x: int, u: int, p: int, message: str
) -> None:
    parameters = np.append(ideal.parameter_vector(), np.zeros(p))
    with pytest.raises(InputError, match=message):
        ideal.rhs(0.0, np.zeros(x), np.zeros(u), parameters)


def test_a_table_or_a_number_is_no_state(ideal: Model) -> None:
    for wrong in (0.0, np.zeros((1, 4))):
        with pytest.raises(InputError, match="State x has shape"):
            ideal.rhs(0.0, wrong, np.zeros(2), ideal.parameter_vector())


def test_lists_do_as_well_as_arrays(ideal: Model) -> None:
    p = ideal.parameter_vector()
    given = ideal.rhs(0.0, [0.0, 0.3, 0.1, 0.2], (0.1, 0.2), list(p))
    state, torque = np.array([0.0, 0.3, 0.1, 0.2]), np.array([0.1, 0.2])
    wanted = np.empty(4)
    ideal.state_derivative(0.0, state, torque, p, wanted)
    assert np.array_equal(given, wanted)


@pytest.mark.parametrize("value", [-1.0, 2e4, math.nan, math.inf])
def test_values_out_of_bounds_are_refused(ideal: Model, value: float) -> None:
    message = r"'b_pan' = .* N m s/rad lies outside its bounds \[0, 10000\] N m s/rad; change"
    with pytest.raises(InputError, match=message):
        ideal.parameter_vector({"b_pan": value})


def test_values_on_the_bounds_are_allowed_and_so_is_rounding(ideal: Model) -> None:
    for value in (0.0, 1e4, math.nextafter(1e4, math.inf)):
        assert value in ideal.parameter_vector({"b_pan": value})


def test_every_effect_can_be_off() -> None:
    model = ptp_symbolic.load("full")
    off = {p.name: p.vanishes for p in model.parameters if p.vanishes is not None}
    assert off
    model.parameter_vector(off)


def test_unknown_names_get_the_nearest_one(ideal: Model) -> None:
    with pytest.raises(InputError, match="Unknown parameter 'b_pam': did you mean 'b_pan'"):
        ideal.parameter_vector({"b_pam": 0.1})
    with pytest.raises(InputError, match="Unknown state 'teta_pan': did you mean 'theta_pan'"):
        ptp_symbolic.simulate(ideal, 0.1, initial={"teta_pan": 0.1})
    with pytest.raises(InputError, match="Unknown input 'tau_pam': did you mean 'tau_pan'"):
        ptp_symbolic.simulate(ideal, 0.1, {"tau_pam": "constant:1"})
    with pytest.raises(InputError, match="Unknown input 'tau_pam': did you mean 'tau_pan'"):
        ptp_symbolic.sensitivity(ideal, 0.1, {"tau_pam": "constant:1"})


def test_the_unchecked_function_says_so() -> None:
    assert "Nothing is checked" in (inspect.getdoc(Model.state_derivative) or "")


def test_the_package_shows_real_signatures_and_docstrings() -> None:
    for name, first in (
        ("simulate", "model"),
        ("sensitivity", "model"),
        ("inverse_dynamics", "machine"),
    ):
        function = getattr(ptp_symbolic, name)
        names = list(inspect.signature(function).parameters)
        assert names[0] == first and "args" not in names
        assert "InputError" in (function.__doc__ or "")
        assert name in dir(ptp_symbolic)
    assert "initial" in inspect.signature(ptp_symbolic.simulate).parameters
    annotation = inspect.signature(ptp_symbolic.simulate).parameters["times"].annotation
    assert annotation == "float | ArrayLike | None"  # not the page that numpy makes of it
    with pytest.raises(AttributeError, match="no attribute 'simulat'"):
        ptp_symbolic.simulat  # noqa: B018 - looking it up is the test


@pytest.mark.parametrize(
    ("source", "message"),
    [
        ("paylaod", "Unknown platform 'paylaod'.*; or give the path of a"),
        ("nowhere/bench.toml", "nowhere/bench.toml: there is no such file; give the path of a"),
    ],
)
def test_unknown_platforms_are_refused_in_the_same_words(source: str, message: str) -> None:
    with pytest.raises(InputError, match=message):
        ptp_symbolic.load(source)


def test_a_folder_is_no_platform(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="is a folder; give a platform TOML"):
        ptp_symbolic.load(tmp_path)


def test_profiles_as_text_are_inputs(ideal: Model) -> None:
    from ptp_symbolic.numeric.simulation.inputs import sine_sweep, step

    texts = {"tau_pan": "step:0.5@0.02", "tau_tilt": "sweep:0.1@1..3"}
    signals = {"tau_pan": step(0.0, 0.5, 0.02), "tau_tilt": sine_sweep(0.1, 1.0, 3.0, 0.0, 0.1)}
    found, wanted = (ptp_symbolic.simulate(ideal, 0.1, given) for given in (texts, signals))
    assert np.array_equal(found.x, wanted.x)
    assert found["omega_pan"][-1] > 0.0


def test_what_is_no_input_is_refused(ideal: Model) -> None:
    with pytest.raises(
        InputError, match=r"Input 'tau_pan': Profile 'step:nan@0.5' .*: nan is no fi"
    ):
        ptp_symbolic.simulate(ideal, 0.1, {"tau_pan": "step:nan@0.5"})
    with pytest.raises(InputError, match="Input 'tau_pan' is of type object; give a number, a"):
        ptp_symbolic.simulate(ideal, 0.1, {"tau_pan": object()})
