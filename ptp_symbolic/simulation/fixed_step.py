"""The second way to simulate: fixed steps that solve friction and contact implicitly.

It locates no events. A step keeps its modes when they still hold at its end: then it is the
two-stage Rosenbrock method of Verwer et al. (SIAM J. Sci. Comput. 20, 1999), L-stable, order 2 with
any Jacobian. Otherwise it is repeated as a linearly implicit Euler step whose modes are unknowns:
one element after the other changes, and the linear system is solved anew, until every mode fits the
end of the step (Murty, Opsearch 11, 1974; time stepping after Moreau, 1988).

Order 2 in smooth motion, 1 across mode changes: an event takes effect up to one step late or early.
A bounce shorter than a step is missed. Work per step is bounded, and nothing is allocated in it.
"""

from dataclasses import dataclass

import numpy as np
from numba import njit, types
from numpy.typing import NDArray

from ptp_symbolic.errors import InputError
from ptp_symbolic.runtime.model import Model
from ptp_symbolic.simulation import signatures
from ptp_symbolic.simulation.implicit_step import (
    choose_start_modes,
    correct_a_mode,
    fixed_mode_step,
    mode_finding_step,
)
from ptp_symbolic.simulation.input_values import evaluate_inputs
from ptp_symbolic.simulation.inputs import InputTable

FloatArray = NDArray[np.float64]

DONE, DIVERGED, UNDECIDED = 0, 1, 2
MOST_STEPS = 1e9
NEGLIGIBLE = 1e-60  # flushed to zero, as denormal numbers are slow

_V, _M, _I = types.float64[::1], types.float64[:, ::1], types.int64[::1]


@njit(
    types.Tuple((types.int64, types.float64, types.int64, types.int64))(
        signatures.MODE_DERIVATIVE,
        signatures.JACOBIAN,
        signatures.GUARDS,
        _V,  # x, changed in place
        _V,  # modes, written
        _V,  # parameters
        _I,  # state index of the rate of every friction
        _I,  # per state the friction that sets it to zero when it comes to rest, or -1
        types.Tuple((_V, _M, _I, _M, _I, _M, _I)),  # the input table
        types.int64,  # number of inputs
        types.boolean,  # inputs are held between times
        _V,  # times, increasing; inputs jump at no other time
        types.float64,  # step in s: every interval is cut into equal steps of at most this length
        _M,  # out: states [times, n]
        _M,  # out: modes [times, modes]
    ),
    cache=True,
    nogil=True,
    error_model="numpy",
)
def integrate_fixed(
    derivative, jacobian, guards, x, m, p, friction_rates, zero_at_rest, table, input_count, held,
    times, step, out_x, out_m,
):  # fmt: skip
    """Integrate from the first to the last time.

    Returns (status, time reached in s, steps, most mode sets tried in one step).
    """
    n, frictions = len(x), len(friction_rates)
    contacts = (len(m) - frictions) // 2
    fx, fu, fp = np.zeros((n, n)), np.zeros((n, input_count)), np.zeros((n, len(p)))
    work = (fx, fu, fp, np.zeros((n, n)), np.zeros(n, dtype=np.int64))
    k1, k2, end, was = np.zeros(n), np.zeros(n), np.zeros(n), np.zeros(len(m))
    g = np.zeros(3 * frictions + 4 * contacts)
    refused = np.zeros((frictions, 2), dtype=np.bool_)
    u_start, u_end = np.zeros(input_count), np.zeros(input_count)
    cursor = np.zeros(input_count, dtype=np.int64)
    steps, most_sweeps = 0, 0
    evaluate_inputs(times[0], 1, *table, cursor, u_start)
    if not choose_start_modes(guards, times[0], x, u_start, p, m, g, friction_rates, refused):
        return UNDECIDED, times[0], steps, most_sweeps
    out_x[0] = x
    out_m[0] = m
    for interval in range(1, len(times)):
        begin, length = times[interval - 1], times[interval] - times[interval - 1]
        count = max(1, int(np.ceil(length / step - 1e-9)))
        h = length / count
        evaluate_inputs(begin, 1, *table, cursor, u_start)
        u_end[:] = u_start
        for index in range(count):
            t = begin + index * h
            t_end = begin + (index + 1) * h if index + 1 < count else times[interval]
            if not held:
                evaluate_inputs(t_end, -1, *table, cursor, u_end)
            fixed_mode_step(
                derivative, jacobian, t, h, x, u_start, u_end, p, m, friction_rates, work, k1, k2,
                end,
            )  # fmt: skip
            if len(g) > 0:
                guards(t_end, end, u_end, p, m, g)
                was[:] = m
                refused[:] = False
                if correct_a_mode(end, m, g, friction_rates, refused):
                    m[:] = was
                    sweeps = mode_finding_step(
                        derivative, jacobian, guards, t, h, x, u_end, p, m, friction_rates,
                        zero_at_rest, work, k1, g, was, refused, end,
                    )  # fmt: skip
                    if sweeps == 0:
                        return UNDECIDED, t, steps, most_sweeps
                    most_sweeps = max(most_sweeps, sweeps)
            for i in range(n):
                if not abs(end[i]) < 1e12:
                    return DIVERGED, t, steps, most_sweeps
                x[i] = end[i] if abs(end[i]) > NEGLIGIBLE else 0.0
            u_start[:] = u_end
            steps += 1
        out_x[interval] = x
        out_m[interval] = m
    return DONE, times[-1], steps, most_sweeps


@dataclass(frozen=True, eq=False)
class FixedStepTrajectory:
    """States x [k, n] and modes [k, modes] at times t [k] in s.

    steps: how many were taken; most_sweeps: the most mode sets that one of them tried.
    """

    t: FloatArray
    x: FloatArray
    modes: FloatArray
    steps: int
    most_sweeps: int


def simulate_fixed_step(
    model: Model,
    times: FloatArray,
    inputs: InputTable,
    start: FloatArray,
    parameters: FloatArray,
    step: float,
) -> FixedStepTrajectory:
    """Simulate `model` in steps of at most `step` s; the result is at the given times [k] in s.

    start [n] and parameters [np] are in the order of the model. Every output time and every jump
    of an input is the end of a step, so the steps between two of them are equal and at most `step`
    long. Raises InputError for a step that is no positive time, when the state diverges, and when
    no set of modes fits a step.
    """
    if not 0.0 < step < np.inf or (times[-1] - times[0]) / step > MOST_STEPS:
        raise InputError(
            f"Step {step:g} s for {times[-1] - times[0]:g} s; give a positive number of seconds"
            f" that makes at most {MOST_STEPS:g} steps."
        )
    inner = inputs.stops[(inputs.stops > times[0]) & (inputs.stops < times[-1])]
    grid = np.unique(np.concatenate([times, inner]))
    x, m = np.array(start, dtype=np.float64), np.zeros(len(model.mode_names))
    out_x, out_m = np.zeros((len(grid), len(x))), np.zeros((len(grid), len(m)))
    status, reached, steps, most_sweeps = integrate_fixed(
        model.module.mode_derivative, model.module.jacobian, model.module.guards, x, m, parameters,
        model.friction_rates, model.zero_at_rest, inputs.arrays, len(model.input_names), False,
        grid, float(step), out_x, out_m,
    )  # fmt: skip
    if status != DONE:
        state = ", ".join(f"{n} {v:.3g}" for n, v in zip(model.state_names, x, strict=True))
        why = {
            DIVERGED: "the state diverges; check inputs and parameters or take a smaller step",
            UNDECIDED: "no set of modes fits the end of the step; take a smaller step",
        }[status]
        raise InputError(f"Stopped at {reached:.6g} s with {state}: {why}.")
    kept = np.searchsorted(grid, times)
    return FixedStepTrajectory(times, out_x[kept], out_m[kept], steps, most_sweeps)
