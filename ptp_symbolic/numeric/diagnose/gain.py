"""By how much a larger model predicts better: leave-one-block-out losses.

Every block of the training runs is left out in turn and predicted by the others (see
`identify.blocks`); the losses of two models on the same blocks are compared in pairs.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from ptp_symbolic.numeric.diagnose.trial import Trial
from ptp_symbolic.numeric.identify.blocks import (
    ELSEWHERE,
    SINGULAR,
    block_labels,
    block_length,
    block_squares,
    bootstrap_share,
    degrees_of_freedom,
    jackknife_covariance,
    leave_blocks_out,
    longest_block,
    without_outliers,
)
from ptp_symbolic.numeric.identify.constants import (
    FALSE_ALARM,
    FEWEST_BLOCKS,
    MOST,
    NOTHING,
    TUNING,
)
from ptp_symbolic.numeric.identify.coordinates import to_search
from ptp_symbolic.numeric.identify.evidence import recorded
from ptp_symbolic.numeric.identify.fit import Fit
from ptp_symbolic.numeric.identify.intervals import chance_of, project_out
from ptp_symbolic.numeric.identify.noise import innovations, prediction_error_filter
from ptp_symbolic.numeric.identify.robust_loss import huber_loss, weighted_median
from ptp_symbolic.numeric.identify.run import Run, by_log

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]
IntArray = NDArray[np.int64]


@dataclass(frozen=True)
class Gain:
    """Share of the predictive loss of the smaller model that the larger one takes away, its 95 %
    interval, its t statistic with `degrees` of freedom over blocks, and the probability of ranks of
    the blocks like these, or better ones, where there is no gain (see `compared`).
    """

    share: float
    lower: float
    upper: float
    statistic: float
    degrees: int
    by_rank: float = 1.0

    @property
    def chance(self) -> float:
        """Probability of this gain, or a larger one, where there is none (one-sided)."""
        return float(stats.t.sf(self.statistic, max(self.degrees, 1)))

    @property
    def is_most(self) -> bool:
        """Whether surely, at 95 %, more of the loss is taken away than is left."""
        return self.lower > MOST

    def is_clear(self, tests: int) -> bool:
        """Whether the gain is above zero at 5 % over so many `tests` (Bonferroni)."""
        return self.chance < FALSE_ALARM / max(tests, 1)


@recorded(Gain)
def gain(larger: Trial, smaller: Trial) -> Gain:
    """The predictive gain of `larger` over `smaller`, both fitted to the same runs; none where a
    derivative of either is no number, for its motion multiplies any error without bounds.
    """
    evaluations = (*larger.fit.evaluations, *smaller.fit.evaluations)
    if not all(np.all(np.isfinite(e.by_parameter)) for e in evaluations):
        return Gain(0.0, -np.inf, np.inf, 0.0, 0)
    return _gain(larger.fit.runs, [_projected(t.fit) for t in (larger, smaller)])


@recorded(Gain)
def gain_in_innovations(larger: Trial, smaller: Trial) -> Gain:
    """The same where what `larger` leaves is coloured: in its innovations, each model one step of
    generalized least squares from its fit.
    """
    runs = larger.fit.runs
    signals = runs[0].measured.shape[1]
    parts = [_projected(t.fit) for t in (larger, smaller)]
    filters = [
        prediction_error_filter([r.reshape(-1, signals)[:, k] for r in parts[0][0]])
        for k in range(signals)
    ]
    white = [_in_innovations(*part, filters) for part in parts]
    squares = [_mean_square(residuals, signals) for residuals in (white[0][0], parts[0][0])]
    return _gain(runs, white, squares[0] / squares[1])


def _mean_square(residuals: Sequence[FloatArray], signals: int) -> FloatArray:
    """Mean square [signals] of the residuals [k * signals] of all runs, above zero."""
    every = np.concatenate(residuals).reshape(-1, signals)
    return np.maximum(np.mean(every**2, axis=0), 1e-300)


def _in_innovations(
    residuals: Sequence[FloatArray], jacobians: Sequence[FloatArray], filters: list[FloatArray]
) -> tuple[list[FloatArray], list[FloatArray]]:
    """Innovations of residuals and Jacobians, per run, at the optimum of their squares."""
    white = [innovations(r[:, None], filters)[:, 0] for r in residuals]
    slopes = [innovations(j, filters) for j in jacobians]
    columns = np.vstack(slopes)
    size = np.maximum(np.linalg.norm(columns, axis=0), 1e-300)
    step = -np.linalg.lstsq(columns / size, np.concatenate(white), rcond=SINGULAR)[0] / size
    return [r + j @ step for r, j in zip(white, slopes, strict=True)], slopes


def _gain(
    runs: Sequence[Run],
    residuals: Sequence[tuple[list[FloatArray], list[FloatArray]]],
    noise: FloatArray | float = 1.0,
) -> Gain:
    """The gain of the first of two models, given by residuals and Jacobians of the same runs.

    Signals count by what the first leaves in them, or by the mean square `noise` [signals] of
    theirs where it leaves less: the angle of an axis that rests is told to no better.
    """
    signals = runs[0].measured.shape[1]
    difference = [
        (b**2 - a**2).reshape(-1, signals).sum(axis=1)
        for a, b in zip(residuals[0][0], residuals[1][0], strict=True)
    ]
    series = by_log(runs, difference)
    labels = block_labels([len(s) for s in series], block_length(series))
    label = np.concatenate(labels)
    size = np.bincount(label)
    squares, told = zip(*(_predicted_squares(p, label, signals) for p in residuals), strict=True)
    scale = np.maximum(weighted_median(squares[0], size.astype(np.float64)), noise)
    judged = size * np.logical_and(*told)
    losses = [
        judged * huber_loss(s / scale, np.full(signals, TUNING**2)).sum(axis=1) for s in squares
    ]
    return compared(losses[0], losses[1])


def compared(larger: FloatArray, smaller: FloatArray) -> Gain:
    """The gain from the losses `larger` and `smaller` [b] of the same blocks by two models.

    By the t statistic a gain is not clear where most of it lies in few blocks, however many gain
    besides; by signed ranks it is (Wilcoxon, 1945).
    """
    taken = smaller - larger
    share, lower, upper = bootstrap_share(taken, smaller, 1.0 - FALSE_ALARM)
    b, whole = len(taken), max(float(smaller.sum()), 1e-300)

    def error_of(influence: FloatArray) -> float:
        return float(np.sqrt(b / (b - 1) * np.sum((influence / whole) ** 2))) if b > 1 else np.inf

    error = error_of(taken - taken.mean())
    if b < 2 * FEWEST_BLOCKS:  # percentiles of so few are too narrow
        reach = float(stats.t.ppf(1.0 - 0.5 * FALSE_ALARM, max(b - 1, 1)))
        reach *= error_of(taken - share * smaller)
        lower, upper = share - reach, share + reach
    differs = taken[taken != 0.0]
    by_rank = stats.wilcoxon(differs, alternative="greater").pvalue if differs.size else 1.0
    return Gain(share, lower, upper, share / max(error, NOTHING), b - 1, float(by_rank))


@recorded()
def p_value(trial: Trial, zero: Mapping[str, float]) -> float:
    """Probability that parameters this far from `zero`, or further, are found where they are zero.

    By their search coordinates, with the covariance of a jackknife over blocks of time under the
    model that has them (see `chance_of`, `degrees_of_freedom`). Blocks far worse than usual weigh
    less, and the coordinates are those of one step towards the fit with these weights (Bickel,
    1975).
    """
    fit = trial.fit
    own = [k for k, f in enumerate(fit.free) if f.name in zero]
    residual, jacobian = (np.concatenate(parts) for parts in _projected(fit))
    signals = fit.runs[0].measured.shape[1]
    logs = by_log(fit.runs, [e.residual.reshape(-1, signals) for e in fit.evaluations])
    labels = block_labels([len(log) for log in logs], longest_block(logs))
    label = np.concatenate(labels)
    residual, jacobian, step = without_outliers(residual, jacobian, label, signals)
    shifts = leave_blocks_out(residual, jacobian, np.repeat(label, signals)).shifts[:, own]
    away = to_search(fit.free, fit.values) - to_search(fit.free, {**fit.values, **zero})
    away = (away + step)[own]
    return chance_of(away, jackknife_covariance(shifts), degrees_of_freedom(shifts))


def _projected(fit: Fit) -> tuple[list[FloatArray], list[FloatArray]]:
    """Residuals [k * ny] and Jacobians [k * ny, nf] of every run, its unknown start taken out; in
    double precision, which products of columns that hardly differ need.
    """
    tables = [
        project_out(np.column_stack([e.residual, e.by_parameter]), e.by_start.astype(np.float64))
        for e in fit.evaluations
    ]
    return [table[:, 0] for table in tables], [table[:, 1:] for table in tables]


def _predicted_squares(
    parts: tuple[Sequence[FloatArray], Sequence[FloatArray]], label: IntArray, signals: int
) -> tuple[FloatArray, BoolArray]:
    """Mean square [b, signals] of the residuals of every block, predicted by the other blocks, and
    whether these can [b]: nothing predicts a block that alone holds what is known of a parameter.
    """
    residual, jacobian = np.concatenate(parts[0]), np.vstack(parts[1])
    prior = float(np.mean(residual**2))  # without the block no parameter moves by more than a unit
    left = leave_blocks_out(residual, jacobian, np.repeat(label, signals), prior)
    return block_squares(left.predicted, label, signals), left.leverage <= 1.0 - ELSEWHERE
