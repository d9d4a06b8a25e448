"""Friction that lets go later after a longer rest, led through ever longer windows, on logs of the
benchmark's own integrator.
"""

import json
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from ptp_symbolic.models import emission, variants
from ptp_symbolic.numeric.data import log_files, read_split_logs
from ptp_symbolic.numeric.diagnose.floor import carried_noise, left_over
from ptp_symbolic.numeric.diagnose.proposals import propose
from ptp_symbolic.numeric.diagnose.refits import fit_declared
from ptp_symbolic.numeric.diagnose.through_windows import through_windows
from ptp_symbolic.numeric.diagnose.trial import Task, Trial
from ptp_symbolic.platform import read_platform
from ptp_symbolic.workflows.preparation import effect_keys, task_for
from tests.benchmark.catalogue import catalogue
from tests.benchmark.sets import generate

SET = "071"  # a direct drive that hides it


@pytest.fixture(scope="module")
def hidden(
    tmp_path_factory: pytest.TempPathFactory,
) -> Iterator[tuple[Task, Trial, dict[str, float]]]:
    """The task, its declared model, and the parameters of the machine."""
    folder = tmp_path_factory.mktemp("breakaway")
    generate(next(e for e in catalogue() if e.id.startswith(SET)), folder)
    truth = json.loads((folder / "truth.json").read_text())
    platform = read_platform(folder / "platform.toml")
    files = (log_files(sorted((folder / part).glob("*.csv"))) for part in ("train", "validate"))
    logs = read_split_logs(*files, platform)
    model = emission.emit(variants.with_candidates(platform))
    with ThreadPoolExecutor(2) as executor:
        task = task_for(platform, model, *logs, effect_keys(platform), executor, lambda text: None)
        task, declared = fit_declared(task, propose(task))
        yield task, declared, truth["parameters"]


def breakaway(values: dict[str, float], rest: float) -> float:
    """Breakaway torque (N m) after a rest of so many s (Rabinowicz, 1958)."""
    growth = values["a_rest_pan"] * np.log(1.0 + rest / values["t_rest_pan"])
    return float(values["F_s_pan"] * (1.0 + growth))


def test_windows_lead_to_the_breakaway_of_the_machine(
    hidden: tuple[Task, Trial, dict[str, float]],
) -> None:
    task, declared, truth = hidden
    candidate = next(c for c in task.candidates if c.id == "rate_dependent_breakaway")
    carried = carried_noise(task, declared.fit)
    found = through_windows(task, declared, candidate, carried)
    assert found is not None
    assert np.all(left_over(found.fit) < 0.02 * left_over(declared.fit))
    for rest in (0.1, 0.3):  # torques come in steps: after longer rests many laws do as well
        expected = breakaway(truth, rest)
        assert breakaway(found.values, rest) == pytest.approx(expected, rel=0.03)
