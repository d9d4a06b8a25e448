"""Pan-tilt platform of the thesis with its payload: equations of motion, emitted; do not edit.

M(q) q'' = forcing - friction, with the lower triangle of M by symmetry:

  M[0, 0] = inertia_pan + inertia_pan_per_sin_tilt*sin(theta_tilt)
  M[0, 1] = -coupling_cos_tilt*cos(theta_tilt) + coupling_sin_tilt*sin(theta_tilt)
  M[1, 1] = inertia_tilt
  forcing[omega_pan] = -b_pan*omega_pan - coriolis*omega_tilt -
      coupling_cos_tilt*omega_tilt**2*sin(theta_tilt) -
      coupling_sin_tilt*omega_tilt**2*cos(theta_tilt) + tau_pan
  forcing[omega_tilt] = -b_tilt*omega_tilt + coriolis*omega_pan/2 +
      gravity_cos_tilt*cos(theta_tilt) + gravity_sin_tilt*sin(theta_tilt) + tau_tilt

with the functions named above, in order of use:

  inertia_pan = J_pan + J_z_payload + J_z_tilt + c_x_payload**2*m_payload +
      c_y_payload**2*m_payload
  inertia_pan_sin_sq_tilt = J_x_payload + J_x_tilt - J_z_payload - J_z_tilt -
      c_x_payload**2*m_payload + c_z_payload**2*m_payload
  inertia_pan_sin_cos_tilt = 2*c_x_payload*c_z_payload*m_payload
  coupling_sin_tilt = c_x_payload*c_y_payload*m_payload
  coupling_cos_tilt = c_y_payload*c_z_payload*m_payload
  inertia_tilt = J_y_payload + J_y_tilt + c_x_payload**2*m_payload + c_z_payload**2*m_payload
  gravity_sin_tilt = c_z_payload*gravity*m_payload
  gravity_cos_tilt = c_x_payload*gravity*m_payload
  inertia_pan_per_sin_tilt = inertia_pan_sin_cos_tilt*cos(theta_tilt) +
      inertia_pan_sin_sq_tilt*sin(theta_tilt)
  coriolis = 2*inertia_pan_per_sin_tilt*omega_pan*cos(theta_tilt) -
      inertia_pan_sin_cos_tilt*omega_pan


Operations of the state derivative: 236 as derived, 71 as written, 44 of them at every
call where `prepare` does the others once per parameter set.

Effects:
- rigid_bodies: thesis Eq. 3.8, Table 5.1
- payload: thesis section 3.2.2, Table 5.3 with erratum 18
- viscous_friction (pan): thesis Eq. 2.8, Eq. 3.8 (b_p, b_t)
- viscous_friction (tilt): thesis Eq. 2.8, Eq. 3.8 (b_p, b_t)
"""

import math

from numba import njit

MODEL_HASH = "7d8704cc2016505e"
NAME = "payload"
TITLE = "Pan-tilt platform of the thesis with its payload"
# How many numbers `prepare` writes.
PREPARED = 8
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
    ("m_payload", "kg", 4.992, 0.0, 100000.0, "payload mass"),
    ("J_x_payload", "kg m^2", 0.0053, 0.0, 10000.0, "payload inertia about its own x axis"),
    ("J_y_payload", "kg m^2", 0.0068, 0.0, 10000.0, "payload inertia about its own y axis"),
    ("J_z_payload", "kg m^2", 0.0068, 0.0, 10000.0, "payload inertia about its own z axis"),
    ("c_x_payload", "m", 0.1, -10.0, 10.0, "x of the payload's centre of mass"),
    ("c_y_payload", "m", 0.0, -10.0, 10.0, "y of the payload's centre of mass"),
    ("c_z_payload", "m", 0.0, -10.0, 10.0, "z of the payload's centre of mass"),
    ("b_pan", "N m s/rad", 0.1, 0.0, 10000.0, "viscous friction in the pan joint"),
    ("b_tilt", "N m s/rad", 0.1, 0.0, 10000.0, "viscous friction in the tilt joint"),
    ("gravity", "m/s^2", 9.81, 0.0, 1000.0, "gravitational acceleration"),
)


# Arguments, in SI: t in s; x in STATE_UNITS, u in INPUT_UNITS, p in the units of PARAMETERS;
# modes m as MODE_NAMES; c as `prepare` writes it. Lengths and shapes are in brackets.
@njit(cache=True, error_model="numpy", nogil=True, forceinline=True, _nrt=False)
def constants(p):
    """Return what depends on the parameters alone."""
    J_pan, J_x_tilt, J_y_tilt, J_z_tilt, m_payload, J_x_payload = p[0], p[1], p[2], p[3], p[4], p[5]
    J_y_payload, J_z_payload, c_x_payload, c_y_payload, c_z_payload = p[6], p[7], p[8], p[9], p[10]
    gravity = p[13]
    inertia_pan_sin_cos_tilt = 2.0 * c_x_payload * c_z_payload * m_payload
    c_z_payload_sq_m_payload = (c_z_payload * c_z_payload) * m_payload
    c_x_payload_sq_m_payload = (c_x_payload * c_x_payload) * m_payload
    inertia_pan_sin_sq_tilt = (J_x_payload + J_x_tilt - J_z_payload - J_z_tilt
        - c_x_payload_sq_m_payload + c_z_payload_sq_m_payload)
    c_y_payload_m_payload = c_y_payload * m_payload
    coupling_cos_tilt = c_y_payload_m_payload * c_z_payload
    coupling_sin_tilt = c_x_payload * c_y_payload_m_payload
    gravity_m_payload = gravity * m_payload
    gravity_cos_tilt = c_x_payload * gravity_m_payload
    gravity_sin_tilt = c_z_payload * gravity_m_payload
    inertia_tilt = J_y_payload + J_y_tilt + c_x_payload_sq_m_payload + c_z_payload_sq_m_payload
    inertia_pan = (J_pan + J_z_payload + J_z_tilt + c_x_payload_sq_m_payload
        + (c_y_payload * c_y_payload) * m_payload)
    return (inertia_pan_sin_cos_tilt, inertia_pan_sin_sq_tilt, coupling_cos_tilt, coupling_sin_tilt,
        gravity_cos_tilt, gravity_sin_tilt, inertia_tilt, inertia_pan)


@njit(cache=True, error_model="numpy", nogil=True, forceinline=True, _nrt=False)
def mass_and_forces(t, x, u, p, c):
    """Return mass matrix, forces and what else the functions below have in common."""
    theta_tilt, omega_pan, omega_tilt = x[1], x[2], x[3]
    tau_pan, tau_tilt = u[0], u[1]
    b_pan, b_tilt = p[11], p[12]
    inertia_pan_sin_cos_tilt, inertia_pan_sin_sq_tilt, coupling_cos_tilt = c[0], c[1], c[2]
    coupling_sin_tilt, gravity_cos_tilt, gravity_sin_tilt, inertia_pan = c[3], c[4], c[5], c[7]
    cos_tilt = math.cos(theta_tilt)
    sin_tilt = math.sin(theta_tilt)
    inertia_pan_per_sin_tilt = (cos_tilt * inertia_pan_sin_cos_tilt
        + inertia_pan_sin_sq_tilt * sin_tilt)
    coriolis = omega_pan * (2.0 * cos_tilt * inertia_pan_per_sin_tilt - inertia_pan_sin_cos_tilt)
    force_pan = (-b_pan * omega_pan - omega_tilt * (coriolis
        + omega_tilt * (cos_tilt * coupling_sin_tilt + coupling_cos_tilt * sin_tilt)) + tau_pan)
    minus_gravity_torque_tilt = cos_tilt * gravity_cos_tilt + gravity_sin_tilt * sin_tilt
    force_tilt = (-b_tilt * omega_tilt + 0.5 * coriolis * omega_pan + minus_gravity_torque_tilt
        + tau_tilt)
    mass_pan = inertia_pan + inertia_pan_per_sin_tilt * sin_tilt
    mass_pan_tilt = -cos_tilt * coupling_cos_tilt + coupling_sin_tilt * sin_tilt
    return (cos_tilt, sin_tilt, force_pan, minus_gravity_torque_tilt, force_tilt, mass_pan,
        mass_pan_tilt)


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def prepare(p, c):
    """Write into c what prepared_derivative takes from the parameters alone.

    p [14]; c [8].
    c: what `constants` returns, in its order.
    """
    values = constants(p)
    for k in range(PREPARED):
        c[k] = values[k]


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def prepared_derivative(t, x, u, p, m, c, dx):
    """Write the time derivative of the state into dx in the modes m, c being prepared.

    t, x [4], u [2], p [14], m [0], c [8]; dx [4] in STATE_UNITS per s.
    """
    forces = mass_and_forces(t, x, u, p, c)
    force_pan, force_tilt, mass_pan, mass_pan_tilt = forces[2], forces[4], forces[5], forces[6]
    omega_pan, omega_tilt = x[2], x[3]
    inertia_tilt = c[6]
    dx[0] = omega_pan  # rate_of_theta_pan
    dx[1] = omega_tilt  # rate_of_theta_tilt
    inverse_determinant = 1.0 / (inertia_tilt * mass_pan - (mass_pan_tilt * mass_pan_tilt))
    # accel_pan
    dx[2] = inverse_determinant * (force_pan * inertia_tilt - force_tilt * mass_pan_tilt)
    dx[3] = inverse_determinant * (-force_pan * mass_pan_tilt + force_tilt * mass_pan)  # accel_tilt


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def mode_derivative(t, x, u, p, m, dx):
    """Write the time derivative of the state into dx in the modes m.

    t, x [4], u [2], p [14], m [0]; dx [4] in STATE_UNITS per s.
    """
    prepared_derivative(t, x, u, p, m, constants(p), dx)


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def guards(t, x, u, p, m, g):
    """Write holding and breakaway torques, gap separations and contact torques into g.

    t, x [4], u [2], p [14], m [0]; g [0] in N m and rad.
    """
    return


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def energy(t, x, u, p, m, e):
    """Write stored energy in J, power in and dissipated power in W into e.

    t, x [4], u [2], p [14], m [0]; e [3] in J, W and W.
    e: stored, power_in, dissipated.
    """
    c = constants(p)
    forces = mass_and_forces(t, x, u, p, c)
    cos_tilt, sin_tilt, mass_pan, mass_pan_tilt = forces[0], forces[1], forces[5], forces[6]
    omega_pan, omega_tilt = x[2], x[3]
    tau_pan, tau_tilt = u[0], u[1]
    b_pan, b_tilt = p[11], p[12]
    gravity_cos_tilt, gravity_sin_tilt, inertia_tilt = c[4], c[5], c[6]
    omega_tilt_sq = omega_tilt * omega_tilt
    omega_pan_sq = omega_pan * omega_pan
    e[0] = (cos_tilt * gravity_sin_tilt - gravity_cos_tilt * sin_tilt
        + 0.5 * inertia_tilt * omega_tilt_sq + 0.5 * mass_pan * omega_pan_sq
        + mass_pan_tilt * omega_pan * omega_tilt)  # stored
    e[1] = omega_pan * tau_pan + omega_tilt * tau_tilt  # power_in
    e[2] = b_pan * omega_pan_sq + b_tilt * omega_tilt_sq  # dissipated


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def equation_error(t, x, u, p, m, r):
    """Write torques that rows lack, then other states' rates, into r; x ends in accelerations.

    t, x [6], u [2], p [14], m [0]; r [2] in N m, then STATE_UNITS per s.
    x: STATE_NAMES, then given_accel_pan, given_accel_tilt.
    r: torque_pan, torque_tilt.
    """
    c = constants(p)
    forces = mass_and_forces(t, x, u, p, c)
    force_pan, force_tilt, mass_pan, mass_pan_tilt = forces[2], forces[4], forces[5], forces[6]
    given_accel_pan, given_accel_tilt = x[4], x[5]
    inertia_tilt = c[6]
    r[0] = -force_pan + given_accel_pan * mass_pan + given_accel_tilt * mass_pan_tilt  # torque_pan
    # torque_tilt
    r[1] = -force_tilt + given_accel_pan * mass_pan_tilt + given_accel_tilt * inertia_tilt


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def mass_matrix(t, x, u, p, m, M):
    """Write the mass matrix of the joints, then of gear outputs, into M.

    t, x [4], u [2], p [14], m [0]; M [2, 2] in kg m^2.
    """
    c = constants(p)
    forces = mass_and_forces(t, x, u, p, c)
    mass_pan, mass_pan_tilt = forces[5], forces[6]
    inertia_tilt = c[6]
    M[0, 0] = mass_pan
    M[0, 1] = mass_pan_tilt
    M[1, 0] = mass_pan_tilt
    M[1, 1] = inertia_tilt  # mass_tilt


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def gravity_torque(t, x, u, p, m, G):
    """Write the torques that hold the machine against its weight into G.

    t, x [4], u [2], p [14], m [0]; G [2] in N m.
    G: gravity_torque_pan, gravity_torque_tilt.
    """
    c = constants(p)
    forces = mass_and_forces(t, x, u, p, c)
    minus_gravity_torque_tilt = forces[3]
    G[0] = 0.0  # gravity_torque_pan
    G[1] = -minus_gravity_torque_tilt  # gravity_torque_tilt


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def linearize(t, x, u, p, m, fx, fu, fp, gx, gp):
    """Write the non-zero derivatives of dx into fx, fu, fp and those of guards into gx, gp.

    t, x [4], u [2], p [14], m [0]; fx [4, 4]; fu [4, 2]; fp [4, 14]; gx [0, 4]; gp [0, 14].
    fx: rows and columns as STATE_NAMES; fu: rows as STATE_NAMES, columns as INPUT_NAMES; fp: rows
      as STATE_NAMES, columns as PARAMETERS; gx: rows as g of guards, columns as STATE_NAMES; gp:
      rows as g of guards, columns as PARAMETERS.
    Where fp or gx is empty, it and what follows it is not computed.
    """
    theta_tilt, omega_pan, omega_tilt = x[1], x[2], x[3]
    tau_pan, tau_tilt = u[0], u[1]
    J_pan, J_x_tilt, J_y_tilt, J_z_tilt, m_payload, J_x_payload = p[0], p[1], p[2], p[3], p[4], p[5]
    J_y_payload, J_z_payload, c_x_payload, c_y_payload, c_z_payload = p[6], p[7], p[8], p[9], p[10]
    b_pan, b_tilt, gravity = p[11], p[12], p[13]
    c_z_payload_sq = c_z_payload * c_z_payload
    c_z_payload_sq_m_payload = c_z_payload_sq * m_payload
    c_x_payload_sq = c_x_payload * c_x_payload
    c_x_payload_sq_m_payload = c_x_payload_sq * m_payload
    inertia_tilt = J_y_payload + J_y_tilt + c_x_payload_sq_m_payload + c_z_payload_sq_m_payload
    c_y_payload_sq = c_y_payload * c_y_payload
    inertia_pan = (J_pan + J_z_payload + J_z_tilt + c_x_payload_sq_m_payload
        + c_y_payload_sq * m_payload)
    cos_tilt = math.cos(theta_tilt)
    gravity_sin_tilt_by_gravity = c_z_payload * m_payload
    inertia_tilt_by_c_z_payload = 2.0 * gravity_sin_tilt_by_gravity
    inertia_pan_sin_cos_tilt = c_x_payload * inertia_tilt_by_c_z_payload
    inertia_pan_sin_sq_tilt = (J_x_payload + J_x_tilt - J_z_payload - J_z_tilt
        - c_x_payload_sq_m_payload + c_z_payload_sq_m_payload)
    sin_tilt = math.sin(theta_tilt)
    inertia_pan_per_sin_tilt = (cos_tilt * inertia_pan_sin_cos_tilt
        + inertia_pan_sin_sq_tilt * sin_tilt)
    inertia_pan_per_sin_tilt_sin_tilt = inertia_pan_per_sin_tilt * sin_tilt
    mass_pan = inertia_pan + inertia_pan_per_sin_tilt_sin_tilt
    coupling_sin_tilt_by_c_x_payload = c_y_payload * m_payload
    coupling_cos_tilt = c_z_payload * coupling_sin_tilt_by_c_x_payload
    coupling_sin_tilt = c_x_payload * coupling_sin_tilt_by_c_x_payload
    mass_pan_tilt = -cos_tilt * coupling_cos_tilt + coupling_sin_tilt * sin_tilt
    inverse_determinant = 1.0 / (inertia_tilt * mass_pan - (mass_pan_tilt * mass_pan_tilt))
    cos_tilt_inertia_pan_per_sin_tilt = cos_tilt * inertia_pan_per_sin_tilt
    coriolis_by_omega_pan = 2.0 * cos_tilt_inertia_pan_per_sin_tilt - inertia_pan_sin_cos_tilt
    coriolis = coriolis_by_omega_pan * omega_pan
    force_pan_factor = cos_tilt * coupling_sin_tilt + coupling_cos_tilt * sin_tilt
    force_pan_factor_omega_tilt = force_pan_factor * omega_tilt
    force_pan = -b_pan * omega_pan - omega_tilt * (coriolis + force_pan_factor_omega_tilt) + tau_pan
    gravity_cos_tilt_by_c_x_payload = gravity * m_payload
    gravity_cos_tilt = c_x_payload * gravity_cos_tilt_by_c_x_payload
    gravity_sin_tilt = c_z_payload * gravity_cos_tilt_by_c_x_payload
    force_tilt_by_coriolis = 0.5 * omega_pan
    force_tilt = (-b_tilt * omega_tilt + coriolis * force_tilt_by_coriolis
        + cos_tilt * gravity_cos_tilt + gravity_sin_tilt * sin_tilt + tau_tilt)
    accel_pan = inverse_determinant * (force_pan * inertia_tilt - force_tilt * mass_pan_tilt)
    accel_tilt = inverse_determinant * (-force_pan * mass_pan_tilt + force_tilt * mass_pan)
    inertia_pan_per_sin_tilt_by_theta_tilt = (cos_tilt * inertia_pan_sin_sq_tilt
        - inertia_pan_sin_cos_tilt * sin_tilt)
    twice_omega_pan = 2.0 * omega_pan
    coriolis_by_inertia_pan_per_sin_tilt = cos_tilt * twice_omega_pan
    coriolis_by_theta_tilt = (coriolis_by_inertia_pan_per_sin_tilt
        * inertia_pan_per_sin_tilt_by_theta_tilt - inertia_pan_per_sin_tilt_sin_tilt
        * twice_omega_pan)
    omega_tilt_sq = omega_tilt * omega_tilt
    balance_pan_by_theta_tilt = (-accel_pan * (cos_tilt_inertia_pan_per_sin_tilt
        + inertia_pan_per_sin_tilt_by_theta_tilt * sin_tilt) - accel_tilt * force_pan_factor
        - coriolis_by_theta_tilt * omega_tilt + mass_pan_tilt * omega_tilt_sq)
    balance_tilt_by_theta_tilt = (-accel_pan * force_pan_factor
        + coriolis_by_theta_tilt * force_tilt_by_coriolis + cos_tilt * gravity_sin_tilt
        - gravity_cos_tilt * sin_tilt)
    fx[2, 1] = (inverse_determinant * (balance_pan_by_theta_tilt * inertia_tilt
        - balance_tilt_by_theta_tilt * mass_pan_tilt))  # accel_pan_by_theta_tilt
    fx[3, 1] = (inverse_determinant * (-balance_pan_by_theta_tilt * mass_pan_tilt
        + balance_tilt_by_theta_tilt * mass_pan))  # accel_tilt_by_theta_tilt
    fx[0, 2] = 1.0  # rate_of_theta_pan_by_omega_pan
    balance_pan_by_omega_pan = -b_pan - coriolis_by_omega_pan * omega_tilt
    balance_tilt_by_omega_pan = 0.5 * coriolis + coriolis_by_omega_pan * force_tilt_by_coriolis
    fx[2, 2] = (inverse_determinant * (balance_pan_by_omega_pan * inertia_tilt
        - balance_tilt_by_omega_pan * mass_pan_tilt))  # accel_pan_by_omega_pan
    fx[3, 2] = (inverse_determinant * (-balance_pan_by_omega_pan * mass_pan_tilt
        + balance_tilt_by_omega_pan * mass_pan))  # accel_tilt_by_omega_pan
    fx[1, 3] = 1.0  # rate_of_theta_tilt_by_omega_tilt
    balance_pan_by_omega_tilt = -coriolis - 2.0 * force_pan_factor_omega_tilt
    fx[2, 3] = (inverse_determinant * (b_tilt * mass_pan_tilt
        + balance_pan_by_omega_tilt * inertia_tilt))  # accel_pan_by_omega_tilt
    fx[3, 3] = (inverse_determinant * (-b_tilt * mass_pan
        - balance_pan_by_omega_tilt * mass_pan_tilt))  # accel_tilt_by_omega_tilt
    accel_pan_by_tau_pan = inertia_tilt * inverse_determinant
    fu[2, 0] = accel_pan_by_tau_pan
    inverse_determinant_mass_pan_tilt = inverse_determinant * mass_pan_tilt
    fu[3, 0] = -inverse_determinant_mass_pan_tilt  # accel_tilt_by_tau_pan
    fu[2, 1] = -inverse_determinant_mass_pan_tilt  # accel_pan_by_tau_tilt
    accel_tilt_by_tau_tilt = inverse_determinant * mass_pan
    fu[3, 1] = accel_tilt_by_tau_tilt
    if len(fp) == 0:
        return
    accel_pan_by_inertia_pan = -accel_pan * accel_pan_by_tau_pan
    fp[2, 0] = accel_pan_by_inertia_pan  # accel_pan_by_J_pan
    accel_tilt_by_inertia_pan = accel_pan * inverse_determinant_mass_pan_tilt
    fp[3, 0] = accel_tilt_by_inertia_pan  # accel_tilt_by_J_pan
    coriolis_by_inertia_pan_sin_sq_tilt = coriolis_by_inertia_pan_per_sin_tilt * sin_tilt
    accel_pan_sin_tilt = accel_pan * sin_tilt
    balance_pan_by_inertia_pan_sin_sq_tilt = (-accel_pan_sin_tilt * sin_tilt
        - coriolis_by_inertia_pan_sin_sq_tilt * omega_tilt)
    balance_tilt_by_inertia_pan_sin_sq_tilt = (coriolis_by_inertia_pan_sin_sq_tilt
        * force_tilt_by_coriolis)
    accel_pan_by_inertia_pan_sin_sq_tilt = (inverse_determinant
        * (balance_pan_by_inertia_pan_sin_sq_tilt * inertia_tilt
        - balance_tilt_by_inertia_pan_sin_sq_tilt * mass_pan_tilt))
    fp[2, 1] = accel_pan_by_inertia_pan_sin_sq_tilt  # accel_pan_by_J_x_tilt
    accel_tilt_by_inertia_pan_sin_sq_tilt = (inverse_determinant
        * (-balance_pan_by_inertia_pan_sin_sq_tilt * mass_pan_tilt
        + balance_tilt_by_inertia_pan_sin_sq_tilt * mass_pan))
    fp[3, 1] = accel_tilt_by_inertia_pan_sin_sq_tilt  # accel_tilt_by_J_x_tilt
    accel_pan_by_inertia_tilt = accel_tilt * inverse_determinant_mass_pan_tilt
    fp[2, 2] = accel_pan_by_inertia_tilt  # accel_pan_by_J_y_tilt
    accel_tilt_by_inertia_tilt = -accel_tilt * accel_tilt_by_tau_tilt
    fp[3, 2] = accel_tilt_by_inertia_tilt  # accel_tilt_by_J_y_tilt
    accel_pan_by_J_z_tilt = accel_pan_by_inertia_pan - accel_pan_by_inertia_pan_sin_sq_tilt
    fp[2, 3] = accel_pan_by_J_z_tilt
    accel_tilt_by_J_z_tilt = accel_tilt_by_inertia_pan - accel_tilt_by_inertia_pan_sin_sq_tilt
    fp[3, 3] = accel_tilt_by_J_z_tilt
    balance_pan_by_coupling_cos_tilt = accel_tilt * cos_tilt - omega_tilt_sq * sin_tilt
    balance_tilt_by_coupling_cos_tilt = accel_pan * cos_tilt
    accel_pan_by_coupling_cos_tilt = (inverse_determinant * (balance_pan_by_coupling_cos_tilt
        * inertia_tilt - balance_tilt_by_coupling_cos_tilt * mass_pan_tilt))
    balance_pan_by_coupling_sin_tilt = -accel_tilt * sin_tilt - cos_tilt * omega_tilt_sq
    accel_pan_by_coupling_sin_tilt = (inverse_determinant * (accel_pan_sin_tilt * mass_pan_tilt
        + balance_pan_by_coupling_sin_tilt * inertia_tilt))
    accel_pan_by_gravity_cos_tilt = -cos_tilt * inverse_determinant_mass_pan_tilt
    accel_pan_by_gravity_sin_tilt = -inverse_determinant_mass_pan_tilt * sin_tilt
    coriolis_by_inertia_pan_sin_cos_tilt = (coriolis_by_inertia_pan_per_sin_tilt * cos_tilt
        - omega_pan)
    balance_pan_by_inertia_pan_sin_cos_tilt = (-accel_pan_sin_tilt * cos_tilt
        - coriolis_by_inertia_pan_sin_cos_tilt * omega_tilt)
    balance_tilt_by_inertia_pan_sin_cos_tilt = (coriolis_by_inertia_pan_sin_cos_tilt
        * force_tilt_by_coriolis)
    accel_pan_by_inertia_pan_sin_cos_tilt = (inverse_determinant
        * (balance_pan_by_inertia_pan_sin_cos_tilt * inertia_tilt
        - balance_tilt_by_inertia_pan_sin_cos_tilt * mass_pan_tilt))
    coupling_cos_tilt_by_m_payload = c_y_payload * c_z_payload
    coupling_sin_tilt_by_m_payload = c_x_payload * c_y_payload
    gravity_cos_tilt_by_m_payload = c_x_payload * gravity
    gravity_sin_tilt_by_m_payload = c_z_payload * gravity
    inertia_pan_by_m_payload = c_x_payload_sq + c_y_payload_sq
    inertia_pan_sin_cos_tilt_by_m_payload = 2.0 * c_x_payload * c_z_payload
    inertia_pan_sin_sq_tilt_by_m_payload = -c_x_payload_sq + c_z_payload_sq
    inertia_tilt_by_m_payload = c_x_payload_sq + c_z_payload_sq
    fp[2, 4] = (accel_pan_by_coupling_cos_tilt * coupling_cos_tilt_by_m_payload
        + accel_pan_by_coupling_sin_tilt * coupling_sin_tilt_by_m_payload
        + accel_pan_by_gravity_cos_tilt * gravity_cos_tilt_by_m_payload
        + accel_pan_by_gravity_sin_tilt * gravity_sin_tilt_by_m_payload
        + accel_pan_by_inertia_pan * inertia_pan_by_m_payload
        + accel_pan_by_inertia_pan_sin_cos_tilt * inertia_pan_sin_cos_tilt_by_m_payload
        + accel_pan_by_inertia_pan_sin_sq_tilt * inertia_pan_sin_sq_tilt_by_m_payload
        + accel_pan_by_inertia_tilt * inertia_tilt_by_m_payload)  # accel_pan_by_m_payload
    accel_tilt_by_coupling_cos_tilt = (inverse_determinant * (-balance_pan_by_coupling_cos_tilt
        * mass_pan_tilt + balance_tilt_by_coupling_cos_tilt * mass_pan))
    accel_tilt_by_coupling_sin_tilt = (inverse_determinant * (-accel_pan_sin_tilt * mass_pan
        - balance_pan_by_coupling_sin_tilt * mass_pan_tilt))
    accel_tilt_by_gravity_cos_tilt = accel_tilt_by_tau_tilt * cos_tilt
    accel_tilt_by_gravity_sin_tilt = accel_tilt_by_tau_tilt * sin_tilt
    accel_tilt_by_inertia_pan_sin_cos_tilt = (inverse_determinant
        * (-balance_pan_by_inertia_pan_sin_cos_tilt * mass_pan_tilt
        + balance_tilt_by_inertia_pan_sin_cos_tilt * mass_pan))
    fp[3, 4] = (accel_tilt_by_coupling_cos_tilt * coupling_cos_tilt_by_m_payload
        + accel_tilt_by_coupling_sin_tilt * coupling_sin_tilt_by_m_payload
        + accel_tilt_by_gravity_cos_tilt * gravity_cos_tilt_by_m_payload
        + accel_tilt_by_gravity_sin_tilt * gravity_sin_tilt_by_m_payload
        + accel_tilt_by_inertia_pan * inertia_pan_by_m_payload
        + accel_tilt_by_inertia_pan_sin_cos_tilt * inertia_pan_sin_cos_tilt_by_m_payload
        + accel_tilt_by_inertia_pan_sin_sq_tilt * inertia_pan_sin_sq_tilt_by_m_payload
        + accel_tilt_by_inertia_tilt * inertia_tilt_by_m_payload)  # accel_tilt_by_m_payload
    fp[2, 5] = accel_pan_by_inertia_pan_sin_sq_tilt  # accel_pan_by_J_x_payload
    fp[3, 5] = accel_tilt_by_inertia_pan_sin_sq_tilt  # accel_tilt_by_J_x_payload
    fp[2, 6] = accel_pan_by_inertia_tilt  # accel_pan_by_J_y_payload
    fp[3, 6] = accel_tilt_by_inertia_tilt  # accel_tilt_by_J_y_payload
    fp[2, 7] = accel_pan_by_J_z_tilt  # accel_pan_by_J_z_payload
    fp[3, 7] = accel_tilt_by_J_z_tilt  # accel_tilt_by_J_z_payload
    gravity_cos_tilt_by_gravity = c_x_payload * m_payload
    inertia_pan_by_c_x_payload = 2.0 * gravity_cos_tilt_by_gravity
    fp[2, 8] = (accel_pan_by_coupling_sin_tilt * coupling_sin_tilt_by_c_x_payload
        + accel_pan_by_gravity_cos_tilt * gravity_cos_tilt_by_c_x_payload
        + accel_pan_by_inertia_pan * inertia_pan_by_c_x_payload
        + accel_pan_by_inertia_pan_sin_cos_tilt * inertia_tilt_by_c_z_payload
        - accel_pan_by_inertia_pan_sin_sq_tilt * inertia_pan_by_c_x_payload
        + accel_pan_by_inertia_tilt * inertia_pan_by_c_x_payload)  # accel_pan_by_c_x_payload
    fp[3, 8] = (accel_tilt_by_coupling_sin_tilt * coupling_sin_tilt_by_c_x_payload
        + accel_tilt_by_gravity_cos_tilt * gravity_cos_tilt_by_c_x_payload
        + accel_tilt_by_inertia_pan * inertia_pan_by_c_x_payload
        + accel_tilt_by_inertia_pan_sin_cos_tilt * inertia_tilt_by_c_z_payload
        - accel_tilt_by_inertia_pan_sin_sq_tilt * inertia_pan_by_c_x_payload
        + accel_tilt_by_inertia_tilt * inertia_pan_by_c_x_payload)  # accel_tilt_by_c_x_payload
    inertia_pan_by_c_y_payload = 2.0 * coupling_sin_tilt_by_c_x_payload
    fp[2, 9] = (accel_pan_by_coupling_cos_tilt * gravity_sin_tilt_by_gravity
        + accel_pan_by_coupling_sin_tilt * gravity_cos_tilt_by_gravity
        + accel_pan_by_inertia_pan * inertia_pan_by_c_y_payload)  # accel_pan_by_c_y_payload
    fp[3, 9] = (accel_tilt_by_coupling_cos_tilt * gravity_sin_tilt_by_gravity
        + accel_tilt_by_coupling_sin_tilt * gravity_cos_tilt_by_gravity
        + accel_tilt_by_inertia_pan * inertia_pan_by_c_y_payload)  # accel_tilt_by_c_y_payload
    fp[2, 10] = (accel_pan_by_coupling_cos_tilt * coupling_sin_tilt_by_c_x_payload
        + accel_pan_by_gravity_sin_tilt * gravity_cos_tilt_by_c_x_payload
        + accel_pan_by_inertia_pan_sin_cos_tilt * inertia_pan_by_c_x_payload
        + accel_pan_by_inertia_pan_sin_sq_tilt * inertia_tilt_by_c_z_payload
        + accel_pan_by_inertia_tilt * inertia_tilt_by_c_z_payload)  # accel_pan_by_c_z_payload
    fp[3, 10] = (accel_tilt_by_coupling_cos_tilt * coupling_sin_tilt_by_c_x_payload
        + accel_tilt_by_gravity_sin_tilt * gravity_cos_tilt_by_c_x_payload
        + accel_tilt_by_inertia_pan_sin_cos_tilt * inertia_pan_by_c_x_payload
        + accel_tilt_by_inertia_pan_sin_sq_tilt * inertia_tilt_by_c_z_payload
        + accel_tilt_by_inertia_tilt * inertia_tilt_by_c_z_payload)  # accel_tilt_by_c_z_payload
    fp[2, 11] = -accel_pan_by_tau_pan * omega_pan  # accel_pan_by_b_pan
    fp[3, 11] = inverse_determinant_mass_pan_tilt * omega_pan  # accel_tilt_by_b_pan
    fp[2, 12] = inverse_determinant_mass_pan_tilt * omega_tilt  # accel_pan_by_b_tilt
    fp[3, 12] = -accel_tilt_by_tau_tilt * omega_tilt  # accel_tilt_by_b_tilt
    fp[2, 13] = (accel_pan_by_gravity_cos_tilt * gravity_cos_tilt_by_gravity
        + accel_pan_by_gravity_sin_tilt * gravity_sin_tilt_by_gravity)  # accel_pan_by_gravity
    fp[3, 13] = (accel_tilt_by_gravity_cos_tilt * gravity_cos_tilt_by_gravity
        + accel_tilt_by_gravity_sin_tilt * gravity_sin_tilt_by_gravity)  # accel_tilt_by_gravity


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def outputs(t, x, u, p, y):
    """Write the measured signals into y.

    t, x [4], u [2], p [14]; y [2] in OUTPUT_UNITS.
    """
    theta_pan, theta_tilt = x[0], x[1]
    y[0] = theta_pan  # reading_theta_pan
    y[1] = theta_tilt  # reading_theta_tilt


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def output_jacobian(t, x, u, p, yx, yp):
    """Write the non-zero derivatives of outputs by state and parameter.

    t, x [4], u [2], p [14]; yx [2, 4]; yp [2, 14].
    """
    yx[0, 0] = 1.0  # reading_theta_pan_by_theta_pan
    yx[1, 1] = 1.0  # reading_theta_tilt_by_theta_tilt


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def domain(p, bounds):
    """Write lower and upper bound of the state of every row of DOMAIN into bounds.

    p [14]; bounds [0, 2] in STATE_UNITS: lower, upper.
    """
    return


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def margins(p, margin):
    """Write by how much the parameters meet every row of REQUIREMENTS into margin.

    p [14]; margin [0] in units of what is compared.
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

    w [33 * 64]: rows of 64 numbers, t, then x, u, p, c of prepare and dx.
    """
    for lane in range(64):
        theta_tilt = w[128 + lane]
        omega_pan = w[192 + lane]
        omega_tilt = w[256 + lane]
        tau_pan = w[320 + lane]
        tau_tilt = w[384 + lane]
        b_pan = w[1152 + lane]
        b_tilt = w[1216 + lane]
        inertia_pan_sin_cos_tilt = w[1344 + lane]
        inertia_pan_sin_sq_tilt = w[1408 + lane]
        coupling_cos_tilt = w[1472 + lane]
        coupling_sin_tilt = w[1536 + lane]
        gravity_cos_tilt = w[1600 + lane]
        gravity_sin_tilt = w[1664 + lane]
        inertia_tilt = w[1728 + lane]
        inertia_pan = w[1792 + lane]
        cos_tilt = lane_cos(theta_tilt)
        sin_tilt = lane_sin(theta_tilt)
        inertia_pan_per_sin_tilt = (cos_tilt * inertia_pan_sin_cos_tilt
            + inertia_pan_sin_sq_tilt * sin_tilt)
        coriolis = (omega_pan * (2.0 * cos_tilt * inertia_pan_per_sin_tilt
            - inertia_pan_sin_cos_tilt))
        force_pan = (-b_pan * omega_pan - omega_tilt * (coriolis
            + omega_tilt * (cos_tilt * coupling_sin_tilt + coupling_cos_tilt * sin_tilt)) + tau_pan)
        minus_gravity_torque_tilt = cos_tilt * gravity_cos_tilt + gravity_sin_tilt * sin_tilt
        force_tilt = (-b_tilt * omega_tilt + 0.5 * coriolis * omega_pan + minus_gravity_torque_tilt
            + tau_tilt)
        mass_pan = inertia_pan + inertia_pan_per_sin_tilt * sin_tilt
        mass_pan_tilt = -cos_tilt * coupling_cos_tilt + coupling_sin_tilt * sin_tilt
        w[1856 + lane] = omega_pan
        w[1920 + lane] = omega_tilt
        inverse_determinant = 1.0 / (inertia_tilt * mass_pan - (mass_pan_tilt * mass_pan_tilt))
        w[1984 + lane] = (inverse_determinant * (force_pan * inertia_tilt
            - force_tilt * mass_pan_tilt))
        w[2048 + lane] = inverse_determinant * (-force_pan * mass_pan_tilt + force_tilt * mass_pan)


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
    ("payload", None, ("m_payload", "J_x_payload", "J_y_payload", "J_z_payload", "c_x_payload",
     "c_y_payload", "c_z_payload"), (), (), "payload",
     "thesis section 3.2.2, Table 5.3 with erratum 18", "", False),
    ("viscous_friction", "pan", ("b_pan",), (), (), "viscous friction in the joint",
     "thesis Eq. 2.8, Eq. 3.8 (b_p, b_t)",
     "Run at six or more steady speeds, the slowest near the Stribeck speed.", False),
    ("viscous_friction", "tilt", ("b_tilt",), (), (), "viscous friction in the joint",
     "thesis Eq. 2.8, Eq. 3.8 (b_p, b_t)",
     "Run at six or more steady speeds, the slowest near the Stribeck speed.", False),
)
# END sha256 77f1ed0169b177196c8fd38f3b57f4cafddf27984033f0141df81c92af9a91e1
