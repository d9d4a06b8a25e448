"""Averages of signals and of their second derivatives under a smooth test function.

Multiplied by a test function that is zero with its slopes at both ends and integrated, an equation
of motion needs no second derivative of the measured angle: integration by parts moves it to the
test function (modulating functions: Shinbrot, 1957; weak form: Messenger and Bortz, 2021). The test
function is (1 - s^2)^4 over a window that is centred on the sample.
"""

from typing import Any, NamedTuple

import numpy as np
from numba import njit, types
from numpy.typing import NDArray
from scipy.special import beta

from ptp_symbolic.numeric.identify.constants import LARGEST_GAP, LEAST_SAMPLES
from ptp_symbolic.numeric.simulation.kernels.records import CUBE, INTEGERS, MATRIX, VECTOR

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


class Windows(NamedTuple):
    """The weights of the samples in the windows of chosen samples [c], window after window.

    A window holds the samples from `first` to before `end`, both [c], equal where it is cut off by
    an end of the run or interrupted by a gap; their weights begin at `begin` [c] in `weight` [w],
    and their average is divided by `whole` [c]. Values count from that of the sample `middle` [c]
    where `relative`, as in derivatives.
    """

    first: Any
    end: Any
    begin: Any
    weight: Any
    whole: Any
    middle: Any
    relative: bool


@njit(cache=True, nogil=True, error_model="numpy")
def _is_whole(time, half_width, k, low, high):
    """Whether the window of sample k, from `low` to before `high`, is not cut off by an end of the
    run nor interrupted by a gap.
    """
    slack = 1e-9 * half_width
    if time[k] - half_width < time[0] - slack or time[k] + half_width > time[-1] + slack:
        return False
    if high - low < LEAST_SAMPLES:
        return False
    longest = max(time[low] - time[k], time[k] - time[high - 1]) + half_width
    for j in range(low, high - 1):
        longest = max(longest, time[j + 1] - time[j])
    return longest <= LARGEST_GAP * half_width


def windows(time: FloatArray, half_width: float, derivative: int, chosen: IntArray) -> Windows:
    """The windows of `half_width` s around the samples `chosen` [c] of `time` [k] in s, for the
    average of a signal, or of its first or second `derivative` (1 or 2). Weights are normalised so
    that a constant has the average 1 and a parabola its exact derivatives, however few the samples.
    """
    slack = 1e-9 * half_width
    first = np.searchsorted(time, time[chosen] - half_width - slack)
    end = np.searchsorted(time, time[chosen] + half_width + slack, side="right")
    _empty_broken(time, half_width, chosen, first, end)
    begin = np.cumsum(end - first) - (end - first)
    weights, wholes = np.zeros(int(np.sum(end - first))), np.zeros(len(chosen))
    _weigh(time, half_width, derivative, chosen, first, end, begin, weights, wholes)
    return Windows(first, end, begin, weights, wholes, chosen, derivative > 0)


@njit(cache=True, nogil=True, error_model="numpy")
def _empty_broken(time, half_width, chosen, first, end):
    """Let the windows of `chosen` [c] that are not whole end where they begin."""
    for row in range(len(chosen)):
        if not _is_whole(time, half_width, chosen[row], first[row], end[row]):
            end[row] = first[row]


@njit(cache=True, nogil=True, error_model="numpy")
def _place(time, half_width, k, j, low, high):
    """Where sample j stands in the window of sample k, in half widths from its middle, and how wide
    it is in s.
    """
    before = time[j - 1] if j > low else time[k] - half_width
    after = time[j + 1] if j < high - 1 else time[k] + half_width
    return (time[j] - time[k]) / half_width, 0.5 * (after - before)


@njit(cache=True, nogil=True, error_model="numpy")
def _weigh(time, half_width, derivative, chosen, first, end, begin, weights, wholes):
    """Fill the weights [w] of all windows, and what their averages are divided by [c].

    A second derivative of a straight line, and a first one of a square about the middle, are zero
    by symmetry where samples are even; elsewhere the test function makes up for what is not.
    """
    other = 3 - derivative
    for row in range(len(chosen)):
        k, low, high = chosen[row], first[row], end[row]
        wrong, right = 0.0, 0.0
        for j in range(low, high):
            s, width = _place(time, half_width, k, j, low, high)
            base = max(1.0 - s * s, 0.0)
            weight = base * base * base * base
            if derivative > 0:
                right += width * weight * s ** (2 * other)
            if derivative == 1:
                weight = 8.0 * s * base * base * base
            elif derivative == 2:
                weight = base * base * (48.0 * s * s - 8.0 * base)
            if derivative > 0:
                wrong += width * weight * s**other
            weights[begin[row] + j - low] = width * weight
        for j in range(low, high):
            s, width = _place(time, half_width, k, j, low, high)
            at = begin[row] + j - low
            share = 1.0
            if derivative > 0:
                weights[at] -= wrong / right * width * max(1.0 - s * s, 0.0) ** 4 * s**other
                share = s * half_width if derivative == 1 else 0.5 * (s * half_width) ** 2
            wholes[row] += weights[at] * share


@njit(cache=True, nogil=True, error_model="numpy")
def averages(found, values):
    """Averages [c, v] of `values` [k, v], or of their derivatives per s or s^2, in the windows
    `found`; nan where a window is not whole.
    """
    columns = values.shape[1]
    result = np.zeros((len(found.middle), columns))
    for row in range(len(found.middle)):
        low, high, k = found.first[row], found.end[row], found.middle[row]
        for j in range(low, high):
            weight = found.weight[found.begin[row] + j - low]
            for c in range(columns):
                origin = values[k, c] if found.relative else 0.0
                result[row, c] += weight * (values[j, c] - origin)
        for c in range(columns):
            result[row, c] = result[row, c] / found.whole[row] if low < high else np.nan
    return result


def weak_average(
    time: FloatArray, values: FloatArray, half_width: float, derivative: int, chosen: IntArray
) -> FloatArray:
    """Average [c, v] of `values` [k, v] at `time` [k] in s, or of their first or second derivative
    (`derivative` 1 or 2, per s or s^2), under the test function of `half_width` s centred on the
    samples `chosen` [c]; nan where its window is not whole.
    """
    found: FloatArray = averages(windows(time, half_width, derivative, chosen), values)
    return found


def local_motion(time: FloatArray, values: FloatArray, half_width: float) -> FloatArray:
    """Value, rate and acceleration [k, 3, c] of `values` [k, c], per s and s^2, from a parabola
    through the samples within `half_width` s of each, at least five of them (local regression: Fan
    and Gijbels, 1996).
    """
    moments = np.zeros((len(time), 5))
    right = np.zeros((len(time), 3, values.shape[1]))
    _fill_moments(time, values, half_width, moments, right)
    found = np.linalg.solve(moments[:, np.add.outer(np.arange(3), np.arange(3))], right)
    units = np.array([1.0, 1.0 / half_width, 2.0 / half_width**2])
    return np.asarray(found * units[:, None])


@njit(cache=True, nogil=True, error_model="numpy")
def _fill_moments(time, values, half_width, moments, right):
    """Sums over the samples around each of the powers 0 to 4 of their distance over `half_width`
    [k, 5], and of those to 2 times their `values` [k, 3, c].
    """
    n, columns = values.shape
    low, high = 0, 0
    for k in range(n):
        while time[low] < time[k] - half_width:
            low += 1
        while high < n and time[high] <= time[k] + half_width:
            high += 1
        a, b = low, high
        while b - a < 5:
            a, b = max(a - 1, 0), min(b + 1, n)
        for j in range(a, b):
            s = (time[j] - time[k]) / half_width
            power = 1.0
            for order in range(5):
                moments[k, order] += power
                if order < 3:
                    for c in range(columns):
                        right[k, order, c] += power * values[j, c]
                power *= s


def curvature_noise(period: float, half_width: float) -> float:
    """Standard deviation in 1/s^2 of the weak average of the second derivative of white noise of
    deviation 1, sampled every `period` s.

    Continuous limit of the sums above, with w = (1 - s^2)^4: the integral of w is B(1/2, 5), that
    of w''^2 is 64 (49 B(5/2, 5) - 14 B(3/2, 5) + B(1/2, 5)).
    """
    square = 64.0 * (49.0 * beta(2.5, 5.0) - 14.0 * beta(1.5, 5.0) + beta(0.5, 5.0))
    return float(np.sqrt(period / half_width * square) / beta(0.5, 5.0) / half_width**2)


_WINDOWS = types.NamedTuple(
    (INTEGERS, INTEGERS, INTEGERS, VECTOR, VECTOR, INTEGERS, types.boolean), Windows
)
AHEAD = (
    (_empty_broken, (VECTOR, types.float64, INTEGERS, INTEGERS, INTEGERS)),
    (
        _weigh,
        (
            VECTOR,
            types.float64,
            types.int64,
            INTEGERS,
            INTEGERS,
            INTEGERS,
            INTEGERS,
            VECTOR,
            VECTOR,
        ),
    ),
    (averages, (_WINDOWS, MATRIX)),
    (_fill_moments, (VECTOR, MATRIX, types.float64, MATRIX, CUBE)),
)
