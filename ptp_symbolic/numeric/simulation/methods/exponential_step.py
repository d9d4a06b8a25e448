"""From one sample to the next in one step, of a controller or of inputs that are held: exponential
time differencing.

Between samples the inputs stand still, and a geared machine that keeps its modes is nearly linear.
With L its Jacobian, taken once and kept while the modes stay, the exponential of L integrates the
rest g = f - L x of its slope f (Cox and Matthews, J. Comput. Phys. 176, 2002), known at four states
of the step:

    x + s h phi1(s h L) f(x), s = 0, 1/4, 1/2, 1

Between these g is a parabola and a decay as quick as that of the fastest state (see `propagator`).
A step is exact in what is linear and of order 2 in the rest. It takes four slopes where the
implicit method takes eight and a Jacobian. A step is made only where the rest is within the
tolerance (also inside: two slopes a period of cogging apart would not see it), no mode ends inside
and nothing is asked for inside; everything else is left to the adaptive method. So are machines
that time itself drives, such as a shaken base, samples at uneven times, and steps in which an
oscillation turns so far that a mode may end, and the force be back, unseen between the four states:
a load that swings on its shaft leaves the face of a gap for a few milliseconds.

Tangents over an exponential step: the variational equation by the same matrices.

With the linear part L of the step, s' = L s + g, where g = (fx - L) s + fp is weighed at the nodes
as the rest of the slope is (see `propagator`). It follows what a winding or a shaft does within the
step: the tangents are good to some thousandths where inputs change little from sample to sample. No
tolerance controls them.

The matrices of an exponential step, and how they weigh what is not linear.

The rest g of a slope is known at the NODES of a step after its start, as differences to what it is
there. Between them it is taken for a s + b s^2 + c (exp(-d s) - 1) over the fraction s of the step,
d being how often the fastest state decays in it: what follows a winding, such as its heat, is done
in a thousandth of a second, and a polynomial alone would see it last for the whole step
(exponential fitting: Ixaru, Comput. Phys. Commun. 105, 1997). Where another state decays faster
than the winding, the parabola alone follows the winding. The exponential of the linear part L
integrates the three to h times phi2, 2 phi3 and psi - phi1, with psi = exp(-d) phi1(h L + d).

The exponential of a small matrix, and the three phi functions that go with it.

phi0(z) = exp(z), phi1(z) = (phi0(z) - 1) / z, phi2(z) = (phi1(z) - 1) / z, phi3(z) = (phi2(z) -
1/2) / z (Hochbruck and Ostermann, Acta Numerica 19, 2010, Eq. 2.10), by scaling and squaring of a
Taylor series.
"""

import math
from typing import Any, NamedTuple

import numpy as np
from numba import types

from ptp_symbolic.numeric.simulation.events.impacts import derivative, hold_at_rest, jacobian
from ptp_symbolic.numeric.simulation.events.modes import (
    NEARLY,
    fill_violations,
    is_finite,
    summit,
)
from ptp_symbolic.numeric.simulation.input_values import TIME_DIFFERENCE, fill_drive
from ptp_symbolic.numeric.simulation.kernels.linear import (
    LANES,
    add_product,
    add_sparse_product,
    factor,
    load,
    multiply,
    nothing,
    padded,
    plus_times,
    solve,
    store,
)
from ptp_symbolic.numeric.simulation.kernels.records import (
    CUBE,
    INSTANT,
    INTEGERS,
    LARGEST_STATE,
    MATRIX,
    STEPS,
    TIME,
    TIME_RESOLUTION,
    VECTOR,
    copy,
    copy_matrix,
    flush,
    inlined,
    kernel,
    merged,
)
from ptp_symbolic.numeric.simulation.methods.steps import larger, over_tolerance
from ptp_symbolic.numeric.simulation.outputs import next_output

HIGHEST_POWER, LARGEST_NORM, MOST_DOUBLINGS = 15, 0.5, 60


@kernel
def fill_phi_functions(matrix, scale, phi0, phi1, phi2, phi3, product):
    """Write phi0 to phi3 of scale times `matrix`, all [k, k]; `product` is scratch."""
    doublings, norm = 0, largest_row_sum(matrix)
    while not norm * scale <= LARGEST_NORM and doublings < MOST_DOUBLINGS:
        scale *= 0.5
        doublings += 1
    coefficient = 1.0
    for power in range(2, HIGHEST_POWER + 1):
        coefficient /= power
    for i in range(len(phi3)):
        for j in range(len(phi3)):
            phi3[i, j] = coefficient if i == j else 0.0
    for power in range(HIGHEST_POWER, 3, -1):
        coefficient *= power
        fill_product_and_diagonal(scale, matrix, phi3, coefficient, product)
        copy_matrix(product, phi3)
    fill_product_and_diagonal(scale, matrix, phi3, 0.5, phi2)
    fill_product_and_diagonal(scale, matrix, phi2, 1.0, phi1)
    fill_product_and_diagonal(scale, matrix, phi1, 1.0, phi0)
    for _ in range(doublings):
        double(phi0, phi1, phi2, phi3, product)


@kernel
def double(phi0, phi1, phi2, phi3, product):
    """Square: from z to 2 z (Skaflestad and Wright, Appl. Numer. Math. 59); all [k, k]."""
    fill_product_and_diagonal(1.0, phi0, phi3, 0.0, product)
    for i in range(len(phi3)):
        for j in range(len(phi3)):
            before = 0.5 * phi1[i, j] + phi2[i, j] + phi3[i, j]
            phi3[i, j] = 0.125 * (product[i, j] + before)
    fill_product_and_diagonal(1.0, phi0, phi2, 0.0, product)
    for i in range(len(phi2)):
        for j in range(len(phi2)):
            phi2[i, j] = 0.25 * (product[i, j] + phi1[i, j] + phi2[i, j])
    fill_product_and_diagonal(1.0, phi0, phi1, 0.0, product)
    for i in range(len(phi1)):
        for j in range(len(phi1)):
            phi1[i, j] = 0.5 * (product[i, j] + phi1[i, j])
    fill_product_and_diagonal(1.0, phi0, phi0, 0.0, product)
    copy_matrix(product, phi0)


@inlined
def largest_row_sum(matrix):
    """Maximum norm of `matrix` [k, k]."""
    largest = 0.0
    for i in range(len(matrix)):
        total = 0.0
        for j in range(len(matrix)):
            total += abs(matrix[i, j])
        largest = max(largest, total)
    return largest


@kernel
def fill_product_and_diagonal(factor, a, b, diagonal, out):
    """Write factor a b + diagonal I into out, all [k, k]."""
    for i in range(len(out)):
        for j in range(len(out)):
            total = 0.0
            for k in range(len(out)):
                total += a[i, k] * b[k, j]
            out[i, j] = factor * total + (diagonal if i == j else 0.0)


NODES, MIDDLE = 3, 1
FRACTIONS = np.array([0.25, 0.5, 1.0])  # of the step, where the nodes are
SLOWEST, FASTEST = 1.0, 40.0  # decays per step; slower is like a cubic, faster like a jump

_V, _M, _C = VECTOR, MATRIX, CUBE
PROPAGATOR = types.Tuple((_V, _V, *[_C] * 4, *[_M] * 11, *[_V] * 4, INTEGERS))


class Propagator(NamedTuple):
    """Matrices that carry the moving states of a machine over one sampling period.

    modes: those that the matrices hold for; clock [6]: the period in s, whether matrices of it are
    known, samples to wait before the next try, how many after the next failure, by how much in rad
    the fastest oscillation turns in the period, and when in s it was last asked for. For every node
    s, by columns [moving, moving rounded up to LANES]: decay = phi0(s h L), reach = s h phi1(s h
    L), weights of the rests, these also `by_rows`; linear = L, phi0 to phi3 of h L [moving,
    moving]; shifted, psi, product [moving, moving]: scratch. states, rest [3, w]: those at the
    nodes; fitted [3, 3], unit, order [3], slope, change, none [w]: scratch; `none` stays zero.
    """

    modes: Any
    clock: Any
    decay: Any
    reach: Any
    weights: Any
    by_rows: Any
    linear: Any
    phi0: Any
    phi1: Any
    phi2: Any
    phi3: Any
    shifted: Any
    psi: Any
    product: Any
    states: Any
    rest: Any
    fitted: Any
    slope: Any
    change: Any
    none: Any
    unit: Any
    order: Any


def new_propagator(modes: int, moving: int, n: int) -> Propagator:
    """Preallocated propagator of n states, the first `moving` of which are not set by samplers."""
    z, w = np.zeros, padded(n)
    arrays = [z(modes), z(6)]
    arrays += [z((NODES, moving, padded(moving))) for _ in range(3)]
    arrays += [z((NODES, moving, moving))]
    arrays += [z((moving, moving)) for _ in range(8)]
    arrays += [z((NODES, size)) for size in (w, w, NODES)]
    arrays += [z(size) for size in (w, w, w, NODES)]
    arrays += [z(NODES, dtype=np.int64)]
    return Propagator(*arrays)


def forget(propagator: Propagator) -> None:
    """Let a propagator begin anew."""
    propagator.clock[:] = 0.0, 0.0, 0.0, 1.0, 0.0, -np.inf


@kernel
def fill_propagator(h, fx, propagator):
    """Fill the matrices of a step of h s, with the linear part from fx [n, n]."""
    linear, phi0, phi1, phi2, phi3, product = (
        propagator.linear,
        propagator.phi0,
        propagator.phi1,
        propagator.phi2,
        propagator.phi3,
        propagator.product,
    )
    copy_matrix(fx, linear)
    decays = decays_in(h, linear)
    copy_matrix(linear, propagator.shifted)
    for i in range(linear.shape[0]):
        propagator.shifted[i, i] += decays / h
    fill_phi_functions(propagator.shifted, h, phi0, propagator.psi, phi2, phi3, product)
    fill_phi_functions(linear, FRACTIONS[0] * h, phi0, phi1, phi2, phi3, product)
    for node in range(NODES):
        if node > 0:
            double(phi0, phi1, phi2, phi3, product)
        fill_columns(1.0, phi0, propagator.decay[node])
        fill_columns(FRACTIONS[node] * h, phi1, propagator.reach[node])
    fill_weights(decays, h, propagator)


@inlined
def decays_in(h, linear):
    """How often the fastest state decays by a factor of e in h s, by itself."""
    fastest = SLOWEST
    for i in range(linear.shape[0]):
        fastest = max(fastest, -h * linear[i, i])
    return min(fastest, FASTEST)


@kernel
def fill_weights(decays, h, propagator):
    """Fill the weights of the rests at the nodes, by the fit of the three functions to them."""
    phi1, phi2, phi3, psi = propagator.phi1, propagator.phi2, propagator.phi3, propagator.psi
    fitted, unit, left = propagator.fitted, propagator.unit, math.exp(-decays)
    for node in range(NODES):
        s = FRACTIONS[node]
        fitted[node, 0], fitted[node, 1], fitted[node, 2] = s, s * s, math.expm1(-decays * s)
    factor(fitted, propagator.order)
    for node in range(NODES):
        for k in range(NODES):
            unit[k] = 1.0 if k == node else 0.0
        solve(fitted, propagator.order, unit)
        weights = propagator.by_rows[node]
        for i in range(phi1.shape[0]):
            for j in range(phi1.shape[0]):
                decaying = left * psi[i, j] - phi1[i, j]
                total = unit[0] * phi2[i, j] + 2.0 * unit[1] * phi3[i, j] + unit[2] * decaying
                weights[i, j] = h * total
        fill_columns(1.0, weights, propagator.weights[node])


@inlined
def fill_columns(scale, matrix, columns):
    """Write a scale times `matrix` [moving, moving], transposed, into columns [moving, w]."""
    for i in range(matrix.shape[0]):
        for j in range(matrix.shape[0]):
            columns[j, i] = scale * matrix[i, j]


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


PERIOD, KNOWN, WAIT, PATIENCE, TURN, USED = 0, 1, 2, 3, 4, 5
LENGTHS = 3  # of steps that follow one another: inputs of two axes, each late by its own delay
LONGEST_WAIT = 64.0  # samples
RESTING = 1e-3  # of the tolerance
FARTHEST_TURN = math.pi  # rad in a step; of an oscillation that parabolas through the nodes show


@inlined
def of_length(length, propagators):
    """Which of the `propagators` [LENGTHS] is that of steps of so many s; without one, the one that
    no step has asked for for longest.
    """
    found = 0
    for k in range(LENGTHS):
        if abs(length - propagators[k].clock[PERIOD]) <= TIME_RESOLUTION:
            return k
        if propagators[k].clock[USED] < propagators[found].clock[USED]:
            found = k
    return found


@merged
def reach_sample(
    equations, inputs, target, x, limits, atol, step, watch, tangents, record, propagator
):
    """Try an exponential step from x [n], and its tangents, to the sample at `target` in s; False
    with all as it was.
    """
    t, clock = record.clock[TIME], propagator.clock
    length = target - t
    again = abs(length - clock[PERIOD]) <= TIME_RESOLUTION
    clock[PERIOD], clock[USED] = length, t
    if not again:
        clock[KNOWN] = 0.0
        return False
    if clock[WAIT] > 0.0:
        clock[WAIT] -= 1.0
        return False
    if length > limits[1] or next_output(record) < target - TIME_RESOLUTION:
        return False
    known = clock[KNOWN] == 1.0 and are_equal(watch.m, propagator.modes)
    if known and clock[TURN] > FARTHEST_TURN:
        return False
    derivative(equations, t, x, inputs.u, watch.m, propagator.slope)
    error = 1e300
    for _ in range(2):
        if not known:
            if is_driven_by_time(equations, inputs, t, x, watch.m, propagator):
                break
            jacobian(equations, t, x, inputs.u, watch.m, step.fx, step.fu, step.fp)
            copy(watch.m, propagator.modes)
            clock[KNOWN], clock[TURN] = 1.0, turn_in(length, step.fx, propagator.linear.shape[0])
            if clock[TURN] > FARTHEST_TURN:
                return False
            fill_propagator(length, step.fx, propagator)
        error = propagate(equations, inputs, t, length, x, limits, atol, watch.m, step, propagator)
        if error <= 1.0 or not known:
            break
        known = False
    if not error <= 1.0:
        clock[KNOWN], clock[WAIT] = 0.0, clock[PATIENCE]
        clock[PATIENCE] = min(2.0 * clock[PATIENCE], LONGEST_WAIT)
        return False
    clock[PATIENCE] = 1.0
    if may_end_a_mode(equations, inputs, t, length, step, watch, propagator):
        return False
    record.counts[STEPS] += 1
    record.counts[INSTANT] = 0
    record.clock[TIME] = target
    if tangents.table.shape[1] > 0:
        push_tangents(equations, inputs, t, length, x, watch.m, step, tangents, propagator)
        flush(tangents.s)
    copy(step.end, x)
    flush(x)
    return True


@inlined
def turn_in(h, fx, moving):
    """By how much, in rad, the fastest oscillation of two of the `moving` states turns in h s, by
    itself; fx [n, n].
    """
    fastest = 0.0
    for i in range(moving):
        for j in range(i):
            apart = 0.5 * (fx[i, i] - fx[j, j])
            fastest = max(fastest, -fx[i, j] * fx[j, i] - apart * apart)
    return h * math.sqrt(fastest)


@kernel
def is_driven_by_time(equations, inputs, t, x, m, propagator):
    """Whether dx/dt depends on time explicitly."""
    derivative(equations, t + TIME_DIFFERENCE, x, inputs.u, m, propagator.change)
    return not are_equal(propagator.change, propagator.slope)


@inlined
def are_equal(a, b):
    """Whether two vectors are the same."""
    same = True
    for i in range(len(a)):
        same = same and a[i] == b[i]
    return same


@inlined
def propagate(equations, inputs, t, h, x, limits, atol, m, step, propagator):
    """Fill the states [3, w] inside, the middle of them also as step.point [w], and the end [n] of
    a step of h s; returns the largest effect of its rest over the tolerance.

    Where next to nothing moves, nothing needs to be corrected.
    """
    slope, change, none = propagator.slope, propagator.change, propagator.none
    states, rest, moving = propagator.states, propagator.rest, propagator.linear.shape[0]
    for node in range(NODES):
        multiply(propagator.reach[node], slope, none, change)
        for a in range(len(x)):
            states[node, a] = x[a] + (change[a] if a < moving else 0.0)
    copy(states[MIDDLE], step.point)
    copy(states[NODES - 1], step.end)
    worst = 0.0
    for a in range(moving):
        worst = larger(worst, over_tolerance(h * slope[a], x[a], step.end[a], limits[0], atol[a]))
    if worst <= RESTING:
        hold_at_rest(equations, m, x, step.end)
        return worst
    worst = 0.0
    for node in range(NODES):
        reached = FRACTIONS[node] * h
        derivative(equations, t + reached, states[node], inputs.u, m, rest[node])
        multiply(propagator.decay[node], slope, none, change)
        for a in range(moving):
            rest[node, a] -= change[a]
            if node < NODES - 1:
                unseen = over_tolerance(
                    reached * rest[node, a], x[a], states[node, a], limits[0], atol[a]
                )
                worst = larger(worst, unseen)
    for node in range(NODES):
        multiply(propagator.weights[node], rest[node], none, change)
        for a in range(moving):
            step.end[a] += change[a]
    for a in range(moving):
        correction = step.end[a] - states[NODES - 1, a]
        worst = larger(worst, over_tolerance(correction, x[a], step.end[a], limits[0], atol[a]))
    hold_at_rest(equations, m, x, step.end)
    return worst


@inlined
def may_end_a_mode(equations, inputs, t, h, step, watch, propagator):
    """Whether a mode or the domain may end in the step, by the event functions at its start, first
    quarter, middle and end, by the vertices of their parabolas, and by how rates of sliding begin.
    """
    if not is_finite(step.end, LARGEST_STATE):
        return True
    early, inside = watch.at_end, propagator.states[0]  # the first quarter, before the end
    if fill_violations(equations, inputs, t + FRACTIONS[0] * h, inside, watch, early) > 0.0:
        return True
    if fill_violations(equations, inputs, t + 0.5 * h, step.point, watch, watch.at_middle) > 0.0:
        return True
    near = False
    for element in range(len(watch.at_end)):
        start, middle = watch.at_start[element], watch.at_middle[element]
        near = near or summit(start, early[element], middle) > 0.0
    for f in range(len(equations.friction_rates)):
        rise = -watch.m[f] * propagator.slope[equations.friction_rates[f]] * FRACTIONS[0] * h
        near = near or rises_to_zero(watch.at_start[f], rise, early[f])
    if near or fill_violations(equations, inputs, t + h, step.end, watch, watch.at_end) > 0.0:
        return True
    for element in range(len(watch.at_end)):
        start, middle = watch.at_start[element], watch.at_middle[element]
        near = near or summit(start, middle, watch.at_end[element]) > 0.0
    return near


@inlined
def rises_to_zero(start, rise, end):
    """Whether the parabola from `start` to `end`, which begins to `rise`, comes near zero between:
    within a quarter of how far it rises.
    """
    bend = end - start - rise
    if not bend < 0.0 < rise < -2.0 * bend:
        return False
    height = -0.25 * rise * rise / bend
    return start + height > -NEARLY * height
