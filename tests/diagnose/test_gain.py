"""How much better a larger model predicts: closed cases, refits by brute force, and false finds."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from scipy import special, stats
from scipy.signal import lfilter

from ptp_symbolic.numeric.diagnose.fitted_model import TUNING, FittedModel
from ptp_symbolic.numeric.diagnose.gain import (
    Gain,
    compared,
    gain,
    gain_in_innovations,
    held_out_gain,
)
from ptp_symbolic.numeric.identify.coordinates import free_parameter
from tests.identify.curves import Floats
from tests.identify.straight import finished


def trial(residuals: Sequence[Floats], columns: Sequence[Floats] | None = None) -> FittedModel:
    """A fit that leaves `residuals` per run, `columns` [k, nf] fitted."""
    free = () if columns is None else [free_parameter("b", 1.0, -9.0, 9.0)] * columns[0].shape[1]
    slopes = None if columns is None else [-c for c in columns]
    return FittedModel((), finished(residuals, slopes, None, free))


def test_against_a_steady_loss_the_statistic_is_students() -> None:
    """The share is a mean then: SciPy's t test of one sample, and its interval."""
    taken = np.random.default_rng(61).normal(0.1, 0.5, 200)
    found = compared(2.0 - taken, np.full(200, 2.0))
    student = stats.ttest_1samp(taken, 0.0)
    assert found.share == pytest.approx(taken.mean() / 2.0, rel=1e-12)
    assert found.statistic == pytest.approx(student.statistic, rel=1e-12)
    assert found.degrees == student.df == 199
    interval = student.confidence_interval(0.95)
    assert found.lower == pytest.approx(interval.low / 2.0, abs=0.3 * taken.std() / np.sqrt(200))
    assert found.upper == pytest.approx(interval.high / 2.0, abs=0.3 * taken.std() / np.sqrt(200))


def test_a_third_taken_from_every_block_is_a_third_beyond_doubt() -> None:
    smaller = np.random.default_rng(61).uniform(1.0, 9.0, 30)
    found = compared(smaller * 2.0 / 3.0, smaller)
    assert (found.share, found.lower, found.upper) == pytest.approx((1 / 3, 1 / 3, 1 / 3))
    assert found.is_significant(10**6)
    assert not compared(smaller, smaller * 2.0 / 3.0).is_significant(1)
    assert not compared(smaller, smaller).is_significant(1)


def test_few_blocks_have_a_students_interval_and_one_has_none() -> None:
    """A bootstrap of five misses the truth in 21 %, for 5 %."""
    taken = np.array([0.2, 0.3, 0.5, 0.6, 0.9])
    found = compared(1.0 - taken, np.ones(5))
    interval = stats.ttest_1samp(taken, 0.0).confidence_interval(0.95)
    assert (found.lower, found.upper) == pytest.approx((interval.low, interval.high))
    whole = np.array([1.0, 9.0, 3.0, 200.0, 0.1])
    steady = compared(0.6 * whole, whole)  # the same share of every block, however they differ
    assert (steady.lower, steady.upper) == pytest.approx((0.4, 0.4))
    alone = compared(np.array([0.6]), np.array([1.0]))
    assert alone.share == pytest.approx(0.4)
    assert (alone.lower, alone.upper) == (-np.inf, np.inf)
    assert not alone.is_significant(1)


@pytest.mark.parametrize(("half_width", "is_most"), [(0.1, True), (1.5, False)])
def test_most_is_taken_away_where_blocks_agree(half_width: float, is_most: bool) -> None:
    """Sixty percent on average of 30 blocks: 0.6 -+ 1.96 half_width / sqrt(3 * 30) by the central
    limit, above a half or not.
    """
    taken = 0.6 + half_width * np.linspace(-1.0, 1.0, 30)
    found = compared(1.0 - taken, np.ones(30))
    assert found.share == pytest.approx(0.6)
    assert (0.6 - 1.96 * half_width / np.sqrt(90.0) > 0.5) == is_most
    assert found.is_most is is_most


def test_a_gain_that_lies_in_few_blocks_is_clear_by_ranks_if_many_gain_besides() -> None:
    """Of twenty blocks that all gain, all signs are as likely otherwise: one in 2^20. Where ten
    gain and ten lose, of the same sizes, it is one in two.
    """
    smaller = 1.0 + 0.1 * np.arange(1, 21)
    smaller[-2:] = 1000.0, 2000.0
    found = compared(np.ones(20), smaller)
    assert found.chance > 0.05
    assert found.by_rank == pytest.approx(0.5**20)
    sizes = np.repeat(np.arange(1.0, 11.0), 2)
    mixed = compared(np.full(20, 20.0), 20.0 + sizes * np.tile([1.0, -1.0], 10))
    assert mixed.by_rank == pytest.approx(0.5, abs=0.02)


@pytest.mark.parametrize("tests", [1, 40, 1000])
@pytest.mark.parametrize("degrees", [1, 11, 199])
def test_a_clear_gain_passes_a_one_sided_t_test_shared_among_all_tests(
    tests: int, degrees: int
) -> None:
    threshold = stats.t.isf(0.05 / tests, degrees)
    above, below = (Gain(0.1, 0.0, 0.2, f * threshold, degrees) for f in (1.0001, 0.9999))
    assert above.is_significant(tests) and not below.is_significant(tests)
    assert not Gain(-0.1, -0.2, 0.0, -2.0 * threshold, degrees).is_significant(tests)


def gains(losses: Floats) -> list[Gain]:
    """The gain of the second over the first of two equally good models; losses [draws, 2, b]."""
    return [compared(second, first) for first, second in losses]


def test_equally_good_models_are_hardly_ever_told_apart() -> None:
    """400 draws of 12 blocks: one in 800 is expected where forty sets are tried; three or more come
    with a chance of 1.5 %. Without Bonferroni twenty are, with a standard error of 4.4.
    """
    rng = np.random.default_rng(62)
    found = gains(1.0 + 0.1 * rng.standard_normal((400, 2, 12)))
    assert sum(g.is_significant(40) for g in found) <= 2
    assert 8 <= sum(g.is_significant(1) for g in found) <= 33


def test_a_false_gain_is_as_rare_where_blocks_differ_widely() -> None:
    """Losses of three degrees of freedom each: 15 of 300 draws, with a standard error of 3.8."""
    rng = np.random.default_rng(63)
    found = gains(rng.chisquare(3.0, (300, 2, 12)))
    assert sum(g.is_significant(1) for g in found) <= 26


def huber(square: Floats) -> Floats:
    """SciPy's loss, as a square."""
    return 2.0 * special.huber(TUNING, np.sqrt(square))


@pytest.mark.parametrize("off", [2.0, 10.0, 1000.0])
def test_a_run_far_off_counts_linearly(off: float) -> None:
    """One run of twenty, `off` times as far off in the smaller model as all others."""
    usual = [np.where(np.arange(60) % 2, 1.0, -1.0)] * 20
    strange = [off * usual[0], *usual[1:]]
    found = gain(trial(usual), trial(strange))
    loss = huber(np.array(off**2))
    assert found.share == pytest.approx((loss - 1.0) / (loss + 19.0), rel=1e-12)


def test_a_gain_is_that_of_runs_predicted_by_the_others() -> None:
    """200 equal runs are a block each: 200 refits of a slope, with a wave that helps or without."""
    rng = np.random.default_rng(64)
    table = rng.standard_normal((200, 6, 2))
    measured = table @ [1.0, 0.4] + rng.standard_normal((200, 6))
    trials, losses = [], []
    scale = None
    for columns in (table, table[..., :1]):
        count = columns.shape[2]
        found = np.linalg.lstsq(columns.reshape(-1, count), measured.ravel())[0]
        trials.append(trial(list(measured - columns @ found), list(columns)))
        square = np.empty(200)
        for run in range(200):
            others = np.arange(200) != run
            refit = np.linalg.lstsq(columns[others].reshape(-1, count), measured[others].ravel())[0]
            square[run] = np.mean((measured[run] - columns[run] @ refit) ** 2)
        scale = np.mean(square) if scale is None else scale
        losses.append(huber(square / scale))
    found = gain(*trials)
    assert found.degrees == 199
    # The prior of one search unit weighs as much as one of 2400 samples.
    assert found.share == pytest.approx(1.0 - losses[0].sum() / losses[1].sum(), rel=1e-4)
    assert 0.05 < found.lower < found.share < found.upper < 0.25


def test_a_run_that_alone_tells_a_parameter_is_not_judged() -> None:
    """Its breakaway is predicted by nothing: the gain is that of a slope in the 39 other runs."""
    rng = np.random.default_rng(66)
    slope, once = rng.standard_normal((2, 40, 60))
    once *= 1e-3
    once[7, 30] = 30.0
    noise = rng.standard_normal((40, 60))
    measured = 0.4 * slope + 5.0 * once + noise
    columns = np.stack([slope, once], axis=2)
    found = np.linalg.lstsq(columns.reshape(-1, 2), measured.ravel())[0]
    larger = trial(list(measured - columns @ found), list(columns))
    judged = gain(larger, trial(list(measured)))
    others = np.arange(40) != 7
    shares = gain(
        trial(list((measured - columns @ found)[others]), list(slope[others, :, None])),
        trial(list(measured[others])),
    )
    assert judged.share == pytest.approx(shares.share, rel=0.02)
    assert 0.08 < judged.lower < judged.share < 0.2


def test_a_parameter_that_fits_noise_alone_gains_nothing() -> None:
    """In sample it always does; on blocks left out a column loses as much as it took."""
    rng, clear = np.random.default_rng(65), []
    for _ in range(12):
        columns, noise = rng.standard_normal((20, 60, 3)), rng.standard_normal((20, 60))
        found = np.linalg.lstsq(columns.reshape(-1, 3), noise.ravel())[0]
        larger = trial(list(noise - columns @ found), list(columns))
        clear.append(gain(larger, trial(list(noise))))
        assert larger.fit.cost < np.sum(noise**2)
    assert np.mean([g.share for g in clear]) < 0.0
    assert sum(g.is_significant(1) for g in clear) <= 2


def test_a_signal_of_a_large_unit_does_not_outweigh_another() -> None:
    """Half of the loss of one of two signals is a quarter of all, however large its residuals."""
    sign = np.where(np.arange(60) % 2, 1.0, -1.0)
    for size in (1.0, 1e4):
        better = [np.column_stack([size * sign, sign])] * 20
        worse = [np.column_stack([np.sqrt(2.0) * size * sign, sign])] * 20
        assert gain(trial(better), trial(worse)).share == pytest.approx(1.0 / 3.0, rel=1e-9)


def test_a_validation_run_that_sticks_does_not_hide_what_the_others_gain() -> None:
    """Four runs of 50 samples fall from rms 10 to 1, the fourth stays at 100. Beyond 2.5 they count
    linearly: 43.75 and 493.75 by hand, so that 128.25 of 625 are taken away; of squares, 3 %.
    """
    wave = np.tile([1.0, -1.0], 25)
    before = finished([10.0 * wave] * 3 + [100.0 * wave])
    after = finished([wave] * 3 + [100.0 * wave])
    assert held_out_gain(after, before).share == pytest.approx(128.25 / 625.0, rel=1e-12)


def test_a_signal_below_its_noise_counts_no_more_than_noise() -> None:
    """One axis gains 36 % of its mean square, the other, nearly at rest, nine tenths of next to
    nothing: 0.36 + 0.0008 of 1 + 0.0009 by hand. By its own scale it would have counted for 8 of 9.
    """
    sign = np.where(np.arange(60) % 2, 1.0, -1.0)
    better = [np.column_stack([0.8 * sign, 0.01 * sign])] * 20
    worse = [np.column_stack([sign, 0.03 * sign])] * 20
    found = gain(trial(better), trial(worse))
    assert found.share == pytest.approx(0.3608 / 1.0009, rel=1e-9)


def test_innovations_count_by_those_of_noise_of_their_colour() -> None:
    """Half of an autoregression of variance one goes, and nothing of white noise: a third of what
    counted twice in one signal and once in the other, though the innovations of the first have a
    variance of 1 - pole^2.
    """
    rng, pole = np.random.default_rng(62), 0.9
    size = np.sqrt(1.0 - pole**2)
    slow = [lfilter([size], [1.0, -pole], rng.standard_normal(900))[300:] for _ in range(20)]
    better = [np.column_stack([r, rng.standard_normal(len(r))]) for r in slow]
    worse = [table * np.array([np.sqrt(2.0), 1.0]) for table in better]
    unrelated = [rng.standard_normal((table.size, 1)) for table in better]
    found = gain_in_innovations(trial(better, unrelated), trial(worse, unrelated))
    assert found.share == pytest.approx(1.0 / 3.0, abs=0.03)


@pytest.mark.long
@pytest.mark.parametrize("pole", [0.0, 0.7])
def test_windows_of_one_log_that_gain_alike_count_together(pole: float) -> None:
    """Without a gain, 5 % seem clear; of windows that count each for itself 20 % at 0.7."""
    rng, clear = np.random.default_rng(63), 0
    for _ in range(150):
        drawn = lfilter([1.0], [1.0, -pole], rng.standard_normal((4, 60)))[:, 10:]
        taken = 0.1 * drawn / np.sqrt(np.mean(drawn**2))
        after, before = (
            finished([np.full(4, np.sqrt(square)) for square in (1.0 + change).ravel()])
            for change in (-taken, taken)
        )
        runs = tuple(replace(r, source=f"log {k // 50}") for k, r in enumerate(after.runs))
        found = held_out_gain(replace(after, runs=runs), replace(before, runs=runs))
        clear += found.is_significant(1)
    assert clear / 150 < 0.11
