"""The explicit method: Tsitouras's Runge-Kutta pair, its interpolant and its exact tangents."""

from ptp_symbolic.numeric.simulation.events.pressed import derivative, jacobian
from ptp_symbolic.numeric.simulation.kernels.lanes import LANES, nothing, plus_times, store
from ptp_symbolic.numeric.simulation.kernels.linear import add_sparse_product, add_stages, weighted
from ptp_symbolic.numeric.simulation.kernels.records import copy, inlined, kernel
from ptp_symbolic.numeric.simulation.methods.drive import fill_drive
from ptp_symbolic.numeric.simulation.methods.tableau import ERROR, INTERPOLANT, STAGES, A, C
from ptp_symbolic.numeric.simulation.signals.input_values import (
    evaluate_input_slopes,
    evaluate_inputs,
)


@kernel
def attempt(equations, inputs, t, h, x, m, step):
    """Try a step of length h in s: fill stages, slopes k [8, w] and the end point [n]."""
    n = len(x)
    for a in range(n):
        step.stage[0, a] = x[a]
    copy(step.slope, step.k[0])
    for i in range(1, STAGES):
        for e in range(0, step.stage.shape[1], LANES):
            change = plus_times(nothing(), h, weighted(A, i, i, step.k, e))
            store(change, step.stage[i], e)
        for a in range(n):
            step.stage[i, a] += x[a]
        if not inputs.held:
            side = -1 if C[i] == 1.0 else 1
            evaluate_inputs(t + C[i] * h, side, *inputs.table, inputs.cursor, inputs.u)
        derivative(equations, t + C[i] * h, step.stage[i], inputs.u, m, step.k[i])
    copy(step.stage[STAGES - 1], step.end)


@inlined
def error_of(h, a, step):
    """Embedded estimate of the local error of state a, in its unit."""
    e = 0.0
    for i in range(STAGES):
        e += ERROR[i] * step.k[i, a]
    return h * e


@inlined
def fill_dense(h, x, step):
    """Write the dense output of the step, coefficients [5, w] by powers of its fraction."""
    for a in range(len(x)):
        step.dense[0, a] = x[a]
    for power in range(4):
        for e in range(0, step.dense.shape[1], LANES):
            total = weighted(INTERPOLANT, power, STAGES, step.k, e)
            store(plus_times(nothing(), h, total), step.dense[power + 1], e)


@kernel
def push_tangents(equations, inputs, t, h, m, step, tangents):
    """Propagate the tangents over an accepted step: the exact derivative of the discrete step."""
    n, width = tangents.table.shape
    count = n * width
    for i in range(STAGES - 1):
        copy(tangents.s, tangents.point)
        add_stages(i, A, h, tangents.k, tangents.point, count)
        if not inputs.held:
            side = -1 if C[i] == 1.0 else 1
            evaluate_inputs(t + C[i] * h, side, *inputs.table, inputs.cursor, inputs.u)
            evaluate_input_slopes(t + C[i] * h, side, *inputs.table, inputs.cursor, inputs.ahead)
        jacobian(
            equations, t + C[i] * h, step.stage[i], inputs.u, m, step.fx, tangents.fu, tangents.fp
        )
        fill_drive(inputs, tangents, tangents.fu, tangents.fp, tangents.k[i])
        add_sparse_product(step.fx, n, width, tangents.point, tangents.k[i])
    add_stages(STAGES - 1, A, h, tangents.k, tangents.s, count)
