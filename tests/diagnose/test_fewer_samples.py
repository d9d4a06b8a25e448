"""A search over fewer samples: an independent drive, sampled four times closer than it needs."""

from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest

from ptp_symbolic.numeric.diagnose import noise_floor
from ptp_symbolic.numeric.diagnose.noise_floor import (
    carried_noise,
    fitted_to_every_sample,
    is_thinned,
    noise_floor_of,
    with_every_residual,
    with_fewer_samples,
)
from ptp_symbolic.numeric.diagnose.trial import Task, Trial, fitted
from ptp_symbolic.numeric.identify.run import Run
from tests.diagnose.test_refits import FREE
from tests.identify.pan_runs import COUNT, FLOOR, KNOWN, MODEL, TRUTH, make_runs, seconds
from tests.independent.pan_drive import PanDrive


def slow() -> np.ndarray:
    """A voltage [k] that hardly changes from sample to sample, over the gap and back."""
    return 9.0 * np.sin(2.0 * np.pi * 0.1 * seconds(10.0))


def by_input_noise() -> np.ndarray:
    """A voltage [k] that changes from sample to sample: the current follows at once."""
    return slow() + 0.3 * np.sin(2.0 * np.pi * 33.0 * seconds(10.0))


@pytest.fixture(scope="module")
def task() -> Iterator[Task]:
    first, second = make_runs(PanDrive(), [slow(), by_input_noise()], 5).runs
    coarse = replace(first, weight=first.weight * np.array([0.05, 1.0]))  # its current
    runs = (coarse, second)
    none: tuple[tuple[Run, ...], ...] = ()
    with ThreadPoolExecutor(2) as executor, pytest.MonkeyPatch.context() as patched:
        patched.setattr(noise_floor, "SEARCH_PERIOD", 0.02)
        yield with_fewer_samples(
            Task(
                MODEL,
                runs,
                runs,
                runs,
                none,
                (),
                (),
                FREE,
                {**KNOWN, **TRUTH},
                (),
                executor,
                lambda text: None,
                (None,),
                frozenset(),
                FLOOR * COUNT,
            ),
            {**KNOWN, **TRUTH},
        )


@pytest.fixture(scope="module")
def searched(task: Task) -> Trial:
    return fitted(task, (), task.fixed, None, 12)


def test_a_run_loses_samples_unless_a_signal_needs_them(task: Task) -> None:
    lengths = [len(run.time) for run in task.train]
    assert lengths[0] <= 1000 and lengths[1] == 2000
    assert [len(run.time) for run in task.every_sample] == [2000, 2000]


def test_what_was_found_is_fitted_to_every_sample(task: Task, searched: Trial) -> None:
    """It ends as low as a fit to every sample from the start."""
    assert is_thinned(task, searched.fit)
    (found,) = fitted_to_every_sample(task, [searched])
    assert found.fit.runs == task.every_sample
    whole = replace(task, train=task.every_sample)
    direct = fitted(whole, (), task.fixed, None, 30, share=1e-3)
    assert found.fit.cost == pytest.approx(direct.fit.cost, rel=1e-3)
    assert fitted_to_every_sample(task, [found]) == [found]


def test_noise_is_judged_by_every_sample(task: Task, searched: Trial) -> None:
    """The inputs of fewer samples are averages, with less noise; the angle shows the same."""
    every = with_every_residual(task, searched.fit)
    assert [e.residual.size for e in every.evaluations] == [run.size for run in task.every_sample]
    whole = replace(task, train=task.every_sample)
    same = carried_noise(whole, replace(searched.fit, runs=task.every_sample))
    here = carried_noise(task, searched.fit)
    assert np.array_equal(here.usual, same.usual)
    assert np.array_equal(here.most, same.most)
    floor = noise_floor_of(task, searched, same)
    assert np.all(floor.noise < 1.2)
