"""Up to the next stop, with adaptive steps of either method, located events, and samplers.

An event inside a step is bracketed on the dense output, then located by repeating the step itself
until its end lies just past the event. The step length is carried over stops and events.
"""

from ptp_symbolic.numeric.simulation.events.domain import is_finite, is_outside
from ptp_symbolic.numeric.simulation.events.location import (
    TIME_RESOLUTION,
    first_violation,
    locate_event,
)
from ptp_symbolic.numeric.simulation.events.transition import enter, pass_event
from ptp_symbolic.numeric.simulation.kernels.records import (
    CHATTERING,
    DIVERGED,
    DONE,
    EXHAUSTED,
    INSTANT,
    LARGEST_STATE,
    LENGTH,
    OUTSIDE,
    STEPS,
    TIME,
    TOO_FAST,
    copy,
    merged,
)
from ptp_symbolic.numeric.simulation.methods.exponential_step import reach_sample
from ptp_symbolic.numeric.simulation.methods.step_length import (
    is_balanced,
    leave,
    next_length,
    try_step,
)
from ptp_symbolic.numeric.simulation.methods.steps import (
    ROSENBROCK,
    RUNGE_KUTTA,
    begin,
    end_slope,
)
from ptp_symbolic.numeric.simulation.outputs import write_here
from ptp_symbolic.numeric.simulation.sampling import is_due, next_stop, sample_at

SHORTEST = 1e-11  # s


@merged
def advance(method, equations, inputs, stop, x, limits, atol, step, watch, tangents, record):
    """Integrate x [n] in place up to `stop` in s, through all events; returns a status.

    `limits` [3]: rtol, largest step in s, most steps; `atol` [n] in the units of the states.
    """
    clock, counts = record.clock, record.counts
    known = False
    if is_outside(x, watch):
        return OUTSIDE
    while stop - clock[TIME] > TIME_RESOLUTION:
        t = clock[TIME]
        if counts[STEPS] >= limits[2]:
            return EXHAUSTED
        if not known:
            begin(method, equations, inputs, t, x, watch.m, step)
            known = True
        length = next_length(stop - t, limits[1], clock)
        if not try_step(method, equations, inputs, t, length, x, limits, atol, step, watch, record):
            if clock[LENGTH] < SHORTEST:
                return TOO_FAST
            continue
        fraction = 0.0
        if len(watch.at_end) > 0:
            fraction = first_violation(equations, inputs, t, length, step, watch)
        t_new = stop if length == stop - t else t + length
        if fraction > 0.0:
            length = locate_event(method, equations, inputs, t, length, fraction, x, step, watch)
            t_new = t + length
            if not is_balanced(equations, inputs, t, length, limits, step, watch, record):
                continue
            end_slope(method, equations, inputs, t_new, watch.m, step, watch.before)
        if not is_finite(step.end, LARGEST_STATE):
            return DIVERGED
        leave(method, equations, inputs, t, length, t_new, x, step, watch, tangents, record)
        known = method == RUNGE_KUTTA
        if known:
            end_slope(method, equations, inputs, t_new, watch.m, step, step.slope)
        if fraction > 0.0:
            status = pass_event(equations, inputs, t_new, length, x, watch, tangents, record)
            if status != DONE:
                return status
            known = False
        else:
            counts[INSTANT] = 0
            copy(watch.at_end, watch.at_start)
    clock[TIME] = stop
    return DONE


@merged
def advance_by_samples(
    method,
    equations,
    inputs,
    stop,
    x,
    limits,
    atol,
    step,
    watch,
    tangents,
    record,
    sampling,
    propagator,
):
    """Advance to `stop` in s, running the samplers that come due until then and there.

    The explicit method shares nothing with the exponential step: each checks the other.
    """
    whole = method == ROSENBROCK and inputs.held
    whole = whole and tangents.table.shape[1] == 0 and len(record.ledger) == 0
    while True:
        target = next_stop(stop, sampling)
        if not whole or not reach_sample(
            equations, inputs, target, x, limits, atol, step, watch, tangents, record, propagator
        ):
            status = advance(
                method, equations, inputs, target, x, limits, atol, step, watch, tangents, record
            )
            if status != DONE:
                return status
        if is_due(target, sampling):
            sample_at(equations, inputs, target, x, watch.m, tangents, sampling)
        if target == stop:
            return DONE
        write_here(equations, inputs, target, x, watch.m, tangents, record)
        copy(inputs.ahead, inputs.u)
        if not enter(equations, inputs, target, x, watch, tangents, record):
            return CHATTERING
