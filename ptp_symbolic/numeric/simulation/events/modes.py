"""Modes of friction and contact: when one is violated, and what follows.

Modes are one array: the direction of every friction (-1, 0 sticking, 1), then for every contact
the face it touches (-1, 0 in the gap, 1) and whether that face transmits torque (1) or has let go
while still beyond the gap (0). Guards come as the emitted `guards` writes them: per friction
holding torque, breakaway forward and backward; per contact separation, half gap and the torque at
the upper and lower face.
"""

from ptp_symbolic.numeric.runtime.element_layout import (
    contact_count,
    contact_guards,
    contact_modes,
    friction_guards,
)
from ptp_symbolic.numeric.simulation.events.impacts import rest_together, strike_faces
from ptp_symbolic.numeric.simulation.events.pressed import PRESSED, fill_guards, press
from ptp_symbolic.numeric.simulation.kernels.records import inlined, kernel

REVERSAL_DEAD_BAND = 1e-13
PUSH_DEAD_BAND = 1e-12  # N m, or N; a face at rest without load would let go and push by rounding


@kernel
def violation(element, x, m, g, friction_rates):
    """Event function of `element` at x [n], modes m and guards g (> 0: its mode has ended); in the
    unit of its guard, or rad/s for the reversal of sliding.
    """
    frictions = len(friction_rates)
    if element < frictions:
        direction = m[element]
        if direction != 0.0:
            return -direction * x[friction_rates[element]] - REVERSAL_DEAD_BAND
        hold = g[friction_guards(element)]
        return max(hold - g[friction_guards(element) + 1], -hold - g[friction_guards(element) + 2])
    contact = element - frictions
    at = contact_guards(frictions, contact)
    side, active = m[contact_modes(frictions, contact)], m[contact_modes(frictions, contact) + 1]
    if side == 0.0:
        return max(g[at] - g[at + 1], -g[at] - g[at + 1])
    pushing = side * (g[at + 2] if side > 0.0 else g[at + 3])
    if active > 0.0:
        return -pushing - PUSH_DEAD_BAND
    return max(pushing - PUSH_DEAD_BAND, g[at + 1] - side * g[at])


@kernel
def largest_violation(x, m, g, friction_rates):
    """The largest event function over all elements; not above zero where every mode holds."""
    worst = -1e300
    elements = len(friction_rates) + contact_count(len(friction_rates), len(m))
    for element in range(elements):
        worst = max(worst, violation(element, x, m, g, friction_rates))
    return worst


@inlined
def _fill_difference(sign, row, limit_sign, limit, derivatives, out):
    """Write sign times one row plus limit_sign times another into out."""
    for i in range(len(out)):
        out[i] = sign * derivatives[row, i] + limit_sign * derivatives[limit, i]


@inlined
def _active_guards(element, m, g, frictions):
    """Sign and row of the two guards whose sum is the violation of a rest or a contact."""
    if element < frictions:
        at, hold = friction_guards(element), g[friction_guards(element)]
        if hold - g[at + 1] >= -hold - g[at + 2]:
            return 1.0, at, -1.0, at + 1
        return -1.0, at, -1.0, at + 2
    contact = element - frictions
    at = contact_guards(frictions, contact)
    side, active = m[contact_modes(frictions, contact)], m[contact_modes(frictions, contact) + 1]
    if side == 0.0:
        return 1.0 if g[at] >= 0.0 else -1.0, at, -1.0, at + 1
    face = at + 2 if side > 0.0 else at + 3
    if active > 0.0:
        return -side, face, 0.0, face
    if side * g[face] >= g[at + 1] - side * g[at]:
        return side, face, 0.0, face
    return -side, at, 1.0, at + 1


@kernel
def violation_gradient(element, m, g, gx, gp, friction_rates, by_x, by_p):
    """Write the gradient of `violation` into by_x [n] and by_p [np], on its active branch, from the
    guards' Jacobians gx [guards, n] and gp [guards, np].
    """
    if element < len(friction_rates) and m[element] != 0.0:
        for i in range(len(by_x)):
            by_x[i] = 0.0
        for i in range(len(by_p)):
            by_p[i] = 0.0
        by_x[friction_rates[element]] = -m[element]
        return
    sign, row, limit_sign, limit = _active_guards(element, m, g, len(friction_rates))
    _fill_difference(sign, row, limit_sign, limit, gx, by_x)
    _fill_difference(sign, row, limit_sign, limit, gp, by_p)


@kernel
def switch_contacts(equations, m, g):
    """Move every violated contact to its next mode, in m; g are the guards."""
    frictions, contacts = len(equations.friction_rates), equations.contacts
    for contact in range(contact_count(frictions, len(m))):
        at = contact_guards(frictions, contact)
        where = contact_modes(frictions, contact)
        side = m[where]
        if side == 0.0:
            if abs(g[at]) > g[at + 1]:
                side = 1.0 if g[at] > 0.0 else -1.0
                m[where] = side
                pushing = side * (g[at + 2] if side > 0.0 else g[at + 3])
                m[where + 1] = 1.0 if pushing > 0.0 else 0.0
            continue
        pushing = side * (g[at + 2] if side > 0.0 else g[at + 3])
        if contacts[contact, PRESSED] == 1:
            if pushing > 0.0 or g[at + 1] - side * g[at] > 0.0:
                contacts[contact, PRESSED] = 0
                m[where + 1] = 1.0 if pushing > 0.0 else 0.0
        elif m[where + 1] > 0.0:
            if pushing < 0.0:
                m[where + 1] = 0.0
        elif g[at + 1] - side * g[at] > 0.0:
            m[where] = 0.0
        elif pushing > 0.0:
            m[where + 1] = 1.0


@kernel
def settle(equations, t, x, u, watch, tangents):
    """Find consistent modes and rates at one instant t in s, x [n] in place; False on chattering.

    Order matters: rates that reversed are zeroed first, then contacts switch and rigid faces
    strike, then the holding torque of every resting friction decides whether it sticks or slides.
    Ties end in sticking.
    """
    m, g = watch.m, watch.g
    friction_rates, zero_at_rest = equations.friction_rates, equations.zero_at_rest
    frictions = len(friction_rates)
    for _ in range(20):
        for k in range(frictions):
            if m[k] != 0.0 and violation(k, x, m, g, friction_rates) > 0.0:
                x[friction_rates[k]] = 0.0
                m[k] = 0.0
                rest_together(friction_rates[k], equations, m, x)
                for a in range(len(x)):
                    if zero_at_rest[a] == k:
                        x[a] = 0.0
        fill_guards(equations, t, x, u, watch)
        switch_contacts(equations, m, g)
        strike_faces(equations, t, x, u, watch, tangents)
        press(equations, t, x, u, watch)
        fill_guards(equations, t, x, u, watch)
        for k in range(frictions):
            if m[k] == 0.0:
                if g[friction_guards(k)] > g[friction_guards(k) + 1]:
                    m[k] = 1.0
                elif -g[friction_guards(k)] > g[friction_guards(k) + 2]:
                    m[k] = -1.0
        fill_guards(equations, t, x, u, watch)
        if largest_violation(x, m, g, friction_rates) <= 0.0:
            return True
    return False
