"""Tangents of the state: through accepted steps, and their jumps at events."""

import numpy as np
from numba import njit

from ptp_symbolic.simulation.inputs import evaluate_inputs
from ptp_symbolic.simulation.tableau import STAGES, A, C

SLOPE_STEP = 1e-6  # s
GRAZING = 1e-9  # a guard that is only touched has no event time to differentiate


@njit(cache=True, nogil=True, error_model="numpy")
def input_slope(t, table, cursor, delay_column, u, slope):
    """Write du/dt of the inputs that can be late, by a forward difference inside their piece."""
    if len(u) == 0 or np.max(delay_column) < 0:
        return
    evaluate_inputs(t + SLOPE_STEP, -1, *table, cursor, slope)
    for c in range(len(u)):
        slope[c] = (slope[c] - u[c]) / SLOPE_STEP


@njit(cache=True, nogil=True, error_model="numpy")
def push_tangents(
    jacobian, t, h, x, u, p, m, table, cursor, held, stage, columns, delay_column, s, work
):  # fmt: skip
    """Carry the tangents s [n, ns] over an accepted step; the first columns are parameters."""
    fx, fu, fp, slopes, at = work
    n, ns = s.shape
    u_slope = np.zeros(len(u))
    for i in range(STAGES - 1):
        for a in range(n):
            for c in range(ns):
                at[a, c] = s[a, c]
            for j in range(i):
                factor = h * A[i, j]
                for c in range(ns):
                    at[a, c] += factor * slopes[j, a, c]
        if not held:
            evaluate_inputs(t + C[i] * h, -1 if C[i] == 1.0 else 1, *table, cursor, u)
            input_slope(t + C[i] * h, table, cursor, delay_column, u, u_slope)
        jacobian(t + C[i] * h, stage[i], u, p, m, fx, fu, fp)
        for a in range(n):
            for c in range(ns):
                slopes[i, a, c] = 0.0
            for c in range(len(columns)):
                slopes[i, a, c] = fp[a, columns[c]]
            for c in range(len(u)):
                if delay_column[c] >= 0:
                    slopes[i, a, delay_column[c]] -= fu[a, c] * u_slope[c]
            for b in range(n):
                factor = fx[a, b]
                if factor != 0.0:
                    for c in range(ns):
                        slopes[i, a, c] += factor * at[b, c]
    for a in range(n):
        for i in range(STAGES - 1):
            factor = h * A[STAGES - 1, i]
            for c in range(ns):
                s[a, c] += factor * slopes[i, a, c]


@njit(cache=True, nogil=True, error_model="numpy")
def jump_tangents(before, after, by_time, by_x, by_p, columns, s):
    """Add (f- - f+) dt/dp to the tangents, dt/dp from the guard that ended the mode."""
    n, ns = s.shape
    slope = by_time
    size = abs(by_time)
    for a in range(n):
        slope += by_x[a] * before[a]
        size += abs(by_x[a] * before[a])
    if abs(slope) <= GRAZING * size:
        return
    for c in range(ns):
        shift = by_p[columns[c]] if c < len(columns) else 0.0
        for a in range(n):
            shift += by_x[a] * s[a, c]
        shift /= -slope
        for a in range(n):
            s[a, c] += (before[a] - after[a]) * shift
