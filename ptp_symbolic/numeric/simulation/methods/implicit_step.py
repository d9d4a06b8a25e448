"""One step of fixed length: an order-2 step in given modes, and an implicit step that finds them.

Both are linearly implicit, with the emitted Jacobian; a sticking rate is a row of the linear
system, so that it ends at exactly zero.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from ptp_symbolic.numeric.runtime.element_layout import (
    contact_count,
    contact_guards,
    contact_modes,
    friction_guards,
)
from ptp_symbolic.numeric.simulation.events.impacts import derivative, jacobian
from ptp_symbolic.numeric.simulation.kernels.calls import call
from ptp_symbolic.numeric.simulation.kernels.linear import factor, solve
from ptp_symbolic.numeric.simulation.kernels.records import copy, inlined, kernel

MOST_SWEEPS = 30
GAMMA = 1.0 - math.sqrt(0.5)


class StepWork(NamedTuple):
    """Preallocated arrays of a step: Jacobians fx [n, n], fu [n, nu], fp [0, np]; LU factors [n, n]
    and pivots [n]; stages k1, k2 and state end [n]; refused [f, 2].
    """

    fx: Any
    fu: Any
    fp: Any
    matrix: Any
    order: Any
    k1: Any
    k2: Any
    end: Any
    refused: Any


@kernel
def factor_step(equations, reach, t, x, u, m, work):
    """LU-factor I - `reach` fx, `reach` in s; rows of sticking rates are those of the identity."""
    n, a = len(x), work.matrix
    jacobian(equations, t, x, u, m, work.fx, work.fu, work.fp)
    for i in range(n):
        for j in range(n):
            a[i, j] = -reach * work.fx[i, j]
        a[i, i] += 1.0
    for f in range(len(equations.friction_rates)):
        if m[f] == 0.0:
            rate = equations.friction_rates[f]
            for j in range(n):
                a[rate, j] = 0.0
            a[rate, rate] = 1.0
    factor(a, work.order)


@inlined
def rest(equations, m, k):
    """Zero the derivative k [n] of every sticking rate."""
    for f in range(len(equations.friction_rates)):
        if m[f] == 0.0:
            k[equations.friction_rates[f]] = 0.0


@kernel
def fixed_mode_step(equations, t, h, x, u_start, u_end, m, work):
    """Write the state after an order-2 Rosenbrock step in the modes m into `work.end` [n]."""
    n, k1, k2, end = len(x), work.k1, work.k2, work.end
    factor_step(equations, GAMMA * h, t, x, u_start, m, work)
    derivative(equations, t, x, u_start, m, k1)
    rest(equations, m, k1)
    solve(work.matrix, work.order, k1)
    for i in range(n):
        end[i] = x[i] + h * k1[i]
    derivative(equations, t + h, end, u_end, m, k2)
    for i in range(n):
        k2[i] -= 2.0 * k1[i]
    rest(equations, m, k2)
    solve(work.matrix, work.order, k2)
    for i in range(n):
        end[i] = x[i] + h * (1.5 * k1[i] + 0.5 * k2[i])


@kernel
def mode_finding_step(equations, t, h, x, u, watch, work):
    """Write the state after a linearly implicit Euler step into `work.end` [n], its modes into
    `watch.m`.

    Returns the number of mode sets tried, or 0 when none of MOST_SWEEPS sets is consistent.
    """
    rates, k, end, m = equations.friction_rates, work.k1, work.end, watch.m
    copy(m, watch.m_before)
    allow_all(work.refused)
    for sweep in range(1, MOST_SWEEPS + 1):
        factor_step(equations, h, t + h, x, u, m, work)
        derivative(equations, t + h, x, u, m, k)
        for i in range(len(x)):
            k[i] *= h
        for f in range(len(rates)):
            if m[f] == 0.0:
                k[rates[f]] = -x[rates[f]]
        solve(work.matrix, work.order, k)
        for i in range(len(x)):
            end[i] = x[i] + k[i]
            friction = equations.zero_at_rest[i]
            if friction >= 0 and m[friction] == 0.0 and watch.m_before[friction] != 0.0:
                end[i] = 0.0
        call(equations.guards, t + h, end, u, equations.p, m, watch.g)
        if not correct_a_mode(end, m, watch.g, rates, work.refused):
            return sweep
    return 0


@inlined
def allow_all(refused):
    """Clear the directions `refused` [f, 2] of every friction."""
    for f in range(len(refused)):
        refused[f, 0], refused[f, 1] = 0, 0


@kernel
def correct_a_mode(x, m, g, friction_rates, refused):
    """Change the first mode that does not fit x [n] and guards g; False when all of them fit."""
    for f in range(len(friction_rates)):
        if correct_friction(f, x[friction_rates[f]], m, g, refused):
            for other in range(len(friction_rates)):
                if other != f:
                    refused[other, 0], refused[other, 1] = 0, 0
            return True
    for contact in range(contact_count(len(friction_rates), len(m))):
        if correct_contact(contact, len(friction_rates), m, g):
            allow_all(refused)
            return True
    return False


@kernel
def correct_friction(f, rate, m, g, refused):
    """Stop sliding against its direction; start it where the holding torque exceeds breakaway.

    A direction that ended against itself is `refused` [frictions, 2] while the other modes stay:
    sliding one way and resting both fail only where the friction of this step brings it to rest.
    """
    if m[f] != 0.0:
        if m[f] * rate >= 0.0:
            return False
        refused[f, 0 if m[f] > 0.0 else 1] = 1
        m[f] = 0.0
        return True
    if g[friction_guards(f)] > g[friction_guards(f) + 1] and not refused[f, 0]:
        m[f] = 1.0
    elif -g[friction_guards(f)] > g[friction_guards(f) + 2] and not refused[f, 1]:
        m[f] = -1.0
    return m[f] != 0.0


@kernel
def correct_contact(contact, frictions, m, g):
    """Let a face push only from beyond the gap and never pull; True when its torque changed.

    A face that has let go and the open gap move alike, so that their names change freely.
    """
    at, where = contact_guards(frictions, contact), contact_modes(frictions, contact)
    separation, half_gap, active = g[at], g[at + 1], m[where + 1]
    side = m[where]
    if active == 0.0:
        side = 1.0 if separation > 0.0 else -1.0
    push = side * (g[at + 2] if side > 0.0 else g[at + 3])
    if active > 0.0 and push >= 0.0:
        return False
    beyond = side * separation > half_gap
    m[where] = side if beyond else 0.0
    m[where + 1] = 1.0 if beyond and push > 0.0 else 0.0
    return m[where + 1] != active


@kernel
def choose_start_modes(equations, t, x, u, watch, work):
    """Write modes consistent with the initial state x [n] into `watch.m`; False when none are."""
    m = watch.m
    for i in range(len(m)):
        m[i] = 0.0
    for f in range(len(equations.friction_rates)):
        m[f] = np.sign(x[equations.friction_rates[f]])
    allow_all(work.refused)
    for _ in range(MOST_SWEEPS):
        call(equations.guards, t, x, u, equations.p, m, watch.g)
        if not correct_a_mode(x, m, watch.g, equations.friction_rates, work.refused):
            return True
    return False
