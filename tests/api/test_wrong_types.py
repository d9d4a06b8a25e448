"""What is of no type that a public function takes: one line that says what it takes."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import ptp_symbolic as ptp

SAMPLE = ptp.sample("tilted_base")
PLATFORM, TRAIN = SAMPLE / "platform.toml", SAMPLE / "train"
MACHINE = "A machine is of type int; give the name of a model or a preset, the path of"
LOG = "A log is of type int; give the path of a file or a folder, a log of `read_log`, a DataFr"

CALLS: dict[str, tuple[Callable[[], Any], str]] = {
    "load": (lambda: ptp.load(3), MACHINE),
    "simulate": (lambda: ptp.simulate(3), MACHINE),
    "sensitivity": (lambda: ptp.sensitivity(3), MACHINE),
    "simulate_batch": (lambda: ptp.simulate_batch(3, 1.0), MACHINE),
    "fit": (lambda: ptp.fit(3, TRAIN), MACHINE),
    "fit to 3": (lambda: ptp.fit(PLATFORM, 3), LOG),
    "fit to [3]": (lambda: ptp.fit(PLATFORM, [3]), LOG),
    "fit to numbers": (lambda: ptp.fit(PLATFORM, np.zeros((9, 2))), "A log is of type ndarray"),
    "fit to None": (lambda: ptp.fit(PLATFORM, None), "A log is of type NoneType"),
    "diagnose": (lambda: ptp.diagnose(3, TRAIN, TRAIN), MACHINE),
    "diagnose 3": (lambda: ptp.diagnose(PLATFORM, 3, TRAIN), LOG),
    "validate 3": (lambda: ptp.diagnose(PLATFORM, TRAIN, 3), LOG),
    "effort": (
        lambda: ptp.diagnose(PLATFORM, TRAIN, TRAIN, effort="much"),
        "`effort` is of type str; give a number",
    ),
    "time limit": (
        lambda: ptp.diagnose(PLATFORM, TRAIN, TRAIN, time_limit="long"),
        "`time_limit` is of type str; give a number of s",
    ),
    "resume": (
        lambda: ptp.diagnose(PLATFORM, TRAIN, TRAIN, resume=3),
        "`resume` is of type int; give the path of a folder",
    ),
    "experiment": (lambda: ptp.experiment(3), MACHINE),
    "between": (lambda: ptp.experiment(PLATFORM, between=3), "`between` is of type int; give na"),
    "limits": (lambda: ptp.experiment(PLATFORM, limits=3), "`limits` is of type int; give names"),
    "friction map": (lambda: ptp.friction_map(3), "`points` is of type int; give the path of a C"),
    "axis": (lambda: ptp.friction_map("a.csv", axis=3), "Unknown axis 3. Choose one of: pan, tilt"),
    "read_log": (lambda: ptp.read_log(3, PLATFORM), "A log is of type int; give the path of a fi"),
    "read_log with": (lambda: ptp.read_log("a.csv", 3), MACHINE),
    "read_platform": (lambda: ptp.read_platform(3), "A platform is of type int; give the path of"),
    "read_robot": (lambda: ptp.read_robot(3), "A robot is of type int; give the path of a URDF"),
    "export": (lambda: ptp.export(3, "c99", "out"), MACHINE),
    "export to 3": (lambda: ptp.export("ideal", 3, "out"), "Unknown target 3"),
    "export into 3": (lambda: ptp.export("ideal", "c99", 3), "`folder` is of type int; give the"),
    "inverse_dynamics": (
        lambda: ptp.inverse_dynamics("ideal", 3),
        "A motion is of type int; give angles, rates and accelerations",
    ),
    "its angles": (
        lambda: ptp.inverse_dynamics("ideal", ("a", [[0, 0]], [[0, 0]])),
        "Motion: angles are no array of numbers",
    ),
    "check_effect": (lambda: ptp.check_effect(3), "3 is of type int; give an Effect"),
    "sample": (lambda: ptp.sample(3), "Unknown sample 3. Choose one of: tilted_base"),
    "rtol": (lambda: ptp.simulate("ideal", 1.0, rtol="low"), "`rtol` is of type str; give a numb"),
    "step": (lambda: ptp.simulate("ideal", 1.0, step=True), "`step` is of type bool; give a num"),
    "save": (lambda: ptp.simulate("ideal", 1.0, save=3), "`save` is of type int; give names as t"),
    "inputs": (lambda: ptp.simulate("ideal", 1.0, inputs=3), "`inputs` is of type int; give input"),
    "input": (lambda: ptp.simulate("ideal", 1.0, tau_pan=None), "'tau_pan' is of type NoneType"),
    "not a number": (
        lambda: ptp.simulate("ideal", [0.0, 1.0], tau_pan=[0.0, float("nan")]),
        "Input 'tau_pan': .*NaN",
    ),
    "function of nothing": (
        lambda: ptp.simulate("ideal", 1.0, tau_pan=lambda: 1.0),
        "Input 'tau_pan': the function must take one argument, the time in s, but: too many",
    ),
    "function to a text": (
        lambda: ptp.simulate("ideal", 1.0, tau_pan=lambda t: "fast"),
        "Input 'tau_pan': .* returns 'fast' at 0 s; it must return one finite number",
    ),
    "controller": (
        lambda: ptp.simulate("ideal", 1.0, controller=lambda t: 0.0, period=0.1),
        "The controller must take t in s and what is measured, but: too many",
    ),
    "period": (
        lambda: ptp.simulate("ideal", 1.0, controller=lambda t, y: 0.0, period="1 ms"),
        "`period` is of type str; give a number of s",
    ),
    "batch": (
        lambda: ptp.simulate_batch("ideal", 0.1, parameters="J_pan"),
        "`parameters` is of type str; give a value or an array",
    ),
}


@pytest.mark.parametrize("name", CALLS)
def test_a_wrong_type_is_refused_in_one_line(name: str) -> None:
    wrong, said = CALLS[name]
    with pytest.raises(ptp.InputError, match=said) as refused:
        wrong()
    assert "\n" not in str(refused.value)


def test_one_name_is_a_name() -> None:
    """A text alone is no sequence of letters."""
    found = ptp.sensitivity("ideal", 0.1, by_parameters="J_pan")
    assert found.names == ("J_pan",)


def test_a_signal_that_is_no_text_is_a_key_error() -> None:
    with pytest.raises(KeyError, match=r"Unknown signal 3\. Choose one of"):
        ptp.simulate("ideal", 0.01)[3]
