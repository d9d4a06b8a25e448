"""Places in a gap: a closed form with bounces added, and an independent machine put there."""

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from numpy.typing import NDArray

from ptp_symbolic.numeric.identify.evaluate import Tolerance, evaluate
from ptp_symbolic.numeric.identify.fit import with_gap_places
from ptp_symbolic.numeric.identify.run import Run
from tests.identify.pan_runs import GAP, KNOWN, MODEL, THREE, TRUTH, Made, make_runs
from tests.independent.pan_drive import PanDrive
from tests.independent.pan_logs import COUNT

Floats = NDArray[np.float64]
HALF_GAP = 50.0  # standard deviations that the joint moves from the middle to a face


@pytest.fixture(scope="module")
def made() -> Made:
    return make_runs(PanDrive(), [profile() for profile in THREE], 21)


def only_angle(run: Run) -> Run:
    """The run with its encoder alone."""
    column = run.signals.index("theta_pan")
    gap = replace(run.unknowns[-1], column=0)
    return replace(
        run,
        measured=np.zeros((400, 1)),
        signals=("theta_pan",),
        weight=run.weight[column : column + 1],
        unknowns=(*run.unknowns[:-1], gap),
    )


def bouncing(true: float, seen: list[float]) -> Callable[[Floats], Floats]:
    """Residual whose median is a straight line through zero at `true`; a third of the samples
    bounce, ever differently, so that the sum of squares has many minima.
    """

    def residual(z: Floats) -> Floats:
        seen.append(float(z[-1]))
        noise = np.random.default_rng(5).normal(size=400)
        chaos = np.random.default_rng(int(1e6 * (z[-1] + 2.0))).normal(size=400)
        bounces = np.where(np.arange(400) % 3 == 0, 20.0 * chaos, 0.0)
        return np.asarray(HALF_GAP * (true - z[-1]) + noise + bounces)

    return residual


@pytest.mark.parametrize("true", [-0.83, -0.2, 0.4, 0.97])
def test_the_root_of_the_median_is_found_among_bounces(made: Made, true: float) -> None:
    run, seen = only_angle(made.runs[0]), list[float]()
    z = with_gap_places(run, run.guess, bouncing(true, seen))
    assert z[-1] == pytest.approx(true, abs=2.0 / HALF_GAP)
    assert np.array_equal(z[:-1], run.guess[:-1])
    assert len(seen) < 9  # the start, a face, and Brent's steps along a nearly straight line


def test_a_place_that_leaves_noise_is_kept_after_one_simulation(made: Made) -> None:
    run, seen = only_angle(made.runs[0]), list[float]()
    start = run.guess
    start[-1] = 0.4
    assert np.array_equal(with_gap_places(run, start, bouncing(0.4, seen)), start)
    assert seen == [0.4]


def test_what_cannot_be_simulated_is_left_where_it_is(made: Made) -> None:
    run = only_angle(made.runs[0])
    assert np.array_equal(with_gap_places(run, run.guess, lambda z: None), run.guess)


def test_beyond_a_face_the_best_place_looked_at_is_taken(made: Made) -> None:
    """The shaft is wound up: the root lies outside of the gap, a face is nearest to it."""
    run, seen = only_angle(made.runs[0]), list[float]()
    assert with_gap_places(run, run.guess, bouncing(1.5, seen))[-1] == 1.0


def test_an_independent_machine_is_found_where_it_was_put(made: Made) -> None:
    """At the true parameters, nothing fitted: to a count, which is what the angle at the start is
    unknown by.
    """
    p, none = MODEL.parameter_vector({**KNOWN, **TRUTH}), np.zeros(0, dtype=np.int64)

    def residual(run: Run, z: Floats) -> Floats:
        return evaluate(MODEL, run, p, z, none, False, Tolerance()).residual

    for run, place in zip(made.runs, made.places, strict=True):
        z = with_gap_places(run, run.guess, partial(residual, run))
        found = dict(zip([u.name for u in run.unknowns], z, strict=True))
        assert found["gap_place_0"] == pytest.approx(place, abs=COUNT / (GAP / 2))
