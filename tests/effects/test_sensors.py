"""What sensors beside the encoder show: closed forms, and derivatives against differences."""

import math
from dataclasses import replace

import numpy as np
import pytest

from ptp_symbolic.models.emission import emit
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.platform import (
    EffectDeclaration,
    Platform,
    SignalDeclaration,
)


def machine(axis: str, effects: tuple[str, ...], sensors: tuple[str, ...]) -> Platform:
    return Platform(
        "bench",
        "bench",
        (axis,),
        9.81,
        tuple(EffectDeclaration(e, None if e == "rigid_bodies" else axis, None) for e in effects),
        (),
        tuple(SignalDeclaration(s, s, "1", "output") for s in sensors),
    )


def shown(model: Model, state: dict[str, float], name: str) -> float:
    x = np.array([state.get(n, 0.0) for n in model.state_names])
    y, u = np.zeros(len(model.output_names)), np.zeros(len(model.input_names))
    model.module.outputs(0.0, x, u, model.parameter_vector(), y)
    return float(y[model.output_names.index(name)])


@pytest.fixture(scope="module")
def loose() -> Model:
    effects = ("rigid_bodies", "dc_motor", "shaft_compliance", "backlash")
    return emit(machine("pan", effects, ("omega_pan", "tau_shaft_pan", "omega_motor_pan")))


@pytest.mark.parametrize(
    ("lead", "closing", "pressed"),
    [
        (0.5, 2.0, 0.0),  # in the gap, whatever the speed
        (1.5, 0.0, 0.5),
        (-1.5, 0.0, -0.5),
        (1.5, -100.0, 0.0),  # parting so fast that the damper would pull
        (-1.5, -0.2, -0.5),
    ],
)
def test_a_torque_cell_shows_what_presses_in_the_gap(
    loose: Model, lead: float, closing: float, pressed: float
) -> None:
    """`lead` and `pressed` are in half gaps; faces press and never pull."""
    half, p = 0.5 * loose.defaults["gap_pan"], loose.defaults
    state = {"theta_gear_pan": lead * half, "omega_gear_pan": closing}
    expected = p["k_shaft_pan"] * pressed * half + p["d_shaft_pan"] * closing * bool(pressed)
    assert shown(loose, state, "tau_shaft_pan") == pytest.approx(expected, abs=1e-12)


def test_a_tachometer_turns_with_the_motor_and_a_gyro_with_the_joint(loose: Model) -> None:
    state = {"omega_pan": 0.7, "omega_gear_pan": 0.9}
    assert shown(loose, state, "omega_pan") == 0.7
    assert shown(loose, state, "omega_motor_pan") == pytest.approx(500.0 * 0.9)


def test_the_motor_of_a_screw_turns_as_the_law_of_cosines_says() -> None:
    effects = ("rigid_bodies", "linear_actuator")
    model = emit(machine("tilt", effects, ("omega_motor_tilt",)))
    p = model.defaults

    def length(angle: float) -> float:
        foot, arm = p["l_ground_tilt"], p["r_arm_tilt"]
        start = p["l_min_tilt"] + p["s_start_tilt"]
        at_zero = math.acos((foot**2 + arm**2 - start**2) / (2 * foot * arm))
        return math.sqrt(foot**2 + arm**2 - 2 * foot * arm * math.cos(at_zero - angle))

    step = 1e-6
    for angle in (-0.3, 0.0, 0.4):
        slope = (length(angle + step) - length(angle - step)) / (2 * step)
        turns = p["N_tilt"] * slope / p["lead_tilt"]
        found = shown(model, {"theta_tilt": angle, "omega_tilt": 0.2}, "omega_motor_tilt")
        assert found == pytest.approx(2 * math.pi * turns * 0.2, rel=1e-7)


@pytest.mark.parametrize("lead", [0.3, 1.7, -1.7])
def test_derivatives_of_what_sensors_show(loose: Model, lead: float) -> None:
    _check_jacobian(
        loose,
        {
            "theta_gear_pan": lead * 0.5 * loose.defaults["gap_pan"],
            "omega_pan": 0.1,
            "omega_gear_pan": 0.12,
            "i_pan": 0.4,
        },
    )


def test_derivatives_of_a_tachometer_behind_a_linkage() -> None:
    model = emit(machine("tilt", ("rigid_bodies", "linear_actuator"), ("omega_motor_tilt",)))
    _check_jacobian(model, {"theta_tilt": 0.2, "omega_tilt": 0.3})


def _check_jacobian(model: Model, state: dict[str, float]) -> None:
    x = np.array([state.get(n, 0.0) for n in model.state_names])
    u, p = np.zeros(len(model.input_names)), model.parameter_vector()
    count = len(model.output_names)
    yx, yp = np.zeros((count, len(x))), np.zeros((count, len(p)))
    model.module.output_jacobian(0.0, x, u, p, yx, yp)

    def outputs(x: np.ndarray, p: np.ndarray) -> np.ndarray:
        y = np.zeros(count)
        model.module.outputs(0.0, x, u, p, y)
        return y

    for given, found in ((0, yx), (1, yp)):
        for j in range(found.shape[1]):
            at = [x, p]
            step = np.zeros(found.shape[1])
            step[j] = 1e-6 * max(abs(at[given][j]), 1e-3)
            ends = []
            for sign in (1.0, -1.0):
                moved = at.copy()
                moved[given] = at[given] + sign * step
                ends.append(outputs(*moved))
            quotient = (ends[0] - ends[1]) / (2 * step[j])
            assert found[:, j] == pytest.approx(quotient, rel=1e-5, abs=1e-4), j


def test_a_sensor_that_is_not_declared_leaves_the_equations_as_they_are() -> None:
    bare = machine("pan", ("rigid_bodies", "dc_motor"), ())
    watched = replace(bare, signals=(SignalDeclaration("omega_pan", "g", "rad/s", "output"),))
    assert emit(bare).output_names == ("theta_pan", "i_pan")
    assert emit(watched).output_names == ("theta_pan", "i_pan", "omega_pan")
    asked = replace(bare, signals=(SignalDeclaration("omega_pan", "g", "rad/s", "input"),))
    assert emit(asked).output_names == ("theta_pan", "i_pan")
