"""Tilt drive of the thesis: equations of motion, emitted; do not edit.

M(q) q'' = forcing - friction, with the lower triangle of M by symmetry:

  M[0, 0] = J_motor_tilt*ratio_tilt**2 + inertia_tilt
  forcing[omega_tilt] = -J_motor_tilt*omega_tilt**2*ratio_tilt*ratio_tilt_by_theta_tilt -
      b_tilt*omega_tilt + gravity_cos_tilt*cos(theta_tilt) + gravity_sin_tilt*sin(theta_tilt) +
      ratio_tilt*(K_t_tilt*i_tilt - b_motor_tilt*omega_tilt*ratio_tilt)

with the functions named above, in order of use:

  inertia_tilt = J_y_payload + c_x_payload**2*m_payload + c_z_payload**2*m_payload
  gravity_sin_tilt = c_z_payload*gravity*m_payload
  gravity_cos_tilt = c_x_payload*gravity*m_payload
  linkage_cos_tilt = l_ground_tilt**2 + r_arm_tilt**2 - (l_min_tilt + s_start_tilt)**2
  linkage_sin_tilt = sqrt(4*l_ground_tilt**2*r_arm_tilt**2 - linkage_cos_tilt**2)
  length_tilt = sqrt(l_ground_tilt**2 - linkage_cos_tilt*cos(theta_tilt) -
      linkage_sin_tilt*sin(theta_tilt) + r_arm_tilt**2)
  length_tilt_by_theta_tilt = (linkage_cos_tilt*sin(theta_tilt) -
      linkage_sin_tilt*cos(theta_tilt))/(2*sqrt(l_ground_tilt**2 -
      linkage_cos_tilt*cos(theta_tilt) - linkage_sin_tilt*sin(theta_tilt) + r_arm_tilt**2))
  ratio_tilt = pi*N_tilt*(linkage_cos_tilt*sin(theta_tilt) -
      linkage_sin_tilt*cos(theta_tilt))/(lead_tilt*length_tilt)
  ratio_tilt_by_theta_tilt = pi*N_tilt*(linkage_cos_tilt*cos(theta_tilt) +
      linkage_sin_tilt*sin(theta_tilt))/(lead_tilt*length_tilt) -
      pi*N_tilt*length_tilt_by_theta_tilt*(linkage_cos_tilt*sin(theta_tilt) -
      linkage_sin_tilt*cos(theta_tilt))/(lead_tilt*length_tilt**2)
  driving_torque_tilt = -J_motor_tilt*omega_tilt**2*ratio_tilt*ratio_tilt_by_theta_tilt +
      ratio_tilt*(K_t_tilt*i_tilt - b_motor_tilt*omega_tilt*ratio_tilt)
  load_torque_tilt = -b_tilt*omega_tilt + gravity_cos_tilt*cos(theta_tilt) +
      gravity_sin_tilt*sin(theta_tilt)
  load_inertia_tilt = inertia_tilt
  raised_tilt = pi*d_screw_tilt*(pi*d_screw_tilt*f_screw_tilt +
      lead_tilt)/(lead_tilt*(pi*d_screw_tilt - f_screw_tilt*lead_tilt))
  lowered_tilt = -pi*d_screw_tilt*(pi*d_screw_tilt*f_screw_tilt -
      lead_tilt)/(lead_tilt*(pi*d_screw_tilt + f_screw_tilt*lead_tilt))
  carried_tilt = -J_motor_tilt*load_torque_tilt*ratio_tilt**2 +
      driving_torque_tilt*load_inertia_tilt
  lost_raising_tilt = (raised_tilt - 1)/(J_motor_tilt*ratio_tilt**2 +
      load_inertia_tilt*raised_tilt)
  lost_lowering_tilt = (-lowered_tilt + 1)/Abs(J_motor_tilt*ratio_tilt**2 +
      load_inertia_tilt*lowered_tilt)

  sliding friction[omega_tilt] = carried_tilt*slide_tilt*(-lost_lowering_tilt +
      lost_raising_tilt)/2 + (lost_lowering_tilt +
      lost_raising_tilt)*Abs(carried_tilt*slide_tilt)/2
  i_tilt' = (-K_t_tilt*omega_tilt*ratio_tilt - R_tilt*i_tilt + u_tilt)/L_tilt

Operations of the state derivative: 193 as derived, 115 as written, 80 of them at every
call where `prepare` does the others once per parameter set.

Effects:
- payload: thesis section 3.2.2, Table 5.3 with erratum 18
- viscous_friction (tilt): thesis Eq. 2.8, Eq. 3.8 (b_p, b_t)
- linear_actuator (tilt): thesis Eq. 3.10, 3.12 and 3.2.3.2 with errata 9 and 10, Tables 5.5, 5.6
"""

import math

import numpy as np
from numba import njit

MODEL_HASH = "4a2b93e3a6a178d5"
NAME = "tilt_drive"
TITLE = "Tilt drive of the thesis"
# How many numbers `prepare` writes.
PREPARED = 10
AXES = ("tilt",)
STATE_NAMES = ("theta_tilt", "omega_tilt", "i_tilt")
STATE_UNITS = ("rad", "rad/s", "A")
STATE_INITIAL = (0.0, 0.0, 0.0)
INPUT_NAMES = ("u_tilt",)
INPUT_UNITS = ("V",)
# Per input: index of the parameter by which it is late, or -1.
INPUT_DELAYS = (-1,)
# Per input: whether motion depends on it, and not samplers alone.
INPUT_ACTS = (True,)
OUTPUT_NAMES = ("theta_tilt", "i_tilt")
OUTPUT_UNITS = ("rad", "A")
MODE_NAMES = ("slide_tilt",)
FRICTION_RATES = np.array([1], dtype=np.int64)
# Per state: the friction that sets it to zero when it comes to rest, or -1.
ZERO_AT_REST = (-1, -1, -1)
# Samplers: parameters of the period. Sampled: sampler and state of each update.
SAMPLERS = ()
SAMPLED = ()
# Per contact: state index of the angle at the gear output and at the joint.
CONTACT_ANGLES = ()
# Limits of the equations: state, meaning; `domain` gives the bounds.
DOMAIN = (
    ("theta_tilt", "dead centre of the tilt linkage"),
    ("theta_tilt", "stroke end of the tilt actuator"),
)
# Parameters: name, unit, default, lower and upper bound, meaning.
PARAMETERS = (
    ("m_payload", "kg", 6.3785, 0.0, 100000.0, "payload mass"),
    ("J_y_payload", "kg m^2", 0.0136, 0.0, 10000.0, "payload inertia about its own y axis"),
    ("c_x_payload", "m", 0.0, -10.0, 10.0, "x of the payload's centre of mass"),
    ("c_z_payload", "m", 0.0876228, -10.0, 10.0, "z of the payload's centre of mass"),
    ("b_tilt", "N m s/rad", 10.0, 0.0, 10000.0, "viscous friction in the tilt joint"),
    ("L_tilt", "H", 0.00935, 1e-09, 1000.0, "winding inductance"),
    ("R_tilt", "ohm", 17.0, 1e-06, 1000000.0, "winding resistance"),
    ("K_t_tilt", "N m/A", 0.044, 1e-09, 10000.0, "torque constant"),
    ("J_motor_tilt", "kg m^2", 1.62e-06, 1e-12, 1000.0, "rotor inertia"),
    ("b_motor_tilt", "N m s/rad", 0.00011696, 0.0, 100.0, "viscous friction of the rotor"),
    ("N_tilt", "1", 93.0, 0.001, 1000000.0, "gear ratio"),
    ("lead_tilt", "m", 0.004, 1e-06, 1.0, "lead of the screw per turn"),
    ("d_screw_tilt", "m", 0.008, 1e-06, 1.0, "mean diameter of the screw"),
    ("f_screw_tilt", "1", 0.15, 0.0, 10.0, "friction coefficient of the screw"),
    ("l_ground_tilt", "m", 0.19755, 1e-06, 100.0, "joint to foot of the actuator"),
    ("l_min_tilt", "m", 0.139, 1e-06, 100.0, "length of the actuator drawn in"),
    ("r_arm_tilt", "m", 0.0634133, 1e-06, 100.0, "joint to pin of the actuator"),
    ("s_start_tilt", "m", 0.0405022, 0.0, 100.0, "stroke at tilt angle zero"),
    ("s_max_tilt", "m", 0.1, 1e-06, 100.0, "longest stroke"),
    ("gravity", "m/s^2", 9.81, 0.0, 1000.0, "gravitational acceleration"),
)


# Arguments, in SI: t in s; x in STATE_UNITS, u in INPUT_UNITS, p in the units of PARAMETERS;
# modes m as MODE_NAMES; c as `prepare` writes it. Lengths and shapes are in brackets.
@njit(cache=True, error_model="numpy", nogil=True, forceinline=True, _nrt=False)
def constants(p):
    """Return what depends on the parameters alone."""
    m_payload, J_y_payload, c_x_payload, c_z_payload, lead_tilt = p[0], p[1], p[2], p[3], p[11]
    d_screw_tilt, f_screw_tilt, l_ground_tilt, l_min_tilt = p[12], p[13], p[14], p[15]
    r_arm_tilt, s_start_tilt, gravity = p[16], p[17], p[19]
    l_ground_tilt_sq = l_ground_tilt * l_ground_tilt
    r_arm_tilt_sq = r_arm_tilt * r_arm_tilt
    l_ground_tilt_sq_plus_r_arm_tilt_sq = l_ground_tilt_sq + r_arm_tilt_sq
    linkage_cos_tilt = (l_ground_tilt_sq_plus_r_arm_tilt_sq - ((l_min_tilt
        + s_start_tilt) * (l_min_tilt + s_start_tilt)))
    linkage_sin_tilt = (math.sqrt(4.0 * l_ground_tilt_sq * r_arm_tilt_sq
        - (linkage_cos_tilt * linkage_cos_tilt)))
    lead_tilt_inverse = 1.0 / lead_tilt
    gravity_m_payload = gravity * m_payload
    gravity_cos_tilt = c_x_payload * gravity_m_payload
    gravity_sin_tilt = c_z_payload * gravity_m_payload
    inertia_tilt = (J_y_payload + (c_x_payload * c_x_payload) * m_payload
        + (c_z_payload * c_z_payload) * m_payload)
    d_screw_tilt_pi = math.pi * d_screw_tilt
    f_screw_tilt_lead_tilt = f_screw_tilt * lead_tilt
    d_screw_tilt_pi_f_screw_tilt = d_screw_tilt_pi * f_screw_tilt
    d_screw_tilt_pi_lead_tilt_inverse = d_screw_tilt_pi * lead_tilt_inverse
    lowered_tilt = (-d_screw_tilt_pi_lead_tilt_inverse * (d_screw_tilt_pi_f_screw_tilt
        - lead_tilt) / (d_screw_tilt_pi + f_screw_tilt_lead_tilt))
    raised_tilt = (d_screw_tilt_pi_lead_tilt_inverse * (d_screw_tilt_pi_f_screw_tilt
        + lead_tilt) / (d_screw_tilt_pi - f_screw_tilt_lead_tilt))
    raised_tilt_minus_lowered_tilt = -lowered_tilt + raised_tilt
    return (l_ground_tilt_sq_plus_r_arm_tilt_sq, linkage_cos_tilt, linkage_sin_tilt,
        lead_tilt_inverse, gravity_cos_tilt, gravity_sin_tilt, inertia_tilt, lowered_tilt,
        raised_tilt, raised_tilt_minus_lowered_tilt)


@njit(cache=True, error_model="numpy", nogil=True, forceinline=True, _nrt=False)
def mass_and_forces(t, x, u, p, slide_tilt, c):
    """Return mass matrix, forces and what else the functions below have in common."""
    theta_tilt, omega_tilt, i_tilt = x[0], x[1], x[2]
    u_tilt = u[0]
    b_tilt, L_tilt, R_tilt, K_t_tilt, J_motor_tilt = p[4], p[5], p[6], p[7], p[8]
    b_motor_tilt, N_tilt = p[9], p[10]
    l_ground_tilt_sq_plus_r_arm_tilt_sq, linkage_cos_tilt, linkage_sin_tilt = c[0], c[1], c[2]
    lead_tilt_inverse, gravity_cos_tilt, gravity_sin_tilt, inertia_tilt = c[3], c[4], c[5], c[6]
    lowered_tilt, raised_tilt = c[7], c[8]
    cos_tilt = math.cos(theta_tilt)
    cos_tilt_linkage_cos_tilt = cos_tilt * linkage_cos_tilt
    sin_tilt = math.sin(theta_tilt)
    linkage_sin_tilt_sin_tilt = linkage_sin_tilt * sin_tilt
    length_tilt = (math.sqrt(-cos_tilt_linkage_cos_tilt + l_ground_tilt_sq_plus_r_arm_tilt_sq
        - linkage_sin_tilt_sin_tilt))
    N_tilt_lead_tilt_inverse_pi_per_length_tilt = math.pi * N_tilt * lead_tilt_inverse / length_tilt
    ratio_tilt_factor = -cos_tilt * linkage_sin_tilt + linkage_cos_tilt * sin_tilt
    ratio_tilt = N_tilt_lead_tilt_inverse_pi_per_length_tilt * ratio_tilt_factor
    length_tilt_by_theta_tilt = 0.5 * ratio_tilt_factor / length_tilt
    ratio_tilt_by_theta_tilt = (-math.pi * N_tilt * lead_tilt_inverse * length_tilt_by_theta_tilt
        * ratio_tilt_factor / (length_tilt * length_tilt)
        + N_tilt_lead_tilt_inverse_pi_per_length_tilt * (cos_tilt_linkage_cos_tilt
        + linkage_sin_tilt_sin_tilt))
    omega_tilt_sq = omega_tilt * omega_tilt
    carried_tilt_term = J_motor_tilt * omega_tilt_sq * ratio_tilt * ratio_tilt_by_theta_tilt
    omega_tilt_ratio_tilt = omega_tilt * ratio_tilt
    carried_tilt_factor = K_t_tilt * i_tilt - b_motor_tilt * omega_tilt_ratio_tilt
    carried_tilt_factor_2 = -carried_tilt_factor * ratio_tilt + carried_tilt_term
    b_tilt_omega_tilt = b_tilt * omega_tilt
    cos_tilt_gravity_cos_tilt = cos_tilt * gravity_cos_tilt
    gravity_sin_tilt_sin_tilt = gravity_sin_tilt * sin_tilt
    ratio_tilt_sq = ratio_tilt * ratio_tilt
    J_motor_tilt_ratio_tilt_sq = J_motor_tilt * ratio_tilt_sq
    lost_lowering_tilt = ((1.0 - lowered_tilt) / abs(J_motor_tilt_ratio_tilt_sq
        + inertia_tilt * lowered_tilt))
    lost_raising_tilt = ((raised_tilt - 1.0) / (J_motor_tilt_ratio_tilt_sq
        + inertia_tilt * raised_tilt))
    minus_gravity_torque_tilt = cos_tilt_gravity_cos_tilt + gravity_sin_tilt_sin_tilt
    load_torque_tilt = -b_tilt_omega_tilt + minus_gravity_torque_tilt
    carried_tilt = (-J_motor_tilt_ratio_tilt_sq * load_torque_tilt
        - carried_tilt_factor_2 * inertia_tilt)
    carried_tilt_slide_tilt = carried_tilt * slide_tilt
    friction_torque_tilt = (slide_tilt * (0.5 * carried_tilt_slide_tilt * (-lost_lowering_tilt
        + lost_raising_tilt) + 0.5 * (lost_lowering_tilt
        + lost_raising_tilt) * abs(carried_tilt_slide_tilt)))
    force_tilt = (-b_tilt_omega_tilt - carried_tilt_factor_2 + cos_tilt_gravity_cos_tilt
        - friction_torque_tilt + gravity_sin_tilt_sin_tilt)
    mass_tilt = J_motor_tilt_ratio_tilt_sq + inertia_tilt
    rate_of_i_tilt = (-K_t_tilt * omega_tilt_ratio_tilt - R_tilt * i_tilt + u_tilt) / L_tilt
    return (cos_tilt, sin_tilt, ratio_tilt, omega_tilt_sq, carried_tilt_term, carried_tilt_factor,
        ratio_tilt_sq, minus_gravity_torque_tilt, load_torque_tilt, friction_torque_tilt,
        force_tilt, mass_tilt, rate_of_i_tilt)


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def prepare(p, c):
    """Write into c what prepared_derivative takes from the parameters alone.

    p [20]; c [10].
    c: what `constants` returns, in its order.
    """
    values = constants(p)
    for k in range(PREPARED):
        c[k] = values[k]


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def prepared_derivative(t, x, u, p, m, c, dx):
    """Write the time derivative of the state into dx in the modes m, c being prepared.

    t, x [3], u [1], p [20], m [1], c [10]; dx [3] in STATE_UNITS per s.
    """
    slide_tilt = m[0]
    forces = mass_and_forces(t, x, u, p, slide_tilt, c)
    force_tilt, mass_tilt, rate_of_i_tilt = forces[10], forces[11], forces[12]
    omega_tilt = x[1]
    dx[0] = omega_tilt  # rate_of_theta_tilt
    inverse_mass_tilt = 1.0 / mass_tilt
    dx[1] = force_tilt * inverse_mass_tilt * (slide_tilt * slide_tilt)  # accel_tilt
    dx[2] = rate_of_i_tilt


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def mode_derivative(t, x, u, p, m, dx):
    """Write the time derivative of the state into dx in the modes m.

    t, x [3], u [1], p [20], m [1]; dx [3] in STATE_UNITS per s.
    """
    prepared_derivative(t, x, u, p, m, constants(p), dx)


@njit(cache=True, error_model="numpy", nogil=True, forceinline=True, _nrt=False)
def guard_values(t, x, u, p, slide_tilt):
    """Return what `guards` writes, in modes that are given one by one."""
    c = constants(p)
    forces = mass_and_forces(t, x, u, p, slide_tilt, c)
    ratio_tilt, carried_tilt_term, carried_tilt_factor = forces[2], forces[4], forces[5]
    load_torque_tilt = forces[8]
    lowered_tilt, raised_tilt, raised_tilt_minus_lowered_tilt = c[7], c[8], c[9]
    transmitted_torque_tilt = carried_tilt_factor * ratio_tilt
    holding_tilt = -carried_tilt_term + load_torque_tilt + transmitted_torque_tilt
    forward_tilt_term = 0.5 * load_torque_tilt * (lowered_tilt + raised_tilt - 2.0)
    abs_load_torque_tilt = abs(load_torque_tilt)
    forward_tilt = 0.5 * abs_load_torque_tilt * raised_tilt_minus_lowered_tilt - forward_tilt_term
    backward_tilt = 0.5 * abs_load_torque_tilt * raised_tilt_minus_lowered_tilt + forward_tilt_term
    return holding_tilt, forward_tilt, backward_tilt


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def guards(t, x, u, p, m, g):
    """Write holding and breakaway torques, gap separations and contact torques into g.

    t, x [3], u [1], p [20], m [1]; g [3] in N m and rad.
    g: holding_tilt, forward_tilt, backward_tilt.
    """
    slide_tilt = m[0]
    g[0], g[1], g[2] = guard_values(t, x, u, p, slide_tilt)


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def energy(t, x, u, p, m, e):
    """Write stored energy in J, power in and dissipated power in W into e.

    t, x [3], u [1], p [20], m [1]; e [3] in J, W and W.
    e: stored, power_in, dissipated.
    """
    slide_tilt = m[0]
    c = constants(p)
    forces = mass_and_forces(t, x, u, p, slide_tilt, c)
    cos_tilt, sin_tilt, omega_tilt_sq, ratio_tilt_sq = forces[0], forces[1], forces[3], forces[6]
    friction_torque_tilt, mass_tilt = forces[9], forces[11]
    omega_tilt, i_tilt = x[1], x[2]
    u_tilt = u[0]
    b_tilt, L_tilt, R_tilt, b_motor_tilt = p[4], p[5], p[6], p[9]
    gravity_cos_tilt, gravity_sin_tilt = c[4], c[5]
    i_tilt_sq = i_tilt * i_tilt
    e[0] = (0.5 * L_tilt * i_tilt_sq + cos_tilt * gravity_sin_tilt - gravity_cos_tilt * sin_tilt
        + 0.5 * mass_tilt * omega_tilt_sq)  # stored
    e[1] = i_tilt * u_tilt  # power_in
    winding_loss_tilt = R_tilt * i_tilt_sq
    e[2] = (b_motor_tilt * omega_tilt_sq * ratio_tilt_sq + b_tilt * omega_tilt_sq
        + friction_torque_tilt * omega_tilt + winding_loss_tilt)  # dissipated


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def equation_error(t, x, u, p, m, r):
    """Write torques that rows lack, then other states' rates, into r; x ends in accelerations.

    t, x [4], u [1], p [20], m [1]; r [2] in N m, then STATE_UNITS per s.
    x: STATE_NAMES, then given_accel_tilt.
    r: torque_tilt, rate_of_i_tilt.
    """
    slide_tilt = m[0]
    c = constants(p)
    forces = mass_and_forces(t, x, u, p, slide_tilt, c)
    force_tilt, mass_tilt, rate_of_i_tilt = forces[10], forces[11], forces[12]
    given_accel_tilt = x[3]
    r[0] = -force_tilt + given_accel_tilt * mass_tilt  # torque_tilt
    r[1] = rate_of_i_tilt


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def mass_matrix(t, x, u, p, m, M):
    """Write the mass matrix of the joints, then of gear outputs, into M.

    t, x [3], u [1], p [20], m [1]; M [1, 1] in kg m^2.
    """
    slide_tilt = m[0]
    c = constants(p)
    forces = mass_and_forces(t, x, u, p, slide_tilt, c)
    mass_tilt = forces[11]
    M[0, 0] = mass_tilt


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def gravity_torque(t, x, u, p, m, G):
    """Write the torques that hold the machine against its weight into G.

    t, x [3], u [1], p [20], m [1]; G [1] in N m.
    G: gravity_torque_tilt.
    """
    slide_tilt = m[0]
    c = constants(p)
    forces = mass_and_forces(t, x, u, p, slide_tilt, c)
    minus_gravity_torque_tilt = forces[7]
    G[0] = -minus_gravity_torque_tilt  # gravity_torque_tilt


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def linearize(t, x, u, p, m, fx, fu, fp, gx, gp):
    """Write the non-zero derivatives of dx into fx, fu, fp and those of guards into gx, gp.

    t, x [3], u [1], p [20], m [1]; fx [3, 3]; fu [3, 1]; fp [3, 20]; gx [3, 3]; gp [3, 20].
    fx: rows and columns as STATE_NAMES; fu: rows as STATE_NAMES, columns as INPUT_NAMES; fp: rows
      as STATE_NAMES, columns as PARAMETERS; gx: rows as g of guards, columns as STATE_NAMES; gp:
      rows as g of guards, columns as PARAMETERS.
    Where fp or gx is empty, it and what follows it is not computed.
    """
    theta_tilt, omega_tilt, i_tilt = x[0], x[1], x[2]
    u_tilt = u[0]
    m_payload, J_y_payload, c_x_payload, c_z_payload, b_tilt = p[0], p[1], p[2], p[3], p[4]
    L_tilt, R_tilt, K_t_tilt, J_motor_tilt, b_motor_tilt = p[5], p[6], p[7], p[8], p[9]
    N_tilt, lead_tilt, d_screw_tilt, f_screw_tilt, l_ground_tilt = p[10], p[11], p[12], p[13], p[14]
    l_min_tilt, r_arm_tilt, s_start_tilt, gravity = p[15], p[16], p[17], p[19]
    slide_tilt = m[0]
    c_x_payload_sq = c_x_payload * c_x_payload
    c_z_payload_sq = c_z_payload * c_z_payload
    inertia_tilt = J_y_payload + c_x_payload_sq * m_payload + c_z_payload_sq * m_payload
    cos_tilt = math.cos(theta_tilt)
    l_ground_tilt_sq = l_ground_tilt * l_ground_tilt
    r_arm_tilt_sq = r_arm_tilt * r_arm_tilt
    l_ground_tilt_sq_plus_r_arm_tilt_sq = l_ground_tilt_sq + r_arm_tilt_sq
    l_min_tilt_plus_s_start_tilt = l_min_tilt + s_start_tilt
    linkage_cos_tilt = (l_ground_tilt_sq_plus_r_arm_tilt_sq
        - (l_min_tilt_plus_s_start_tilt * l_min_tilt_plus_s_start_tilt))
    cos_tilt_linkage_cos_tilt = cos_tilt * linkage_cos_tilt
    four_times_r_arm_tilt_sq = 4.0 * r_arm_tilt_sq
    linkage_sin_tilt = (math.sqrt(four_times_r_arm_tilt_sq * l_ground_tilt_sq
        - (linkage_cos_tilt * linkage_cos_tilt)))
    sin_tilt = math.sin(theta_tilt)
    linkage_sin_tilt_sin_tilt = linkage_sin_tilt * sin_tilt
    length_tilt = (math.sqrt(-cos_tilt_linkage_cos_tilt + l_ground_tilt_sq_plus_r_arm_tilt_sq
        - linkage_sin_tilt_sin_tilt))
    length_tilt_inverse = 1.0 / length_tilt
    lead_tilt_inverse = 1.0 / lead_tilt
    lead_tilt_inverse_pi = math.pi * lead_tilt_inverse
    lead_tilt_inverse_pi_length_tilt_inverse = lead_tilt_inverse_pi * length_tilt_inverse
    ratio_tilt_by_N_tilt_factor = -cos_tilt * linkage_sin_tilt + linkage_cos_tilt * sin_tilt
    ratio_tilt_by_N_tilt = lead_tilt_inverse_pi_length_tilt_inverse * ratio_tilt_by_N_tilt_factor
    ratio_tilt = N_tilt * ratio_tilt_by_N_tilt
    ratio_tilt_sq = ratio_tilt * ratio_tilt
    J_motor_tilt_ratio_tilt_sq = J_motor_tilt * ratio_tilt_sq
    mass_tilt = J_motor_tilt_ratio_tilt_sq + inertia_tilt
    inverse_mass_tilt = 1.0 / mass_tilt
    inverse_mass_tilt_slide_tilt_sq = inverse_mass_tilt * (slide_tilt * slide_tilt)
    ratio_tilt_by_theta_tilt_factor = cos_tilt_linkage_cos_tilt + linkage_sin_tilt_sin_tilt
    ratio_tilt_by_theta_tilt_factor_2 = (lead_tilt_inverse_pi_length_tilt_inverse
        * ratio_tilt_by_theta_tilt_factor)
    half_length_tilt_inverse = 0.5 * length_tilt_inverse
    length_tilt_by_theta_tilt = half_length_tilt_inverse * ratio_tilt_by_N_tilt_factor
    length_tilt_inverse_sq = 1.0 / (length_tilt * length_tilt)
    lead_tilt_inverse_pi_length_tilt_inverse_sq = lead_tilt_inverse_pi * length_tilt_inverse_sq
    ratio_tilt_by_theta_tilt_factor_3 = (lead_tilt_inverse_pi_length_tilt_inverse_sq
        * ratio_tilt_by_N_tilt_factor)
    ratio_tilt_by_theta_tilt_factor_4 = (length_tilt_by_theta_tilt
        * ratio_tilt_by_theta_tilt_factor_3)
    ratio_tilt_by_theta_tilt = (N_tilt * ratio_tilt_by_theta_tilt_factor_2
        - N_tilt * ratio_tilt_by_theta_tilt_factor_4)
    length_tilt_inverse_cubed = 1.0 / (length_tilt * length_tilt * length_tilt)
    quarter_length_tilt_inverse_cubed = 0.25 * length_tilt_inverse_cubed
    length_tilt_by_theta_tilt_by_theta_tilt = (half_length_tilt_inverse
        * ratio_tilt_by_theta_tilt_factor - quarter_length_tilt_inverse_cubed
        * (ratio_tilt_by_N_tilt_factor * ratio_tilt_by_N_tilt_factor))
    N_tilt_ratio_tilt_by_theta_tilt_factor = N_tilt * ratio_tilt_by_theta_tilt_factor
    ratio_tilt_by_theta_tilt_by_theta_tilt_term = (N_tilt_ratio_tilt_by_theta_tilt_factor
        * lead_tilt_inverse_pi_length_tilt_inverse_sq)
    ratio_tilt_by_length_tilt = -N_tilt * ratio_tilt_by_theta_tilt_factor_3
    ratio_tilt_by_theta_tilt_by_length_tilt = (2.0 * math.pi * N_tilt * lead_tilt_inverse
        * length_tilt_by_theta_tilt * length_tilt_inverse_cubed * ratio_tilt_by_N_tilt_factor
        - ratio_tilt_by_theta_tilt_by_theta_tilt_term)
    ratio_tilt_by_theta_tilt_by_theta_tilt = (length_tilt_by_theta_tilt
        * ratio_tilt_by_theta_tilt_by_length_tilt - length_tilt_by_theta_tilt
        * ratio_tilt_by_theta_tilt_by_theta_tilt_term + length_tilt_by_theta_tilt_by_theta_tilt
        * ratio_tilt_by_length_tilt - ratio_tilt)
    omega_tilt_sq = omega_tilt * omega_tilt
    omega_tilt_sq_ratio_tilt_by_theta_tilt = omega_tilt_sq * ratio_tilt_by_theta_tilt
    omega_tilt_ratio_tilt = omega_tilt * ratio_tilt
    b_motor_tilt_omega_tilt_ratio_tilt = b_motor_tilt * omega_tilt_ratio_tilt
    force_tilt_by_ratio_tilt = (-J_motor_tilt * omega_tilt_sq_ratio_tilt_by_theta_tilt
        + K_t_tilt * i_tilt - 2.0 * b_motor_tilt_omega_tilt_ratio_tilt)
    J_motor_tilt_ratio_tilt = J_motor_tilt * ratio_tilt
    J_motor_tilt_ratio_tilt_omega_tilt_sq = J_motor_tilt_ratio_tilt * omega_tilt_sq
    driving_torque_tilt_by_theta_tilt = (-J_motor_tilt_ratio_tilt_omega_tilt_sq
        * ratio_tilt_by_theta_tilt_by_theta_tilt + force_tilt_by_ratio_tilt
        * ratio_tilt_by_theta_tilt)
    gravity_cos_tilt_by_c_x_payload = gravity * m_payload
    gravity_sin_tilt = c_z_payload * gravity_cos_tilt_by_c_x_payload
    gravity_cos_tilt = c_x_payload * gravity_cos_tilt_by_c_x_payload
    gravity_cos_tilt_sin_tilt = gravity_cos_tilt * sin_tilt
    carried_tilt_by_theta_tilt_factor = -cos_tilt * gravity_sin_tilt + gravity_cos_tilt_sin_tilt
    b_tilt_omega_tilt = b_tilt * omega_tilt
    load_torque_tilt = (-b_tilt_omega_tilt + cos_tilt * gravity_cos_tilt
        + gravity_sin_tilt * sin_tilt)
    twice_J_motor_tilt_ratio_tilt = 2.0 * J_motor_tilt_ratio_tilt
    carried_tilt_by_ratio_tilt = -load_torque_tilt * twice_J_motor_tilt_ratio_tilt
    carried_tilt_by_theta_tilt = (J_motor_tilt_ratio_tilt_sq * carried_tilt_by_theta_tilt_factor
        + carried_tilt_by_ratio_tilt * ratio_tilt_by_theta_tilt
        + driving_torque_tilt_by_theta_tilt * inertia_tilt)
    d_screw_tilt_pi = math.pi * d_screw_tilt
    f_screw_tilt_lead_tilt = f_screw_tilt * lead_tilt
    d_screw_tilt_pi_plus_f_screw_tilt_lead_tilt = d_screw_tilt_pi + f_screw_tilt_lead_tilt
    lowered_tilt_factor = 1.0 / d_screw_tilt_pi_plus_f_screw_tilt_lead_tilt
    d_screw_tilt_pi_f_screw_tilt = d_screw_tilt_pi * f_screw_tilt
    d_screw_tilt_pi_f_screw_tilt_minus_lead_tilt = d_screw_tilt_pi_f_screw_tilt - lead_tilt
    lowered_tilt_factor_2 = d_screw_tilt_pi_f_screw_tilt_minus_lead_tilt * lowered_tilt_factor
    d_screw_tilt_pi_lead_tilt_inverse = d_screw_tilt_pi * lead_tilt_inverse
    lowered_tilt = -d_screw_tilt_pi_lead_tilt_inverse * lowered_tilt_factor_2
    one_minus_lowered_tilt = 1.0 - lowered_tilt
    lost_lowering_tilt_by_theta_tilt_denominator = (J_motor_tilt_ratio_tilt_sq
        + inertia_tilt * lowered_tilt)
    lost_lowering_tilt_by_theta_tilt_factor = (one_minus_lowered_tilt * (0.0
        if lost_lowering_tilt_by_theta_tilt_denominator == 0.0
        else math.copysign(1.0, lost_lowering_tilt_by_theta_tilt_denominator))
        / (lost_lowering_tilt_by_theta_tilt_denominator
        * lost_lowering_tilt_by_theta_tilt_denominator))
    lost_lowering_tilt_by_ratio_tilt = (-lost_lowering_tilt_by_theta_tilt_factor
        * twice_J_motor_tilt_ratio_tilt)
    lost_lowering_tilt_by_theta_tilt = lost_lowering_tilt_by_ratio_tilt * ratio_tilt_by_theta_tilt
    d_screw_tilt_pi_minus_f_screw_tilt_lead_tilt = d_screw_tilt_pi - f_screw_tilt_lead_tilt
    raised_tilt_factor = 1.0 / d_screw_tilt_pi_minus_f_screw_tilt_lead_tilt
    d_screw_tilt_pi_f_screw_tilt_plus_lead_tilt = d_screw_tilt_pi_f_screw_tilt + lead_tilt
    raised_tilt_factor_2 = d_screw_tilt_pi_f_screw_tilt_plus_lead_tilt * raised_tilt_factor
    raised_tilt = d_screw_tilt_pi_lead_tilt_inverse * raised_tilt_factor_2
    raised_tilt_minus_one = raised_tilt - 1.0
    lost_raising_tilt_by_theta_tilt_denominator = (J_motor_tilt_ratio_tilt_sq
        + inertia_tilt * raised_tilt)
    lost_raising_tilt_by_theta_tilt_factor = (raised_tilt_minus_one
        / (lost_raising_tilt_by_theta_tilt_denominator
        * lost_raising_tilt_by_theta_tilt_denominator))
    lost_raising_tilt_by_ratio_tilt = (-lost_raising_tilt_by_theta_tilt_factor
        * twice_J_motor_tilt_ratio_tilt)
    lost_raising_tilt_by_theta_tilt = lost_raising_tilt_by_ratio_tilt * ratio_tilt_by_theta_tilt
    minus_holding_tilt_by_J_motor_tilt = omega_tilt_sq_ratio_tilt_by_theta_tilt * ratio_tilt
    carried_tilt_factor = (J_motor_tilt * minus_holding_tilt_by_J_motor_tilt
        - ratio_tilt * (K_t_tilt * i_tilt - b_motor_tilt_omega_tilt_ratio_tilt))
    lost_lowering_tilt_factor = 1.0 / abs(lost_lowering_tilt_by_theta_tilt_denominator)
    lost_lowering_tilt = lost_lowering_tilt_factor * one_minus_lowered_tilt
    lost_raising_tilt_factor = 1.0 / lost_raising_tilt_by_theta_tilt_denominator
    lost_raising_tilt = lost_raising_tilt_factor * raised_tilt_minus_one
    lost_lowering_tilt_plus_lost_raising_tilt = lost_lowering_tilt + lost_raising_tilt
    carried_tilt = (-J_motor_tilt_ratio_tilt_sq * load_torque_tilt
        - carried_tilt_factor * inertia_tilt)
    carried_tilt_slide_tilt = carried_tilt * slide_tilt
    abs_carried_tilt_slide_tilt = abs(carried_tilt_slide_tilt)
    half_abs_carried_tilt_slide_tilt = 0.5 * abs_carried_tilt_slide_tilt
    force_tilt_factor = -0.5 * lost_lowering_tilt + 0.5 * lost_raising_tilt
    force_tilt = (-b_tilt_omega_tilt - carried_tilt_factor + cos_tilt * gravity_cos_tilt
        + gravity_sin_tilt * sin_tilt - slide_tilt * (carried_tilt_slide_tilt * force_tilt_factor
        + half_abs_carried_tilt_slide_tilt * lost_lowering_tilt_plus_lost_raising_tilt))
    accel_tilt = force_tilt * inverse_mass_tilt_slide_tilt_sq
    accel_tilt_twice_J_motor_tilt_ratio_tilt = accel_tilt * twice_J_motor_tilt_ratio_tilt
    force_tilt_by_carried_tilt = (-slide_tilt * (force_tilt_factor * slide_tilt
        + 0.5 * lost_lowering_tilt_plus_lost_raising_tilt * slide_tilt * (0.0
        if carried_tilt_slide_tilt == 0.0 else math.copysign(1.0, carried_tilt_slide_tilt))))
    half_carried_tilt_slide_tilt = 0.5 * carried_tilt_slide_tilt
    force_tilt_by_lost_lowering_tilt = (-slide_tilt * (0.5 * abs_carried_tilt_slide_tilt
        - half_carried_tilt_slide_tilt))
    force_tilt_by_lost_raising_tilt = (-slide_tilt * (half_abs_carried_tilt_slide_tilt
        + half_carried_tilt_slide_tilt))
    fx[1, 0] = (inverse_mass_tilt_slide_tilt_sq * (-accel_tilt_twice_J_motor_tilt_ratio_tilt
        * ratio_tilt_by_theta_tilt + carried_tilt_by_theta_tilt * force_tilt_by_carried_tilt
        + cos_tilt * gravity_sin_tilt + driving_torque_tilt_by_theta_tilt
        + force_tilt_by_lost_lowering_tilt * lost_lowering_tilt_by_theta_tilt
        + force_tilt_by_lost_raising_tilt * lost_raising_tilt_by_theta_tilt
        - gravity_cos_tilt_sin_tilt))  # accel_tilt_by_theta_tilt
    rate_of_i_tilt_by_u_tilt = 1.0 / L_tilt
    K_t_tilt_omega_tilt_rate_of_i_tilt_by_u_tilt = K_t_tilt * omega_tilt * rate_of_i_tilt_by_u_tilt
    # rate_of_i_tilt_by_theta_tilt
    fx[2, 0] = -K_t_tilt_omega_tilt_rate_of_i_tilt_by_u_tilt * ratio_tilt_by_theta_tilt
    fx[0, 1] = 1.0  # rate_of_theta_tilt_by_omega_tilt
    carried_tilt_by_omega_tilt_factor = (2.0 * J_motor_tilt * omega_tilt_ratio_tilt
        * ratio_tilt_by_theta_tilt + b_motor_tilt * ratio_tilt_sq)
    carried_tilt_by_omega_tilt = (J_motor_tilt_ratio_tilt_sq * b_tilt
        - carried_tilt_by_omega_tilt_factor * inertia_tilt)
    b_tilt_plus_carried_tilt_by_omega_tilt_factor = b_tilt + carried_tilt_by_omega_tilt_factor
    fx[1, 1] = (inverse_mass_tilt_slide_tilt_sq * (-b_tilt_plus_carried_tilt_by_omega_tilt_factor
        + carried_tilt_by_omega_tilt * force_tilt_by_carried_tilt))  # accel_tilt_by_omega_tilt
    driving_torque_tilt_by_i_tilt = K_t_tilt * ratio_tilt
    # rate_of_i_tilt_by_omega_tilt
    fx[2, 1] = -driving_torque_tilt_by_i_tilt * rate_of_i_tilt_by_u_tilt
    carried_tilt_by_i_tilt = driving_torque_tilt_by_i_tilt * inertia_tilt
    fx[1, 2] = (inverse_mass_tilt_slide_tilt_sq * (carried_tilt_by_i_tilt
        * force_tilt_by_carried_tilt + driving_torque_tilt_by_i_tilt))  # accel_tilt_by_i_tilt
    fx[2, 2] = -R_tilt * rate_of_i_tilt_by_u_tilt  # rate_of_i_tilt_by_i_tilt
    fu[2, 0] = rate_of_i_tilt_by_u_tilt
    if len(fp) == 0:
        return
    carried_tilt_by_gravity_cos_tilt = -J_motor_tilt_ratio_tilt_sq * cos_tilt
    accel_tilt_by_gravity_cos_tilt = (inverse_mass_tilt_slide_tilt_sq
        * (carried_tilt_by_gravity_cos_tilt * force_tilt_by_carried_tilt + cos_tilt))
    carried_tilt_by_gravity_sin_tilt = -J_motor_tilt_ratio_tilt_sq * sin_tilt
    accel_tilt_by_gravity_sin_tilt = (inverse_mass_tilt_slide_tilt_sq
        * (carried_tilt_by_gravity_sin_tilt * force_tilt_by_carried_tilt + sin_tilt))
    accel_tilt_by_inertia_tilt = -accel_tilt * inverse_mass_tilt_slide_tilt_sq
    lost_lowering_tilt_by_load_inertia_tilt = (-lost_lowering_tilt_by_theta_tilt_factor
        * lowered_tilt)
    lost_raising_tilt_by_load_inertia_tilt = -lost_raising_tilt_by_theta_tilt_factor * raised_tilt
    accel_tilt_by_load_inertia_tilt = (inverse_mass_tilt_slide_tilt_sq * (-carried_tilt_factor
        * force_tilt_by_carried_tilt + force_tilt_by_lost_lowering_tilt
        * lost_lowering_tilt_by_load_inertia_tilt + force_tilt_by_lost_raising_tilt
        * lost_raising_tilt_by_load_inertia_tilt))
    gravity_cos_tilt_by_m_payload = c_x_payload * gravity
    gravity_sin_tilt_by_m_payload = c_z_payload * gravity
    inertia_tilt_by_m_payload = c_x_payload_sq + c_z_payload_sq
    fp[1, 0] = (accel_tilt_by_gravity_cos_tilt * gravity_cos_tilt_by_m_payload
        + accel_tilt_by_gravity_sin_tilt * gravity_sin_tilt_by_m_payload
        + accel_tilt_by_inertia_tilt * inertia_tilt_by_m_payload
        + accel_tilt_by_load_inertia_tilt * inertia_tilt_by_m_payload)  # accel_tilt_by_m_payload
    # accel_tilt_by_J_y_payload
    fp[1, 1] = accel_tilt_by_inertia_tilt + accel_tilt_by_load_inertia_tilt
    gravity_cos_tilt_by_gravity = c_x_payload * m_payload
    inertia_tilt_by_c_x_payload = 2.0 * gravity_cos_tilt_by_gravity
    # accel_tilt_by_c_x_payload
    fp[1, 2] = (accel_tilt_by_gravity_cos_tilt * gravity_cos_tilt_by_c_x_payload
        + accel_tilt_by_inertia_tilt * inertia_tilt_by_c_x_payload
        + accel_tilt_by_load_inertia_tilt * inertia_tilt_by_c_x_payload)
    gravity_sin_tilt_by_gravity = c_z_payload * m_payload
    inertia_tilt_by_c_z_payload = 2.0 * gravity_sin_tilt_by_gravity
    # accel_tilt_by_c_z_payload
    fp[1, 3] = (accel_tilt_by_gravity_sin_tilt * gravity_cos_tilt_by_c_x_payload
        + accel_tilt_by_inertia_tilt * inertia_tilt_by_c_z_payload
        + accel_tilt_by_load_inertia_tilt * inertia_tilt_by_c_z_payload)
    carried_tilt_by_b_tilt = J_motor_tilt_ratio_tilt_sq * omega_tilt
    fp[1, 4] = (inverse_mass_tilt_slide_tilt_sq * (carried_tilt_by_b_tilt
        * force_tilt_by_carried_tilt - omega_tilt))  # accel_tilt_by_b_tilt
    fp[2, 5] = (-(-R_tilt * i_tilt - driving_torque_tilt_by_i_tilt * omega_tilt
        + u_tilt) / (L_tilt * L_tilt))  # rate_of_i_tilt_by_L_tilt
    fp[2, 6] = -i_tilt * rate_of_i_tilt_by_u_tilt  # rate_of_i_tilt_by_R_tilt
    driving_torque_tilt_by_K_t_tilt = i_tilt * ratio_tilt
    carried_tilt_by_K_t_tilt = driving_torque_tilt_by_K_t_tilt * inertia_tilt
    fp[1, 7] = (inverse_mass_tilt_slide_tilt_sq * (carried_tilt_by_K_t_tilt
        * force_tilt_by_carried_tilt + driving_torque_tilt_by_K_t_tilt))  # accel_tilt_by_K_t_tilt
    fp[2, 7] = -omega_tilt_ratio_tilt * rate_of_i_tilt_by_u_tilt  # rate_of_i_tilt_by_K_t_tilt
    carried_tilt_by_J_motor_tilt = (-inertia_tilt * minus_holding_tilt_by_J_motor_tilt
        - load_torque_tilt * ratio_tilt_sq)
    lost_lowering_tilt_by_J_motor_tilt = -lost_lowering_tilt_by_theta_tilt_factor * ratio_tilt_sq
    lost_raising_tilt_by_J_motor_tilt = -lost_raising_tilt_by_theta_tilt_factor * ratio_tilt_sq
    fp[1, 8] = (inverse_mass_tilt_slide_tilt_sq * (-accel_tilt * ratio_tilt_sq
        + carried_tilt_by_J_motor_tilt * force_tilt_by_carried_tilt
        + force_tilt_by_lost_lowering_tilt * lost_lowering_tilt_by_J_motor_tilt
        + force_tilt_by_lost_raising_tilt * lost_raising_tilt_by_J_motor_tilt
        - minus_holding_tilt_by_J_motor_tilt))  # accel_tilt_by_J_motor_tilt
    driving_torque_tilt_by_b_motor_tilt = -omega_tilt * ratio_tilt_sq
    carried_tilt_by_b_motor_tilt = driving_torque_tilt_by_b_motor_tilt * inertia_tilt
    # accel_tilt_by_b_motor_tilt
    fp[1, 9] = (inverse_mass_tilt_slide_tilt_sq * (carried_tilt_by_b_motor_tilt
        * force_tilt_by_carried_tilt + driving_torque_tilt_by_b_motor_tilt))
    ratio_tilt_by_theta_tilt_by_N_tilt = (ratio_tilt_by_theta_tilt_factor_2
        - ratio_tilt_by_theta_tilt_factor_4)
    driving_torque_tilt_by_N_tilt = (-J_motor_tilt_ratio_tilt_omega_tilt_sq
        * ratio_tilt_by_theta_tilt_by_N_tilt + force_tilt_by_ratio_tilt * ratio_tilt_by_N_tilt)
    carried_tilt_by_N_tilt = (carried_tilt_by_ratio_tilt * ratio_tilt_by_N_tilt
        + driving_torque_tilt_by_N_tilt * inertia_tilt)
    lost_lowering_tilt_by_N_tilt = lost_lowering_tilt_by_ratio_tilt * ratio_tilt_by_N_tilt
    lost_raising_tilt_by_N_tilt = lost_raising_tilt_by_ratio_tilt * ratio_tilt_by_N_tilt
    fp[1, 10] = (inverse_mass_tilt_slide_tilt_sq * (-accel_tilt_twice_J_motor_tilt_ratio_tilt
        * ratio_tilt_by_N_tilt + carried_tilt_by_N_tilt * force_tilt_by_carried_tilt
        + driving_torque_tilt_by_N_tilt + force_tilt_by_lost_lowering_tilt
        * lost_lowering_tilt_by_N_tilt + force_tilt_by_lost_raising_tilt
        * lost_raising_tilt_by_N_tilt))  # accel_tilt_by_N_tilt
    # rate_of_i_tilt_by_N_tilt
    fp[2, 10] = -K_t_tilt_omega_tilt_rate_of_i_tilt_by_u_tilt * ratio_tilt_by_N_tilt
    lost_lowering_tilt_by_lowered_tilt = (-inertia_tilt * lost_lowering_tilt_by_theta_tilt_factor
        - lost_lowering_tilt_factor)
    accel_tilt_by_lowered_tilt = (force_tilt_by_lost_lowering_tilt * inverse_mass_tilt_slide_tilt_sq
        * lost_lowering_tilt_by_lowered_tilt)
    lost_raising_tilt_by_raised_tilt = (-inertia_tilt * lost_raising_tilt_by_theta_tilt_factor
        + lost_raising_tilt_factor)
    accel_tilt_by_raised_tilt = (force_tilt_by_lost_raising_tilt * inverse_mass_tilt_slide_tilt_sq
        * lost_raising_tilt_by_raised_tilt)
    lead_tilt_inverse_lowered_tilt_factor = lead_tilt_inverse * lowered_tilt_factor
    lowered_tilt_by_lead_tilt_factor = (1.0 / (d_screw_tilt_pi_plus_f_screw_tilt_lead_tilt
        * d_screw_tilt_pi_plus_f_screw_tilt_lead_tilt))
    lead_tilt_inverse_sq = 1.0 / (lead_tilt * lead_tilt)
    d_screw_tilt_pi_lead_tilt_inverse_sq = d_screw_tilt_pi * lead_tilt_inverse_sq
    lowered_tilt_by_lead_tilt = (d_screw_tilt_pi * lead_tilt_inverse_lowered_tilt_factor
        + d_screw_tilt_pi_f_screw_tilt * d_screw_tilt_pi_f_screw_tilt_minus_lead_tilt
        * lead_tilt_inverse * lowered_tilt_by_lead_tilt_factor
        + d_screw_tilt_pi_lead_tilt_inverse_sq * lowered_tilt_factor_2)
    lead_tilt_inverse_raised_tilt_factor = lead_tilt_inverse * raised_tilt_factor
    raised_tilt_by_lead_tilt_factor = (d_screw_tilt_pi_f_screw_tilt_plus_lead_tilt
        / (d_screw_tilt_pi_minus_f_screw_tilt_lead_tilt
        * d_screw_tilt_pi_minus_f_screw_tilt_lead_tilt))
    raised_tilt_by_lead_tilt_factor_2 = lead_tilt_inverse * raised_tilt_by_lead_tilt_factor
    raised_tilt_by_lead_tilt = (d_screw_tilt_pi * lead_tilt_inverse_raised_tilt_factor
        + d_screw_tilt_pi_f_screw_tilt * raised_tilt_by_lead_tilt_factor_2
        - d_screw_tilt_pi_lead_tilt_inverse_sq * raised_tilt_factor_2)
    lead_tilt_inverse_sq_length_tilt_inverse_pi = (math.pi * lead_tilt_inverse_sq
        * length_tilt_inverse)
    ratio_tilt_by_lead_tilt = (-N_tilt * lead_tilt_inverse_sq_length_tilt_inverse_pi
        * ratio_tilt_by_N_tilt_factor)
    ratio_tilt_by_theta_tilt_by_lead_tilt = (math.pi * N_tilt * lead_tilt_inverse_sq
        * length_tilt_by_theta_tilt * length_tilt_inverse_sq * ratio_tilt_by_N_tilt_factor
        - N_tilt_ratio_tilt_by_theta_tilt_factor * lead_tilt_inverse_sq_length_tilt_inverse_pi)
    driving_torque_tilt_by_lead_tilt = (-J_motor_tilt_ratio_tilt_omega_tilt_sq
        * ratio_tilt_by_theta_tilt_by_lead_tilt + force_tilt_by_ratio_tilt
        * ratio_tilt_by_lead_tilt)
    carried_tilt_by_lead_tilt = (carried_tilt_by_ratio_tilt * ratio_tilt_by_lead_tilt
        + driving_torque_tilt_by_lead_tilt * inertia_tilt)
    lost_lowering_tilt_by_lead_tilt = lost_lowering_tilt_by_ratio_tilt * ratio_tilt_by_lead_tilt
    lost_raising_tilt_by_lead_tilt = lost_raising_tilt_by_ratio_tilt * ratio_tilt_by_lead_tilt
    # accel_tilt_by_lead_tilt
    fp[1, 11] = (accel_tilt_by_lowered_tilt * lowered_tilt_by_lead_tilt + accel_tilt_by_raised_tilt
        * raised_tilt_by_lead_tilt + inverse_mass_tilt_slide_tilt_sq
        * (-accel_tilt_twice_J_motor_tilt_ratio_tilt * ratio_tilt_by_lead_tilt
        + carried_tilt_by_lead_tilt * force_tilt_by_carried_tilt + driving_torque_tilt_by_lead_tilt
        + force_tilt_by_lost_lowering_tilt * lost_lowering_tilt_by_lead_tilt
        + force_tilt_by_lost_raising_tilt * lost_raising_tilt_by_lead_tilt))
    # rate_of_i_tilt_by_lead_tilt
    fp[2, 11] = -K_t_tilt_omega_tilt_rate_of_i_tilt_by_u_tilt * ratio_tilt_by_lead_tilt
    d_screw_tilt_pi_sq = (math.pi * math.pi) * d_screw_tilt
    d_screw_tilt_pi_sq_f_screw_tilt = d_screw_tilt_pi_sq * f_screw_tilt
    lowered_tilt_by_d_screw_tilt = ((math.pi * math.pi) * d_screw_tilt
        * d_screw_tilt_pi_f_screw_tilt_minus_lead_tilt * lead_tilt_inverse
        * lowered_tilt_by_lead_tilt_factor - d_screw_tilt_pi_sq_f_screw_tilt
        * lead_tilt_inverse_lowered_tilt_factor - lead_tilt_inverse_pi * lowered_tilt_factor_2)
    raised_tilt_by_d_screw_tilt = (-d_screw_tilt_pi_sq * raised_tilt_by_lead_tilt_factor_2
        + d_screw_tilt_pi_sq_f_screw_tilt * lead_tilt_inverse_raised_tilt_factor
        + lead_tilt_inverse_pi * raised_tilt_factor_2)
    fp[1, 12] = (accel_tilt_by_lowered_tilt * lowered_tilt_by_d_screw_tilt
        + accel_tilt_by_raised_tilt * raised_tilt_by_d_screw_tilt)  # accel_tilt_by_d_screw_tilt
    d_screw_tilt_sq_pi_sq = (math.pi * math.pi) * (d_screw_tilt * d_screw_tilt)
    lowered_tilt_by_f_screw_tilt = (math.pi * d_screw_tilt
        * d_screw_tilt_pi_f_screw_tilt_minus_lead_tilt * lowered_tilt_by_lead_tilt_factor
        - d_screw_tilt_sq_pi_sq * lead_tilt_inverse_lowered_tilt_factor)
    raised_tilt_by_f_screw_tilt = (d_screw_tilt_pi * raised_tilt_by_lead_tilt_factor
        + d_screw_tilt_sq_pi_sq * lead_tilt_inverse_raised_tilt_factor)
    fp[1, 13] = (accel_tilt_by_lowered_tilt * lowered_tilt_by_f_screw_tilt
        + accel_tilt_by_raised_tilt * raised_tilt_by_f_screw_tilt)  # accel_tilt_by_f_screw_tilt
    cos_tilt_half_length_tilt_inverse = cos_tilt * half_length_tilt_inverse
    ratio_tilt_by_linkage_cos_tilt_factor = N_tilt * lead_tilt_inverse_pi_length_tilt_inverse
    ratio_tilt_by_linkage_cos_tilt_term = ratio_tilt_by_linkage_cos_tilt_factor * sin_tilt
    ratio_tilt_by_linkage_cos_tilt = (-cos_tilt_half_length_tilt_inverse * ratio_tilt_by_length_tilt
        + ratio_tilt_by_linkage_cos_tilt_term)
    half_length_tilt_inverse_sin_tilt = half_length_tilt_inverse * sin_tilt
    length_tilt_by_theta_tilt_by_linkage_cos_tilt = (cos_tilt * quarter_length_tilt_inverse_cubed
        * ratio_tilt_by_N_tilt_factor + half_length_tilt_inverse_sin_tilt)
    ratio_tilt_by_theta_tilt_by_linkage_cos_tilt_term = (cos_tilt
        * ratio_tilt_by_linkage_cos_tilt_factor)
    ratio_tilt_by_theta_tilt_by_linkage_cos_tilt_factor = (N_tilt
        * lead_tilt_inverse_pi_length_tilt_inverse_sq * length_tilt_by_theta_tilt)
    ratio_tilt_by_theta_tilt_by_linkage_cos_tilt = (-cos_tilt_half_length_tilt_inverse
        * ratio_tilt_by_theta_tilt_by_length_tilt + length_tilt_by_theta_tilt_by_linkage_cos_tilt
        * ratio_tilt_by_length_tilt - ratio_tilt_by_theta_tilt_by_linkage_cos_tilt_factor * sin_tilt
        + ratio_tilt_by_theta_tilt_by_linkage_cos_tilt_term)
    driving_torque_tilt_by_linkage_cos_tilt = (-J_motor_tilt_ratio_tilt_omega_tilt_sq
        * ratio_tilt_by_theta_tilt_by_linkage_cos_tilt + force_tilt_by_ratio_tilt
        * ratio_tilt_by_linkage_cos_tilt)
    carried_tilt_by_linkage_cos_tilt = (carried_tilt_by_ratio_tilt * ratio_tilt_by_linkage_cos_tilt
        + driving_torque_tilt_by_linkage_cos_tilt * inertia_tilt)
    lost_lowering_tilt_by_linkage_cos_tilt = (lost_lowering_tilt_by_ratio_tilt
        * ratio_tilt_by_linkage_cos_tilt)
    lost_raising_tilt_by_linkage_cos_tilt = (lost_raising_tilt_by_ratio_tilt
        * ratio_tilt_by_linkage_cos_tilt)
    accel_tilt_by_linkage_cos_tilt = (inverse_mass_tilt_slide_tilt_sq
        * (-accel_tilt_twice_J_motor_tilt_ratio_tilt * ratio_tilt_by_linkage_cos_tilt
        + carried_tilt_by_linkage_cos_tilt * force_tilt_by_carried_tilt
        + driving_torque_tilt_by_linkage_cos_tilt + force_tilt_by_lost_lowering_tilt
        * lost_lowering_tilt_by_linkage_cos_tilt + force_tilt_by_lost_raising_tilt
        * lost_raising_tilt_by_linkage_cos_tilt))
    ratio_tilt_by_linkage_sin_tilt = (-half_length_tilt_inverse_sin_tilt * ratio_tilt_by_length_tilt
        - ratio_tilt_by_theta_tilt_by_linkage_cos_tilt_term)
    length_tilt_by_theta_tilt_by_linkage_sin_tilt = (-cos_tilt_half_length_tilt_inverse
        + 0.25 * length_tilt_inverse_cubed * ratio_tilt_by_N_tilt_factor * sin_tilt)
    ratio_tilt_by_theta_tilt_by_linkage_sin_tilt = (cos_tilt
        * ratio_tilt_by_theta_tilt_by_linkage_cos_tilt_factor - half_length_tilt_inverse_sin_tilt
        * ratio_tilt_by_theta_tilt_by_length_tilt + length_tilt_by_theta_tilt_by_linkage_sin_tilt
        * ratio_tilt_by_length_tilt + ratio_tilt_by_linkage_cos_tilt_term)
    driving_torque_tilt_by_linkage_sin_tilt = (-J_motor_tilt_ratio_tilt_omega_tilt_sq
        * ratio_tilt_by_theta_tilt_by_linkage_sin_tilt + force_tilt_by_ratio_tilt
        * ratio_tilt_by_linkage_sin_tilt)
    carried_tilt_by_linkage_sin_tilt = (carried_tilt_by_ratio_tilt * ratio_tilt_by_linkage_sin_tilt
        + driving_torque_tilt_by_linkage_sin_tilt * inertia_tilt)
    lost_lowering_tilt_by_linkage_sin_tilt = (lost_lowering_tilt_by_ratio_tilt
        * ratio_tilt_by_linkage_sin_tilt)
    lost_raising_tilt_by_linkage_sin_tilt = (lost_raising_tilt_by_ratio_tilt
        * ratio_tilt_by_linkage_sin_tilt)
    accel_tilt_by_linkage_sin_tilt = (inverse_mass_tilt_slide_tilt_sq
        * (-accel_tilt_twice_J_motor_tilt_ratio_tilt * ratio_tilt_by_linkage_sin_tilt
        + carried_tilt_by_linkage_sin_tilt * force_tilt_by_carried_tilt
        + driving_torque_tilt_by_linkage_sin_tilt + force_tilt_by_lost_lowering_tilt
        * lost_lowering_tilt_by_linkage_sin_tilt + force_tilt_by_lost_raising_tilt
        * lost_raising_tilt_by_linkage_sin_tilt))
    linkage_cos_tilt_by_l_ground_tilt = 2.0 * l_ground_tilt
    linkage_sin_tilt_inverse = 1.0 / linkage_sin_tilt
    linkage_cos_tilt_linkage_sin_tilt_inverse = linkage_cos_tilt * linkage_sin_tilt_inverse
    linkage_sin_tilt_by_l_ground_tilt = (four_times_r_arm_tilt_sq * l_ground_tilt
        * linkage_sin_tilt_inverse - linkage_cos_tilt_by_l_ground_tilt
        * linkage_cos_tilt_linkage_sin_tilt_inverse)
    length_tilt_by_l_ground_tilt = l_ground_tilt * length_tilt_inverse
    ratio_tilt_by_l_ground_tilt = length_tilt_by_l_ground_tilt * ratio_tilt_by_length_tilt
    length_tilt_by_theta_tilt_by_l_ground_tilt_factor = (0.5 * length_tilt_inverse_cubed
        * ratio_tilt_by_N_tilt_factor)
    length_tilt_by_theta_tilt_by_l_ground_tilt = (-l_ground_tilt
        * length_tilt_by_theta_tilt_by_l_ground_tilt_factor)
    ratio_tilt_by_theta_tilt_by_l_ground_tilt = (length_tilt_by_l_ground_tilt
        * ratio_tilt_by_theta_tilt_by_length_tilt + length_tilt_by_theta_tilt_by_l_ground_tilt
        * ratio_tilt_by_length_tilt)
    driving_torque_tilt_by_l_ground_tilt = (-J_motor_tilt_ratio_tilt_omega_tilt_sq
        * ratio_tilt_by_theta_tilt_by_l_ground_tilt + force_tilt_by_ratio_tilt
        * ratio_tilt_by_l_ground_tilt)
    carried_tilt_by_l_ground_tilt = (carried_tilt_by_ratio_tilt * ratio_tilt_by_l_ground_tilt
        + driving_torque_tilt_by_l_ground_tilt * inertia_tilt)
    lost_lowering_tilt_by_l_ground_tilt = (lost_lowering_tilt_by_ratio_tilt
        * ratio_tilt_by_l_ground_tilt)
    lost_raising_tilt_by_l_ground_tilt = (lost_raising_tilt_by_ratio_tilt
        * ratio_tilt_by_l_ground_tilt)
    fp[1, 14] = (accel_tilt_by_linkage_cos_tilt * linkage_cos_tilt_by_l_ground_tilt
        + accel_tilt_by_linkage_sin_tilt * linkage_sin_tilt_by_l_ground_tilt
        + inverse_mass_tilt_slide_tilt_sq * (-accel_tilt_twice_J_motor_tilt_ratio_tilt
        * ratio_tilt_by_l_ground_tilt + carried_tilt_by_l_ground_tilt * force_tilt_by_carried_tilt
        + driving_torque_tilt_by_l_ground_tilt + force_tilt_by_lost_lowering_tilt
        * lost_lowering_tilt_by_l_ground_tilt + force_tilt_by_lost_raising_tilt
        * lost_raising_tilt_by_l_ground_tilt))  # accel_tilt_by_l_ground_tilt
    rate_of_i_tilt_by_l_ground_tilt_factor = (K_t_tilt_omega_tilt_rate_of_i_tilt_by_u_tilt
        * ratio_tilt_by_linkage_cos_tilt)
    rate_of_i_tilt_by_l_ground_tilt_factor_2 = (K_t_tilt_omega_tilt_rate_of_i_tilt_by_u_tilt
        * ratio_tilt_by_linkage_sin_tilt)
    # rate_of_i_tilt_by_l_ground_tilt
    fp[2, 14] = (-K_t_tilt_omega_tilt_rate_of_i_tilt_by_u_tilt * ratio_tilt_by_l_ground_tilt
        - linkage_cos_tilt_by_l_ground_tilt * rate_of_i_tilt_by_l_ground_tilt_factor
        - linkage_sin_tilt_by_l_ground_tilt * rate_of_i_tilt_by_l_ground_tilt_factor_2)
    linkage_cos_tilt_by_l_min_tilt = -2.0 * l_min_tilt_plus_s_start_tilt
    linkage_sin_tilt_by_l_min_tilt = (-linkage_cos_tilt_by_l_min_tilt
        * linkage_cos_tilt_linkage_sin_tilt_inverse)
    accel_tilt_by_l_min_tilt = (accel_tilt_by_linkage_cos_tilt * linkage_cos_tilt_by_l_min_tilt
        + accel_tilt_by_linkage_sin_tilt * linkage_sin_tilt_by_l_min_tilt)
    fp[1, 15] = accel_tilt_by_l_min_tilt
    rate_of_i_tilt_by_l_min_tilt = (-linkage_cos_tilt_by_l_min_tilt
        * rate_of_i_tilt_by_l_ground_tilt_factor - linkage_sin_tilt_by_l_min_tilt
        * rate_of_i_tilt_by_l_ground_tilt_factor_2)
    fp[2, 15] = rate_of_i_tilt_by_l_min_tilt
    linkage_cos_tilt_by_r_arm_tilt = 2.0 * r_arm_tilt
    linkage_sin_tilt_by_r_arm_tilt = (4.0 * l_ground_tilt_sq * linkage_sin_tilt_inverse * r_arm_tilt
        - linkage_cos_tilt_by_r_arm_tilt * linkage_cos_tilt_linkage_sin_tilt_inverse)
    length_tilt_by_r_arm_tilt = length_tilt_inverse * r_arm_tilt
    ratio_tilt_by_r_arm_tilt = length_tilt_by_r_arm_tilt * ratio_tilt_by_length_tilt
    length_tilt_by_theta_tilt_by_r_arm_tilt = (-length_tilt_by_theta_tilt_by_l_ground_tilt_factor
        * r_arm_tilt)
    ratio_tilt_by_theta_tilt_by_r_arm_tilt = (length_tilt_by_r_arm_tilt
        * ratio_tilt_by_theta_tilt_by_length_tilt + length_tilt_by_theta_tilt_by_r_arm_tilt
        * ratio_tilt_by_length_tilt)
    driving_torque_tilt_by_r_arm_tilt = (-J_motor_tilt_ratio_tilt_omega_tilt_sq
        * ratio_tilt_by_theta_tilt_by_r_arm_tilt + force_tilt_by_ratio_tilt
        * ratio_tilt_by_r_arm_tilt)
    carried_tilt_by_r_arm_tilt = (carried_tilt_by_ratio_tilt * ratio_tilt_by_r_arm_tilt
        + driving_torque_tilt_by_r_arm_tilt * inertia_tilt)
    lost_lowering_tilt_by_r_arm_tilt = lost_lowering_tilt_by_ratio_tilt * ratio_tilt_by_r_arm_tilt
    lost_raising_tilt_by_r_arm_tilt = lost_raising_tilt_by_ratio_tilt * ratio_tilt_by_r_arm_tilt
    fp[1, 16] = (accel_tilt_by_linkage_cos_tilt * linkage_cos_tilt_by_r_arm_tilt
        + accel_tilt_by_linkage_sin_tilt * linkage_sin_tilt_by_r_arm_tilt
        + inverse_mass_tilt_slide_tilt_sq * (-accel_tilt_twice_J_motor_tilt_ratio_tilt
        * ratio_tilt_by_r_arm_tilt + carried_tilt_by_r_arm_tilt * force_tilt_by_carried_tilt
        + driving_torque_tilt_by_r_arm_tilt + force_tilt_by_lost_lowering_tilt
        * lost_lowering_tilt_by_r_arm_tilt + force_tilt_by_lost_raising_tilt
        * lost_raising_tilt_by_r_arm_tilt))  # accel_tilt_by_r_arm_tilt
    # rate_of_i_tilt_by_r_arm_tilt
    fp[2, 16] = (-K_t_tilt_omega_tilt_rate_of_i_tilt_by_u_tilt * ratio_tilt_by_r_arm_tilt
        - linkage_cos_tilt_by_r_arm_tilt * rate_of_i_tilt_by_l_ground_tilt_factor
        - linkage_sin_tilt_by_r_arm_tilt * rate_of_i_tilt_by_l_ground_tilt_factor_2)
    fp[1, 17] = accel_tilt_by_l_min_tilt  # accel_tilt_by_s_start_tilt
    fp[2, 17] = rate_of_i_tilt_by_l_min_tilt  # rate_of_i_tilt_by_s_start_tilt
    fp[1, 19] = (accel_tilt_by_gravity_cos_tilt * gravity_cos_tilt_by_gravity
        + accel_tilt_by_gravity_sin_tilt * gravity_sin_tilt_by_gravity)  # accel_tilt_by_gravity
    if len(gx) == 0:
        return
    # holding_tilt_by_theta_tilt
    gx[0, 0] = (-J_motor_tilt_ratio_tilt_omega_tilt_sq * ratio_tilt_by_theta_tilt_by_theta_tilt
        - carried_tilt_by_theta_tilt_factor + force_tilt_by_ratio_tilt * ratio_tilt_by_theta_tilt)
    sign_load_torque_tilt = 0.0 if load_torque_tilt == 0.0 else math.copysign(1.0, load_torque_tilt)
    raised_tilt_minus_lowered_tilt = -lowered_tilt + raised_tilt
    forward_tilt_by_theta_tilt_term = 0.5 * lowered_tilt + 0.5 * raised_tilt - 1.0
    forward_tilt_by_theta_tilt_factor = (-forward_tilt_by_theta_tilt_term
        + 0.5 * raised_tilt_minus_lowered_tilt * sign_load_torque_tilt)
    # forward_tilt_by_theta_tilt
    gx[1, 0] = -carried_tilt_by_theta_tilt_factor * forward_tilt_by_theta_tilt_factor
    backward_tilt_by_theta_tilt_factor = (forward_tilt_by_theta_tilt_term
        + 0.5 * raised_tilt_minus_lowered_tilt * sign_load_torque_tilt)
    # backward_tilt_by_theta_tilt
    gx[2, 0] = -backward_tilt_by_theta_tilt_factor * carried_tilt_by_theta_tilt_factor
    gx[0, 1] = -b_tilt_plus_carried_tilt_by_omega_tilt_factor  # holding_tilt_by_omega_tilt
    gx[1, 1] = -b_tilt * forward_tilt_by_theta_tilt_factor  # forward_tilt_by_omega_tilt
    gx[2, 1] = -b_tilt * backward_tilt_by_theta_tilt_factor  # backward_tilt_by_omega_tilt
    gx[0, 2] = driving_torque_tilt_by_i_tilt  # holding_tilt_by_i_tilt
    # holding_tilt_by_m_payload
    gp[0, 0] = cos_tilt * gravity_cos_tilt_by_m_payload + gravity_sin_tilt_by_m_payload * sin_tilt
    cos_tilt_gravity_cos_tilt_by_m_payload = cos_tilt * gravity_cos_tilt_by_m_payload
    gravity_sin_tilt_by_m_payload_sin_tilt = gravity_sin_tilt_by_m_payload * sin_tilt
    # forward_tilt_by_m_payload
    gp[1, 0] = (cos_tilt_gravity_cos_tilt_by_m_payload * forward_tilt_by_theta_tilt_factor
        + forward_tilt_by_theta_tilt_factor * gravity_sin_tilt_by_m_payload_sin_tilt)
    # backward_tilt_by_m_payload
    gp[2, 0] = (backward_tilt_by_theta_tilt_factor * cos_tilt_gravity_cos_tilt_by_m_payload
        + backward_tilt_by_theta_tilt_factor * gravity_sin_tilt_by_m_payload_sin_tilt)
    gp[0, 2] = cos_tilt * gravity_cos_tilt_by_c_x_payload  # holding_tilt_by_c_x_payload
    cos_tilt_gravity_cos_tilt_by_c_x_payload = cos_tilt * gravity_cos_tilt_by_c_x_payload
    # forward_tilt_by_c_x_payload
    gp[1, 2] = cos_tilt_gravity_cos_tilt_by_c_x_payload * forward_tilt_by_theta_tilt_factor
    # backward_tilt_by_c_x_payload
    gp[2, 2] = backward_tilt_by_theta_tilt_factor * cos_tilt_gravity_cos_tilt_by_c_x_payload
    gp[0, 3] = gravity_cos_tilt_by_c_x_payload * sin_tilt  # holding_tilt_by_c_z_payload
    gravity_cos_tilt_by_c_x_payload_sin_tilt = gravity_cos_tilt_by_c_x_payload * sin_tilt
    # forward_tilt_by_c_z_payload
    gp[1, 3] = forward_tilt_by_theta_tilt_factor * gravity_cos_tilt_by_c_x_payload_sin_tilt
    # backward_tilt_by_c_z_payload
    gp[2, 3] = backward_tilt_by_theta_tilt_factor * gravity_cos_tilt_by_c_x_payload_sin_tilt
    gp[0, 4] = -omega_tilt  # holding_tilt_by_b_tilt
    gp[1, 4] = -forward_tilt_by_theta_tilt_factor * omega_tilt  # forward_tilt_by_b_tilt
    gp[2, 4] = -backward_tilt_by_theta_tilt_factor * omega_tilt  # backward_tilt_by_b_tilt
    gp[0, 7] = driving_torque_tilt_by_K_t_tilt  # holding_tilt_by_K_t_tilt
    gp[0, 8] = -minus_holding_tilt_by_J_motor_tilt  # holding_tilt_by_J_motor_tilt
    gp[0, 9] = driving_torque_tilt_by_b_motor_tilt  # holding_tilt_by_b_motor_tilt
    gp[0, 10] = (-J_motor_tilt_ratio_tilt_omega_tilt_sq * ratio_tilt_by_theta_tilt_by_N_tilt
        + force_tilt_by_ratio_tilt * ratio_tilt_by_N_tilt)  # holding_tilt_by_N_tilt
    gp[0, 11] = (-J_motor_tilt_ratio_tilt_omega_tilt_sq * ratio_tilt_by_theta_tilt_by_lead_tilt
        + force_tilt_by_ratio_tilt * ratio_tilt_by_lead_tilt)  # holding_tilt_by_lead_tilt
    half_load_torque_tilt = 0.5 * load_torque_tilt
    half_abs_load_torque_tilt = 0.5 * abs(load_torque_tilt)
    forward_tilt_by_lead_tilt_factor = -half_abs_load_torque_tilt - half_load_torque_tilt
    forward_tilt_by_lead_tilt_factor_2 = half_abs_load_torque_tilt - half_load_torque_tilt
    # forward_tilt_by_lead_tilt
    gp[1, 11] = (forward_tilt_by_lead_tilt_factor * lowered_tilt_by_lead_tilt
        + forward_tilt_by_lead_tilt_factor_2 * raised_tilt_by_lead_tilt)
    # backward_tilt_by_lead_tilt
    gp[2, 11] = (-forward_tilt_by_lead_tilt_factor * raised_tilt_by_lead_tilt
        - forward_tilt_by_lead_tilt_factor_2 * lowered_tilt_by_lead_tilt)
    # forward_tilt_by_d_screw_tilt
    gp[1, 12] = (forward_tilt_by_lead_tilt_factor * lowered_tilt_by_d_screw_tilt
        + forward_tilt_by_lead_tilt_factor_2 * raised_tilt_by_d_screw_tilt)
    # backward_tilt_by_d_screw_tilt
    gp[2, 12] = (-forward_tilt_by_lead_tilt_factor * raised_tilt_by_d_screw_tilt
        - forward_tilt_by_lead_tilt_factor_2 * lowered_tilt_by_d_screw_tilt)
    # forward_tilt_by_f_screw_tilt
    gp[1, 13] = (forward_tilt_by_lead_tilt_factor * lowered_tilt_by_f_screw_tilt
        + forward_tilt_by_lead_tilt_factor_2 * raised_tilt_by_f_screw_tilt)
    # backward_tilt_by_f_screw_tilt
    gp[2, 13] = (-forward_tilt_by_lead_tilt_factor * raised_tilt_by_f_screw_tilt
        - forward_tilt_by_lead_tilt_factor_2 * lowered_tilt_by_f_screw_tilt)
    gp[0, 14] = (-J_motor_tilt_ratio_tilt_omega_tilt_sq * ratio_tilt_by_theta_tilt_by_l_ground_tilt
        + driving_torque_tilt_by_linkage_cos_tilt * linkage_cos_tilt_by_l_ground_tilt
        + driving_torque_tilt_by_linkage_sin_tilt * linkage_sin_tilt_by_l_ground_tilt
        + force_tilt_by_ratio_tilt * ratio_tilt_by_l_ground_tilt)  # holding_tilt_by_l_ground_tilt
    holding_tilt_by_l_min_tilt = (driving_torque_tilt_by_linkage_cos_tilt
        * linkage_cos_tilt_by_l_min_tilt + driving_torque_tilt_by_linkage_sin_tilt
        * linkage_sin_tilt_by_l_min_tilt)
    gp[0, 15] = holding_tilt_by_l_min_tilt
    gp[0, 16] = (-J_motor_tilt_ratio_tilt_omega_tilt_sq * ratio_tilt_by_theta_tilt_by_r_arm_tilt
        + driving_torque_tilt_by_linkage_cos_tilt * linkage_cos_tilt_by_r_arm_tilt
        + driving_torque_tilt_by_linkage_sin_tilt * linkage_sin_tilt_by_r_arm_tilt
        + force_tilt_by_ratio_tilt * ratio_tilt_by_r_arm_tilt)  # holding_tilt_by_r_arm_tilt
    gp[0, 17] = holding_tilt_by_l_min_tilt  # holding_tilt_by_s_start_tilt
    # holding_tilt_by_gravity
    gp[0, 19] = cos_tilt * gravity_cos_tilt_by_gravity + gravity_sin_tilt_by_gravity * sin_tilt
    cos_tilt_gravity_cos_tilt_by_gravity = cos_tilt * gravity_cos_tilt_by_gravity
    gravity_sin_tilt_by_gravity_sin_tilt = gravity_sin_tilt_by_gravity * sin_tilt
    # forward_tilt_by_gravity
    gp[1, 19] = (cos_tilt_gravity_cos_tilt_by_gravity * forward_tilt_by_theta_tilt_factor
        + forward_tilt_by_theta_tilt_factor * gravity_sin_tilt_by_gravity_sin_tilt)
    # backward_tilt_by_gravity
    gp[2, 19] = (backward_tilt_by_theta_tilt_factor * cos_tilt_gravity_cos_tilt_by_gravity
        + backward_tilt_by_theta_tilt_factor * gravity_sin_tilt_by_gravity_sin_tilt)


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def outputs(t, x, u, p, y):
    """Write the measured signals into y.

    t, x [3], u [1], p [20]; y [2] in OUTPUT_UNITS.
    """
    theta_tilt, i_tilt = x[0], x[2]
    y[0] = theta_tilt  # reading_theta_tilt
    y[1] = i_tilt  # reading_i_tilt


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def output_jacobian(t, x, u, p, yx, yp):
    """Write the non-zero derivatives of outputs by state and parameter.

    t, x [3], u [1], p [20]; yx [2, 3]; yp [2, 20].
    """
    yx[0, 0] = 1.0  # reading_theta_tilt_by_theta_tilt
    yx[1, 2] = 1.0  # reading_i_tilt_by_i_tilt


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def domain(p, bounds):
    """Write lower and upper bound of the state of every row of DOMAIN into bounds.

    p [20]; bounds [2, 2] in STATE_UNITS: lower, upper.
    """
    l_ground_tilt, l_min_tilt, r_arm_tilt, s_start_tilt = p[14], p[15], p[16], p[17]
    s_max_tilt = p[18]
    l_ground_tilt_sq_plus_r_arm_tilt_sq = ((l_ground_tilt * l_ground_tilt)
        + (r_arm_tilt * r_arm_tilt))
    half_per_l_ground_tilt_per_r_arm_tilt = 0.5 / (l_ground_tilt * r_arm_tilt)
    highest_theta_tilt = (math.acos(half_per_l_ground_tilt_per_r_arm_tilt
        * (l_ground_tilt_sq_plus_r_arm_tilt_sq - ((l_min_tilt + s_start_tilt) * (l_min_tilt
        + s_start_tilt)))))
    bounds[0, 0] = highest_theta_tilt - math.pi  # lowest_theta_tilt
    bounds[0, 1] = highest_theta_tilt
    bounds[1, 0] = (highest_theta_tilt
        - math.acos(max(-1.0, min(1.0, half_per_l_ground_tilt_per_r_arm_tilt
        * (l_ground_tilt_sq_plus_r_arm_tilt_sq - ((l_min_tilt + s_max_tilt) * (l_min_tilt
        + s_max_tilt)))))))  # lowest_theta_tilt
    # highest_theta_tilt
    bounds[1, 1] = (highest_theta_tilt
        - math.acos(max(-1.0, min(1.0, half_per_l_ground_tilt_per_r_arm_tilt
        * (l_ground_tilt_sq_plus_r_arm_tilt_sq - (l_min_tilt * l_min_tilt))))))


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def margins(p, margin):
    """Write by how much the parameters meet every row of REQUIREMENTS into margin.

    p [20]; margin [3] in units of what is compared.
    """
    lead_tilt, d_screw_tilt, f_screw_tilt, l_ground_tilt = p[11], p[12], p[13], p[14]
    l_min_tilt, r_arm_tilt, s_start_tilt, s_max_tilt = p[15], p[16], p[17], p[18]
    # requirement_0
    margin[0] = (2.0 * l_ground_tilt * r_arm_tilt - abs((l_ground_tilt * l_ground_tilt)
        + (r_arm_tilt * r_arm_tilt) - ((l_min_tilt + s_start_tilt) * (l_min_tilt + s_start_tilt))))
    margin[1] = s_max_tilt - s_start_tilt  # requirement_1
    margin[2] = math.pi * d_screw_tilt - f_screw_tilt * lead_tilt  # requirement_2


@njit(cache=True, error_model="numpy", nogil=True, forceinline=True, _nrt=False)
def breaking_away(slide, holding, forward, backward):
    """Return the direction of a friction: if it sticks, that of a torque beyond breakaway."""
    if slide == 0.0 and holding > forward:
        return 1.0
    if slide == 0.0 and -holding > backward:
        return -1.0
    return slide


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def implied_modes(t, x, u, p):
    """Return the modes that a state implies, in the order of MODE_NAMES: contact from the
    separation, sticking from the holding torque.
    """
    omega_tilt = x[1]
    slide_tilt = np.sign(omega_tilt)
    g = guard_values(t, x, u, p, slide_tilt)
    slide_tilt = breaking_away(slide_tilt, g[0], g[1], g[2])
    return (slide_tilt,)


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def initial_modes(t, x, u, p, m):
    """Write the modes that a state implies into m; see MODE_NAMES."""
    (m[0],) = implied_modes(t, x, u, p)


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def state_derivative(t, x, u, p, dx):
    """Write the time derivative of the state into dx, in the modes that the state implies."""
    mode_derivative(t, x, u, p, implied_modes(t, x, u, p), dx)


# What the field calls some of these functions.
vector_field, events, inverse_dynamics = mode_derivative, guards, equation_error


# What follows is for fits and diagnoses; no function above uses it.
# States without influence while these parameters are at their vanishing values.
IDLE_STATES = ()
# Relations: parameters, rule, strict; `margins` gives what is at least zero.
REQUIREMENTS = (
    (("l_ground_tilt", "l_min_tilt", "r_arm_tilt", "s_start_tilt"),
     "the linkage closes, off its dead centres; change a length", True),
    (("s_start_tilt", "s_max_tilt"), "s_start is at most s_max; change one of them", False),
    (("lead_tilt", "d_screw_tilt", "f_screw_tilt"),
     "the screw wedges unless f < pi d / lead; lower f_screw", True),
)
# Searching them: name, value at which the effect vanishes (None: any), starts,
# period, what a frequency is locked to.
SEARCH = (("b_tilt", 0.0, (0.1,), None, None),)
# Effects: id, axis, parameters, nested members (title, parameters, tied ones), keys of the
# effects that it acts on, title, reference, separating experiment, first member leads.
EFFECTS = (
    ("payload", None, ("m_payload", "J_y_payload", "c_x_payload", "c_z_payload"), (), (), "payload",
     "thesis section 3.2.2, Table 5.3 with erratum 18", "", False),
    ("viscous_friction", "tilt", ("b_tilt",), (), (), "viscous friction in the joint",
     "thesis Eq. 2.8, Eq. 3.8 (b_p, b_t)",
     "Run at six or more steady speeds, the slowest near the Stribeck speed.", False),
    ("linear_actuator", "tilt", ("L_tilt", "R_tilt", "K_t_tilt", "J_motor_tilt", "b_motor_tilt",
     "N_tilt", "lead_tilt", "d_screw_tilt", "f_screw_tilt", "l_ground_tilt", "l_min_tilt",
     "r_arm_tilt", "s_start_tilt", "s_max_tilt"), (), (),
     "linear actuator with lead screw and linkage",
     "thesis Eq. 3.10, 3.12 and 3.2.3.2 with errata 9 and 10, Tables 5.5, 5.6", "", False),
)
# END sha256 49bffeeececffe882ce3104a2918fe4f891d9d65be8267908a0742d8a9a61fe0
