"""Rigid faces in steps of fixed length: they strike where they have closed by the end of a step.

As in `simulate(method="fixed_step")` (Moreau, 1988): speeds tell, not depth. Newton's law of
restitution; a gear output that leans on a joint that sticks is pressed: both rest.
"""

from numba.extending import register_jitable

from ptp_symbolic.numeric.gpu.machine import copy

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
