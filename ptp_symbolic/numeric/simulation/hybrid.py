"""The compiled runner: adaptive steps by either method, located events, tangents through both.

One runner serves every model: the emitted functions come in as typed function pointers. Steps end
at every stop (sample of a zero-order hold, break of a profile) and where a sampler is due. Where
inputs stand still from stop to stop, exponential steps go as far as they can (`held_samples`).

Up to the next stop, with adaptive steps of either method, located events, and samplers.

An event inside a step is bracketed on the dense output, then located by repeating the step itself
until its end lies just past the event. The step length is carried over stops and events.

Step size control: try a step, plan the next from its error; stops and events keep the plan.
"""

from collections.abc import Callable
from functools import lru_cache

import numpy as np
from numba import njit, types

from ptp_symbolic.numeric.simulation.ahead import (
    LEAN_RUNNER,
    RUNNER,
    SAMPLED_RUNNER,
    made_once,
)
from ptp_symbolic.numeric.simulation.events.crossing import enter, jump_by_delay, pass_event
from ptp_symbolic.numeric.simulation.events.modes import (
    first_violation,
    is_finite,
    is_outside,
    locate_event,
)
from ptp_symbolic.numeric.simulation.input_values import evaluate_inputs
from ptp_symbolic.numeric.simulation.kernels.calls import place
from ptp_symbolic.numeric.simulation.kernels.records import (
    CHATTERING,
    DIVERGED,
    DONE,
    EXHAUSTED,
    INSTANT,
    KERNEL,
    LARGEST_STATE,
    LENGTH,
    OUTSIDE,
    RUN_TYPES,
    SHORTEST,
    SOURCES,
    STEPS,
    TIME,
    TIME_RESOLUTION,
    TOO_FAST,
    Inputs,
    Record,
    Step,
    Tangents,
    Watch,
    copy,
    equations_at,
    flush,
    inlined,
    merged,
    source_stamp,
)
from ptp_symbolic.numeric.simulation.methods.exponential_step import (
    LENGTHS,
    PROPAGATOR,
    Propagator,
    reach_sample,
)
from ptp_symbolic.numeric.simulation.methods.steps import (
    ROSENBROCK,
    attempt,
    begin,
    end_slope,
    ends_with_slope,
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
from ptp_symbolic.numeric.simulation.sampling import (
    SAMPLING,
    Sampling,
    is_due,
    next_stop,
    reach_samples_at,
    sample_at,
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
    push_tangents(method, equations, inputs, t, length, watch.m, step, tangents)
    copy(step.end, x)
    flush(x)
    record.clock[TIME] = t_new


@inlined
def grant(stops, limits):
    """Add what `stops` bring to the steps that may be taken at once, limits[3]: limits[4] each, and
    no more than limits[5] at a time (a leaky bucket: Turner, 1986).
    """
    limits[3] = min(limits[5], limits[3] + limits[4] * stops)


@merged
def advance(method, equations, inputs, stop, x, limits, atol, step, watch, tangents, record):
    """Integrate x [n] in place up to `stop` in s, through all events; returns a status.

    `limits` [6]: rtol, largest step in s, most steps, and those of `grant`; `atol` [n] in the units
    of the states.
    """
    clock, counts = record.clock, record.counts
    known, most = False, min(limits[2], counts[STEPS] + limits[3])
    if is_outside(x, watch):
        return OUTSIDE
    while stop - clock[TIME] > TIME_RESOLUTION:
        t = clock[TIME]
        if counts[STEPS] >= most:
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
        known = ends_with_slope(method)
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


@inlined
def unless(left_out, value):
    """`value` where `left_out` is None, else None: what it is for is then not compiled."""
    if left_out is None:
        return value
    return None


def compiled_runner(sources: int, sampled: bool, lean: bool) -> Callable[..., int]:
    """The compiled runner for machines with samplers (`sampled`), or for those without, which takes
    a third less time; or for runs of those by the implicit method without tangents (`lean`), which
    takes two thirds of that; stamped with the `sources` it comes from (see `source_stamp`).
    """
    left_out = 1 if lean else None  # no function: it would be another in every process

    @njit(
        types.int64(
            types.int64,  # method
            types.int64,  # address of the loop over held samples, or 0
            *RUN_TYPES,
            SAMPLING,
            types.UniTuple(PROPAGATOR, LENGTHS),
        ),
        cache=True,
        **KERNEL,
    )
    def run(
        method,
        samples,
        functions,
        p,
        prepared,
        friction_rates,
        zero_at_rest,
        contacts,
        table,
        cursor,
        held,
        u,
        x,
        stops,
        limits,
        atol,
        step,
        watch,
        tangents,
        record,
        sampling,
        propagators,
    ):
        """Integrate from the first to the last stop; returns a status, the rest is in `record`."""
        record = place(Record(*record))
        record.counts[SOURCES] = sources
        equations = place(
            equations_at(functions, p, prepared, friction_rates, zero_at_rest, contacts)
        )
        inputs = place(Inputs(table, cursor, held, u[0], u[1]))
        step, watch = place(Step(*step)), place(Watch(*watch))
        moved = place(Tangents(*tangents))
        method, tangents = unless(left_out, method), unless(left_out, moved)
        sampling = place(Sampling(*sampling))
        propagators = (
            place(Propagator(*propagators[0])),
            place(Propagator(*propagators[1])),
            place(Propagator(*propagators[2])),
        )
        record.clock[TIME], record.clock[LENGTH] = stops[0], limits[1]
        if sampled and is_due(stops[0], sampling):
            sample_at(equations, inputs, stops[0], x, watch.m, tangents, sampling)
        evaluate_inputs(stops[0], 1, *inputs.table, inputs.cursor, inputs.u)
        write_here(equations, inputs, stops[0], x, watch.m, tangents, record)
        index = 0
        while index < len(stops) - 1:
            before = index
            if samples != 0:
                index = reach_samples_at(
                    samples,
                    index,
                    equations,
                    inputs,
                    x,
                    stops,
                    limits,
                    atol,
                    step,
                    watch,
                    moved,
                    record,
                    propagators,
                )
                if index == len(stops) - 1:
                    return DONE
            index += 1
            copy(inputs.u, u[2])
            evaluate_inputs(stops[index - 1], 1, *inputs.table, inputs.cursor, inputs.u)
            if index > 1:
                jump_by_delay(equations, inputs, stops[index - 1], x, u[2], watch, tangents)
            if not enter(equations, inputs, stops[index - 1], x, watch, tangents, record):
                return CHATTERING
            end, taken = stops[index], record.counts[STEPS]
            grant(index - before, limits)
            if sampled:
                status = advance_by_samples(
                    method,
                    equations,
                    inputs,
                    end,
                    x,
                    limits,
                    atol,
                    step,
                    watch,
                    tangents,
                    record,
                    sampling,
                    propagators[0],
                )
            else:
                status = advance(
                    method, equations, inputs, end, x, limits, atol, step, watch, tangents, record
                )
            if status != DONE:
                return status
            limits[3] -= record.counts[STEPS] - taken
            write_here(equations, inputs, stops[index], x, watch.m, tangents, record)
        return DONE

    return run


@lru_cache(maxsize=3)
def runner(sampled: bool, lean: bool = False) -> Callable[..., int]:
    """The runner as `compiled_runner` makes it, when it is first needed: up to half a minute once
    on a new machine, or begun before by `compile_ahead`.
    """
    kernel = SAMPLED_RUNNER if sampled else LEAN_RUNNER if lean else RUNNER
    return made_once(kernel, lambda: compiled_runner(source_stamp(), sampled, lean))
