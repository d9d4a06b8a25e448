"""A signal that holds its value from sample to sample: its averages between given times."""

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]


def held_averages(time: FloatArray, held: FloatArray, edges: FloatArray) -> FloatArray:
    """Averages [m] between neighbouring `edges` [m + 1] in s of the signal that takes the value
    `held` [n] at `time` [n] in s; before the first sample it is that.
    """
    integral = np.concatenate([[0.0], np.cumsum(held[:-1] * np.diff(time))])
    at = np.interp(edges, time, integral)
    at += np.where(edges < time[0], (edges - time[0]) * held[0], 0.0)
    at += np.where(edges > time[-1], (edges - time[-1]) * held[-1], 0.0)
    return np.asarray(np.diff(at) / np.diff(edges))
