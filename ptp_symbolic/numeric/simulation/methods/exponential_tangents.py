"""Tangents over an exponential step: the variational equation by the same matrices.

With the linear part L of the step, s' = L s + g, where g = (fx - L) s + fp is weighed at the nodes
as the rest of the slope is (see `propagator`). It follows what a winding or a shaft does within the
step: the tangents are good to some thousandths where inputs change little from sample to sample. No
tolerance controls them.
"""

from ptp_symbolic.numeric.simulation.events.pressed import jacobian
from ptp_symbolic.numeric.simulation.kernels.lanes import LANES, load, nothing, plus_times, store
from ptp_symbolic.numeric.simulation.kernels.linear import add_product, add_sparse_product
from ptp_symbolic.numeric.simulation.kernels.records import copy, inlined
from ptp_symbolic.numeric.simulation.methods.drive import fill_drive
from ptp_symbolic.numeric.simulation.methods.propagator import FRACTIONS, NODES


@inlined
def push_tangents(equations, inputs, t, h, x, m, step, tangents, propagator):
    """Propagate the tangents over the step of h s from x [n], whose states at the nodes are known.

    The tangents in g are those that g at the start leads to, straight over the step: they count
    only as far as the machine is not linear.
    """
    n, width = propagator.linear.shape[0], tangents.table.shape[1]
    count = n * width
    s, driven, ahead = tangents.s, tangents.right, tangents.point
    here, start, rest = tangents.along, tangents.by[0], tangents.by[1]
    fill_rest(equations, inputs, t, x, m, s, step, tangents, propagator, start)
    copy(start, driven)
    add_sparse_product(propagator.linear, n, width, s, driven)
    for e in range(0, count, LANES):
        store(plus_times(nothing(), h, load(driven, e)), driven, e)
    copy(s, ahead)
    add_product(propagator.phi1, width, driven, ahead)
    copy(ahead, driven)
    for node in range(NODES):
        part = FRACTIONS[node]
        for e in range(0, count, LANES):
            begun = plus_times(nothing(), 1.0 - part, load(s, e))
            store(plus_times(begun, part, load(driven, e)), here, e)
        state = propagator.states[node]
        fill_rest(equations, inputs, t + part * h, state, m, here, step, tangents, propagator, rest)
        for e in range(0, count, LANES):
            store(plus_times(load(rest, e), -1.0, load(start, e)), rest, e)
        add_product(propagator.by_rows[node], width, rest, ahead)
    for e in range(0, count, LANES):
        store(load(ahead, e), s, e)


@inlined
def fill_rest(equations, inputs, t, x, m, s, step, tangents, propagator, out):
    """Write (fx - L) s + fp at t in s and x [n] for tangents s; s and out are [n * ns]."""
    n, width = propagator.linear.shape[0], tangents.table.shape[1]
    jacobian(equations, t, x, inputs.u, m, step.fx, step.fu, step.fp)
    fill_drive(inputs, tangents, step.fu, step.fp, out)
    for a in range(n):
        for b in range(n):
            step.fx[a, b] -= propagator.linear[a, b]
    add_sparse_product(step.fx, n, width, s, out)
