"""Modes of friction and contact: when one is violated, and what follows.

Modes are one array: the direction of every friction (-1, 0 sticking, 1), then for every contact
the face it touches (-1, 0 in the gap, 1) and whether that face transmits torque (1) or has let go
while still beyond the gap (0). Guards come as the emitted `guards` writes them: per friction
holding torque, breakaway forward and backward; per contact separation, half gap and the torque at
the upper and lower face.

Event location: find the end of a mode or of the domain in a step, and step to just past it.

Where the equations of a model end: bounds of states, watched like the ends of modes.
"""

from ptp_symbolic.numeric.runtime.element_layout import (
    contact_count,
    contact_guards,
    contact_modes,
    friction_guards,
)
from ptp_symbolic.numeric.simulation.events.impacts import (
    PRESSED,
    fill_guards,
    press,
    rest_together,
    strike_faces,
)
from ptp_symbolic.numeric.simulation.input_values import evaluate_inputs
from ptp_symbolic.numeric.simulation.kernels.records import (
    TIME,
    TIME_RESOLUTION,
    inlined,
    kernel,
    merged,
)
from ptp_symbolic.numeric.simulation.methods.steps import attempt, curve, fill_dense

REVERSAL_DEAD_BAND = 1e-13
PUSH_DEAD_BAND = 1e-12  # N m, or N; a face at rest without load would let go and push by rounding


@kernel
def violation(element, x, m, g, friction_rates):
    """Event function of `element` at x [n], modes m and guards g (> 0: its mode has ended); in the
    unit of its guard, or rad/s for the reversal of sliding.
    """
    frictions = len(friction_rates)
    if element < frictions:
        direction = m[element]
        if direction != 0.0:
            return -direction * x[friction_rates[element]] - REVERSAL_DEAD_BAND
        hold = g[friction_guards(element)]
        return max(hold - g[friction_guards(element) + 1], -hold - g[friction_guards(element) + 2])
    contact = element - frictions
    at = contact_guards(frictions, contact)
    side, active = m[contact_modes(frictions, contact)], m[contact_modes(frictions, contact) + 1]
    if side == 0.0:
        return max(g[at] - g[at + 1], -g[at] - g[at + 1])
    pushing = side * (g[at + 2] if side > 0.0 else g[at + 3])
    if active > 0.0:
        return -pushing - PUSH_DEAD_BAND
    return max(pushing - PUSH_DEAD_BAND, g[at + 1] - side * g[at])


@kernel
def largest_violation(x, m, g, friction_rates):
    """The largest event function over all elements; not above zero where every mode holds."""
    worst = -1e300
    elements = len(friction_rates) + contact_count(len(friction_rates), len(m))
    for element in range(elements):
        worst = max(worst, violation(element, x, m, g, friction_rates))
    return worst


@inlined
def _fill_difference(sign, row, limit_sign, limit, derivatives, out):
    """Write sign times one row plus limit_sign times another into out."""
    for i in range(len(out)):
        out[i] = sign * derivatives[row, i] + limit_sign * derivatives[limit, i]


@inlined
def _active_guards(element, m, g, frictions):
    """Sign and row of the two guards whose sum is the violation of a rest or a contact."""
    if element < frictions:
        at, hold = friction_guards(element), g[friction_guards(element)]
        if hold - g[at + 1] >= -hold - g[at + 2]:
            return 1.0, at, -1.0, at + 1
        return -1.0, at, -1.0, at + 2
    contact = element - frictions
    at = contact_guards(frictions, contact)
    side, active = m[contact_modes(frictions, contact)], m[contact_modes(frictions, contact) + 1]
    if side == 0.0:
        return 1.0 if g[at] >= 0.0 else -1.0, at, -1.0, at + 1
    face = at + 2 if side > 0.0 else at + 3
    if active > 0.0:
        return -side, face, 0.0, face
    if side * g[face] >= g[at + 1] - side * g[at]:
        return side, face, 0.0, face
    return -side, at, 1.0, at + 1


@kernel
def violation_gradient(element, m, g, gx, gp, friction_rates, by_x, by_p):
    """Write the gradient of `violation` into by_x [n] and by_p [np], on its active branch, from the
    guards' Jacobians gx [guards, n] and gp [guards, np].
    """
    if element < len(friction_rates) and m[element] != 0.0:
        for i in range(len(by_x)):
            by_x[i] = 0.0
        for i in range(len(by_p)):
            by_p[i] = 0.0
        by_x[friction_rates[element]] = -m[element]
        return
    sign, row, limit_sign, limit = _active_guards(element, m, g, len(friction_rates))
    _fill_difference(sign, row, limit_sign, limit, gx, by_x)
    _fill_difference(sign, row, limit_sign, limit, gp, by_p)


@kernel
def switch_contacts(equations, m, g):
    """Move every violated contact to its next mode, in m; g are the guards."""
    frictions, contacts = len(equations.friction_rates), equations.contacts
    for contact in range(contact_count(frictions, len(m))):
        at = contact_guards(frictions, contact)
        where = contact_modes(frictions, contact)
        side = m[where]
        if side == 0.0:
            if abs(g[at]) > g[at + 1]:
                side = 1.0 if g[at] > 0.0 else -1.0
                m[where] = side
                pushing = side * (g[at + 2] if side > 0.0 else g[at + 3])
                m[where + 1] = 1.0 if pushing > 0.0 else 0.0
            continue
        pushing = side * (g[at + 2] if side > 0.0 else g[at + 3])
        if contacts[contact, PRESSED] == 1:
            if pushing > 0.0 or g[at + 1] - side * g[at] > 0.0:
                contacts[contact, PRESSED] = 0
                m[where + 1] = 1.0 if pushing > 0.0 else 0.0
        elif m[where + 1] > 0.0:
            if pushing < 0.0:
                m[where + 1] = 0.0
        elif g[at + 1] - side * g[at] > 0.0:
            m[where] = 0.0
        elif pushing > 0.0:
            m[where + 1] = 1.0


@kernel
def settle(equations, t, x, u, watch, tangents):
    """Find consistent modes and rates at one instant t in s, x [n] in place; False on chattering.

    Order matters: rates that reversed are zeroed first, then contacts switch and rigid faces
    strike, then the holding torque of every resting friction decides whether it sticks or slides.
    Ties end in sticking.
    """
    m, g = watch.m, watch.g
    friction_rates, zero_at_rest = equations.friction_rates, equations.zero_at_rest
    frictions = len(friction_rates)
    for _ in range(20):
        for k in range(frictions):
            if m[k] != 0.0 and violation(k, x, m, g, friction_rates) > 0.0:
                x[friction_rates[k]] = 0.0
                m[k] = 0.0
                rest_together(friction_rates[k], equations, m, x)
                for a in range(len(x)):
                    if zero_at_rest[a] == k:
                        x[a] = 0.0
        fill_guards(equations, t, x, u, watch)
        switch_contacts(equations, m, g)
        strike_faces(equations, t, x, u, watch, tangents)
        press(equations, t, x, u, watch)
        fill_guards(equations, t, x, u, watch)
        for k in range(frictions):
            if m[k] == 0.0:
                if g[friction_guards(k)] > g[friction_guards(k) + 1]:
                    m[k] = 1.0
                elif -g[friction_guards(k)] > g[friction_guards(k) + 2]:
                    m[k] = -1.0
        fill_guards(equations, t, x, u, watch)
        if largest_violation(x, m, g, friction_rates) <= 0.0:
            return True
    return False


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
