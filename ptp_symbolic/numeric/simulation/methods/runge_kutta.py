"""The explicit method: Tsitouras's Runge-Kutta pair, its interpolant and its exact tangents.

Explicit Runge-Kutta coefficients of Tsitouras, order 5(4), with its free interpolant.

Source: Ch. Tsitouras, Runge-Kutta pairs of order 5(4) satisfying only the first column simplifying
assumption, Computers and Mathematics with Applications 62 (2011) 770-775, Table 1 and section 4.
"""

import numpy as np

from ptp_symbolic.numeric.simulation.events.impacts import derivative, jacobian
from ptp_symbolic.numeric.simulation.input_values import (
    evaluate_input_slopes,
    evaluate_inputs,
    fill_drive,
)
from ptp_symbolic.numeric.simulation.kernels.linear import (
    LANES,
    add_sparse_product,
    add_stages,
    nothing,
    plus_times,
    store,
    weighted,
)
from ptp_symbolic.numeric.simulation.kernels.records import copy, inlined, kernel

STAGES = 7
ORDER = 5

C = np.array([0.0, 0.161, 0.327, 0.9, 0.9800255409045097, 1.0, 1.0])
A = np.zeros((STAGES, STAGES))
A[1, :1] = [0.161]
A[2, :2] = [-0.008480655492356989, 0.335480655492357]
A[3, :3] = [2.8971530571054935, -6.359448489975075, 4.3622954328695815]
A[4, :4] = [5.325864828439257, -11.748883564062828, 7.4955393428898365, -0.09249506636175525]
A[5, :5] = [
    5.86145544294642,
    -12.92096931784711,
    8.159367898576159,
    -0.071584973281401,
    -0.028269050394068383,
]
A[6, :6] = [
    0.09646076681806523,
    0.01,
    0.4798896504144996,
    1.379008574103742,
    -3.290069515436081,
    2.324710524099774,
]
ERROR = np.array(
    [
        -0.00178001105222577714,
        -0.0008164344596567469,
        0.007880878010261995,
        -0.1447110071732629,
        0.5823571654525552,
        -0.45808210592918697,
        0.015151515151515152,
    ]
)

# Weight of every stage in the powers 1 to 4 of the fraction of a step: the free interpolant.
INTERPOLANT = np.zeros((4, STAGES))
for _stage, _factor, _roots, _square in (
    (0, -1.0530884977290216, (0.0, 1.3299890189751412), (1.4364028541716351, 0.7139816917074209)),
    (1, 0.1017, (0.0, 0.0), (2.1966568338249754, 1.2949852507374631)),
    (2, 2.490627285651252793, (0.0, 0.0), (2.38535645472061657, 1.57803468208092486)),
    (3, -16.54810288924490272, (0.0, 0.0, 1.21712927295533244, 0.61620406037800089), None),
    (4, 47.37952196281928122, (0.0, 0.0, 1.203071208372362603, 0.658047292653547382), None),
    (5, -34.87065786149660974, (0.0, 0.0, 1.2, 0.666666666666666667), None),
    (6, 2.5, (0.0, 0.0, 1.0, 0.6), None),
):
    _polynomial = _factor * np.poly(_roots)
    if _square is not None:
        _polynomial = np.convolve(_polynomial, [1.0, -_square[0], _square[1]])
    INTERPOLANT[:, _stage] = _polynomial[3::-1]


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
