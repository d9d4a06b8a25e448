"""A gear output that leans on a joint that sticks: both rest.

Where friction holds the joint in the gap, a load that would drive the gear back through a closed
face stops both: friction carries what the gear does not. Else the modes would chatter: the joint
sticks, the gear pushed onto it, both are driven back. The rest ends when the gear turns away, or
when it pushes the joint on. A contact at such a rest is not active, and its flag PRESSED is set.
"""

from ptp_symbolic.numeric.runtime.element_layout import contact_guards, contact_modes
from ptp_symbolic.numeric.simulation.kernels.calls import call
from ptp_symbolic.numeric.simulation.kernels.records import clear, copy, inlined, kernel

PRESSED = 3
STICKS = 2
RESTING_SPEED = 1e-5  # rad/s; slower parts that touch stay together


@inlined
def derivative(equations, t, x, u, m, out):
    """Write dx/dt [n]; a gear output pressed onto a sticking joint stays at rest."""
    call(equations.derivative, t, x, u, equations.p, m, equations.prepared, out)
    for contact in range(len(equations.contacts)):
        if equations.contacts[contact, PRESSED] == 1:
            out[equations.contacts[contact, 0]] = 0.0


@inlined
def jacobian(equations, t, x, u, m, fx, fu, fp):
    """Write the Jacobians fx [n, n], fu [n, nu], fp [n, np] of `derivative`; an fp without rows is
    not asked for.
    """
    none = fx[:0]
    call(equations.linearize, t, x, u, equations.p, m, fx, fu, fp, none, none)
    for contact in range(len(equations.contacts)):
        if equations.contacts[contact, PRESSED] == 1:
            gear = equations.contacts[contact, 0]
            clear(fx[gear])
            clear(fu[gear])
            if len(fp) > 0:
                clear(fp[gear])


@inlined
def hold_at_rest(equations, m, x, end):
    """Copy what rests from the start x [n] of a step to its `end` [n]: rounding would make it
    creep.
    """
    for f in range(len(equations.friction_rates)):
        if m[f] == 0.0:
            end[equations.friction_rates[f]] = x[equations.friction_rates[f]]
    for contact in range(len(equations.contacts)):
        if equations.contacts[contact, PRESSED] == 1:
            end[equations.contacts[contact, 0]] = x[equations.contacts[contact, 0]]


@inlined
def fill_guards(equations, t, x, u, watch):
    """Write the guards into watch.g; those of a pressed contact say whether it is released."""
    call(equations.guards, t, x, u, equations.p, watch.m, watch.g)
    for contact in range(len(equations.contacts)):
        if equations.contacts[contact, PRESSED] == 1:
            fill_guards_of_pressed(contact, equations, t, x, u, watch)


@kernel
def fill_guards_of_pressed(contact, equations, t, x, u, watch):
    """Write the guards of a pressed contact: accelerations in rad/s^2."""
    frictions = len(equations.friction_rates)
    at, side = contact_guards(frictions, contact), watch.m[contact_modes(frictions, contact)]
    watch.g[at] = side * acceleration(contact, 0.0, equations, t, x, u, watch)
    watch.g[at + 1] = 0.0
    watch.g[at + 2] = side * acceleration(contact, 1.0, equations, t, x, u, watch)
    watch.g[at + 3] = watch.g[at + 2]


@kernel
def acceleration(contact, active, equations, t, x, u, watch):
    """Acceleration of the gear towards its face, alone (0) or with the joint (1), in rad/s^2."""
    m, where = watch.m, contact_modes(len(equations.friction_rates), contact)
    gear, joint = equations.contacts[contact, 0], equations.contacts[contact, 1]
    copy(m, watch.m_kept)
    m[where + 1] = active
    for f in range(len(equations.friction_rates)):
        if equations.friction_rates[f] == gear or equations.friction_rates[f] == joint:
            m[f] = m[where]
    call(equations.derivative, t, x, u, equations.p, m, equations.prepared, watch.trial)
    copy(watch.m_kept, m)
    return m[where] * watch.trial[gear]


@kernel
def press(equations, t, x, u, watch):
    """Bring to rest, in x [n] and the modes, every gear output pushed onto a joint that sticks."""
    m, contacts = watch.m, equations.contacts
    frictions = len(equations.friction_rates)
    for contact in range(len(contacts)):
        gear, joint = contacts[contact, 0], contacts[contact, 1]
        where = contact_modes(frictions, contact)
        touching = m[where] != 0.0 and m[where + 1] == 0.0 and abs(x[gear]) <= RESTING_SPEED
        if contacts[contact, 2] != STICKS or contacts[contact, PRESSED] == 1 or not touching:
            continue
        if acceleration(contact, 0.0, equations, t, x, u, watch) <= 0.0:
            continue
        if acceleration(contact, 1.0, equations, t, x, u, watch) > 0.0:
            continue
        contacts[contact, PRESSED] = 1
        x[gear] = 0.0
        for f in range(frictions):
            if equations.friction_rates[f] == gear or equations.friction_rates[f] == joint:
                m[f] = 0.0
                for a in range(len(x)):
                    if equations.zero_at_rest[a] == f:
                        x[a] = 0.0
