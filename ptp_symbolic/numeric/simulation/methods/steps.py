"""One step by either method, behind one face: begin, attempt, error, dense output, tangents.

Where `method` is None it is the implicit one, and where `tangents` are None there are none: what
such runs do not call is not compiled for them.
"""

import math

from ptp_symbolic.numeric.simulation.events.impacts import derivative
from ptp_symbolic.numeric.simulation.input_values import evaluate_inputs
from ptp_symbolic.numeric.simulation.kernels.records import copy, flush, inlined, kernel
from ptp_symbolic.numeric.simulation.methods import rosenbrock, runge_kutta

RUNGE_KUTTA, ROSENBROCK = 0, 1

_begin_implicit = rosenbrock.begin
_attempt_implicit, _attempt_explicit = rosenbrock.attempt, runge_kutta.attempt
_dense_implicit, _dense_explicit = rosenbrock.fill_dense, runge_kutta.fill_dense
_push_implicit, _push_explicit = rosenbrock.push_tangents, runge_kutta.push_tangents
_error_explicit = runge_kutta.error_of
LAST_EXPLICIT, LAST_IMPLICIT = runge_kutta.STAGES - 1, rosenbrock.STAGES - 1


@inlined
def begin(method, equations, inputs, t, x, m, step):
    """Evaluate what the method needs at the start x [n] of a step; leaves inputs.u as there."""
    if not inputs.held:
        evaluate_inputs(t, 1, *inputs.table, inputs.cursor, inputs.u)
    if method is None or method == ROSENBROCK:
        _begin_implicit(equations, inputs, t, x, m, step)
    else:
        derivative(equations, t, x, inputs.u, m, step.slope)


@kernel
def attempt(method, equations, inputs, t, h, x, m, step):
    """Try a step of length h in s from x [n] at t, in the modes m."""
    if method is None or method == ROSENBROCK:
        _attempt_implicit(equations, inputs, t, h, x, m, step)
    else:
        _attempt_explicit(equations, inputs, t, h, x, m, step)


@inlined
def error_norm(method, h, x, step, rtol, atol):
    """Maximum norm of the estimated local error of an attempt over its tolerance; atol [n]."""
    worst = 0.0
    for a in range(len(x)):
        if method is None or method == ROSENBROCK:
            e = step.k[LAST_IMPLICIT, a]
        else:
            e = _error_explicit(h, a, step)
        ratio = over_tolerance(e, x[a], step.end[a], rtol, atol[a])
        worst = larger(worst, ratio)
    return worst


@inlined
def larger(one, other):
    """The larger of two numbers; NaN where either is."""
    return one if other <= one or math.isnan(one) else other


@inlined
def over_tolerance(error, start, end, rtol, atol):
    """Error of a state over its mixed absolute and relative tolerance, by both ends of a step."""
    return abs(error) / (atol + rtol * max(abs(start), abs(end)))


@kernel
def fill_dense(method, h, x, step):
    """Write the dense output of an accepted step, coefficients [5, w] by powers of its fraction."""
    if method is None or method == ROSENBROCK:
        _dense_implicit(x, step)
    else:
        _dense_explicit(h, x, step)


@inlined
def curve(fraction, step, out):
    """Evaluate the dense output at a fraction of the step into out [n]."""
    d = step.dense
    for a in range(len(out)):
        high = d[2, a] + fraction * (d[3, a] + fraction * d[4, a])
        out[a] = d[0, a] + fraction * (d[1, a] + fraction * high)


@kernel
def push_tangents(method, equations, inputs, t, h, m, step, tangents):
    """Propagate the tangents [n, ns], if any, over an accepted step of length h in s."""
    if tangents is not None:
        if tangents.table.shape[1] == 0:
            return
        if method is None or method == ROSENBROCK:
            _push_implicit(equations, inputs, t, h, m, step, tangents)
        else:
            _push_explicit(equations, inputs, t, h, m, step, tangents)
        flush(tangents.s)


@inlined
def ends_with_slope(method):
    """Whether the last stage of a step is the slope where the next begins."""
    if method is None:
        return False
    return method == RUNGE_KUTTA


@inlined
def end_slope(method, equations, inputs, t, m, step, out):
    """Write dx/dt [n] at the end of an accepted attempt in the modes before any switch."""
    if method is None or method == ROSENBROCK:
        derivative(equations, t, step.end, inputs.u, m, out)
    else:
        copy(step.k[LAST_EXPLICIT], out)
