"""One explicit Runge-Kutta step: stages, error, interpolant."""

from numba import njit

from ptp_symbolic.simulation.inputs import evaluate_inputs
from ptp_symbolic.simulation.tableau import ERROR, STAGES, A, C, interpolation_weights

SMALLEST = 1e-60


@njit(cache=True, nogil=True, error_model="numpy")
def fill_stages(derivative, t, h, x, u, p, m, table, cursor, held, k, stage):
    """Fill stage states [7, n] and slopes k [7, n]; k[0] and stage[0] = x are given."""
    n = len(x)
    for i in range(1, STAGES):
        for a in range(n):
            total = 0.0
            for j in range(i):
                total += A[i, j] * k[j, a]
            stage[i, a] = x[a] + h * total
        if not held:
            side = -1 if C[i] == 1.0 else 1
            evaluate_inputs(t + C[i] * h, side, *table, cursor, u)
        derivative(t + C[i] * h, stage[i], u, p, m, k[i])


@njit(cache=True, nogil=True, error_model="numpy")
def error_norm(h, x, k, stage, rtol, atol):
    """Largest error of the step over its tolerance."""
    worst = 0.0
    for a in range(len(x)):
        e = 0.0
        for i in range(STAGES):
            e += ERROR[i] * k[i, a]
        scale = atol[a] + rtol * max(abs(x[a]), abs(stage[STAGES - 1, a]))
        worst = max(worst, abs(h * e) / scale)
    return worst


@njit(cache=True, nogil=True, error_model="numpy")
def interpolate(s, h, x, k, weights, out):
    """Write the state at the fraction s of the step into out."""
    interpolation_weights(s, weights)
    for a in range(len(x)):
        total = 0.0
        for i in range(STAGES):
            total += weights[i] * k[i, a]
        out[a] = x[a] + h * total


@njit(cache=True, nogil=True, error_model="numpy")
def flush(values):
    """Set denormal numbers to zero: they slow every loop."""
    flat = values.reshape(-1)
    for i in range(flat.size):
        if abs(flat[i]) < SMALLEST:
            flat[i] = 0.0
