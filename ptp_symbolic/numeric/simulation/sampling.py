"""Samplers at run time: when the next one is due, what it sets, and how the tangents jump.

At one instant the inputs jump first, then the samplers that are due run in order, each after what
those before it have set, then friction and contact find their modes. Outputs at that instant show
what holds after it.

From sample to sample of inputs that are held, by exponential steps, as far as they reach.

A compiled function of its own, which `hybrid` calls by its address: the two are compiled side by
side. The explicit method shares nothing with it, so that each checks the other.
"""

from collections.abc import Callable
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from numba import njit, types
from numba.core import cgutils
from numba.extending import intrinsic
from numpy.typing import NDArray

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.ahead import HELD_SAMPLES, made_once
from ptp_symbolic.numeric.simulation.events.crossing import jump_by_delay
from ptp_symbolic.numeric.simulation.events.impacts import derivative
from ptp_symbolic.numeric.simulation.events.modes import fill_violations
from ptp_symbolic.numeric.simulation.input_values import (
    evaluate_input_slopes,
    evaluate_inputs,
)
from ptp_symbolic.numeric.simulation.kernels.calls import call, placed, sampler_addresses
from ptp_symbolic.numeric.simulation.kernels.records import (
    EQUATIONS_TYPE,
    INNER,
    INPUTS_TYPE,
    INTEGERS,
    MATRIX,
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
    copy,
    inlined,
    kernel,
    source_stamp,
)
from ptp_symbolic.numeric.simulation.methods.exponential_step import (
    LENGTHS,
    PROPAGATOR,
    Propagator,
    of_length,
    reach_sample,
)
from ptp_symbolic.numeric.simulation.outputs import write_here

FloatArray = NDArray[np.float64]


MOST_SAMPLES = 1e7
COINCIDENT = 1e-12  # s; instants that are closer are one
PERIOD, OFFSET, PHASE, TIMING = 0, 1, 2, 3

_V, _M, _I = VECTOR, MATRIX, INTEGERS
SAMPLING = types.Tuple((_I, _I, _I, _V, _I, _I, _V, _M, _M, _M, _V, _M, _V, _V, _V))


class Sampling(NamedTuple):
    """The samplers [s] of a model and where they are.

    functions [2]: addresses of `sample` and `sample_jacobian`; owner, target [r]: sampler and state
    of every update; due [s] in s: next instant; count [s]: periods begun; armed [s]: 1 between the
    start of a period and a later instant in it; z [3 s + r], zx, zu, zp: what `sample` writes, and
    its Jacobians; shift [ns]: derivative of the instant by what the tangents are by; rows [r, ns]:
    new tangents of the updated states; before, after [n]: dx/dt; slopes [nu]: du/dt.
    """

    functions: Any
    owner: Any
    target: Any
    due: Any
    count: Any
    armed: Any
    z: Any
    zx: Any
    zu: Any
    zp: Any
    shift: Any
    rows: Any
    before: Any
    after: Any
    slopes: Any


def new_sampling(
    model: Model, p: FloatArray, x: FloatArray, times: FloatArray, ns: int
) -> Sampling:
    """The samplers of `model` at p [np] and x [n] before the first of `times` [k] in s, with room
    for `ns` tangents.

    Raises InputError for a sampling time that is not positive, longer than the run, or so short
    that there are more than MOST_SAMPLES instants.
    """
    samplers, rows, n, nu = (
        len(model.sampler_periods),
        len(model.sampled),
        len(x),
        len(model.input_names),
    )
    size, real, whole = TIMING * samplers + rows, np.zeros, np.zeros(samplers, np.int64)
    functions = sampler_addresses(model.module) if samplers else np.zeros(2, np.int64)
    made = Sampling(
        functions,
        np.ascontiguousarray(model.sampled[:, 0]),
        np.ascontiguousarray(model.sampled[:, 1]),
        real(samplers),
        whole,
        whole.copy(),
        real(size),
        real((size, n)),
        real((size, nu)),
        real((size, len(p))),
        real(ns),
        real((rows, ns)),
        real(n),
        real(n),
        real(nu),
    )
    if samplers:
        model.module.sample(times[0], x, real(nu), p, real(len(model.mode_names)), made.z)
    for i, names in enumerate(model.sampler_periods):
        period, offset = made.z[TIMING * i + PERIOD], made.z[TIMING * i + OFFSET]
        duration = times[-1] - times[0]
        if not 0.0 < period <= duration or duration / period > MOST_SAMPLES:
            raise InputError(
                f"Sampling time {period:g} s ({', '.join(names)}) in a run of {duration:g} s; give"
                f" a positive time, at most that of the run and at most {MOST_SAMPLES:g} samples."
            )
        made.count[i] = max(0, np.ceil((times[0] - offset - COINCIDENT) / period))
        made.due[i] = offset + made.count[i] * period
    return made


@inlined
def next_stop(stop, sampling):
    """The earlier of `stop` and the next sampling instant, in s."""
    earliest = stop
    for i in range(len(sampling.due)):
        earliest = min(earliest, sampling.due[i])
    return earliest if earliest < stop - COINCIDENT else stop


@inlined
def is_due(t, sampling):
    """Whether some sampler has an instant at t in s."""
    found = False
    for i in range(len(sampling.due)):
        found = found or sampling.due[i] <= t + COINCIDENT
    return found


@inlined
def sample_at(equations, inputs, t, x, m, tangents, sampling):
    """Run every sampler that is due at t in s, and apply its saltation to the tangents, if any.

    inputs.u is as before t, inputs.ahead will be as after it.
    """
    evaluate_inputs(t, 1, *inputs.table, inputs.cursor, inputs.ahead)
    if tangents.table.shape[1] == 0:
        sample_now(equations, inputs.ahead, t, x, m, sampling)
    else:
        sample_with_tangents(equations, inputs, t, x, m, tangents, sampling)


@kernel
def sample_now(equations, u, t, x, m, sampling):
    """Run every sampler that is due at t in s, with inputs u [nu] after a jump there."""
    for i in range(len(sampling.due)):
        if sampling.due[i] <= t + COINCIDENT and _comes(i, equations, u, t, x, m, sampling):
            _set_states(i, x, sampling)


@kernel
def sample_with_tangents(equations, inputs, t, x, m, tangents, sampling):
    """Run every sampler due at t in s, and apply its saltation to the tangents; see `sample_at`."""
    for i in range(len(sampling.due)):
        if sampling.due[i] > t + COINCIDENT:
            continue
        if not _comes(i, equations, inputs.ahead, t, x, m, sampling):
            continue
        call(
            sampling.functions[1],
            t,
            x,
            inputs.ahead,
            equations.p,
            m,
            sampling.zx,
            sampling.zu,
            sampling.zp,
        )
        moves = _fill_shift(i, tangents, sampling)
        if not inputs.held:
            evaluate_inputs(t, -1, *inputs.table, inputs.cursor, inputs.u)
        derivative(equations, t, x, inputs.u, m, sampling.before)
        _fill_rows(i, inputs, t, tangents, sampling)
        _set_states(i, x, sampling)
        if moves:
            derivative(equations, t, x, inputs.ahead, m, sampling.after)
        _jump(i, moves, tangents, sampling)


@inlined
def _comes(i, equations, u, t, x, m, sampling):
    """Whether sampler i, due at t, sets its states now; else it waits for what is next."""
    z, at = sampling.z, TIMING * i
    call(sampling.functions[0], t, x, u, equations.p, m, z)
    if sampling.armed[i] == 1:
        return True
    phase = z[at + PHASE]
    if phase >= 1.0:
        sampling.count[i] += 1
        sampling.due[i] = z[at + OFFSET] + sampling.count[i] * z[at + PERIOD]
        return False
    if phase * z[at + PERIOD] > COINCIDENT:
        sampling.armed[i] = 1
        sampling.due[i] = z[at + OFFSET] + (sampling.count[i] + phase) * z[at + PERIOD]
        return False
    return True


@inlined
def _set_states(i, x, sampling):
    """Set the states of sampler i, and go on to its next period."""
    at, rows = TIMING * i, TIMING * len(sampling.due)
    for r in range(len(sampling.owner)):
        if sampling.owner[r] == i:
            x[sampling.target[r]] = sampling.z[rows + r]
    sampling.armed[i] = 0
    sampling.count[i] += 1
    sampling.due[i] = sampling.z[at + OFFSET] + sampling.count[i] * sampling.z[at + PERIOD]


@inlined
def _fill_shift(i, tangents, sampling):
    """Write the derivative of the instant; False when it is zero throughout."""
    at, s, columns, z = TIMING * i, tangents.table, tangents.columns, sampling.z
    periods, moves = sampling.count[i] + max(z[at + PHASE], 0.0), False
    for c in range(s.shape[1]):
        shift = 0.0
        if c < len(columns):
            j = columns[c]
            shift = sampling.zp[at + OFFSET, j] + periods * sampling.zp[at + PERIOD, j]
            shift += z[at + PERIOD] * sampling.zp[at + PHASE, j]
        for a in range(s.shape[0]):
            shift += z[at + PERIOD] * sampling.zx[at + PHASE, a] * s[a, c]
        sampling.shift[c] = shift
        moves = moves or shift != 0.0
    return moves


@inlined
def _fill_rows(i, inputs, t, tangents, sampling):
    """Write the tangents of what sampler i is about to set."""
    s, columns, first = tangents.table, tangents.columns, TIMING * len(sampling.due)
    evaluate_input_slopes(t, 1, *inputs.table, inputs.cursor, sampling.slopes)
    for r in range(len(sampling.owner)):
        if sampling.owner[r] != i:
            continue
        for c in range(s.shape[1]):
            shift = sampling.shift[c]
            total = sampling.zp[first + r, columns[c]] if c < len(columns) else 0.0
            for a in range(s.shape[0]):
                total += sampling.zx[first + r, a] * (s[a, c] + sampling.before[a] * shift)
            for j in range(len(sampling.slopes)):
                late = 1.0 if tangents.delay_column[j] == c else 0.0
                total += sampling.zu[first + r, j] * sampling.slopes[j] * (shift - late)
            sampling.rows[r, c] = total


@inlined
def _jump(i, moves, tangents, sampling):
    """Put the new tangents in; other states jump when the instant moves, as at any event."""
    s = tangents.table
    if moves:
        for a in range(s.shape[0]):
            for c in range(s.shape[1]):
                s[a, c] += (sampling.before[a] - sampling.after[a]) * sampling.shift[c]
    for r in range(len(sampling.owner)):
        if sampling.owner[r] == i:
            copy(sampling.rows[r], s[sampling.target[r]])


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
    types.UniTuple(placed(Propagator, PROPAGATOR), LENGTHS),
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
        propagators,
    ):
        """Go on from the stop `index`; returns that of the stop where something else is needed."""
        record.counts[SOURCES] = sources
        while index < len(stops) - 1 and record.counts[STEPS] < limits[2]:
            t = stops[index]
            copy(inputs.u, inputs.ahead)
            evaluate_inputs(t, 1, *inputs.table, inputs.cursor, inputs.u)
            jump_by_delay(equations, inputs, t, x, inputs.ahead, watch, tangents)
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
                propagators[of_length(stops[index + 1] - t, propagators)],
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
