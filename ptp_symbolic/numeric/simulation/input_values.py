"""Values and slopes of the inputs in compiled code, and how these drive the tangents."""

import math

from numba import njit

from ptp_symbolic.numeric.simulation.kernels.records import KERNEL, inlined


@njit(cache=True, **KERNEL)
def evaluate_inputs(
    t, side, breaks, coefficients, offsets, sines, sine_offsets, sweeps, sweep_offsets, cursor, u
):
    """Fill u [nu] with every signal at time t in s; side +1: value after a jump at t, -1: before.

    The arrays are those of an InputTable. cursor [nu], read and written, holds the piece found
    last, so that a walk through thousands of samples costs one comparison per call.
    """
    for j in range(u.shape[0]):
        row, s = _find_piece(t, side, breaks, offsets, cursor, j)
        c = coefficients[row]
        value = c[0] + s * (c[1] + s * (c[2] + s * c[3]))
        for i in range(sine_offsets[j], sine_offsets[j + 1]):
            value += sines[i, 0] * math.sin(2.0 * math.pi * sines[i, 1] * t + sines[i, 2])
        for i in range(sweep_offsets[j], sweep_offsets[j + 1]):
            t0, t1 = sweeps[i, 3], sweeps[i, 4]
            if t0 <= t < t1 or (side < 0 and t == t1):
                rate = 0.5 * (sweeps[i, 2] - sweeps[i, 1]) / (t1 - t0)
                turns = (sweeps[i, 1] + rate * (t - t0)) * (t - t0)
                value += sweeps[i, 0] * math.sin(2.0 * math.pi * turns)
        u[j] = value


@njit(cache=True, **KERNEL)
def evaluate_input_slopes(
    t,
    side,
    breaks,
    coefficients,
    offsets,
    sines,
    sine_offsets,
    sweeps,
    sweep_offsets,
    cursor,
    slope,
):
    """Fill slope [nu] with du/dt per s at time t in s, as `evaluate_inputs` does u."""
    for j in range(slope.shape[0]):
        row, s = _find_piece(t, side, breaks, offsets, cursor, j)
        c = coefficients[row]
        value = 0.0
        if breaks[offsets[j] + j] <= t <= breaks[offsets[j + 1] + j]:
            value = c[1] + s * (2.0 * c[2] + s * 3.0 * c[3])
        for i in range(sine_offsets[j], sine_offsets[j + 1]):
            turn = 2.0 * math.pi * sines[i, 1]
            value += sines[i, 0] * turn * math.cos(turn * t + sines[i, 2])
        for i in range(sweep_offsets[j], sweep_offsets[j + 1]):
            t0, t1 = sweeps[i, 3], sweeps[i, 4]
            if t0 <= t < t1 or (side < 0 and t == t1):
                rate = 0.5 * (sweeps[i, 2] - sweeps[i, 1]) / (t1 - t0)
                turns = (sweeps[i, 1] + rate * (t - t0)) * (t - t0)
                turn = 2.0 * math.pi * (sweeps[i, 1] + 2.0 * rate * (t - t0))
                value += sweeps[i, 0] * turn * math.cos(2.0 * math.pi * turns)
        slope[j] = value


@njit(cache=True, **KERNEL)
def evaluate_inputs_at(times, table, cursor, u):
    """Fill u [m, nu] with every signal at `times` [m] in s, as `evaluate_inputs` does."""
    for i in range(len(times)):
        evaluate_inputs(times[i], 1, *table, cursor, u[i])


@njit(cache=True, **KERNEL)
def evaluate_input_slopes_at(times, table, cursor, slopes):
    """Fill slopes [m, nu] at `times` [m] in s, as `evaluate_input_slopes` does."""
    for i in range(len(times)):
        evaluate_input_slopes(times[i], 1, *table, cursor, slopes[i])


@njit(forceinline=True, **KERNEL)
def _find_piece(t, side, breaks, offsets, cursor, j):
    """Row of the coefficients of signal j at time t, and the time since that piece began."""
    pieces = offsets[j + 1] - offsets[j]
    at = offsets[j] + j
    k = cursor[j]
    while k < pieces and (breaks[at + k + 1] < t or (side > 0 and breaks[at + k + 1] == t)):
        k += 1
    while k >= 0 and (breaks[at + k] > t or (side < 0 and breaks[at + k] == t)):
        k -= 1
    cursor[j] = k
    piece = min(max(k, 0), pieces - 1)
    return offsets[j] + piece, min(max(t, breaks[at]), breaks[at + pieces]) - breaks[at + piece]


TIME_DIFFERENCE = 1e-5  # s; of the difference quotient by time


@inlined
def fill_drive(inputs, tangents, fu, fp, out):
    """Write the inhomogeneous term [n * ns] of the variational equation: fp of the parameters, and
    -fu du/dt of the delays, du/dt in inputs.ahead.
    """
    n, columns = fp.shape[0], tangents.columns
    width = len(out) // n
    for a in range(n):
        for c in range(len(columns)):
            out[a * width + c] = fp[a, columns[c]]
        for c in range(len(columns), width):
            out[a * width + c] = 0.0
    if inputs.held:
        return
    for c in range(len(inputs.u)):
        column = tangents.delay_column[c]
        if column >= 0:
            for a in range(n):
                out[a * width + column] -= fu[a, c] * inputs.ahead[c]
