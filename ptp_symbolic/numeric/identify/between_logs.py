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
IntArray = NDArray[np.int64]


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
    of its own, over blocks within: an analysis of variance (Fisher, 1925). A sum of white noise has
    a variance in proportion to the information in its log, or block, less its part in the value
    that was taken out. Blocks are long enough to be independent; unequal ones have the degrees of
    freedom of so many equal ones (Satterthwaite, 1946).
    """
    root = inverse_root(np.vstack([c for _, c in logs]))
    inverse = root @ root.T
    lengths = [len(r) // signals for r, _ in logs]
    labels = block_labels(lengths, sum(lengths) / (2 * FEWEST_BLOCKS))
    between, sums, expected = np.zeros(len(inverse)), [], []
    for (residual, columns), label in zip(logs, labels, strict=True):
        influence = columns @ inverse
        moved, known = residual @ influence, np.maximum(np.sum(influence**2, axis=0), 1e-300)
        rest = influence * (residual[:, None] - influence * moved / known)
        parts = np.repeat(label - label[0], signals)
        of_block = _sums(influence**2, parts)
        between += moved**2 / known
        sums.append(_sums(rest, parts))
        expected.append(of_block * (1.0 - of_block / known))
    variances = np.maximum(np.concatenate(expected), 0.0)
    whole = np.maximum(np.sum(variances, axis=0), 1e-300)
    equal = whole**2 / np.maximum(np.sum(variances**2, axis=0), 1e-300)
    free = len(logs) - 1, equal - len(logs)
    variance = np.sum(np.concatenate(sums) ** 2, axis=0) / whole
    ratio = between / free[0] / np.maximum(variance, 1e-300)
    return np.where(free[1] < 1.0, 1.0, stats.f.sf(ratio, free[0], np.maximum(free[1], 1.0)))


def _sums(columns: FloatArray, parts: IntArray) -> FloatArray:
    """Sums [parts, nf] of the rows of `columns` [k, nf] in each of the `parts` [k]."""
    return np.array([np.bincount(parts, column) for column in columns.T]).T
