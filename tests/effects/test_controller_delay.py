"""A controller that computes for a time: a loop written by hand, by the matrix exponential."""

from collections import deque

import numpy as np
import pytest
from scipy.linalg import expm

from ptp_symbolic import sensitivity, simulate
from ptp_symbolic.models import emission
from ptp_symbolic.models.structures import structures
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.inputs import step
from ptp_symbolic.platform import EffectDeclaration, Platform

J, L, R, KT, ROTOR, N = 0.4, 5e-3, 5.0, 0.05, 1e-5, 100.0
KP, KD, PERIOD, GOAL, SAMPLES = 60.0, 2.0, 2e-3, 0.2, 250
VALUES = {
    "J_pan": J,
    "L_pan": L,
    "R_pan": R,
    "K_t_pan": KT,
    "J_motor_pan": ROTOR,
    "N_pan": N,
    "K_p_pan": KP,
    "K_d_pan": KD,
    "t_sample_pan": PERIOD,
    "n_d_pan": 1.0,
    "n_u_pan": 1e12,
}


def platform(*names: str) -> Platform:
    axes = {n: None if n == "rigid_bodies" else "pan" for n in ("rigid_bodies", "dc_motor", *names)}
    effects = tuple(EffectDeclaration(name, axis, None) for name, axis in axes.items())
    return Platform("servo", "Servo", ("pan",), 9.81, effects, (), ())


@pytest.fixture(scope="module")
def model() -> Model:
    return emission.emit(platform("pid_controller", "controller_delay"))


def loop(delay: float) -> tuple[np.ndarray, np.ndarray]:
    """Angles [n + 1] and acting voltages [n + 1] at the samples, the command of each acting `delay`
    samples later: every sampling time is cut where the next command sets in.
    """
    inertia = J + ROTOR * N**2
    rates = np.zeros((4, 4))
    rates[0, 1] = 1.0
    rates[1, 2] = N * KT / inertia
    rates[2, 1:] = -KT * N / L, -R / L, 1.0 / L
    whole = int(np.ceil(delay)) - 1  # samples that pass entirely before a command acts
    before, after = (expm(PERIOD * part * rates) for part in (delay - whole, 1 + whole - delay))
    waiting, x, last = deque([0.0] * whole), np.zeros(4), 0.0
    angles, volts = [0.0], []
    for _ in range(SAMPLES + 1):
        error = GOAL - x[0]
        asked = KP * error + KD * (error - last) / PERIOD
        last = error
        waiting.append(min(max(asked, -24.0), 24.0))
        volts.append(x[3])
        x = before @ x
        x[3] = waiting.popleft()
        x = after @ x
        angles.append(x[0])
    return np.array(angles[: SAMPLES + 1]), np.array(volts)


@pytest.mark.parametrize("delay", [0.3, 1.0, 1.6, 2.0])
def test_every_sample_is_that_of_a_loop_written_by_hand(model: Model, delay: float) -> None:
    """A part of a sample, a whole one, more than one, two: the loop rings the more."""
    angles, volts = loop(delay)
    times = np.arange(SAMPLES + 1) * PERIOD
    goal = {"setpoint_pan": step(GOAL, GOAL, 1.0)}
    values = {**VALUES, "n_compute_pan": delay}
    found = simulate(model, times, goal, values, rtol=1e-12, atol=1e-12)
    assert found["theta_pan"] == pytest.approx(angles, abs=1e-9)
    assert found["u_acting_pan"] == pytest.approx(volts, abs=1e-6)


def test_a_delay_of_no_time_is_the_loop_without_one(model: Model) -> None:
    """In the limit: the shortest delay that may be declared is a thousandth of a sample."""
    times = np.arange(SAMPLES + 1) * PERIOD
    goal = {"setpoint_pan": step(GOAL, GOAL, 1.0)}
    short = simulate(model, times, goal, {**VALUES, "n_compute_pan": 1e-3})["theta_pan"]
    rough = simulate(model, times, goal, {**VALUES, "n_compute_pan": 1e-2})["theta_pan"]
    without = simulate(emission.emit(platform("pid_controller")), times, goal, VALUES)["theta_pan"]
    assert np.abs(short - without).max() < 2e-5
    assert np.abs(rough - without).max() == pytest.approx(
        10.0 * np.abs(short - without).max(), rel=0.1
    )


@pytest.mark.parametrize("delay", [0.5, 1.4])
def test_the_slope_by_the_delay_is_that_of_the_loop_written_by_hand(
    model: Model, delay: float
) -> None:
    """What a fit goes by, through instants that move with the parameter."""
    h = 1e-5
    (above, _), (below, _) = loop(delay + h), loop(delay - h)
    found = sensitivity(
        model,
        np.arange(SAMPLES + 1) * PERIOD,
        {"setpoint_pan": step(GOAL, GOAL, 1.0)},
        {**VALUES, "n_compute_pan": delay},
        by_parameters=["n_compute_pan"],
        rtol=1e-10,
        atol=1e-12,
    )
    slope = found.states[:, 0, 0]
    assert slope == pytest.approx((above - below) / (2.0 * h), rel=1e-4, abs=1e-8)


def test_it_is_a_candidate_behind_a_declared_controller_alone() -> None:
    served, driven = platform("pid_controller"), platform()
    found, untried = structures(served)
    rebuilt = next(each for each in found if each.keys == ("controller_delay@pan",))
    assert {e.effect for e in rebuilt.platform.effects} > {"pid_controller", "controller_delay"}
    assert "controller_delay@pan" not in untried
    others, untried = structures(driven)
    assert all("controller_delay@pan" not in each.keys for each in others)
    assert untried["controller_delay@pan"] == (
        "not tried: it needs computed_pan and sampling_pan, which no declared effect defines"
    )
