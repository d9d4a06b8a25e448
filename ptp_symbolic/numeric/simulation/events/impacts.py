"""Rigid contacts: impacts at one instant, and what a body brings to rest along with itself.

Newton's law of restitution: a speed of approach v leaves the faces parting at e v, unless that is
below RESTING_SPEED: then they stay together, so that bounces that grow ever shorter (Zeno) end
after finitely many. What is cut off are flights no higher than RESTING_SPEED squared over twice the
acceleration. Bodies that are joined by another rigid contact are struck as one.
"""

from ptp_symbolic.numeric.runtime.element_layout import contact_modes
from ptp_symbolic.numeric.simulation.events.pressed import PRESSED, RESTING_SPEED, STICKS
from ptp_symbolic.numeric.simulation.kernels.calls import call
from ptp_symbolic.numeric.simulation.kernels.records import clear, inlined, kernel

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
