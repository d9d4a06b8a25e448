"""Up to the next stop, with adaptive steps of either method, located events, and samplers.

An event inside a step is bracketed on the dense output, then located by repeating the step itself
until its end lies just past the event. The step length is carried over stops and events.

Step size control: try a step, plan the next from its error; stops and events keep the plan.
"""

import numpy as np

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
    flush,
    inlined,
    merged,
)
from ptp_symbolic.numeric.simulation.methods.exponential_step import reach_sample
from ptp_symbolic.numeric.simulation.methods.steps import (
    ROSENBROCK,
    RUNGE_KUTTA,
    attempt,
    begin,
    end_slope,
    error_norm,
    fill_dense,
    push_tangents,
)
from ptp_symbolic.numeric.simulation.outputs import (
    fill_powers,
    ledger_error,
    work_done,
    write_here,
    write_inside,
)
from ptp_symbolic.numeric.simulation.sampling import is_due, next_stop, sample_at


@inlined
def next_length(remaining, largest, clock):
    """Length in s of the next attempt: as planned, but so that equal steps reach the stop."""
    planned = min(clock[LENGTH], largest)
    return remaining if planned >= remaining else remaining / np.ceil(remaining / planned)


@inlined
def accept(error, length, clock):
    """Plan the next step from the scaled local error of an attempt; False when it must be repeated.

    A step that a stop has cut short says that longer ones are possible, not how long: the plan
    stays where it is longer.
    """
    if not error < 1e10:
        error = 1e10
    if error > 1.0:
        clock[LENGTH] = length * max(0.2, 0.9 * error**-0.2)
        return False
    grow = 5.0 if error < 1e-4 else min(5.0, 0.9 * error**-0.2)
    if clock[LENGTH] <= length:
        clock[LENGTH] = length * grow
    else:
        clock[LENGTH] = max(clock[LENGTH], length * grow)
    return True


@inlined
def try_step(method, equations, inputs, t, length, x, limits, atol, step, watch, record):
    """Try a step of `length` s and plan the next; leaves dense output and powers. False when it
    must be repeated.
    """
    record.counts[STEPS] += 1
    attempt(method, equations, inputs, t, length, x, watch.m, step)
    error = error_norm(method, length, x, step, limits[0], atol)
    if error <= 1.0:
        fill_dense(method, length, x, step)
        if len(record.ledger) > 0:
            fill_powers(equations, inputs, t, length, watch.m, step, record)
            error = max(error, ledger_error(length, limits[0], record))
    return accept(error, length, record.clock)


@inlined
def is_balanced(equations, inputs, t, length, limits, step, watch, record):
    """Check the energy balance of a step that an event has shortened; False to repeat it."""
    if len(record.ledger) == 0:
        return True
    fill_powers(equations, inputs, t, length, watch.m, step, record)
    error = ledger_error(length, limits[0], record)
    return error <= 1.0 or accept(error, length, record.clock)


@merged
def leave(method, equations, inputs, t, length, t_new, x, step, watch, tangents, record):
    """Commit an accepted step: outputs inside it, work over it in J, tangents, x [n] in place."""
    write_inside(equations, inputs, t, length, t_new, watch.m, step, record)
    if len(record.ledger) > 0:
        for c in range(1, 3):
            record.totals[c] += work_done(1.0, length, record.powers, c)
    if tangents.table.shape[1] > 0:
        push_tangents(method, equations, inputs, t, length, watch.m, step, tangents)
        flush(tangents.s)
    copy(step.end, x)
    flush(x)
    record.clock[TIME] = t_new


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
