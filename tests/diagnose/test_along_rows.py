"""What grows along the measured motion beside a torque that nothing explains: logs whose motion is
known in closed form, under gusts that no log holds.
"""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from ptp_symbolic.numeric.diagnose import along_rows
from ptp_symbolic.numeric.diagnose.along_rows import AlongMotion, extended_along_motion
from ptp_symbolic.numeric.diagnose.fitted_model import fitted
from ptp_symbolic.numeric.diagnose.noise_floor import propagated_input_noise
from ptp_symbolic.numeric.diagnose.proposals import declared_start, propose
from ptp_symbolic.numeric.diagnose.refits import fit_declared
from ptp_symbolic.numeric.diagnose.stepwise import StepwiseSearch
from ptp_symbolic.numeric.diagnose.verdict import _near_floor, _Set
from ptp_symbolic.numeric.identify.equation_space import EquationSpace
from ptp_symbolic.numeric.identify.intervals import estimates
from tests.diagnose.spring_table import DAMPING, INERTIA, PAYLOAD, STIFFNESS, spring_table

GUST = 0.05  # N m: a tenth of the largest logged torque


def grown(
    folder: Path, stiffness: float, lasting: int = 1, gyro: bool = False
) -> AlongMotion | None:
    with spring_table(folder, stiffness, GUST, lasting, gyro) as problem:
        declared = fitted(problem, (), declared_start(problem), None)
        return extended_along_motion(problem, propose(problem), declared, problem.train)


@pytest.mark.parametrize("gyro", [False, True])
def test_a_spring_is_found_beside_gusts_and_the_intervals_tell_how_well(
    gyro: bool, tmp_path: Path
) -> None:
    """No value is further off than two intervals, four standard deviations."""
    found = grown(tmp_path, STIFFNESS, gyro=gyro)
    assert found is not None
    assert found.trial.keys == ("cable_spring@pan",)
    assert found.gains["cable_spring@pan"].lower > 0.5
    truth = {"J_pan": INERTIA - PAYLOAD, "b_pan": DAMPING, "k1_cable_pan": STIFFNESS}
    intervals = {e.name: e for e in estimates(found.fit)}
    for name, value in truth.items():
        half = 0.5 * (intervals[name].upper - intervals[name].lower)
        assert abs(intervals[name].value - value) < 2.0 * half, name
        assert half < 0.05 * value, name
    assert found.trial.values["k1_cable_pan"] == intervals["k1_cable_pan"].value
    left = np.concatenate([e.residual for e in found.trial.fit.evaluations])
    assert np.sqrt(np.mean(left**2)) > 20.0


def test_validation_runs_are_seen_in_windows_as_short_as_training_runs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Here the shortest that the samples allow are the usual ones, 0.11 s: others are taken."""
    spaces: list[EquationSpace] = []
    make = along_rows.equation_space

    def noted(*given: Any, shortest: bool = False, half_width: float | None = None) -> Any:
        space = make(*given, half_width=0.15 if shortest else half_width)
        assert space is not None
        spaces.append(space)
        return space

    monkeypatch.setattr(along_rows, "equation_space", noted)
    with spring_table(tmp_path, STIFFNESS, GUST) as problem:
        declared = fitted(problem, (), declared_start(problem), None)
        assert extended_along_motion(problem, propose(problem), declared, problem.train) is not None
    train, validate = spaces
    assert (train.runs, validate.runs) == (problem.whole, problem.validate)
    assert (train.half_width, validate.half_width) == (0.15, 0.15)


@pytest.mark.parametrize("lasting", [1, 50, 150])
def test_gusts_alone_are_given_no_name(lasting: int, tmp_path: Path) -> None:
    """Whether they change every sample or last 1.5 s."""
    assert grown(tmp_path, 0.0, lasting) is None


@pytest.mark.parametrize(("gust", "near"), [(0.0, True), (GUST, False)])
def test_a_set_that_reaches_the_floor_of_the_outputs_is_fitted_to_these(
    gust: float, near: bool, tmp_path: Path
) -> None:
    """Begun 3 % off in all values; the gusts leave 20 counts whatever they are."""
    with spring_table(tmp_path, STIFFNESS, gust) as problem:
        proposals = propose(problem)
        problem, declared = fit_declared(problem, proposals)
        stepwise = StepwiseSearch(
            problem, declared, proposals, propagated_input_noise(problem, declared.fit)
        )
        (spring,) = [
            c for c in problem.candidates if c.key == "cable_spring@pan" and len(c.defining) == 1
        ]
        truth = {"J_pan": INERTIA - PAYLOAD, "b_pan": DAMPING, "k1_cable_pan": STIFFNESS}
        values = declared.values | {name: 1.03 * value for name, value in truth.items()}
        along = fitted(problem, (spring,), values, None)
        found = _near_floor(stepwise, [_Set(along, along, along.fit, {}, {}, ())])
        assert (found is not None) is near
        if found is not None:
            for name, value in truth.items():
                assert found.values[name] == pytest.approx(value, rel=1e-3), name
    assert _near_floor(stepwise, []) is None
