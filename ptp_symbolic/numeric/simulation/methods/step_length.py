"""Step size control: try a step, plan the next from its error; stops and events keep the plan."""

import numpy as np

from ptp_symbolic.numeric.simulation.kernels.records import (
    LENGTH,
    STEPS,
    TIME,
    copy,
    flush,
    inlined,
    merged,
)
from ptp_symbolic.numeric.simulation.methods.steps import (
    attempt,
    error_norm,
    fill_dense,
    push_tangents,
)
from ptp_symbolic.numeric.simulation.outputs import (
    fill_powers,
    ledger_error,
    work_done,
    write_inside,
)


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
