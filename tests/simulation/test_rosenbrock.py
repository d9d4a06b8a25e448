"""The Rosenbrock method: its coefficients, its defaults, and what it says when a state diverges."""

import math

import numpy as np
import pytest

import ptp_symbolic
from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.simulation.inputs import constant, multisine, stack, step, table
from ptp_symbolic.numeric.simulation.integration import Accuracy, default_method, integrate
from ptp_symbolic.numeric.simulation.kernels.records import DIVERGED
from ptp_symbolic.numeric.simulation.methods.rosenbrock import COUPLING, GAMMA, STAGES, A, C, D
from tests.simulation.block import J, block


def test_coefficients_meet_the_order_conditions() -> None:
    """The 17 conditions up to order 5 (Hairer and Wanner, Solving ODEs II, table IV.7.1)."""
    gamma = np.linalg.inv(np.eye(STAGES) / GAMMA - COUPLING)
    alpha, b = A @ gamma, (A[-1] + np.eye(STAGES)[-1]) @ gamma
    beta = alpha + gamma
    a, s = alpha.sum(axis=1), beta.sum(axis=1)
    assert a == pytest.approx(C, abs=1e-13)
    assert gamma.sum(axis=1) == pytest.approx(D, abs=1e-13)
    conditions = {
        1: [(b.sum(), 1)],
        2: [(b @ s, 2)],
        3: [(b @ a**2, 3), (b @ beta @ s, 6)],
        4: [
            (b @ a**3, 4),
            (b @ (a * (alpha @ s)), 8),
            (b @ beta @ a**2, 12),
            (b @ beta @ beta @ s, 24),
        ],
        5: [
            (b @ a**4, 5),
            (b @ (a**2 * (alpha @ s)), 10),
            (b @ (alpha @ s) ** 2, 20),
            (b @ (a * (alpha @ a**2)), 15),
            (b @ (a * (alpha @ beta @ s)), 30),
            (b @ beta @ a**3, 20),
            (b @ beta @ (a * (alpha @ s)), 40),
            (b @ beta @ beta @ a**2, 60),
            (b @ beta @ beta @ beta @ s, 120),
        ],
    }
    for found in conditions.values():
        for value, inverse in found:
            assert value == pytest.approx(1.0 / inverse, abs=2e-13)


def test_both_methods_see_the_same_events_and_angles(figure) -> None:
    drive = ptp_symbolic.load("pan_drive")
    for signal in (step(0.0, 24.0, 0.5), multisine([5.0, 4.0, 3.0], [0.5, 1.7, 4.1])):
        one, other = (
            ptp_symbolic.simulate(drive, 3.0, {"u_pan": signal}, method=method)
            for method in ("rosenbrock", "runge_kutta")
        )
        assert [(e.element, e.mode) for e in one.events] == [
            (e.element, e.mode) for e in other.events
        ]
        off = np.abs(one["theta_pan"] - other["theta_pan"]).max()
        assert figure(f"one off the other over {len(one.events)} events, rad", off) < 1e-8
        assert one.steps < other.steps


def test_a_held_input_may_jump_faster_than_the_winding_reacts() -> None:
    """Steps as long as the samples, ten times the time constant of the winding, stay stable."""
    drive = ptp_symbolic.load("pan_drive")
    time = np.arange(400) * 5e-3
    signal = table(time, 12.0 * np.sign(np.sin(9.0 * time) + 0.3), "hold")
    fine, coarse = (
        ptp_symbolic.simulate(drive, time, {"u_pan": signal}, rtol=rtol, atol=rtol / 10)
        for rtol in (1e-9, 1e-5)
    )
    assert np.abs(fine["theta_pan"] - coarse["theta_pan"]).max() < 1e-5
    assert coarse.steps < 3 * len(time)


def test_the_model_chooses_its_method() -> None:
    assert default_method(ptp_symbolic.load("payload")) == "runge_kutta"
    assert default_method(ptp_symbolic.load("pan_drive")) == "rosenbrock"
    with pytest.raises(
        InputError, match=r"Unknown method 'euler'\. Choose from: runge_kutta, rosen"
    ):
        ptp_symbolic.simulate(ptp_symbolic.load("payload"), 1.0, method="euler")
    with pytest.raises(InputError, match="Unknown method 'fixed_step'"):
        ptp_symbolic.sensitivity(ptp_symbolic.load("payload"), 1.0, method="fixed_step")


@pytest.mark.parametrize("method", ["rosenbrock", "runge_kutta", "fixed_step"])
def test_a_state_that_diverges_is_reported_and_never_written(method: str) -> None:
    body, inputs, soft = block(), {"tau_pan": constant(1e9)}, {"k": 0.0}
    with pytest.raises(InputError, match=r"Stopped at .* s with theta_pan .*: the state div") as at:
        ptp_symbolic.simulate(body, 400.0, inputs, soft, method=method, step=1e-2)
    assert "nan" not in str(at.value) and "inf" not in str(at.value)
    time = float(str(at.value).split()[2])
    assert time == pytest.approx(math.sqrt(2e12 * J / 1e9), abs=0.11)
    ends = ptp_symbolic.simulate(body, [0.0, time - 0.2], inputs, soft, method=method, step=1e-2)
    assert np.all(np.isfinite(ends.x)) and np.all(np.isfinite(ends.stored))
    if method != "fixed_step":
        with pytest.raises(InputError, match="the state diverges; check inputs and parameters"):
            ptp_symbolic.sensitivity(body, [0.0, 400.0], inputs, soft, None, ["J"], method=method)


def test_a_pole_in_finite_time_is_reported_with_its_time() -> None:
    """A spring that pulls outward with the cube of the way: theta = 1 / (1 - t)."""
    body, start = block(), {"theta_pan": 1.0, "omega_pan": 1.0}
    pole = {"k": 0.0, "F_c": 0.0, "F_s": 0.0, "k3": 1.0, "J": 0.5}
    p = body.parameter_vector(pole)
    p[4] = -2.0 * p[0]
    ends = np.array([0.0, 2.0])
    for method in ("rosenbrock", "runge_kutta"):
        accuracy = Accuracy(1e-8, np.full(2, 1e-8), 0.1)
        found = integrate(
            body,
            method,
            p,
            np.array(list(start.values())),
            stack([constant(0.0)]),
            True,
            ends,
            ends,
            accuracy,
        )
        assert found.status == DIVERGED
        assert found.reached == pytest.approx(1.0, abs=5e-6)
        assert np.all(np.isfinite(found.state)) and np.all(np.isfinite(found.x))
