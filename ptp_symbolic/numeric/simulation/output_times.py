"""Output times of a simulation."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ptp_symbolic.errors import InputError

FloatArray = NDArray[np.float64]

OUTPUT_STEP = 1e-3
MOST_SAMPLES = 5_000_000


def output_times(times: float | ArrayLike, every: float = OUTPUT_STEP) -> FloatArray:
    """Output times [k] in s: from 0 to a duration in s and `every` so many s between, or as given;
    a tuple of two is the span (start, end), with `every` so many s between.

    Raises InputError for a duration or an interval that is not positive, for less than two times or
    times that are not finite and increasing, and for five million or more within a duration.
    """
    t = np.array(times, dtype=np.float64)
    if t.ndim == 0:
        if not 0.0 < t < np.inf:
            raise InputError(f"Duration {float(t):g} s; give a positive number of seconds.")
        t = _regular_times(float(t), every)
    elif isinstance(times, tuple) and t.shape == (2,) and 0.0 < t[1] - t[0] < np.inf:
        t = float(t[0]) + _regular_times(float(t[1] - t[0]), every)
    if t.ndim != 1 or len(t) < 2 or not np.all(np.isfinite(t)) or np.any(np.diff(t) <= 0):
        raise InputError("Output times must be two or more finite, increasing numbers of seconds.")
    return t


def _regular_times(duration: float, every: float) -> FloatArray:
    if not 0.0 < every < np.inf:
        raise InputError(f"Output every {every:g} s; give a positive number of seconds.")
    count = duration / every
    if count >= MOST_SAMPLES:
        raise InputError(
            f"{duration:g} s with an output every {every:g} s make {count:.3g} samples, at most"
            f" {MOST_SAMPLES} are allowed; shorten the duration, or give output times further"
            f" apart (`every` {1.01 * duration / MOST_SAMPLES:.3g})."
        )
    if abs(count - round(count)) < 1e-3 or count < 1.0:
        return np.linspace(0.0, duration, max(2, round(count) + 1))
    return np.append(every * np.arange(int(count) + 1), duration)
