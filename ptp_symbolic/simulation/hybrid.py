"""The compiled runner: adaptive Runge-Kutta steps, located events, tangents through both.

One runner serves every model: the emitted functions come in as typed function pointers. Steps end
at every stop (sample of a held input, break of a profile). A mode that ends inside a step is found
on the step's interpolant, then by repeating the step itself until the landing point lies just past
the event. Tangents are the exact derivative of the accepted steps; at an event they jump (Aizerman
and Gantmacher, 1958).
"""

import numpy as np
from numba import njit, types

from ptp_symbolic.simulation import signatures
from ptp_symbolic.simulation.delays import jump_by_delay
from ptp_symbolic.simulation.inputs import evaluate_inputs
from ptp_symbolic.simulation.location import (
    TIME_RESOLUTION,
    first_violation,
    locate_event,
    record_switches,
    worst_element,
)
from ptp_symbolic.simulation.modes import (
    largest_violation,
    settle,
    violation,
    violation_gradient,
)
from ptp_symbolic.simulation.step import error_norm, fill_stages, flush, interpolate
from ptp_symbolic.simulation.tableau import STAGES, A, C
from ptp_symbolic.simulation.tangents import jump_tangents, push_tangents

DONE, DIVERGED, CHATTERING, TOO_MANY_STEPS = 0, 1, 2, 3
MAX_INSTANT_EVENTS = 100

_V, _M, _I = types.float64[::1], types.float64[:, ::1], types.int64[::1]
TABLE = types.Tuple((_V, _M, _I, _M, _I, _M, _I))


@njit(
    types.Tuple((types.int64, types.float64, types.int64, types.int64))(
        signatures.MODE_DERIVATIVE,
        signatures.JACOBIAN,
        signatures.GUARDS,
        signatures.GUARD_JACOBIAN,
        signatures.ENERGY,
        _V,  # x, changed in place
        _V,  # modes, changed in place
        _V,  # parameters
        _I,  # state index of the rate of every friction
        _I,  # per state the friction that zeroes it when it comes to rest, or -1
        TABLE,
        types.int64,  # number of inputs
        types.boolean,  # inputs are held between stops
        _V,  # stops, the first is the start
        _V,  # output times, increasing
        _M,  # out: states [times, n]
        _I,  # parameter columns of the tangents
        _I,  # per input the tangent column of its delay, or -1
        _M,  # tangents [n, ns], changed in place; ns = 0: none
        types.float64[:, :, ::1],  # out: tangents [times, n, ns]; output times must be stops
        types.float64[:, ::1],  # out: work [times, 3]: stored, supplied, dissipated; or no rows
        types.float64,  # rtol
        _V,  # atol
        types.float64,  # largest step
        types.float64[:, ::1],  # out: events [capacity, 3]: time, element, mode entered
    ),
    cache=True,
    nogil=True,
    error_model="numpy",
)
def integrate(
    derivative, jacobian, guards, guard_jacobian, energy, x, m, p, friction_rates, zero_at_rest,
    table, input_count, held, stops, output_times, out_x, columns, delay_column, s, out_s,
    out_energy, rtol, atol, largest_step, events,
):  # fmt: skip
    """Integrate from the first to the last stop; returns (status, time reached, events, steps)."""
    n, ns, np_ = len(x), s.shape[1], len(p)
    frictions = len(friction_rates)
    elements = frictions + (len(m) - frictions) // 2
    guard_count = 3 * frictions + 4 * (elements - frictions)
    k, stage = np.zeros((STAGES, n)), np.zeros((STAGES, n))
    weights, x_end, trial = np.zeros(STAGES), np.zeros(n), np.zeros(n)
    u_before = np.zeros(input_count)
    u, u_later = np.zeros(input_count), np.zeros(input_count)
    g, g_later = np.zeros(guard_count), np.zeros(guard_count)
    gx, gp = np.zeros((guard_count, n)), np.zeros((guard_count, np_))
    by_x, by_p, before, after = np.zeros(n), np.zeros(np_), np.zeros(n), np.zeros(n)
    fx, fu, fp = np.zeros((n, n)), np.zeros((n, input_count)), np.zeros((n, np_))
    work = (fx, fu, fp, np.zeros((STAGES, n, ns)), np.zeros((n, ns)))
    cursor = np.zeros(input_count, dtype=np.int64)
    m_before, powers, totals = np.zeros(len(m)), np.zeros(3), np.zeros(3)
    stage_powers = np.zeros((STAGES, 3))
    with_energy = out_energy.shape[0] > 0
    t, h = stops[0], largest_step
    output, event_count, steps, instant = 0, 0, 0, 0
    while output < len(output_times) and output_times[output] <= t:
        out_x[output] = x
        out_s[output] = s
        if with_energy:
            evaluate_inputs(t, 1, *table, cursor, u)
            energy(t, x, u, p, m, powers)
            out_energy[output, 0] = powers[0]
        output += 1
    for stop_index in range(1, len(stops)):
        stop = stops[stop_index]
        u_before[:] = u
        evaluate_inputs(t, 1, *table, cursor, u)
        if ns > 0 and stop_index > 1:
            jump_by_delay(derivative, t, x, u_before, u, p, m, delay_column, before, after, s)
        if elements > 0:
            guards(t, x, u, p, m, g)
            if largest_violation(x, m, g, friction_rates) > 0.0:
                m_before[:] = m
                if not settle(guards, t, x, u, p, m, g, friction_rates, zero_at_rest):
                    return CHATTERING, t, event_count, steps
                event_count = record_switches(
                    t, m_before, m, frictions, elements, events, event_count
                )
        derivative(t, x, u, p, m, k[0])
        while stop - t > TIME_RESOLUTION:
            remaining = stop - t
            h = min(h, largest_step)
            trial_h = remaining if h >= remaining else remaining / np.ceil(remaining / h)
            steps += 1
            stage[0] = x
            fill_stages(derivative, t, trial_h, x, u, p, m, table, cursor, held, k, stage)
            error = error_norm(trial_h, x, k, stage, rtol, atol)
            if not np.isfinite(error):
                error = 1e10
            if error > 1.0:
                h = trial_h * max(0.2, 0.9 * error**-0.2)
                if h < 1e-11:
                    return DIVERGED, t, event_count, steps
                continue
            grow = 5.0 if error < 1e-4 else min(5.0, 0.9 * error**-0.2)
            if grow > 1.0 or h <= trial_h:
                h = trial_h * grow
            step_h = trial_h
            ended = False
            if elements > 0:
                x_end[:] = stage[STAGES - 1]
                high = first_violation(
                    guards, t, step_h, x, k, u, p, m, table, cursor, held, g, friction_rates,
                    weights, trial, x_end,
                )  # fmt: skip
                if high > 0.0:
                    ended = True
                    step_h = locate_event(
                        derivative, guards, t, high * step_h, step_h, x, k, stage, u, p, m, table,
                        cursor, held, g, friction_rates, weights, trial,
                    )  # fmt: skip
            t_new = stop if (not ended and trial_h == remaining) else t + step_h
            if with_energy:
                for i in range(STAGES):
                    if not held:
                        side = 1 if C[i] < 1.0 else -1
                        evaluate_inputs(t + C[i] * step_h, side, *table, cursor, u)
                    energy(t + C[i] * step_h, stage[i], u, p, m, stage_powers[i])
            while output < len(output_times) and output_times[output] < t_new - TIME_RESOLUTION:
                fraction = (output_times[output] - t) / step_h
                interpolate(fraction, step_h, x, k, weights, out_x[output])
                if with_energy:
                    energy(output_times[output], out_x[output], u, p, m, powers)
                    out_energy[output, 0] = powers[0]
                    for c in range(1, 3):
                        gained = 0.0
                        for i in range(STAGES):
                            gained += weights[i] * stage_powers[i, c]
                        out_energy[output, c] = totals[c] + step_h * gained
                output += 1
            if ns > 0:
                push_tangents(
                    jacobian,
                    t,
                    step_h,
                    x,
                    u,
                    p,
                    m,
                    table,
                    cursor,
                    held,
                    stage,
                    columns,
                    delay_column,
                    s,
                    work,
                )
            if with_energy:
                for i in range(STAGES - 1):
                    totals[1] += step_h * A[STAGES - 1, i] * stage_powers[i, 1]
                    totals[2] += step_h * A[STAGES - 1, i] * stage_powers[i, 2]
            x[:] = stage[STAGES - 1]
            t = t_new
            if not ended:
                k[0] = k[STAGES - 1]
                instant = 0
                continue
            instant = instant + 1 if step_h < 1e-10 else 0
            if instant > MAX_INSTANT_EVENTS:
                return CHATTERING, t, event_count, steps
            evaluate_inputs(t, 1, *table, cursor, u)
            m_before[:] = m
            before[:] = k[STAGES - 1]
            by_time = 0.0
            if ns > 0:
                guards(t, x, u, p, m, g)
                element = worst_element(x, m, g, friction_rates, elements)
                guard_jacobian(t, x, u, p, m, gx, gp)
                violation_gradient(element, m, g, gx, gp, friction_rates, x, by_x, by_p)
                if not held:
                    ahead = 1e-7
                    evaluate_inputs(t + ahead, 1, *table, cursor, u_later)
                    guards(t, x, u_later, p, m, g_later)
                    by_time = (
                        violation(element, x, m, g_later, friction_rates)
                        - violation(element, x, m, g, friction_rates)
                    ) / ahead
            if not settle(guards, t, x, u, p, m, g, friction_rates, zero_at_rest):
                return CHATTERING, t, event_count, steps
            event_count = record_switches(t, m_before, m, frictions, elements, events, event_count)
            derivative(t, x, u, p, m, k[0])
            if ns > 0:
                after[:] = k[0]
                for a in range(n):
                    friction = zero_at_rest[a]
                    if friction >= 0 and m[friction] == 0.0 and m_before[friction] != 0.0:
                        s[a] = 0.0
                        before[a] = 0.0
                jump_tangents(before, after, by_time, by_x, by_p, columns, s)
                for f in range(frictions):
                    if m[f] == 0.0:
                        s[friction_rates[f]] = 0.0
        t = stop
        flush(x)
        if ns > 0:
            flush(s)
        while output < len(output_times) and output_times[output] <= t + TIME_RESOLUTION:
            out_x[output] = x
            out_s[output] = s
            if with_energy:
                energy(t, x, u, p, m, powers)
                out_energy[output] = totals
                out_energy[output, 0] = powers[0]
            output += 1
        for a in range(n):
            if not abs(x[a]) < 1e12:
                return DIVERGED, t, event_count, steps
    return DONE, t, event_count, steps
