"""Event location: find the end of a mode or of the domain in a step, and step to just past it.

Where the equations of a model end: bounds of states, watched like the ends of modes.
"""

from ptp_symbolic.numeric.simulation.events.modes import largest_violation, violation
from ptp_symbolic.numeric.simulation.events.pressed import fill_guards
from ptp_symbolic.numeric.simulation.kernels.records import (
    TIME,
    TIME_RESOLUTION,
    inlined,
    kernel,
    merged,
)
from ptp_symbolic.numeric.simulation.methods.steps import attempt, curve, fill_dense
from ptp_symbolic.numeric.simulation.signals.input_values import evaluate_inputs


@inlined
def past_bound(limit, x, watch):
    """How far the state of a limit is past its nearer bound, in its unit (> 0: outside)."""
    value = x[watch.limited[limit]]
    return max(watch.bounds[limit, 0] - value, value - watch.bounds[limit, 1])


@inlined
def is_outside(x, watch):
    """Whether some state of x [n] is past a bound of the domain."""
    found = False
    for limit in range(len(watch.limited)):
        found = found or past_bound(limit, x, watch) > 0.0
    return found


@inlined
def is_finite(x, largest):
    """Whether every state of x [n] is a number (not NaN) below `largest` in size."""
    found = True
    for a in range(len(x)):
        found = found and abs(x[a]) < largest
    return found


@kernel
def stop_at_bound(t, h, x, end, watch, clock):
    """Move x [n] at t in s along the secant to `end` [n], h s later, up to the first bound."""
    fraction = 1.0
    for limit in range(len(watch.limited)):
        before, after = past_bound(limit, x, watch), past_bound(limit, end, watch)
        if after > 0.0:
            fraction = min(fraction, before / (before - after))
    for a in range(len(x)):
        x[a] += fraction * (end[a] - x[a])
    clock[TIME] = t + fraction * h


MISSES, NEAR_START = 4, 0.01
LANDING = 2e-12  # s; how far past an event a step may end
NEARLY = 0.25
NEARBY = 1e-3  # of the way to the root: step of the first slope, on the dense output


@inlined
def fill_violations(equations, inputs, t, x, watch, out):
    """Write the event functions of all elements and limits into out (> 0: the mode has ended);
    returns the largest.
    """
    fill_guards(equations, t, x, inputs.u, watch)
    worst = -1e300
    elements = len(out) - len(watch.limited)
    for element in range(elements):
        out[element] = violation(element, x, watch.m, watch.g, equations.friction_rates)
        worst = max(worst, out[element])
    for limit in range(len(watch.limited)):
        out[elements + limit] = past_bound(limit, x, watch)
        worst = max(worst, out[elements + limit])
    return worst


@kernel
def violation_at(equations, inputs, t, x, watch):
    """Largest event function at t in s and x [n]; inputs as they are before a jump at t."""
    if not inputs.held:
        evaluate_inputs(t, -1, *inputs.table, inputs.cursor, inputs.u)
    fill_guards(equations, t, x, inputs.u, watch)
    worst = largest_violation(x, watch.m, watch.g, equations.friction_rates)
    for limit in range(len(watch.limited)):
        worst = max(worst, past_bound(limit, x, watch))
    return worst


@inlined
def on_curve(equations, inputs, t, h, fraction, step, watch):
    """Largest event function at a fraction of the step, by dense output."""
    curve(fraction, step, step.point)
    return violation_at(equations, inputs, t + fraction * h, step.point, watch)


@kernel
def first_violation(equations, inputs, t, h, step, watch):
    """A fraction of the step at which a mode is found to have ended; 0 if none has.

    inputs.u is as at the end of the step. End and middle are probed, and the vertex of the parabola
    through start, middle and end of every event function that comes near zero there: it may change
    sign twice within one step.
    """
    ended = fill_violations(equations, inputs, t + h, step.end, watch, watch.at_end) > 0.0
    curve(0.5, step, step.point)
    if not inputs.held:
        evaluate_inputs(t + 0.5 * h, -1, *inputs.table, inputs.cursor, inputs.u)
    if fill_violations(equations, inputs, t + 0.5 * h, step.point, watch, watch.at_middle) > 0.0:
        return 0.5
    for element in range(len(watch.at_end)):
        start, end = watch.at_start[element], watch.at_end[element]
        middle = watch.at_middle[element]
        highest = summit(start, middle, end)
        if highest > 0.0 and on_curve(equations, inputs, t, h, highest, step, watch) > 0.0:
            return highest
    return 1.0 if ended else 0.0


@inlined
def summit(start, middle, end):
    """Fraction of a step at which the parabola through an event function at start, middle and end
    has its maximum, if that comes near zero; else 0.
    """
    bend, rise = 2.0 * (start + end) - 4.0 * middle, 4.0 * middle - 3.0 * start - end
    if not bend < 0.0 < rise < -2.0 * bend:
        return 0.0
    highest = -0.5 * rise / bend
    size = abs(middle - start) + abs(end - middle)
    return highest if start + highest * (rise + highest * bend) > -NEARLY * size else 0.0


@kernel
def root_on_curve(equations, inputs, t, h, high, step, watch):
    """Fraction below `high` at which the largest event function has a root on the dense output
    (Illinois method).
    """
    low, below = 0.0, on_curve(equations, inputs, t, h, 0.0, step, watch)
    above = on_curve(equations, inputs, t, h, high, step, watch)
    side = 0
    for _ in range(60):
        if (high - low) * h <= TIME_RESOLUTION or above <= 0.0:
            break
        guess = 0.5 * (low + high)
        if below < 0.0:
            guess = max(low, min(high, high - above * (high - low) / (above - below)))
        value = on_curve(equations, inputs, t, h, guess, step, watch)
        if value > 0.0:
            high, above = guess, value
            below *= 0.5 if side > 0 else 1.0
            side = 1
        else:
            low, below = guess, value
            above *= 0.5 if side < 0 else 1.0
            side = -1
    return high


@merged
def locate_event(method, equations, inputs, t, h, fraction, x, step, watch):
    """Length in s of the step that lands just past the first event; the attempt is left at that
    step.

    The root on the dense output is only as good as that: the step itself is repeated until it ends
    past the event and no more than LANDING after it; its slope there begins the secant iteration.
    Where a few such steps end before any event, the last of them is taken: the next step begins
    nearer and its dense output is better. Only near the start of a step the search strides ahead,
    or no progress would be made.
    """
    root = root_on_curve(equations, inputs, t, h, fraction, step, watch)
    before = on_curve(equations, inputs, t, h, (1.0 - NEARBY) * root, step, watch)
    after = on_curve(equations, inputs, t, h, root, step, watch)
    length, rate = root * h, (after - before) / (NEARBY * root * h)
    low, high = 0.0, h
    last, reach, misses = -1.0, LANDING, 0
    for _ in range(60):
        attempt(method, equations, inputs, t, length, x, watch.m, step)
        value = violation_at(equations, inputs, t + length, step.end, watch)
        if last >= 0.0:
            rate = (value - before) / (length - last) if length != last else 0.0
        before, last = value, length
        if not value <= 0.0:  # also when it is not a number
            high = length
            if high - low <= LANDING or (rate > 0.0 and value <= LANDING * rate):
                break
        else:
            low, misses = length, misses + 1
            if h - low <= TIME_RESOLUTION or (misses >= MISSES and low > NEAR_START * h):
                break
        ahead = LANDING if value <= 0.0 else -LANDING
        if rate > 0.0:
            ahead = 0.5 * LANDING - value / rate
        if value <= 0.0 and misses >= MISSES:
            reach = min(8.0 * reach, NEAR_START * h)
            ahead = max(ahead, reach)
        length += ahead
        if not low < length < high:
            length = 0.5 * (low + high)
    fill_dense(method, length, x, step)
    return length
