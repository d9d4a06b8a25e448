"""Tangents of the state: through accepted steps, and their jumps at events."""

from numba import njit

from ptp_symbolic.simulation.inputs import evaluate_inputs
from ptp_symbolic.simulation.tableau import STAGES, A, C


@njit(cache=True, nogil=True, error_model="numpy")
def push_tangents(jacobian, t, h, x, u, p, m, table, cursor, held, stage, columns, s, work):
    """Carry the tangents s [n, ns] over an accepted step; the first columns are parameters."""
    fx, fu, fp, slopes, at = work
    n, ns = s.shape
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
        jacobian(t + C[i] * h, stage[i], u, p, m, fx, fu, fp)
        for a in range(n):
            for c in range(ns):
                slopes[i, a, c] = 0.0
            for c in range(len(columns)):
                slopes[i, a, c] = fp[a, columns[c]]
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
    for a in range(n):
        slope += by_x[a] * before[a]
    if abs(slope) < 1e-300:
        return
    for c in range(ns):
        shift = by_p[columns[c]] if c < len(columns) else 0.0
        for a in range(n):
            shift += by_x[a] * s[a, c]
        shift /= -slope
        for a in range(n):
            s[a, c] += (before[a] - after[a]) * shift
