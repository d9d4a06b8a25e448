"""The noise floor: what the encoder's rounding and noise leave of a perfect model."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.identify.evaluate import Evaluation
from ptp_symbolic.identify.run import Run

FloatArray = NDArray[np.float64]

ROUNDING_COUNTS = 1.0 / np.sqrt(12.0)
KEPT_SHARE = 0.99
MANY_WINDOWS, KEPT_WINDOWS = 20, 0.9


def encoder_columns(run: Run) -> list[int]:
    """Measured columns that are encoder signals; all columns where there is no encoder."""
    found = [c for c in range(run.measured.shape[1]) if np.isfinite(run.counts[c])]
    return found or list(range(run.measured.shape[1]))


def trimmed(pairs: Sequence[tuple[Run, Evaluation]]) -> list[tuple[Run, Evaluation]]:
    """Of many windows those nine tenths that fit best; few whole runs all.

    One window in twenty may settle in the wrong branch of sticking and sliding.
    """
    if len(pairs) < MANY_WINDOWS:
        return list(pairs)
    size = [float(np.mean(e.residual**2)) for _, e in pairs]
    order = np.argsort(size, kind="stable")[: int(KEPT_WINDOWS * len(pairs))]
    return [pairs[i] for i in sorted(order)]


def residual_counts(run: Run, evaluation: Evaluation, column: int) -> FloatArray:
    """Residual of one column in counts (in units of its noise where it has no counts)."""
    residual = evaluation.residual.reshape(run.measured.shape)[:, column]
    count = run.counts[column]
    return residual / run.weight[column] / count if np.isfinite(count) else residual


def floor_counts(pairs: Sequence[tuple[Run, Evaluation]]) -> float:
    """Floor in counts: rounding, and noise as seen in third differences of the residual.

    Third differences remove everything slow; of white noise they keep the variance times 20.
    """
    extra = []
    for run, evaluation in pairs:
        for column in encoder_columns(run):
            third = np.diff(residual_counts(run, evaluation, column), 3) ** 2
            kept = np.sort(third)[: max(1, int(KEPT_SHARE * third.size))]
            extra.append((float(kept.sum()) / 20.0, kept.size))
    total = sum(part for part, _ in extra) / max(sum(size for _, size in extra), 1)
    noise = max(0.0, total - ROUNDING_COUNTS**2)
    return float(np.hypot(ROUNDING_COUNTS, np.sqrt(noise)))
