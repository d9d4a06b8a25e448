"""Steps of fixed length with friction and contact solved implicitly, the modes found per thread.

The scheme of `simulate(method="fixed_step")`: a step keeps its modes when they still hold at its
end: then it is the two-stage Rosenbrock method of Verwer et al. (SIAM J. Sci. Comput. 20, 1999).
Otherwise it is repeated as a linearly implicit Euler step whose modes are unknowns of a
complementarity problem (principal pivoting: Murty, Opsearch 11, 1974). Rigid faces strike at the
ends of steps: see `rigid`.

Rigid faces in steps of fixed length: they strike where they have closed by the end of a step.

As in `simulate(method="fixed_step")` (Moreau, 1988): speeds tell, not depth. Newton's law of
restitution; a gear output that leans on a joint that sticks is pressed: both rest.
"""

import math
from typing import Any, NamedTuple

from numba.extending import register_jitable

from ptp_symbolic.numeric.gpu.machine import (
    copy,
    evaluate,
    is_finite,
    is_outside,
    next_stop,
    rates_of,
)
from ptp_symbolic.numeric.simulation.kernels.records import (
    DIVERGED,
    DONE,
    OUTSIDE,
    SMALLEST,
    UNDECIDED,
)

MOST_ROUNDS = 20
STICKS = 2  # rule of a contact whose joint sticks in the gap; 0 is sprung, 1 rigid
REVERSAL_DEAD_BAND = 1e-13  # rad/s
PUSH_DEAD_BAND = 1e-12  # N m, or N
APPROACH_DEAD_BAND = 1e-12  # rad/s
RESTING_SPEED = 1e-5  # rad/s; slower faces stay together
FACE_WIDTH = 1e-9  # rad; faces that are closer touch at the start
SAME_SPEED = 1e-9  # rad/s, of faces that stay together from the start


@register_jitable
def push_of(m, modes, g, guards):
    """Torque in N m by which the face that is touched pushes (> 0) or would pull."""
    return m[modes] * (g[guards + 2] if m[modes] > 0.0 else g[guards + 3])


@register_jitable
def violation(machine, element, x):
    """How far the mode of an element has ended: not above zero while it lasts."""
    m, g = machine.m, machine.g
    if element < machine.frictions:
        at = 3 * element
        if m[element] != 0.0:
            return -m[element] * x[machine.friction_rates[element]] - REVERSAL_DEAD_BAND
        return max(g[at] - g[at + 1], -g[at] - g[at + 2])
    c = element - machine.frictions
    modes, at = machine.frictions + 2 * c, 3 * machine.frictions + 4 * c
    if m[modes] == 0.0:
        return max(g[at] - g[at + 1], -g[at] - g[at + 1])
    push = push_of(m, modes, g, at)
    if m[modes + 1] > 0.0:
        return -push - PUSH_DEAD_BAND
    return max(push - PUSH_DEAD_BAND, g[at + 1] - m[modes] * g[at])


@register_jitable
def holds(machine, x):
    """Whether every mode holds at x [n] and the present guards."""
    worst = -1e300
    for element in range(machine.frictions + machine.contacts):
        worst = max(worst, violation(machine, element, x))
    return worst <= 0.0


@register_jitable
def towards_face(machine, k, c, active, t, x, u):
    """Acceleration of a gear towards its face, alone (active 0) or with the joint (1); k [n] is
    scratch.
    """
    m, modes = machine.m, machine.frictions + 2 * c
    copy(m, machine.m_before)
    side = m[modes]
    m[modes + 1] = active
    gear, joint = machine.contact_rates[3 * c], machine.contact_rates[3 * c + 1]
    for f in range(machine.frictions):
        if machine.friction_rates[f] == gear or machine.friction_rates[f] == joint:
            m[f] = side
    machine.derivative(t, x, u, machine.p, m, machine.prepared, k)
    copy(machine.m_before, m)
    return side * k[gear]


@register_jitable
def fill_guards(machine, k, t, x, u):
    """Write the guards; those of a pressed contact say whether it is released."""
    machine.guard_values(t, x, u, machine.p, machine.m, machine.g)
    for c in range(machine.contacts):
        if machine.pressed[c] == 1:
            at, side = 3 * machine.frictions + 4 * c, machine.m[machine.frictions + 2 * c]
            machine.g[at] = side * towards_face(machine, k, c, 0.0, t, x, u)
            machine.g[at + 1] = 0.0
            machine.g[at + 2] = side * towards_face(machine, k, c, 1.0, t, x, u)
            machine.g[at + 3] = machine.g[at + 2]


@register_jitable
def switch_contacts(machine):
    """Move every violated contact to its next mode."""
    m, g = machine.m, machine.g
    for c in range(machine.contacts):
        modes, at = machine.frictions + 2 * c, 3 * machine.frictions + 4 * c
        if m[modes] == 0.0:
            if abs(g[at]) > g[at + 1]:
                m[modes] = 1.0 if g[at] > 0.0 else -1.0
                m[modes + 1] = 1.0 if push_of(m, modes, g, at) > 0.0 else 0.0
            continue
        push, apart = push_of(m, modes, g, at), g[at + 1] - m[modes] * g[at] > 0.0
        if machine.pressed[c] == 1:
            if push > 0.0 or apart:
                machine.pressed[c] = 0
                m[modes + 1] = 1.0 if push > 0.0 else 0.0
        elif m[modes + 1] > 0.0:
            if push < 0.0:
                m[modes + 1] = 0.0
        elif apart:
            m[modes] = 0.0
        elif push > 0.0:
            m[modes + 1] = 1.0


@register_jitable
def strike(machine, c, t, x, u):
    """One impact by Newton's law of restitution."""
    m, n = machine.m, len(x)
    modes, at = machine.frictions + 2 * c, c * (n + 2)
    m[modes + 1] = 0.0
    machine.impacts(t, x, u, machine.p, m, machine.changes)
    speed = abs(x[machine.contact_rates[3 * c]] - x[machine.contact_rates[3 * c + 1]])
    restitution = machine.changes[at + n]
    if machine.settling[c] == 1 or not restitution * speed > RESTING_SPEED:
        restitution = 0.0
    for a in range(n):
        x[a] += (1.0 + restitution) * machine.changes[at + a]
    for f in range(machine.frictions):
        rate = machine.friction_rates[f]
        if machine.changes[at + rate] != 0.0:
            m[f] = 1.0 if x[rate] > 0.0 else -1.0 if x[rate] < 0.0 else 0.0
    m[modes + 1] = 1.0 if restitution == 0.0 else 0.0


@register_jitable
def strike_faces(machine, t, x, u):
    """Apply the impact law to every rigid contact that has just closed."""
    m = machine.m
    for c in range(machine.contacts):
        gear, joint = machine.contact_rates[3 * c], machine.contact_rates[3 * c + 1]
        rule, modes = machine.contact_rates[3 * c + 2], machine.frictions + 2 * c
        if rule == 0:
            continue
        if m[modes + 1] == 0.0:
            if rule == STICKS:
                x[joint] = 0.0
        elif m[modes] * (x[gear] - x[joint]) > APPROACH_DEAD_BAND:
            strike(machine, c, t, x, u)


@register_jitable
def zero_at_rest_of(machine, f, x):
    """Zero the states that are zero while friction f sticks."""
    for a in range(len(x)):
        if machine.zero_at_rest[a] == f:
            x[a] = 0.0


@register_jitable
def press(machine, k, t, x, u):
    """Bring to rest every gear output that is pushed onto a joint that sticks."""
    m = machine.m
    for c in range(machine.contacts):
        gear, joint = machine.contact_rates[3 * c], machine.contact_rates[3 * c + 1]
        modes = machine.frictions + 2 * c
        touching = m[modes] != 0.0 and m[modes + 1] == 0.0 and abs(x[gear]) <= RESTING_SPEED
        if machine.contact_rates[3 * c + 2] != STICKS or machine.pressed[c] == 1 or not touching:
            continue
        if towards_face(machine, k, c, 0.0, t, x, u) <= 0.0:
            continue
        if towards_face(machine, k, c, 1.0, t, x, u) > 0.0:
            continue
        machine.pressed[c] = 1
        x[gear] = 0.0
        for f in range(machine.frictions):
            if machine.friction_rates[f] == gear or machine.friction_rates[f] == joint:
                m[f] = 0.0
                zero_at_rest_of(machine, f, x)


@register_jitable
def stop_reversed(machine, x):
    """Zero the rates that have reversed, and what a lasting rigid contact joins to them."""
    m = machine.m
    for f in range(machine.frictions):
        if m[f] == 0.0 or not violation(machine, f, x) > 0.0:
            continue
        rate = machine.friction_rates[f]
        x[rate] = 0.0
        m[f] = 0.0
        for c in range(machine.contacts):
            gear, joint = machine.contact_rates[3 * c], machine.contact_rates[3 * c + 1]
            joined = m[machine.frictions + 2 * c + 1] > 0.0 and machine.contact_rates[3 * c + 2] > 0
            if joined and rate in (gear, joint):
                x[gear] = 0.0
                x[joint] = 0.0
        zero_at_rest_of(machine, f, x)


@register_jitable
def break_away(m, g, frictions):
    """Let every resting friction slide whose holding torque exceeds breakaway."""
    for f in range(frictions):
        if m[f] == 0.0 and g[3 * f] > g[3 * f + 1]:
            m[f] = 1.0
        elif m[f] == 0.0 and -g[3 * f] > g[3 * f + 2]:
            m[f] = -1.0


@register_jitable
def land(machine, k, t, x, u):
    """Apply the impacts of faces that have closed by t, and switch modes; False on chattering.

    Faces that approach again before the gap has opened meet without restitution. k [n] is scratch.
    """
    fill_guards(machine, k, t, x, u)
    if holds(machine, x):
        return True
    for c in range(machine.contacts):
        machine.settling[c] = 1 if machine.m[machine.frictions + 2 * c] != 0.0 else 0
    for _ in range(MOST_ROUNDS):
        stop_reversed(machine, x)
        fill_guards(machine, k, t, x, u)
        switch_contacts(machine)
        strike_faces(machine, t, x, u)
        press(machine, k, t, x, u)
        fill_guards(machine, k, t, x, u)
        break_away(machine.m, machine.g, machine.frictions)
        fill_guards(machine, k, t, x, u)
        if holds(machine, x):
            return True
    return False


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
