"""A search over fewer samples: an independent drive, sampled four times closer than it needs."""

from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest

from ptp_symbolic.numeric.diagnose import noise_floor
from ptp_symbolic.numeric.diagnose.fitted_model import FittedModel, SearchProblem, fitted
from ptp_symbolic.numeric.diagnose.noise_floor import (
    fitted_to_every_sample,
    is_thinned,
    noise_floor_of,
    propagated_input_noise,
    with_every_residual,
    with_fewer_samples,
)
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
def problem() -> Iterator[SearchProblem]:
    first, second = make_runs(PanDrive(), [slow(), by_input_noise()], 5).runs
    coarse = replace(first, weight=first.weight * np.array([0.05, 1.0]))  # its current
    runs = (coarse, second)
    none: tuple[tuple[Run, ...], ...] = ()
    with ThreadPoolExecutor(2) as executor, pytest.MonkeyPatch.context() as patched:
        patched.setattr(noise_floor, "SEARCH_PERIOD", 0.02)
        yield with_fewer_samples(
            SearchProblem(
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
def searched(problem: SearchProblem) -> FittedModel:
    return fitted(problem, (), problem.fixed, None, 12)


def test_a_run_loses_samples_unless_a_signal_needs_them(problem: SearchProblem) -> None:
    lengths = [len(run.time) for run in problem.train]
    assert lengths[0] <= 1000 and lengths[1] == 2000
    assert [len(run.time) for run in problem.every_sample] == [2000, 2000]


def test_what_was_found_is_fitted_to_every_sample(
    problem: SearchProblem, searched: FittedModel
) -> None:
    """It ends as low as a fit to every sample from the start."""
    assert is_thinned(problem, searched.fit)
    (found,) = fitted_to_every_sample(problem, [searched])
    assert found.fit.runs == problem.every_sample
    whole = replace(problem, train=problem.every_sample)
    direct = fitted(whole, (), problem.fixed, None, 30, share=1e-3)
    assert found.fit.cost == pytest.approx(direct.fit.cost, rel=1e-3)
    assert fitted_to_every_sample(problem, [found]) == [found]


def test_noise_is_judged_by_every_sample(problem: SearchProblem, searched: FittedModel) -> None:
    """The inputs of fewer samples are averages, with less noise; the angle shows the same."""
    every = with_every_residual(problem, searched.fit)
    assert [e.residual.size for e in every.evaluations] == [
        run.size for run in problem.every_sample
    ]
    whole = replace(problem, train=problem.every_sample)
    same = propagated_input_noise(whole, replace(searched.fit, runs=problem.every_sample))
    here = propagated_input_noise(problem, searched.fit)
    assert np.array_equal(here.median, same.median)
    assert np.array_equal(here.most, same.most)
    floor = noise_floor_of(problem, searched, same)
    assert np.all(floor.noise < 1.2)
