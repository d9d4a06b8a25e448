"""The implicit method for stiff machines: Rodas5P with the emitted Jacobian, and its tangents.

Rosenbrock coefficients Rodas5P: order 5 with an embedded order 4 and an interpolant of order 4.

Source: G. Steinebach, Construction of Rosenbrock-Wanner method Rodas5P and numerical benchmarks
within the Julia Differential Equations package, BIT Numerical Mathematics 63:27 (2023), in the
form without products of matrix and vector (Hairer and Wanner, Solving ODEs II, section IV.7).
L-stable and stiffly accurate: the last stage is the error estimate.
"""

import numpy as np

from ptp_symbolic.numeric.simulation.events.impacts import derivative, hold_at_rest, jacobian
from ptp_symbolic.numeric.simulation.input_values import (
    TIME_DIFFERENCE,
    evaluate_input_slopes,
    evaluate_inputs,
    fill_drive,
)
from ptp_symbolic.numeric.simulation.kernels.linear import (
    LANES,
    add_product,
    add_scaled,
    add_sparse_product,
    add_stages,
    invert,
    load,
    multiply,
    nothing,
    plus_times,
    store,
    weighted,
)
from ptp_symbolic.numeric.simulation.kernels.records import copy, copy_matrix, inlined, kernel

STAGES = 8
GAMMA = 0.21193756319429014

# Nodes of the stages, fractions of the step, and weights of the partial derivative by time.
C = np.array(
    [0.0, 0.6358126895828704, 0.4095798393397535, 0.9769306725060716, 0.4288403609558664, 1, 1, 1]
)
D = np.array(
    [
        0.21193756319429014,
        -0.42387512638858027,
        -0.3384627126235924,
        1.8046452872882734,
        2.325825639765069,
        0.0,
        0.0,
        0.0,
    ]
)

# Weights of the earlier stages in the argument of a stage.
A = np.zeros((STAGES, STAGES))
A[1, :1] = [3.0]
A[2, :2] = [2.849394379747939, 0.45842242204463923]
A[3, :3] = [-6.954028509809101, 2.489845061869568, -10.358996098473584]
A[4, :4] = [2.8029986275628964, 0.5072464736228206, -0.3988312541770524, -0.04721187230404641]
A[5, :5] = [
    -7.502846399306121,
    2.561846144803919,
    -11.627539656261098,
    -0.18268767659942256,
    0.030198172008377946,
]
A[6, :5], A[6, 5] = A[5, :5], 1.0
A[7, :6], A[7, 6] = A[6, :6], 1.0

# Weights of the earlier stages, over the step length, on the right-hand side of a stage.
COUPLING = np.zeros((STAGES, STAGES))
COUPLING[1, :1] = [-14.155112264123755]
COUPLING[2, :2] = [-17.97296035885952, -2.859693295451294]
COUPLING[3, :3] = [147.12150275711716, -1.41221402718213, 71.68940251302358]
COUPLING[4, :4] = [
    165.43517024871676,
    -0.4592823456491126,
    42.90938336958603,
    -5.961986721573306,
]
COUPLING[5, :5] = [
    24.854864614690072,
    -3.0009227002832186,
    47.4931110020768,
    5.5814197821558125,
    -0.6610691825249471,
]
COUPLING[6, :6] = [
    30.91273214028599,
    -3.1208243349937974,
    77.79954646070892,
    34.28646028294783,
    -19.097331116725623,
    -28.087943162872662,
]
COUPLING[7, :7] = [
    37.80277123390563,
    -3.2571969029072276,
    112.26918849496327,
    66.9347231244047,
    -40.06618937091002,
    -54.66780262877968,
    -9.48861652309627,
]

# Weights of the stages in the dense output
# y(s) = (1 - s) y0 + s (y1 + (1 - s) (h0 + s (h1 + s h2))).
H = np.array(
    [
        [
            25.948786856663858,
            -2.5579724845846235,
            10.433815404888879,
            -2.3679251022685204,
            0.524948541321073,
            1.1241088310450404,
            0.4272876194431874,
            -0.17202221070155493,
        ],
        [
            -9.91568850695171,
            -0.9689944594115154,
            3.0438037242978453,
            -24.495224566215796,
            20.176138334709044,
            15.98066361424651,
            -6.789040303419874,
            -6.710236069923372,
        ],
        [
            11.419903575922262,
            2.8879645146136994,
            72.92137995996029,
            80.12511834622643,
            -52.072871366152654,
            -59.78993625266729,
            -0.15582684282751913,
            4.883087185713722,
        ],
    ]
)


@kernel
def begin(equations, inputs, t, x, m, step):
    """Evaluate dx/dt, the Jacobians and the partial derivative by time at the start of a step."""
    n = len(x)
    derivative(equations, t, x, inputs.u, m, step.slope)
    jacobian(equations, t, x, inputs.u, m, step.fx, step.fu, step.fp)
    derivative(equations, t + TIME_DIFFERENCE, x, inputs.u, m, step.right)
    moves = False
    for a in range(n):
        step.by_time[a] = 0.0
        moves = moves or step.right[a] != step.slope[a]
    if moves:
        derivative(equations, t - TIME_DIFFERENCE, x, inputs.u, m, step.point)
        for a in range(n):
            step.by_time[a] = (step.right[a] - step.point[a]) / (2.0 * TIME_DIFFERENCE)
    if not inputs.held:
        evaluate_input_slopes(t, 1, *inputs.table, inputs.cursor, inputs.ahead)
        for a in range(n):
            for c in range(len(inputs.ahead)):
                step.by_time[a] += step.fu[a, c] * inputs.ahead[c]


@kernel
def attempt(equations, inputs, t, h, x, m, step):
    """Try a step of length h in s: fill the stages k [8, w] and the end point [n].

    States that samplers set come last; the inverse may leave them out.
    """
    point, right, added = step.point, step.right, step.added
    invert(step.fx, 1.0 / (h * GAMMA), step.inverse, step.order, step.columns)
    for i in range(STAGES):
        for e in range(0, len(added), LANES):
            by_time = plus_times(nothing(), h * D[i], load(step.by_time, e))
            store(plus_times(by_time, 1.0 / h, weighted(COUPLING, i, i, step.k, e)), added, e)
        if i == 0:
            copy(step.slope, right)
        else:
            place_stage(i, x, step.k, point)
            if not inputs.held and i < 6:
                side = -1 if C[i] == 1.0 else 1
                evaluate_inputs(t + C[i] * h, side, *inputs.table, inputs.cursor, inputs.u)
            derivative(equations, t + C[i] * h, point, inputs.u, m, right)
        multiply(step.columns, right, added, step.k[i])
    for a in range(len(x)):
        step.end[a] = point[a] + step.k[STAGES - 1, a]
    hold_at_rest(equations, m, x, step.end)


@inlined
def place_stage(i, x, k, point):
    """Write the argument `point` [w] of stage i; the last two go on from the stage before them."""
    if i > 5:
        for a in range(len(x)):
            point[a] += k[i - 1, a]
        return
    for e in range(0, len(point), LANES):
        store(weighted(A, i, i, k, e), point, e)
    for a in range(len(x)):
        point[a] += x[a]


@inlined
def fill_dense(x, step):
    """Write the dense output of the step, coefficients [5, w] by powers of its fraction."""
    d = step.dense
    for e in range(0, d.shape[1], LANES):
        first = weighted(H, 0, STAGES, step.k, e)
        second = weighted(H, 1, STAGES, step.k, e)
        third = weighted(H, 2, STAGES, step.k, e)
        store(first, d[1], e)
        store(plus_times(second, -1.0, first), d[2], e)
        store(plus_times(third, -1.0, second), d[3], e)
        store(plus_times(nothing(), -1.0, third), d[4], e)
    for a in range(len(x)):
        d[0, a] = x[a]
        d[1, a] += step.end[a] - x[a]


@kernel
def push_tangents(equations, inputs, t, h, m, step, tangents):
    """Propagate the tangents over an accepted step with the same method and the same inverse.

    The variational equation is linear; its coefficients are a parabola in time through start,
    middle and end of the step, so that three Jacobians do where the stages would need sixteen. With
    W = rate I - fx at the start, inverse(W) fx s = rate inverse(W) s - s: only the change of fx
    over the step is ever multiplied, and it has few entries. States that the inverse leaves out
    have no influence, nor have their tangents.
    """
    rate = 1.0 / (h * GAMMA)
    n, width = step.inverse.shape[0], tangents.table.shape[1]
    count = n * width
    s, point, right, along = tangents.s, tangents.point, tangents.right, tangents.along
    fit_coefficients(equations, inputs, t, h, m, step, tangents)
    copy(tangents.by[1], along)
    add_sparse_product(tangents.fx[1], n, width, s, along)
    for i in range(STAGES):
        k = tangents.k[i]
        if i > 5:
            add_scaled(1.0, tangents.k[i - 1], 0, point, 0, count)
        else:
            copy(s, point)
            add_stages(i, A, 1.0, tangents.k, point, count)
        place_coefficients(C[i], n, count, tangents)
        for e in range(0, count, LANES):
            here = load(point, e)
            driven = plus_times(load(right, e), D[i], load(along, e))
            store(plus_times(driven, rate, here), right, e)
            store(plus_times(nothing(), -1.0, here), k, e)
        add_sparse_product(tangents.matrix, n, width, point, right)
        add_stages(i, COUPLING, 1.0 / h, tangents.k, right, count)
        add_product(step.inverse, width, right, k)
    copy(point, s)
    add_scaled(1.0, tangents.k[STAGES - 1], 0, s, 0, count)


@inlined
def fit_coefficients(equations, inputs, t, h, m, step, tangents):
    """Interpolate the coefficients of the variational equation by parabolas over the step."""
    n = len(step.end)
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
            copy_matrix(step.fx, tangents.fx[0])
            fill_drive(inputs, tangents, step.fu, step.fp, tangents.by[0])
        else:
            jacobian(
                equations,
                time,
                step.point,
                inputs.u,
                m,
                tangents.fx[node],
                tangents.fu,
                tangents.fp,
            )
            fill_drive(inputs, tangents, tangents.fu, tangents.fp, tangents.by[node])
    for a in range(n):
        parabola(tangents.fx[0, a], tangents.fx[1, a], tangents.fx[2, a])
    parabola(tangents.by[0], tangents.by[1], tangents.by[2])


@inlined
def parabola(start, middle, end):
    """Replace values [m] at start, middle and end of a step by coefficients of its fraction."""
    for e in range(len(start)):
        a, b, c = start[e], middle[e], end[e]
        middle[e] = 4.0 * b - 3.0 * a - c
        end[e] = 2.0 * (a + c) - 4.0 * b


@inlined
def place_coefficients(fraction, n, count, tangents):
    """Write the change of fx, its first n rows and columns, and the first `count` elements of the
    inhomogeneous term at a fraction of the step.
    """
    square = fraction * fraction
    start, first, second = tangents.by[0], tangents.by[1], tangents.by[2]
    for e in range(0, count, LANES):
        rising = plus_times(load(start, e), fraction, load(first, e))
        store(plus_times(rising, square, load(second, e)), tangents.right, e)
    for a in range(n):
        first, second = tangents.fx[1, a], tangents.fx[2, a]
        for b in range(n):
            tangents.matrix[a, b] = fraction * first[b] + square * second[b]
