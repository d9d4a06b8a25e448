"""Where refits begin: in the valleys of a parameter, over which the misfit is a known curve."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from ptp_symbolic.numeric.diagnose import refits, search
from ptp_symbolic.numeric.diagnose.candidates import FAR_OFF
from ptp_symbolic.numeric.diagnose.fitted_model import FittedModel, fitted
from ptp_symbolic.numeric.diagnose.noise_floor import propagated_input_noise
from ptp_symbolic.numeric.diagnose.proposals import propose
from ptp_symbolic.numeric.diagnose.stepwise import StepwiseSearch
from ptp_symbolic.numeric.identify.evaluate import Evaluation
from tests.diagnose.spring_table import spring_table

START = 0.1
WAVES = 3.0  # of the misfit, from the least damping to the most


def ripple(damping: float) -> float:
    """Root mean square of what a damping leaves: three valleys in its logarithm, the deepest where
    the damping is its start.
    """
    if damping == 0.0:
        return 0.1
    place = np.log(damping / START) / np.log(FAR_OFF)
    return float(1.3 - 0.2 * np.cos(np.pi * WAVES * place) + 0.2 * place**2)


def test_fits_begin_in_the_other_valleys_the_deepest_first(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """From the place in one valley, whose own is not begun again. A parameter that starts at zero
    has no factor by which that may be off, deep as the misfit may be there.
    """
    with spring_table(tmp_path, stiffness=0.0) as problem:
        proposals = propose(problem)
        (damping,) = (f for f in problem.free if f.name == "b_pan")
        damping = replace(damping, start=START, lower=0.0, upper=9.0)
        own = START * FAR_OFF ** (-2.0 / WAVES)
        trial = fitted(problem, (), proposals.start | {"b_pan": own}, None)

        def simulated_at(_: Any, fit: Any, values: dict[str, float]) -> list[Evaluation]:
            size = ripple(values["b_pan"])
            return [replace(e, residual=np.full_like(e.residual, size)) for e in fit.evaluations]

        there = simulated_at(None, trial.fit, {"b_pan": own})
        trial = replace(trial, fit=replace(trial.fit, evaluations=tuple(there)))
        monkeypatch.setattr(
            refits, "weakly_identified", lambda _: [damping, replace(damping, start=0.0)]
        )
        monkeypatch.setattr(refits, "simulated_at", simulated_at)
        begun = refits.from_far_off(problem, proposals, trial)
    found = [t.values["b_pan"] / START for t in begun]
    assert found == pytest.approx([1.0, 1.5**2, FAR_OFF, 1.0 / FAR_OFF], rel=1e-9)
    assert all(t.values["J_pan"] == trial.values["J_pan"] for t in begun)


@pytest.mark.parametrize(
    ("outside", "back"), [(1.01 * FAR_OFF, [1.0, FAR_OFF, 1.0 / FAR_OFF]), (0.99 * FAR_OFF, [])]
)
def test_fits_begin_where_a_parameter_outside_its_range_is_back(
    outside: float, back: list[float], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Though every run has one place to begin from, and whatever it leaves."""
    with spring_table(tmp_path, stiffness=0.0) as problem:
        proposals = propose(problem)
        monkeypatch.setattr(refits, "weakly_identified", lambda _: [])
        (damping,) = (f for f in problem.free if f.name == "b_pan")
        there = proposals.start | {"b_pan": outside * damping.start}
        begun = refits.from_far_off(problem, proposals, fitted(problem, (), there, None))
    found = [t.values["b_pan"] / damping.start for t in begun]
    assert found == pytest.approx(back, rel=1e-9)


def test_a_place_that_is_no_likelier_is_not_taken(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with spring_table(tmp_path, stiffness=0.0) as problem:
        proposals = propose(problem)
        end = fitted(problem, (), proposals.start, None, 12)
        stepwise = StepwiseSearch(problem, end, proposals, propagated_input_noise(problem, end.fit))
        worse = fitted(problem, (), end.values | {"b_pan": 1.2 * end.values["b_pan"]}, end.fit.z)
        polished: list[FittedModel] = []
        monkeypatch.setattr(
            StepwiseSearch, "polished", lambda _, trial: polished.append(trial) or trial
        )
        for begun, known, taken in ((end, end, end), (end, worse, end), (worse, end, end)):
            monkeypatch.setattr(search, "from_far_off", lambda *_, begun=begun: [begun])
            monkeypatch.setattr(search, "halving", lambda _, trials, *rest: trials)
            assert search._better_from_far_off(stepwise, known) is taken
        assert polished == [end]
