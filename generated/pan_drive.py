"""Pan drive of the thesis: equations of motion, emitted; do not edit.

M(q) q'' = forcing - friction, with the lower triangle of M by symmetry:

  M[0, 0] = J_pan
  M[1, 1] = J_motor_pan*N_pan**2
  forcing[omega_pan] = active_pan*(d_shaft_pan*(omega_gear_pan - omega_pan) +
      k_shaft_pan*(-gap_pan*side_pan/2 + theta_gear_pan - theta_pan)) - b_pan*omega_pan
  forcing[omega_gear_pan] = K_t_pan*N_pan*i_pan - active_pan*(d_shaft_pan*(omega_gear_pan -
      omega_pan) + k_shaft_pan*(-gap_pan*side_pan/2 + theta_gear_pan - theta_pan))
  sliding friction[omega_gear_pan] = F_c_pan*(a_F_c_pan*slide_pan + 1) +
      F_v_pan*omega_gear_pan*slide_pan*(a_F_v_pan*slide_pan + 1) +
      (-F_c_pan*(a_F_c_pan*slide_pan + 1) + F_s_pan*(a_F_s_pan*slide_pan +
      1))*exp(-omega_gear_pan**2/(v_s_pan**2*(a_v_s_pan*slide_pan + 1)**2))
  i_pan' = (-K_t_pan*N_pan*omega_gear_pan - R_pan*i_pan + u_pan)/L_pan

Operations of the state derivative: 65 as derived, 54 as written, 48 of them at every
call where `prepare` does the others once per parameter set.

Effects:
- rigid_bodies: thesis Eq. 3.8, Table 5.1
- viscous_friction (pan): thesis Eq. 2.8, Eq. 3.8 (b_p, b_t)
- csvs_friction (pan): thesis Eq. 2.10, 2.11 with errata 2 and 3, Eq. 4.1, exponent 2
- direction_dependent_friction (pan): thesis Tables 4.1 and 4.2 (omega > 0, omega < 0)
- backlash (pan): thesis Eq. 2.16 (dead zone), Table 5.7; contact that cannot pull
- shaft_compliance (pan): thesis Eq. 2.15 with erratum 4, Table 5.7
- dc_motor (pan): thesis Eq. 3.10, Eq. 3.11 with erratum 8
"""

import math

import numpy as np
from numba import njit

MODEL_HASH = "d5359052a93d2a54"
NAME = "pan_drive"
TITLE = "Pan drive of the thesis"
# How many numbers `prepare` writes.
PREPARED = 5
AXES = ("pan",)
STATE_NAMES = ("theta_pan", "omega_pan", "theta_gear_pan", "omega_gear_pan", "i_pan")
STATE_UNITS = ("rad", "rad/s", "rad", "rad/s", "A")
STATE_INITIAL = (0.0, 0.0, 0.0, 0.0, 0.0)
INPUT_NAMES = ("u_pan",)
INPUT_UNITS = ("V",)
# Per input: index of the parameter by which it is late, or -1.
INPUT_DELAYS = (-1,)
# Per input: whether motion depends on it, and not samplers alone.
INPUT_ACTS = (True,)
OUTPUT_NAMES = ("theta_pan", "i_pan")
OUTPUT_UNITS = ("rad", "A")
MODE_NAMES = ("slide_pan", "side_pan", "active_pan")
FRICTION_RATES = np.array([3], dtype=np.int64)
# Per state: the friction that sets it to zero when it comes to rest, or -1.
ZERO_AT_REST = (-1, -1, -1, -1, -1)
# Samplers: parameters of the period. Sampled: sampler and state of each update.
SAMPLERS = ()
SAMPLED = ()
# Per contact: state index of the angle at the gear output and at the joint.
CONTACT_ANGLES = ((2, 0),)
# Limits of the equations: state, meaning; `domain` gives the bounds.
DOMAIN = ()
# Parameters: name, unit, default, lower and upper bound, meaning.
PARAMETERS = (
    ("J_pan", "kg m^2", 0.05, 1e-12, 10000.0, "inertia of the pan body about z"),
    ("b_pan", "N m s/rad", 2.0, 0.0, 10000.0, "viscous friction in the pan joint"),
    ("F_c_pan", "N m", 0.2401, 0.0, 10000.0, "Coulomb friction torque"),
    ("F_s_pan", "N m", 0.675, 0.0, 10000.0, "static (breakaway) friction torque"),
    ("v_s_pan", "rad/s", 0.016, 1e-06, 1000.0, "Stribeck speed"),
    ("F_v_pan", "N m s/rad", 13.9424, 0.0, 10000.0, "viscous part"),
    ("a_F_c_pan", "1", -0.05581007913369427, -0.95, 0.95,
     "relative half difference of Coulomb friction"),
    ("a_F_s_pan", "1", -0.17362962962962966, -0.95, 0.95,
     "relative half difference of static friction"),
    ("a_v_s_pan", "1", -0.006249999999999962, -0.95, 0.95,
     "relative half difference of Stribeck speed"),
    ("a_F_v_pan", "1", -0.025677071379389464, -0.95, 0.95,
     "relative half difference of viscous friction"),
    ("gap_pan", "rad", 0.02600540585471551, 0.0, 1.0, "whole gap between the two faces"),
    ("k_shaft_pan", "N m/rad", 5000.0, 0.001, 1000000000.0, "shaft stiffness"),
    ("d_shaft_pan", "N m s/rad", 1.0, 0.0, 1000000.0, "shaft damping"),
    ("L_pan", "H", 0.0069, 1e-09, 1000.0, "winding inductance"),
    ("R_pan", "ohm", 12.9, 1e-06, 1000000.0, "winding resistance"),
    ("K_t_pan", "N m/A", 0.0724, 1e-09, 10000.0, "torque constant"),
    ("J_motor_pan", "kg m^2", 1.1e-05, 1e-12, 1000.0, "rotor inertia"),
    ("N_pan", "1", 500.0, 0.001, 1000000.0, "gear ratio"),
)


# Arguments, in SI: t in s; x in STATE_UNITS, u in INPUT_UNITS, p in the units of PARAMETERS;
# modes m as MODE_NAMES; c as `prepare` writes it. Lengths and shapes are in brackets.
@njit(cache=True, error_model="numpy", nogil=True, forceinline=True, _nrt=False)
def constants(p):
    """Return what depends on the parameters alone."""
    J_pan, gap_pan, K_t_pan, J_motor_pan, N_pan = p[0], p[10], p[15], p[16], p[17]
    half_gap_pan = 0.5 * gap_pan
    inverse_mass_pan = 1.0 / J_pan
    mass_gear_pan = J_motor_pan * (N_pan * N_pan)
    inverse_mass_gear_pan = 1.0 / mass_gear_pan
    K_t_pan_N_pan = K_t_pan * N_pan
    return half_gap_pan, inverse_mass_pan, mass_gear_pan, inverse_mass_gear_pan, K_t_pan_N_pan


@njit(cache=True, error_model="numpy", nogil=True, forceinline=True, _nrt=False)
def mass_and_forces(t, x, u, p, slide_pan, side_pan, active_pan, c):
    """Return mass matrix, forces and what else the functions below have in common."""
    theta_pan, omega_pan, theta_gear_pan, omega_gear_pan, i_pan = x[0], x[1], x[2], x[3], x[4]
    u_pan = u[0]
    b_pan, F_c_pan, F_s_pan, v_s_pan, F_v_pan, a_F_c_pan = p[1], p[2], p[3], p[4], p[5], p[6]
    a_F_s_pan, a_v_s_pan, a_F_v_pan, k_shaft_pan, d_shaft_pan = p[7], p[8], p[9], p[11], p[12]
    L_pan, R_pan, K_t_pan, N_pan = p[13], p[14], p[15], p[17]
    half_gap_pan, K_t_pan_N_pan = c[0], c[4]
    omega_gear_pan_minus_omega_pan = omega_gear_pan - omega_pan
    d_shaft_pan_omega_gear_pan_minus_omega_pan = d_shaft_pan * omega_gear_pan_minus_omega_pan
    theta_pan_minus_theta_gear_pan = -theta_gear_pan + theta_pan
    shaft_torque_pan_factor = -half_gap_pan * side_pan - theta_pan_minus_theta_gear_pan
    k_shaft_pan_shaft_torque_pan_factor = k_shaft_pan * shaft_torque_pan_factor
    shaft_torque_pan = (active_pan * (d_shaft_pan_omega_gear_pan_minus_omega_pan
        + k_shaft_pan_shaft_torque_pan_factor))
    force_pan = -b_pan * omega_pan + shaft_torque_pan
    coulomb_torque_pan = F_c_pan * (a_F_c_pan * slide_pan + 1.0)
    omega_gear_pan_sq = omega_gear_pan * omega_gear_pan
    stribeck_square_pan = (omega_gear_pan_sq / ((v_s_pan * v_s_pan) * ((a_v_s_pan * slide_pan
        + 1.0) * (a_v_s_pan * slide_pan + 1.0))))
    viscous_coefficient_pan = F_v_pan * (a_F_v_pan * slide_pan + 1.0)
    friction_torque_gear_pan = (slide_pan * (coulomb_torque_pan
        + omega_gear_pan * slide_pan * viscous_coefficient_pan + (F_s_pan * (a_F_s_pan * slide_pan
        + 1.0) - coulomb_torque_pan) * math.exp(-stribeck_square_pan)))
    force_gear_pan = K_t_pan * N_pan * i_pan - friction_torque_gear_pan - shaft_torque_pan
    rate_of_i_pan = (-K_t_pan_N_pan * omega_gear_pan - R_pan * i_pan + u_pan) / L_pan
    return (omega_gear_pan_minus_omega_pan, d_shaft_pan_omega_gear_pan_minus_omega_pan,
        theta_pan_minus_theta_gear_pan, shaft_torque_pan_factor,
        k_shaft_pan_shaft_torque_pan_factor, shaft_torque_pan, force_pan, omega_gear_pan_sq,
        friction_torque_gear_pan, force_gear_pan, rate_of_i_pan)


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def prepare(p, c):
    """Write into c what prepared_derivative takes from the parameters alone.

    p [18]; c [5].
    c: what `constants` returns, in its order.
    """
    values = constants(p)
    for k in range(PREPARED):
        c[k] = values[k]


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def prepared_derivative(t, x, u, p, m, c, dx):
    """Write the time derivative of the state into dx in the modes m, c being prepared.

    t, x [5], u [1], p [18], m [3], c [5]; dx [5] in STATE_UNITS per s.
    """
    slide_pan, side_pan, active_pan = m[0], m[1], m[2]
    forces = mass_and_forces(t, x, u, p, slide_pan, side_pan, active_pan, c)
    force_pan, force_gear_pan, rate_of_i_pan = forces[6], forces[9], forces[10]
    omega_pan, omega_gear_pan = x[1], x[3]
    inverse_mass_pan, inverse_mass_gear_pan = c[1], c[3]
    dx[0] = omega_pan  # rate_of_theta_pan
    dx[1] = force_pan * inverse_mass_pan  # accel_pan
    dx[2] = omega_gear_pan  # rate_of_theta_gear_pan
    dx[3] = force_gear_pan * inverse_mass_gear_pan * (slide_pan * slide_pan)  # accel_gear_pan
    dx[4] = rate_of_i_pan


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def mode_derivative(t, x, u, p, m, dx):
    """Write the time derivative of the state into dx in the modes m.

    t, x [5], u [1], p [18], m [3]; dx [5] in STATE_UNITS per s.
    """
    prepared_derivative(t, x, u, p, m, constants(p), dx)


@njit(cache=True, error_model="numpy", nogil=True, forceinline=True, _nrt=False)
def guard_values(t, x, u, p, slide_pan, side_pan, active_pan):
    """Return what `guards` writes, in modes that are given one by one."""
    c = constants(p)
    forces = mass_and_forces(t, x, u, p, slide_pan, side_pan, active_pan, c)
    d_shaft_pan_omega_gear_pan_minus_omega_pan = forces[1]
    theta_pan_minus_theta_gear_pan, shaft_torque_pan = forces[2], forces[5]
    i_pan = x[4]
    F_s_pan, a_F_s_pan, k_shaft_pan = p[3], p[7], p[11]
    half_gap_pan, K_t_pan_N_pan = c[0], c[4]
    holding_pan = K_t_pan_N_pan * i_pan - shaft_torque_pan
    forward_pan = F_s_pan * (a_F_s_pan + 1.0)
    backward_pan = F_s_pan * (1.0 - a_F_s_pan)
    upper_pan = (d_shaft_pan_omega_gear_pan_minus_omega_pan + k_shaft_pan * (-half_gap_pan
        - theta_pan_minus_theta_gear_pan))
    lower_pan = (d_shaft_pan_omega_gear_pan_minus_omega_pan + k_shaft_pan * (half_gap_pan
        - theta_pan_minus_theta_gear_pan))
    return (holding_pan, forward_pan, backward_pan, -theta_pan_minus_theta_gear_pan, half_gap_pan,
        upper_pan, lower_pan)


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def guards(t, x, u, p, m, g):
    """Write holding and breakaway torques, gap separations and contact torques into g.

    t, x [5], u [1], p [18], m [3]; g [7] in N m and rad.
    g: holding_pan, forward_pan, backward_pan, separation_pan, half_gap_pan, upper_pan, lower_pan.
    """
    slide_pan, side_pan, active_pan = m[0], m[1], m[2]
    (g[0], g[1], g[2], g[3], g[4], g[5], g[6]) = guard_values(t, x, u, p, slide_pan, side_pan,
        active_pan)


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def energy(t, x, u, p, m, e):
    """Write stored energy in J, power in and dissipated power in W into e.

    t, x [5], u [1], p [18], m [3]; e [3] in J, W and W.
    e: stored, power_in, dissipated.
    """
    slide_pan, side_pan, active_pan = m[0], m[1], m[2]
    c = constants(p)
    forces = mass_and_forces(t, x, u, p, slide_pan, side_pan, active_pan, c)
    omega_gear_pan_minus_omega_pan = forces[0]
    d_shaft_pan_omega_gear_pan_minus_omega_pan, shaft_torque_pan_factor = forces[1], forces[3]
    k_shaft_pan_shaft_torque_pan_factor, omega_gear_pan_sq = forces[4], forces[7]
    friction_torque_gear_pan = forces[8]
    omega_pan, omega_gear_pan, i_pan = x[1], x[3], x[4]
    u_pan = u[0]
    J_pan, b_pan, k_shaft_pan, L_pan, R_pan = p[0], p[1], p[11], p[13], p[14]
    mass_gear_pan = c[2]
    side_pan_sq = side_pan * side_pan
    i_pan_sq = i_pan * i_pan
    omega_pan_sq = omega_pan * omega_pan
    e[0] = (0.5 * J_pan * omega_pan_sq + 0.5 * L_pan * i_pan_sq
        + 0.5 * k_shaft_pan * (shaft_torque_pan_factor * shaft_torque_pan_factor) * side_pan_sq
        + 0.5 * mass_gear_pan * omega_gear_pan_sq)  # stored
    e[1] = i_pan * u_pan  # power_in
    twist_rate_pan = omega_gear_pan_minus_omega_pan * side_pan_sq
    winding_loss_pan = R_pan * i_pan_sq
    # dissipated
    e[2] = (b_pan * omega_pan_sq + friction_torque_gear_pan * omega_gear_pan
        + twist_rate_pan * (active_pan * d_shaft_pan_omega_gear_pan_minus_omega_pan
        - k_shaft_pan_shaft_torque_pan_factor * (1.0 - active_pan)) + winding_loss_pan)


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def equation_error(t, x, u, p, m, r):
    """Write torques that rows lack, then other states' rates, into r; x ends in accelerations.

    t, x [7], u [1], p [18], m [3]; r [3] in N m, then STATE_UNITS per s.
    x: STATE_NAMES, then given_accel_pan, given_accel_gear_pan.
    r: torque_pan, torque_gear_pan, rate_of_i_pan.
    """
    slide_pan, side_pan, active_pan = m[0], m[1], m[2]
    c = constants(p)
    forces = mass_and_forces(t, x, u, p, slide_pan, side_pan, active_pan, c)
    force_pan, force_gear_pan, rate_of_i_pan = forces[6], forces[9], forces[10]
    given_accel_pan, given_accel_gear_pan = x[5], x[6]
    J_pan = p[0]
    mass_gear_pan = c[2]
    r[0] = J_pan * given_accel_pan - force_pan  # torque_pan
    r[1] = -force_gear_pan + given_accel_gear_pan * mass_gear_pan  # torque_gear_pan
    r[2] = rate_of_i_pan


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def mass_matrix(t, x, u, p, m, M):
    """Write the mass matrix of the joints, then of gear outputs, into M.

    t, x [5], u [1], p [18], m [3]; M [2, 2] in kg m^2.
    """
    c = constants(p)
    J_pan = p[0]
    mass_gear_pan = c[2]
    M[0, 0] = J_pan  # mass_pan
    M[0, 1] = 0.0  # mass_pan_gear_pan
    M[1, 0] = 0.0  # mass_pan_gear_pan
    M[1, 1] = mass_gear_pan


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def gravity_torque(t, x, u, p, m, G):
    """Write the torques that hold the machine against its weight into G.

    t, x [5], u [1], p [18], m [3]; G [2] in N m.
    G: gravity_torque_pan, gravity_torque_gear_pan.
    """
    G[0] = 0.0  # gravity_torque_pan
    G[1] = 0.0  # gravity_torque_gear_pan


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def linearize(t, x, u, p, m, fx, fu, fp, gx, gp):
    """Write the non-zero derivatives of dx into fx, fu, fp and those of guards into gx, gp.

    t, x [5], u [1], p [18], m [3]; fx [5, 5]; fu [5, 1]; fp [5, 18]; gx [7, 5]; gp [7, 18].
    fx: rows and columns as STATE_NAMES; fu: rows as STATE_NAMES, columns as INPUT_NAMES; fp: rows
      as STATE_NAMES, columns as PARAMETERS; gx: rows as g of guards, columns as STATE_NAMES; gp:
      rows as g of guards, columns as PARAMETERS.
    Where fp or gx is empty, it and what follows it is not computed.
    """
    theta_pan, omega_pan, theta_gear_pan, omega_gear_pan, i_pan = x[0], x[1], x[2], x[3], x[4]
    u_pan = u[0]
    J_pan, b_pan, F_c_pan, F_s_pan, v_s_pan, F_v_pan = p[0], p[1], p[2], p[3], p[4], p[5]
    a_F_c_pan, a_F_s_pan, a_v_s_pan, a_F_v_pan, gap_pan = p[6], p[7], p[8], p[9], p[10]
    k_shaft_pan, d_shaft_pan, L_pan, R_pan, K_t_pan = p[11], p[12], p[13], p[14], p[15]
    J_motor_pan, N_pan = p[16], p[17]
    slide_pan, side_pan, active_pan = m[0], m[1], m[2]
    inverse_mass_pan = 1.0 / J_pan
    holding_pan_by_theta_pan = active_pan * k_shaft_pan
    accel_pan_by_theta_gear_pan = holding_pan_by_theta_pan * inverse_mass_pan
    fx[1, 0] = -accel_pan_by_theta_gear_pan  # accel_pan_by_theta_pan
    N_pan_sq = N_pan * N_pan
    mass_gear_pan = J_motor_pan * N_pan_sq
    inverse_mass_gear_pan = 1.0 / mass_gear_pan
    slide_pan_sq = slide_pan * slide_pan
    inverse_mass_gear_pan_slide_pan_sq = inverse_mass_gear_pan * slide_pan_sq
    accel_gear_pan_by_theta_gear_pan = (-holding_pan_by_theta_pan
        * inverse_mass_gear_pan_slide_pan_sq)
    fx[3, 0] = -accel_gear_pan_by_theta_gear_pan  # accel_gear_pan_by_theta_pan
    fx[0, 1] = 1.0  # rate_of_theta_pan_by_omega_pan
    balance_gear_pan_by_omega_pan = active_pan * d_shaft_pan
    fx[1, 1] = inverse_mass_pan * (-b_pan - balance_gear_pan_by_omega_pan)  # accel_pan_by_omega_pan
    # accel_gear_pan_by_omega_pan
    fx[3, 1] = balance_gear_pan_by_omega_pan * inverse_mass_gear_pan_slide_pan_sq
    fx[1, 2] = accel_pan_by_theta_gear_pan
    fx[3, 2] = accel_gear_pan_by_theta_gear_pan
    fx[1, 3] = balance_gear_pan_by_omega_pan * inverse_mass_pan  # accel_pan_by_omega_gear_pan
    fx[2, 3] = 1.0  # rate_of_theta_gear_pan_by_omega_gear_pan
    v_s_pan_inverse_sq = 1.0 / (v_s_pan * v_s_pan)
    one_plus_a_v_s_pan_slide_pan = a_v_s_pan * slide_pan + 1.0
    one_plus_a_v_s_pan_slide_pan_inverse_sq = (1.0 / (one_plus_a_v_s_pan_slide_pan
        * one_plus_a_v_s_pan_slide_pan))
    stribeck_square_pan_factor = one_plus_a_v_s_pan_slide_pan_inverse_sq * v_s_pan_inverse_sq
    one_plus_a_F_c_pan_slide_pan = a_F_c_pan * slide_pan + 1.0
    coulomb_torque_pan = F_c_pan * one_plus_a_F_c_pan_slide_pan
    one_plus_a_F_s_pan_slide_pan = a_F_s_pan * slide_pan + 1.0
    omega_gear_pan_sq = omega_gear_pan * omega_gear_pan
    stribeck_square_pan = omega_gear_pan_sq * stribeck_square_pan_factor
    exp_minus_stribeck_square_pan = math.exp(-stribeck_square_pan)
    accel_gear_pan_by_omega_gear_pan_factor = (exp_minus_stribeck_square_pan * (F_s_pan
        * one_plus_a_F_s_pan_slide_pan - coulomb_torque_pan))
    twice_accel_gear_pan_by_omega_gear_pan_factor = 2.0 * accel_gear_pan_by_omega_gear_pan_factor
    one_plus_a_F_v_pan_slide_pan = a_F_v_pan * slide_pan + 1.0
    viscous_coefficient_pan = F_v_pan * one_plus_a_F_v_pan_slide_pan
    # accel_gear_pan_by_omega_gear_pan
    fx[3, 3] = (inverse_mass_gear_pan_slide_pan_sq * (-balance_gear_pan_by_omega_pan - slide_pan
        * (-omega_gear_pan * stribeck_square_pan_factor
        * twice_accel_gear_pan_by_omega_gear_pan_factor + slide_pan * viscous_coefficient_pan)))
    rate_of_i_pan_by_u_pan = 1.0 / L_pan
    balance_gear_pan_by_i_pan = K_t_pan * N_pan
    # rate_of_i_pan_by_omega_gear_pan
    fx[4, 3] = -balance_gear_pan_by_i_pan * rate_of_i_pan_by_u_pan
    # accel_gear_pan_by_i_pan
    fx[3, 4] = balance_gear_pan_by_i_pan * inverse_mass_gear_pan_slide_pan_sq
    fx[4, 4] = -R_pan * rate_of_i_pan_by_u_pan  # rate_of_i_pan_by_i_pan
    fu[4, 0] = rate_of_i_pan_by_u_pan
    if len(fp) == 0:
        return
    upper_pan_by_d_shaft_pan = omega_gear_pan - omega_pan
    half_gap_pan = 0.5 * gap_pan
    theta_pan_minus_theta_gear_pan = -theta_gear_pan + theta_pan
    shaft_torque_pan_factor = -half_gap_pan * side_pan - theta_pan_minus_theta_gear_pan
    shaft_torque_pan = (active_pan * (d_shaft_pan * upper_pan_by_d_shaft_pan
        + k_shaft_pan * shaft_torque_pan_factor))
    force_pan = -b_pan * omega_pan + shaft_torque_pan
    accel_pan = force_pan * inverse_mass_pan
    fp[1, 0] = -accel_pan * inverse_mass_pan  # accel_pan_by_J_pan
    fp[1, 1] = -inverse_mass_pan * omega_pan  # accel_pan_by_b_pan
    fp[3, 2] = (-inverse_mass_gear_pan_slide_pan_sq * slide_pan * (-exp_minus_stribeck_square_pan
        * one_plus_a_F_c_pan_slide_pan + one_plus_a_F_c_pan_slide_pan))  # accel_gear_pan_by_F_c_pan
    fp[3, 3] = (-exp_minus_stribeck_square_pan * inverse_mass_gear_pan_slide_pan_sq
        * one_plus_a_F_s_pan_slide_pan * slide_pan)  # accel_gear_pan_by_F_s_pan
    accel_gear_pan_by_v_s_pan_factor = (omega_gear_pan_sq
        * twice_accel_gear_pan_by_omega_gear_pan_factor)
    # accel_gear_pan_by_v_s_pan
    fp[3, 4] = (-accel_gear_pan_by_v_s_pan_factor * inverse_mass_gear_pan_slide_pan_sq
        * one_plus_a_v_s_pan_slide_pan_inverse_sq * slide_pan / (v_s_pan * v_s_pan * v_s_pan))
    fp[3, 5] = (-inverse_mass_gear_pan_slide_pan_sq * omega_gear_pan * one_plus_a_F_v_pan_slide_pan
        * slide_pan_sq)  # accel_gear_pan_by_F_v_pan
    F_c_pan_slide_pan = F_c_pan * slide_pan
    fp[3, 6] = (-inverse_mass_gear_pan_slide_pan_sq * slide_pan * (-F_c_pan_slide_pan
        * exp_minus_stribeck_square_pan + F_c_pan_slide_pan))  # accel_gear_pan_by_a_F_c_pan
    fp[3, 7] = (-F_s_pan * exp_minus_stribeck_square_pan * inverse_mass_gear_pan_slide_pan_sq
        * slide_pan_sq)  # accel_gear_pan_by_a_F_s_pan
    # accel_gear_pan_by_a_v_s_pan
    fp[3, 8] = (-accel_gear_pan_by_v_s_pan_factor * inverse_mass_gear_pan_slide_pan_sq
        * slide_pan_sq * v_s_pan_inverse_sq / (one_plus_a_v_s_pan_slide_pan
        * one_plus_a_v_s_pan_slide_pan * one_plus_a_v_s_pan_slide_pan))
    omega_gear_pan_slide_pan = omega_gear_pan * slide_pan
    # accel_gear_pan_by_a_F_v_pan
    fp[3, 9] = -F_v_pan * inverse_mass_gear_pan_slide_pan_sq * omega_gear_pan_slide_pan
    balance_gear_pan_by_gap_pan = 0.5 * holding_pan_by_theta_pan * side_pan
    fp[1, 10] = -balance_gear_pan_by_gap_pan * inverse_mass_pan  # accel_pan_by_gap_pan
    # accel_gear_pan_by_gap_pan
    fp[3, 10] = balance_gear_pan_by_gap_pan * inverse_mass_gear_pan_slide_pan_sq
    balance_gear_pan_by_k_shaft_pan = -active_pan * shaft_torque_pan_factor
    fp[1, 11] = -balance_gear_pan_by_k_shaft_pan * inverse_mass_pan  # accel_pan_by_k_shaft_pan
    # accel_gear_pan_by_k_shaft_pan
    fp[3, 11] = balance_gear_pan_by_k_shaft_pan * inverse_mass_gear_pan_slide_pan_sq
    balance_gear_pan_by_d_shaft_pan = -active_pan * upper_pan_by_d_shaft_pan
    fp[1, 12] = -balance_gear_pan_by_d_shaft_pan * inverse_mass_pan  # accel_pan_by_d_shaft_pan
    # accel_gear_pan_by_d_shaft_pan
    fp[3, 12] = balance_gear_pan_by_d_shaft_pan * inverse_mass_gear_pan_slide_pan_sq
    fp[4, 13] = (-(-R_pan * i_pan - balance_gear_pan_by_i_pan * omega_gear_pan
        + u_pan) / (L_pan * L_pan))  # rate_of_i_pan_by_L_pan
    fp[4, 14] = -i_pan * rate_of_i_pan_by_u_pan  # rate_of_i_pan_by_R_pan
    balance_gear_pan_by_K_t_pan = N_pan * i_pan
    # accel_gear_pan_by_K_t_pan
    fp[3, 15] = balance_gear_pan_by_K_t_pan * inverse_mass_gear_pan_slide_pan_sq
    omega_gear_pan_rate_of_i_pan_by_u_pan = omega_gear_pan * rate_of_i_pan_by_u_pan
    fp[4, 15] = -N_pan * omega_gear_pan_rate_of_i_pan_by_u_pan  # rate_of_i_pan_by_K_t_pan
    force_gear_pan = (K_t_pan * N_pan * i_pan - shaft_torque_pan
        - slide_pan * (accel_gear_pan_by_omega_gear_pan_factor + coulomb_torque_pan
        + omega_gear_pan_slide_pan * viscous_coefficient_pan))
    accel_gear_pan = force_gear_pan * inverse_mass_gear_pan_slide_pan_sq
    # accel_gear_pan_by_J_motor_pan
    fp[3, 16] = -N_pan_sq * accel_gear_pan * inverse_mass_gear_pan_slide_pan_sq
    fp[3, 17] = (inverse_mass_gear_pan_slide_pan_sq * (-2.0 * J_motor_pan * N_pan * accel_gear_pan
        + K_t_pan * i_pan))  # accel_gear_pan_by_N_pan
    fp[4, 17] = -K_t_pan * omega_gear_pan_rate_of_i_pan_by_u_pan  # rate_of_i_pan_by_N_pan
    if len(gx) == 0:
        return
    gx[0, 0] = holding_pan_by_theta_pan
    gx[3, 0] = -1.0  # separation_pan_by_theta_pan
    gx[5, 0] = -k_shaft_pan  # upper_pan_by_theta_pan
    gx[6, 0] = -k_shaft_pan  # lower_pan_by_theta_pan
    gx[0, 1] = balance_gear_pan_by_omega_pan  # holding_pan_by_omega_pan
    gx[5, 1] = -d_shaft_pan  # upper_pan_by_omega_pan
    gx[6, 1] = -d_shaft_pan  # lower_pan_by_omega_pan
    gx[0, 2] = -holding_pan_by_theta_pan  # holding_pan_by_theta_gear_pan
    gx[3, 2] = 1.0  # separation_pan_by_theta_gear_pan
    gx[5, 2] = k_shaft_pan  # upper_pan_by_theta_gear_pan
    gx[6, 2] = k_shaft_pan  # lower_pan_by_theta_gear_pan
    gx[0, 3] = -balance_gear_pan_by_omega_pan  # holding_pan_by_omega_gear_pan
    gx[5, 3] = d_shaft_pan  # upper_pan_by_omega_gear_pan
    gx[6, 3] = d_shaft_pan  # lower_pan_by_omega_gear_pan
    gx[0, 4] = balance_gear_pan_by_i_pan  # holding_pan_by_i_pan
    gp[1, 3] = a_F_s_pan + 1.0  # forward_pan_by_F_s_pan
    gp[2, 3] = 1.0 - a_F_s_pan  # backward_pan_by_F_s_pan
    gp[1, 7] = F_s_pan  # forward_pan_by_a_F_s_pan
    gp[2, 7] = -F_s_pan  # backward_pan_by_a_F_s_pan
    gp[0, 10] = balance_gear_pan_by_gap_pan  # holding_pan_by_gap_pan
    gp[4, 10] = 0.5  # half_gap_pan_by_gap_pan
    lower_pan_by_gap_pan = 0.5 * k_shaft_pan
    gp[5, 10] = -lower_pan_by_gap_pan  # upper_pan_by_gap_pan
    gp[6, 10] = lower_pan_by_gap_pan
    gp[0, 11] = balance_gear_pan_by_k_shaft_pan  # holding_pan_by_k_shaft_pan
    gp[5, 11] = -half_gap_pan - theta_pan_minus_theta_gear_pan  # upper_pan_by_k_shaft_pan
    gp[6, 11] = half_gap_pan + theta_gear_pan - theta_pan  # lower_pan_by_k_shaft_pan
    gp[0, 12] = balance_gear_pan_by_d_shaft_pan  # holding_pan_by_d_shaft_pan
    gp[5, 12] = upper_pan_by_d_shaft_pan
    gp[6, 12] = upper_pan_by_d_shaft_pan  # lower_pan_by_d_shaft_pan
    gp[0, 15] = balance_gear_pan_by_K_t_pan  # holding_pan_by_K_t_pan
    gp[0, 17] = K_t_pan * i_pan  # holding_pan_by_N_pan


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def outputs(t, x, u, p, y):
    """Write the measured signals into y.

    t, x [5], u [1], p [18]; y [2] in OUTPUT_UNITS.
    """
    theta_pan, i_pan = x[0], x[4]
    y[0] = theta_pan  # reading_theta_pan
    y[1] = i_pan  # reading_i_pan


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def output_jacobian(t, x, u, p, yx, yp):
    """Write the non-zero derivatives of outputs by state and parameter.

    t, x [5], u [1], p [18]; yx [2, 5]; yp [2, 18].
    """
    yx[0, 0] = 1.0  # reading_theta_pan_by_theta_pan
    yx[1, 4] = 1.0  # reading_i_pan_by_i_pan


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def domain(p, bounds):
    """Write lower and upper bound of the state of every row of DOMAIN into bounds.

    p [18]; bounds [0, 2] in STATE_UNITS: lower, upper.
    """
    return


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def margins(p, margin):
    """Write by how much the parameters meet every row of REQUIREMENTS into margin.

    p [18]; margin [1] in units of what is compared.
    """
    F_c_pan, F_s_pan = p[2], p[3]
    margin[0] = -F_c_pan + F_s_pan  # requirement_0


@njit(cache=True, error_model="numpy", nogil=True, forceinline=True, _nrt=False)
def touching(separation, half_gap, upper, lower):
    """Return side and activity of a contact: the face beyond half the gap, active if it pushes."""
    side = 1.0 if separation > 0.0 else -1.0
    if side * separation > half_gap:
        torque = upper if side > 0.0 else lower
        return side, (1.0 if side * torque > 0.0 else 0.0)
    return 0.0, 0.0


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
    omega_gear_pan = x[3]
    g = guard_values(t, x, u, p, 0.0, 0.0, 0.0)
    side_pan, active_pan = touching(g[3], g[4], g[5], g[6])
    slide_pan = np.sign(omega_gear_pan)
    g = guard_values(t, x, u, p, slide_pan, side_pan, active_pan)
    slide_pan = breaking_away(slide_pan, g[0], g[1], g[2])
    return slide_pan, side_pan, active_pan


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def initial_modes(t, x, u, p, m):
    """Write the modes that a state implies into m; see MODE_NAMES."""
    m[0], m[1], m[2] = implied_modes(t, x, u, p)


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
REQUIREMENTS = ((("F_c_pan", "F_s_pan"), "F_s is at least F_c; raise F_s or lower F_c", False),)
# Searching them: name, value at which the effect vanishes (None: any), starts,
# period, what a frequency is locked to.
SEARCH = (
    ("b_pan", 0.0, (0.1,), None, None),
    ("F_c_pan", 0.0, (0.05,), None, None),
    ("F_s_pan", 0.0, (0.05,), None, None),
    ("v_s_pan", None, (0.05,), None, None),
    ("F_v_pan", 0.0, (0.0,), None, None),
    ("a_F_c_pan", 0.0, (-0.1, 0.1), None, None),
    ("a_F_s_pan", 0.0, (0.0,), None, None),
    ("a_v_s_pan", 0.0, (0.0,), None, None),
    ("a_F_v_pan", 0.0, (0.0,), None, None),
    ("gap_pan", 0.0, (0.005, 0.02, 0.05), None, None),
    ("k_shaft_pan", None, (100.0, 3000.0), None, None),
    ("d_shaft_pan", None, (1.0,), None, None),
)
# Effects: id, axis, parameters, nested members (title, parameters, tied ones), keys of the
# effects that it acts on, title, reference, separating experiment, first member leads.
EFFECTS = (
    ("rigid_bodies", None, ("J_pan",), (), (), "pan body and tilt body",
     "thesis Eq. 3.8, Table 5.1", "", False),
    ("viscous_friction", "pan", ("b_pan",), (), (), "viscous friction in the joint",
     "thesis Eq. 2.8, Eq. 3.8 (b_p, b_t)",
     "Run at six or more steady speeds, the slowest near the Stribeck speed.", False),
    ("csvs_friction", "pan", ("F_c_pan", "F_s_pan", "v_s_pan", "F_v_pan"), (("Coulomb friction",
     ("F_c_pan",), (("F_s_pan", "F_c_pan"),)), ("Coulomb and viscous friction", ("F_c_pan",
     "F_v_pan"), (("F_s_pan", "F_c_pan"),)), ("Coulomb and static friction, Stribeck curve",
     ("F_c_pan", "F_s_pan", "v_s_pan"), ()), ("Coulomb, static, viscous and Stribeck friction",
     ("F_c_pan", "F_s_pan", "v_s_pan", "F_v_pan"), ())), (),
     "Coulomb, static, viscous and Stribeck friction",
     "thesis Eq. 2.10, 2.11 with errata 2 and 3, Eq. 4.1, exponent 2",
     "Crawl through standstill in both directions at several slow speeds.", False),
    ("direction_dependent_friction", "pan", ("a_F_c_pan", "a_F_s_pan", "a_v_s_pan", "a_F_v_pan"),
     (("Coulomb friction", ("a_F_c_pan",), ()), ("viscous friction", ("a_F_v_pan",), ()),
     ("Coulomb and static friction", ("a_F_c_pan", "a_F_s_pan"), ()),
     ("Coulomb and viscous friction", ("a_F_c_pan", "a_F_v_pan"), ()),
     ("Coulomb, static and viscous friction", ("a_F_c_pan", "a_F_s_pan", "a_F_v_pan"), ()),
     ("all of dry and viscous friction", ("a_F_c_pan", "a_F_s_pan", "a_v_s_pan", "a_F_v_pan"), ())),
     ("csvs_friction@pan",), "friction that differs by direction",
     "thesis Tables 4.1 and 4.2 (omega > 0, omega < 0)",
     "Run the same speeds both ways at two supply polarities, or back-drive the joint "
     "without power: friction follows the motion, an offset does not.", False),
    ("backlash", "pan", ("gap_pan",), (), ("shaft_compliance@pan",), "backlash",
     "thesis Eq. 2.16 (dead zone), Table 5.7; contact that cannot pull",
     "Reverse slowly with and without a known preload torque on the joint: backlash "
     "disappears under preload, presliding does not.", False),
    ("shaft_compliance", "pan", ("k_shaft_pan", "d_shaft_pan"), (), (), "flexible shaft",
     "thesis Eq. 2.15 with erratum 4, Table 5.7",
     "Lock the motor and strike the joint, or excite with a 10 to 40 Hz chirp: a shaft"
     " resonates, a delay only turns the phase, and a gap rings at no fixed frequency.", False),
    ("dc_motor", "pan", ("L_pan", "R_pan", "K_t_pan", "J_motor_pan", "N_pan"), (), (),
     "geared DC motor", "thesis Eq. 3.10, Eq. 3.11 with erratum 8", "", False),
)
# END sha256 70c9612f76ded493b97cfb1e025fe5c6826318441368fafafcb4f13edaeda995
