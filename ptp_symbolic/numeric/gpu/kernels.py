"""The two kernels of a model, one thread a trajectory.

Arrays of all trajectories have the trajectory as their last index, so that neighbouring threads
read neighbouring numbers; what a thread works on is in registers and memory of its own.

Smooth models: Tsitouras's pair of order 5(4), every thread with a step length of its own.

Steps end where an input jumps; the step length is taken up again after such a stop.
"""

from functools import lru_cache
from typing import Any, NamedTuple

from numba import cuda, float64, int64
from numba.extending import register_jitable

from ptp_symbolic.numeric.gpu.implicit import (
    StepWork,
    begin_rigid,
    choose_start_modes,
    find_sprung_modes,
    integrate_in_steps,
    keep_modes,
    land_rigid,
    never_strike,
)
from ptp_symbolic.numeric.gpu.machine import (
    READY,
    Layout,
    Machine,
    Signals,
    begin_signals,
    copy,
    evaluate,
    is_finite,
    is_outside,
    next_stop,
)
from ptp_symbolic.numeric.simulation.kernels.records import (
    DIVERGED,
    DONE,
    EXHAUSTED,
    OUTSIDE,
    TOO_FAST,
)
from ptp_symbolic.numeric.simulation.methods.runge_kutta import ERROR, ORDER, STAGES, A, C

SHORTEST = 1e-11  # s
SAFETY, LEAST, MOST = 0.9, 0.2, 5.0  # factors by which a step length changes
FIRST = 1e-4  # s; the longest first step
BEFORE_STOP = 2.0  # step lengths: a shorter rest before a stop is cut in two


class Accuracy(NamedTuple):
    """Relative tolerance, absolute ones [n] in the units of the states, the longest step in s, and
    the most steps tried.
    """

    relative: Any
    absolute: Any
    longest: Any
    most_steps: Any


@register_jitable
def integrate_smooth(machine, signals, k, begin, end, accuracy):
    """Integrate machine.x [n] from `begin` to `end` in s, with stages k [7, n].

    Returns status, the time reached in s, and the number of steps tried.
    """
    t, stop, h, steps = begin, begin, min(FIRST, accuracy.longest), 0
    if is_outside(machine, machine.x):
        return OUTSIDE, t, steps
    while t < end:
        if t >= stop:
            stop = next_stop(t, end, signals)
            evaluate(t, 1, signals, machine.u)
            machine.derivative(
                t, machine.x, machine.u, machine.p, machine.m, machine.prepared, k[0]
            )
        if steps >= accuracy.most_steps:
            return EXHAUSTED, t, steps
        length = h
        if t + h >= stop:
            length = stop - t
        elif t + BEFORE_STOP * h > stop:
            length = 0.5 * (stop - t)
        attempt(machine, signals, k, t, length)
        steps += 1
        error = error_norm(machine, k, length, accuracy)
        factor = MOST
        if not error < (SAFETY / MOST) ** ORDER:
            factor = max(LEAST, SAFETY * error ** (-1.0 / ORDER)) if error < 1e30 else LEAST
        if error <= 1.0:
            if is_outside(machine, machine.end):
                copy(machine.end, machine.x)
                return OUTSIDE, t + length, steps
            t = stop if t + h >= stop else t + length
            accept(machine, k)
            h = max(h, factor * length) if length < h else factor * length
            h = min(h, accuracy.longest)
            continue
        h = factor * length
        if h < SHORTEST:
            return (TOO_FAST if is_finite(machine.end) else DIVERGED), t, steps
    return (DONE if is_finite(machine.x) else DIVERGED), t, steps


@register_jitable
def attempt(machine, signals, k, t, h):
    """Try a step of h s: write the slopes k [7, n] and the state machine.end [n]."""
    for i in range(1, STAGES):
        for a in range(len(machine.x)):
            change = 0.0
            for j in range(i):
                change += A[i, j] * k[j, a]
            machine.end[a] = machine.x[a] + h * change
        evaluate(t + C[i] * h, -1 if C[i] == 1.0 else 1, signals, machine.u)
        machine.derivative(
            t + C[i] * h, machine.end, machine.u, machine.p, machine.m, machine.prepared, k[i]
        )


@register_jitable
def error_norm(machine, k, h, accuracy):
    """The largest estimated error of a state over its tolerance; infinite for what is no number."""
    worst = 0.0
    for a in range(len(machine.x)):
        error = 0.0
        for i in range(STAGES):
            error += ERROR[i] * k[i, a]
        size = max(abs(machine.x[a]), abs(machine.end[a]))
        ratio = abs(h * error) / (accuracy.absolute[a] + accuracy.relative * size)
        worst = max(worst, ratio) if ratio < 1e300 else 1e300
    return worst


@register_jitable
def accept(machine, k):
    """Go on to the end of the step, where its last slope is the first of the next."""
    for a in range(len(machine.x)):
        machine.x[a] = machine.end[a]
        k[0, a] = k[STAGES - 1, a]


@register_jitable
def read_trajectory(i, runs, machine, signals, delays, prepare, domain):
    """Read trajectory i into a machine and its signals."""
    for a in range(runs.x.shape[0]):
        machine.x[a] = runs.x[a, i]
    for a in range(runs.p.shape[0]):
        machine.p[a] = runs.p[a, i]
    for a in range(runs.m.shape[0]):
        machine.m[a] = runs.m[a, i]
    prepare(machine.p, machine.prepared)
    domain(machine.p, machine.bounds)
    begin_signals(signals, delays, machine.p)


@register_jitable
def write_trajectory(i, runs, x, status, reached, steps):
    """Write the final state x [n] and how the run ended to the place of trajectory i."""
    for a in range(runs.x.shape[0]):
        runs.x[a, i] = x[a]
    runs.status[i], runs.reached[i], runs.steps[i] = status, reached, steps


@lru_cache(maxsize=16)
def smooth_kernel(layout: Layout) -> Any:
    """The kernel of a smooth model: explicit steps within tolerances."""
    module, f = layout.module, float64
    derivative, guards = module.prepared_derivative, module.guards
    prepare, domain = module.prepare, module.domain
    n, nu, parameters, prepared = sizes_of(layout)
    modes, guard_count, limits = layout.modes, layout.guards, layout.limits
    bounds, limited, delays = max(1, limits), layout.limited, layout.delays
    rates, zero_at_rest, stages = layout.friction_rates, layout.zero_at_rest, STAGES
    contact_rates = layout.contact_rates

    @cuda.jit
    def run_smooth(runs, drives, begin, end, accuracy):
        i, local = cuda.grid(1), cuda.local.array
        if i >= len(runs.status) or runs.status[i] != READY:
            return
        x, u = local(n, f), local(nu, f)
        machine = Machine(
            derivative,
            guards,
            guards,
            guards,
            0,
            0,
            rates,
            zero_at_rest,
            contact_rates,
            limits,
            limited,
            x,
            local(n, f),
            u,
            u,
            local(parameters, f),
            local(prepared, f),
            local(modes, f),
            local(modes, f),
            local(guard_count, f),
            local((bounds, 2), f),
            local(1, int64),
            local(1, int64),
            local(1, f),
        )
        first = runs.kind[i] * nu
        signals = Signals(drives, first, local(nu, f), local(nu, int64), local(nu, int64))
        read_trajectory(i, runs, machine, signals, delays, prepare, domain)
        status, reached, steps = integrate_smooth(
            machine, signals, local((stages, n), f), begin, end, accuracy
        )
        write_trajectory(i, runs, x, status, reached, steps)

    return run_smooth


@lru_cache(maxsize=16)
def stepping_kernel(layout: Layout) -> Any:
    """The kernel of all models: fixed steps that find the modes of friction and contact."""
    module, f = layout.module, float64
    derivative, linearize = module.prepared_derivative, module.linearize
    guards, prepare, domain = module.guards, module.prepare, module.domain
    n, nu, parameters, prepared = sizes_of(layout)
    modes, guard_count, limits = layout.modes, layout.guards, layout.limits
    frictions, contacts, directions = layout.frictions, layout.contacts, 2 * layout.frictions + 1
    bounds, limited, delays = max(1, limits), layout.limited, layout.delays
    rates, zero_at_rest = layout.friction_rates, layout.zero_at_rest
    contact_rates, touching = layout.contact_rates, max(1, contacts)
    impacts = module.impacts if layout.rigid else guards
    changes = touching * (n + 2) if layout.rigid else 1
    begin_modes, find_modes, land = choose_start_modes, find_sprung_modes, never_strike
    if layout.rigid:
        begin_modes, find_modes, land = begin_rigid, keep_modes, land_rigid

    @cuda.jit
    def run_in_steps(runs, drives, begin, end, step):
        i, local = cuda.grid(1), cuda.local.array
        if i >= len(runs.status) or runs.status[i] != READY:
            return
        x = local(n, f)
        machine = Machine(
            derivative,
            linearize,
            guards,
            impacts,
            frictions,
            contacts,
            rates,
            zero_at_rest,
            contact_rates,
            limits,
            limited,
            x,
            local(n, f),
            local(nu, f),
            local(nu, f),
            local(parameters, f),
            local(prepared, f),
            local(modes, f),
            local(modes, f),
            local(guard_count, f),
            local((bounds, 2), f),
            local(touching, int64),
            local(touching, int64),
            local(changes, f),
        )
        for c in range(touching):
            machine.pressed[c] = 0
            machine.settling[c] = 0
        work = StepWork(
            local((n, n), f),
            local((n, nu), f),
            local((n, n), f),
            local(n, int64),
            local(n, f),
            local(n, f),
            local(directions, int64),
        )
        first = runs.kind[i] * nu
        signals = Signals(drives, first, local(nu, f), local(nu, int64), local(nu, int64))
        read_trajectory(i, runs, machine, signals, delays, prepare, domain)
        status, reached, steps = integrate_in_steps(
            machine, signals, work, begin, end, step, begin_modes, find_modes, land
        )
        write_trajectory(i, runs, x, status, reached, steps)

    return run_in_steps


def sizes_of(layout: Layout) -> tuple[int, int, int, int]:
    """Numbers of states, inputs, parameters and prepared subexpressions."""
    return layout.states, layout.inputs, layout.parameters, layout.prepared
