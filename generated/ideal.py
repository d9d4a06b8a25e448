"""Balanced pan-tilt platform of the thesis: equations of motion, emitted; do not edit.

M(q) q'' = forcing - friction, with the lower triangle of M by symmetry:

  M[0, 0] = inertia_pan + inertia_pan_per_sin_tilt*sin(theta_tilt)
  M[1, 1] = J_y_tilt
  forcing[omega_pan] = -b_pan*omega_pan - 2*coriolis*omega_tilt + tau_pan
  forcing[omega_tilt] = -b_tilt*omega_tilt + coriolis*omega_pan + tau_tilt

with the functions named above, in order of use:

  inertia_pan = J_pan + J_z_tilt
  inertia_pan_sin_sq_tilt = J_x_tilt - J_z_tilt
  inertia_pan_per_sin_tilt = inertia_pan_sin_sq_tilt*sin(theta_tilt)
  coriolis = inertia_pan_per_sin_tilt*omega_pan*cos(theta_tilt)


Operations of the state derivative: 46 as derived, 22 as written, 19 of them at every
call where `prepare` does the others once per parameter set.

Effects:
- rigid_bodies: thesis Eq. 3.8, Table 5.1
- viscous_friction (pan): thesis Eq. 2.8, Eq. 3.8 (b_p, b_t)
- viscous_friction (tilt): thesis Eq. 2.8, Eq. 3.8 (b_p, b_t)
"""

import math

from numba import njit

MODEL_HASH = "ed093a152caf5434"
NAME = "ideal"
TITLE = "Balanced pan-tilt platform of the thesis"
# How many numbers `prepare` writes.
PREPARED = 3
AXES = ("pan", "tilt")
STATE_NAMES = ("theta_pan", "theta_tilt", "omega_pan", "omega_tilt")
STATE_UNITS = ("rad", "rad", "rad/s", "rad/s")
STATE_INITIAL = (0.0, 0.0, 0.0, 0.0)
INPUT_NAMES = ("tau_pan", "tau_tilt")
INPUT_UNITS = ("N m", "N m")
# Per input: index of the parameter by which it is late, or -1.
INPUT_DELAYS = (-1, -1)
# Per input: whether motion depends on it, and not samplers alone.
INPUT_ACTS = (True, True)
OUTPUT_NAMES = ("theta_pan", "theta_tilt")
OUTPUT_UNITS = ("rad", "rad")
MODE_NAMES = ()
FRICTION_RATES = ()
# Per state: the friction that sets it to zero when it comes to rest, or -1.
ZERO_AT_REST = (-1, -1, -1, -1)
# Samplers: parameters of the period. Sampled: sampler and state of each update.
SAMPLERS = ()
SAMPLED = ()
# Per contact: state index of the angle at the gear output and at the joint.
CONTACT_ANGLES = ()
# Limits of the equations: state, meaning; `domain` gives the bounds.
DOMAIN = ()
# Parameters: name, unit, default, lower and upper bound, meaning.
PARAMETERS = (
    ("J_pan", "kg m^2", 0.00053, 1e-12, 10000.0, "inertia of the pan body about z"),
    ("J_x_tilt", "kg m^2", 0.00041, 1e-12, 10000.0, "inertia of the tilt body about x"),
    ("J_y_tilt", "kg m^2", 0.00065, 1e-12, 10000.0, "inertia of the tilt body about y"),
    ("J_z_tilt", "kg m^2", 0.00027, 1e-12, 10000.0, "inertia of the tilt body about z"),
    ("b_pan", "N m s/rad", 0.1, 0.0, 10000.0, "viscous friction in the pan joint"),
    ("b_tilt", "N m s/rad", 0.1, 0.0, 10000.0, "viscous friction in the tilt joint"),
)


# Arguments, in SI: t in s; x in STATE_UNITS, u in INPUT_UNITS, p in the units of PARAMETERS;
# modes m as MODE_NAMES; c as `prepare` writes it. Lengths and shapes are in brackets.
@njit(cache=True, error_model="numpy", nogil=True, forceinline=True, _nrt=False)
def constants(p):
    """Return what depends on the parameters alone."""
    J_pan, J_x_tilt, J_y_tilt, J_z_tilt = p[0], p[1], p[2], p[3]
    inertia_pan_sin_sq_tilt = J_x_tilt - J_z_tilt
    inertia_pan = J_pan + J_z_tilt
    inverse_mass_tilt = 1.0 / J_y_tilt
    return inertia_pan_sin_sq_tilt, inertia_pan, inverse_mass_tilt


@njit(cache=True, error_model="numpy", nogil=True, forceinline=True, _nrt=False)
def mass_and_forces(t, x, u, p, c):
    """Return mass matrix, forces and what else the functions below have in common."""
    theta_tilt, omega_pan, omega_tilt = x[1], x[2], x[3]
    tau_pan, tau_tilt = u[0], u[1]
    b_pan, b_tilt = p[4], p[5]
    inertia_pan_sin_sq_tilt, inertia_pan = c[0], c[1]
    cos_tilt = math.cos(theta_tilt)
    sin_tilt = math.sin(theta_tilt)
    inertia_pan_per_sin_tilt = inertia_pan_sin_sq_tilt * sin_tilt
    coriolis = cos_tilt * inertia_pan_per_sin_tilt * omega_pan
    force_pan = -b_pan * omega_pan - 2.0 * coriolis * omega_tilt + tau_pan
    mass_pan = inertia_pan + inertia_pan_per_sin_tilt * sin_tilt
    force_tilt = -b_tilt * omega_tilt + coriolis * omega_pan + tau_tilt
    return force_pan, mass_pan, force_tilt


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def prepare(p, c):
    """Write into c what prepared_derivative takes from the parameters alone.

    p [6]; c [3].
    c: what `constants` returns, in its order.
    """
    values = constants(p)
    for k in range(PREPARED):
        c[k] = values[k]


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def prepared_derivative(t, x, u, p, m, c, dx):
    """Write the time derivative of the state into dx in the modes m, c being prepared.

    t, x [4], u [2], p [6], m [0], c [3]; dx [4] in STATE_UNITS per s.
    """
    forces = mass_and_forces(t, x, u, p, c)
    force_pan, mass_pan, force_tilt = forces[0], forces[1], forces[2]
    omega_pan, omega_tilt = x[2], x[3]
    inverse_mass_tilt = c[2]
    dx[0] = omega_pan  # rate_of_theta_pan
    dx[1] = omega_tilt  # rate_of_theta_tilt
    inverse_mass_pan = 1.0 / mass_pan
    dx[2] = force_pan * inverse_mass_pan  # accel_pan
    dx[3] = force_tilt * inverse_mass_tilt  # accel_tilt


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def mode_derivative(t, x, u, p, m, dx):
    """Write the time derivative of the state into dx in the modes m.

    t, x [4], u [2], p [6], m [0]; dx [4] in STATE_UNITS per s.
    """
    prepared_derivative(t, x, u, p, m, constants(p), dx)


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def guards(t, x, u, p, m, g):
    """Write holding and breakaway torques, gap separations and contact torques into g.

    t, x [4], u [2], p [6], m [0]; g [0] in N m and rad.
    """
    return


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def energy(t, x, u, p, m, e):
    """Write stored energy in J, power in and dissipated power in W into e.

    t, x [4], u [2], p [6], m [0]; e [3] in J, W and W.
    e: stored, power_in, dissipated.
    """
    c = constants(p)
    forces = mass_and_forces(t, x, u, p, c)
    mass_pan = forces[1]
    omega_pan, omega_tilt = x[2], x[3]
    tau_pan, tau_tilt = u[0], u[1]
    J_y_tilt, b_pan, b_tilt = p[2], p[4], p[5]
    omega_tilt_sq = omega_tilt * omega_tilt
    omega_pan_sq = omega_pan * omega_pan
    e[0] = 0.5 * J_y_tilt * omega_tilt_sq + 0.5 * mass_pan * omega_pan_sq  # stored
    e[1] = omega_pan * tau_pan + omega_tilt * tau_tilt  # power_in
    e[2] = b_pan * omega_pan_sq + b_tilt * omega_tilt_sq  # dissipated


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def equation_error(t, x, u, p, m, r):
    """Write torques that rows lack, then other states' rates, into r; x ends in accelerations.

    t, x [6], u [2], p [6], m [0]; r [2] in N m, then STATE_UNITS per s.
    x: STATE_NAMES, then given_accel_pan, given_accel_tilt.
    r: torque_pan, torque_tilt.
    """
    c = constants(p)
    forces = mass_and_forces(t, x, u, p, c)
    force_pan, mass_pan, force_tilt = forces[0], forces[1], forces[2]
    given_accel_pan, given_accel_tilt = x[4], x[5]
    J_y_tilt = p[2]
    r[0] = -force_pan + given_accel_pan * mass_pan  # torque_pan
    r[1] = J_y_tilt * given_accel_tilt - force_tilt  # torque_tilt


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def mass_matrix(t, x, u, p, m, M):
    """Write the mass matrix of the joints, then of gear outputs, into M.

    t, x [4], u [2], p [6], m [0]; M [2, 2] in kg m^2.
    """
    c = constants(p)
    forces = mass_and_forces(t, x, u, p, c)
    mass_pan = forces[1]
    J_y_tilt = p[2]
    M[0, 0] = mass_pan
    M[0, 1] = 0.0  # mass_pan_tilt
    M[1, 0] = 0.0  # mass_pan_tilt
    M[1, 1] = J_y_tilt  # mass_tilt


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def gravity_torque(t, x, u, p, m, G):
    """Write the torques that hold the machine against its weight into G.

    t, x [4], u [2], p [6], m [0]; G [2] in N m.
    G: gravity_torque_pan, gravity_torque_tilt.
    """
    G[0] = 0.0  # gravity_torque_pan
    G[1] = 0.0  # gravity_torque_tilt


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def linearize(t, x, u, p, m, fx, fu, fp, gx, gp):
    """Write the non-zero derivatives of dx into fx, fu, fp and those of guards into gx, gp.

    t, x [4], u [2], p [6], m [0]; fx [4, 4]; fu [4, 2]; fp [4, 6]; gx [0, 4]; gp [0, 6].
    fx: rows and columns as STATE_NAMES; fu: rows as STATE_NAMES, columns as INPUT_NAMES; fp: rows
      as STATE_NAMES, columns as PARAMETERS; gx: rows as g of guards, columns as STATE_NAMES; gp:
      rows as g of guards, columns as PARAMETERS.
    Where fp or gx is empty, it and what follows it is not computed.
    """
    theta_tilt, omega_pan, omega_tilt = x[1], x[2], x[3]
    tau_pan, tau_tilt = u[0], u[1]
    J_pan, J_x_tilt, J_y_tilt, J_z_tilt, b_pan, b_tilt = p[0], p[1], p[2], p[3], p[4], p[5]
    inertia_pan = J_pan + J_z_tilt
    inertia_pan_sin_sq_tilt = J_x_tilt - J_z_tilt
    sin_tilt = math.sin(theta_tilt)
    inertia_pan_per_sin_tilt = inertia_pan_sin_sq_tilt * sin_tilt
    inertia_pan_per_sin_tilt_sin_tilt = inertia_pan_per_sin_tilt * sin_tilt
    mass_pan = inertia_pan + inertia_pan_per_sin_tilt_sin_tilt
    inverse_mass_pan = 1.0 / mass_pan
    cos_tilt = math.cos(theta_tilt)
    coriolis_by_inertia_pan_per_sin_tilt = cos_tilt * omega_pan
    coriolis = coriolis_by_inertia_pan_per_sin_tilt * inertia_pan_per_sin_tilt
    twice_omega_tilt = 2.0 * omega_tilt
    force_pan = -b_pan * omega_pan - coriolis * twice_omega_tilt + tau_pan
    accel_pan = force_pan * inverse_mass_pan
    coriolis_by_omega_pan = cos_tilt * inertia_pan_per_sin_tilt
    inertia_pan_per_sin_tilt_by_theta_tilt = cos_tilt * inertia_pan_sin_sq_tilt
    coriolis_by_theta_tilt = (coriolis_by_inertia_pan_per_sin_tilt
        * inertia_pan_per_sin_tilt_by_theta_tilt - inertia_pan_per_sin_tilt_sin_tilt * omega_pan)
    fx[2, 1] = (inverse_mass_pan * (-accel_pan * (coriolis_by_omega_pan
        + inertia_pan_per_sin_tilt_by_theta_tilt * sin_tilt)
        - coriolis_by_theta_tilt * twice_omega_tilt))  # accel_pan_by_theta_tilt
    inverse_mass_tilt = 1.0 / J_y_tilt
    fx[3, 1] = coriolis_by_theta_tilt * inverse_mass_tilt * omega_pan  # accel_tilt_by_theta_tilt
    fx[0, 2] = 1.0  # rate_of_theta_pan_by_omega_pan
    # accel_pan_by_omega_pan
    fx[2, 2] = inverse_mass_pan * (-b_pan - coriolis_by_omega_pan * twice_omega_tilt)
    # accel_tilt_by_omega_pan
    fx[3, 2] = inverse_mass_tilt * (coriolis + coriolis_by_omega_pan * omega_pan)
    fx[1, 3] = 1.0  # rate_of_theta_tilt_by_omega_tilt
    fx[2, 3] = -2.0 * coriolis * inverse_mass_pan  # accel_pan_by_omega_tilt
    fx[3, 3] = -b_tilt * inverse_mass_tilt  # accel_tilt_by_omega_tilt
    fu[2, 0] = inverse_mass_pan  # accel_pan_by_tau_pan
    fu[3, 1] = inverse_mass_tilt  # accel_tilt_by_tau_tilt
    if len(fp) == 0:
        return
    accel_pan_by_inertia_pan = -accel_pan * inverse_mass_pan
    fp[2, 0] = accel_pan_by_inertia_pan  # accel_pan_by_J_pan
    coriolis_by_inertia_pan_sin_sq_tilt = coriolis_by_inertia_pan_per_sin_tilt * sin_tilt
    accel_pan_by_inertia_pan_sin_sq_tilt = (inverse_mass_pan * (-accel_pan * (sin_tilt * sin_tilt)
        - coriolis_by_inertia_pan_sin_sq_tilt * twice_omega_tilt))
    fp[2, 1] = accel_pan_by_inertia_pan_sin_sq_tilt  # accel_pan_by_J_x_tilt
    accel_tilt_by_inertia_pan_sin_sq_tilt = (coriolis_by_inertia_pan_sin_sq_tilt * inverse_mass_tilt
        * omega_pan)
    fp[3, 1] = accel_tilt_by_inertia_pan_sin_sq_tilt  # accel_tilt_by_J_x_tilt
    force_tilt = -b_tilt * omega_tilt + coriolis * omega_pan + tau_tilt
    accel_tilt = force_tilt * inverse_mass_tilt
    fp[3, 2] = -accel_tilt * inverse_mass_tilt  # accel_tilt_by_J_y_tilt
    # accel_pan_by_J_z_tilt
    fp[2, 3] = accel_pan_by_inertia_pan - accel_pan_by_inertia_pan_sin_sq_tilt
    fp[3, 3] = -accel_tilt_by_inertia_pan_sin_sq_tilt  # accel_tilt_by_J_z_tilt
    fp[2, 4] = -inverse_mass_pan * omega_pan  # accel_pan_by_b_pan
    fp[3, 5] = -inverse_mass_tilt * omega_tilt  # accel_tilt_by_b_tilt


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def outputs(t, x, u, p, y):
    """Write the measured signals into y.

    t, x [4], u [2], p [6]; y [2] in OUTPUT_UNITS.
    """
    theta_pan, theta_tilt = x[0], x[1]
    y[0] = theta_pan  # reading_theta_pan
    y[1] = theta_tilt  # reading_theta_tilt


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def output_jacobian(t, x, u, p, yx, yp):
    """Write the non-zero derivatives of outputs by state and parameter.

    t, x [4], u [2], p [6]; yx [2, 4]; yp [2, 6].
    """
    yx[0, 0] = 1.0  # reading_theta_pan_by_theta_pan
    yx[1, 1] = 1.0  # reading_theta_tilt_by_theta_tilt


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def domain(p, bounds):
    """Write lower and upper bound of the state of every row of DOMAIN into bounds.

    p [6]; bounds [0, 2] in STATE_UNITS: lower, upper.
    """
    return


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def margins(p, margin):
    """Write by how much the parameters meet every row of REQUIREMENTS into margin.

    p [6]; margin [0] in units of what is compared.
    """
    return


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def initial_modes(t, x, u, p, m):
    """Leave m alone: this model has no modes."""
    return


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def state_derivative(t, x, u, p, dx):
    """Write the time derivative of the state into dx."""
    mode_derivative(t, x, u, p, (), dx)


# What the field calls some of these functions.
vector_field, events, inverse_dynamics = mode_derivative, guards, equation_error


@njit(error_model="numpy", nogil=True, forceinline=True, _nrt=False)
def lane_quarter(x):
    """Return the multiple of pi/2 nearest to x: adding 1.5 * 2**52 rounds to a whole number."""
    return (0.6366197723675814 * x + 6755399441055744.0) - 6755399441055744.0


@njit(error_model="numpy", nogil=True, forceinline=True, _nrt=False)
def lane_polynomials(x, n):
    """Return sine and cosine of x - n pi/2, which lies within pi/4."""
    r = ((x - n * 1.5707963267341256) - n * 6.077100506303966e-11) - n * 2.0222662487959506e-21
    z = r * r
    sine = 2.7557313707070068e-06 + z * (-2.5050760253406863e-08 + z * 1.58969099521155e-10)
    sine = 0.00833333333332249 + z * (-0.0001984126982985795 + z * sine)
    sine = r + r * z * (-0.16666666666666632 + z * sine)
    cosine = -2.7557314351390663e-07 + z * (2.087572321298175e-09 - z * 1.1359647557788195e-11)
    cosine = 0.0416666666666666 + z * (
        -0.001388888888887411 + z * (2.480158728947673e-05 + z * cosine)
    )
    half = 0.5 * z
    least = 1.0 - half
    return sine, least + (((1.0 - least) - half) + z * z * cosine)


@njit(error_model="numpy", nogil=True, forceinline=True, _nrt=False)
def lane_sin(x):
    """Return the sine of x in rad."""
    n = lane_quarter(x)
    sine, cosine = lane_polynomials(x, n)
    turn = n - 4.0 * ((0.25 * n + 6755399441055744.0) - 6755399441055744.0)
    value = cosine if abs(turn) == 1.0 else sine
    return -value if (turn < 0.0) | (turn > 1.5) else value


@njit(error_model="numpy", nogil=True, forceinline=True, _nrt=False)
def lane_cos(x):
    """Return the cosine of x in rad."""
    n = lane_quarter(x)
    sine, cosine = lane_polynomials(x, n)
    turn = n - 4.0 * ((0.25 * n + 6755399441055744.0) - 6755399441055744.0)
    value = sine if abs(turn) == 1.0 else cosine
    return -value if (turn > 0.5) | (turn < -1.5) else value


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def lane_sines(w):
    """Replace every angle of w [k] in rad by its sine."""
    for i in range(len(w)):
        w[i] = lane_sin(w[i])


LANES = 64


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def lane_derivative(w):
    """Write the time derivatives of 64 states side by side into w.

    w [20 * 64]: rows of 64 numbers, t, then x, u, p, c of prepare and dx.
    """
    for lane in range(64):
        theta_tilt = w[128 + lane]
        omega_pan = w[192 + lane]
        omega_tilt = w[256 + lane]
        tau_pan = w[320 + lane]
        tau_tilt = w[384 + lane]
        b_pan = w[704 + lane]
        b_tilt = w[768 + lane]
        inertia_pan_sin_sq_tilt = w[832 + lane]
        inertia_pan = w[896 + lane]
        inverse_mass_tilt = w[960 + lane]
        cos_tilt = lane_cos(theta_tilt)
        sin_tilt = lane_sin(theta_tilt)
        inertia_pan_per_sin_tilt = inertia_pan_sin_sq_tilt * sin_tilt
        coriolis = cos_tilt * inertia_pan_per_sin_tilt * omega_pan
        force_pan = -b_pan * omega_pan - 2.0 * coriolis * omega_tilt + tau_pan
        mass_pan = inertia_pan + inertia_pan_per_sin_tilt * sin_tilt
        force_tilt = -b_tilt * omega_tilt + coriolis * omega_pan + tau_tilt
        w[1024 + lane] = omega_pan
        w[1088 + lane] = omega_tilt
        inverse_mass_pan = 1.0 / mass_pan
        w[1152 + lane] = force_pan * inverse_mass_pan
        w[1216 + lane] = force_tilt * inverse_mass_tilt


# What follows is for fits and diagnoses; no function above uses it.
# States without influence while these parameters are at their vanishing values.
IDLE_STATES = ()
# Relations: parameters, rule, strict; `margins` gives what is at least zero.
REQUIREMENTS = ()
# Searching them: name, value at which the effect vanishes (None: any), starts,
# period, what a frequency is locked to.
SEARCH = (("b_pan", 0.0, (0.1,), None, None), ("b_tilt", 0.0, (0.1,), None, None))
# Effects: id, axis, parameters, nested members (title, parameters, tied ones), keys of the
# effects that it acts on, title, reference, separating experiment, first member leads.
EFFECTS = (
    ("rigid_bodies", None, ("J_pan", "J_x_tilt", "J_y_tilt", "J_z_tilt"), (), (),
     "pan body and tilt body", "thesis Eq. 3.8, Table 5.1", "", False),
    ("viscous_friction", "pan", ("b_pan",), (), (), "viscous friction in the joint",
     "thesis Eq. 2.8, Eq. 3.8 (b_p, b_t)",
     "Run at six or more steady speeds, the slowest near the Stribeck speed.", False),
    ("viscous_friction", "tilt", ("b_tilt",), (), (), "viscous friction in the joint",
     "thesis Eq. 2.8, Eq. 3.8 (b_p, b_t)",
     "Run at six or more steady speeds, the slowest near the Stribeck speed.", False),
)
# END sha256 b15c21a2b090cdb17ce95af1ccebecf32fd23f64f92f264174c1d61ec02a1a28
