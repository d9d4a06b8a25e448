"""The compiled runner: adaptive steps by either method, located events, tangents through both.

One runner serves every model: the emitted functions come in as typed function pointers. Steps end
at every stop (sample of a zero-order hold, break of a profile) and where a sampler is due. Where
inputs stand still from stop to stop, exponential steps go as far as they can (`held_samples`).
"""

from collections.abc import Callable
from functools import lru_cache

from numba import njit, types

from ptp_symbolic.numeric.simulation.advance import advance, advance_by_samples
from ptp_symbolic.numeric.simulation.ahead import (
    RUNNER,
    SAMPLED_RUNNER,
    made_once,
)
from ptp_symbolic.numeric.simulation.events.crossing import jump_by_delay
from ptp_symbolic.numeric.simulation.events.transition import enter
from ptp_symbolic.numeric.simulation.held_samples import reach_samples_at
from ptp_symbolic.numeric.simulation.kernels.records import (
    CHATTERING,
    DONE,
    KERNEL,
    LENGTH,
    RUN_TYPES,
    SOURCES,
    TIME,
    Inputs,
    Record,
    Step,
    Tangents,
    Watch,
    copy,
    equations_at,
    source_stamp,
)
from ptp_symbolic.numeric.simulation.methods.propagator import PROPAGATOR, Propagator
from ptp_symbolic.numeric.simulation.outputs import write_here
from ptp_symbolic.numeric.simulation.sampling import (
    SAMPLING,
    Sampling,
    is_due,
    sample_at,
)
from ptp_symbolic.numeric.simulation.signals.input_values import evaluate_inputs


def compiled_runner(sources: int, sampled: bool) -> Callable[..., int]:
    """The compiled runner for machines with samplers (`sampled`), or for those without, which takes
    a third less time; stamped with the `sources` it comes from (see `source_stamp`).
    """

    @njit(
        types.int64(
            types.int64,  # method
            types.int64,  # address of the loop over held samples, or 0
            *RUN_TYPES,
            SAMPLING,
            PROPAGATOR,
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
        propagator,
    ):
        """Integrate from the first to the last stop; returns a status, the rest is in `record`."""
        work = step, watch, tangents, record
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
        index = 0
        while index < len(stops) - 1:
            if samples != 0:
                index = reach_samples_at(
                    samples,
                    index,
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
                    *work,
                    propagator,
                )
                if index == len(stops) - 1:
                    return DONE
            index += 1
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
    needed: half a minute once on a new machine, or begun before by `compile_ahead`.
    """
    kernel = SAMPLED_RUNNER if sampled else RUNNER
    return made_once(kernel, lambda: compiled_runner(source_stamp(), sampled))
