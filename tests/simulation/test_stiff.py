"""A strongly damped body: its rate settles in a nanosecond, which explicit steps would follow."""

import time

import numpy as np
import pytest

from ptp_symbolic import sensitivity, simulate
from ptp_symbolic.models import emission
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.inputs import constant, step
from ptp_symbolic.numeric.simulation.integration import PATIENCE
from ptp_symbolic.numeric.simulation.run import SimulationError
from ptp_symbolic.platform import EffectDeclaration, Platform

EFFECTS = (
    EffectDeclaration("rigid_bodies", None, None),
    EffectDeclaration("viscous_friction", "pan", None),
)
PLATFORM = Platform("stiff", "A light body in thick oil", ("pan",), 9.81, EFFECTS, (), ())
J, B, TORQUE = 1e-6, 1e3, 2.0
STIFF = {"J_pan": J, "b_pan": B}
TIMES = np.linspace(0.0, 10.0, 21)


@pytest.fixture(scope="module")
def model() -> Model:
    return emission.emit(PLATFORM)


def test_it_is_integrated_implicitly_unless_the_method_is_given(model: Model) -> None:
    """Rate torque over damping, from the first instant on; angle in proportion to the time."""
    driven = {"tau_pan": constant(TORQUE)}
    simulate(model, 0.01, driven)
    began = time.perf_counter()
    found = simulate(model, TIMES, driven, STIFF)
    assert time.perf_counter() - began < 5.0
    assert found["omega_pan"][1:] == pytest.approx(TORQUE / B, rel=1e-9)
    assert found["theta_pan"] == pytest.approx(TORQUE / B * TIMES, abs=1e-8)
    with pytest.raises(SimulationError, match=r"stiff.* take the method rosenbrock"):
        simulate(model, TIMES, driven, STIFF, method="runge_kutta")


@pytest.mark.parametrize("damping", [1e3, 1.0, 1e-1])
@pytest.mark.parametrize("start", [0.0, 5.0])
def test_so_are_its_sensitivities(model: Model, damping: float, start: float) -> None:
    """By the closed form: theta = T/b (t - J/b (1 - exp(-b t / J))) from the torque's start on. A
    step over the transient once left the tangents 0.4 % off, and the angle 1e-12 rad.
    """
    values, since = {"J_pan": J, "b_pan": damping}, np.maximum(TIMES - start, 0.0)
    driven = {"tau_pan": step(0.0, TORQUE, start)}
    found = sensitivity(model, TIMES, driven, values, by_parameters=("b_pan", "J_pan"))
    lag = J / damping
    by_damping = -TORQUE / damping**2 * (since - 2.0 * lag * (since > 0.0))
    by_inertia = np.where(since > 0.0, -TORQUE / damping**2, 0.0)
    assert found.states[:, 0, 0] == pytest.approx(by_damping, rel=1e-7, abs=1e-15)
    assert found.states[:, 0, 1] == pytest.approx(by_inertia, rel=1e-4)
    assert found.states[since > 0.0, 1, 0] == pytest.approx(-TORQUE / damping**2, rel=1e-7)


def test_explicit_sensitivities_of_a_stiff_machine_are_refused(model: Model) -> None:
    driven = {"tau_pan": constant(TORQUE)}
    with pytest.raises(SimulationError, match="the machine is stiff"):
        sensitivity(model, TIMES, driven, STIFF, by_parameters=("b_pan",), method="runge_kutta")


def test_many_explicit_steps_of_a_machine_that_is_not_stiff_are_taken(model: Model) -> None:
    mild = {"J_pan": 0.5, "b_pan": 0.1}
    duration, longest = 200.0, 1e-3
    assert duration / longest > 1.5 * PATIENCE
    found = simulate(
        model,
        np.array([0.0, duration]),
        {"tau_pan": constant(TORQUE)},
        mild,
        largest_step=longest,
        method="runge_kutta",
    )
    assert found.steps > PATIENCE
    settled = TORQUE / 0.1 * -np.expm1(-0.1 / 0.5 * duration)
    assert found["omega_pan"][-1] == pytest.approx(settled, rel=1e-8)
