"""Cross an event: settle the modes, and apply the saltation matrix to the tangents (Aizerman and
Gantmacher, 1958).

Go on in the modes to which new inputs, or an event, have led.
"""

from ptp_symbolic.numeric.simulation.events.impacts import (
    PRESSED,
    clear_resting,
    derivative,
    fill_guards,
)
from ptp_symbolic.numeric.simulation.events.modes import (
    fill_violations,
    is_outside,
    settle,
    violation,
    violation_gradient,
)
from ptp_symbolic.numeric.simulation.input_values import evaluate_inputs
from ptp_symbolic.numeric.simulation.kernels.calls import call
from ptp_symbolic.numeric.simulation.kernels.records import (
    CHATTERING,
    DONE,
    INSTANT,
    OUTSIDE,
    clear,
    copy,
    inlined,
    kernel,
    merged,
)
from ptp_symbolic.numeric.simulation.outputs import note_strikes, note_switches

GRAZING = 1e-9  # a guard that is only touched has no event time to differentiate
AHEAD = 1e-7  # s


@kernel
def cross(equations, inputs, t, x, watch, tangents, record):
    """Settle the modes at an event at t in s, and let x [n] and the tangents jump; watch.before
    holds dx/dt [n] before the event.

    Returns False when the modes chatter.
    """
    m, frictions = watch.m, len(equations.friction_rates)
    evaluate_inputs(t, 1, *inputs.table, inputs.cursor, inputs.u)
    copy(m, watch.m_before)
    follow_to_event(equations, inputs, t, x, watch, tangents)
    if not settle(equations, t, x, inputs.u, watch, tangents):
        return False
    note_switches(t, m, watch.m_before, frictions, equations.contacts, record)
    note_strikes(watch, record)
    follow_from_event(equations, inputs, t, x, watch, tangents)
    return True


@inlined
def differentiate_guard(equations, inputs, t, x, watch, tangents):
    """Write the gradient of the event function that ended its mode into watch.by_x [n] and
    watch.by_p [np]; returns its partial derivative by time, per s.
    """
    m, p, rates = watch.m, equations.p, equations.friction_rates
    fill_guards(equations, t, x, inputs.u, watch)
    worst, element = -1e300, 0
    for candidate in range(len(watch.at_end) - len(watch.limited)):
        value = violation(candidate, x, m, watch.g, rates)
        if value > worst:
            worst, element = value, candidate
    contact = element - len(rates)
    if contact >= 0 and equations.contacts[contact, PRESSED] == 1:
        clear(watch.by_x)  # it starts from rest without a jump
        clear(watch.by_p)
        return 0.0
    call(
        equations.linearize,
        t,
        x,
        inputs.u,
        p,
        m,
        tangents.fx[0],
        tangents.fu,
        tangents.fp,
        watch.gx,
        watch.gp,
    )
    violation_gradient(element, m, watch.g, watch.gx, watch.gp, rates, watch.by_x, watch.by_p)
    if inputs.held:
        return 0.0
    evaluate_inputs(t + AHEAD, 1, *inputs.table, inputs.cursor, inputs.ahead)
    fill_guards(equations, t, x, inputs.ahead, watch)
    later = violation(element, x, m, watch.g, rates)
    fill_guards(equations, t, x, inputs.u, watch)
    return (later - violation(element, x, m, watch.g, rates)) / AHEAD


@inlined
def follow_to_event(equations, inputs, t, x, watch, tangents):
    """Add f- dt/dp to the tangents [n, ns], if any, dt/dp from the event function; keeps dt/dp.

    First half of the saltation matrix. Impacts act between this and `follow_from_event`, at the
    state where the event is. A grazing event has no dt/dp.
    """
    if tangents is not None and tangents.table.shape[1] > 0:
        by_time = differentiate_guard(equations, inputs, t, x, watch, tangents)
        _follow_to_event(by_time, watch, tangents)


@inlined
def _follow_to_event(by_time, watch, tangents):
    s, columns, shifts = tangents.table, tangents.columns, tangents.along
    n, ns = s.shape
    for c in range(ns):
        shifts[c] = 0.0
    slope, size = by_time, abs(by_time)
    for a in range(n):
        slope += watch.by_x[a] * watch.before[a]
        size += abs(watch.by_x[a] * watch.before[a])
    if abs(slope) <= GRAZING * size:
        return
    for c in range(ns):
        shift = watch.by_p[columns[c]] if c < len(columns) else 0.0
        for a in range(n):
            shift += watch.by_x[a] * s[a, c]
        shift /= -slope
        shifts[c] = shift
        for a in range(n):
            s[a, c] += watch.before[a] * shift


@inlined
def follow_from_event(equations, inputs, t, x, watch, tangents):
    """Take f+ dt/dp off the tangents [n, ns], if any: the second half of the saltation matrix; and
    zero those of what has come to rest.
    """
    if tangents is not None and tangents.table.shape[1] > 0:
        derivative(equations, t, x, inputs.u, watch.m, watch.after)
        for a in range(len(x)):
            friction = equations.zero_at_rest[a]
            if friction >= 0 and watch.m[friction] == 0.0 and watch.m_before[friction] != 0.0:
                clear(tangents.table[a])
        _follow_from_event(watch, tangents)
        clear_resting(equations, watch.m, tangents.table)


@inlined
def _follow_from_event(watch, tangents):
    s = tangents.table
    for c in range(s.shape[1]):
        for a in range(s.shape[0]):
            s[a, c] -= watch.after[a] * tangents.along[c]


@kernel
def jump_by_delay(equations, inputs, t, x, u_before, watch, tangents):
    """Add (f- - f+) to the tangent, if any, of every delay whose zero-order-hold input jumps at t,
    from u_before [nu] to inputs.u.
    """
    if tangents is not None and tangents.table.shape[1] > 0:
        _jump_by_delay(equations, inputs, t, x, u_before, watch, tangents)


@inlined
def _jump_by_delay(equations, inputs, t, x, u_before, watch, tangents):
    u, s = inputs.u, tangents.table
    for j in range(len(u)):
        column = tangents.delay_column[j]
        if column < 0 or u[j] == u_before[j]:
            continue
        now = u[j]
        derivative(equations, t, x, u, watch.m, watch.after)
        u[j] = u_before[j]
        derivative(equations, t, x, u, watch.m, watch.before)
        u[j] = now
        for a in range(len(x)):
            s[a, column] += watch.before[a] - watch.after[a]


MAX_INSTANT_EVENTS = 100
INSTANT_STEP = 1e-10  # s


@merged
def enter(equations, inputs, t, x, watch, tangents, record):
    """Settle modes that inputs from t in s on have ended, x [n] in place; False on chattering."""
    elements = len(watch.at_end)
    if elements == 0 or fill_violations(equations, inputs, t, x, watch, watch.at_start) <= 0.0:
        return True
    copy(watch.m, watch.m_before)
    if not settle(equations, t, x, inputs.u, watch, tangents):
        return False
    note_switches(
        t, watch.m, watch.m_before, len(equations.friction_rates), equations.contacts, record
    )
    note_strikes(watch, record)
    fill_violations(equations, inputs, t, x, watch, watch.at_start)
    return True


@merged
def pass_event(equations, inputs, t, length, x, watch, tangents, record):
    """Stop outside the domain, else cross to the next modes; returns a status."""
    counts = record.counts
    if is_outside(x, watch):
        return OUTSIDE
    counts[INSTANT] = counts[INSTANT] + 1 if length < INSTANT_STEP else 0
    if counts[INSTANT] > MAX_INSTANT_EVENTS:
        return CHATTERING
    if not cross(equations, inputs, t, x, watch, tangents, record):
        return CHATTERING
    fill_violations(equations, inputs, t, x, watch, watch.at_start)
    return DONE
