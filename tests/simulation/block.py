"""A block on a spring with dry friction, as a module of the emitted kind: for closed forms.

J omega' = tau - k theta - k3 theta^3 - F_c sign(omega); at rest it holds up to F_s. The friction
drops from F_s to F_c at once, which no emitted law does, and which closed forms assume.
"""

import math
import types

import numpy as np
from numba import njit

from ptp_symbolic.numeric.runtime.model import Model

J, K, F_C, F_S = 0.5, 8.0, 0.3, 0.5


@njit
def pull(x, u, p):
    return u[0] - p[1] * x[0] - p[4] * x[0] ** 3


@njit
def stiffness(x, p):
    return p[1] + 3.0 * p[4] * x[0] ** 2


@njit(error_model="numpy", nogil=True)
def mode_derivative(t, x, u, p, m, dx):
    dx[0] = x[1]
    dx[1] = 0.0 if m[0] == 0.0 else (pull(x, u, p) - m[0] * p[2]) / p[0]


@njit(error_model="numpy", nogil=True)
def prepare(p, c):
    return


@njit(error_model="numpy", nogil=True)
def prepared_derivative(t, x, u, p, m, c, dx):
    mode_derivative(t, x, u, p, m, dx)


@njit(error_model="numpy", nogil=True)
def linearize(t, x, u, p, m, fx, fu, fp, gx, gp):
    slides = m[0] * m[0]
    fx[0, 1] = 1.0
    fx[1, 0] = -slides * stiffness(x, p) / p[0]
    fu[1, 0] = slides / p[0]
    if len(fp) == 0:
        return
    fp[1, 0] = -slides * (pull(x, u, p) - m[0] * p[2]) / p[0] ** 2
    fp[1, 1] = -slides * x[0] / p[0]
    fp[1, 2] = -m[0] / p[0]
    fp[1, 4] = -slides * x[0] ** 3 / p[0]
    if len(gx) == 0:
        return
    gx[0, 0] = -stiffness(x, p)
    gp[0, 1] = -x[0]
    gp[0, 4] = -(x[0] ** 3)
    gp[1, 3] = 1.0
    gp[2, 3] = 1.0


@njit(error_model="numpy", nogil=True)
def guards(t, x, u, p, m, g):
    g[0] = pull(x, u, p)
    g[1] = p[3]
    g[2] = p[3]


@njit(error_model="numpy", nogil=True)
def energy(t, x, u, p, m, e):
    e[0] = 0.5 * p[0] * x[1] ** 2 + 0.5 * p[1] * x[0] ** 2 + 0.25 * p[4] * x[0] ** 4
    e[1] = u[0] * x[1]
    e[2] = m[0] * p[2] * x[1]


@njit(error_model="numpy", nogil=True)
def initial_modes(t, x, u, p, m):
    hold = pull(x, u, p)
    m[0] = np.sign(x[1])
    if m[0] == 0.0 and abs(hold) > p[3]:
        m[0] = math.copysign(1.0, hold)


@njit(error_model="numpy", nogil=True)
def outputs(t, x, u, p, y):
    y[0] = x[0]


@njit(error_model="numpy", nogil=True)
def output_jacobian(t, x, u, p, yx, yp):
    yx[0, 0] = 1.0


def block() -> Model:
    """The block with J, K, F_C and F_S as defaults."""
    module = types.ModuleType("block")
    module.__dict__.update(
        mode_derivative=mode_derivative,
        PREPARED=0,
        prepare=prepare,
        prepared_derivative=prepared_derivative,
        linearize=linearize,
        guards=guards,
        energy=energy,
        initial_modes=initial_modes,
        outputs=outputs,
        output_jacobian=output_jacobian,
        NAME="block",
        AXES=("pan",),
        STATE_NAMES=("theta_pan", "omega_pan"),
        STATE_UNITS=("rad", "rad/s"),
        STATE_INITIAL=(0.0, 0.0),
        INPUT_NAMES=("tau_pan",),
        INPUT_UNITS=("N m",),
        INPUT_DELAYS=(-1,),
        INPUT_ACTS=(True,),
        OUTPUT_NAMES=("theta_pan",),
        OUTPUT_UNITS=("rad",),
        MODE_NAMES=("slide_pan",),
        SAMPLERS=(),
        SAMPLED=(),
        FRICTION_RATES=np.array([1]),
        ZERO_AT_REST=(-1, -1),
        CONTACT_ANGLES=(),
        SEARCH=(),
        DOMAIN=(),
        REQUIREMENTS=(),
        domain=lambda p, bounds: None,
        margins=lambda p, margin: None,
        EFFECTS=(),
        PARAMETERS=(
            ("J", "kg m^2", J, 1e-6, 1e6, "inertia"),
            ("k", "N m/rad", K, 0.0, 1e6, "stiffness"),
            ("F_c", "N m", F_C, 0.0, 1e6, "sliding friction"),
            ("F_s", "N m", F_S, 0.0, 1e6, "breakaway"),
            ("k3", "N m/rad^3", 0.0, 0.0, 1e6, "cubic stiffness"),
        ),
    )
    return Model(module)
