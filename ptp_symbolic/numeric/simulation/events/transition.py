"""Go on in the modes to which new inputs, or an event, have led."""

from ptp_symbolic.numeric.simulation.events.crossing import cross
from ptp_symbolic.numeric.simulation.events.location import fill_violations, is_outside
from ptp_symbolic.numeric.simulation.events.modes import settle
from ptp_symbolic.numeric.simulation.kernels.records import (
    CHATTERING,
    DONE,
    INSTANT,
    OUTSIDE,
    copy,
    merged,
)
from ptp_symbolic.numeric.simulation.outputs import note_strikes, note_switches

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
