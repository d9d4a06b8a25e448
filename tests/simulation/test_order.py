"""Order of convergence of every method: smooth, at rest and away again, across a gap.

Steps of one length, errors against exact solutions, the order as the slope of a line through four
errors. The motions are nonlinear: Rodas5P is of order 6 for linear ones. The steps are as short as
the leading term of the error needs to rule: at a tenth of a swing that of Tsitouras's pair, whose
coefficients are tiny, does not yet; nor does that of the pair of order 8, beside the next, until
rounding does. Slow motions keep the error well above what an event costs, which is found to 2e-12 s
whatever the step.
"""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import quad, solve_ivp
from scipy.optimize import brentq
from scipy.special import ellipj, ellipk

import ptp_symbolic
from ptp_symbolic.models import emission
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.inputs import ramp, step
from ptp_symbolic.numeric.simulation.run import Trajectory
from ptp_symbolic.platform import EffectDeclaration, Platform
from tests.simulation.block import block

METHODS = ("rosenbrock", "runge_kutta")
K, K3 = 8.0, 10.0


def sizes(longest: float, count: int = 4) -> NDArray[np.float64]:
    return longest * 2.0 ** (-0.5 * np.arange(count))


def order(error: Callable[[float], float], lengths: NDArray[np.float64]) -> float:
    """Slope of log error over log step."""
    errors = [error(length) for length in lengths]
    return float(np.polyfit(np.log(lengths), np.log(errors), 1)[0])


def run(model: Model, times: Any, method: str, length: float, **rest: Any) -> Trajectory:
    """Steps of one length, but for those that end at an event or an output."""
    return ptp_symbolic.simulate(
        model, times, method=method, step=length, largest_step=length, rtol=1e3, atol=1e3, **rest
    )


@pytest.mark.parametrize(
    ("method", "expected", "within", "longest", "end"),
    [
        ("rosenbrock", 5.0, 0.1, 5e-3, 10.0),
        ("runge_kutta", 8.5, 0.5, 0.1, 10.0),
        ("fixed_step", 2.0, 0.1, 1e-4, 2.0),
    ],
)
def test_a_pendulum_of_large_swing(
    method: str, expected: float, within: float, longest: float, end: float, figure
) -> None:
    """The payload, let go 160 degrees off its rest: an elliptic function."""
    model, swing = ptp_symbolic.load("payload"), 2.8
    v = model.defaults
    inertia = v["J_y_tilt"] + v["J_y_payload"] + v["m_payload"] * v["c_x_payload"] ** 2
    rate = math.sqrt(v["m_payload"] * 9.81 * v["c_x_payload"] / inertia)
    times, k = np.linspace(0.0, end, 11), math.sin(swing / 2)
    exact = 2.0 * np.arcsin(k * ellipj(ellipk(k * k) - rate * times, k * k)[0]) + math.pi / 2
    start, free = {"theta_tilt": math.pi / 2 + swing}, {"b_tilt": 0.0}

    def error(length: float) -> float:
        found = run(model, times, method, length, parameters=free, initial=start)
        return float(np.linalg.norm(found["theta_tilt"] - exact))

    found = figure(f"order, {expected:g} expected", order(error, sizes(longest)))
    assert found == pytest.approx(expected, abs=within)


def rest_after_swings(start: float, friction: float, pull: float) -> tuple[float, int]:
    """Where a block on a hardening spring stays, and after how many swings: roots of its energy."""

    def stored(x: float) -> float:
        return 0.5 * K * x**2 + 0.25 * K3 * x**4 - pull * x

    x, swings = start, 0
    while abs(spring := K * x + K3 * x**3 - pull) > friction:
        way = math.copysign(1.0, spring)

        def lost(y: float, x: float = x, way: float = way) -> float:
            return stored(x) - stored(y) - friction * way * (x - y)

        x, swings = brentq(lost, x - way * 1e-9, x - 4.0 * way, xtol=1e-16), swings + 1
    return x, swings


@pytest.mark.parametrize("method", METHODS)
def test_a_block_that_comes_to_rest_and_is_pulled_away_again(method: str, figure) -> None:
    """48 swings until it stays, and 73 more when it is pulled: every one of them located."""
    friction, pull, again = 0.1, 10.0, 4e4
    first, swings = rest_after_swings(0.9, friction, 0.0)
    exact, more = rest_after_swings(first, friction, pull)
    slow = {"J": 5e5, "k": K, "k3": K3, "F_c": friction, "F_s": friction}

    def error(length: float) -> float:
        found = run(
            block(),
            [0.0, again, 2.0 * again],
            method,
            length,
            parameters=slow,
            initial={"theta_pan": 0.9},
            inputs={"tau_pan": step(0.0, pull, again)},
        )
        assert [e.mode for e in found.events].count("sticks") == 2
        assert len(found.events) == swings + more + 1
        return float(np.linalg.norm(found["theta_pan"][1:] - [first, exact]))

    found = figure("order, 5 expected", order(error, sizes(10.0)))
    assert found == pytest.approx(5.0, abs=0.1)


SLOPE, TORN_AT = 0.02, 100.0
TORN = {"J": 5000.0, "k": 0.0, "k3": K3, "F_c": 0.8, "F_s": SLOPE * TORN_AT}


def after_breakaway(end: float) -> NDArray[np.float64]:
    """State at `end` of a block that a ramp tears loose when it reaches F_s: DOP853 from there."""

    def motion(t: float, x: NDArray[np.float64]) -> list[float]:
        return [x[1], (SLOPE * t - K3 * x[0] ** 3 - TORN["F_c"]) / TORN["J"]]

    found = solve_ivp(
        motion, (TORN_AT, end), [0.0, 0.0], "DOP853", rtol=1e-13, atol=1e-15, max_step=0.5
    )
    assert found.y[1, 1:].min() > 0.0
    return found.y[:, -1]


def test_a_block_that_breaks_away_under_a_ramp(figure) -> None:
    """Steps of fixed length start it late, by half a step where they are 8 k + 4."""
    end, pull = 1.6 * TORN_AT, {"tau_pan": ramp(0.0, 1e3 * SLOPE, 0.0, 1e3)}
    exact = after_breakaway(end)

    def error(length: float, method: str = "fixed_step") -> float:
        found = run(block(), [0.0, end], method, length, inputs=pull, parameters=TORN)
        assert [e.mode for e in found.events] == ["slides forward"]
        late = found.events[0].time - TORN_AT
        assert late == pytest.approx(0.5 * length if method == "fixed_step" else 0.0, abs=1e-11)
        return float(np.linalg.norm((found.x[-1] - exact) * [1.0, 20.0]))

    found = figure("order, 1 expected", order(error, end / np.array([108, 148, 212, 300])))
    assert found == pytest.approx(1.0, abs=0.1)
    for method in METHODS:
        assert figure(f"error, {method}", error(1.0, method)) < 1e-10


@pytest.fixture(scope="module")
def flying() -> Model:
    """A load on a hardening cable wrap that flies to and fro between the faces of a held gear."""
    names = ("dc_motor", "csvs_friction", "backlash", "shaft_compliance", "cable_spring")
    effects = [EffectDeclaration(name, "pan", None) for name in names]
    bodies = EffectDeclaration("rigid_bodies", None, None)
    return emission.emit(Platform("flight", "Flight", ("pan",), 9.81, (bodies, *effects), (), ()))


FLIGHT = {
    "J_pan": 100.0,
    "gap_pan": 1.0,
    "k_shaft_pan": 2.0,
    "d_shaft_pan": 0.0,
    "k3_cable_pan": 4.0,
    "F_c_pan": 5.0,
    "F_s_pan": 5.0,
}


def touching_times(speed: float, count: int) -> NDArray[np.float64]:
    """When the load touches a face: integrals of dx / v, v from its energy."""
    inertia, half = FLIGHT["J_pan"], 0.5 * FLIGHT["gap_pan"]
    shaft, cubic = FLIGHT["k_shaft_pan"], FLIGHT["k3_cable_pan"]
    energy = 0.5 * inertia * speed**2

    def over(x: float) -> float:
        return energy - 0.25 * cubic * x**4 - 0.5 * shaft * max(x - half, 0.0) ** 2

    turn = brentq(over, half, 10.0, xtol=1e-16)
    depth = turn - half

    def pace(s: float) -> float:
        x = turn - depth * s * s
        steep = 0.25 * cubic * (turn + x) * (turn**2 + x**2) + 0.5 * shaft * (turn + x - 2 * half)
        return math.sqrt(2.0 * depth * inertia / steep)

    fine = {"epsabs": 1e-13, "epsrel": 1e-13}
    flight = quad(lambda x: math.sqrt(0.5 * inertia / over(x)), 0.0, half, **fine)[0]
    contact = 2.0 * quad(pace, 0.0, 1.0, **fine)[0]
    return flight + (contact + 2.0 * flight) * np.arange(count)


@pytest.mark.parametrize("method", METHODS)
def test_a_load_that_flies_across_the_gap(flying: Model, method: str, figure) -> None:
    speed, count = 0.1, 12
    exact = touching_times(speed, count)

    def error(length: float) -> float:
        found = run(
            flying,
            [0.0, exact[-1] + 1.0],
            method,
            length,
            parameters=FLIGHT,
            initial={"omega_pan": speed},
        )
        times = np.array([e.time for e in found.events if "touches" in e.mode])
        assert len(times) == count
        return float(np.linalg.norm(times - exact))

    found = figure("order, 5 expected", order(error, sizes(0.25)))
    assert found == pytest.approx(5.0, abs=0.1)
