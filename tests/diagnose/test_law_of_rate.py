"""Whether a torque goes with the rate as its law says, on logs of SciPy's integrator."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from ptp_symbolic.numeric.data import Log
from ptp_symbolic.numeric.diagnose import along_rows
from ptp_symbolic.numeric.diagnose.along_rows import _Motion, extended_along_motion
from ptp_symbolic.numeric.diagnose.confirm import contradicts_its_law
from ptp_symbolic.numeric.diagnose.fitted_model import fitted
from ptp_symbolic.numeric.diagnose.proposals import declared_start, propose, start_for
from tests.diagnose.spring_table import (
    COUNT,
    DAMPING,
    INERTIA,
    PERIOD,
    SAMPLES,
    STIFFNESS,
    table_of,
)

USUAL = 1.0  # rad/s
DRAG = 0.05  # N m s^2/rad^2
Torque = Callable[[float, float], float]


def spring(angle: float, rate: float) -> float:
    return -STIFFNESS * angle


def cubic_spring(angle: float, rate: float) -> float:
    return -STIFFNESS * angle**3


def spring_by_speed(angle: float, rate: float) -> float:
    return -STIFFNESS * angle * abs(rate) / USUAL


def spring_partly_by_speed(angle: float, rate: float) -> float:
    return 0.6 * spring(angle, rate) + 0.4 * spring_by_speed(angle, rate)


def drag_by_speed(angle: float, rate: float) -> float:
    return -DRAG * rate**3 / USUAL


def logged(hidden: Torque, seed: int) -> Log:
    """Six seconds under a torque that changes every half second, and one that is `hidden`."""
    rng = np.random.default_rng(seed)
    torque = np.repeat(rng.uniform(-0.5, 0.5, SAMPLES // 50), 50)
    time = PERIOD * np.arange(SAMPLES)

    def rates(t: float, x: np.ndarray) -> list[float]:
        acting = torque[min(int(t / PERIOD + 1e-6), SAMPLES - 1)] + hidden(x[0], x[1])
        return [x[1], (acting - DAMPING * x[1]) / INERTIA]

    found = solve_ivp(rates, (0.0, time[-1]), [0.0, 0.0], "LSODA", time, max_step=PERIOD, rtol=1e-8)
    reading = np.rint(found.y[0] / COUNT) * COUNT
    return Log(f"run_{seed}", time, torque[:, None], reading[:, None])


@pytest.mark.parametrize(
    ("hidden", "breaks", "mostly"),
    [
        (spring, False, False),
        (spring_partly_by_speed, True, False),
        (spring_by_speed, True, True),
    ],
)
def test_a_spring_that_is_stronger_where_it_is_fast_is_none(
    hidden: Torque, breaks: bool, mostly: bool, tmp_path: Path
) -> None:
    with table_of(tmp_path, lambda seed: logged(hidden, seed)) as problem:
        proposals = propose(problem)
        (found,) = [
            c for c in problem.candidates if c.key == "cable_spring@pan" and len(c.defining) == 1
        ]
        values = start_for(problem, proposals, (found,), proposals.start)
        assert abs(values["k1_cable_pan"]) > 0.2 * STIFFNESS
        assert proposals.space is not None
        law = (problem, proposals.space, (found,), values, found)
        assert contradicts_its_law(*law) is breaks
        assert contradicts_its_law(*law, loosely=True) is mostly


@pytest.mark.parametrize(
    ("hidden", "key", "named"),
    [
        (spring, "cable_spring@pan", True),
        (spring_by_speed, "cable_spring@pan", False),
        (drag_by_speed, "quadratic_drag@pan", False),
    ],
)
def test_what_broke_its_law_has_to_keep_it_along_the_motion(
    hidden: Torque, key: str, named: bool, tmp_path: Path
) -> None:
    """Beside a second friction, drag makes up in the rows for a torque cubic in the rate."""
    with table_of(tmp_path, lambda seed: logged(hidden, seed)) as problem:
        declared = fitted(problem, (), declared_start(problem), None)
        grown = extended_along_motion(problem, propose(problem), declared, problem.train, [key])
        assert (key in grown.trial.keys if grown else False) is named


def test_the_law_is_asked_for_loosely_of_what_has_not_broken_it(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """Here every spring breaks its law loosely, and none strictly."""
    monkeypatch.setattr(along_rows, "contradicts_its_law", lambda *_, loosely: loosely)
    with table_of(tmp_path, lambda seed: logged(spring, seed)) as problem:
        declared, found = fitted(problem, (), declared_start(problem), None), propose(problem)
        assert extended_along_motion(problem, found, declared, problem.train) is None
        grown = extended_along_motion(problem, found, declared, problem.train, ["cable_spring@pan"])
        assert grown is not None and grown.trial.keys == ("cable_spring@pan",)


@pytest.mark.parametrize(("hidden", "cubic"), [(spring, False), (cubic_spring, True)])
def test_a_fuller_form_that_earns_nothing_is_left_out_along_the_motion(
    hidden: Torque, cubic: bool, tmp_path: Path
) -> None:
    with table_of(tmp_path, lambda seed: logged(hidden, seed)) as problem:
        proposals = propose(problem)
        assert proposals.space is not None and proposals.regression is not None
        motion = _Motion(problem, proposals.space, proposals.regression, proposals.start, ())
        springs = [
            s.candidate
            for s in proposals.regression.signatures
            if s.candidate.key == "cable_spring@pan"
        ]
        full = max(springs, key=lambda c: len(c.free))
        assert "k3_cable_pan" in full.parameters
        (found,) = motion.in_simplest_forms((full,), ())
        assert ("k3_cable_pan" in found.parameters) is cubic
        assert motion.in_simplest_forms((full,), (full,)) == (full,)
