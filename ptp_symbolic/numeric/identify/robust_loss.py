"""Robust losses: Huber's, and Cauchy's over blocks of a residual, which are windows that stand for
themselves, or blocks of a run.

A window that began on the wrong side of a rest says nothing about the parameters, nor does the
stretch of a run in which friction lets go a sample late: a mean square over all would pay for it
with parameters that are wrong everywhere (Black and Anandan, 1996).
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.identify.constants import FALSE_ALARM, TUNING
from ptp_symbolic.numeric.identify.evaluate import Evaluation

FloatArray = NDArray[np.float64]
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

    Infinite for a few blocks, and where the usual one leaves `below` standard deviations or more:
    far from the noise the blocks that leave most may be those that show what is missing.
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
