"""Modes of friction and contact: when one is violated, and what follows.

Modes are one array: the direction of every friction (-1, 0 sticking, 1), then for every contact
the face it touches (-1, 0 in the gap, 1) and whether that face transmits torque (1) or has let go
while still beyond the gap (0). Guards come as the emitted `guards` writes them: per friction
holding torque, breakaway forward and backward; per contact separation, half gap and the torque at
the upper and lower face.
"""

from numba import njit

REVERSAL_DEAD_BAND = 1e-13


@njit(cache=True, nogil=True)
def violation(element, x, m, g, friction_rates):
    """How far `element` is past the end of its mode (> 0: the mode has ended)."""
    frictions = len(friction_rates)
    if element < frictions:
        direction = m[element]
        if direction != 0.0:
            return -direction * x[friction_rates[element]] - REVERSAL_DEAD_BAND
        hold = g[3 * element]
        return max(hold - g[3 * element + 1], -hold - g[3 * element + 2])
    contact = element - frictions
    at = 3 * frictions + 4 * contact
    side, active = m[frictions + 2 * contact], m[frictions + 2 * contact + 1]
    if side == 0.0:
        return max(g[at] - g[at + 1], -g[at] - g[at + 1])
    pushing = side * (g[at + 2] if side > 0.0 else g[at + 3])
    if active > 0.0:
        return -pushing
    return max(pushing, g[at + 1] - side * g[at])


@njit(cache=True, nogil=True)
def largest_violation(x, m, g, friction_rates):
    """The largest violation over all elements; negative when every mode holds."""
    worst = -1e300
    elements = len(friction_rates) + (len(m) - len(friction_rates)) // 2
    for element in range(elements):
        worst = max(worst, violation(element, x, m, g, friction_rates))
    return worst


@njit(cache=True, nogil=True)
def violation_gradient(element, m, g, gx, gp, friction_rates, x, by_x, by_p):
    """Write the derivatives of `violation` by state and parameter, on its active branch."""
    frictions = len(friction_rates)
    by_x[:] = 0.0
    by_p[:] = 0.0
    if element < frictions:
        direction = m[element]
        if direction != 0.0:
            by_x[friction_rates[element]] = -direction
            return
        hold = g[3 * element]
        forward = hold - g[3 * element + 1] >= -hold - g[3 * element + 2]
        sign, limit = (1.0, 3 * element + 1) if forward else (-1.0, 3 * element + 2)
        by_x[:] = sign * gx[3 * element] - gx[limit]
        by_p[:] = sign * gp[3 * element] - gp[limit]
        return
    contact = element - frictions
    at = 3 * frictions + 4 * contact
    side, active = m[frictions + 2 * contact], m[frictions + 2 * contact + 1]
    if side == 0.0:
        sign = 1.0 if g[at] >= 0.0 else -1.0
        by_x[:] = sign * gx[at] - gx[at + 1]
        by_p[:] = sign * gp[at] - gp[at + 1]
        return
    face = at + 2 if side > 0.0 else at + 3
    if active > 0.0:
        by_x[:] = -side * gx[face]
        by_p[:] = -side * gp[face]
    elif side * g[face] >= g[at + 1] - side * g[at]:
        by_x[:] = side * gx[face]
        by_p[:] = side * gp[face]
    else:
        by_x[:] = gx[at + 1] - side * gx[at]
        by_p[:] = gp[at + 1] - side * gp[at]


@njit(cache=True, nogil=True)
def switch_contacts(m, g, friction_rates):
    """Move every violated contact to its next mode."""
    frictions = len(friction_rates)
    for contact in range((len(m) - frictions) // 2):
        at = 3 * frictions + 4 * contact
        where = frictions + 2 * contact
        side = m[where]
        if side == 0.0:
            if abs(g[at]) > g[at + 1]:
                side = 1.0 if g[at] > 0.0 else -1.0
                m[where] = side
                pushing = side * (g[at + 2] if side > 0.0 else g[at + 3])
                m[where + 1] = 1.0 if pushing > 0.0 else 0.0
            continue
        pushing = side * (g[at + 2] if side > 0.0 else g[at + 3])
        if m[where + 1] > 0.0:
            if pushing < 0.0:
                m[where + 1] = 0.0
        elif g[at + 1] - side * g[at] > 0.0:
            m[where] = 0.0
        elif pushing > 0.0:
            m[where + 1] = 1.0


@njit(cache=True, nogil=True)
def settle(guards, t, x, u, p, m, g, friction_rates, zero_at_rest):
    """Resolve all violated modes at one instant; returns False when that does not end.

    Order matters: rates that reversed are zeroed first, then contacts switch, then the torque
    on every resting friction decides whether it sticks or slides. Ties end in sticking.
    """
    frictions = len(friction_rates)
    for _ in range(20):
        for k in range(frictions):
            if m[k] != 0.0 and violation(k, x, m, g, friction_rates) > 0.0:
                x[friction_rates[k]] = 0.0
                m[k] = 0.0
                for a in range(len(x)):
                    if zero_at_rest[a] == k:
                        x[a] = 0.0
        guards(t, x, u, p, m, g)
        switch_contacts(m, g, friction_rates)
        guards(t, x, u, p, m, g)
        for k in range(frictions):
            if m[k] == 0.0:
                if g[3 * k] > g[3 * k + 1]:
                    m[k] = 1.0
                elif -g[3 * k] > g[3 * k + 2]:
                    m[k] = -1.0
        guards(t, x, u, p, m, g)
        if largest_violation(x, m, g, friction_rates) <= 0.0:
            return True
    return False
