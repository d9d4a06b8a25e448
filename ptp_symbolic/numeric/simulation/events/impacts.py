"""Rigid contacts: impacts at one instant, and what a body brings to rest along with itself.

Newton's law of restitution: a speed of approach v leaves the faces parting at e v, unless that is
below RESTING_SPEED: then they stay together, so that bounces that grow ever shorter (Zeno) end
after finitely many. What is cut off are flights no higher than RESTING_SPEED squared over twice the
acceleration. Bodies that are joined by another rigid contact are struck as one.

A gear output that leans on a joint that sticks: both rest.

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


DEAD_BAND = 1e-12  # rad/s
SPRUNG = 0
SETTLING = 4  # flag of a contact whose next bounce would be shorter than a step of fixed length


@kernel
def strike_faces(equations, t, x, u, watch, tangents):
    """Apply the impact law to every rigid contact that has just closed; x [n] jumps in place."""
    m, contacts = watch.m, equations.contacts
    for contact in range(len(contacts)):
        gear, joint, rule = contacts[contact, 0], contacts[contact, 1], contacts[contact, 2]
        where = contact_modes(len(equations.friction_rates), contact)
        if rule == SPRUNG:
            continue
        if m[where + 1] == 0.0:
            if rule == STICKS and x[joint] != 0.0:
                hold(joint, equations, t, x, u, watch)
        elif m[where] * (x[gear] - x[joint]) > DEAD_BAND:
            strike(contact, equations, t, x, u, watch, tangents)


@inlined
def hold(joint, equations, t, x, u, watch):
    """Zero the rate of a joint that friction locks; it moves only where a coupled impact has turned
    it back. Adds the energy lost in J to `watch.lost`.
    """
    m, energies = watch.m, watch.energies
    call(equations.energy, t, x, u, equations.p, m, energies[0])
    x[joint] = 0.0
    call(equations.energy, t, x, u, equations.p, m, energies[1])
    watch.lost[0] += energies[0, 0] - energies[1, 0]


@inlined
def strike(contact, equations, t, x, u, watch, tangents):
    """Change the rates in x [n] by one impact; adds the energy lost in J to `watch.lost`."""
    n, m, changes = len(x), watch.m, watch.strike
    where, at = contact_modes(len(equations.friction_rates), contact), contact * (n + 2)
    m[where + 1] = 0.0
    call(equations.impacts, t, x, u, equations.p, m, changes)
    speed = abs(x[equations.contacts[contact, 0]] - x[equations.contacts[contact, 1]])
    bounces = equations.contacts[contact, SETTLING] == 0
    bounces = bounces and changes[at + n] * speed > RESTING_SPEED
    restitution = changes[at + n] if bounces else 0.0
    if tangents is not None and tangents.table.shape[1] > 0:
        call(equations.impact_jacobian, t, x, u, equations.p, m, watch.strike_x, watch.strike_p)
        strike_tangents(at, restitution, watch, tangents)
    watch.lost[0] += (1.0 - restitution * restitution) * changes[at + n + 1]
    for a in range(n):
        x[a] += (1.0 + restitution) * changes[at + a]
    for f in range(len(equations.friction_rates)):
        rate = equations.friction_rates[f]
        if changes[at + rate] != 0.0:
            m[f] = 1.0 if x[rate] > 0.0 else -1.0 if x[rate] < 0.0 else 0.0
    m[where + 1] = 1.0 if restitution == 0.0 else 0.0


@inlined
def strike_tangents(at, restitution, watch, tangents):
    """Propagate the tangents through the impact whose rows of the Jacobians begin at `at`."""
    s, change = tangents.table, watch.by_x
    n = s.shape[0]
    for c in range(s.shape[1]):
        for a in range(n):
            change[a] = (1.0 + restitution) * along_tangent(at + a, c, watch, tangents)
        if restitution > 0.0:
            more = along_tangent(at + n, c, watch, tangents)
            for a in range(n):
                change[a] += more * watch.strike[at + a]
        for a in range(n):
            s[a, c] += change[a]


@inlined
def along_tangent(row, c, watch, tangents):
    """Directional derivative of one entry of watch.strike along the tangent c."""
    result = watch.strike_p[row, tangents.columns[c]] if c < len(tangents.columns) else 0.0
    for b in range(tangents.table.shape[0]):
        result += watch.strike_x[row, b] * tangents.table[b, c]
    return result


@kernel
def rest_together(rate, equations, m, x):
    """Zero the rates of a lasting rigid contact once friction has brought state `rate` to rest."""
    for contact in range(len(equations.contacts)):
        gear, joint = equations.contacts[contact, 0], equations.contacts[contact, 1]
        joined = m[contact_modes(len(equations.friction_rates), contact) + 1] > 0.0
        if equations.contacts[contact, 2] != SPRUNG and joined and rate in (gear, joint):
            x[gear], x[joint] = 0.0, 0.0


@kernel
def clear_resting(equations, m, s):
    """Zero the tangents [n, ns] of rates that friction, a stuck partner or a gap locks."""
    frictions = len(equations.friction_rates)
    for f in range(frictions):
        if m[f] == 0.0:
            clear(s[equations.friction_rates[f]])
    for contact in range(len(equations.contacts)):
        gear, joint = equations.contacts[contact, 0], equations.contacts[contact, 1]
        rule = equations.contacts[contact, 2]
        joined = m[contact_modes(frictions, contact) + 1] > 0.0
        if rule == STICKS and not joined:
            clear(s[joint])
        if equations.contacts[contact, PRESSED] == 1:
            clear(s[gear])
        for f in range(frictions):
            if rule != SPRUNG and joined and m[f] == 0.0:
                rate = equations.friction_rates[f]
                if rate in (gear, joint):
                    clear(s[gear])
                    clear(s[joint])
