"""From sample to sample of inputs that are held, by exponential steps, as far as they reach.

A compiled function of its own, which `hybrid` calls by its address: the two are compiled side by
side. The explicit method shares nothing with it, so that each checks the other.
"""

from collections.abc import Callable
from functools import lru_cache
from typing import Any

from numba import njit, types
from numba.core import cgutils
from numba.extending import intrinsic

from ptp_symbolic.numeric.simulation.ahead import HELD_SAMPLES, made_once
from ptp_symbolic.numeric.simulation.events.location import fill_violations
from ptp_symbolic.numeric.simulation.kernels.by_address import placed
from ptp_symbolic.numeric.simulation.kernels.records import (
    EQUATIONS_TYPE,
    INNER,
    INPUTS_TYPE,
    RECORD_TYPE,
    SOURCES,
    STEP_TYPE,
    STEPS,
    TANGENTS_TYPE,
    VECTOR,
    WATCH_TYPE,
    Equations,
    Inputs,
    Record,
    Step,
    Tangents,
    Watch,
    source_stamp,
)
from ptp_symbolic.numeric.simulation.methods.exponential_step import reach_sample
from ptp_symbolic.numeric.simulation.methods.propagator import PROPAGATOR, Propagator
from ptp_symbolic.numeric.simulation.outputs import write_here
from ptp_symbolic.numeric.simulation.signals.input_values import evaluate_inputs

SIGNATURE = types.int64(
    types.int64,  # index of the stop where it begins
    placed(Equations, EQUATIONS_TYPE),
    placed(Inputs, INPUTS_TYPE),
    VECTOR,  # x, changed in place
    VECTOR,  # stops
    VECTOR,  # rtol, largest step, most steps
    VECTOR,  # atol
    placed(Step, STEP_TYPE),
    placed(Watch, WATCH_TYPE),
    placed(Tangents, TANGENTS_TYPE),
    placed(Record, RECORD_TYPE),
    placed(Propagator, PROPAGATOR),
)


def compiled_loop(sources: int) -> Callable[..., int]:
    """The compiled loop, stamped with the `sources` it comes from (see `source_stamp`)."""

    @njit(SIGNATURE, cache=True, **INNER)
    def reach_samples(
        index,
        equations,
        inputs,
        x,
        stops,
        limits,
        atol,
        step,
        watch,
        tangents,
        record,
        propagator,
    ):
        """Go on from the stop `index`; returns that of the stop where something else is needed."""
        record.counts[SOURCES] = sources
        while index < len(stops) - 1 and record.counts[STEPS] < limits[2]:
            t = stops[index]
            evaluate_inputs(t, 1, *inputs.table, inputs.cursor, inputs.u)
            if fill_violations(equations, inputs, t, x, watch, watch.at_start) > 0.0:
                break
            if not reach_sample(
                equations,
                inputs,
                stops[index + 1],
                x,
                limits,
                atol,
                step,
                watch,
                tangents,
                record,
                propagator,
            ):
                break
            index += 1
            write_here(equations, inputs, stops[index], x, watch.m, tangents, record)
        return index

    return reach_samples


@lru_cache(maxsize=1)
def loop() -> Callable[..., int]:
    """The loop, compiled when it is first needed, or begun before by `compile_ahead`."""
    return made_once(HELD_SAMPLES, lambda: compiled_loop(source_stamp()))


@lru_cache(maxsize=1)
def loop_address() -> int:
    """Address of the compiled loop, which `loop` keeps alive."""
    compiled = loop().get_compile_result(SIGNATURE)  # type: ignore[attr-defined]
    return int(compiled.library.get_pointer_to_function(compiled.fndesc.llvm_func_name))


@intrinsic
def reach_samples_at(typing_context: Any, address: Any, *arguments: Any) -> Any:
    """Call the compiled loop at `address` with arguments of its `SIGNATURE`."""

    def generate(context: Any, builder: Any, _: Any, values: Any) -> Any:
        result, wanted = SIGNATURE.return_type, SIGNATURE.args
        pointer_type = context.call_conv.get_function_type(result, wanted).as_pointer()
        function = builder.inttoptr(values[0], pointer_type)
        given = cgutils.unpack_tuple(builder, values[1])
        _, index = context.call_conv.call_function(builder, function, result, wanted, given)
        return index

    return SIGNATURE.return_type(address, types.StarArgTuple(arguments)), generate
