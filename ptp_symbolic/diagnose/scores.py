"""Scores at the declared optimum and comparisons on runs that were never fitted."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from ptp_symbolic.diagnose.floor import encoder_columns, residual_counts, trimmed
from ptp_symbolic.identify.evaluate import Evaluation
from ptp_symbolic.identify.fit import Fit
from ptp_symbolic.identify.intervals import BLOCK_SECONDS, project_out
from ptp_symbolic.identify.run import Run

FloatArray = NDArray[np.float64]
Pairs = Sequence[tuple[Run, Evaluation]]


@dataclass(frozen=True)
class Score:
    """Lagrange multiplier statistic of a candidate, its p-value, and the share of its effect that
    the declared parameters leave visible (0: absorbed).
    """

    statistic: float
    p_value: float
    share_left: float


def score(fit: Fit, extra: Sequence[FloatArray]) -> Score:
    """Score candidates from the derivatives `extra` (one [k, nc] per run) at the optimum `fit`.

    The covariance sums over blocks of time, as in the intervals.
    """
    regressors, nuisance, residuals, labels = [], [], [], []
    for number, ((run, e), columns) in enumerate(zip(fit.pairs(), extra, strict=True)):
        regressors.append(project_out(columns, e.by_start))
        nuisance.append(project_out(e.by_parameter, e.by_start))
        residuals.append(e.residual)
        block = np.floor((run.time - run.time[0]) / BLOCK_SECONDS).astype(int)
        labels.append(number * 100000 + np.repeat(block, run.measured.shape[1]))
    d, n, r = np.vstack(regressors), np.vstack(nuisance), np.concatenate(residuals)
    seen = np.linalg.norm(d, axis=0) > 0
    if not seen.any():
        return Score(0.0, 1.0, 0.0)
    d = d[:, seen] / np.linalg.norm(d[:, seen], axis=0)
    outside = _outside(d, n)
    left = float(np.max(np.linalg.norm(outside, axis=0)))
    order, label = np.unique(np.concatenate(labels), return_inverse=True)
    sums = np.zeros((len(order), outside.shape[1]))
    np.add.at(sums, label, outside * r[:, None])
    gradient, middle = sums.sum(axis=0), sums.T @ sums
    statistic = float(gradient @ np.linalg.pinv(middle, hermitian=True) @ gradient)
    return Score(statistic, float(stats.chi2.sf(statistic, outside.shape[1])), left)


def share_left(fit: Fit, residuals: Sequence[FloatArray]) -> float:
    """Share of a change to `residuals` [k * ny] per run that the free parameters cannot absorb."""
    changes, nuisance = [], []
    for (_, e), residual in zip(fit.pairs(), residuals, strict=True):
        changes.append(project_out((residual - e.residual)[:, None], e.by_start))
        nuisance.append(project_out(e.by_parameter, e.by_start))
    change = np.vstack(changes)
    size = float(np.linalg.norm(change))
    return float(np.linalg.norm(_outside(change, np.vstack(nuisance)))) / size if size else 0.0


def _outside(columns: FloatArray, nuisance: FloatArray) -> FloatArray:
    """The part of `columns` [k, nc] that the columns of `nuisance` [k, nn] do not span."""
    if not nuisance.shape[1]:
        return columns
    scaled = nuisance / np.maximum(np.linalg.norm(nuisance, axis=0), 1e-300)
    return columns - scaled @ np.linalg.lstsq(scaled, columns, rcond=1e-12)[0]


def mean_square(pairs: Pairs) -> float:
    """Mean square of all encoder residuals in counts^2; of many windows without the worst."""
    kept = trimmed(pairs)
    parts = [residual_counts(r, e, c) for r, e in kept for c in encoder_columns(r)]
    return float(np.mean(np.concatenate(parts) ** 2))


def block_mean_squares(pairs: Pairs) -> FloatArray:
    """Mean square in counts^2 of every block of `BLOCK_SECONDS`, over all encoder columns."""
    values = []
    for run, e in pairs:
        block = np.floor((run.time - run.time[0]) / BLOCK_SECONDS).astype(int)
        squares = sum(residual_counts(run, e, c) ** 2 for c in encoder_columns(run))
        total = np.bincount(block, weights=np.asarray(squares))
        size = np.bincount(block) * len(encoder_columns(run))
        values.append(total[size > 0] / size[size > 0])
    return np.concatenate(values)


def share_improved(before: Pairs, after: Pairs, floor: float) -> float:
    """Share of held-out blocks that improve, among those whose change can be seen (0.1 floor^2).

    What lies below the floor counts as on it: there nothing is left to improve, and the rounding of
    a joint at rest differs by chance.
    """
    excess = [np.maximum(block_mean_squares(pairs), floor**2) for pairs in (before, after)]
    change = excess[0] - excess[1]
    seen = np.abs(change) > 0.1 * floor**2
    return float(np.mean(change[seen] > 0)) if seen.any() else 0.0


def share_explained(before: Pairs, after: Pairs, floor: float) -> float:
    """Share of the excess over the floor that is gone; at most 1."""
    excess = mean_square(before) - floor**2
    if excess <= 0.0:
        return 0.0
    return float(min(1.0, 1.0 - (mean_square(after) - floor**2) / excess))
