"""The compiled runner: adaptive steps by either method, located events, tangents through both.

One runner serves every model: the emitted functions come in as typed function pointers. Steps end
at every stop (sample of a zero-order hold, break of a profile) and where a sampler is due. An event
inside a step is bracketed on the dense output, then located by repeating the step itself until its
end lies just past the event. The step length is carried over stops and events.
"""

from collections.abc import Callable
from functools import lru_cache

from numba import njit, types

from ptp_symbolic.numeric.simulation.ahead import note_compiled, wait_until_compiled
from ptp_symbolic.numeric.simulation.events.crossing import jump_by_delay
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
    INTEGERS,
    KERNEL,
    LARGEST_STATE,
    LENGTH,
    MACHINE_TYPES,
    MATRIX,
    OUTSIDE,
    RECORD_TYPE,
    SOURCES,
    STEP_TYPE,
    STEPS,
    TANGENTS_TYPE,
    TIME,
    TOO_FAST,
    VECTOR,
    WATCH_TYPE,
    Inputs,
    Record,
    Step,
    Tangents,
    Watch,
    copy,
    equations_at,
    merged,
    source_stamp,
)
from ptp_symbolic.numeric.simulation.methods.exponential_step import (
    PROPAGATOR,
    Propagator,
    reach_sample,
)
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
from ptp_symbolic.numeric.simulation.sampling import (
    SAMPLING,
    Sampling,
    is_due,
    next_stop,
    sample_at,
)
from ptp_symbolic.numeric.simulation.signals.input_values import evaluate_inputs

SHORTEST = 1e-11  # s

_V, _M, _I = VECTOR, MATRIX, INTEGERS


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
    plain = method == ROSENBROCK and inputs.held
    plain = plain and tangents.table.shape[1] == 0 and len(record.ledger) == 0
    while True:
        target = next_stop(stop, sampling)
        if not plain or not reach_sample(
            equations, inputs, target, x, limits, atol, step, watch, record, propagator
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


def compiled_runner(sources: int, sampled: bool) -> Callable[..., int]:
    """The compiled runner for machines with samplers (`sampled`), or for those without, which takes
    a third less time; stamped with the `sources` it comes from (see `source_stamp`).
    """

    @njit(
        types.int64(
            types.int64,  # method
            *MACHINE_TYPES,
            _M,  # inputs: now, ahead, before [3, nu]
            _V,  # x, changed in place
            _V,  # stops, the first is the start
            _V,  # rtol, largest step, most steps
            _V,  # atol
            STEP_TYPE,
            WATCH_TYPE,
            TANGENTS_TYPE,
            RECORD_TYPE,
            SAMPLING,
            PROPAGATOR,
        ),
        cache=True,
        **KERNEL,
    )
    def run(
        method,
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
        propagator,
    ):
        """Integrate from the first to the last stop; returns a status, the rest is in `record`."""
        record = Record(*record)
        record.counts[SOURCES] = sources
        equations = equations_at(functions, p, prepared, friction_rates, zero_at_rest, contacts)
        inputs, step, watch = Inputs(table, cursor, held, u[0], u[1]), Step(*step), Watch(*watch)
        tangents, sampling = Tangents(*tangents), Sampling(*sampling)
        propagator = Propagator(*propagator)
        record.clock[TIME], record.clock[LENGTH] = stops[0], limits[1]
        if sampled and is_due(stops[0], sampling):
            sample_at(equations, inputs, stops[0], x, watch.m, tangents, sampling)
        evaluate_inputs(stops[0], 1, *inputs.table, inputs.cursor, inputs.u)
        write_here(equations, inputs, stops[0], x, watch.m, tangents, record)
        for index in range(1, len(stops)):
            copy(inputs.u, u[2])
            evaluate_inputs(stops[index - 1], 1, *inputs.table, inputs.cursor, inputs.u)
            if tangents.table.shape[1] > 0 and index > 1:
                jump_by_delay(equations, inputs, stops[index - 1], x, u[2], watch, tangents)
            if not enter(equations, inputs, stops[index - 1], x, watch, tangents, record):
                return CHATTERING
            end = stops[index]
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
                    propagator,
                )
            else:
                status = advance(
                    method, equations, inputs, end, x, limits, atol, step, watch, tangents, record
                )
            if status != DONE:
                return status
            write_here(equations, inputs, stops[index], x, watch.m, tangents, record)
        return DONE

    return run


@lru_cache(maxsize=2)
def runner(sampled: bool) -> Callable[..., int]:
    """The runner for machines with samplers (`sampled`) or without, compiled when it is first
    needed: about a minute once on a new machine, or begun before by `compile_ahead`.
    """
    wait_until_compiled(sampled)
    run = compiled_runner(source_stamp(), sampled)
    note_compiled(sampled)
    return run
