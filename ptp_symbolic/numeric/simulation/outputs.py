"""Results of a run: states at the output times, the energy ledger, events."""

import numpy as np

from ptp_symbolic.numeric.runtime.element_layout import contact_count, contact_modes
from ptp_symbolic.numeric.simulation.events.impacts import PRESSED
from ptp_symbolic.numeric.simulation.input_values import evaluate_inputs
from ptp_symbolic.numeric.simulation.kernels.calls import call
from ptp_symbolic.numeric.simulation.kernels.records import (
    EVENTS,
    OUTPUT,
    TIME_RESOLUTION,
    UNBALANCED,
    copy,
    copy_matrix,
    inlined,
    kernel,
)
from ptp_symbolic.numeric.simulation.methods.steps import curve

OF_STEP, OF_RUN, INSIDE, ROUNDING = 10.0, 0.01, 20.0, 1e-14
SHORTEST_FOR_LEDGER, MOST_UNBALANCED = 1e-9, 100  # s
NODES = 0.5 * (1.0 - 0.2**0.5), 0.5 * (1.0 + 0.2**0.5)  # Lobatto, with both ends: order 6


@kernel
def fill_powers(equations, inputs, t, h, m, step, record):
    """Evaluate stored energy in J and both powers in W at the four Lobatto nodes of a step, and
    replace the powers by the coefficients of their interpolating cubics, in record.powers [4, 3].
    """
    for node in range(4):
        fraction = 0.0 if node == 0 else 1.0 if node == 3 else NODES[node - 1]
        curve(fraction, step, step.point)
        if not inputs.held:
            side = -1 if node == 3 else 1
            evaluate_inputs(t + fraction * h, side, *inputs.table, inputs.cursor, inputs.u)
        call(
            equations.energy,
            t + fraction * h,
            step.point,
            inputs.u,
            equations.p,
            m,
            record.powers[node],
        )
    for c in range(1, 3):
        _cubic_through_nodes(record.powers, c)


@inlined
def _cubic_through_nodes(powers, c):
    """Replace the values of column c at the nodes by the coefficients of the cubic through them."""
    at, a, b = powers[0, c], powers[1, c] - powers[0, c], powers[2, c] - powers[0, c]
    end = powers[3, c] - at
    x, y = NODES
    # Newton's divided differences through 0, x, y and 1.
    first = a / x
    second = ((b - a) / (y - x) - first) / y
    third = ((end - b) / (1.0 - y) - (b - a) / (y - x)) / (1.0 - x) - second
    powers[0, c] = at
    powers[1, c] = first - x * second + x * y * third
    powers[2, c] = second - (x + y) * third
    powers[3, c] = third


@inlined
def work_done(fraction, h, powers, c):
    """Work in J, the integral of power c of `powers` [4, 3], from the start to a fraction of a
    step.
    """
    cubic = powers[2, c] / 3.0 + fraction * powers[3, c] / 4.0
    return h * fraction * (powers[0, c] + fraction * (powers[1, c] / 2.0 + fraction * cubic))


@inlined
def missing_at(node, fraction, h, powers):
    """Residual in J of the energy balance between the start of a step and a node."""
    change = powers[node, 0] - powers[0, 0]
    return abs(change - work_done(fraction, h, powers, 1) + work_done(fraction, h, powers, 2))


@inlined
def ledger_error(h, rtol, record):
    """Residual of the energy balance of a step over its tolerance: at its end, and less so inside.

    A stiff method leaps over a transient without harm to the states, but not to the work done in
    it. Where a step of SHORTEST_FOR_LEDGER is still off, it is taken; where many are, the energies
    of the model do not balance, and steps are no longer shortened for them.
    """
    powers, totals = record.powers, record.totals
    through = abs(work_done(1.0, h, powers, 1)) + abs(work_done(1.0, h, powers, 2))
    through += abs(powers[3, 0] - powers[0, 0])
    before, rounding = abs(totals[1]) + abs(totals[2]), ROUNDING * abs(powers[3, 0])
    at_end = rtol * (OF_STEP * through + OF_RUN * before)
    inside = rtol * INSIDE * (through + before)
    error = max(0.0, missing_at(3, 1.0, h, powers) - rounding) / at_end
    for node in range(1, 3):
        missing = missing_at(node, NODES[node - 1], h, powers)
        error = max(error, max(0.0, missing - rounding) / inside)
    if error > 1.0 and h < SHORTEST_FOR_LEDGER:
        record.counts[UNBALANCED] += 1
        return 0.0
    return error if error > 1.0 and record.counts[UNBALANCED] <= MOST_UNBALANCED else 0.0


@kernel
def write_inside(equations, inputs, t, h, t_new, m, step, record):
    """Write the outputs inside the step from t to t_new in s, by dense output."""
    output = record.counts[OUTPUT]
    while output < len(record.times) and record.times[output] < t_new - TIME_RESOLUTION:
        time = record.times[output]
        fraction = (time - t) / h
        curve(fraction, step, record.x[output])
        if len(record.ledger) > 0:
            if not inputs.held:
                evaluate_inputs(time, 1, *inputs.table, inputs.cursor, inputs.u)
            _write_ledger(equations, inputs, time, m, output, record)
            for c in range(1, 3):
                record.ledger[output, c] += work_done(fraction, h, record.powers, c)
        output += 1
    record.counts[OUTPUT] = output


@inlined
def next_output(record):
    """Time of the next output in s; infinite after the last."""
    output = record.counts[OUTPUT]
    return record.times[output] if output < len(record.times) else np.inf


@inlined
def write_here(equations, inputs, t, x, m, tangents, record):
    """Write the outputs at time t in s, a stop, with their tangents [n, ns]."""
    if next_output(record) <= t + TIME_RESOLUTION:
        _write_here(equations, inputs, t, x, m, tangents, record)


@kernel
def _write_here(equations, inputs, t, x, m, tangents, record):
    output = record.counts[OUTPUT]
    while output < len(record.times) and record.times[output] <= t + TIME_RESOLUTION:
        copy(x, record.x[output])
        if tangents is not None:
            copy_matrix(tangents.table, record.s[output])
        if len(record.ledger) > 0:
            _write_ledger(equations, inputs, t, m, output, record)
        output += 1
    record.counts[OUTPUT] = output


@inlined
def _write_ledger(equations, inputs, t, m, output, record):
    call(equations.energy, t, record.x[output], inputs.u, equations.p, m, record.ledger[output])
    record.ledger[output, 1] = record.totals[1]
    record.ledger[output, 2] = record.totals[2]


@inlined
def note_switches(t, m, m_before, frictions, contacts, record):
    """Record every element whose mode changed at t; the count goes on past the room for events."""
    events = record.events
    for element in range(frictions + contact_count(frictions, len(m))):
        where = element if element < frictions else contact_modes(frictions, element - frictions)
        changed = m[where] != m_before[where]
        mode = m[where]
        if element >= frictions:
            changed = changed or m[where + 1] != m_before[where + 1]
            mode = m[where] * (2.0 - m[where + 1])
            bounced = m_before[where] == 0.0 and m[where + 1] == 0.0
            mode = 3.0 * m[where] if bounced else mode
            if contacts[element - frictions, PRESSED] == 1:
                mode = 4.0 * m[where]
        if changed:
            count = record.counts[EVENTS]
            if count < len(events):
                events[count, 0] = t
                events[count, 1] = element
                events[count, 2] = mode
            record.counts[EVENTS] = count + 1


@inlined
def note_strikes(watch, record):
    """Add the energy in J that impacts have taken to what is dissipated."""
    record.totals[2] += watch.lost[0]
    watch.lost[0] = 0.0
