"""Delay of the input: the same motion, later by exactly the delay, whatever the signal."""

import numpy as np
import pytest

from ptp_symbolic import sensitivity, simulate
from ptp_symbolic.models import emission
from ptp_symbolic.numeric.simulation.inputs import (
    InputSignal,
    cubic_transition,
    ramp,
    sine_sweep,
    step,
    table,
    trapezoid,
)
from ptp_symbolic.platform import EffectDeclaration, Platform

BODY = EffectDeclaration("rigid_bodies", None, None)
DELAY = EffectDeclaration("input_delay", "pan", None)
J, LATE = 0.05, 0.0123456789
SAMPLES = np.arange(0.0, 0.5, 0.002)
SIGNALS = {
    "step": step(0.0, 1.3, 0.1),
    "ramp": ramp(0.0, 2.0, 0.05, 0.31),
    "trapezoid": trapezoid(1.0, 0.07, 0.1, 0.0, 0.033),
    "cubic": cubic_transition(0.0, 1.0, 0.02, 0.4),
    "sweep": sine_sweep(1.5, 2.0, 15.0, 0.05, 0.45),
    "log": table(SAMPLES, np.sin(40.0 * SAMPLES) * (SAMPLES > 0.01)),
}


def platform(*axes: str) -> Platform:
    return Platform("late", "Late command", axes, 9.81, (BODY, DELAY), (), ())


@pytest.mark.parametrize("delay", [0.0, 0.002, LATE, 0.37])
def test_a_late_step_of_torque_gives_a_late_parabola(delay: float) -> None:
    values = {"J_pan": J, "t_delay_pan": delay}
    found = simulate(emission.emit(platform("pan")), 0.5, {"tau_pan": step(0.0, 1.3, 0.1)}, values)
    since = np.maximum(found.t - 0.1 - delay, 0.0)
    assert found["omega_pan"] == pytest.approx(1.3 / J * since, abs=1e-9)
    assert found["theta_pan"] == pytest.approx(0.65 / J * since**2, abs=1e-9)


@pytest.mark.parametrize("signal", SIGNALS.values(), ids=SIGNALS)
def test_a_motor_answers_every_signal_late(signal: InputSignal) -> None:
    motor = tuple(
        EffectDeclaration(e, "pan", None) for e in ("dc_motor", "csvs_friction", "input_delay")
    )
    model = emission.emit(Platform("late", "Late motor", ("pan",), 9.81, (BODY, *motor), (), ()))
    driven, times = {"u_pan": signal}, np.linspace(0.0, 0.5, 26)
    prompt = simulate(model, times, driven, rtol=1e-10)
    late = simulate(model, [0.0, *(times + LATE)], driven, {"t_delay_pan": LATE}, rtol=1e-10)
    assert late.x[1:] == pytest.approx(prompt.x, abs=1e-8)
    assert [e.time - LATE for e in late.events] == pytest.approx(
        [e.time for e in prompt.events], abs=1e-8
    )


def test_the_other_axis_is_not_late() -> None:
    model = emission.emit(platform("pan", "tilt"))
    values = {"J_y_tilt": J, "t_delay_pan": LATE}
    found = simulate(model, 0.3, {"tau_tilt": step(0.0, 0.2, 0.1)}, values)
    assert found["omega_tilt"] == pytest.approx(4.0 * np.maximum(found.t - 0.1, 0.0), abs=1e-9)


def test_a_later_command_costs_rate_and_angle_at_once() -> None:
    """Derivatives by the delay after a step: -tau/J of the rate, minus the rate of the angle."""
    model, values = emission.emit(platform("pan")), {"J_pan": J, "t_delay_pan": LATE}
    driven = {"tau_pan": step(0.0, 1.3, 0.1)}
    found = sensitivity(model, [0.0, 0.1, 0.3], driven, values, by_parameters=["t_delay_pan"])
    assert found.states[:2] == pytest.approx(0.0, abs=0.0)
    slope = 1.3 / J
    assert found.states[2, :, 0] == pytest.approx([-slope * (0.2 - LATE), -slope], rel=1e-9)
