"""Derivatives of a finished fit, for its intervals: a pendulum that SciPy swings nearly to its top,
where two percent more of inertia carry it over; and jumps and stairs in closed form.
"""

import math
from collections.abc import Callable
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from ptp_symbolic.numeric.identify import intervals
from ptp_symbolic.numeric.identify.constants import MISLEADING, ROUGH
from ptp_symbolic.numeric.identify.coordinates import FreeParameter, free_parameter, to_search
from ptp_symbolic.numeric.identify.fit import Fit, fit_parameters
from ptp_symbolic.numeric.identify.intervals import estimates, reaches, with_finite_differences
from ptp_symbolic.numeric.identify.least_squares import Secants
from tests.identify.curves import Floats
from tests.identify.straight import finished
from tests.identify.test_windows import COUNT, FREE, MODEL, run_of

MASS, ARM, INERTIA = 1.0, 0.02, 0.02  # kg, m, kg m^2 of the body beside the payload
TORQUE = MASS * 9.81 * ARM  # N m, of gravity, tilt level
LEVER = MASS * ARM**2  # kg m^2, of the payload
BOTTOM = math.pi / 2.0  # rad: a positive tilt lowers the boresight
TIME = 0.01 * np.arange(601)
TOP = math.sqrt(4.0 * TORQUE / (INERTIA + LEVER))  # rad/s at the bottom, to come to rest at the top
RATE = TOP * math.sqrt(0.982)


def swing(inertia: float) -> Floats:
    """Tilt angles in rad of the pendulum that passes its lowest point with RATE at first."""
    found = solve_ivp(
        lambda _, x: [x[1], TORQUE * math.cos(x[0]) / (inertia + LEVER)],
        (0.0, TIME[-1]),
        [BOTTOM, RATE],
        t_eval=TIME,
        rtol=1e-10,
        atol=1e-12,
    )
    return np.asarray(found.y[0])


def swung() -> Fit:
    """The inertia fitted to the swing, rounded to counts, its start known."""
    made = run_of(0.0 * TIME, swing(INERTIA), 0.0 * TIME, 0.01)
    start = made.start.copy()
    names = list(MODEL.state_names)
    start[[names.index("theta_tilt"), names.index("omega_tilt")]] = BOTTOM, RATE
    free = (free_parameter("J_y_tilt", INERTIA, 1e-4, 1.0),)
    payload = {"m_payload": MASS, "c_x_payload": ARM, "c_y_payload": 0.0, "c_z_payload": 0.0}
    fixed = {**MODEL.defaults, **FREE, **payload}
    fixed.pop("J_y_tilt")
    return fit_parameters(MODEL, [replace(made, start=start, unknowns=())], free, fixed)


def test_two_percent_of_inertia_carry_the_pendulum_over() -> None:
    assert np.max(swing(INERTIA)) < BOTTOM + math.pi
    assert np.max(swing(1.02 * INERTIA)) > BOTTOM + 2.0 * math.pi


def test_a_motion_that_the_run_rules_out_tells_nothing_of_a_parameter() -> None:
    """The derivative by the logarithm of the inertia is that at the optimum, which is known to a
    part in a million; over two percent the angle changes by turns.
    """
    fit = with_finite_differences(swung())
    (told,) = estimates(fit)
    assert told.lower < INERTIA < told.upper < (1.0 + 1e-5) * INERTIA
    step = 1e-5 * INERTIA
    slope = (swing(INERTIA + step) - swing(INERTIA - step)) / (2.0 * step)
    size = INERTIA * np.linalg.norm(slope) * math.sqrt(12.0) / COUNT
    far = np.linalg.norm(swing(1.02 * INERTIA) - swing(INERTIA)) / 0.02 * math.sqrt(12.0) / COUNT
    assert far > size / MISLEADING
    assert np.linalg.norm(fit.evaluations[0].by_parameter) == pytest.approx(size, rel=0.1)


SAMPLES = 400
RAMP = np.linspace(-1.0, 1.0, SAMPLES)
FREE_ONE = FreeParameter("p", 1.0, -1e3, 1e3)
Residual = Callable[[float], Floats]


def closed(monkeypatch: pytest.MonkeyPatch, residual: Residual, tangent: Floats) -> Fit:
    """A fit at the value 1 of a parameter with white noise of 1, a `residual` [SAMPLES] of the
    parameter beside it, and its `tangent` there.
    """
    noise = np.random.default_rng(2).standard_normal(SAMPLES)
    fit = finished([noise], [tangent[:, None]], free=(FREE_ONE,), values={"p": 1.0})
    secants = Secants(lambda _, phi, z: noise + residual(float(phi[0])), np.array([np.inf]))
    problem = SimpleNamespace(evaluate=lambda *_: list(fit.evaluations), refine=secants)
    monkeypatch.setattr(intervals, "simulations_of", lambda *_: None)
    monkeypatch.setattr(intervals, "problem_of", lambda *_: problem)
    return fit


SLOPE = 40.0
KNOWN = 1.96 / (SLOPE * float(np.linalg.norm(RAMP)))  # a quarter of a usual step


@pytest.mark.parametrize("away", [2.0, 0.5, 0.01])
def test_a_single_jump_does_not_tell_where_a_parameter_is(
    monkeypatch: pytest.MonkeyPatch, away: float
) -> None:
    """The ramp tells the parameter as it does without a jump, however near that is."""
    zero = to_search((FREE_ONE,), {"p": 1.0})[0]

    def residual(phi: float) -> Floats:
        return SLOPE * (phi - zero) * RAMP + 1e4 * (phi - zero > away * KNOWN)

    fit = closed(monkeypatch, residual, SLOPE * RAMP)
    assert reaches(with_finite_differences(fit)) == pytest.approx([KNOWN], rel=0.15)


def test_errors_of_the_simulation_tell_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    """A run that does not depend on the parameter, simulated to half a percent of its noise."""
    draws = np.random.default_rng(4)
    fit = closed(monkeypatch, lambda _: 0.5 * ROUGH * draws.standard_normal(SAMPLES), 0.0 * RAMP)
    assert np.isinf(reaches(with_finite_differences(fit))).all()


def test_differences_go_as_far_as_they_are_asked_to(monkeypatch: pytest.MonkeyPatch) -> None:
    """What a jump within the errors of a value does to a prediction is seen in full."""
    zero = to_search((FREE_ONE,), {"p": 1.0})[0]
    fit = closed(monkeypatch, lambda phi: 1e4 * (phi - zero > 0.5 * KNOWN) + 0.0 * RAMP, 0.0 * RAMP)
    moved = with_finite_differences(fit, reach=np.array([KNOWN]))
    assert KNOWN * moved.evaluations[0].by_parameter == pytest.approx(1e4)


def test_the_slope_of_a_staircase_is_that_of_its_flight(monkeypatch: pytest.MonkeyPatch) -> None:
    """Treads of a thousandth of what the data tell, without a derivative on any."""
    own = 1.96 / (400.0 * float(np.linalg.norm(RAMP)))
    zero = to_search((FREE_ONE,), {"p": 1.0})[0]

    def residual(phi: float) -> Floats:
        return 0.4 * own * np.floor((phi - zero) / (1e-3 * own)) * RAMP

    fit = closed(monkeypatch, residual, 0.0 * RAMP)
    assert reaches(with_finite_differences(fit)) == pytest.approx([own], rel=0.15)
