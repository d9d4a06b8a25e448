"""Cauchy's loss over blocks of a residual: by hand, by SciPy, and past a valley."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

from ptp_symbolic.numeric.identify.blocks import (
    blocks_of,
    robust_tuning,
    weighted_median,
)
from ptp_symbolic.numeric.identify.least_squares import Problem, cost_of, minimise
from tests.identify.curves import Floats, evaluation


def location(values: Floats) -> Problem:
    """One parameter for runs without start unknowns: run r measures 50 times `values[r]`."""
    wave = np.tile([1.0, -1.0], 25)
    none: list[Floats] = [np.zeros(0) for _ in values]

    def evaluate(phi: Floats, z: object, tangents: bool):
        return [evaluation(v - phi[0] + wave, -np.ones((50, 1)), np.zeros((50, 0))) for v in values]

    return Problem(
        evaluate, np.array([-99.0]), np.array([99.0]), none, none, none, np.zeros(1), np.zeros(1)
    )


def test_loss_of_windows_by_hand() -> None:
    """Twenty windows of ten samples: 19 of rms 1, one of rms 10, with half weight at rms 2.5."""
    none = np.zeros((10, 0))
    windows = [evaluation(np.full(10, r), none, none) for r in (*[1.0] * 19, 10.0)]
    problem = location(np.zeros(20))
    no_starts = [np.zeros(0)] * 20
    tuning = robust_tuning([(e, None) for e in windows], np.inf)
    assert tuning == 2.5
    by_hand = 19 * 10 * 6.25 * math.log(1.16) + 10 * 6.25 * math.log(17.0)
    assert cost_of(problem, windows, no_starts, tuning) == pytest.approx(by_hand, rel=1e-14)
    assert cost_of(problem, windows, no_starts) == pytest.approx(190 + 10 * 100, rel=1e-14)
    assert robust_tuning([(e, None) for e in windows[:19]], np.inf) == np.inf
    assert robust_tuning([(e, None) for e in windows], 1.0) == np.inf
    assert robust_tuning([(e, None) for e in windows], 1.1) == 2.5
    failed = [replace(windows[0], failed="stopped"), *windows[1:]]
    assert robust_tuning([(e, None) for e in failed], np.inf) == np.inf


def test_a_median_counts_every_run_by_its_samples() -> None:
    """Of 1, 2 and 9 with 5, 1 and 1 samples it lies where half of the samples are below: between
    the middles of the first two, at 2.5 and 5.5 of 7, a third of the way.
    """
    values = np.array([[9.0, 1.0], [1.0, 1.0], [2.0, 1.0]])
    assert weighted_median(values, np.array([1.0, 5.0, 1.0])) == pytest.approx([4.0 / 3.0, 1.0])
    assert weighted_median(values, np.ones(3)) == pytest.approx([2.0, 1.0])


def test_windows_in_a_wrong_branch_hardly_move_the_optimum() -> None:
    """Three windows of 23 lie far off. The optimum is that of Cauchy's loss of windows, by search
    over one number; least squares would go twenty times as far from the truth, 0.
    """
    values = np.array([*np.linspace(-0.4, 0.4, 20), 12.0, 13.0, 14.0])
    problem = location(values)
    found = minimise(problem, np.array([1.0]), [np.zeros(0)] * 23, 100, 1e-13, 12)

    def rms(at: float) -> Floats:
        return np.sqrt((values - at) ** 2 + 1.0)

    tuning = 2.5 * np.median(rms(found.phi[0]))

    def loss(at: float) -> float:
        return float(np.sum(np.log(1.0 + (rms(at) / tuning) ** 2)))

    exact = minimize_scalar(loss, bounds=(-5.0, 5.0), method="bounded", options={"xatol": 1e-10})
    assert found.phi[0] == pytest.approx(exact.x, abs=1e-6)
    assert found.phi[0] < np.mean(values) / 15.0


def test_blocks_of_one_run_weigh_as_windows_do() -> None:
    """The 23 windows end to end, as one run: the same optimum. A cost is good to its rounding, and
    tells a value to the root of that, 1.5e-8.
    """
    values = np.array([*np.linspace(-0.4, 0.4, 20), 12.0, 13.0, 14.0])
    windows = location(values)

    def evaluate(phi: Floats, z: object, tangents: bool):
        every = windows.evaluate(phi, [], tangents)
        residual = np.concatenate([e.residual for e in every])
        return [evaluation(residual, -np.ones((23 * 50, 1)), np.zeros((23 * 50, 0)))]

    none, blocks = [np.zeros(0)], [np.repeat(np.arange(23), 50)]
    run = replace(
        windows,
        evaluate=evaluate,
        start_lower=none,
        start_upper=none,
        start_sigma=none,
        blocks=blocks,
    )
    by_windows = minimise(windows, np.array([1.0]), none * 23, 100, 1e-13, 12)
    by_blocks = minimise(run, np.array([1.0]), none, 100, 1e-13, 12)
    assert by_blocks.phi == pytest.approx(by_windows.phi, abs=1.5e-8)
    assert by_blocks.cost == pytest.approx(by_windows.cost, rel=1e-12)


def test_rows_of_two_signals_share_blocks_and_the_rest_joins_the_last() -> None:
    """2.4 s in blocks of 1 s: two blocks, the second of 1.4 s; a run shorter than one is one."""
    time = 7.0 + 0.4 * np.arange(7)
    assert blocks_of(time, 2, 1.0).tolist() == [0] * 6 + [1] * 8
    assert blocks_of(time[:2], 1, 1.0).tolist() == [0, 0]


def late(blocks: list[np.ndarray] | None) -> Problem:
    """One run of 30 blocks of ten rows with the truth at 1. Below 0.9 one block slips late, and the
    squares are least where the rest pays for it, at 1 - (1/30 10) = 0.67.
    """
    noise = np.tile([0.1, -0.1], 150)
    slip = np.zeros(300)
    slip[70:80] = 10.0

    def evaluate(phi: Floats, z: object, tangents: bool):
        residual = 1.0 - phi[0] + noise - slip * (phi[0] < 0.9)
        return [evaluation(residual, -np.ones((300, 1)), np.zeros((300, 0)))]

    bound, none = np.array([9.0]), [np.zeros(0)]
    return Problem(
        evaluate, -bound, bound, none, none, none, np.zeros(1), np.zeros(1), blocks=blocks
    )


def test_blocks_lead_out_of_a_valley_that_one_late_slip_digs() -> None:
    begin, none = np.array([0.5]), [np.zeros(0)]
    stuck = minimise(late(None), begin, none, 100, 1e-9, 12)
    assert stuck.phi[0] == pytest.approx(2.0 / 3.0, abs=1e-6)
    eased = minimise(late([np.repeat(np.arange(30), 10)]), stuck.phi, none, 100, 1e-9, 12)
    assert eased.phi[0] == pytest.approx(1.0, abs=1e-6)
    assert math.sqrt(float(np.mean(eased.evaluations[0].residual ** 2))) == pytest.approx(0.1)
