"""The declared model's best fit: `fit` and `diagnose` end in the same place."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from ptp_symbolic.numeric.diagnose.fitted_model import fitted
from ptp_symbolic.numeric.diagnose.noise_floor import propagated_input_noise
from ptp_symbolic.numeric.diagnose.proposals import propose
from ptp_symbolic.numeric.diagnose.refits import better_over_same_runs, over_whole_runs
from ptp_symbolic.numeric.diagnose.stepwise import Search, Tried
from ptp_symbolic.numeric.diagnose.verdict import with_declared_over_windows
from ptp_symbolic.platform import read_platform
from ptp_symbolic.workflows.diagnosis import diagnose_platform
from ptp_symbolic.workflows.fit import fit_platform
from tests.diagnose.spring_table import DAMPING, INERTIA, PAYLOAD, PLATFORM, log, spring_table


def test_a_search_that_ended_early_gives_the_declared_model_its_best_fit(tmp_path: Path) -> None:
    """A machine of which nothing is missing, whose search ended with twice its damping."""
    with spring_table(tmp_path, stiffness=0.0) as problem:
        proposals = propose(problem)
        problem, end = over_whole_runs(problem, proposals)
        stuck = fitted(problem, (), end.values | {"b_pan": 2.0 * DAMPING}, None)
        propagated = propagated_input_noise(problem, end.fit)
        found = Search(
            problem, stuck, stuck, (), Tried(), proposals, propagated, False, is_over_windows=False
        )
        best = with_declared_over_windows(found)
    assert best.declared is best.chosen
    assert best.declared.values["b_pan"] == pytest.approx(DAMPING, rel=0.01)
    assert best.declared.values["J_pan"] == pytest.approx(INERTIA - PAYLOAD, rel=0.01)
    assert with_declared_over_windows(best) is best
    led = replace(found, is_over_windows=True)
    assert with_declared_over_windows(led) is led


def test_windows_that_lead_to_a_worse_place_lead_nowhere(tmp_path: Path) -> None:
    with spring_table(tmp_path, stiffness=0.0) as problem:
        proposals = propose(problem)
        problem, end = over_whole_runs(problem, proposals)
        worse = fitted(problem, (), end.values | {"b_pan": 2.0 * DAMPING}, None)
    assert better_over_same_runs(end, worse) is end
    assert better_over_same_runs(worse, end) is end


@pytest.mark.long
def test_the_error_before_is_that_of_the_fit_alone(tmp_path: Path) -> None:
    """The turntable on a spring that is not declared: the declared model is off by far."""
    (tmp_path / "table.toml").write_text(PLATFORM)
    platform = read_platform(tmp_path / "table.toml")
    paths = []
    for seed in (1, 2, 3):
        run, path = log(seed), tmp_path / f"run_{seed}.csv"
        rows = np.column_stack([run.time, run.inputs, run.outputs])
        np.savetxt(path, rows, delimiter=",", header="time [s],torque,angle", comments="")
        paths.append(path)
    alone = fit_platform(platform, paths[:2]).summary
    before = diagnose_platform(platform, paths[:2], paths[2:]).summary
    assert before["added"][0]["effect"] == "cable_spring"
    errors = [
        e["total"]["rmse"] for e in (alone["error"]["after"], before["error"]["train"]["before"])
    ]
    assert alone["windows"] == before["error"]["train"]["before"]["windows"]
    assert errors[0] == pytest.approx(errors[1], rel=1e-3)
    for name, own in alone["parameters"].items():
        half = 0.5 * (own["ci95"][1] - own["ci95"][0])
        told = before["fit"]["before"]["parameters"][name]["value"]
        assert told == pytest.approx(own["value"], abs=0.05 * half), name
