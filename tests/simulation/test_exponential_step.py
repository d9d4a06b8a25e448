"""The exponential step of sampled machines: matrices against SciPy, runs against another way."""

from dataclasses import replace

import numpy as np
import pytest
from numba import njit
from scipy.integrate import solve_ivp
from scipy.linalg import expm

from ptp_symbolic.models import emission
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.inputs import InputSignal, constant, ramp, stack, step
from ptp_symbolic.numeric.simulation.integration import (
    Accuracy,
    Solution,
    integrate,
    tolerance_weights,
)
from ptp_symbolic.numeric.simulation.kernels.records import DONE, KERNEL
from ptp_symbolic.numeric.simulation.methods.exponential_step import double, fill_phi_functions
from ptp_symbolic.platform import (
    EffectDeclaration,
    ParameterDeclaration,
    Platform,
    read_platform,
)
from tests.effects import test_pid_controller as pid

END = 4.0
CLOSE, LATE = 1e-7, 1e-5  # rad; s: what 1e-7 rad is at 0.01 rad/s


@njit(**KERNEL)
def phi_functions(matrix, scale, twice, phi0, phi1, phi2, phi3, product):  # type: ignore[no-untyped-def]
    fill_phi_functions(matrix, scale, phi0, phi1, phi2, phi3, product)
    if twice:
        double(phi0, phi1, phi2, phi3, product)


@pytest.mark.parametrize("twice", [False, True])
@pytest.mark.parametrize("size", [1e-9, 0.3, 40.0, 3e4])
def test_phi_functions_are_blocks_of_the_exponential_of_a_larger_matrix(
    size: float, twice: bool
) -> None:
    """Sidje (ACM Trans. Math. Softw. 24, 1998): the exponential of A beside a chain of ones."""
    random, k = np.random.default_rng(3), 5
    basis = random.standard_normal((k, k))
    matrix = basis @ np.diag(-random.uniform(0.1, 1.0, k)) @ np.linalg.inv(basis)  # decays
    matrix[2] = 0.0  # a body at rest
    found = [np.zeros((k, k)) for _ in range(5)]
    phi_functions(matrix, size, twice, *found)
    zero, one = np.zeros((k, k)), np.eye(k)
    whole = size * (2.0 if twice else 1.0) * matrix
    chain = [
        [whole, one, zero, zero],
        [zero, zero, one, zero],
        [zero, zero, zero, one],
        [zero, zero, zero, zero],
    ]
    exact = expm(np.block(chain))
    for i, phi in enumerate(found[:4]):
        expected = exact[:k, i * k : (i + 1) * k]
        np.testing.assert_allclose(phi, expected, rtol=1e-9, atol=1e-11 * np.abs(expected).max())
    np.testing.assert_array_equal(found[0][2], one[2])


@pytest.fixture(scope="module")
def servo() -> Model:
    """The pan servo of the thesis with its controller at 1 kHz."""
    platform = read_platform("thesis-pan-servo")
    kept = tuple(p for p in platform.parameters if p.name != "t_sample_pan")
    fast = ParameterDeclaration("t_sample_pan", "s", 1e-3)
    return emission.emit(replace(platform, parameters=(*kept, fast)))


def solution(
    model: Model,
    goal: InputSignal,
    method: str,
    tolerance: float,
    times: np.ndarray,
    ledger: bool = False,
    parameters: dict[str, float] | None = None,
    start: float = 0.0,
) -> Solution:
    """A run from the first to the last of `times`, from rest but for the rate of the load."""
    table, weights, x = stack([goal]), tolerance_weights(model), np.zeros(len(model.state_names))
    x[1] = start
    found = integrate(
        model,
        method,
        model.parameter_vector(parameters),
        x,
        table,
        table.held,
        table.with_stops(times[[0, -1]]),
        times,
        Accuracy(tolerance, 0.1 * tolerance * weights, 0.1),
        ledger=ledger,
        event_room=500,
    )
    assert found.status == DONE
    return found


@pytest.mark.parametrize("goal", [ramp(0.0, 0.5, 0.0, 2.0), step(0.0, 0.02, 0.1)])
def test_a_servo_moves_as_the_explicit_method_says_with_a_step_per_sample(
    servo: Model, goal: InputSignal
) -> None:
    samples = np.linspace(0.0, END, 4001)
    exact = solution(servo, goal, "runge_kutta", 1e-11, samples)
    found = solution(servo, goal, "rosenbrock", 1e-7, samples)
    assert np.max(np.abs(found.x[:, 0] - exact.x[:, 0])) < CLOSE
    assert len(found.events) == len(exact.events) >= 2
    np.testing.assert_array_equal(found.events[:, 1:], exact.events[:, 1:])
    np.testing.assert_allclose(found.events[:, 0], exact.events[:, 0], rtol=0.0, atol=LATE)
    careful = solution(servo, goal, "rosenbrock", 1e-7, samples, ledger=True)
    assert found.steps < min(1.05 * 4000, careful.steps)


def test_a_linear_servo_moves_as_the_exponential_says(figure) -> None:
    """The hand-written loop of the controller's tests, exact from sample to sample."""
    period, goal = 1e-3, step(0.0, 0.2, 0.0)
    model, given = pid.servo(), pid.GAINS | pid.FINE | {"t_sample_pan": period}
    found = solution(model, goal, "rosenbrock", 1e-6, np.arange(2001) * period, parameters=given)
    controller = pid.Controller(300.0, 900.0, 4.0, period)
    exact = pid.exact(controller, goal, 2000)
    assert figure("error, rad", np.abs(found.x[:, 0] - exact[:, 0]).max()) < 1e-12
    assert found.steps < 2010  # the first sample tells the period, by the adaptive method


def test_the_order_is_three_in_forces_that_are_not_linear(figure) -> None:
    """A load flies in the gap on a hardening cable wrap; the controller does nothing. The order is
    two in general; where a force depends on the angle alone, that is better by one inside a step.
    """
    names = (
        "dc_motor",
        "csvs_friction",
        "backlash",
        "shaft_compliance",
        "cable_spring",
        "pid_controller",
    )
    bodies, more = (
        EffectDeclaration("rigid_bodies", None, None),
        (EffectDeclaration(name, "pan", None) for name in names),
    )
    model = emission.emit(Platform("flight", "Flight", ("pan",), 9.81, (bodies, *more), (), ()))
    load = {"J_pan": 100.0, "gap_pan": 1.0, "k3_cable_pan": 40.0, "K_p_pan": 0.0}
    speed, end = 0.1, 24.0
    exact = solve_ivp(
        lambda t, x: [x[1], -load["k3_cable_pan"] * x[0] ** 3 / load["J_pan"]],
        (0.0, end),
        [0.0, speed],
        "DOP853",
        rtol=1e-13,
        atol=1e-15,
    ).y[0, -1]

    def error(period: float) -> float:
        found = solution(
            model,
            constant(0.0),
            "rosenbrock",
            1e-2,
            np.array([0.0, end]),
            parameters=load | {"t_sample_pan": period},
            start=speed,
        )
        assert found.steps == round(end / period)
        return float(abs(found.x[-1, 0] - exact))

    periods = np.array([0.08, 0.06, 0.04, 0.03])
    errors = [error(period) for period in periods]
    found = figure("order, 3 expected", np.polyfit(np.log(periods), np.log(errors), 1)[0])
    assert found == pytest.approx(3.0, abs=0.1)


def test_outputs_between_samples_are_those_of_the_adaptive_method(servo: Model) -> None:
    goal, between = ramp(0.0, 0.5, 0.0, 2.0), np.linspace(0.0, END, 9001)
    exact = solution(servo, goal, "runge_kutta", 1e-11, between)
    found = solution(servo, goal, "rosenbrock", 1e-6, between)
    assert np.max(np.abs(found.x[:, 0] - exact.x[:, 0])) < CLOSE
    assert np.max(np.abs(found.x[:, 4] - exact.x[:, 4])) < 1e-4  # A


def test_a_base_that_shakes_once_a_sample_is_not_overlooked(figure) -> None:
    """At every sample the base moves as at the one before."""
    period = 0.02
    model = pid.servo("payload", "base_motion")
    given = (
        pid.GAINS
        | pid.FINE
        | {
            "t_sample_pan": period,
            "K_p_pan": 20.0,
            "K_i_pan": 0.0,
            "K_d_pan": 0.0,
            "m_payload": 20.0,
            "c_x_payload": 0.5,
            "a_base": 20.0,
            "f_base": 1.0 / period,
            "phi_base": 1.5,
            "psi_base": 1.5,
        }
    )
    times = np.linspace(0.0, 2.0, 101)
    exact, found = (
        solution(model, step(0.0, 0.1, 0.0), method, tolerance, times, parameters=given)
        for method, tolerance in (("runge_kutta", 1e-11), ("rosenbrock", 1e-5))
    )
    assert figure("error, rad", np.abs(found.x[:, 0] - exact.x[:, 0]).max()) < 1e-6


def test_a_body_at_rest_does_not_creep_from_sample_to_sample(servo: Model) -> None:
    """A goal too small to break friction loose: the load stays where it was to the last bit."""
    found = solution(servo, step(0.0, 1e-9, 0.1), "rosenbrock", 1e-5, np.linspace(0.0, END, 4001))
    assert np.all(found.x[:, 0] == 0.0)
    assert found.steps <= 4001
