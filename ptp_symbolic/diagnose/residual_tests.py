"""Tests of what a model leaves over on held-out runs, for every measured signal."""

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from ptp_symbolic.diagnose.floor import residual_counts
from ptp_symbolic.diagnose.trial import Trial

FloatArray = NDArray[np.float64]

LAGS = 25
WHITE = (
    "neighbouring residuals should not resemble each other; rounding and noise of the inputs make"
    " them do so a little where nothing is missing, so that this test alone proves nothing"
)
INDEPENDENT = "what is left over should not follow {name}; where it does, the model lacks something"


def residual_tests(trial: Trial, inputs: tuple[str, ...]) -> list[dict[str, Any]]:
    """Per measured signal: whiteness of its residual, and independence of each of the `inputs`.

    The statistic is the largest correlation over `LAGS` lags, averaged over runs; of independent
    residuals it stays below the threshold in 99 of 100 cases.
    """
    assert trial.validate is not None
    pairs = [(r, e) for r, e in trial.validate.pairs() if len(r.time) > 4 * LAGS]
    size = sum(len(run.time) for run, _ in pairs)
    rows: list[dict[str, Any]] = []
    for column, signal in enumerate(trial.validate.runs[0].signals if pairs else ()):
        left = [residual_counts(run, e, column) for run, e in pairs]
        white = np.mean([_correlation(r, r) for r in left], axis=0)[1:]
        rows.append(_row("whiteness", signal, white, size, WHITE))
        for k, name in enumerate(inputs):
            crossed = np.mean(
                [_correlation(r, run.held_inputs[:, k])
                 for r, (run, _) in zip(left, pairs, strict=True)], axis=0,
            )  # fmt: skip
            meaning = INDEPENDENT.format(name=name)
            rows.append(_row(f"independence of {name}", signal, crossed, size, meaning))
    return rows


def _row(name: str, signal: str, values: FloatArray, size: int, meaning: str) -> dict[str, Any]:
    largest = float(np.max(np.abs(values)))
    threshold = float(stats.norm.ppf(1.0 - 0.005 / values.size) / np.sqrt(size))
    return {
        "name": name, "signal": signal, "statistic": largest, "threshold": threshold,
        "passed": largest <= threshold, "meaning": meaning,
    }  # fmt: skip


def _correlation(a: FloatArray, b: FloatArray) -> FloatArray:
    a, b = a - a.mean(), b - b.mean()
    scale = max(float(np.linalg.norm(a) * np.linalg.norm(b)), 1e-300)
    return np.array([float(a[k:] @ b[: b.size - k]) / scale for k in range(LAGS + 1)])
