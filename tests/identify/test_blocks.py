"""Blocks of correlated residuals: against closed forms of AR(1) noise and brute-force refits."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.signal import lfilter

from ptp_symbolic.numeric.identify.blocks import (
    block_labels,
    block_length,
    bootstrap_share,
    jackknife_covariance,
    leave_blocks_out,
    long_blocks,
    longest_block,
    without_outliers,
)
from ptp_symbolic.numeric.identify.constants import FEWEST_BLOCKS, MOST_BLOCKS
from tests.identify.curves import Floats


def remembering(pole: float, shape: tuple[int, int], seed: int) -> Floats:
    """AR(1) noise [series, n] of rms 1, stationary from the start."""
    white = np.random.default_rng(seed).standard_normal((shape[0], shape[1] + 300))
    return lfilter([np.sqrt(1.0 - pole**2)], [1.0, -pole], white)[:, 300:]


def optimal_length(pole: float, n: int) -> float:
    """Politis and White (2004) for AR(1): G = 2 a / (1 - a)^2 and D = 4/3 ((1 + a) / (1 - a))^2,
    both over the variance.
    """
    slope = 2.0 * pole / (1.0 - pole) ** 2
    spread = 4.0 / 3.0 * ((1.0 + pole) / (1.0 - pole)) ** 2
    return (2.0 * slope**2 / spread * n) ** (1.0 / 3.0)


@pytest.mark.parametrize("pole", [0.5, 0.8, 0.9])
@pytest.mark.parametrize("n", [4000, 16000])
def test_blocks_of_a_first_order_noise_are_as_long_as_theory_asks_for(pole: float, n: int) -> None:
    """The rule estimates G and D from n / b independent pieces, of which there are 50 at least: a
    length is good to some 25 %, the mean of eight to 10 %, and it is a few per cent short.
    """
    found = [block_length([s]) for s in remembering(pole, (8, n), 3)]
    assert np.mean(found) == pytest.approx(optimal_length(pole, n), rel=0.25)


def test_several_runs_ask_for_the_blocks_of_their_total_length() -> None:
    """Wherever their means lie: an offset of a run is no correlation."""
    runs = remembering(0.8, (4, 4000), 5)
    found = block_length(list(runs))
    assert found == pytest.approx(optimal_length(0.8, 16000), rel=0.4)
    offsets = np.array([[0.0], [5.0], [-9.0], [70.0]])
    assert block_length(list(runs + offsets)) == pytest.approx(found)


def test_the_slowest_signal_asks_for_the_blocks_of_all() -> None:
    """Two signals that remember alike, each the opposite of the other but for white noise: in their
    sum nothing is left of that.
    """
    slow, white = remembering(0.8, (2, 8000), 6), remembering(0.0, (2, 8000), 8)
    logs = [np.column_stack([s, 0.3 * w - s]) for s, w in zip(slow, white, strict=True)]
    assert longest_block(logs) == pytest.approx(optimal_length(0.8, 16000), rel=0.4)
    assert block_length([log.sum(axis=1) for log in logs]) < 6.0


def test_white_noise_needs_no_blocks() -> None:
    assert all(block_length([s]) < 6.0 for s in remembering(0.0, (20, 4000), 7))
    assert block_length([np.full(50, 3.0)]) == 1.0
    assert block_length([np.ones(2)]) == 1.0


RUN_SIZES = st.lists(st.integers(200, 3000), min_size=1, max_size=6)


@given(RUN_SIZES, st.floats(1.0, 1e4))
def test_blocks_of_a_run_are_equally_long_and_never_reach_into_the_next(
    sizes: list[int], length: float
) -> None:
    """A run of x blocks gets round(x): between two and four thirds of x from x = 1 on."""
    labels = block_labels(sizes, length)
    assert [len(own) for own in labels] == sizes
    together = np.concatenate(labels)
    counts = np.bincount(together)
    assert np.all(np.diff(together) >= 0) and np.all(counts > 0)
    for own in labels:
        blocks = counts[np.unique(own)]
        assert blocks.sum() == len(own) and np.ptp(blocks) <= 1
    assert 2 / 3 * FEWEST_BLOCKS <= len(counts) <= 4 / 3 * MOST_BLOCKS


def test_a_length_between_the_limits_is_kept() -> None:
    assert np.array_equal(np.bincount(block_labels([1200], 40.0)[0]), np.full(30, 40))
    assert np.array_equal(np.bincount(block_labels([1200], 1e9)[0]), np.full(12, 100))
    assert np.array_equal(np.bincount(block_labels([1200], 1.0)[0]), np.full(200, 6))


RNG = np.random.default_rng(11)
LABEL = np.arange(300) * 13 // 300
DESIGN = RNG.normal(size=(300, 4)) * [1.0, 1e-3, 1e4, 1.0]
MEASURED = DESIGN @ [2.0, 300.0, -1e-4, 0.5] + RNG.normal(size=300)


def test_leaving_a_block_out_is_fitting_without_it() -> None:
    """Thirteen refits; the ridge of 1e-10 is all that tells them from the normal equations."""
    found = np.linalg.lstsq(DESIGN, MEASURED)[0]
    left = leave_blocks_out(MEASURED - DESIGN @ found, -DESIGN, LABEL)
    for block in range(13):
        own = block == LABEL
        without = np.linalg.lstsq(DESIGN[~own], MEASURED[~own])[0]
        assert left.shifts[block] == pytest.approx(without - found, rel=1e-7)
        predicted = MEASURED[own] - DESIGN[own] @ without
        assert left.predicted[own] == pytest.approx(predicted, rel=1e-7, abs=1e-8)


def test_what_no_block_sees_does_not_move_and_nothing_free_predicts_nothing() -> None:
    silent = np.column_stack([DESIGN[:, 0], np.zeros(300)])
    found = np.linalg.lstsq(silent, MEASURED)[0]
    left = leave_blocks_out(MEASURED - silent @ found, -silent, LABEL)
    assert np.all(left.shifts[:, 1] == 0.0) and np.all(left.shifts[:, 0] != 0.0)
    nothing = leave_blocks_out(MEASURED, np.zeros((300, 0)), LABEL)
    assert np.array_equal(nothing.predicted, MEASURED) and nothing.shifts.shape == (13, 0)


def test_what_one_block_alone_sees_does_not_move_either() -> None:
    """As after a fit that ended early: the score of the block is not quite zero."""
    wave, once = np.sin(0.3 * np.arange(300)), np.where(LABEL == 7, DESIGN[:, 0], 0.0)
    columns = np.column_stack([wave, once])
    early = np.linalg.lstsq(columns, MEASURED)[0] + 1e-4
    left = leave_blocks_out(MEASURED - columns @ early, -columns, LABEL)
    assert abs(left.shifts[7, 1]) < 1e-3


def test_the_leverage_of_a_block_is_its_share_of_what_is_known() -> None:
    """Of one parameter the share of the squares; of two that blocks see apart the larger one."""
    one = DESIGN[:, :1]
    square = np.bincount(LABEL, weights=one[:, 0] ** 2)
    left = leave_blocks_out(MEASURED, one, LABEL)
    assert left.leverage == pytest.approx(square / square.sum(), rel=1e-6)
    once = np.where(LABEL == 7, DESIGN[:, 3], 0.0)
    apart = leave_blocks_out(MEASURED, np.column_stack([one[:, 0] * (LABEL != 7), once]), LABEL)
    assert apart.leverage[7] == pytest.approx(1.0, rel=1e-6)
    rest = np.delete(square, 7)
    assert np.delete(apart.leverage, 7) == pytest.approx(rest / rest.sum(), rel=1e-6)


def test_the_jackknife_of_a_mean_is_the_textbook_variance_of_a_mean() -> None:
    """Of two correlated means over 15 blocks of 20: the covariance of block means over 15."""
    rng = np.random.default_rng(12)
    blocks = rng.normal(size=(15, 20, 2)) @ [[1.0, 0.6], [0.0, 0.8]] + rng.normal(size=(15, 1, 2))
    means = blocks.mean(axis=1)
    residual = (blocks - means.mean(axis=0)).ravel()
    label = np.repeat(np.arange(15), 40)
    shifts = leave_blocks_out(residual, -np.tile(np.eye(2), (300, 1)), label).shifts
    assert jackknife_covariance(shifts) == pytest.approx(np.cov(means.T) / 15, rel=1e-7)


def test_a_share_is_that_of_the_sums_and_its_interval_that_of_a_ratio_of_means() -> None:
    """200 blocks: the delta method; 2000 resamples know an end to 0.06 standard errors."""
    rng = np.random.default_rng(14)
    whole = rng.uniform(1.0, 3.0, 200)
    gain = 0.3 * whole + rng.normal(0.0, 0.5, 200)
    share, low, high = bootstrap_share(gain, whole, 0.95)
    assert share == pytest.approx(gain.sum() / whole.sum(), rel=1e-14)
    error = np.std(gain - share * whole, ddof=1) / np.sqrt(200) / whole.mean()
    assert (low - share) / error == pytest.approx(-1.96, abs=0.2)
    assert (high - share) / error == pytest.approx(1.96, abs=0.2)
    _, low, high = bootstrap_share(gain, whole, 0.5)
    assert (high - low) / error == pytest.approx(2 * 0.674, abs=0.1)


def test_the_interval_of_a_share_holds_the_truth_as_often_as_it_promises() -> None:
    """200 sets of 40 blocks: 95 %, with a standard error of 1.5 %."""
    rng = np.random.default_rng(13)
    held = 0
    for _ in range(200):
        whole = 10.0 + rng.standard_normal(40)
        _, low, high = bootstrap_share(0.3 * whole + rng.standard_normal(40), whole, 0.95)
        held += low <= 0.3 <= high
    assert 0.90 < held / 200 < 0.99


def test_a_block_far_worse_than_usual_does_not_carry_a_fit_away() -> None:
    """A slope of 2 from eleven blocks with noise of 1, and one block that is off by 30: one step
    with Huber's weights takes most of the error back; without such a block nothing moves.
    """
    rng = np.random.default_rng(6)
    column, label = np.tile(np.linspace(-1.0, 1.0, 50), 12), np.repeat(np.arange(12), 50)
    error = float((column @ column) ** -0.5)
    for jump, least, most in ((0.0, 0.0, 4.0 * error), (30.0, 2.0, 0.4)):
        measured = 2.0 * column + rng.standard_normal(600)
        measured[label == 7] += jump * np.sign(column[label == 7])
        slope = float(column @ measured / (column @ column))
        _, _, step = without_outliers(measured - slope * column, -column[:, None], label, 1)
        assert slope - 2.0 >= least - 4.0 * error
        assert abs(slope + step[0] - 2.0) <= max(4.0 * error, most * abs(slope - 2.0))


def test_blocks_are_as_few_as_a_students_interval_allows() -> None:
    column = np.sin(0.3 * np.arange(1200))[:, None]
    label = long_blocks([600, 600], 5.0, column, 1)
    assert label.tolist() == np.repeat(np.arange(FEWEST_BLOCKS), 1200 // FEWEST_BLOCKS).tolist()
    both = long_blocks([600, 600], 5.0, np.repeat(column, 2, axis=0), 2)
    assert both.tolist() == np.repeat(label, 2).tolist()


def test_no_block_holds_nearly_all_that_is_known_of_a_direction() -> None:
    """The second column is seen during 80 samples that lie within a block of 100, or during 40 that
    lie within one of 50.
    """
    columns = np.column_stack([np.ones(1200), np.zeros(1200)])
    columns[505:585, 1] = 1.0
    label = long_blocks([1200], 5.0, columns, 1)
    assert label.max() + 1 == 2 * FEWEST_BLOCKS
    columns[545:585, 1] = 0.0
    assert long_blocks([1200], 5.0, columns, 1).max() + 1 == 4 * FEWEST_BLOCKS


def test_blocks_end_at_the_length_that_the_correlation_asks_for() -> None:
    columns = np.column_stack([np.ones(1200), np.zeros(1200)])
    columns[505, 1] = 1.0
    assert long_blocks([1200], 40.0, columns, 1).max() + 1 == 30


def test_columns_whose_squares_are_no_floats_are_left_out_like_others() -> None:
    """Scaling a column by 1e200 scales its shifts by 1e-200, and no prediction."""
    rng = np.random.default_rng(9)
    residual, jacobian, label = rng.normal(size=60), rng.normal(size=(60, 2)), np.arange(60) // 10
    scale = np.array([1e200, 1.0])
    with np.errstate(all="raise", under="ignore"):
        large = leave_blocks_out(residual, scale * jacobian, label)
    usual = leave_blocks_out(residual, jacobian, label)
    assert large.predicted == pytest.approx(usual.predicted, rel=1e-9)
    assert large.shifts * scale == pytest.approx(usual.shifts, rel=1e-9)
