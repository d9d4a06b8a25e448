"""Averages of signals and of their second derivatives under a smooth test function.

Multiplied by a test function that is zero with its slopes at both ends and integrated, an equation
of motion needs no second derivative of the measured angle: integration by parts moves it to the
test function (modulating functions: Shinbrot, 1957; weak form: Messenger and Bortz, 2021). The test
function is (1 - s^2)^4 over a window that is centred on the sample.
"""

import numpy as np
from numba import njit
from numpy.typing import NDArray
from scipy.special import beta

from ptp_symbolic.numeric.identify.constants import LARGEST_GAP, LEAST_SAMPLES

FloatArray = NDArray[np.float64]


@njit(cache=True, nogil=True, error_model="numpy")
def _windows(time, half_width):
    """First and one past the last sample of the window of every sample; empty where it is cut off
    by an end of the run or interrupted by a gap.
    """
    n = len(time)
    first, end = np.zeros(n, dtype=np.int64), np.zeros(n, dtype=np.int64)
    low, high = 0, 0
    slack = 1e-9 * half_width
    for k in range(n):
        while time[low] < time[k] - half_width - slack:
            low += 1
        while high < n and time[high] <= time[k] + half_width + slack:
            high += 1
        whole = (
            time[k] - half_width >= time[0] - slack and time[k] + half_width <= time[n - 1] + slack
        )
        if not whole or high - low < LEAST_SAMPLES:
            continue
        longest = max(time[low] - time[k], time[k] - time[high - 1]) + half_width
        for j in range(low, high - 1):
            longest = max(longest, time[j + 1] - time[j])
        if longest <= LARGEST_GAP * half_width:
            first[k], end[k] = low, high
    return first, end


@njit(cache=True, nogil=True, error_model="numpy")
def weak_average(time, values, half_width, derivative, chosen):
    """Average [c, v] of `values` [k, v] at `time` [k] in s, or of their first or second derivative
    (`derivative` 1 or 2, per s or s^2), under the test function of `half_width` s centred on the
    samples `chosen` [c]; nan where its window is not whole. Weights are normalised so that a
    constant has the average 1 and a parabola its exact derivatives, however few the samples.
    """
    columns = values.shape[1]
    first, end = _windows(time, half_width)
    result = np.full((len(chosen), columns), np.nan)
    for row, k in enumerate(chosen):
        low, high = first[k], end[k]
        if low == high:
            continue
        whole = 0.0
        total = np.zeros(columns)
        for j in range(low, high):
            before = time[j - 1] if j > low else time[k] - half_width
            after = time[j + 1] if j < high - 1 else time[k] + half_width
            width = 0.5 * (after - before)
            s = (time[j] - time[k]) / half_width
            base = max(1.0 - s * s, 0.0)
            weight = base * base * base * base
            share = weight
            if derivative == 1:
                weight = 8.0 * s * base * base * base
                share = weight * s * half_width
            elif derivative == 2:
                weight = base * base * (48.0 * s * s - 8.0 * base)
                share = 0.5 * weight * s * s * half_width * half_width
            whole += width * share
            for c in range(columns):
                origin = values[k, c] if derivative > 0 else 0.0
                total[c] += width * weight * (values[j, c] - origin)
        result[row] = total / whole
    return result


@njit(cache=True, nogil=True, error_model="numpy")
def local_motion(time, values, half_width):
    """Value, rate and acceleration [k, 3, c] of `values` [k, c], per s and s^2, from a parabola
    through the samples within `half_width` s of each, at least five of them (local regression: Fan
    and Gijbels, 1996).
    """
    n, columns = values.shape
    result = np.zeros((n, 3, columns))
    low, high = 0, 0
    for k in range(n):
        while time[low] < time[k] - half_width:
            low += 1
        while high < n and time[high] <= time[k] + half_width:
            high += 1
        a, b = low, high
        while b - a < 5:
            a, b = max(a - 1, 0), min(b + 1, n)
        moments, right = np.zeros(5), np.zeros((3, columns))
        for j in range(a, b):
            s = (time[j] - time[k]) / half_width
            power = 1.0
            for order in range(5):
                moments[order] += power
                if order < 3:
                    for c in range(columns):
                        right[order, c] += power * values[j, c]
                power *= s
        matrix = np.empty((3, 3))
        for row in range(3):
            for column in range(3):
                matrix[row, column] = moments[row + column]
        found = np.linalg.solve(matrix, right)
        for c in range(columns):
            result[k, 0, c] = found[0, c]
            result[k, 1, c] = found[1, c] / half_width
            result[k, 2, c] = 2.0 * found[2, c] / (half_width * half_width)
    return result


def curvature_noise(period: float, half_width: float) -> float:
    """Standard deviation in 1/s^2 of the weak average of the second derivative of white noise of
    deviation 1, sampled every `period` s.

    Continuous limit of the sums above, with w = (1 - s^2)^4: the integral of w is B(1/2, 5), that
    of w''^2 is 64 (49 B(5/2, 5) - 14 B(3/2, 5) + B(1/2, 5)).
    """
    square = 64.0 * (49.0 * beta(2.5, 5.0) - 14.0 * beta(1.5, 5.0) + beta(0.5, 5.0))
    return float(np.sqrt(period / half_width * square) / beta(0.5, 5.0) / half_width**2)
