"""Statistics of residuals that are correlated in time: blocks long enough to be independent.

Leave-one-block-out without a refit: near the optimum the residual is linear in the parameters, and
the normal equations without a block give its prediction and the shift of the parameters at once
(PRESS: Allen, 1974; the jackknife over clusters: Bell and McCaffrey, 2002).

Robust losses: Huber's, and Cauchy's over blocks, which are whole windows or parts of a run. A
window that began on the wrong side of a rest holds no information about the parameters, nor does
the stretch of a run in which friction breaks away a sample late: a mean square over all would
compensate it by parameters that are wrong everywhere (Black and Anandan, 1996).
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import linalg

from ptp_symbolic.numeric.identify.constants import (
    FALSE_ALARM,
    FEWEST_BLOCKS,
    MATERIAL,
    MOST,
    MOST_BLOCKS,
    NOTHING,
    RESAMPLES,
    SEED,
    TUNING,
)
from ptp_symbolic.numeric.identify.evaluate import Evaluation

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

MANY_RUNS = np.reciprocal(FALSE_ALARM)  # windows: one leaves a band of FALSE_ALARM by chance
Block = NDArray[np.int64]  # [k]: to which block each row of a residual belongs, from 0 on


def blocks_of(time: FloatArray, signals: int, length: float) -> Block:
    """The block [n * signals] of every row of a run sampled at `time` [n] (s): each `length` long
    (s), the last one at most half as long again.
    """
    elapsed = time - time[0]
    last = max(int(np.round(elapsed[-1] / length)), 1) - 1
    return np.repeat(np.minimum((elapsed / length).astype(np.int64), last), signals)


def huber_loss(square: FloatArray, squared_tuning: FloatArray) -> FloatArray:
    """Huber's loss of the squares `square`, linear in their root beyond the tuning constant,
    which comes squared; shapes broadcast.
    """
    linear = 2.0 * np.sqrt(squared_tuning * square) - squared_tuning
    return np.where(square <= squared_tuning, square, linear)


def weighted_median(values: FloatArray, weight: FloatArray) -> FloatArray:
    """Medians [v] of the columns of `values` [k, v], whose rows count by `weight` [k]."""
    order = np.argsort(values, axis=0, kind="stable")
    below = np.cumsum(weight[order], axis=0) - 0.5 * weight[order]
    at = 0.5 * weight.sum()
    ordered = np.take_along_axis(values, order, axis=0)
    columns = zip(below.T, ordered.T, strict=True)
    return np.array([np.interp(at, b, v) for b, v in columns])


def trimmed_mean(values: FloatArray, weight: FloatArray, share: float) -> FloatArray:
    """Means [v] of the columns of `values` [k, v], whose rows count by `weight` [k], without the
    largest that hold a `share` of all weight (Tukey and McLaughlin, 1963, at one end).
    """
    order = np.argsort(values, axis=0, kind="stable")
    below = np.cumsum(weight[order], axis=0)
    kept = np.clip((1.0 - share) * weight.sum() - (below - weight[order]), 0.0, weight[order])
    return np.asarray(np.sum(kept * np.take_along_axis(values, order, axis=0), axis=0)) / kept.sum(
        axis=0
    )


def robust_tuning(pairs: Sequence[tuple[Evaluation, Block | None]], below: float) -> float:
    """Tuning constant of the loss: the root mean square at which a block counts half.

    Infinite for a few blocks, and where the median one has a residual of `below` standard
    deviations or more: far from the noise the blocks with the largest residuals may be those that
    show what is missing.
    """
    if any(e.failed for e, _ in pairs):
        return np.inf
    parts = [_mean_squares(e, block) for e, block in pairs]
    squares = np.concatenate([s for s, _ in parts])
    if len(squares) < MANY_RUNS:
        return np.inf
    sizes = np.concatenate([n for _, n in parts])
    middle = float(np.sqrt(weighted_median(squares[:, None], sizes)[0]))
    return TUNING * middle if middle < below else np.inf


def loss(e: Evaluation, block: Block | None, tuning: float) -> float:
    """Square well below the tuning constant, its logarithm beyond, summed over blocks."""
    if np.isinf(tuning):
        return float(e.residual @ e.residual)
    squares, sizes = _mean_squares(e, block)
    return float(tuning**2 * np.sum(sizes * np.log1p(squares / tuning**2)))


def shares(e: Evaluation, block: Block | None, tuning: float) -> FloatArray:
    """Weight [k] of every row in the normal equations."""
    squares, _ = _mean_squares(e, block)
    each = 1.0 / (1.0 + squares / tuning**2)
    return np.repeat(each, e.residual.size) if block is None else each[block]


def _mean_squares(e: Evaluation, block: Block | None) -> tuple[FloatArray, FloatArray]:
    """Mean square and number of rows of every block."""
    if block is None:
        return np.array([float(np.mean(e.residual**2))]), np.array([float(e.residual.size)])
    sizes = np.bincount(block).astype(float)
    return np.bincount(block, e.residual**2) / sizes, sizes


ELSEWHERE = MOST * MATERIAL  # share that blocks other than one must show
SINGULAR = np.sqrt(np.finfo(float).eps)  # singular value of equal directions, over the largest


def block_length(series: Sequence[FloatArray]) -> float:
    """Samples in a block for the mean of stationary `series` [n] of one kind (Politis and White,
    2004).

    The automatic rule for the circular block bootstrap, with the corrected constant of Patton,
    Politis and White (2009): (2 G^2 / D)^(1/3) n^(1/3), lags up to where correlations are noise.
    """
    covariance = autocovariance(series)
    spectrum = covariance[0] + 2.0 * float(np.sum(covariance[1:]))
    if spectrum <= 0.0:
        return 1.0
    sizes = [len(s) for s in series if len(s) > 3]
    slope = 2.0 * float(np.sum(np.arange(len(covariance)) * covariance))
    length = (2.0 * slope**2 / (4.0 / 3.0 * spectrum**2)) ** (1.0 / 3.0) * sum(sizes) ** (1.0 / 3.0)
    return float(np.clip(length, 1.0, max(sizes)))


def autocovariance(series: Sequence[FloatArray]) -> FloatArray:
    """Covariance of samples of stationary `series` [n] of one kind, so many samples apart, tapered
    to zero beyond the lag up to which it is more than noise (Politis and Romano, 1995).
    """
    centred = [s - s.mean() for s in series if len(s) > 3]
    n = sum(len(s) for s in centred)
    if not n or not any(np.any(s) for s in centred):
        return np.zeros(1)
    longest = max(len(s) for s in centred)
    most = min(longest - 1, int(np.ceil(np.sqrt(n))) + max(5, int(np.log10(n))) + 1)
    covariance = np.array(
        [
            sum(float(s[k:] @ s[: len(s) - k]) for s in centred if len(s) > k) / n
            for k in range(most + 1)
        ]
    )
    bandwidth = max(1, 2 * _last_correlated(covariance / covariance[0], n))
    lags = np.arange(min(bandwidth, most) + 1)
    return np.asarray(covariance[lags] * np.clip(2.0 * (1.0 - lags / bandwidth), 0.0, 1.0))


def longest_block(logs: Sequence[FloatArray]) -> float:
    """Samples in a block for residuals `logs` [n, signals]: of the signal with the longest (see
    `block_length`).
    """
    return max(block_length(list(signal)) for signal in zip(*(log.T for log in logs), strict=True))


def _last_correlated(correlation: FloatArray, n: int) -> int:
    """The lag after which several correlations in a row are no larger than those of noise."""
    noise = 2.0 * np.sqrt(np.log10(n) / n)
    quiet = max(5, int(np.sqrt(np.log10(n))))
    for lag in range(1, len(correlation) - quiet):
        if np.all(np.abs(correlation[lag : lag + quiet]) < noise):
            return max(lag - 1, 1)
    return len(correlation) - 1


def block_labels(sizes: Sequence[int], length: float) -> list[IntArray]:
    """Block number [n] of every sample, per run of `sizes` samples; blocks of about `length`
    samples, all of one run equally long, about FEWEST_BLOCKS to MOST_BLOCKS in all.
    """
    longest, shortest = sum(sizes) / FEWEST_BLOCKS, sum(sizes) / MOST_BLOCKS
    length = max(min(max(length, shortest), longest), 1.0)
    labels, first = [], 0
    for size in sizes:
        count = max(1, round(size / length))
        labels.append(first + np.arange(size) * count // max(size, 1))
        first += count
    return labels


def long_blocks(
    sizes: Sequence[int], length: float, jacobian: FloatArray, signals: int
) -> IntArray:
    """Number of the block of every row of `jacobian` [n * signals, nf], runs of `sizes` samples cut
    into blocks that are as long as can be.

    With few blocks Student's distribution is right whatever the correlation within them, and wider
    by little (Ibragimov and Mueller, 2010). FEWEST_BLOCKS, or twice as many as often as needed
    until all but any one of them still see every direction, but none shorter than `length`.
    """
    root = inverse_root(jacobian)
    longest = sum(sizes) / FEWEST_BLOCKS
    while True:
        label = np.repeat(np.concatenate(block_labels(sizes, longest)), signals)
        parts = [jacobian[label == block] @ root for block in range(int(label.max()) + 1)]
        share = max((float(np.linalg.norm(part, 2)) ** 2 for part in parts if part.size), default=0)
        if share <= 1.0 - ELSEWHERE or longest <= max(length, 1.0):
            return label
        longest = max(length, 0.5 * longest)


def _lengths(jacobian: FloatArray) -> FloatArray:
    """Norms of the columns [n, nf], also of those whose squares are no floats: where a simulation
    multiplies small changes its derivatives may be.
    """
    largest = np.abs(jacobian).max(axis=0, initial=0.0)
    unit = np.ldexp(1.0, np.frexp(np.where(largest > 0.0, largest, 1.0))[1] - 1)
    return np.asarray(unit * np.linalg.norm(jacobian / unit, axis=0))


def inverse_root(jacobian: FloatArray) -> FloatArray:
    """Directions [nf, seen] in which the columns of `jacobian` are orthonormal."""
    size = _lengths(jacobian)
    unit = np.where(size > 0.0, size, 1.0)
    _, spread, directions = np.linalg.svd(jacobian / unit, full_matrices=False)
    seen = spread**2 > NOTHING * max(float(spread[0]) ** 2 if len(spread) else 0.0, 1e-300)
    return np.asarray(directions[seen].T / spread[seen] / unit[:, None])


@dataclass(frozen=True, eq=False)
class LeftOut:
    """Leave-one-block-out: residuals [n] of each block predicted by the others, the shifts [b, nf]
    of the parameters without it, and its leverage [b]: the largest share of what is known of any
    combination of parameters that it alone holds.
    """

    predicted: FloatArray
    shifts: FloatArray
    leverage: FloatArray


def leave_blocks_out(
    residual: FloatArray,
    jacobian: FloatArray,
    label: IntArray,
    prior: float = 0.0,
    ridge: float = 1e-10,
) -> LeftOut:
    """Leave each block out in turn of a least squares fit with `residual` [n] and `jacobian`
    [n, nf] (by the parameters) at its optimum; `label` [n] numbers the blocks. Directions that no
    other block sees do not move; `prior` is the precision of a prior of every parameter at its
    optimum.
    """
    blocks = int(label.max()) + 1 if len(label) else 0
    nf = jacobian.shape[1]
    predicted, shifts, leverage = residual.copy(), np.zeros((blocks, nf)), np.zeros(blocks)
    if nf == 0:
        return LeftOut(predicted, shifts, leverage)
    size = _lengths(jacobian)
    size = np.where(size > 0.0, size, 1.0)
    scaled = jacobian / size
    information = scaled.T @ scaled + np.diag((np.sqrt(prior) / size) ** 2)
    known = information + ridge * np.eye(nf)
    for block in range(blocks):
        rows = np.flatnonzero(label == block)
        own = scaled[rows]
        rest = information - own.T @ own
        leverage[block] = linalg.eigh(own.T @ own, known, eigvals_only=True)[-1]
        score = own.T @ residual[rows]
        shift = np.linalg.lstsq(rest + ridge * np.eye(nf), score, rcond=1e2 * ridge)[0]
        predicted[rows] = residual[rows] + own @ shift
        shifts[block] = shift / size
    return LeftOut(predicted, shifts, leverage)


def block_squares(residual: FloatArray, label: IntArray, signals: int) -> FloatArray:
    """Mean square [b, signals] of every block of `residual` [n], which holds `signals` values for
    every entry of `label` [n / signals].
    """
    size = np.bincount(label)
    table = residual.reshape(-1, signals) ** 2
    return np.column_stack([np.bincount(label, weights=c) / size for c in table.T])


def without_outliers(
    residual: FloatArray, jacobian: FloatArray, label: IntArray, signals: int
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """A fit in which blocks far worse than usual weigh less (Huber, 1964): residual [n] and
    jacobian [n, nf] with these weights, and the one Gauss-Newton step [nf] to their optimum
    (Bickel, 1975).

    `residual` is [n / signals, signals] in one column, `label` [n / signals] its blocks; every
    signal has its own weight in a block.
    """
    squares = block_squares(residual, label, signals)
    usual = weighted_median(squares, np.bincount(label).astype(np.float64))
    weight = huber_root(squares, usual)[label].ravel()
    residual, jacobian = weight * residual, weight[:, None] * jacobian
    step = np.asarray(-np.linalg.lstsq(jacobian, residual, rcond=SINGULAR)[0], dtype=np.float64)
    return residual + jacobian @ step, jacobian, step


def huber_root(squares: FloatArray, usual: FloatArray | float) -> FloatArray:
    """Root of Huber's weight of blocks with mean `squares`, of which some are `usual`: by it their
    rows are multiplied.
    """
    return np.minimum(1.0, (TUNING**2 * usual / np.maximum(squares, 1e-300)) ** 0.25)


def jackknife_covariance(shifts: FloatArray) -> FloatArray:
    """Covariance [nf, nf] of parameters from their `shifts` [b, nf] without each of b blocks."""
    b = len(shifts)
    centred = shifts - shifts.mean(axis=0)
    return (b - 1.0) / max(b, 1) * centred.T @ centred


def degrees_of_freedom(shifts: FloatArray, *, centred: bool = True) -> FloatArray:
    """Degrees of freedom [nf] of variances from the `shifts` [b, nf] of b blocks: b - 1 where all
    blocks shift a parameter alike, 1 where one alone does (moments of the squares, after
    Satterthwaite, 1946).

    Of m independent normal shifts, the ratio of 3 (sum s^2)^2 to sum s^4 is m + 2, that of their
    expectations. Those of a jackknife sum to zero (`centred`): it is m (m + 1) / (m - 1), and m - 1
    are free.
    """
    square = shifts**2
    fourth = np.maximum(np.sum(square**2, axis=0), 1e-300)
    ratio = 3.0 * np.sum(square, axis=0) ** 2 / fourth
    equal = ratio - 2.0
    if centred:
        root = np.sqrt(np.maximum((ratio - 1.0) ** 2 - 4.0 * ratio, 0.0))
        equal = 0.5 * (ratio - 1.0 + root) - 1.0
    return np.asarray(np.clip(equal, 1.0, max(len(shifts) - 1, 1)))


def bootstrap_share(
    gain: FloatArray, whole: FloatArray, confidence: float
) -> tuple[float, float, float]:
    """The share sum(gain) / sum(whole) over blocks [b], and its interval of that `confidence` from
    a bootstrap over blocks (percentiles: Efron, 1979).
    """
    rng = np.random.default_rng(SEED)
    b = len(gain)
    drawn = rng.multinomial(b, np.full(b, 1.0 / b), size=RESAMPLES)
    below = np.maximum(drawn @ whole, 1e-300)
    shares = (drawn @ gain) / below
    tail = 0.5 * (1.0 - confidence)
    low, high = np.quantile(shares, [tail, 1.0 - tail])
    return float(gain.sum() / max(whole.sum(), 1e-300)), float(low), float(high)
