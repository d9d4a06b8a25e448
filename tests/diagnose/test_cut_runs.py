"""Runs that the model of a chosen set cannot follow to their end: closed form of a pendulum."""

from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from ptp_symbolic.numeric.diagnose.cut_runs import in_windows_of
from ptp_symbolic.numeric.diagnose.fitted_model import SearchProblem, fitted
from ptp_symbolic.numeric.diagnose.noise_floor import normalised_residual
from ptp_symbolic.numeric.diagnose.proposals import ProposedSets
from ptp_symbolic.numeric.diagnose.refits import fitted_over_windows
from ptp_symbolic.numeric.diagnose.summary import windows_of
from ptp_symbolic.numeric.identify.constants import ITERATIONS
from ptp_symbolic.numeric.identify.coordinates import free_parameter
from ptp_symbolic.numeric.identify.run import Run
from tests.identify.test_windows import COUNT, FREE, MODEL, pendulum, run_of

PAYLOAD = {"m_payload": 5.0, "c_x_payload": 0.001}


@pytest.fixture(scope="module")
def problem() -> Iterator[SearchProblem]:
    """Runs above the axis, where a small angle grows a hundred and four times, and one below it,
    declared without the payload.
    """
    up, down, little = (pendulum(*of)[0] for of in ((100.0, True), (100.0, False), (4.0, True)))
    train = (up, down, little)
    with ThreadPoolExecutor(2) as executor:
        yield SearchProblem(
            MODEL,
            train,
            train,
            train,
            (),
            (),
            (down, up),
            tuple(free_parameter(name, 0.0, 0.0, 10.0) for name in PAYLOAD),
            dict(zip(MODEL.parameter_names, MODEL.parameter_vector(FREE), strict=True)),
            (),
            executor,
            lambda text: None,
            (None, None),
            frozenset(),
            COUNT,
        )


def test_runs_in_which_a_set_multiplies_errors_are_cut_and_no_other(problem: SearchProblem) -> None:
    """2.4 s above the axis are two windows; from four times up to ten a run stays whole."""
    up, down, little = problem.train
    part = in_windows_of(problem, fitted(problem, (), {**problem.fixed, **PAYLOAD}, None))
    first, second, *whole = part.train
    assert (first.source, second.source) == (up.source, up.source)
    assert len(first.time) + len(second.time) == len(up.time) + 1
    assert whole == [down, little]
    assert part.every_sample == part.train
    assert part.validate[0] is down
    assert len(part.validate) == 3
    assert windows_of(part.train) == {"count": 2, "seconds": pytest.approx(up.time[-1] / 2)}


def falling(duration: float) -> Run:
    """The payload leaves the top 0.02 rad beside it (SciPy)."""
    inertia = FREE["J_y_tilt"] + PAYLOAD["m_payload"] * PAYLOAD["c_x_payload"] ** 2
    weight = 9.81 * PAYLOAD["m_payload"] * PAYLOAD["c_x_payload"]
    time = 0.005 * np.arange(round(duration / 0.005) + 1)
    fall = solve_ivp(
        lambda _, x: [x[1], weight * np.cos(x[0]) / inertia],
        (0.0, duration),
        [0.02 - np.pi / 2, 0.0],
        t_eval=time,
        rtol=1e-10,
        atol=1e-12,
    )
    rest = np.zeros(len(time))
    return run_of(rest, fall.y[0], rest, 0.005)


def test_windows_that_the_fitted_model_cannot_follow_are_cut_again(problem: SearchProblem) -> None:
    """A payload that is declared a tenth too heavy leaves the top sooner than the true one: that is
    157 counts over 4 s, and 77 over windows of 1 s.
    """
    heavy = {**problem.fixed, **PAYLOAD, "m_payload": 1.1 * PAYLOAD["m_payload"]}
    run = falling(4.0)
    known = replace(
        problem,
        train=(run,),
        every_sample=(run,),
        validate=(run,),
        free=(free_parameter("b_pan", 0.0, 0.0, 1e-9),),
        fixed=heavy,
    )
    part, trial = fitted_over_windows(
        known, ProposedSets(heavy, (), tuple, (), (), False, None, None)
    )
    assert len(part.train) == 4
    assert len(part.validate) == 4
    assert part.few == part.train
    whole = fitted(known, (), heavy, None, ITERATIONS)
    assert np.max(normalised_residual(trial.fit)) < 0.6 * np.max(normalised_residual(whole.fit))


def test_a_set_that_multiplies_none_leaves_the_runs_as_they_are(problem: SearchProblem) -> None:
    assert in_windows_of(problem, fitted(problem, (), problem.fixed, None)) is problem
