"""Fits led through ever longer windows, on logs of the benchmark's own integrator."""

import json
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest

from ptp_symbolic.models import emission, variants
from ptp_symbolic.numeric.data import log_files, read_split_logs
from ptp_symbolic.numeric.diagnose.fitted_model import SearchProblem, fitted
from ptp_symbolic.numeric.diagnose.noise_floor import normalised_residual, propagated_input_noise
from ptp_symbolic.numeric.diagnose.proposals import propose
from ptp_symbolic.numeric.diagnose.refits import fit_declared, to_its_end
from ptp_symbolic.numeric.diagnose.search import through_windows
from ptp_symbolic.platform import read_platform
from ptp_symbolic.workflows.preparation import effect_keys, problem_for, workers
from tests.benchmark.catalogue import catalogue
from tests.benchmark.sets import generate


@contextmanager
def logged(number: str, folder: Path) -> Iterator[tuple[SearchProblem, dict[str, float]]]:
    """The problem of a set of the benchmark, and the parameters of its machine."""
    generate(next(e for e in catalogue() if e.id.startswith(number)), folder)
    platform = read_platform(folder / "platform.toml")
    train, validate = (log_files(sorted((folder / h).glob("*.csv"))) for h in ("train", "validate"))
    logs = read_split_logs(train, validate, platform)
    model = emission.emit(variants.with_candidates(platform))
    with workers() as executor:
        problem = problem_for(
            platform, model, *logs, effect_keys(platform), executor, lambda text: None
        )
        yield problem, json.loads((folder / "truth.json").read_text())["parameters"]


@pytest.mark.long
def test_windows_lead_to_the_breakaway_of_the_machine(tmp_path: Path) -> None:
    """A direct drive that hides it: the declared model leaves a hundred times the noise. Its torque
    comes in steps, so that many laws let it go at the same samples: the fit is as good as one
    that begins at the parameters of the machine, and its Coulomb friction is that of the machine.
    """
    with logged("071", tmp_path) as (problem, truth):
        problem, declared = fit_declared(problem, propose(problem))
        candidate = next(c for c in problem.candidates if c.id == "rate_dependent_breakaway")
        propagated = propagated_input_noise(problem, declared.fit)
        found = through_windows(problem, declared, candidate, propagated, is_white=False)
        assert found is not None
        own = fitted(problem, (candidate,), {**declared.values, **truth}, None)
        best = to_its_end(problem, own, propagated)
    assert np.all(normalised_residual(found.fit) < 0.02 * normalised_residual(declared.fit))
    assert found.fit.cost <= 1.001 * best.fit.cost
    assert found.values["F_c_pan"] == pytest.approx(truth["F_c_pan"], rel=0.002)


@pytest.mark.long
def test_windows_lead_the_declared_model_out_of_a_wrong_stribeck_speed(tmp_path: Path) -> None:
    """A direct drive that lacks nothing, with start values far off, in windows of four seconds."""
    with logged("236", tmp_path) as (problem, truth):
        _, declared = fit_declared(problem, propose(problem))
    for name in ("J_pan", "F_c_pan", "F_s_pan", "v_s_pan"):
        assert declared.values[name] == pytest.approx(truth[name], rel=0.03)
    assert np.all(normalised_residual(declared.fit) < 1.3)
