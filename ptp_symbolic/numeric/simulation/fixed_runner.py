"""The second way to simulate: fixed steps that solve friction and contact implicitly.

It locates no events (time stepping). A step keeps its modes when they still hold at its end: then
it is the two-stage Rosenbrock method of Verwer et al. (SIAM J. Sci. Comput. 20, 1999), L-stable,
order 2 with any Jacobian. Otherwise it is repeated as a linearly implicit Euler step whose modes
are unknowns of a complementarity problem: one element after the other changes, and the linear
system is solved anew, until every mode fits the end (principal pivoting: Murty, Opsearch 11, 1974).

Rigid faces that have closed by the end of a step strike there, as speeds tell, not depth (Moreau,
1988); bodies whose next bounce would not outlast a step stay together.

Order 2 in smooth motion, 1 across mode changes: an event takes effect up to one step late or early.
A bounce shorter than a step is missed. Work per step is bounded, and nothing is allocated in it.
"""

from collections.abc import Callable
from functools import lru_cache

import numpy as np
from numba import njit, types

from ptp_symbolic.numeric.runtime.element_layout import contact_modes
from ptp_symbolic.numeric.simulation.ahead import FIXED_RUNNER, made_once
from ptp_symbolic.numeric.simulation.events.impacts import SETTLING, SPRUNG, fill_guards
from ptp_symbolic.numeric.simulation.events.modes import (
    is_finite,
    is_outside,
    largest_violation,
    settle,
    stop_at_bound,
)
from ptp_symbolic.numeric.simulation.input_values import evaluate_inputs
from ptp_symbolic.numeric.simulation.kernels.calls import call, place
from ptp_symbolic.numeric.simulation.kernels.records import (
    DIVERGED,
    DONE,
    INSTANT,
    INTEGERS,
    KERNEL,
    LARGEST_STATE,
    MACHINE_TYPES,
    MATRIX,
    OUTPUT,
    OUTSIDE,
    RECORD_TYPE,
    SMALLEST,
    SOURCES,
    STEPS,
    TANGENTS_TYPE,
    TIME,
    UNDECIDED,
    VECTOR,
    WATCH_TYPE,
    Inputs,
    Record,
    Watch,
    copy,
    equations_at,
    inlined,
    kernel,
    source_stamp,
)
from ptp_symbolic.numeric.simulation.methods.implicit_step import (
    StepWork,
    allow_all,
    choose_start_modes,
    correct_a_mode,
    fixed_mode_step,
    mode_finding_step,
)
from ptp_symbolic.numeric.simulation.outputs import note_strikes, note_switches
from ptp_symbolic.numeric.simulation.sampling import (
    SAMPLING,
    Sampling,
    next_stop,
    sample_now,
)

_V, _M, _I = VECTOR, MATRIX, INTEGERS
_WORK = types.Tuple((_M, _M, _M, _M, _I, _V, _V, _V, types.int64[:, ::1]))


@kernel
def take_step(equations, inputs, t, t_end, x, watch, tangents, work, record):
    """Step x [n] in place from t to t_end in s; inputs.ahead holds u at t. Returns a status."""
    record.clock[TIME] = t
    h, u, m, rigid = t_end - t, inputs.u, watch.m, is_rigid(equations.contacts)
    if not inputs.held:
        evaluate_inputs(t_end, -1, *inputs.table, inputs.cursor, u)
    fixed_mode_step(equations, t, h, x, inputs.ahead, u, m, work)
    if len(m) > 0 and not rigid and not find_modes(equations, t, h, x, u, watch, work, record):
        return UNDECIDED
    if not is_finite(work.end, LARGEST_STATE):
        return DIVERGED
    if is_outside(work.end, watch):
        stop_at_bound(t, h, x, work.end, watch, record.clock)
        return OUTSIDE
    if len(record.ledger) > 0:
        add_work(equations, t, t_end, x, inputs.ahead, u, m, work.end, record)
    if rigid and not land(equations, t_end, work.end, u, watch, tangents, record):
        return UNDECIDED
    for i in range(len(x)):
        x[i] = work.end[i] if abs(work.end[i]) > SMALLEST else 0.0
    copy(u, inputs.ahead)
    record.counts[STEPS] += 1
    return DONE


@inlined
def find_modes(equations, t, h, x, u, watch, work, record):
    """Repeat a step whose modes do not fit its end in consistent modes; False if none are found."""
    m, rates = watch.m, equations.friction_rates
    call(equations.guards, t + h, work.end, u, equations.p, m, watch.g)
    copy(m, watch.m_before)
    allow_all(work.refused)
    if not correct_a_mode(work.end, m, watch.g, rates, work.refused):
        return True
    copy(watch.m_before, m)
    sweeps = mode_finding_step(equations, t, h, x, u, watch, work)
    if sweeps == 0:
        return False
    record.counts[INSTANT] = max(record.counts[INSTANT], sweeps)
    note_switches(t + h, m, watch.m_before, len(rates), equations.contacts, record)
    return True


@inlined
def is_rigid(contacts):
    """Whether any contact [c, 5] is rigid."""
    found = False
    for contact in range(len(contacts)):
        found = found or contacts[contact, 2] != SPRUNG
    return found


@inlined
def land(equations, t, x, u, watch, tangents, record):
    """Apply the impacts of faces that have closed by t, and switch modes; False on chattering.

    Faces that have let go and approach again before the gap has opened would bounce for ever (Zeno
    behaviour): they meet without restitution.
    """
    m, frictions, contacts = watch.m, len(equations.friction_rates), equations.contacts
    fill_guards(equations, t, x, u, watch)
    if largest_violation(x, m, watch.g, equations.friction_rates) <= 0.0:
        return True
    for contact in range(len(contacts)):
        contacts[contact, SETTLING] = 1 if m[contact_modes(frictions, contact)] != 0.0 else 0
    copy(m, watch.m_before)
    if not settle(equations, t, x, u, watch, tangents):
        return False
    note_switches(t, m, watch.m_before, frictions, contacts, record)
    note_strikes(watch, record)
    return True


@inlined
def take_steps(equations, inputs, begin, end, step, x, watch, tangents, work, record):
    """Go from begin to end in s in equal steps of at most `step` s. Returns a status."""
    count = max(1, int(np.ceil((end - begin) / step - 1e-9)))
    h = (end - begin) / count
    for index in range(count):
        t = begin + index * h
        t_end = end if index + 1 == count else begin + (index + 1) * h
        status = take_step(equations, inputs, t, t_end, x, watch, tangents, work, record)
        if status != DONE:
            return status
    return DONE


@inlined
def add_work(equations, t, t_end, x, u, u_end, m, end, record):
    """Add the work in J of the step, by the trapezoidal rule over the powers at its ends."""
    call(equations.energy, t, x, u, equations.p, m, record.powers[0])
    call(equations.energy, t_end, end, u_end, equations.p, m, record.powers[1])
    for c in range(1, 3):
        record.totals[c] += 0.5 * (t_end - t) * (record.powers[0, c] + record.powers[1, c])


@inlined
def write_output(equations, t, x, u, m, record):
    """Write state [n] and ledger [3] in J at t."""
    output = record.counts[OUTPUT]
    copy(x, record.x[output])
    if len(record.ledger) > 0:
        call(equations.energy, t, x, u, equations.p, m, record.ledger[output])
        record.ledger[output, 1] = record.totals[1]
        record.ledger[output, 2] = record.totals[2]
    record.counts[OUTPUT] = output + 1


@inlined
def begin_modes(equations, t, x, u, watch, tangents, work, record):
    """Find consistent modes of the initial state [n]; False when none fit."""
    if is_rigid(equations.contacts):
        return land(equations, t, x, u, watch, tangents, record)
    return choose_start_modes(equations, t, x, u, watch, work)


def compiled_runner(sources: int) -> Callable[..., int]:
    """The compiled runner, stamped with the `sources` it comes from (see `source_stamp`)."""

    @njit(
        types.int64(
            *MACHINE_TYPES,
            _M,  # inputs: at the end and at the start of a step [2, nu]
            _V,  # x, changed in place
            types.float64,  # longest step in s: every interval is cut into equal ones
            WATCH_TYPE,
            TANGENTS_TYPE,
            _WORK,
            RECORD_TYPE,
            SAMPLING,
        ),
        cache=True,
        **KERNEL,
    )
    def run_fixed(
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
        step,
        watch,
        tangents,
        work,
        record,
        sampling,
    ):
        """Integrate from the first to the last output time; inputs jump at no other time."""
        record = place(Record(*record))
        record.counts[SOURCES] = sources
        equations = place(
            equations_at(functions, p, prepared, friction_rates, zero_at_rest, contacts)
        )
        inputs, work = place(Inputs(table, cursor, held, u[0], u[1])), place(StepWork(*work))
        watch, tangents, sampling = place(Watch(*watch)), None, place(Sampling(*sampling))
        m, times = watch.m, record.times
        record.clock[TIME] = times[0]
        if is_outside(x, watch):
            return OUTSIDE
        for interval in range(len(times)):
            begin = times[interval]
            evaluate_inputs(begin, 1, *inputs.table, inputs.cursor, inputs.ahead)
            sample_now(equations, inputs.ahead, begin, x, m, sampling)
            if interval == 0 and not begin_modes(
                equations, begin, x, inputs.ahead, watch, tangents, work, record
            ):
                return UNDECIDED
            write_output(equations, begin, x, inputs.ahead, m, record)
            if interval + 1 == len(times):
                break
            copy(inputs.ahead, inputs.u)
            while begin < times[interval + 1]:
                if begin > times[interval]:
                    sample_now(equations, inputs.ahead, begin, x, m, sampling)
                end = next_stop(times[interval + 1], sampling)
                status = take_steps(
                    equations, inputs, begin, end, step, x, watch, tangents, work, record
                )
                if status != DONE:
                    return status
                begin = end
        record.clock[TIME] = times[-1]
        return DONE

    return run_fixed


@lru_cache(maxsize=1)
def runner() -> Callable[..., int]:
    """The runner, compiled when it is first needed, or begun before by `compile_ahead`."""
    return made_once(FIXED_RUNNER, lambda: compiled_runner(source_stamp()))
