"""One step of fixed length: an order-2 step in given modes, and an implicit step that finds them.

Both solve one linear system after another with the emitted Jacobian; a sticking rate is a row of
that system, so that it ends at exactly zero.
"""

import math

import numpy as np
from numba import njit

MOST_SWEEPS = 30
GAMMA = 1.0 - math.sqrt(0.5)


@njit(cache=True, nogil=True, error_model="numpy")
def factor(a, order):
    """Replace a [n, n] by its triangular factors, rows swapped as `order` [n] records."""
    n = a.shape[0]
    for k in range(n):
        pivot = k
        for i in range(k + 1, n):
            if abs(a[i, k]) > abs(a[pivot, k]):
                pivot = i
        order[k] = pivot
        if pivot != k:
            for j in range(n):
                a[k, j], a[pivot, j] = a[pivot, j], a[k, j]
        inverse = 1.0 / a[k, k]
        for i in range(k + 1, n):
            if a[i, k] != 0.0:
                a[i, k] *= inverse
                for j in range(k + 1, n):
                    a[i, j] -= a[i, k] * a[k, j]


@njit(cache=True, nogil=True, error_model="numpy")
def solve(a, order, b):
    """Replace the right-hand side b [n] by the solution, with the factors from `factor`."""
    n = len(b)
    for k in range(n):
        pivot = order[k]
        b[k], b[pivot] = b[pivot], b[k]
    for i in range(1, n):
        for j in range(i):
            b[i] -= a[i, j] * b[j]
    for i in range(n - 1, -1, -1):
        for j in range(i + 1, n):
            b[i] -= a[i, j] * b[j]
        b[i] /= a[i, i]


@njit(cache=True, nogil=True, error_model="numpy")
def factor_step(jacobian, reach, t, x, u, p, m, friction_rates, work):
    """Factor the matrix of an implicit step of length `reach` in s; sticking rates are pinned."""
    fx, fu, fp, a, order = work
    n = len(x)
    jacobian(t, x, u, p, m, fx, fu, fp)
    for i in range(n):
        for j in range(n):
            a[i, j] = -reach * fx[i, j]
        a[i, i] += 1.0
    for f in range(len(friction_rates)):
        if m[f] == 0.0:
            a[friction_rates[f], :] = 0.0
            a[friction_rates[f], friction_rates[f]] = 1.0
    factor(a, order)


@njit(cache=True, nogil=True, error_model="numpy")
def fixed_mode_step(
    derivative, jacobian, t, h, x, u_start, u_end, p, m, friction_rates, work, k1, k2, end
):
    """Write the state after a step of order 2 in the modes m into `end` [n]."""
    n, a, order = len(x), work[3], work[4]
    factor_step(jacobian, GAMMA * h, t, x, u_start, p, m, friction_rates, work)
    derivative(t, x, u_start, p, m, k1)
    for f in range(len(friction_rates)):
        if m[f] == 0.0:
            k1[friction_rates[f]] = 0.0
    solve(a, order, k1)
    for i in range(n):
        end[i] = x[i] + h * k1[i]
    derivative(t + h, end, u_end, p, m, k2)
    for i in range(n):
        k2[i] -= 2.0 * k1[i]
    for f in range(len(friction_rates)):
        if m[f] == 0.0:
            k2[friction_rates[f]] = 0.0
    solve(a, order, k2)
    for i in range(n):
        end[i] = x[i] + h * (1.5 * k1[i] + 0.5 * k2[i])


@njit(cache=True, nogil=True, error_model="numpy")
def mode_finding_step(
    derivative, jacobian, guards, t, h, x, u, p, m, friction_rates, zero_at_rest, work, k, g, was,
    refused, end,
):  # fmt: skip
    """Write the state after an implicit Euler step into `end` [n] and its modes into m.

    Returns the number of mode sets tried, or 0 when none of MOST_SWEEPS sets is consistent.
    """
    was[:] = m
    refused[:] = False
    for sweep in range(1, MOST_SWEEPS + 1):
        factor_step(jacobian, h, t + h, x, u, p, m, friction_rates, work)
        derivative(t + h, x, u, p, m, k)
        for i in range(len(x)):
            k[i] *= h
        for f in range(len(friction_rates)):
            if m[f] == 0.0:
                k[friction_rates[f]] = -x[friction_rates[f]]
        solve(work[3], work[4], k)
        for i in range(len(x)):
            end[i] = x[i] + k[i]
            friction = zero_at_rest[i]
            if friction >= 0 and m[friction] == 0.0 and was[friction] != 0.0:
                end[i] = 0.0
        guards(t + h, end, u, p, m, g)
        if not correct_a_mode(end, m, g, friction_rates, refused):
            return sweep
    return 0


@njit(cache=True, nogil=True)
def correct_a_mode(x, m, g, friction_rates, refused):
    """Change the first mode that does not fit state and guards; False when all of them fit."""
    for f in range(len(friction_rates)):
        if correct_friction(f, x[friction_rates[f]], m, g, refused):
            for other in range(len(friction_rates)):
                if other != f:
                    refused[other, :] = False
            return True
    for contact in range((len(m) - len(friction_rates)) // 2):
        if correct_contact(contact, len(friction_rates), m, g):
            refused[:] = False
            return True
    return False


@njit(cache=True, nogil=True)
def correct_friction(f, rate, m, g, refused):
    """Stop sliding against its direction; start it where the holding torque exceeds breakaway.

    A direction that ended against itself is `refused` [frictions, 2] while the other modes stay:
    sliding one way and resting both fail only where the friction of this step brings it to rest.
    """
    if m[f] != 0.0:
        if m[f] * rate >= 0.0:
            return False
        refused[f, 0 if m[f] > 0.0 else 1] = True
        m[f] = 0.0
        return True
    if g[3 * f] > g[3 * f + 1] and not refused[f, 0]:
        m[f] = 1.0
    elif -g[3 * f] > g[3 * f + 2] and not refused[f, 1]:
        m[f] = -1.0
    return m[f] != 0.0


@njit(cache=True, nogil=True)
def correct_contact(contact, frictions, m, g):
    """Let a face push only from beyond the gap and never pull; True when its torque changed.

    A face that has let go and the open gap move alike, so that their names change freely.
    """
    at, where = 3 * frictions + 4 * contact, frictions + 2 * contact
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


@njit(cache=True, nogil=True)
def choose_start_modes(guards, t, x, u, p, m, g, friction_rates, refused):
    """Write the modes that fit the state at the start into m; False when none do."""
    m[:] = 0.0
    for f in range(len(friction_rates)):
        m[f] = np.sign(x[friction_rates[f]])
    for _ in range(MOST_SWEEPS):
        guards(t, x, u, p, m, g)
        if not correct_a_mode(x, m, g, friction_rates, refused):
            return True
    return False
