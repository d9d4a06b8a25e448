"""Values that differ from log to log.

Blocks of time within logs tell how well one value suits them all. They do not tell how far the
machine of another day is from it, whose friction is that of another temperature: where logs differ
by more than blocks within each make likely, every log counts as one observation.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from ptp_symbolic.numeric.identify.blocks import (
    ELSEWHERE,
    block_labels,
    degrees_of_freedom,
    inverse_root,
    jackknife_covariance,
    leave_blocks_out,
)
from ptp_symbolic.numeric.identify.constants import FALSE_ALARM, FEWEST_BLOCKS

FloatArray = NDArray[np.float64]


def reach_between_logs(logs: Sequence[tuple[FloatArray, FloatArray]], signals: int) -> FloatArray:
    """Half widths [nf] of 95 % intervals of the mean over `logs`, by a jackknife over these (Bell
    and McCaffrey, 2002) with Student's distribution; from the residual [k * signals] of every log
    and its derivatives [k * signals, nf] by the parameters, at their common optimum.

    Zero where logs do not differ clearly (see `chance_of_scatter`), and for all parameters where
    there are fewer than three, or where one of them alone tells some combination of parameters:
    without it, the errors of all others would show.
    """
    nothing = np.zeros(logs[0][1].shape[1])
    if len(logs) < 3:
        return nothing
    label = np.repeat(np.arange(len(logs)), [len(r) for r, _ in logs])
    residual, columns = (np.concatenate(parts) for parts in zip(*logs, strict=True))
    left_out = leave_blocks_out(residual, columns, label)
    if np.max(left_out.leverage, initial=0.0) > 1.0 - ELSEWHERE:
        return nothing
    quantile = stats.t.ppf(0.975, degrees_of_freedom(left_out.shifts))
    reach = quantile * np.sqrt(np.diag(jackknife_covariance(left_out.shifts)))
    return np.where(chance_of_scatter(logs, signals) < FALSE_ALARM, reach, 0.0)


def chance_of_scatter(logs: Sequence[tuple[FloatArray, FloatArray]], signals: int) -> FloatArray:
    """The chance [nf] that logs differ so much, or more, in every parameter where they are alike.

    How much each sample moves a parameter is summed over every log, and, once each log has a value
    of its own, over blocks within: an analysis of variance (Fisher, 1925) with the degrees of
    freedom of blocks that are long enough to be independent.
    """
    root = inverse_root(np.vstack([c for _, c in logs]))
    inverse = root @ root.T
    lengths = [len(r) // signals for r, _ in logs]
    labels = block_labels(lengths, sum(lengths) / (2 * FEWEST_BLOCKS))
    between, within, blocks = np.zeros(len(inverse)), np.zeros(len(inverse)), 0
    for (residual, columns), label in zip(logs, labels, strict=True):
        influence = columns @ inverse
        moved = residual @ influence
        own = moved / np.maximum(np.sum(influence**2, axis=0), 1e-300)
        rest = influence * (residual[:, None] - influence * own)
        parts = np.repeat(label - label[0], signals)
        sums = np.array([np.bincount(parts, column) for column in rest.T])
        between, within = between + moved**2, within + np.sum(sums**2, axis=1)
        blocks += sums.shape[1]
    free = len(logs) - 1, blocks - len(logs)
    if free[1] < 1:
        return np.ones(len(inverse))
    ratio = between / free[0] / np.maximum(within, 1e-300) * free[1] / blocks * len(logs)
    return np.asarray(stats.f.sf(ratio, *free))
