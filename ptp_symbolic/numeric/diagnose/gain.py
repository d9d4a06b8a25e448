"""By how much a larger model predicts better: leave-one-block-out losses, and validation runs.

Every block of the training runs is left out in turn and predicted by the others (see
`identify.blocks`); the losses of two models on the same blocks are compared in pairs. The
validation runs are compared with their own noise, with values in the joint confidence region.
"""

from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from ptp_symbolic.numeric.diagnose.fitted_model import (
    SHARP,
    FittedModel,
    SearchProblem,
    tolerance_for,
)
from ptp_symbolic.numeric.diagnose.noise_floor import NoiseFloor
from ptp_symbolic.numeric.identify.blocks import (
    ELSEWHERE,
    MANY_RUNS,
    SINGULAR,
    block_labels,
    block_length,
    block_squares,
    bootstrap_share,
    degrees_of_freedom,
    huber_loss,
    huber_root,
    jackknife_covariance,
    leave_blocks_out,
    longest_block,
    trimmed_mean,
    weighted_median,
    without_outliers,
)
from ptp_symbolic.numeric.identify.constants import (
    ABOVE_NOISE,
    CYCLES,
    FALSE_ALARM,
    FEWEST_BLOCKS,
    MATERIAL,
    MOST,
    NEARBY,
    NOTHING,
    REPEATS,
    ROUGH,
    SEED,
    TUNING,
    UNALIKE,
)
from ptp_symbolic.numeric.identify.coordinates import to_search
from ptp_symbolic.numeric.identify.evaluate import mean_squares
from ptp_symbolic.numeric.identify.evidence import recorded
from ptp_symbolic.numeric.identify.fit import Fit, fit_parameters
from ptp_symbolic.numeric.identify.intervals import (
    chance_of,
    closest_in_ball,
    joint_region,
    project_out,
    reaches,
    with_finite_differences,
)
from ptp_symbolic.numeric.identify.least_squares import BIGGEST, POLISH, Effort
from ptp_symbolic.numeric.identify.noise import innovations, prediction_error_filter
from ptp_symbolic.numeric.identify.run import Run, by_log, by_source, sizes

BoolArray = NDArray[np.bool_]
FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


@dataclass(frozen=True)
class Gain:
    """Share by which the larger model reduces the predictive loss of the smaller one, its 95 %
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
        """Whether the lower 95 % limit of the share is above one half."""
        return self.lower > MOST

    def is_significant(self, tests: int) -> bool:
        """Whether the gain is above zero at 5 % over so many `tests` (Bonferroni)."""
        return self.chance < FALSE_ALARM / max(tests, 1)

    def is_better(self, material: float, tests: int = 1) -> bool:
        """Whether it is a `material` share, and significant over so many `tests`."""
        return self.share >= material and self.is_significant(tests)

    def smallest_chance(self, by_values: float) -> float:
        """The smallest of the chances of three tests, times three: of such values of parameters
        (see `p_value`), of such better predictions of blocks, and of so many of them.
        """
        return min(1.0, 3.0 * min(by_values, self.chance, self.by_rank))

    @property
    def in_words(self) -> str:
        """The share with its lower limit."""
        limit = f"{100.0 * self.lower:.0f} %" if np.isfinite(self.lower) else "not known"
        return (
            f"reduces the sum of squares by {100.0 * self.share:.0f} % (lower 95 % limit {limit})"
        )


@recorded(Gain)
def gain(larger: FittedModel, smaller: FittedModel) -> Gain:
    """The predictive gain of `larger` over `smaller`, both fitted to the same runs; none where a
    derivative of either is no number, for its motion multiplies any error without bounds.
    """
    evaluations = (*larger.fit.evaluations, *smaller.fit.evaluations)
    if not all(np.all(np.isfinite(e.by_parameter)) for e in evaluations):
        return Gain(0.0, -np.inf, np.inf, 0.0, 0)
    return _gain(larger.fit.runs, [_projected(t.fit) for t in (larger, smaller)])


@recorded(Gain)
def gain_in_innovations(larger: FittedModel, smaller: FittedModel) -> Gain:
    """The same where the residual of `larger` is autocorrelated: in its innovations, each model one
    step of generalized least squares from its fit.
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

    Signals are scaled by the median square of the first, or by their mean square `noise` [signals]
    where that is larger: the angle of an axis that rests is known to no better.
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

    By the t statistic a gain is not significant where most of it lies in few blocks, however many
    gain besides; by signed ranks it is (Wilcoxon, 1945).
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
def p_value(trial: FittedModel, zero: Mapping[str, float]) -> float:
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


def is_validated(held_out: Gain, quiet: bool, unusual: bool, material: float) -> bool:
    """Whether what the training runs named holds on the validation runs: their sum of squares falls
    by a `material` share. Where their residual exceeds the noise (not `quiet`), a wrong effect may
    imitate a missing one, so that it has to fall by half, as on training runs.

    Where all may be noise, any effect follows a part of it, for seconds, in blocks left out as
    well; the validation runs have noise of their own. With FEWEST_BLOCKS or more they have to gain
    significantly, and always where the residual of training runs is `unusual`: then the noise is
    large by chance, or an effect is missing. How many blocks gain is enough for that, for one that
    gains far more than the others hides by how much they do.
    """
    if not quiet:
        return held_out.share >= MOST
    is_clear = held_out.smallest_chance(1.0) < FALSE_ALARM
    return held_out.share >= material and (is_clear or not must_gain_clearly(held_out, unusual))


def must_gain_clearly(held_out: Gain, unusual: bool) -> bool:
    """Whether the gain on validation runs that show noise alone has to be significant (see
    `is_validated`).
    """
    return unusual or held_out.degrees + 1 >= FEWEST_BLOCKS


@recorded()
def left_by_best_values(
    after: Fit, estimated: Fit, level: FloatArray, executor: Executor | None = None
) -> FloatArray:
    """Mean square residuals [runs, ny] of the validation runs `after`, in units of the noise, with
    other values: those in the joint confidence region of the `estimated` ones that suit all runs
    together best, to first order. Starts are free. Signals count by their noise `level` [ny], runs
    that are far worse than usual count less (Huber).

    The residual of a complete model at its true values is noise, and the region holds those. That
    of an incomplete one is rarely of the form of a change of its values.
    """
    squares = mean_squares(after.evaluations, after.runs)
    moved = replace(after, free=estimated.free)
    if estimated.free and not after.failed:
        moved = with_finite_differences(moved, executor, reaches(estimated))
    if moved.failed or not all(np.all(np.isfinite(e.by_parameter)) for e in moved.evaluations):
        return squares
    region = joint_region(estimated) if estimated.free else np.zeros((0, 0))
    size = sizes(after.runs)
    scaled = []  # residuals and what the region carries there, over the noise of their signals
    for run, e in moved.pairs():
        noise = np.tile(level, len(run.time))[:, None]
        residual = project_out(e.residual[:, None], e.by_start) / noise
        scaled.append((residual[:, 0], project_out(e.by_parameter, e.by_start) @ region / noise))
    left = [residual for residual, _ in scaled]
    for _ in range(2 * CYCLES):
        square = np.array([np.mean(r**2) for r in left])
        usual = max(float(weighted_median(square[:, None], size)[0]), 1.0)
        weighted = list(zip(huber_root(square, usual), scaled, strict=True))
        columns = np.vstack([root * propagated for root, (_, propagated) in weighted])
        target = -np.concatenate([root * residual for root, (residual, _) in weighted])
        shift = closest_in_ball(columns, target)
        left = [residual + propagated @ shift for residual, propagated in scaled]
    tables = [r.reshape(run.measured.shape) for r, run in zip(left, after.runs, strict=True)]
    return np.array([np.mean((table * level) ** 2, axis=0) for table in tables])


def usual_residual(left: FloatArray, size: FloatArray) -> FloatArray:
    """Root mean square residual [ny] of usual runs of `size` [runs] samples, by the mean squares
    `left` [runs, ny] of each: the median run, for one that sticks at another sample than it did is
    off by counts; of many windows all but the worst, a MATERIAL share of the samples.
    """
    is_many = len(left) >= MANY_RUNS
    square = trimmed_mean(left, size, MATERIAL) if is_many else weighted_median(left, size)
    return np.asarray(np.sqrt(square))


def is_noise_alone(left: FloatArray, size: FloatArray, floor: NoiseFloor, trained: Fit) -> bool:
    """Whether validation runs of `size` [runs] samples show no more than noise, by their mean
    square residuals `left` [runs, ny] (see `left_by_best_values`): by the usual one, and no run may
    be further off than what is near the noise floor. Of many windows the residuals may not be
    larger than those of the training windows. Windows below the usual noise count as equal in that:
    those at rest, rounded to a count that they stay at, have smaller residuals, and show no lack in
    those that move.
    """
    largest, many = ABOVE_NOISE * floor.most, len(left) >= MANY_RUNS
    if not np.all(usual_residual(left, size) <= largest):
        return False
    if not (many or np.all(left <= (NEARBY * largest) ** 2)):
        return False
    own = mean_squares(trained.evaluations, trained.runs)
    if not many or len(own) < MANY_RUNS:
        return True
    quiet = (ABOVE_NOISE * floor.level) ** 2
    pairs = zip(np.maximum(left, quiet).T, np.maximum(own, quiet).T, strict=True)
    return all(chance_of_larger(ours, theirs) > UNALIKE for ours, theirs in pairs)


def chance_of_larger(ours: FloatArray, theirs: FloatArray) -> float:
    """The chance of ranks as high as those of `ours` [m] among `theirs` [n] if all are alike (Mann
    and Whitney, 1947), by permutation: where most are the same, their sum is far from normal. Of
    the draws, eight go as far where the chance is UNALIKE.
    """
    ranks = stats.rankdata(np.concatenate([ours, theirs]))
    rng, count = np.random.default_rng(SEED), round(REPEATS / UNALIKE)
    sums = [rng.permutation(ranks)[: len(ours)].sum() for _ in range(count)]
    return (1.0 + np.count_nonzero(sums >= ranks[: len(ours)].sum())) / (1.0 + count)


def held_out_fit(problem: SearchProblem, trial: FittedModel) -> Fit:
    """The validation runs by the model of a trial, nothing but their start unknowns fitted."""
    return simulated_freely(problem, problem.validate, trial.values)


def simulated_freely(
    problem: SearchProblem, runs: Sequence[Run], values: Mapping[str, float]
) -> Fit:
    """Runs simulated with `values` of all parameters, nothing but their start unknowns fitted."""
    effort = Effort(POLISH, MATERIAL * ROUGH, tolerance_for(problem, SHARP))
    return fit_parameters(problem.model, runs, (), dict(values), None, effort, problem.executor)


def held_out_gain(after: Fit, before: Fit) -> Gain:
    """The share by which the mean square error of validation runs or windows falls (Huber's loss:
    those far worse than usual count linearly). Windows of one log count together as long as what
    they gain is correlated (see `block_length`).
    """
    size = sizes(after.runs)
    squares = [mean_squares(fit.evaluations, fit.runs) for fit in (after, before)]
    usual = np.min([weighted_median(s, size) for s in squares], axis=0)
    tuning = TUNING**2 * np.maximum(usual, 1.0)
    losses = [size * huber_loss(np.minimum(s, BIGGEST), tuning).sum(axis=1) for s in squares]
    blocks = _independent(after.runs, losses[1] - losses[0])
    return compared(*[np.asarray(np.bincount(blocks, loss), dtype=np.float64) for loss in losses])


def _independent(runs: Sequence[Run], taken: FloatArray) -> NDArray[np.int64]:
    """The block [runs] of every run or window: those of one log together as long as what is `taken`
    [runs] from them is correlated, however few blocks that leaves.
    """
    groups = by_source(runs)
    mean = taken / sizes(runs)
    length = block_length([mean[group] for group in groups])
    label, first = np.zeros(len(runs), dtype=np.int64), 0
    for group in groups:
        count = max(1, round(len(group) / length))
        label[group] = first + np.arange(len(group)) * count // len(group)
        first += count
    return label
