"""The parts of an emitted module that are the same for every model."""

STATE_DERIVATIVE_SMOOTH = '''@njit(cache=True, error_model="numpy", nogil=True)
def initial_modes(t, x, u, p, m):
    """Leave m alone: this model has no modes."""
    return


@njit(cache=True, error_model="numpy", nogil=True)
def state_derivative(t, x, u, p, dx):
    """Write the time derivative of the state into dx."""
    mode_derivative(t, x, u, p, x, dx)'''

_BEGIN_MODES = '''@njit(cache=True, error_model="numpy", nogil=True)
def initial_modes(t, x, u, p, m):
    """Find the modes of a state: contact from the separation, sticking from the holding torque."""
    frictions = len(FRICTION_RATES)
    contacts = (len(m) - frictions) // 2
    g = np.empty(3 * frictions + 4 * contacts)
    m[:] = 0.0
    guards(t, x, u, p, m, g)
'''

_SPRUNG_CONTACTS = """    for k in range(contacts):
        at = 3 * frictions + 4 * k
        side = 1.0 if g[at] > 0.0 else -1.0
        if side * g[at] > g[at + 1]:
            torque = g[at + 2] if side > 0.0 else g[at + 3]
            m[frictions + 2 * k] = side
            m[frictions + 2 * k + 1] = 1.0 if side * torque > 0.0 else 0.0
    for k in range(frictions):
        m[k] = np.sign(x[FRICTION_RATES[k]])
"""

_RIGID_CONTACTS = """    for k in range(contacts):
        gear, joint, rule = RIGID_CONTACTS[k]
        at, where = 3 * frictions + 4 * k, frictions + 2 * k
        side = 1.0 if g[at] > 0.0 else -1.0
        within = 0.0 if rule == 0 else FACE_WIDTH
        if side * g[at] > g[at + 1] - within:
            torque = g[at + 2] if side > 0.0 else g[at + 3]
            m[where] = side
            m[where + 1] = 1.0 if side * torque > 0.0 else 0.0
            if rule > 0:
                m[where + 1] = 1.0 if abs(x[gear] - x[joint]) <= SAME_SPEED else 0.0
    for k in range(frictions):
        m[k] = np.sign(x[FRICTION_RATES[k]])
    guards(t, x, u, p, m, g)
    for k in range(contacts):
        at, where = 3 * frictions + 4 * k, frictions + 2 * k
        if RIGID_CONTACTS[k, 2] > 0 and m[where + 1] > 0.0:
            push = m[where] * (g[at + 2] if m[where] > 0.0 else g[at + 3])
            m[where + 1] = 1.0 if push >= 0.0 else 0.0
"""

_END_MODES = '''    guards(t, x, u, p, m, g)
    for k in range(frictions):
        if m[k] == 0.0 and g[3 * k] > g[3 * k + 1]:
            m[k] = 1.0
        elif m[k] == 0.0 and -g[3 * k] > g[3 * k + 2]:
            m[k] = -1.0


@njit(cache=True, error_model="numpy", nogil=True)
def state_derivative(t, x, u, p, dx):
    """Write the time derivative of the state into dx, in the modes that the state implies."""
    m = np.empty(len(MODE_NAMES))
    initial_modes(t, x, u, p, m)
    mode_derivative(t, x, u, p, m, dx)'''

_FACES = """FACE_WIDTH, SAME_SPEED = 1e-9, 1e-9  # rad, rad/s: what counts as lasting contact


"""


def state_derivative_text(modes: bool, rigid: bool) -> str:
    """The functions that find the modes of a state; `rigid` where rigid bodies meet."""
    if not modes:
        return STATE_DERIVATIVE_SMOOTH
    faces, contacts = (_FACES, _RIGID_CONTACTS) if rigid else ("", _SPRUNG_CONTACTS)
    return faces + _BEGIN_MODES + contacts + _END_MODES
