"""From one sample of a controller to the next in one step: exponential time differencing.

Between samples the inputs stand still, and a geared machine that keeps its modes is nearly linear.
With L its Jacobian, taken once and kept while the modes stay, the step of Cox and Matthews (J.
Comput. Phys. 176, 2002, Eq. 22) is exact in what is linear and of order 2 in the rest:

    middle, ahead = x + h/2 phi1(h/2 L) f(x), x + h phi1(h L) f(x)
    end = ahead + h phi2(h L) (f(ahead) - phi0(h L) f(x))

where phi0 is the exponential. It takes three slopes where the implicit method takes eight and a
Jacobian. A step is made only where its correction is within the tolerance, also by what the slope
at the middle says (two slopes a period of cogging apart would not see it), no mode ends inside and
nothing is asked for inside; everything else is left to the adaptive method. So are machines that
time itself drives, such as a shaken base.
"""

from typing import Any, NamedTuple

import numpy as np
from numba import types

from ptp_symbolic.numeric.simulation.events.domain import is_finite
from ptp_symbolic.numeric.simulation.events.location import TIME_RESOLUTION, fill_violations, summit
from ptp_symbolic.numeric.simulation.events.pressed import derivative, hold_at_rest, jacobian
from ptp_symbolic.numeric.simulation.kernels.lanes import padded
from ptp_symbolic.numeric.simulation.kernels.linear import multiply
from ptp_symbolic.numeric.simulation.kernels.records import (
    INSTANT,
    LARGEST_STATE,
    MATRIX,
    STEPS,
    TIME,
    VECTOR,
    copy,
    flush,
    inlined,
    kernel,
    merged,
)
from ptp_symbolic.numeric.simulation.methods.drive import TIME_DIFFERENCE
from ptp_symbolic.numeric.simulation.methods.phi_functions import double, fill_phi_functions
from ptp_symbolic.numeric.simulation.methods.steps import larger, over_tolerance
from ptp_symbolic.numeric.simulation.outputs import next_output

PERIOD, KNOWN, WAIT, PATIENCE = 0, 1, 2, 3
LONGEST_WAIT = 64.0  # samples
RESTING = 1e-3  # of the tolerance

_V, _M = VECTOR, MATRIX
PROPAGATOR = types.Tuple((_V, _V, *[_M] * 10, *[_V] * 5))


class Propagator(NamedTuple):
    """Matrices that carry the moving states of a machine over one period of its sampler.

    modes: those that the matrices hold for; clock [4]: the last period in s, whether matrices of it
    are known, samples to wait before the next try, and how many after the next failure. decay =
    phi0(h L), straight = h phi1(h L), bent = h phi2(h L), half_decay = phi0(h/2 L), half = h/2
    phi1(h/2 L), all by columns [moving, moving rounded up to LANES]; linear, phi0, phi1, phi2,
    product [moving, moving], slope, ahead, right, change, none [w]: scratch; `none` stays zero.
    """

    modes: Any
    clock: Any
    decay: Any
    straight: Any
    bent: Any
    half_decay: Any
    half: Any
    linear: Any
    phi0: Any
    phi1: Any
    phi2: Any
    product: Any
    slope: Any
    ahead: Any
    right: Any
    change: Any
    none: Any


def new_propagator(modes: int, moving: int, n: int) -> Propagator:
    """Preallocated propagator of n states, the first `moving` of which are not set by samplers."""
    z = np.zeros
    return Propagator(
        z(modes),
        np.array([0.0, 0.0, 0.0, 1.0]),
        *(z((moving, padded(moving))) for _ in range(5)),
        *(z((moving, moving)) for _ in range(5)),
        *(z(padded(n)) for _ in range(5)),
    )


@merged
def reach_sample(equations, inputs, target, x, limits, atol, step, watch, record, propagator):
    """Try an exponential step from x [n] to the sample at `target` in s; False with x as it was."""
    t, clock = record.clock[TIME], propagator.clock
    length = target - t
    again = abs(length - clock[PERIOD]) <= TIME_RESOLUTION
    clock[PERIOD] = length
    if not again:
        clock[KNOWN] = 0.0
        return False
    if clock[WAIT] > 0.0:
        clock[WAIT] -= 1.0
        return False
    if length > limits[1] or next_output(record) < target - TIME_RESOLUTION:
        return False
    derivative(equations, t, x, inputs.u, watch.m, propagator.slope)
    known = clock[KNOWN] == 1.0 and are_equal(watch.m, propagator.modes)
    error = 1e300
    for _ in range(2):
        if not known:
            if is_driven_by_time(equations, inputs, t, x, watch.m, propagator):
                break
            take_linear_part(equations, inputs, t, x, watch.m, step, propagator)
            fill_propagator(length, propagator)
        error = propagate(equations, inputs, t, length, x, limits, atol, watch.m, step, propagator)
        if error <= 1.0 or not known:
            break
        known = False
    if not error <= 1.0:
        clock[KNOWN], clock[WAIT] = 0.0, clock[PATIENCE]
        clock[PATIENCE] = min(2.0 * clock[PATIENCE], LONGEST_WAIT)
        return False
    clock[PATIENCE] = 1.0
    if may_end_a_mode(equations, inputs, t, length, step, watch):
        return False
    record.counts[STEPS] += 1
    record.counts[INSTANT] = 0
    record.clock[TIME] = target
    copy(step.end, x)
    flush(x)
    return True


@kernel
def is_driven_by_time(equations, inputs, t, x, m, propagator):
    """Whether dx/dt depends on time explicitly."""
    derivative(equations, t + TIME_DIFFERENCE, x, inputs.u, m, propagator.right)
    return not are_equal(propagator.right, propagator.slope)


@inlined
def are_equal(a, b):
    """Whether two vectors are the same."""
    same = True
    for i in range(len(a)):
        same = same and a[i] == b[i]
    return same


@inlined
def propagate(equations, inputs, t, h, x, limits, atol, m, step, propagator):
    """Fill middle (step.point [w]) and end [n] of a step of h s; returns its largest correction
    over the tolerance.

    Where next to nothing moves, nothing needs to be corrected.
    """
    slope, ahead, right = propagator.slope, propagator.ahead, propagator.right
    change, none, moving = propagator.change, propagator.none, propagator.linear.shape[0]
    copy(x, step.end)
    copy(x, step.point)
    copy(x, ahead)
    multiply(propagator.straight, slope, none, change)
    for a in range(moving):
        ahead[a] += change[a]
    multiply(propagator.half, slope, none, change)
    for a in range(moving):
        step.point[a] += change[a]
    worst = 0.0
    for a in range(moving):
        worst = larger(worst, over_tolerance(h * slope[a], x[a], ahead[a], limits[0], atol[a]))
    if worst <= RESTING:
        copy(ahead, step.end)
        hold_at_rest(equations, m, x, step.end)
        return worst
    worst = 0.0
    multiply(propagator.half_decay, slope, none, change)
    derivative(equations, t + 0.5 * h, step.point, inputs.u, m, right)
    for a in range(moving):
        unseen = 0.5 * h * (right[a] - change[a])
        worst = larger(worst, over_tolerance(unseen, x[a], step.point[a], limits[0], atol[a]))
    multiply(propagator.decay, slope, none, change)
    derivative(equations, t + h, ahead, inputs.u, m, right)
    for a in range(moving):
        right[a] -= change[a]
    multiply(propagator.bent, right, none, change)
    for a in range(moving):
        step.end[a] = ahead[a] + change[a]
        worst = larger(worst, over_tolerance(change[a], x[a], step.end[a], limits[0], atol[a]))
    hold_at_rest(equations, m, x, step.end)
    return worst


@inlined
def may_end_a_mode(equations, inputs, t, h, step, watch):
    """Whether a mode or the domain may end in the step, by the event functions at its start, middle
    and end and by the vertices of their parabolas.
    """
    if not is_finite(step.end, LARGEST_STATE):
        return True
    if fill_violations(equations, inputs, t + h, step.end, watch, watch.at_end) > 0.0:
        return True
    if fill_violations(equations, inputs, t + 0.5 * h, step.point, watch, watch.at_middle) > 0.0:
        return True
    near = False
    for element in range(len(watch.at_end)):
        start, middle = watch.at_start[element], watch.at_middle[element]
        near = near or summit(start, middle, watch.at_end[element]) > 0.0
    return near


@kernel
def take_linear_part(equations, inputs, t, x, m, step, propagator):
    """Linearise at x [n]: the Jacobian [moving, moving] of the moving states in the modes m."""
    jacobian(equations, t, x, inputs.u, m, step.fx, step.fu, step.fp)
    for i in range(propagator.linear.shape[0]):
        for j in range(propagator.linear.shape[0]):
            propagator.linear[i, j] = step.fx[i, j]
    copy(m, propagator.modes)
    propagator.clock[KNOWN] = 1.0


@inlined
def fill_propagator(h, propagator):
    """Fill the matrices of a step of h s from the linear part."""
    linear, phi0, phi1, phi2, product = (
        propagator.linear,
        propagator.phi0,
        propagator.phi1,
        propagator.phi2,
        propagator.product,
    )
    fill_phi_functions(linear, 0.5 * h, phi0, phi1, phi2, product)
    fill_columns(1.0, phi0, propagator.half_decay)
    fill_columns(0.5 * h, phi1, propagator.half)
    double(phi0, phi1, phi2, product)
    fill_columns(1.0, phi0, propagator.decay)
    fill_columns(h, phi1, propagator.straight)
    fill_columns(h, phi2, propagator.bent)


@inlined
def fill_columns(factor, matrix, columns):
    """Write a factor times `matrix` [moving, moving], transposed, into columns [moving, w]."""
    for i in range(matrix.shape[0]):
        for j in range(matrix.shape[0]):
            columns[j, i] = factor * matrix[i, j]
