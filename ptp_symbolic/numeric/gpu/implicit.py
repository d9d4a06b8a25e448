"""Steps of fixed length with friction and contact solved implicitly, the modes found per thread.

The scheme of `simulate(method="fixed_step")`: a step keeps its modes when they still hold at its
end: then it is the two-stage Rosenbrock method of Verwer et al. (SIAM J. Sci. Comput. 20, 1999).
Otherwise it is repeated as a linearly implicit Euler step whose modes are unknowns of a
complementarity problem (principal pivoting: Murty, Opsearch 11, 1974). Rigid faces strike at the
ends of steps: see `rigid`.
"""

import math
from typing import Any, NamedTuple

from numba.extending import register_jitable

from ptp_symbolic.numeric.gpu.drives import evaluate, next_stop
from ptp_symbolic.numeric.gpu.machine import copy, is_finite, is_outside, rates_of
from ptp_symbolic.numeric.gpu.rigid import land
from ptp_symbolic.numeric.simulation.kernels.records import (
    DIVERGED,
    DONE,
    OUTSIDE,
    SMALLEST,
    UNDECIDED,
)

MOST_SWEEPS = 30
GAMMA = 1.0 - math.sqrt(0.5)


class StepWork(NamedTuple):
    """Jacobians by_state [n, n] and by_input [n, nu], LU factors `matrix` [n, n] with pivots
    `order` [n], stages k1, k2 [n], directions `refused` [2 f].
    """

    by_state: Any
    by_input: Any
    matrix: Any
    order: Any
    k1: Any
    k2: Any
    refused: Any


@register_jitable
def integrate_in_steps(machine, signals, work, begin, end, step, begin_modes, find_modes, land):
    """Step machine.x [n] from `begin` to `end` in s, in equal steps of at most `step` s between the
    jumps of the inputs. Returns status, the time reached in s, and the number of steps.

    `begin_modes`, `find_modes` and `land` are the rules of sprung contacts, or of rigid ones.
    """
    t, steps = begin, 0
    for i in range(len(machine.x)):
        for j in range(len(machine.x)):
            work.by_state[i, j] = 0.0
    if is_outside(machine, machine.x):
        return OUTSIDE, t, steps
    while t < end:
        evaluate(t, 1, signals, machine.u)
        if steps == 0 and not begin_modes(machine, work, t):
            return UNDECIDED, t, steps
        start, stop = t, next_stop(t, end, signals)
        count = max(1, math.ceil((stop - start) / step - 1e-9))
        h = (stop - start) / count
        for index in range(count):
            after = stop if index + 1 == count else start + (index + 1) * h
            evaluate(after, -1, signals, machine.u_end)
            status = take_step(machine, work, start + index * h, after, find_modes, land)
            if status != DONE:
                return status, start + index * h, steps
            steps += 1
        t = stop
    return DONE, t, steps


@register_jitable
def take_step(machine, work, t, t_end, find_modes, land):
    """One step of machine.x [n] from t to t_end in s, with the inputs at both ends; its status."""
    fixed_mode_step(machine, work, t, t_end - t)
    if not find_modes(machine, work, t, t_end - t):
        return UNDECIDED
    if not is_finite(machine.end):
        return DIVERGED
    if is_outside(machine, machine.end):
        copy(machine.end, machine.x)
        return OUTSIDE
    if not land(machine, work, t_end):
        return UNDECIDED
    for a in range(len(machine.x)):
        machine.x[a] = machine.end[a] if abs(machine.end[a]) > SMALLEST else 0.0
    copy(machine.u_end, machine.u)
    return DONE


@register_jitable
def find_sprung_modes(machine, work, t, h):
    """Repeat a step whose modes do not fit its end; False if none are found that do."""
    if machine.frictions + machine.contacts == 0:
        return True
    machine.guard_values(t + h, machine.end, machine.u_end, machine.p, machine.m, machine.g)
    copy(machine.m, machine.m_before)
    allow_all(work.refused)
    if not correct_a_mode(machine, work, machine.end):
        return True
    copy(machine.m_before, machine.m)
    return mode_finding_step(machine, work, t, h)


@register_jitable
def keep_modes(machine, work, t, h):
    """Rigid contacts change their modes at the ends of steps alone."""
    return True


@register_jitable
def never_strike(machine, work, t):
    """Sprung contacts have no impacts."""
    return True


@register_jitable
def begin_rigid(machine, work, t):
    """Find consistent modes of an initial state whose modes are known but for its impacts."""
    return land(machine, work.k2, t, machine.x, machine.u)


@register_jitable
def land_rigid(machine, work, t):
    """Strike and switch at the end of a step; False on chattering."""
    return land(machine, work.k2, t, machine.end, machine.u_end)


@register_jitable
def is_coupled(a, row):
    """Whether a row has more than its diagonal; else it is not exchanged, or rests would creep."""
    found = False
    for j in range(len(a)):
        found = found or (j != row and a[row, j] != 0.0)
    return found


@register_jitable
def factor(a, order):
    """Replace a [n, n] by its LU factors, partial pivoting recorded in `order` [n]."""
    n = len(order)
    for k in range(n):
        pivot = k
        if is_coupled(a, k):
            for i in range(k + 1, n):
                if abs(a[i, k]) > abs(a[pivot, k]):
                    pivot = i
        order[k] = pivot
        if pivot != k:
            for j in range(n):
                kept = a[k, j]
                a[k, j] = a[pivot, j]
                a[pivot, j] = kept
        inverse = 1.0 / a[k, k]
        for i in range(k + 1, n):
            if a[i, k] != 0.0:
                a[i, k] *= inverse
                for j in range(k + 1, n):
                    a[i, j] -= a[i, k] * a[k, j]


@register_jitable
def solve(a, order, b):
    """Replace the right-hand side b [n] by the solution, with the LU factors from `factor`."""
    n = len(order)
    for k in range(n):
        kept = b[k]
        b[k] = b[order[k]]
        b[order[k]] = kept
    for i in range(1, n):
        for j in range(i):
            b[i] -= a[i, j] * b[j]
    for i in range(n - 1, -1, -1):
        for j in range(i + 1, n):
            b[i] -= a[i, j] * b[j]
        b[i] /= a[i, i]


@register_jitable
def factor_step(machine, work, reach, t, u):
    """Factor I - `reach` Jacobian, `reach` in s; rows of sticking rates are the identity's."""
    n, a, none = len(machine.x), work.matrix, work.by_state[:0]
    machine.linearize(
        t, machine.x, u, machine.p, machine.m, work.by_state, work.by_input, none, none, none
    )
    for c in range(machine.contacts):
        if machine.pressed[c] == 1:
            for j in range(n):
                work.by_state[machine.contact_rates[3 * c], j] = 0.0
    for i in range(n):
        for j in range(n):
            a[i, j] = -reach * work.by_state[i, j]
        a[i, i] += 1.0
    for f in range(machine.frictions):
        if machine.m[f] == 0.0:
            rate = machine.friction_rates[f]
            for j in range(n):
                a[rate, j] = 0.0
            a[rate, rate] = 1.0
    factor(a, work.order)


@register_jitable
def rest(machine, k):
    """Zero the derivative k [n] of every sticking rate."""
    for f in range(machine.frictions):
        if machine.m[f] == 0.0:
            k[machine.friction_rates[f]] = 0.0


@register_jitable
def fixed_mode_step(machine, work, t, h):
    """Write the state after an order-2 Rosenbrock step in the present modes into machine.end."""
    n, x, end, k1, k2 = len(machine.x), machine.x, machine.end, work.k1, work.k2
    factor_step(machine, work, GAMMA * h, t, machine.u)
    rates_of(machine, t, x, machine.u, k1)
    rest(machine, k1)
    solve(work.matrix, work.order, k1)
    for a in range(n):
        end[a] = x[a] + h * k1[a]
    rates_of(machine, t + h, end, machine.u_end, k2)
    for a in range(n):
        k2[a] -= 2.0 * k1[a]
    rest(machine, k2)
    solve(work.matrix, work.order, k2)
    for a in range(n):
        end[a] = x[a] + h * (1.5 * k1[a] + 0.5 * k2[a])


@register_jitable
def mode_finding_step(machine, work, t, h):
    """Write the state after an implicit step that finds its modes into machine.end; False where
    none of MOST_SWEEPS sets of modes fits.
    """
    x, k, m = machine.x, work.k1, machine.m
    copy(m, machine.m_before)
    allow_all(work.refused)
    for _ in range(MOST_SWEEPS):
        factor_step(machine, work, h, t + h, machine.u_end)
        rates_of(machine, t + h, x, machine.u_end, k)
        for a in range(len(x)):
            k[a] *= h
        for f in range(machine.frictions):
            if m[f] == 0.0:
                k[machine.friction_rates[f]] = -x[machine.friction_rates[f]]
        solve(work.matrix, work.order, k)
        for a in range(len(x)):
            machine.end[a] = x[a] + k[a]
            f = machine.zero_at_rest[a]
            if f >= 0 and m[f] == 0.0 and machine.m_before[f] != 0.0:
                machine.end[a] = 0.0
        machine.guard_values(t + h, machine.end, machine.u_end, machine.p, m, machine.g)
        if not correct_a_mode(machine, work, machine.end):
            return True
    return False


@register_jitable
def allow_all(refused):
    """Clear the directions that were refused."""
    for i in range(len(refused)):
        refused[i] = 0


@register_jitable
def correct_a_mode(machine, work, x):
    """Change the first mode that does not fit x [n] and the guards; False when all of them fit."""
    for f in range(machine.frictions):
        rate = x[machine.friction_rates[f]]
        if correct_friction(f, rate, machine.m, machine.g, work.refused):
            for other in range(machine.frictions):
                if other != f:
                    work.refused[2 * other] = 0
                    work.refused[2 * other + 1] = 0
            return True
    for c in range(machine.contacts):
        modes, guards = machine.frictions + 2 * c, 3 * machine.frictions + 4 * c
        if correct_contact(machine.m, modes, machine.g, guards):
            allow_all(work.refused)
            return True
    return False


@register_jitable
def correct_friction(f, rate, m, g, refused):
    """Stop sliding against its direction; start it where the holding torque exceeds breakaway.

    A direction that ended against itself is refused while the other modes stay.
    """
    if m[f] != 0.0:
        if m[f] * rate >= 0.0:
            return False
        refused[2 * f if m[f] > 0.0 else 2 * f + 1] = 1
        m[f] = 0.0
        return True
    if g[3 * f] > g[3 * f + 1] and refused[2 * f] == 0:
        m[f] = 1.0
    elif -g[3 * f] > g[3 * f + 2] and refused[2 * f + 1] == 0:
        m[f] = -1.0
    return m[f] != 0.0


@register_jitable
def correct_contact(m, at, g, guards):
    """Let a face push only from beyond the gap and never pull; True when its torque changed.

    `at` and `guards` say where the contact stands among the modes m and the guards g.
    """
    separation, half_gap, active = g[guards], g[guards + 1], m[at + 1]
    side = m[at]
    if active == 0.0:
        side = 1.0 if separation > 0.0 else -1.0
    push = side * (g[guards + 2] if side > 0.0 else g[guards + 3])
    if active > 0.0 and push >= 0.0:
        return False
    beyond = side * separation > half_gap
    m[at] = side if beyond else 0.0
    m[at + 1] = 1.0 if beyond and push > 0.0 else 0.0
    return m[at + 1] != active


@register_jitable
def choose_start_modes(machine, work, t):
    """Find modes that fit the initial state; False when none do."""
    m = machine.m
    for i in range(len(m)):
        m[i] = 0.0
    for f in range(machine.frictions):
        rate = machine.x[machine.friction_rates[f]]
        m[f] = 1.0 if rate > 0.0 else -1.0 if rate < 0.0 else 0.0
    if machine.frictions + machine.contacts == 0:
        return True
    allow_all(work.refused)
    for _ in range(MOST_SWEEPS):
        machine.guard_values(t, machine.x, machine.u, machine.p, m, machine.g)
        if not correct_a_mode(machine, work, machine.x):
            return True
    return False
