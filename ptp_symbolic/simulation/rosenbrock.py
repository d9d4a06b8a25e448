"""The implicit method for stiff machines: Rodas5P with the emitted Jacobian, and its tangents."""

from ptp_symbolic.simulation.emitted import call
from ptp_symbolic.simulation.input_values import evaluate_input_slopes, evaluate_inputs
from ptp_symbolic.simulation.kernels import copy, copy_matrix, inlined, kernel
from ptp_symbolic.simulation.linear import invert
from ptp_symbolic.simulation.rodas5p import COUPLING, GAMMA, STAGES, A, C, D, H
from ptp_symbolic.simulation.runge_kutta import add_product, fill_drive

TIME_DIFFERENCE = 1e-5  # s


@kernel
def begin(equations, inputs, t, x, m, step):
    """Take slope, Jacobian and derivative by time at the start of a step."""
    n, p = len(x), equations.p
    call(equations.derivative, t, x, inputs.u, p, m, step.slope)
    call(equations.jacobian, t, x, inputs.u, p, m, step.fx, step.fu, step.fp)
    call(equations.derivative, t + TIME_DIFFERENCE, x, inputs.u, p, m, step.right)
    moves = False
    for a in range(n):
        step.by_time[a] = 0.0
        moves = moves or step.right[a] != step.slope[a]
    if moves:
        call(equations.derivative, t - TIME_DIFFERENCE, x, inputs.u, p, m, step.point)
        for a in range(n):
            step.by_time[a] = (step.right[a] - step.point[a]) / (2.0 * TIME_DIFFERENCE)
    if not inputs.held:
        evaluate_input_slopes(t, 1, *inputs.table, inputs.cursor, inputs.ahead)
        for a in range(n):
            for c in range(len(inputs.ahead)):
                step.by_time[a] += step.fu[a, c] * inputs.ahead[c]


@kernel
def attempt(equations, inputs, t, h, x, m, step):
    """Try a step of length h in s: fill the increments k and the end point.

    Resting frictions are copied back, or rounding would make them creep.
    """
    n, point, right = len(x), step.point, step.right
    invert(step.fx, 1.0 / (h * GAMMA), step.inverse, step.order)
    for i in range(STAGES):
        if i == 0:
            copy(step.slope, right)
        else:
            place_stage(i, x, step.k, point)
            if not inputs.held and i < 6:
                side = -1 if C[i] == 1.0 else 1
                evaluate_inputs(t + C[i] * h, side, *inputs.table, inputs.cursor, inputs.u)
            call(equations.derivative, t + C[i] * h, point, inputs.u, equations.p, m, right)
        for a in range(n):
            right[a] += h * D[i] * step.by_time[a]
        for j in range(i):
            factor = COUPLING[i, j] / h
            for a in range(n):
                right[a] += factor * step.k[j, a]
        for a in range(n):
            total = 0.0
            for b in range(n):
                total += step.inverse[a, b] * right[b]
            step.k[i, a] = total
    for a in range(n):
        step.end[a] = point[a] + step.k[STAGES - 1, a]
    for f in range(len(equations.friction_rates)):
        if m[f] == 0.0:
            step.end[equations.friction_rates[f]] = x[equations.friction_rates[f]]


@inlined
def place_stage(i, x, k, point):
    """Write the point of stage i; the last two go on from the stage before them."""
    if i > 5:
        for a in range(len(x)):
            point[a] += k[i - 1, a]
        return
    copy(x, point)
    for j in range(i):
        factor = A[i, j]
        for a in range(len(x)):
            point[a] += factor * k[j, a]


@inlined
def fill_dense(x, step):
    """Write the interpolant of the step as a polynomial in the fraction of the step."""
    for a in range(len(x)):
        h0, h1, h2 = 0.0, 0.0, 0.0
        for i in range(STAGES):
            h0 += H[0, i] * step.k[i, a]
            h1 += H[1, i] * step.k[i, a]
            h2 += H[2, i] * step.k[i, a]
        step.dense[0, a] = x[a]
        step.dense[1, a] = step.end[a] - x[a] + h0
        step.dense[2, a] = h1 - h0
        step.dense[3, a] = h2 - h1
        step.dense[4, a] = -h2


@kernel
def push_tangents(equations, inputs, t, h, m, step, tangents):
    """Carry the tangents over an accepted step with the same method and the same inverse.

    The variational equation is linear; its coefficients are a parabola in time through start,
    middle and end of the step, so that three Jacobians do where the stages would need sixteen.
    """
    n, ns = tangents.s.shape
    fit_coefficients(equations, inputs, t, h, m, step, tangents)
    copy_matrix(tangents.by[1], tangents.along)
    add_product(tangents.fx[1], tangents.s, tangents.along)
    for i in range(STAGES):
        if i > 5:
            for a in range(n):
                for c in range(ns):
                    tangents.point[a, c] += tangents.k[i - 1, a, c]
        else:
            copy_matrix(tangents.s, tangents.point)
            add_weighted(i, A, 1.0, tangents.k, tangents.point)
        place_coefficients(C[i], tangents)
        if D[i] != 0.0:
            for a in range(n):
                for c in range(ns):
                    tangents.right[a, c] += D[i] * tangents.along[a, c]
        add_product(tangents.matrix, tangents.point, tangents.right)
        add_weighted(i, COUPLING, 1.0 / h, tangents.k, tangents.right)
        for a in range(n):
            for c in range(ns):
                tangents.k[i, a, c] = 0.0
        add_product(step.inverse, tangents.right, tangents.k[i])
    for a in range(n):
        for c in range(ns):
            tangents.s[a, c] = tangents.point[a, c] + tangents.k[STAGES - 1, a, c]


@inlined
def add_weighted(i, weights, scale, k, out):
    """Add the stages before i with their weights to out [n, ns]."""
    n, ns = out.shape
    for j in range(i):
        factor = scale * weights[i, j]
        for a in range(n):
            for c in range(ns):
                out[a, c] += factor * k[j, a, c]


@inlined
def fit_coefficients(equations, inputs, t, h, m, step, tangents):
    """Write the parabolas of the variational equation in the fraction of the step."""
    n, ns = tangents.s.shape
    for node in range(3):
        time, fraction = t + 0.5 * node * h, 0.5 * node
        for a in range(n):
            step.point[a] = step.dense[0, a]
            for power in range(1, 5):
                step.point[a] += step.dense[power, a] * fraction**power
        if not inputs.held:
            side = -1 if node == 2 else 1
            evaluate_inputs(time, side, *inputs.table, inputs.cursor, inputs.u)
            evaluate_input_slopes(time, side, *inputs.table, inputs.cursor, inputs.ahead)
        if node == 0:
            copy_matrix(step.fu, tangents.fu)
            copy_matrix(step.fp, tangents.fp)
            copy_matrix(step.fx, tangents.fx[0])
        else:
            call(
                equations.jacobian, time, step.point, inputs.u, equations.p, m, tangents.fx[node],
                tangents.fu, tangents.fp,
            )  # fmt: skip
        fill_drive(inputs, tangents, tangents.by[node])
    for a in range(n):
        for b in range(n):
            start, middle, end = tangents.fx[0, a, b], tangents.fx[1, a, b], tangents.fx[2, a, b]
            tangents.fx[1, a, b] = 4.0 * middle - 3.0 * start - end
            tangents.fx[2, a, b] = 2.0 * (start + end) - 4.0 * middle
        for c in range(ns):
            start, middle, end = tangents.by[0, a, c], tangents.by[1, a, c], tangents.by[2, a, c]
            tangents.by[1, a, c] = 4.0 * middle - 3.0 * start - end
            tangents.by[2, a, c] = 2.0 * (start + end) - 4.0 * middle


@inlined
def place_coefficients(fraction, tangents):
    """Write the matrix of the variational equation and what drives it at a fraction of the step."""
    n, ns = tangents.s.shape
    square = fraction * fraction
    for a in range(n):
        for b in range(n):
            tangents.matrix[a, b] = (
                tangents.fx[0, a, b]
                + fraction * tangents.fx[1, a, b]
                + square * tangents.fx[2, a, b]
            )
        for c in range(ns):
            tangents.right[a, c] = (
                tangents.by[0, a, c]
                + fraction * tangents.by[1, a, c]
                + square * tangents.by[2, a, c]
            )
