"""Both axes of the thesis, all drives: equations of motion, emitted; do not edit.

M(q) q'' = forcing - friction, with the lower triangle of M by symmetry:

  M[0, 0] = inertia_pan + inertia_pan_per_sin_tilt*sin(theta_tilt)
  M[0, 1] = -coupling_cos_tilt*cos(theta_tilt) + coupling_sin_tilt*sin(theta_tilt)
  M[1, 1] = J_motor_tilt*ratio_tilt**2 + inertia_tilt
  M[2, 2] = J_motor_pan*N_pan**2
  forcing[omega_pan] = active_pan*(d_shaft_pan*(omega_gear_pan - omega_pan) +
      k_shaft_pan*(-gap_pan*side_pan/2 + theta_gear_pan - theta_pan)) - b_pan*omega_pan -
      coriolis*omega_tilt - coupling_cos_tilt*omega_tilt**2*sin(theta_tilt) -
      coupling_sin_tilt*omega_tilt**2*cos(theta_tilt)
  forcing[omega_tilt] = -J_motor_tilt*omega_tilt**2*ratio_tilt*ratio_tilt_by_theta_tilt -
      b_tilt*omega_tilt + coriolis*omega_pan/2 + gravity_cos_tilt*cos(theta_tilt) +
      gravity_sin_tilt*sin(theta_tilt) + ratio_tilt*(K_t_tilt*i_tilt -
      b_motor_tilt*omega_tilt*ratio_tilt)
  forcing[omega_gear_pan] = K_t_pan*N_pan*i_pan - active_pan*(d_shaft_pan*(omega_gear_pan -
      omega_pan) + k_shaft_pan*(-gap_pan*side_pan/2 + theta_gear_pan - theta_pan))

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
  follower_coupling_tilt = -coupling_cos_tilt*cos(theta_tilt) +
      coupling_sin_tilt*sin(theta_tilt)
  follower_inertia_tilt = inertia_pan + inertia_pan_per_sin_tilt*sin(theta_tilt)
  follower_torque_tilt = active_pan*(d_shaft_pan*(omega_gear_pan - omega_pan) +
      k_shaft_pan*(-gap_pan*side_pan/2 + theta_gear_pan - theta_pan)) - b_pan*omega_pan -
      coriolis*omega_tilt - coupling_cos_tilt*omega_tilt**2*sin(theta_tilt) -
      coupling_sin_tilt*omega_tilt**2*cos(theta_tilt)
  driving_torque_tilt = -J_motor_tilt*omega_tilt**2*ratio_tilt*ratio_tilt_by_theta_tilt +
      ratio_tilt*(K_t_tilt*i_tilt - b_motor_tilt*omega_tilt*ratio_tilt)
  load_torque_tilt = -b_tilt*omega_tilt + coriolis*omega_pan/2 -
      follower_coupling_tilt*follower_torque_tilt/follower_inertia_tilt +
      gravity_cos_tilt*cos(theta_tilt) + gravity_sin_tilt*sin(theta_tilt)
  load_inertia_tilt = -follower_coupling_tilt**2/follower_inertia_tilt + inertia_tilt
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

  sliding friction[omega_gear_pan] = F_c_pan*(a_F_c_pan*slide_pan + 1) +
      F_v_pan*omega_gear_pan*slide_pan*(a_F_v_pan*slide_pan + 1) +
      (-F_c_pan*(a_F_c_pan*slide_pan + 1) + F_s_pan*(a_F_s_pan*slide_pan +
      1))*exp(-omega_gear_pan**2/(v_s_pan**2*(a_v_s_pan*slide_pan + 1)**2))
  sliding friction[omega_tilt] = carried_tilt*slide_tilt*(-lost_lowering_tilt +
      lost_raising_tilt)/2 + (lost_lowering_tilt +
      lost_raising_tilt)*Abs(carried_tilt*slide_tilt)/2
  i_pan' = (-K_t_pan*N_pan*omega_gear_pan - R_pan*i_pan + u_pan)/L_pan
  i_tilt' = (-K_t_tilt*omega_tilt*ratio_tilt - R_tilt*i_tilt + u_tilt)/L_tilt

Operations of the state derivative: 697 as derived, 224 as written, 166 of them at every
call where `prepare` does the others once per parameter set.

Effects:
- rigid_bodies: thesis Eq. 3.8, Table 5.1
- payload: thesis section 3.2.2, Table 5.3 with erratum 18
- viscous_friction (pan): thesis Eq. 2.8, Eq. 3.8 (b_p, b_t)
- viscous_friction (tilt): thesis Eq. 2.8, Eq. 3.8 (b_p, b_t)
- csvs_friction (pan): thesis Eq. 2.10, 2.11 with errata 2 and 3, Eq. 4.1, exponent 2
- direction_dependent_friction (pan): thesis Tables 4.1 and 4.2 (omega > 0, omega < 0)
- backlash (pan): thesis Eq. 2.16 (dead zone), Table 5.7; contact that cannot pull
- shaft_compliance (pan): thesis Eq. 2.15 with erratum 4, Table 5.7
- dc_motor (pan): thesis Eq. 3.10, Eq. 3.11 with erratum 8
- linear_actuator (tilt): thesis Eq. 3.10, 3.12 and 3.2.3.2 with errata 9 and 10, Tables 5.5, 5.6
"""

import math

import numpy as np
from numba import njit

MODEL_HASH = "92b6e3417a56047e"
NAME = "full"
TITLE = "Both axes of the thesis, all drives"
# How many numbers `prepare` writes.
PREPARED = 19
AXES = ("pan", "tilt")
STATE_NAMES = (
    "theta_pan", "theta_tilt", "omega_pan", "omega_tilt", "theta_gear_pan", "omega_gear_pan",
    "i_pan", "i_tilt",
)
STATE_UNITS = ("rad", "rad", "rad/s", "rad/s", "rad", "rad/s", "A", "A")
STATE_INITIAL = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
INPUT_NAMES = ("u_pan", "u_tilt")
INPUT_UNITS = ("V", "V")
# Per input: index of the parameter by which it is late, or -1.
INPUT_DELAYS = (-1, -1)
# Per input: whether motion depends on it, and not samplers alone.
INPUT_ACTS = (True, True)
OUTPUT_NAMES = ("theta_pan", "theta_tilt", "i_pan", "i_tilt")
OUTPUT_UNITS = ("rad", "rad", "A", "A")
MODE_NAMES = ("slide_pan", "slide_tilt", "side_pan", "active_pan")
FRICTION_RATES = np.array([5, 3], dtype=np.int64)
# Per state: the friction that sets it to zero when it comes to rest, or -1.
ZERO_AT_REST = (-1, -1, -1, -1, -1, -1, -1, -1)
# Samplers: parameters of the period. Sampled: sampler and state of each update.
SAMPLERS = ()
SAMPLED = ()
# Per contact: state index of the angle at the gear output and at the joint.
CONTACT_ANGLES = ((4, 0),)
# Limits of the equations: state, meaning; `domain` gives the bounds.
DOMAIN = (
    ("theta_tilt", "dead centre of the tilt linkage"),
    ("theta_tilt", "stroke end of the tilt actuator"),
)
# Parameters: name, unit, default, lower and upper bound, meaning.
PARAMETERS = (
    ("J_pan", "kg m^2", 0.01083, 1e-12, 10000.0, "inertia of the pan body about z"),
    ("J_x_tilt", "kg m^2", 0.00041, 1e-12, 10000.0, "inertia of the tilt body about x"),
    ("J_y_tilt", "kg m^2", 0.00065, 1e-12, 10000.0, "inertia of the tilt body about y"),
    ("J_z_tilt", "kg m^2", 0.00027, 1e-12, 10000.0, "inertia of the tilt body about z"),
    ("m_payload", "kg", 6.3785, 0.0, 100000.0, "payload mass"),
    ("J_x_payload", "kg m^2", 0.038, 0.0, 10000.0, "payload inertia about its own x axis"),
    ("J_y_payload", "kg m^2", 0.0136, 0.0, 10000.0, "payload inertia about its own y axis"),
    ("J_z_payload", "kg m^2", 0.0389, 0.0, 10000.0, "payload inertia about its own z axis"),
    ("c_x_payload", "m", 0.0, -10.0, 10.0, "x of the payload's centre of mass"),
    ("c_y_payload", "m", 0.0, -10.0, 10.0, "y of the payload's centre of mass"),
    ("c_z_payload", "m", 0.0876228, -10.0, 10.0, "z of the payload's centre of mass"),
    ("b_pan", "N m s/rad", 2.0, 0.0, 10000.0, "viscous friction in the pan joint"),
    ("b_tilt", "N m s/rad", 10.0, 0.0, 10000.0, "viscous friction in the tilt joint"),
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
    J_pan, J_x_tilt, J_y_tilt, J_z_tilt, m_payload, J_x_payload = p[0], p[1], p[2], p[3], p[4], p[5]
    J_y_payload, J_z_payload, c_x_payload, c_y_payload, c_z_payload = p[6], p[7], p[8], p[9], p[10]
    gap_pan, K_t_pan, J_motor_pan, N_pan, lead_tilt = p[21], p[26], p[27], p[28], p[35]
    d_screw_tilt, f_screw_tilt, l_ground_tilt, l_min_tilt = p[36], p[37], p[38], p[39]
    r_arm_tilt, s_start_tilt, gravity = p[40], p[41], p[43]
    inertia_pan_sin_cos_tilt = 2.0 * c_x_payload * c_z_payload * m_payload
    c_z_payload_sq_m_payload = (c_z_payload * c_z_payload) * m_payload
    c_x_payload_sq_m_payload = (c_x_payload * c_x_payload) * m_payload
    inertia_pan_sin_sq_tilt = (J_x_payload + J_x_tilt - J_z_payload - J_z_tilt
        - c_x_payload_sq_m_payload + c_z_payload_sq_m_payload)
    c_y_payload_m_payload = c_y_payload * m_payload
    coupling_cos_tilt = c_y_payload_m_payload * c_z_payload
    coupling_sin_tilt = c_x_payload * c_y_payload_m_payload
    half_gap_pan = 0.5 * gap_pan
    inertia_tilt = J_y_payload + J_y_tilt + c_x_payload_sq_m_payload + c_z_payload_sq_m_payload
    inertia_pan = (J_pan + J_z_payload + J_z_tilt + c_x_payload_sq_m_payload
        + (c_y_payload * c_y_payload) * m_payload)
    d_screw_tilt_pi = math.pi * d_screw_tilt
    f_screw_tilt_lead_tilt = f_screw_tilt * lead_tilt
    d_screw_tilt_pi_f_screw_tilt = d_screw_tilt_pi * f_screw_tilt
    lead_tilt_inverse = 1.0 / lead_tilt
    d_screw_tilt_pi_lead_tilt_inverse = d_screw_tilt_pi * lead_tilt_inverse
    lowered_tilt = (-d_screw_tilt_pi_lead_tilt_inverse * (d_screw_tilt_pi_f_screw_tilt
        - lead_tilt) / (d_screw_tilt_pi + f_screw_tilt_lead_tilt))
    l_ground_tilt_sq = l_ground_tilt * l_ground_tilt
    r_arm_tilt_sq = r_arm_tilt * r_arm_tilt
    l_ground_tilt_sq_plus_r_arm_tilt_sq = l_ground_tilt_sq + r_arm_tilt_sq
    linkage_cos_tilt = (l_ground_tilt_sq_plus_r_arm_tilt_sq - ((l_min_tilt
        + s_start_tilt) * (l_min_tilt + s_start_tilt)))
    linkage_sin_tilt = (math.sqrt(4.0 * l_ground_tilt_sq * r_arm_tilt_sq
        - (linkage_cos_tilt * linkage_cos_tilt)))
    raised_tilt = (d_screw_tilt_pi_lead_tilt_inverse * (d_screw_tilt_pi_f_screw_tilt
        + lead_tilt) / (d_screw_tilt_pi - f_screw_tilt_lead_tilt))
    gravity_m_payload = gravity * m_payload
    gravity_cos_tilt = c_x_payload * gravity_m_payload
    gravity_sin_tilt = c_z_payload * gravity_m_payload
    mass_gear_pan = J_motor_pan * (N_pan * N_pan)
    inverse_mass_gear_pan = 1.0 / mass_gear_pan
    K_t_pan_N_pan = K_t_pan * N_pan
    raised_tilt_minus_lowered_tilt = -lowered_tilt + raised_tilt
    return (inertia_pan_sin_cos_tilt, inertia_pan_sin_sq_tilt, coupling_cos_tilt, coupling_sin_tilt,
        half_gap_pan, inertia_tilt, inertia_pan, lead_tilt_inverse, lowered_tilt,
        l_ground_tilt_sq_plus_r_arm_tilt_sq, linkage_cos_tilt, linkage_sin_tilt, raised_tilt,
        gravity_cos_tilt, gravity_sin_tilt, mass_gear_pan, inverse_mass_gear_pan, K_t_pan_N_pan,
        raised_tilt_minus_lowered_tilt)


@njit(cache=True, error_model="numpy", nogil=True, forceinline=True, _nrt=False)
def mass_and_forces(t, x, u, p, slide_pan, slide_tilt, side_pan, active_pan, c):
    """Return mass matrix, forces and what else the functions below have in common."""
    theta_pan, theta_tilt, omega_pan, omega_tilt, theta_gear_pan = x[0], x[1], x[2], x[3], x[4]
    omega_gear_pan, i_pan, i_tilt = x[5], x[6], x[7]
    u_pan, u_tilt = u[0], u[1]
    b_pan, b_tilt, F_c_pan, F_s_pan, v_s_pan, F_v_pan = p[11], p[12], p[13], p[14], p[15], p[16]
    a_F_c_pan, a_F_s_pan, a_v_s_pan, a_F_v_pan, k_shaft_pan = p[17], p[18], p[19], p[20], p[22]
    d_shaft_pan, L_pan, R_pan, K_t_pan, N_pan, L_tilt = p[23], p[24], p[25], p[26], p[28], p[29]
    R_tilt, K_t_tilt, J_motor_tilt, b_motor_tilt, N_tilt = p[30], p[31], p[32], p[33], p[34]
    inertia_pan_sin_cos_tilt, inertia_pan_sin_sq_tilt, coupling_cos_tilt = c[0], c[1], c[2]
    coupling_sin_tilt, half_gap_pan, inertia_tilt, inertia_pan = c[3], c[4], c[5], c[6]
    lead_tilt_inverse, lowered_tilt, l_ground_tilt_sq_plus_r_arm_tilt_sq = c[7], c[8], c[9]
    linkage_cos_tilt, linkage_sin_tilt, raised_tilt, gravity_cos_tilt = c[10], c[11], c[12], c[13]
    gravity_sin_tilt, K_t_pan_N_pan = c[14], c[17]
    cos_tilt = math.cos(theta_tilt)
    sin_tilt = math.sin(theta_tilt)
    inertia_pan_per_sin_tilt = (cos_tilt * inertia_pan_sin_cos_tilt
        + inertia_pan_sin_sq_tilt * sin_tilt)
    coriolis = omega_pan * (2.0 * cos_tilt * inertia_pan_per_sin_tilt - inertia_pan_sin_cos_tilt)
    omega_gear_pan_minus_omega_pan = omega_gear_pan - omega_pan
    d_shaft_pan_omega_gear_pan_minus_omega_pan = d_shaft_pan * omega_gear_pan_minus_omega_pan
    theta_pan_minus_theta_gear_pan = -theta_gear_pan + theta_pan
    shaft_torque_pan_factor = -half_gap_pan * side_pan - theta_pan_minus_theta_gear_pan
    k_shaft_pan_shaft_torque_pan_factor = k_shaft_pan * shaft_torque_pan_factor
    shaft_torque_pan = (active_pan * (d_shaft_pan_omega_gear_pan_minus_omega_pan
        + k_shaft_pan_shaft_torque_pan_factor))
    force_pan = (-b_pan * omega_pan - omega_tilt * (coriolis
        + omega_tilt * (cos_tilt * coupling_sin_tilt + coupling_cos_tilt * sin_tilt))
        + shaft_torque_pan)
    mass_pan = inertia_pan + inertia_pan_per_sin_tilt * sin_tilt
    mass_pan_inverse = 1.0 / mass_pan
    mass_pan_tilt = -cos_tilt * coupling_cos_tilt + coupling_sin_tilt * sin_tilt
    mass_pan_tilt_sq = mass_pan_tilt * mass_pan_tilt
    load_inertia_tilt = inertia_tilt - mass_pan_inverse * mass_pan_tilt_sq
    cos_tilt_linkage_cos_tilt = cos_tilt * linkage_cos_tilt
    linkage_sin_tilt_sin_tilt = linkage_sin_tilt * sin_tilt
    length_tilt = (math.sqrt(-cos_tilt_linkage_cos_tilt + l_ground_tilt_sq_plus_r_arm_tilt_sq
        - linkage_sin_tilt_sin_tilt))
    N_tilt_lead_tilt_inverse_pi_per_length_tilt = math.pi * N_tilt * lead_tilt_inverse / length_tilt
    ratio_tilt_factor = -cos_tilt * linkage_sin_tilt + linkage_cos_tilt * sin_tilt
    ratio_tilt = N_tilt_lead_tilt_inverse_pi_per_length_tilt * ratio_tilt_factor
    ratio_tilt_sq = ratio_tilt * ratio_tilt
    J_motor_tilt_ratio_tilt_sq = J_motor_tilt * ratio_tilt_sq
    lost_lowering_tilt = ((1.0 - lowered_tilt) / abs(J_motor_tilt_ratio_tilt_sq
        + load_inertia_tilt * lowered_tilt))
    lost_raising_tilt = ((raised_tilt - 1.0) / (J_motor_tilt_ratio_tilt_sq
        + load_inertia_tilt * raised_tilt))
    length_tilt_by_theta_tilt = 0.5 * ratio_tilt_factor / length_tilt
    ratio_tilt_by_theta_tilt = (-math.pi * N_tilt * lead_tilt_inverse * length_tilt_by_theta_tilt
        * ratio_tilt_factor / (length_tilt * length_tilt)
        + N_tilt_lead_tilt_inverse_pi_per_length_tilt * (cos_tilt_linkage_cos_tilt
        + linkage_sin_tilt_sin_tilt))
    omega_tilt_sq = omega_tilt * omega_tilt
    driving_torque_tilt_term = J_motor_tilt * omega_tilt_sq * ratio_tilt * ratio_tilt_by_theta_tilt
    omega_tilt_ratio_tilt = omega_tilt * ratio_tilt
    driving_torque_tilt_factor = K_t_tilt * i_tilt - b_motor_tilt * omega_tilt_ratio_tilt
    driving_torque_tilt = driving_torque_tilt_factor * ratio_tilt - driving_torque_tilt_term
    force_pan_mass_pan_tilt = force_pan * mass_pan_tilt
    minus_gravity_torque_tilt = cos_tilt * gravity_cos_tilt + gravity_sin_tilt * sin_tilt
    load_torque_tilt_term = (-b_tilt * omega_tilt + 0.5 * coriolis * omega_pan
        + minus_gravity_torque_tilt)
    load_torque_tilt = -force_pan_mass_pan_tilt * mass_pan_inverse + load_torque_tilt_term
    carried_tilt = (-J_motor_tilt_ratio_tilt_sq * load_torque_tilt
        + driving_torque_tilt * load_inertia_tilt)
    carried_tilt_slide_tilt = carried_tilt * slide_tilt
    friction_torque_tilt = (slide_tilt * (0.5 * carried_tilt_slide_tilt * (-lost_lowering_tilt
        + lost_raising_tilt) + 0.5 * (lost_lowering_tilt
        + lost_raising_tilt) * abs(carried_tilt_slide_tilt)))
    transmitted_torque_tilt = driving_torque_tilt_factor * ratio_tilt
    forcing_tilt = -driving_torque_tilt_term + load_torque_tilt_term + transmitted_torque_tilt
    force_tilt = forcing_tilt - friction_torque_tilt
    mass_tilt = J_motor_tilt_ratio_tilt_sq + inertia_tilt
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
    rate_of_i_tilt = (-K_t_tilt * omega_tilt_ratio_tilt - R_tilt * i_tilt + u_tilt) / L_tilt
    return (cos_tilt, sin_tilt, omega_gear_pan_minus_omega_pan,
        d_shaft_pan_omega_gear_pan_minus_omega_pan, theta_pan_minus_theta_gear_pan,
        shaft_torque_pan_factor, k_shaft_pan_shaft_torque_pan_factor, shaft_torque_pan, force_pan,
        mass_pan, mass_pan_tilt, mass_pan_tilt_sq, ratio_tilt_sq, omega_tilt_sq,
        force_pan_mass_pan_tilt, minus_gravity_torque_tilt, load_torque_tilt, friction_torque_tilt,
        forcing_tilt, force_tilt, mass_tilt, omega_gear_pan_sq, friction_torque_gear_pan,
        force_gear_pan, rate_of_i_pan, rate_of_i_tilt)


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def prepare(p, c):
    """Write into c what prepared_derivative takes from the parameters alone.

    p [44]; c [19].
    c: what `constants` returns, in its order.
    """
    values = constants(p)
    for k in range(PREPARED):
        c[k] = values[k]


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def prepared_derivative(t, x, u, p, m, c, dx):
    """Write the time derivative of the state into dx in the modes m, c being prepared.

    t, x [8], u [2], p [44], m [4], c [19]; dx [8] in STATE_UNITS per s.
    """
    slide_pan, slide_tilt, side_pan, active_pan = m[0], m[1], m[2], m[3]
    forces = mass_and_forces(t, x, u, p, slide_pan, slide_tilt, side_pan, active_pan, c)
    force_pan, mass_pan, mass_pan_tilt = forces[8], forces[9], forces[10]
    mass_pan_tilt_sq, force_pan_mass_pan_tilt, force_tilt = forces[11], forces[14], forces[19]
    mass_tilt, force_gear_pan, rate_of_i_pan = forces[20], forces[23], forces[24]
    rate_of_i_tilt = forces[25]
    omega_pan, omega_tilt, omega_gear_pan = x[2], x[3], x[5]
    inverse_mass_gear_pan = c[16]
    dx[0] = omega_pan  # rate_of_theta_pan
    dx[1] = omega_tilt  # rate_of_theta_tilt
    slide_tilt_sq = slide_tilt * slide_tilt
    inverse_determinant = 1.0 / (mass_pan * mass_tilt - mass_pan_tilt_sq * slide_tilt_sq)
    accel_pan = (inverse_determinant * (force_pan * mass_tilt
        - force_tilt * mass_pan_tilt * slide_tilt_sq))
    dx[2] = accel_pan
    dx[3] = (inverse_determinant * slide_tilt_sq * (-force_pan_mass_pan_tilt * slide_tilt_sq
        + force_tilt * mass_pan))  # accel_tilt
    dx[4] = omega_gear_pan  # rate_of_theta_gear_pan
    dx[5] = force_gear_pan * inverse_mass_gear_pan * (slide_pan * slide_pan)  # accel_gear_pan
    dx[6] = rate_of_i_pan
    dx[7] = rate_of_i_tilt


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def mode_derivative(t, x, u, p, m, dx):
    """Write the time derivative of the state into dx in the modes m.

    t, x [8], u [2], p [44], m [4]; dx [8] in STATE_UNITS per s.
    """
    prepared_derivative(t, x, u, p, m, constants(p), dx)


@njit(cache=True, error_model="numpy", nogil=True, forceinline=True, _nrt=False)
def guard_values(t, x, u, p, slide_pan, slide_tilt, side_pan, active_pan):
    """Return what `guards` writes, in modes that are given one by one."""
    c = constants(p)
    forces = mass_and_forces(t, x, u, p, slide_pan, slide_tilt, side_pan, active_pan, c)
    d_shaft_pan_omega_gear_pan_minus_omega_pan = forces[3]
    theta_pan_minus_theta_gear_pan, shaft_torque_pan, force_pan = forces[4], forces[7], forces[8]
    mass_pan, mass_pan_tilt, mass_pan_tilt_sq = forces[9], forces[10], forces[11]
    load_torque_tilt, forcing_tilt, force_tilt = forces[16], forces[18], forces[19]
    mass_tilt = forces[20]
    i_pan = x[6]
    F_s_pan, a_F_s_pan, k_shaft_pan = p[14], p[18], p[22]
    half_gap_pan, lowered_tilt, raised_tilt, K_t_pan_N_pan = c[4], c[8], c[12], c[17]
    raised_tilt_minus_lowered_tilt = c[18]
    slide_tilt_sq = slide_tilt * slide_tilt
    inverse_determinant = 1.0 / (mass_pan * mass_tilt - mass_pan_tilt_sq * slide_tilt_sq)
    accel_pan = (inverse_determinant * (force_pan * mass_tilt
        - force_tilt * mass_pan_tilt * slide_tilt_sq))
    holding_pan = K_t_pan_N_pan * i_pan - shaft_torque_pan
    forward_pan = F_s_pan * (a_F_s_pan + 1.0)
    backward_pan = F_s_pan * (1.0 - a_F_s_pan)
    holding_tilt = -accel_pan * mass_pan_tilt + forcing_tilt
    forward_tilt_term = 0.5 * load_torque_tilt * (lowered_tilt + raised_tilt - 2.0)
    abs_load_torque_tilt = abs(load_torque_tilt)
    forward_tilt = 0.5 * abs_load_torque_tilt * raised_tilt_minus_lowered_tilt - forward_tilt_term
    backward_tilt = 0.5 * abs_load_torque_tilt * raised_tilt_minus_lowered_tilt + forward_tilt_term
    upper_pan = (d_shaft_pan_omega_gear_pan_minus_omega_pan + k_shaft_pan * (-half_gap_pan
        - theta_pan_minus_theta_gear_pan))
    lower_pan = (d_shaft_pan_omega_gear_pan_minus_omega_pan + k_shaft_pan * (half_gap_pan
        - theta_pan_minus_theta_gear_pan))
    return (holding_pan, forward_pan, backward_pan, holding_tilt, forward_tilt, backward_tilt,
        -theta_pan_minus_theta_gear_pan, half_gap_pan, upper_pan, lower_pan)


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def guards(t, x, u, p, m, g):
    """Write holding and breakaway torques, gap separations and contact torques into g.

    t, x [8], u [2], p [44], m [4]; g [10] in N m and rad.
    g: holding_pan, forward_pan, backward_pan, holding_tilt, forward_tilt, backward_tilt,
      separation_pan, half_gap_pan, upper_pan, lower_pan.
    """
    slide_pan, slide_tilt, side_pan, active_pan = m[0], m[1], m[2], m[3]
    (g[0], g[1], g[2], g[3], g[4], g[5], g[6], g[7], g[8], g[9]) = guard_values(t, x, u, p,
        slide_pan, slide_tilt, side_pan, active_pan)


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def energy(t, x, u, p, m, e):
    """Write stored energy in J, power in and dissipated power in W into e.

    t, x [8], u [2], p [44], m [4]; e [3] in J, W and W.
    e: stored, power_in, dissipated.
    """
    slide_pan, slide_tilt, side_pan, active_pan = m[0], m[1], m[2], m[3]
    c = constants(p)
    forces = mass_and_forces(t, x, u, p, slide_pan, slide_tilt, side_pan, active_pan, c)
    cos_tilt, sin_tilt, omega_gear_pan_minus_omega_pan = forces[0], forces[1], forces[2]
    d_shaft_pan_omega_gear_pan_minus_omega_pan, shaft_torque_pan_factor = forces[3], forces[5]
    k_shaft_pan_shaft_torque_pan_factor, mass_pan, mass_pan_tilt = forces[6], forces[9], forces[10]
    ratio_tilt_sq, omega_tilt_sq, friction_torque_tilt = forces[12], forces[13], forces[17]
    mass_tilt, omega_gear_pan_sq, friction_torque_gear_pan = forces[20], forces[21], forces[22]
    omega_pan, omega_tilt, omega_gear_pan, i_pan, i_tilt = x[2], x[3], x[5], x[6], x[7]
    u_pan, u_tilt = u[0], u[1]
    b_pan, b_tilt, k_shaft_pan, L_pan, R_pan, L_tilt = p[11], p[12], p[22], p[24], p[25], p[29]
    R_tilt, b_motor_tilt = p[30], p[33]
    gravity_cos_tilt, gravity_sin_tilt, mass_gear_pan = c[13], c[14], c[15]
    side_pan_sq = side_pan * side_pan
    i_pan_sq = i_pan * i_pan
    i_tilt_sq = i_tilt * i_tilt
    omega_pan_sq = omega_pan * omega_pan
    e[0] = (0.5 * L_pan * i_pan_sq + 0.5 * L_tilt * i_tilt_sq + cos_tilt * gravity_sin_tilt
        - gravity_cos_tilt * sin_tilt
        + 0.5 * k_shaft_pan * (shaft_torque_pan_factor * shaft_torque_pan_factor) * side_pan_sq
        + 0.5 * mass_gear_pan * omega_gear_pan_sq + 0.5 * mass_pan * omega_pan_sq
        + mass_pan_tilt * omega_pan * omega_tilt + 0.5 * mass_tilt * omega_tilt_sq)  # stored
    e[1] = i_pan * u_pan + i_tilt * u_tilt  # power_in
    twist_rate_pan = omega_gear_pan_minus_omega_pan * side_pan_sq
    winding_loss_pan = R_pan * i_pan_sq
    winding_loss_tilt = R_tilt * i_tilt_sq
    e[2] = (b_motor_tilt * omega_tilt_sq * ratio_tilt_sq + b_pan * omega_pan_sq
        + b_tilt * omega_tilt_sq + friction_torque_gear_pan * omega_gear_pan
        + friction_torque_tilt * omega_tilt
        + twist_rate_pan * (active_pan * d_shaft_pan_omega_gear_pan_minus_omega_pan
        - k_shaft_pan_shaft_torque_pan_factor * (1.0 - active_pan)) + winding_loss_pan
        + winding_loss_tilt)  # dissipated


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def equation_error(t, x, u, p, m, r):
    """Write torques that rows lack, then other states' rates, into r; x ends in accelerations.

    t, x [11], u [2], p [44], m [4]; r [5] in N m, then STATE_UNITS per s.
    x: STATE_NAMES, then given_accel_pan, given_accel_tilt, given_accel_gear_pan.
    r: torque_pan, torque_tilt, torque_gear_pan, rate_of_i_pan, rate_of_i_tilt.
    """
    slide_pan, slide_tilt, side_pan, active_pan = m[0], m[1], m[2], m[3]
    c = constants(p)
    forces = mass_and_forces(t, x, u, p, slide_pan, slide_tilt, side_pan, active_pan, c)
    force_pan, mass_pan, mass_pan_tilt, force_tilt = forces[8], forces[9], forces[10], forces[19]
    mass_tilt, force_gear_pan, rate_of_i_pan = forces[20], forces[23], forces[24]
    rate_of_i_tilt = forces[25]
    given_accel_pan, given_accel_tilt, given_accel_gear_pan = x[8], x[9], x[10]
    mass_gear_pan = c[15]
    r[0] = -force_pan + given_accel_pan * mass_pan + given_accel_tilt * mass_pan_tilt  # torque_pan
    # torque_tilt
    r[1] = -force_tilt + given_accel_pan * mass_pan_tilt + given_accel_tilt * mass_tilt
    r[2] = -force_gear_pan + given_accel_gear_pan * mass_gear_pan  # torque_gear_pan
    r[3] = rate_of_i_pan
    r[4] = rate_of_i_tilt


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def mass_matrix(t, x, u, p, m, M):
    """Write the mass matrix of the joints, then of gear outputs, into M.

    t, x [8], u [2], p [44], m [4]; M [3, 3] in kg m^2.
    """
    slide_pan, slide_tilt, side_pan, active_pan = m[0], m[1], m[2], m[3]
    c = constants(p)
    forces = mass_and_forces(t, x, u, p, slide_pan, slide_tilt, side_pan, active_pan, c)
    mass_pan, mass_pan_tilt, mass_tilt = forces[9], forces[10], forces[20]
    mass_gear_pan = c[15]
    M[0, 0] = mass_pan
    M[0, 1] = mass_pan_tilt
    M[0, 2] = 0.0  # mass_pan_gear_pan
    M[1, 0] = mass_pan_tilt
    M[1, 1] = mass_tilt
    M[1, 2] = 0.0  # mass_tilt_gear_pan
    M[2, 0] = 0.0  # mass_pan_gear_pan
    M[2, 1] = 0.0  # mass_tilt_gear_pan
    M[2, 2] = mass_gear_pan


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def gravity_torque(t, x, u, p, m, G):
    """Write the torques that hold the machine against its weight into G.

    t, x [8], u [2], p [44], m [4]; G [3] in N m.
    G: gravity_torque_pan, gravity_torque_tilt, gravity_torque_gear_pan.
    """
    slide_pan, slide_tilt, side_pan, active_pan = m[0], m[1], m[2], m[3]
    c = constants(p)
    forces = mass_and_forces(t, x, u, p, slide_pan, slide_tilt, side_pan, active_pan, c)
    minus_gravity_torque_tilt = forces[15]
    G[0] = 0.0  # gravity_torque_pan
    G[1] = -minus_gravity_torque_tilt  # gravity_torque_tilt
    G[2] = 0.0  # gravity_torque_gear_pan


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def linearize(t, x, u, p, m, fx, fu, fp, gx, gp):
    """Write the non-zero derivatives of dx into fx, fu, fp and those of guards into gx, gp.

    t, x [8], u [2], p [44], m [4]; fx [8, 8]; fu [8, 2]; fp [8, 44]; gx [10, 8]; gp [10, 44].
    fx: rows and columns as STATE_NAMES; fu: rows as STATE_NAMES, columns as INPUT_NAMES; fp: rows
      as STATE_NAMES, columns as PARAMETERS; gx: rows as g of guards, columns as STATE_NAMES; gp:
      rows as g of guards, columns as PARAMETERS.
    Where fp or gx is empty, it and what follows it is not computed.
    """
    theta_pan, theta_tilt, omega_pan, omega_tilt, theta_gear_pan = x[0], x[1], x[2], x[3], x[4]
    omega_gear_pan, i_pan, i_tilt = x[5], x[6], x[7]
    u_pan, u_tilt = u[0], u[1]
    J_pan, J_x_tilt, J_y_tilt, J_z_tilt, m_payload, J_x_payload = p[0], p[1], p[2], p[3], p[4], p[5]
    J_y_payload, J_z_payload, c_x_payload, c_y_payload, c_z_payload = p[6], p[7], p[8], p[9], p[10]
    b_pan, b_tilt, F_c_pan, F_s_pan, v_s_pan, F_v_pan = p[11], p[12], p[13], p[14], p[15], p[16]
    a_F_c_pan, a_F_s_pan, a_v_s_pan, a_F_v_pan, gap_pan = p[17], p[18], p[19], p[20], p[21]
    k_shaft_pan, d_shaft_pan, L_pan, R_pan, K_t_pan = p[22], p[23], p[24], p[25], p[26]
    J_motor_pan, N_pan, L_tilt, R_tilt, K_t_tilt = p[27], p[28], p[29], p[30], p[31]
    J_motor_tilt, b_motor_tilt, N_tilt, lead_tilt, d_screw_tilt = p[32], p[33], p[34], p[35], p[36]
    f_screw_tilt, l_ground_tilt, l_min_tilt, r_arm_tilt = p[37], p[38], p[39], p[40]
    s_start_tilt, gravity = p[41], p[43]
    slide_pan, slide_tilt, side_pan, active_pan = m[0], m[1], m[2], m[3]
    c_x_payload_sq = c_x_payload * c_x_payload
    c_x_payload_sq_m_payload = c_x_payload_sq * m_payload
    c_y_payload_sq = c_y_payload * c_y_payload
    inertia_pan = (J_pan + J_z_payload + J_z_tilt + c_x_payload_sq_m_payload
        + c_y_payload_sq * m_payload)
    cos_tilt = math.cos(theta_tilt)
    gravity_sin_tilt_by_gravity = c_z_payload * m_payload
    inertia_tilt_by_c_z_payload = 2.0 * gravity_sin_tilt_by_gravity
    inertia_pan_sin_cos_tilt = c_x_payload * inertia_tilt_by_c_z_payload
    c_z_payload_sq = c_z_payload * c_z_payload
    c_z_payload_sq_m_payload = c_z_payload_sq * m_payload
    inertia_pan_sin_sq_tilt = (J_x_payload + J_x_tilt - J_z_payload - J_z_tilt
        - c_x_payload_sq_m_payload + c_z_payload_sq_m_payload)
    sin_tilt = math.sin(theta_tilt)
    inertia_pan_per_sin_tilt = (cos_tilt * inertia_pan_sin_cos_tilt
        + inertia_pan_sin_sq_tilt * sin_tilt)
    inertia_pan_per_sin_tilt_sin_tilt = inertia_pan_per_sin_tilt * sin_tilt
    mass_pan = inertia_pan + inertia_pan_per_sin_tilt_sin_tilt
    inertia_tilt = J_y_payload + J_y_tilt + c_x_payload_sq_m_payload + c_z_payload_sq_m_payload
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
    slide_tilt_sq = slide_tilt * slide_tilt
    coupling_sin_tilt_by_c_x_payload = c_y_payload * m_payload
    coupling_cos_tilt = c_z_payload * coupling_sin_tilt_by_c_x_payload
    coupling_sin_tilt = c_x_payload * coupling_sin_tilt_by_c_x_payload
    mass_pan_tilt = -cos_tilt * coupling_cos_tilt + coupling_sin_tilt * sin_tilt
    mass_pan_tilt_sq = mass_pan_tilt * mass_pan_tilt
    inverse_determinant = 1.0 / (mass_pan * mass_tilt - mass_pan_tilt_sq * slide_tilt_sq)
    holding_pan_by_theta_pan = active_pan * k_shaft_pan
    mass_pan_tilt_slide_tilt_sq = mass_pan_tilt * slide_tilt_sq
    mass_pan_inverse = 1.0 / mass_pan
    mass_pan_inverse_mass_pan_tilt = mass_pan_inverse * mass_pan_tilt
    load_torque_tilt_by_theta_gear_pan = -holding_pan_by_theta_pan * mass_pan_inverse_mass_pan_tilt
    carried_tilt_by_theta_gear_pan = (-J_motor_tilt_ratio_tilt_sq
        * load_torque_tilt_by_theta_gear_pan)
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
    load_inertia_tilt = inertia_tilt - mass_pan_inverse * mass_pan_tilt_sq
    lost_lowering_tilt_denominator = J_motor_tilt_ratio_tilt_sq + load_inertia_tilt * lowered_tilt
    abs_lost_lowering_tilt_denominator_inverse = 1.0 / abs(lost_lowering_tilt_denominator)
    lost_lowering_tilt = abs_lost_lowering_tilt_denominator_inverse * one_minus_lowered_tilt
    d_screw_tilt_pi_minus_f_screw_tilt_lead_tilt = d_screw_tilt_pi - f_screw_tilt_lead_tilt
    raised_tilt_factor = 1.0 / d_screw_tilt_pi_minus_f_screw_tilt_lead_tilt
    d_screw_tilt_pi_f_screw_tilt_plus_lead_tilt = d_screw_tilt_pi_f_screw_tilt + lead_tilt
    raised_tilt_factor_2 = d_screw_tilt_pi_f_screw_tilt_plus_lead_tilt * raised_tilt_factor
    raised_tilt = d_screw_tilt_pi_lead_tilt_inverse * raised_tilt_factor_2
    raised_tilt_minus_one = raised_tilt - 1.0
    lost_raising_tilt_denominator = J_motor_tilt_ratio_tilt_sq + load_inertia_tilt * raised_tilt
    lost_raising_tilt_denominator_inverse = 1.0 / lost_raising_tilt_denominator
    lost_raising_tilt = lost_raising_tilt_denominator_inverse * raised_tilt_minus_one
    lost_lowering_tilt_plus_lost_raising_tilt = lost_lowering_tilt + lost_raising_tilt
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
    omega_tilt_sq = omega_tilt * omega_tilt
    omega_tilt_sq_ratio_tilt_by_theta_tilt = omega_tilt_sq * ratio_tilt_by_theta_tilt
    driving_torque_tilt_factor = omega_tilt_sq_ratio_tilt_by_theta_tilt * ratio_tilt
    J_motor_tilt_driving_torque_tilt_factor = J_motor_tilt * driving_torque_tilt_factor
    omega_tilt_ratio_tilt = omega_tilt * ratio_tilt
    b_motor_tilt_omega_tilt_ratio_tilt = b_motor_tilt * omega_tilt_ratio_tilt
    driving_torque_tilt_factor_2 = K_t_tilt * i_tilt - b_motor_tilt_omega_tilt_ratio_tilt
    driving_torque_tilt = (-J_motor_tilt_driving_torque_tilt_factor
        + driving_torque_tilt_factor_2 * ratio_tilt)
    cos_tilt_inertia_pan_per_sin_tilt = cos_tilt * inertia_pan_per_sin_tilt
    coriolis_by_omega_pan = 2.0 * cos_tilt_inertia_pan_per_sin_tilt - inertia_pan_sin_cos_tilt
    coriolis = coriolis_by_omega_pan * omega_pan
    upper_pan_by_d_shaft_pan = omega_gear_pan - omega_pan
    half_gap_pan = 0.5 * gap_pan
    theta_pan_minus_theta_gear_pan = -theta_gear_pan + theta_pan
    shaft_torque_pan_factor = -half_gap_pan * side_pan - theta_pan_minus_theta_gear_pan
    shaft_torque_pan = (active_pan * (d_shaft_pan * upper_pan_by_d_shaft_pan
        + k_shaft_pan * shaft_torque_pan_factor))
    follower_coupling_tilt_by_theta_tilt = (cos_tilt * coupling_sin_tilt
        + coupling_cos_tilt * sin_tilt)
    force_pan_term = follower_coupling_tilt_by_theta_tilt * omega_tilt
    force_pan = -b_pan * omega_pan - omega_tilt * (coriolis + force_pan_term) + shaft_torque_pan
    gravity_cos_tilt_by_c_x_payload = gravity * m_payload
    gravity_cos_tilt = c_x_payload * gravity_cos_tilt_by_c_x_payload
    gravity_sin_tilt = c_z_payload * gravity_cos_tilt_by_c_x_payload
    force_tilt_by_coriolis = 0.5 * omega_pan
    load_torque_tilt_term = (-b_tilt * omega_tilt + coriolis * force_tilt_by_coriolis
        + cos_tilt * gravity_cos_tilt + gravity_sin_tilt * sin_tilt)
    load_torque_tilt = -force_pan * mass_pan_inverse_mass_pan_tilt + load_torque_tilt_term
    carried_tilt = (-J_motor_tilt_ratio_tilt_sq * load_torque_tilt
        + driving_torque_tilt * load_inertia_tilt)
    carried_tilt_slide_tilt = carried_tilt * slide_tilt
    accel_pan_by_theta_gear_pan_factor = -0.5 * lost_lowering_tilt + 0.5 * lost_raising_tilt
    force_tilt_by_carried_tilt = (-slide_tilt * (accel_pan_by_theta_gear_pan_factor * slide_tilt
        + 0.5 * lost_lowering_tilt_plus_lost_raising_tilt * slide_tilt * (0.0
        if carried_tilt_slide_tilt == 0.0 else math.copysign(1.0, carried_tilt_slide_tilt))))
    balance_tilt_by_theta_gear_pan = carried_tilt_by_theta_gear_pan * force_tilt_by_carried_tilt
    accel_pan_by_theta_gear_pan = (inverse_determinant * (-balance_tilt_by_theta_gear_pan
        * mass_pan_tilt_slide_tilt_sq + holding_pan_by_theta_pan * mass_tilt))
    fx[2, 0] = -accel_pan_by_theta_gear_pan  # accel_pan_by_theta_pan
    inverse_determinant_slide_tilt_sq = inverse_determinant * slide_tilt_sq
    accel_tilt_by_theta_gear_pan = (inverse_determinant_slide_tilt_sq
        * (balance_tilt_by_theta_gear_pan * mass_pan - holding_pan_by_theta_pan
        * mass_pan_tilt_slide_tilt_sq))
    fx[3, 0] = -accel_tilt_by_theta_gear_pan  # accel_tilt_by_theta_pan
    N_pan_sq = N_pan * N_pan
    mass_gear_pan = J_motor_pan * N_pan_sq
    inverse_mass_gear_pan = 1.0 / mass_gear_pan
    slide_pan_sq = slide_pan * slide_pan
    inverse_mass_gear_pan_slide_pan_sq = inverse_mass_gear_pan * slide_pan_sq
    accel_gear_pan_by_theta_gear_pan = (-holding_pan_by_theta_pan
        * inverse_mass_gear_pan_slide_pan_sq)
    fx[5, 0] = -accel_gear_pan_by_theta_gear_pan  # accel_gear_pan_by_theta_pan
    abs_carried_tilt_slide_tilt = abs(carried_tilt_slide_tilt)
    half_abs_carried_tilt_slide_tilt = 0.5 * abs_carried_tilt_slide_tilt
    transmitted_torque_tilt = driving_torque_tilt_factor_2 * ratio_tilt
    force_tilt = (-J_motor_tilt_driving_torque_tilt_factor + load_torque_tilt_term
        - slide_tilt * (accel_pan_by_theta_gear_pan_factor * carried_tilt_slide_tilt
        + half_abs_carried_tilt_slide_tilt * lost_lowering_tilt_plus_lost_raising_tilt)
        + transmitted_torque_tilt)
    accel_pan = (inverse_determinant * (force_pan * mass_tilt
        - force_tilt * mass_pan_tilt_slide_tilt_sq))
    accel_tilt = (inverse_determinant_slide_tilt_sq * (-force_pan * mass_pan_tilt_slide_tilt_sq
        + force_tilt * mass_pan))
    inertia_pan_per_sin_tilt_by_theta_tilt = (cos_tilt * inertia_pan_sin_sq_tilt
        - inertia_pan_sin_cos_tilt * sin_tilt)
    twice_omega_pan = 2.0 * omega_pan
    coriolis_by_inertia_pan_per_sin_tilt = cos_tilt * twice_omega_pan
    coriolis_by_theta_tilt = (coriolis_by_inertia_pan_per_sin_tilt
        * inertia_pan_per_sin_tilt_by_theta_tilt - inertia_pan_per_sin_tilt_sin_tilt
        * twice_omega_pan)
    accel_pan_by_theta_tilt_term = (coriolis_by_theta_tilt * omega_tilt
        - mass_pan_tilt * omega_tilt_sq)
    balance_pan_by_theta_tilt = (-accel_pan * (cos_tilt_inertia_pan_per_sin_tilt
        + inertia_pan_per_sin_tilt_by_theta_tilt * sin_tilt) - accel_pan_by_theta_tilt_term
        - accel_tilt * follower_coupling_tilt_by_theta_tilt)
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
    force_tilt_by_ratio_tilt = (-J_motor_tilt * omega_tilt_sq_ratio_tilt_by_theta_tilt
        + K_t_tilt * i_tilt - 2.0 * b_motor_tilt_omega_tilt_ratio_tilt)
    J_motor_tilt_ratio_tilt = J_motor_tilt * ratio_tilt
    J_motor_tilt_ratio_tilt_omega_tilt_sq = J_motor_tilt_ratio_tilt * omega_tilt_sq
    driving_torque_tilt_by_theta_tilt = (-J_motor_tilt_ratio_tilt_omega_tilt_sq
        * ratio_tilt_by_theta_tilt_by_theta_tilt + force_tilt_by_ratio_tilt
        * ratio_tilt_by_theta_tilt)
    follower_inertia_tilt_by_theta_tilt = (cos_tilt_inertia_pan_per_sin_tilt
        + inertia_pan_per_sin_tilt_by_theta_tilt * sin_tilt)
    load_inertia_tilt_by_follower_coupling_tilt = -2.0 * mass_pan_inverse_mass_pan_tilt
    mass_pan_inverse_sq = 1.0 / (mass_pan * mass_pan)
    load_inertia_tilt_by_follower_inertia_tilt = mass_pan_inverse_sq * mass_pan_tilt_sq
    load_inertia_tilt_by_theta_tilt = (follower_coupling_tilt_by_theta_tilt
        * load_inertia_tilt_by_follower_coupling_tilt + follower_inertia_tilt_by_theta_tilt
        * load_inertia_tilt_by_follower_inertia_tilt)
    gravity_cos_tilt_sin_tilt = gravity_cos_tilt * sin_tilt
    load_torque_tilt_by_theta_tilt_term = (coriolis_by_theta_tilt * force_tilt_by_coriolis
        + cos_tilt * gravity_sin_tilt - gravity_cos_tilt_sin_tilt)
    load_torque_tilt_by_follower_coupling_tilt = -force_pan * mass_pan_inverse
    load_torque_tilt_by_follower_inertia_tilt = force_pan * mass_pan_inverse_sq * mass_pan_tilt
    load_torque_tilt_by_theta_tilt = (accel_pan_by_theta_tilt_term * mass_pan_inverse_mass_pan_tilt
        + follower_coupling_tilt_by_theta_tilt * load_torque_tilt_by_follower_coupling_tilt
        + follower_inertia_tilt_by_theta_tilt * load_torque_tilt_by_follower_inertia_tilt
        + load_torque_tilt_by_theta_tilt_term)
    twice_J_motor_tilt_ratio_tilt = 2.0 * J_motor_tilt_ratio_tilt
    carried_tilt_by_ratio_tilt = -load_torque_tilt * twice_J_motor_tilt_ratio_tilt
    carried_tilt_by_theta_tilt = (-J_motor_tilt_ratio_tilt_sq * load_torque_tilt_by_theta_tilt
        + carried_tilt_by_ratio_tilt * ratio_tilt_by_theta_tilt
        + driving_torque_tilt * load_inertia_tilt_by_theta_tilt
        + driving_torque_tilt_by_theta_tilt * load_inertia_tilt)
    lost_lowering_tilt_by_theta_tilt_factor = (one_minus_lowered_tilt * (0.0
        if lost_lowering_tilt_denominator == 0.0
        else math.copysign(1.0, lost_lowering_tilt_denominator)) / (lost_lowering_tilt_denominator
        * lost_lowering_tilt_denominator))
    lost_lowering_tilt_by_load_inertia_tilt = (-lost_lowering_tilt_by_theta_tilt_factor
        * lowered_tilt)
    lost_lowering_tilt_by_ratio_tilt = (-lost_lowering_tilt_by_theta_tilt_factor
        * twice_J_motor_tilt_ratio_tilt)
    lost_lowering_tilt_by_theta_tilt = (load_inertia_tilt_by_theta_tilt
        * lost_lowering_tilt_by_load_inertia_tilt + lost_lowering_tilt_by_ratio_tilt
        * ratio_tilt_by_theta_tilt)
    lost_raising_tilt_by_theta_tilt_factor = (raised_tilt_minus_one / (lost_raising_tilt_denominator
        * lost_raising_tilt_denominator))
    lost_raising_tilt_by_load_inertia_tilt = -lost_raising_tilt_by_theta_tilt_factor * raised_tilt
    lost_raising_tilt_by_ratio_tilt = (-lost_raising_tilt_by_theta_tilt_factor
        * twice_J_motor_tilt_ratio_tilt)
    lost_raising_tilt_by_theta_tilt = (load_inertia_tilt_by_theta_tilt
        * lost_raising_tilt_by_load_inertia_tilt + lost_raising_tilt_by_ratio_tilt
        * ratio_tilt_by_theta_tilt)
    accel_tilt_twice_J_motor_tilt_ratio_tilt = accel_tilt * twice_J_motor_tilt_ratio_tilt
    accel_pan_by_theta_tilt_term_2 = accel_pan * follower_coupling_tilt_by_theta_tilt
    half_carried_tilt_slide_tilt = 0.5 * carried_tilt_slide_tilt
    force_tilt_by_lost_lowering_tilt = (-slide_tilt * (0.5 * abs_carried_tilt_slide_tilt
        - half_carried_tilt_slide_tilt))
    force_tilt_by_lost_raising_tilt = (-slide_tilt * (half_abs_carried_tilt_slide_tilt
        + half_carried_tilt_slide_tilt))
    balance_tilt_by_theta_tilt = (-accel_pan_by_theta_tilt_term_2
        - accel_tilt_twice_J_motor_tilt_ratio_tilt * ratio_tilt_by_theta_tilt
        + carried_tilt_by_theta_tilt * force_tilt_by_carried_tilt
        + driving_torque_tilt_by_theta_tilt
        + force_tilt_by_lost_lowering_tilt * lost_lowering_tilt_by_theta_tilt
        + force_tilt_by_lost_raising_tilt * lost_raising_tilt_by_theta_tilt
        + load_torque_tilt_by_theta_tilt_term)
    accel_pan_by_theta_tilt = (inverse_determinant * (balance_pan_by_theta_tilt * mass_tilt
        - balance_tilt_by_theta_tilt * mass_pan_tilt_slide_tilt_sq))
    fx[2, 1] = accel_pan_by_theta_tilt
    # accel_tilt_by_theta_tilt
    fx[3, 1] = (inverse_determinant_slide_tilt_sq * (-balance_pan_by_theta_tilt
        * mass_pan_tilt_slide_tilt_sq + balance_tilt_by_theta_tilt * mass_pan))
    rate_of_i_tilt_by_u_tilt = 1.0 / L_tilt
    K_t_tilt_omega_tilt_rate_of_i_tilt_by_u_tilt = K_t_tilt * omega_tilt * rate_of_i_tilt_by_u_tilt
    # rate_of_i_tilt_by_theta_tilt
    fx[7, 1] = -K_t_tilt_omega_tilt_rate_of_i_tilt_by_u_tilt * ratio_tilt_by_theta_tilt
    fx[0, 2] = 1.0  # rate_of_theta_pan_by_omega_pan
    follower_torque_tilt_by_omega_gear_pan = active_pan * d_shaft_pan
    follower_torque_tilt_by_omega_pan = (-b_pan - coriolis_by_omega_pan * omega_tilt
        - follower_torque_tilt_by_omega_gear_pan)
    half_coriolis = 0.5 * coriolis
    load_torque_tilt_by_omega_pan_term = (coriolis_by_omega_pan * force_tilt_by_coriolis
        + half_coriolis)
    load_torque_tilt_by_omega_pan = (-follower_torque_tilt_by_omega_pan
        * mass_pan_inverse_mass_pan_tilt + load_torque_tilt_by_omega_pan_term)
    carried_tilt_by_omega_pan = -J_motor_tilt_ratio_tilt_sq * load_torque_tilt_by_omega_pan
    balance_tilt_by_omega_pan = (carried_tilt_by_omega_pan * force_tilt_by_carried_tilt
        + load_torque_tilt_by_omega_pan_term)
    accel_pan_by_omega_pan = (inverse_determinant * (-balance_tilt_by_omega_pan
        * mass_pan_tilt_slide_tilt_sq + follower_torque_tilt_by_omega_pan * mass_tilt))
    fx[2, 2] = accel_pan_by_omega_pan
    # accel_tilt_by_omega_pan
    fx[3, 2] = (inverse_determinant_slide_tilt_sq * (balance_tilt_by_omega_pan * mass_pan
        - follower_torque_tilt_by_omega_pan * mass_pan_tilt_slide_tilt_sq))
    # accel_gear_pan_by_omega_pan
    fx[5, 2] = follower_torque_tilt_by_omega_gear_pan * inverse_mass_gear_pan_slide_pan_sq
    fx[1, 3] = 1.0  # rate_of_theta_tilt_by_omega_tilt
    follower_torque_tilt_by_omega_tilt = -coriolis - 2.0 * force_pan_term
    carried_tilt_by_omega_tilt_factor = (2.0 * J_motor_tilt * omega_tilt_ratio_tilt
        * ratio_tilt_by_theta_tilt + b_motor_tilt * ratio_tilt_sq)
    load_torque_tilt_by_omega_tilt = (-b_tilt
        - follower_torque_tilt_by_omega_tilt * mass_pan_inverse_mass_pan_tilt)
    carried_tilt_by_omega_tilt = (-J_motor_tilt_ratio_tilt_sq * load_torque_tilt_by_omega_tilt
        - carried_tilt_by_omega_tilt_factor * load_inertia_tilt)
    b_tilt_plus_carried_tilt_by_omega_tilt_factor = b_tilt + carried_tilt_by_omega_tilt_factor
    balance_tilt_by_omega_tilt = (-b_tilt_plus_carried_tilt_by_omega_tilt_factor
        + carried_tilt_by_omega_tilt * force_tilt_by_carried_tilt)
    accel_pan_by_omega_tilt = (inverse_determinant * (-balance_tilt_by_omega_tilt
        * mass_pan_tilt_slide_tilt_sq + follower_torque_tilt_by_omega_tilt * mass_tilt))
    fx[2, 3] = accel_pan_by_omega_tilt
    # accel_tilt_by_omega_tilt
    fx[3, 3] = (inverse_determinant_slide_tilt_sq * (balance_tilt_by_omega_tilt * mass_pan
        - follower_torque_tilt_by_omega_tilt * mass_pan_tilt_slide_tilt_sq))
    driving_torque_tilt_by_i_tilt = K_t_tilt * ratio_tilt
    # rate_of_i_tilt_by_omega_tilt
    fx[7, 3] = -driving_torque_tilt_by_i_tilt * rate_of_i_tilt_by_u_tilt
    fx[2, 4] = accel_pan_by_theta_gear_pan
    fx[3, 4] = accel_tilt_by_theta_gear_pan
    fx[5, 4] = accel_gear_pan_by_theta_gear_pan
    load_torque_tilt_by_omega_gear_pan = (-follower_torque_tilt_by_omega_gear_pan
        * mass_pan_inverse_mass_pan_tilt)
    carried_tilt_by_omega_gear_pan = (-J_motor_tilt_ratio_tilt_sq
        * load_torque_tilt_by_omega_gear_pan)
    balance_tilt_by_omega_gear_pan = carried_tilt_by_omega_gear_pan * force_tilt_by_carried_tilt
    accel_pan_by_omega_gear_pan = (inverse_determinant * (-balance_tilt_by_omega_gear_pan
        * mass_pan_tilt_slide_tilt_sq + follower_torque_tilt_by_omega_gear_pan * mass_tilt))
    fx[2, 5] = accel_pan_by_omega_gear_pan
    # accel_tilt_by_omega_gear_pan
    fx[3, 5] = (inverse_determinant_slide_tilt_sq * (balance_tilt_by_omega_gear_pan * mass_pan
        - follower_torque_tilt_by_omega_gear_pan * mass_pan_tilt_slide_tilt_sq))
    fx[4, 5] = 1.0  # rate_of_theta_gear_pan_by_omega_gear_pan
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
    fx[5, 5] = (inverse_mass_gear_pan_slide_pan_sq * (-follower_torque_tilt_by_omega_gear_pan
        - slide_pan * (-omega_gear_pan * stribeck_square_pan_factor
        * twice_accel_gear_pan_by_omega_gear_pan_factor + slide_pan * viscous_coefficient_pan)))
    rate_of_i_pan_by_u_pan = 1.0 / L_pan
    balance_gear_pan_by_i_pan = K_t_pan * N_pan
    # rate_of_i_pan_by_omega_gear_pan
    fx[6, 5] = -balance_gear_pan_by_i_pan * rate_of_i_pan_by_u_pan
    # accel_gear_pan_by_i_pan
    fx[5, 6] = balance_gear_pan_by_i_pan * inverse_mass_gear_pan_slide_pan_sq
    fx[6, 6] = -R_pan * rate_of_i_pan_by_u_pan  # rate_of_i_pan_by_i_pan
    accel_pan_by_i_tilt_factor = inverse_determinant * mass_pan_tilt_slide_tilt_sq
    carried_tilt_by_i_tilt = driving_torque_tilt_by_i_tilt * load_inertia_tilt
    balance_tilt_by_i_tilt = (carried_tilt_by_i_tilt * force_tilt_by_carried_tilt
        + driving_torque_tilt_by_i_tilt)
    accel_pan_by_i_tilt = -accel_pan_by_i_tilt_factor * balance_tilt_by_i_tilt
    fx[2, 7] = accel_pan_by_i_tilt
    inverse_determinant_slide_tilt_sq_mass_pan = inverse_determinant_slide_tilt_sq * mass_pan
    # accel_tilt_by_i_tilt
    fx[3, 7] = balance_tilt_by_i_tilt * inverse_determinant_slide_tilt_sq_mass_pan
    fx[7, 7] = -R_tilt * rate_of_i_tilt_by_u_tilt  # rate_of_i_tilt_by_i_tilt
    fu[6, 0] = rate_of_i_pan_by_u_pan
    fu[7, 1] = rate_of_i_tilt_by_u_tilt
    if len(fp) == 0:
        return
    carried_tilt_by_inertia_pan = (-J_motor_tilt_ratio_tilt_sq
        * load_torque_tilt_by_follower_inertia_tilt + driving_torque_tilt
        * load_inertia_tilt_by_follower_inertia_tilt)
    lost_lowering_tilt_by_inertia_pan = (load_inertia_tilt_by_follower_inertia_tilt
        * lost_lowering_tilt_by_load_inertia_tilt)
    lost_raising_tilt_by_inertia_pan = (load_inertia_tilt_by_follower_inertia_tilt
        * lost_raising_tilt_by_load_inertia_tilt)
    balance_tilt_by_inertia_pan = (carried_tilt_by_inertia_pan * force_tilt_by_carried_tilt
        + force_tilt_by_lost_lowering_tilt * lost_lowering_tilt_by_inertia_pan
        + force_tilt_by_lost_raising_tilt * lost_raising_tilt_by_inertia_pan)
    accel_pan_by_inertia_pan = (inverse_determinant * (-accel_pan * mass_tilt
        - balance_tilt_by_inertia_pan * mass_pan_tilt_slide_tilt_sq))
    fp[2, 0] = accel_pan_by_inertia_pan  # accel_pan_by_J_pan
    accel_tilt_by_inertia_pan = (inverse_determinant_slide_tilt_sq * (accel_pan
        * mass_pan_tilt_slide_tilt_sq + balance_tilt_by_inertia_pan * mass_pan))
    fp[3, 0] = accel_tilt_by_inertia_pan  # accel_tilt_by_J_pan
    coriolis_by_inertia_pan_sin_sq_tilt = coriolis_by_inertia_pan_per_sin_tilt * sin_tilt
    accel_pan_by_inertia_pan_sin_sq_tilt_term = coriolis_by_inertia_pan_sin_sq_tilt * omega_tilt
    accel_pan_sin_tilt = accel_pan * sin_tilt
    balance_pan_by_inertia_pan_sin_sq_tilt = (-accel_pan_by_inertia_pan_sin_sq_tilt_term
        - accel_pan_sin_tilt * sin_tilt)
    follower_inertia_tilt_by_inertia_pan_sin_sq_tilt = sin_tilt * sin_tilt
    load_inertia_tilt_by_inertia_pan_sin_sq_tilt = (follower_inertia_tilt_by_inertia_pan_sin_sq_tilt
        * load_inertia_tilt_by_follower_inertia_tilt)
    load_torque_tilt_by_inertia_pan_sin_sq_tilt_term = (coriolis_by_inertia_pan_sin_sq_tilt
        * force_tilt_by_coriolis)
    load_torque_tilt_by_inertia_pan_sin_sq_tilt = (accel_pan_by_inertia_pan_sin_sq_tilt_term
        * mass_pan_inverse_mass_pan_tilt + follower_inertia_tilt_by_inertia_pan_sin_sq_tilt
        * load_torque_tilt_by_follower_inertia_tilt
        + load_torque_tilt_by_inertia_pan_sin_sq_tilt_term)
    carried_tilt_by_inertia_pan_sin_sq_tilt = (-J_motor_tilt_ratio_tilt_sq
        * load_torque_tilt_by_inertia_pan_sin_sq_tilt + driving_torque_tilt
        * load_inertia_tilt_by_inertia_pan_sin_sq_tilt)
    lost_lowering_tilt_by_inertia_pan_sin_sq_tilt = (load_inertia_tilt_by_inertia_pan_sin_sq_tilt
        * lost_lowering_tilt_by_load_inertia_tilt)
    lost_raising_tilt_by_inertia_pan_sin_sq_tilt = (load_inertia_tilt_by_inertia_pan_sin_sq_tilt
        * lost_raising_tilt_by_load_inertia_tilt)
    balance_tilt_by_inertia_pan_sin_sq_tilt = (carried_tilt_by_inertia_pan_sin_sq_tilt
        * force_tilt_by_carried_tilt + force_tilt_by_lost_lowering_tilt
        * lost_lowering_tilt_by_inertia_pan_sin_sq_tilt + force_tilt_by_lost_raising_tilt
        * lost_raising_tilt_by_inertia_pan_sin_sq_tilt
        + load_torque_tilt_by_inertia_pan_sin_sq_tilt_term)
    accel_pan_by_inertia_pan_sin_sq_tilt = (inverse_determinant
        * (balance_pan_by_inertia_pan_sin_sq_tilt * mass_tilt
        - balance_tilt_by_inertia_pan_sin_sq_tilt * mass_pan_tilt_slide_tilt_sq))
    fp[2, 1] = accel_pan_by_inertia_pan_sin_sq_tilt  # accel_pan_by_J_x_tilt
    accel_tilt_by_inertia_pan_sin_sq_tilt = (inverse_determinant_slide_tilt_sq
        * (-balance_pan_by_inertia_pan_sin_sq_tilt * mass_pan_tilt_slide_tilt_sq
        + balance_tilt_by_inertia_pan_sin_sq_tilt * mass_pan))
    fp[3, 1] = accel_tilt_by_inertia_pan_sin_sq_tilt  # accel_tilt_by_J_x_tilt
    balance_tilt_by_inertia_tilt = (-accel_tilt + driving_torque_tilt * force_tilt_by_carried_tilt
        + force_tilt_by_lost_lowering_tilt * lost_lowering_tilt_by_load_inertia_tilt
        + force_tilt_by_lost_raising_tilt * lost_raising_tilt_by_load_inertia_tilt)
    accel_pan_by_inertia_tilt = -accel_pan_by_i_tilt_factor * balance_tilt_by_inertia_tilt
    fp[2, 2] = accel_pan_by_inertia_tilt  # accel_pan_by_J_y_tilt
    accel_tilt_by_inertia_tilt = (balance_tilt_by_inertia_tilt
        * inverse_determinant_slide_tilt_sq_mass_pan)
    fp[3, 2] = accel_tilt_by_inertia_tilt  # accel_tilt_by_J_y_tilt
    accel_pan_by_J_z_tilt = accel_pan_by_inertia_pan - accel_pan_by_inertia_pan_sin_sq_tilt
    fp[2, 3] = accel_pan_by_J_z_tilt
    accel_tilt_by_J_z_tilt = accel_tilt_by_inertia_pan - accel_tilt_by_inertia_pan_sin_sq_tilt
    fp[3, 3] = accel_tilt_by_J_z_tilt
    follower_torque_tilt_by_coupling_cos_tilt = -omega_tilt_sq * sin_tilt
    balance_pan_by_coupling_cos_tilt = (accel_tilt * cos_tilt
        + follower_torque_tilt_by_coupling_cos_tilt)
    load_inertia_tilt_by_coupling_cos_tilt = -cos_tilt * load_inertia_tilt_by_follower_coupling_tilt
    load_torque_tilt_by_coupling_cos_tilt = (-cos_tilt * load_torque_tilt_by_follower_coupling_tilt
        - follower_torque_tilt_by_coupling_cos_tilt * mass_pan_inverse_mass_pan_tilt)
    carried_tilt_by_coupling_cos_tilt = (-J_motor_tilt_ratio_tilt_sq
        * load_torque_tilt_by_coupling_cos_tilt + driving_torque_tilt
        * load_inertia_tilt_by_coupling_cos_tilt)
    lost_lowering_tilt_by_coupling_cos_tilt = (load_inertia_tilt_by_coupling_cos_tilt
        * lost_lowering_tilt_by_load_inertia_tilt)
    lost_raising_tilt_by_coupling_cos_tilt = (load_inertia_tilt_by_coupling_cos_tilt
        * lost_raising_tilt_by_load_inertia_tilt)
    accel_pan_cos_tilt = accel_pan * cos_tilt
    balance_tilt_by_coupling_cos_tilt = (accel_pan_cos_tilt
        + carried_tilt_by_coupling_cos_tilt * force_tilt_by_carried_tilt
        + force_tilt_by_lost_lowering_tilt * lost_lowering_tilt_by_coupling_cos_tilt
        + force_tilt_by_lost_raising_tilt * lost_raising_tilt_by_coupling_cos_tilt)
    accel_pan_by_coupling_cos_tilt = (inverse_determinant * (balance_pan_by_coupling_cos_tilt
        * mass_tilt - balance_tilt_by_coupling_cos_tilt * mass_pan_tilt_slide_tilt_sq))
    cos_tilt_omega_tilt_sq = cos_tilt * omega_tilt_sq
    balance_pan_by_coupling_sin_tilt = -accel_tilt * sin_tilt - cos_tilt_omega_tilt_sq
    load_inertia_tilt_by_coupling_sin_tilt = load_inertia_tilt_by_follower_coupling_tilt * sin_tilt
    load_torque_tilt_by_coupling_sin_tilt = (cos_tilt_omega_tilt_sq * mass_pan_inverse_mass_pan_tilt
        + load_torque_tilt_by_follower_coupling_tilt * sin_tilt)
    carried_tilt_by_coupling_sin_tilt = (-J_motor_tilt_ratio_tilt_sq
        * load_torque_tilt_by_coupling_sin_tilt + driving_torque_tilt
        * load_inertia_tilt_by_coupling_sin_tilt)
    lost_lowering_tilt_by_coupling_sin_tilt = (load_inertia_tilt_by_coupling_sin_tilt
        * lost_lowering_tilt_by_load_inertia_tilt)
    lost_raising_tilt_by_coupling_sin_tilt = (load_inertia_tilt_by_coupling_sin_tilt
        * lost_raising_tilt_by_load_inertia_tilt)
    balance_tilt_by_coupling_sin_tilt = (-accel_pan_sin_tilt
        + carried_tilt_by_coupling_sin_tilt * force_tilt_by_carried_tilt
        + force_tilt_by_lost_lowering_tilt * lost_lowering_tilt_by_coupling_sin_tilt
        + force_tilt_by_lost_raising_tilt * lost_raising_tilt_by_coupling_sin_tilt)
    accel_pan_by_coupling_sin_tilt = (inverse_determinant * (balance_pan_by_coupling_sin_tilt
        * mass_tilt - balance_tilt_by_coupling_sin_tilt * mass_pan_tilt_slide_tilt_sq))
    carried_tilt_by_gravity_cos_tilt = -J_motor_tilt_ratio_tilt_sq * cos_tilt
    balance_tilt_by_gravity_cos_tilt = (carried_tilt_by_gravity_cos_tilt
        * force_tilt_by_carried_tilt + cos_tilt)
    accel_pan_by_gravity_cos_tilt = -accel_pan_by_i_tilt_factor * balance_tilt_by_gravity_cos_tilt
    carried_tilt_by_gravity_sin_tilt = -J_motor_tilt_ratio_tilt_sq * sin_tilt
    balance_tilt_by_gravity_sin_tilt = (carried_tilt_by_gravity_sin_tilt
        * force_tilt_by_carried_tilt + sin_tilt)
    accel_pan_by_gravity_sin_tilt = -accel_pan_by_i_tilt_factor * balance_tilt_by_gravity_sin_tilt
    coriolis_by_inertia_pan_sin_cos_tilt = (coriolis_by_inertia_pan_per_sin_tilt * cos_tilt
        - omega_pan)
    accel_pan_by_inertia_pan_sin_cos_tilt_term = coriolis_by_inertia_pan_sin_cos_tilt * omega_tilt
    balance_pan_by_inertia_pan_sin_cos_tilt = (-accel_pan_by_inertia_pan_sin_cos_tilt_term
        - accel_pan_sin_tilt * cos_tilt)
    follower_inertia_tilt_by_inertia_pan_sin_cos_tilt = cos_tilt * sin_tilt
    load_inertia_tilt_by_inertia_pan_sin_cos_tilt = (
        follower_inertia_tilt_by_inertia_pan_sin_cos_tilt
        * load_inertia_tilt_by_follower_inertia_tilt)
    load_torque_tilt_by_inertia_pan_sin_cos_tilt_term = (coriolis_by_inertia_pan_sin_cos_tilt
        * force_tilt_by_coriolis)
    load_torque_tilt_by_inertia_pan_sin_cos_tilt = (accel_pan_by_inertia_pan_sin_cos_tilt_term
        * mass_pan_inverse_mass_pan_tilt + follower_inertia_tilt_by_inertia_pan_sin_cos_tilt
        * load_torque_tilt_by_follower_inertia_tilt
        + load_torque_tilt_by_inertia_pan_sin_cos_tilt_term)
    carried_tilt_by_inertia_pan_sin_cos_tilt = (-J_motor_tilt_ratio_tilt_sq
        * load_torque_tilt_by_inertia_pan_sin_cos_tilt + driving_torque_tilt
        * load_inertia_tilt_by_inertia_pan_sin_cos_tilt)
    lost_lowering_tilt_by_inertia_pan_sin_cos_tilt = (load_inertia_tilt_by_inertia_pan_sin_cos_tilt
        * lost_lowering_tilt_by_load_inertia_tilt)
    lost_raising_tilt_by_inertia_pan_sin_cos_tilt = (load_inertia_tilt_by_inertia_pan_sin_cos_tilt
        * lost_raising_tilt_by_load_inertia_tilt)
    balance_tilt_by_inertia_pan_sin_cos_tilt = (carried_tilt_by_inertia_pan_sin_cos_tilt
        * force_tilt_by_carried_tilt + force_tilt_by_lost_lowering_tilt
        * lost_lowering_tilt_by_inertia_pan_sin_cos_tilt + force_tilt_by_lost_raising_tilt
        * lost_raising_tilt_by_inertia_pan_sin_cos_tilt
        + load_torque_tilt_by_inertia_pan_sin_cos_tilt_term)
    accel_pan_by_inertia_pan_sin_cos_tilt = (inverse_determinant
        * (balance_pan_by_inertia_pan_sin_cos_tilt * mass_tilt
        - balance_tilt_by_inertia_pan_sin_cos_tilt * mass_pan_tilt_slide_tilt_sq))
    coupling_cos_tilt_by_m_payload = c_y_payload * c_z_payload
    coupling_sin_tilt_by_m_payload = c_x_payload * c_y_payload
    gravity_cos_tilt_by_m_payload = c_x_payload * gravity
    gravity_sin_tilt_by_m_payload = c_z_payload * gravity
    inertia_pan_by_m_payload = c_x_payload_sq + c_y_payload_sq
    inertia_pan_sin_cos_tilt_by_m_payload = 2.0 * c_x_payload * c_z_payload
    inertia_pan_sin_sq_tilt_by_m_payload = -c_x_payload_sq + c_z_payload_sq
    inertia_tilt_by_m_payload = c_x_payload_sq + c_z_payload_sq
    accel_pan_by_m_payload = (accel_pan_by_coupling_cos_tilt * coupling_cos_tilt_by_m_payload
        + accel_pan_by_coupling_sin_tilt * coupling_sin_tilt_by_m_payload
        + accel_pan_by_gravity_cos_tilt * gravity_cos_tilt_by_m_payload
        + accel_pan_by_gravity_sin_tilt * gravity_sin_tilt_by_m_payload
        + accel_pan_by_inertia_pan * inertia_pan_by_m_payload
        + accel_pan_by_inertia_pan_sin_cos_tilt * inertia_pan_sin_cos_tilt_by_m_payload
        + accel_pan_by_inertia_pan_sin_sq_tilt * inertia_pan_sin_sq_tilt_by_m_payload
        + accel_pan_by_inertia_tilt * inertia_tilt_by_m_payload)
    fp[2, 4] = accel_pan_by_m_payload
    accel_tilt_by_coupling_cos_tilt = (inverse_determinant_slide_tilt_sq
        * (-balance_pan_by_coupling_cos_tilt * mass_pan_tilt_slide_tilt_sq
        + balance_tilt_by_coupling_cos_tilt * mass_pan))
    accel_tilt_by_coupling_sin_tilt = (inverse_determinant_slide_tilt_sq
        * (-balance_pan_by_coupling_sin_tilt * mass_pan_tilt_slide_tilt_sq
        + balance_tilt_by_coupling_sin_tilt * mass_pan))
    accel_tilt_by_gravity_cos_tilt = (balance_tilt_by_gravity_cos_tilt
        * inverse_determinant_slide_tilt_sq_mass_pan)
    accel_tilt_by_gravity_sin_tilt = (balance_tilt_by_gravity_sin_tilt
        * inverse_determinant_slide_tilt_sq_mass_pan)
    accel_tilt_by_inertia_pan_sin_cos_tilt = (inverse_determinant_slide_tilt_sq
        * (-balance_pan_by_inertia_pan_sin_cos_tilt * mass_pan_tilt_slide_tilt_sq
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
    accel_pan_by_c_x_payload = (accel_pan_by_coupling_sin_tilt * coupling_sin_tilt_by_c_x_payload
        + accel_pan_by_gravity_cos_tilt * gravity_cos_tilt_by_c_x_payload
        + accel_pan_by_inertia_pan * inertia_pan_by_c_x_payload
        + accel_pan_by_inertia_pan_sin_cos_tilt * inertia_tilt_by_c_z_payload
        - accel_pan_by_inertia_pan_sin_sq_tilt * inertia_pan_by_c_x_payload
        + accel_pan_by_inertia_tilt * inertia_pan_by_c_x_payload)
    fp[2, 8] = accel_pan_by_c_x_payload
    fp[3, 8] = (accel_tilt_by_coupling_sin_tilt * coupling_sin_tilt_by_c_x_payload
        + accel_tilt_by_gravity_cos_tilt * gravity_cos_tilt_by_c_x_payload
        + accel_tilt_by_inertia_pan * inertia_pan_by_c_x_payload
        + accel_tilt_by_inertia_pan_sin_cos_tilt * inertia_tilt_by_c_z_payload
        - accel_tilt_by_inertia_pan_sin_sq_tilt * inertia_pan_by_c_x_payload
        + accel_tilt_by_inertia_tilt * inertia_pan_by_c_x_payload)  # accel_tilt_by_c_x_payload
    inertia_pan_by_c_y_payload = 2.0 * coupling_sin_tilt_by_c_x_payload
    accel_pan_by_c_y_payload = (accel_pan_by_coupling_cos_tilt * gravity_sin_tilt_by_gravity
        + accel_pan_by_coupling_sin_tilt * gravity_cos_tilt_by_gravity
        + accel_pan_by_inertia_pan * inertia_pan_by_c_y_payload)
    fp[2, 9] = accel_pan_by_c_y_payload
    fp[3, 9] = (accel_tilt_by_coupling_cos_tilt * gravity_sin_tilt_by_gravity
        + accel_tilt_by_coupling_sin_tilt * gravity_cos_tilt_by_gravity
        + accel_tilt_by_inertia_pan * inertia_pan_by_c_y_payload)  # accel_tilt_by_c_y_payload
    accel_pan_by_c_z_payload = (accel_pan_by_coupling_cos_tilt * coupling_sin_tilt_by_c_x_payload
        + accel_pan_by_gravity_sin_tilt * gravity_cos_tilt_by_c_x_payload
        + accel_pan_by_inertia_pan_sin_cos_tilt * inertia_pan_by_c_x_payload
        + accel_pan_by_inertia_pan_sin_sq_tilt * inertia_tilt_by_c_z_payload
        + accel_pan_by_inertia_tilt * inertia_tilt_by_c_z_payload)
    fp[2, 10] = accel_pan_by_c_z_payload
    fp[3, 10] = (accel_tilt_by_coupling_cos_tilt * coupling_sin_tilt_by_c_x_payload
        + accel_tilt_by_gravity_sin_tilt * gravity_cos_tilt_by_c_x_payload
        + accel_tilt_by_inertia_pan_sin_cos_tilt * inertia_pan_by_c_x_payload
        + accel_tilt_by_inertia_pan_sin_sq_tilt * inertia_tilt_by_c_z_payload
        + accel_tilt_by_inertia_tilt * inertia_tilt_by_c_z_payload)  # accel_tilt_by_c_z_payload
    load_torque_tilt_by_b_pan = mass_pan_inverse_mass_pan_tilt * omega_pan
    carried_tilt_by_b_pan = -J_motor_tilt_ratio_tilt_sq * load_torque_tilt_by_b_pan
    balance_tilt_by_b_pan = carried_tilt_by_b_pan * force_tilt_by_carried_tilt
    accel_pan_by_b_pan = (inverse_determinant * (-balance_tilt_by_b_pan
        * mass_pan_tilt_slide_tilt_sq - mass_tilt * omega_pan))
    fp[2, 11] = accel_pan_by_b_pan
    fp[3, 11] = (inverse_determinant_slide_tilt_sq * (balance_tilt_by_b_pan * mass_pan
        + mass_pan_tilt_slide_tilt_sq * omega_pan))  # accel_tilt_by_b_pan
    carried_tilt_by_b_tilt = J_motor_tilt_ratio_tilt_sq * omega_tilt
    balance_tilt_by_b_tilt = carried_tilt_by_b_tilt * force_tilt_by_carried_tilt - omega_tilt
    accel_pan_by_b_tilt = -accel_pan_by_i_tilt_factor * balance_tilt_by_b_tilt
    fp[2, 12] = accel_pan_by_b_tilt
    # accel_tilt_by_b_tilt
    fp[3, 12] = balance_tilt_by_b_tilt * inverse_determinant_slide_tilt_sq_mass_pan
    fp[5, 13] = (-inverse_mass_gear_pan_slide_pan_sq * slide_pan * (-exp_minus_stribeck_square_pan
        * one_plus_a_F_c_pan_slide_pan + one_plus_a_F_c_pan_slide_pan))  # accel_gear_pan_by_F_c_pan
    fp[5, 14] = (-exp_minus_stribeck_square_pan * inverse_mass_gear_pan_slide_pan_sq
        * one_plus_a_F_s_pan_slide_pan * slide_pan)  # accel_gear_pan_by_F_s_pan
    accel_gear_pan_by_v_s_pan_factor = (omega_gear_pan_sq
        * twice_accel_gear_pan_by_omega_gear_pan_factor)
    # accel_gear_pan_by_v_s_pan
    fp[5, 15] = (-accel_gear_pan_by_v_s_pan_factor * inverse_mass_gear_pan_slide_pan_sq
        * one_plus_a_v_s_pan_slide_pan_inverse_sq * slide_pan / (v_s_pan * v_s_pan * v_s_pan))
    fp[5, 16] = (-inverse_mass_gear_pan_slide_pan_sq * omega_gear_pan * one_plus_a_F_v_pan_slide_pan
        * slide_pan_sq)  # accel_gear_pan_by_F_v_pan
    F_c_pan_slide_pan = F_c_pan * slide_pan
    fp[5, 17] = (-inverse_mass_gear_pan_slide_pan_sq * slide_pan * (-F_c_pan_slide_pan
        * exp_minus_stribeck_square_pan + F_c_pan_slide_pan))  # accel_gear_pan_by_a_F_c_pan
    fp[5, 18] = (-F_s_pan * exp_minus_stribeck_square_pan * inverse_mass_gear_pan_slide_pan_sq
        * slide_pan_sq)  # accel_gear_pan_by_a_F_s_pan
    # accel_gear_pan_by_a_v_s_pan
    fp[5, 19] = (-accel_gear_pan_by_v_s_pan_factor * inverse_mass_gear_pan_slide_pan_sq
        * slide_pan_sq * v_s_pan_inverse_sq / (one_plus_a_v_s_pan_slide_pan
        * one_plus_a_v_s_pan_slide_pan * one_plus_a_v_s_pan_slide_pan))
    omega_gear_pan_slide_pan = omega_gear_pan * slide_pan
    # accel_gear_pan_by_a_F_v_pan
    fp[5, 20] = -F_v_pan * inverse_mass_gear_pan_slide_pan_sq * omega_gear_pan_slide_pan
    balance_gear_pan_by_gap_pan = 0.5 * holding_pan_by_theta_pan * side_pan
    load_torque_tilt_by_gap_pan = balance_gear_pan_by_gap_pan * mass_pan_inverse_mass_pan_tilt
    carried_tilt_by_gap_pan = -J_motor_tilt_ratio_tilt_sq * load_torque_tilt_by_gap_pan
    balance_tilt_by_gap_pan = carried_tilt_by_gap_pan * force_tilt_by_carried_tilt
    accel_pan_by_gap_pan = (inverse_determinant * (-balance_gear_pan_by_gap_pan * mass_tilt
        - balance_tilt_by_gap_pan * mass_pan_tilt_slide_tilt_sq))
    fp[2, 21] = accel_pan_by_gap_pan
    # accel_tilt_by_gap_pan
    fp[3, 21] = (inverse_determinant_slide_tilt_sq * (balance_gear_pan_by_gap_pan
        * mass_pan_tilt_slide_tilt_sq + balance_tilt_by_gap_pan * mass_pan))
    # accel_gear_pan_by_gap_pan
    fp[5, 21] = balance_gear_pan_by_gap_pan * inverse_mass_gear_pan_slide_pan_sq
    balance_gear_pan_by_k_shaft_pan = -active_pan * shaft_torque_pan_factor
    load_torque_tilt_by_k_shaft_pan = (balance_gear_pan_by_k_shaft_pan
        * mass_pan_inverse_mass_pan_tilt)
    carried_tilt_by_k_shaft_pan = -J_motor_tilt_ratio_tilt_sq * load_torque_tilt_by_k_shaft_pan
    balance_tilt_by_k_shaft_pan = carried_tilt_by_k_shaft_pan * force_tilt_by_carried_tilt
    accel_pan_by_k_shaft_pan = (inverse_determinant * (-balance_gear_pan_by_k_shaft_pan * mass_tilt
        - balance_tilt_by_k_shaft_pan * mass_pan_tilt_slide_tilt_sq))
    fp[2, 22] = accel_pan_by_k_shaft_pan
    # accel_tilt_by_k_shaft_pan
    fp[3, 22] = (inverse_determinant_slide_tilt_sq * (balance_gear_pan_by_k_shaft_pan
        * mass_pan_tilt_slide_tilt_sq + balance_tilt_by_k_shaft_pan * mass_pan))
    # accel_gear_pan_by_k_shaft_pan
    fp[5, 22] = balance_gear_pan_by_k_shaft_pan * inverse_mass_gear_pan_slide_pan_sq
    balance_gear_pan_by_d_shaft_pan = -active_pan * upper_pan_by_d_shaft_pan
    load_torque_tilt_by_d_shaft_pan = (balance_gear_pan_by_d_shaft_pan
        * mass_pan_inverse_mass_pan_tilt)
    carried_tilt_by_d_shaft_pan = -J_motor_tilt_ratio_tilt_sq * load_torque_tilt_by_d_shaft_pan
    balance_tilt_by_d_shaft_pan = carried_tilt_by_d_shaft_pan * force_tilt_by_carried_tilt
    accel_pan_by_d_shaft_pan = (inverse_determinant * (-balance_gear_pan_by_d_shaft_pan * mass_tilt
        - balance_tilt_by_d_shaft_pan * mass_pan_tilt_slide_tilt_sq))
    fp[2, 23] = accel_pan_by_d_shaft_pan
    # accel_tilt_by_d_shaft_pan
    fp[3, 23] = (inverse_determinant_slide_tilt_sq * (balance_gear_pan_by_d_shaft_pan
        * mass_pan_tilt_slide_tilt_sq + balance_tilt_by_d_shaft_pan * mass_pan))
    # accel_gear_pan_by_d_shaft_pan
    fp[5, 23] = balance_gear_pan_by_d_shaft_pan * inverse_mass_gear_pan_slide_pan_sq
    fp[6, 24] = (-(-R_pan * i_pan - balance_gear_pan_by_i_pan * omega_gear_pan
        + u_pan) / (L_pan * L_pan))  # rate_of_i_pan_by_L_pan
    fp[6, 25] = -i_pan * rate_of_i_pan_by_u_pan  # rate_of_i_pan_by_R_pan
    balance_gear_pan_by_K_t_pan = N_pan * i_pan
    # accel_gear_pan_by_K_t_pan
    fp[5, 26] = balance_gear_pan_by_K_t_pan * inverse_mass_gear_pan_slide_pan_sq
    omega_gear_pan_rate_of_i_pan_by_u_pan = omega_gear_pan * rate_of_i_pan_by_u_pan
    fp[6, 26] = -N_pan * omega_gear_pan_rate_of_i_pan_by_u_pan  # rate_of_i_pan_by_K_t_pan
    force_gear_pan = (K_t_pan * N_pan * i_pan - shaft_torque_pan
        - slide_pan * (accel_gear_pan_by_omega_gear_pan_factor + coulomb_torque_pan
        + omega_gear_pan_slide_pan * viscous_coefficient_pan))
    accel_gear_pan = force_gear_pan * inverse_mass_gear_pan_slide_pan_sq
    # accel_gear_pan_by_J_motor_pan
    fp[5, 27] = -N_pan_sq * accel_gear_pan * inverse_mass_gear_pan_slide_pan_sq
    fp[5, 28] = (inverse_mass_gear_pan_slide_pan_sq * (-2.0 * J_motor_pan * N_pan * accel_gear_pan
        + K_t_pan * i_pan))  # accel_gear_pan_by_N_pan
    fp[6, 28] = -K_t_pan * omega_gear_pan_rate_of_i_pan_by_u_pan  # rate_of_i_pan_by_N_pan
    fp[7, 29] = (-(-R_tilt * i_tilt - driving_torque_tilt_by_i_tilt * omega_tilt
        + u_tilt) / (L_tilt * L_tilt))  # rate_of_i_tilt_by_L_tilt
    fp[7, 30] = -i_tilt * rate_of_i_tilt_by_u_tilt  # rate_of_i_tilt_by_R_tilt
    driving_torque_tilt_by_K_t_tilt = i_tilt * ratio_tilt
    carried_tilt_by_K_t_tilt = driving_torque_tilt_by_K_t_tilt * load_inertia_tilt
    balance_tilt_by_K_t_tilt = (carried_tilt_by_K_t_tilt * force_tilt_by_carried_tilt
        + driving_torque_tilt_by_K_t_tilt)
    accel_pan_by_K_t_tilt = -accel_pan_by_i_tilt_factor * balance_tilt_by_K_t_tilt
    fp[2, 31] = accel_pan_by_K_t_tilt
    # accel_tilt_by_K_t_tilt
    fp[3, 31] = balance_tilt_by_K_t_tilt * inverse_determinant_slide_tilt_sq_mass_pan
    fp[7, 31] = -omega_tilt_ratio_tilt * rate_of_i_tilt_by_u_tilt  # rate_of_i_tilt_by_K_t_tilt
    carried_tilt_by_J_motor_tilt = (-driving_torque_tilt_factor * load_inertia_tilt
        - load_torque_tilt * ratio_tilt_sq)
    lost_lowering_tilt_by_J_motor_tilt = -lost_lowering_tilt_by_theta_tilt_factor * ratio_tilt_sq
    lost_raising_tilt_by_J_motor_tilt = -lost_raising_tilt_by_theta_tilt_factor * ratio_tilt_sq
    balance_tilt_by_J_motor_tilt = (-accel_tilt * ratio_tilt_sq
        + carried_tilt_by_J_motor_tilt * force_tilt_by_carried_tilt - driving_torque_tilt_factor
        + force_tilt_by_lost_lowering_tilt * lost_lowering_tilt_by_J_motor_tilt
        + force_tilt_by_lost_raising_tilt * lost_raising_tilt_by_J_motor_tilt)
    accel_pan_by_J_motor_tilt = -accel_pan_by_i_tilt_factor * balance_tilt_by_J_motor_tilt
    fp[2, 32] = accel_pan_by_J_motor_tilt
    # accel_tilt_by_J_motor_tilt
    fp[3, 32] = balance_tilt_by_J_motor_tilt * inverse_determinant_slide_tilt_sq_mass_pan
    omega_tilt_ratio_tilt_sq = omega_tilt * ratio_tilt_sq
    carried_tilt_by_b_motor_tilt = -load_inertia_tilt * omega_tilt_ratio_tilt_sq
    balance_tilt_by_b_motor_tilt = (carried_tilt_by_b_motor_tilt * force_tilt_by_carried_tilt
        - omega_tilt_ratio_tilt_sq)
    accel_pan_by_b_motor_tilt = -accel_pan_by_i_tilt_factor * balance_tilt_by_b_motor_tilt
    fp[2, 33] = accel_pan_by_b_motor_tilt
    # accel_tilt_by_b_motor_tilt
    fp[3, 33] = balance_tilt_by_b_motor_tilt * inverse_determinant_slide_tilt_sq_mass_pan
    ratio_tilt_by_theta_tilt_by_N_tilt = (ratio_tilt_by_theta_tilt_factor_2
        - ratio_tilt_by_theta_tilt_factor_4)
    driving_torque_tilt_by_N_tilt = (-J_motor_tilt_ratio_tilt_omega_tilt_sq
        * ratio_tilt_by_theta_tilt_by_N_tilt + force_tilt_by_ratio_tilt * ratio_tilt_by_N_tilt)
    carried_tilt_by_N_tilt = (carried_tilt_by_ratio_tilt * ratio_tilt_by_N_tilt
        + driving_torque_tilt_by_N_tilt * load_inertia_tilt)
    lost_lowering_tilt_by_N_tilt = lost_lowering_tilt_by_ratio_tilt * ratio_tilt_by_N_tilt
    lost_raising_tilt_by_N_tilt = lost_raising_tilt_by_ratio_tilt * ratio_tilt_by_N_tilt
    balance_tilt_by_N_tilt = (-accel_tilt_twice_J_motor_tilt_ratio_tilt * ratio_tilt_by_N_tilt
        + carried_tilt_by_N_tilt * force_tilt_by_carried_tilt + driving_torque_tilt_by_N_tilt
        + force_tilt_by_lost_lowering_tilt * lost_lowering_tilt_by_N_tilt
        + force_tilt_by_lost_raising_tilt * lost_raising_tilt_by_N_tilt)
    accel_pan_by_N_tilt = -accel_pan_by_i_tilt_factor * balance_tilt_by_N_tilt
    fp[2, 34] = accel_pan_by_N_tilt
    # accel_tilt_by_N_tilt
    fp[3, 34] = balance_tilt_by_N_tilt * inverse_determinant_slide_tilt_sq_mass_pan
    # rate_of_i_tilt_by_N_tilt
    fp[7, 34] = -K_t_tilt_omega_tilt_rate_of_i_tilt_by_u_tilt * ratio_tilt_by_N_tilt
    lost_lowering_tilt_by_lowered_tilt = (-abs_lost_lowering_tilt_denominator_inverse
        - load_inertia_tilt * lost_lowering_tilt_by_theta_tilt_factor)
    balance_tilt_by_lowered_tilt = (force_tilt_by_lost_lowering_tilt
        * lost_lowering_tilt_by_lowered_tilt)
    accel_pan_by_lowered_tilt = -accel_pan_by_i_tilt_factor * balance_tilt_by_lowered_tilt
    lost_raising_tilt_by_raised_tilt = (-load_inertia_tilt * lost_raising_tilt_by_theta_tilt_factor
        + lost_raising_tilt_denominator_inverse)
    balance_tilt_by_raised_tilt = force_tilt_by_lost_raising_tilt * lost_raising_tilt_by_raised_tilt
    accel_pan_by_raised_tilt = -accel_pan_by_i_tilt_factor * balance_tilt_by_raised_tilt
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
        + driving_torque_tilt_by_lead_tilt * load_inertia_tilt)
    lost_lowering_tilt_by_lead_tilt = lost_lowering_tilt_by_ratio_tilt * ratio_tilt_by_lead_tilt
    lost_raising_tilt_by_lead_tilt = lost_raising_tilt_by_ratio_tilt * ratio_tilt_by_lead_tilt
    balance_tilt_by_lead_tilt = (-accel_tilt_twice_J_motor_tilt_ratio_tilt * ratio_tilt_by_lead_tilt
        + carried_tilt_by_lead_tilt * force_tilt_by_carried_tilt + driving_torque_tilt_by_lead_tilt
        + force_tilt_by_lost_lowering_tilt * lost_lowering_tilt_by_lead_tilt
        + force_tilt_by_lost_raising_tilt * lost_raising_tilt_by_lead_tilt)
    accel_pan_by_lead_tilt = (-accel_pan_by_i_tilt_factor * balance_tilt_by_lead_tilt
        + accel_pan_by_lowered_tilt * lowered_tilt_by_lead_tilt
        + accel_pan_by_raised_tilt * raised_tilt_by_lead_tilt)
    fp[2, 35] = accel_pan_by_lead_tilt
    accel_tilt_by_lowered_tilt = (balance_tilt_by_lowered_tilt
        * inverse_determinant_slide_tilt_sq_mass_pan)
    accel_tilt_by_raised_tilt = (balance_tilt_by_raised_tilt
        * inverse_determinant_slide_tilt_sq_mass_pan)
    # accel_tilt_by_lead_tilt
    fp[3, 35] = (accel_tilt_by_lowered_tilt * lowered_tilt_by_lead_tilt
        + accel_tilt_by_raised_tilt * raised_tilt_by_lead_tilt
        + balance_tilt_by_lead_tilt * inverse_determinant_slide_tilt_sq_mass_pan)
    # rate_of_i_tilt_by_lead_tilt
    fp[7, 35] = -K_t_tilt_omega_tilt_rate_of_i_tilt_by_u_tilt * ratio_tilt_by_lead_tilt
    d_screw_tilt_pi_sq = (math.pi * math.pi) * d_screw_tilt
    d_screw_tilt_pi_sq_f_screw_tilt = d_screw_tilt_pi_sq * f_screw_tilt
    lowered_tilt_by_d_screw_tilt = ((math.pi * math.pi) * d_screw_tilt
        * d_screw_tilt_pi_f_screw_tilt_minus_lead_tilt * lead_tilt_inverse
        * lowered_tilt_by_lead_tilt_factor - d_screw_tilt_pi_sq_f_screw_tilt
        * lead_tilt_inverse_lowered_tilt_factor - lead_tilt_inverse_pi * lowered_tilt_factor_2)
    raised_tilt_by_d_screw_tilt = (-d_screw_tilt_pi_sq * raised_tilt_by_lead_tilt_factor_2
        + d_screw_tilt_pi_sq_f_screw_tilt * lead_tilt_inverse_raised_tilt_factor
        + lead_tilt_inverse_pi * raised_tilt_factor_2)
    accel_pan_by_d_screw_tilt = (accel_pan_by_lowered_tilt * lowered_tilt_by_d_screw_tilt
        + accel_pan_by_raised_tilt * raised_tilt_by_d_screw_tilt)
    fp[2, 36] = accel_pan_by_d_screw_tilt
    fp[3, 36] = (accel_tilt_by_lowered_tilt * lowered_tilt_by_d_screw_tilt
        + accel_tilt_by_raised_tilt * raised_tilt_by_d_screw_tilt)  # accel_tilt_by_d_screw_tilt
    d_screw_tilt_sq_pi_sq = (math.pi * math.pi) * (d_screw_tilt * d_screw_tilt)
    lowered_tilt_by_f_screw_tilt = (math.pi * d_screw_tilt
        * d_screw_tilt_pi_f_screw_tilt_minus_lead_tilt * lowered_tilt_by_lead_tilt_factor
        - d_screw_tilt_sq_pi_sq * lead_tilt_inverse_lowered_tilt_factor)
    raised_tilt_by_f_screw_tilt = (d_screw_tilt_pi * raised_tilt_by_lead_tilt_factor
        + d_screw_tilt_sq_pi_sq * lead_tilt_inverse_raised_tilt_factor)
    accel_pan_by_f_screw_tilt = (accel_pan_by_lowered_tilt * lowered_tilt_by_f_screw_tilt
        + accel_pan_by_raised_tilt * raised_tilt_by_f_screw_tilt)
    fp[2, 37] = accel_pan_by_f_screw_tilt
    fp[3, 37] = (accel_tilt_by_lowered_tilt * lowered_tilt_by_f_screw_tilt
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
        + driving_torque_tilt_by_linkage_cos_tilt * load_inertia_tilt)
    lost_lowering_tilt_by_linkage_cos_tilt = (lost_lowering_tilt_by_ratio_tilt
        * ratio_tilt_by_linkage_cos_tilt)
    lost_raising_tilt_by_linkage_cos_tilt = (lost_raising_tilt_by_ratio_tilt
        * ratio_tilt_by_linkage_cos_tilt)
    balance_tilt_by_linkage_cos_tilt = (-accel_tilt_twice_J_motor_tilt_ratio_tilt
        * ratio_tilt_by_linkage_cos_tilt + carried_tilt_by_linkage_cos_tilt
        * force_tilt_by_carried_tilt + driving_torque_tilt_by_linkage_cos_tilt
        + force_tilt_by_lost_lowering_tilt * lost_lowering_tilt_by_linkage_cos_tilt
        + force_tilt_by_lost_raising_tilt * lost_raising_tilt_by_linkage_cos_tilt)
    accel_pan_by_linkage_cos_tilt = -accel_pan_by_i_tilt_factor * balance_tilt_by_linkage_cos_tilt
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
        + driving_torque_tilt_by_linkage_sin_tilt * load_inertia_tilt)
    lost_lowering_tilt_by_linkage_sin_tilt = (lost_lowering_tilt_by_ratio_tilt
        * ratio_tilt_by_linkage_sin_tilt)
    lost_raising_tilt_by_linkage_sin_tilt = (lost_raising_tilt_by_ratio_tilt
        * ratio_tilt_by_linkage_sin_tilt)
    balance_tilt_by_linkage_sin_tilt = (-accel_tilt_twice_J_motor_tilt_ratio_tilt
        * ratio_tilt_by_linkage_sin_tilt + carried_tilt_by_linkage_sin_tilt
        * force_tilt_by_carried_tilt + driving_torque_tilt_by_linkage_sin_tilt
        + force_tilt_by_lost_lowering_tilt * lost_lowering_tilt_by_linkage_sin_tilt
        + force_tilt_by_lost_raising_tilt * lost_raising_tilt_by_linkage_sin_tilt)
    accel_pan_by_linkage_sin_tilt = -accel_pan_by_i_tilt_factor * balance_tilt_by_linkage_sin_tilt
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
        + driving_torque_tilt_by_l_ground_tilt * load_inertia_tilt)
    lost_lowering_tilt_by_l_ground_tilt = (lost_lowering_tilt_by_ratio_tilt
        * ratio_tilt_by_l_ground_tilt)
    lost_raising_tilt_by_l_ground_tilt = (lost_raising_tilt_by_ratio_tilt
        * ratio_tilt_by_l_ground_tilt)
    balance_tilt_by_l_ground_tilt = (-accel_tilt_twice_J_motor_tilt_ratio_tilt
        * ratio_tilt_by_l_ground_tilt + carried_tilt_by_l_ground_tilt * force_tilt_by_carried_tilt
        + driving_torque_tilt_by_l_ground_tilt + force_tilt_by_lost_lowering_tilt
        * lost_lowering_tilt_by_l_ground_tilt + force_tilt_by_lost_raising_tilt
        * lost_raising_tilt_by_l_ground_tilt)
    accel_pan_by_l_ground_tilt = (-accel_pan_by_i_tilt_factor * balance_tilt_by_l_ground_tilt
        + accel_pan_by_linkage_cos_tilt * linkage_cos_tilt_by_l_ground_tilt
        + accel_pan_by_linkage_sin_tilt * linkage_sin_tilt_by_l_ground_tilt)
    fp[2, 38] = accel_pan_by_l_ground_tilt
    accel_tilt_by_linkage_cos_tilt = (balance_tilt_by_linkage_cos_tilt
        * inverse_determinant_slide_tilt_sq_mass_pan)
    accel_tilt_by_linkage_sin_tilt = (balance_tilt_by_linkage_sin_tilt
        * inverse_determinant_slide_tilt_sq_mass_pan)
    # accel_tilt_by_l_ground_tilt
    fp[3, 38] = (accel_tilt_by_linkage_cos_tilt * linkage_cos_tilt_by_l_ground_tilt
        + accel_tilt_by_linkage_sin_tilt * linkage_sin_tilt_by_l_ground_tilt
        + balance_tilt_by_l_ground_tilt * inverse_determinant_slide_tilt_sq_mass_pan)
    rate_of_i_tilt_by_l_ground_tilt_factor = (K_t_tilt_omega_tilt_rate_of_i_tilt_by_u_tilt
        * ratio_tilt_by_linkage_cos_tilt)
    rate_of_i_tilt_by_l_ground_tilt_factor_2 = (K_t_tilt_omega_tilt_rate_of_i_tilt_by_u_tilt
        * ratio_tilt_by_linkage_sin_tilt)
    # rate_of_i_tilt_by_l_ground_tilt
    fp[7, 38] = (-K_t_tilt_omega_tilt_rate_of_i_tilt_by_u_tilt * ratio_tilt_by_l_ground_tilt
        - linkage_cos_tilt_by_l_ground_tilt * rate_of_i_tilt_by_l_ground_tilt_factor
        - linkage_sin_tilt_by_l_ground_tilt * rate_of_i_tilt_by_l_ground_tilt_factor_2)
    linkage_cos_tilt_by_l_min_tilt = -2.0 * l_min_tilt_plus_s_start_tilt
    linkage_sin_tilt_by_l_min_tilt = (-linkage_cos_tilt_by_l_min_tilt
        * linkage_cos_tilt_linkage_sin_tilt_inverse)
    accel_pan_by_l_min_tilt = (accel_pan_by_linkage_cos_tilt * linkage_cos_tilt_by_l_min_tilt
        + accel_pan_by_linkage_sin_tilt * linkage_sin_tilt_by_l_min_tilt)
    fp[2, 39] = accel_pan_by_l_min_tilt
    accel_tilt_by_l_min_tilt = (accel_tilt_by_linkage_cos_tilt * linkage_cos_tilt_by_l_min_tilt
        + accel_tilt_by_linkage_sin_tilt * linkage_sin_tilt_by_l_min_tilt)
    fp[3, 39] = accel_tilt_by_l_min_tilt
    rate_of_i_tilt_by_l_min_tilt = (-linkage_cos_tilt_by_l_min_tilt
        * rate_of_i_tilt_by_l_ground_tilt_factor - linkage_sin_tilt_by_l_min_tilt
        * rate_of_i_tilt_by_l_ground_tilt_factor_2)
    fp[7, 39] = rate_of_i_tilt_by_l_min_tilt
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
        + driving_torque_tilt_by_r_arm_tilt * load_inertia_tilt)
    lost_lowering_tilt_by_r_arm_tilt = lost_lowering_tilt_by_ratio_tilt * ratio_tilt_by_r_arm_tilt
    lost_raising_tilt_by_r_arm_tilt = lost_raising_tilt_by_ratio_tilt * ratio_tilt_by_r_arm_tilt
    balance_tilt_by_r_arm_tilt = (-accel_tilt_twice_J_motor_tilt_ratio_tilt
        * ratio_tilt_by_r_arm_tilt + carried_tilt_by_r_arm_tilt * force_tilt_by_carried_tilt
        + driving_torque_tilt_by_r_arm_tilt + force_tilt_by_lost_lowering_tilt
        * lost_lowering_tilt_by_r_arm_tilt + force_tilt_by_lost_raising_tilt
        * lost_raising_tilt_by_r_arm_tilt)
    accel_pan_by_r_arm_tilt = (-accel_pan_by_i_tilt_factor * balance_tilt_by_r_arm_tilt
        + accel_pan_by_linkage_cos_tilt * linkage_cos_tilt_by_r_arm_tilt
        + accel_pan_by_linkage_sin_tilt * linkage_sin_tilt_by_r_arm_tilt)
    fp[2, 40] = accel_pan_by_r_arm_tilt
    # accel_tilt_by_r_arm_tilt
    fp[3, 40] = (accel_tilt_by_linkage_cos_tilt * linkage_cos_tilt_by_r_arm_tilt
        + accel_tilt_by_linkage_sin_tilt * linkage_sin_tilt_by_r_arm_tilt
        + balance_tilt_by_r_arm_tilt * inverse_determinant_slide_tilt_sq_mass_pan)
    # rate_of_i_tilt_by_r_arm_tilt
    fp[7, 40] = (-K_t_tilt_omega_tilt_rate_of_i_tilt_by_u_tilt * ratio_tilt_by_r_arm_tilt
        - linkage_cos_tilt_by_r_arm_tilt * rate_of_i_tilt_by_l_ground_tilt_factor
        - linkage_sin_tilt_by_r_arm_tilt * rate_of_i_tilt_by_l_ground_tilt_factor_2)
    fp[2, 41] = accel_pan_by_l_min_tilt  # accel_pan_by_s_start_tilt
    fp[3, 41] = accel_tilt_by_l_min_tilt  # accel_tilt_by_s_start_tilt
    fp[7, 41] = rate_of_i_tilt_by_l_min_tilt  # rate_of_i_tilt_by_s_start_tilt
    accel_pan_by_gravity = (accel_pan_by_gravity_cos_tilt * gravity_cos_tilt_by_gravity
        + accel_pan_by_gravity_sin_tilt * gravity_sin_tilt_by_gravity)
    fp[2, 43] = accel_pan_by_gravity
    fp[3, 43] = (accel_tilt_by_gravity_cos_tilt * gravity_cos_tilt_by_gravity
        + accel_tilt_by_gravity_sin_tilt * gravity_sin_tilt_by_gravity)  # accel_tilt_by_gravity
    if len(gx) == 0:
        return
    gx[0, 0] = holding_pan_by_theta_pan
    gx[3, 0] = accel_pan_by_theta_gear_pan * mass_pan_tilt  # holding_tilt_by_theta_pan
    sign_load_torque_tilt = 0.0 if load_torque_tilt == 0.0 else math.copysign(1.0, load_torque_tilt)
    raised_tilt_minus_lowered_tilt = -lowered_tilt + raised_tilt
    forward_tilt_by_theta_pan_term = 0.5 * lowered_tilt + 0.5 * raised_tilt - 1.0
    forward_tilt_by_theta_pan_factor = (-forward_tilt_by_theta_pan_term
        + 0.5 * raised_tilt_minus_lowered_tilt * sign_load_torque_tilt)
    forward_tilt_by_theta_gear_pan = (forward_tilt_by_theta_pan_factor
        * load_torque_tilt_by_theta_gear_pan)
    gx[4, 0] = -forward_tilt_by_theta_gear_pan  # forward_tilt_by_theta_pan
    backward_tilt_by_theta_pan_factor = (forward_tilt_by_theta_pan_term
        + 0.5 * raised_tilt_minus_lowered_tilt * sign_load_torque_tilt)
    backward_tilt_by_theta_gear_pan = (backward_tilt_by_theta_pan_factor
        * load_torque_tilt_by_theta_gear_pan)
    gx[5, 0] = -backward_tilt_by_theta_gear_pan  # backward_tilt_by_theta_pan
    gx[6, 0] = -1.0  # separation_pan_by_theta_pan
    gx[8, 0] = -k_shaft_pan  # upper_pan_by_theta_pan
    gx[9, 0] = -k_shaft_pan  # lower_pan_by_theta_pan
    # holding_tilt_by_theta_tilt
    gx[3, 1] = (-J_motor_tilt_ratio_tilt_omega_tilt_sq * ratio_tilt_by_theta_tilt_by_theta_tilt
        - accel_pan_by_theta_tilt * mass_pan_tilt - accel_pan_by_theta_tilt_term_2
        + 0.5 * coriolis_by_theta_tilt * omega_pan + cos_tilt * gravity_sin_tilt
        + force_tilt_by_ratio_tilt * ratio_tilt_by_theta_tilt - gravity_cos_tilt_sin_tilt)
    # forward_tilt_by_theta_tilt
    gx[4, 1] = forward_tilt_by_theta_pan_factor * load_torque_tilt_by_theta_tilt
    # backward_tilt_by_theta_tilt
    gx[5, 1] = backward_tilt_by_theta_pan_factor * load_torque_tilt_by_theta_tilt
    gx[0, 2] = follower_torque_tilt_by_omega_gear_pan  # holding_pan_by_omega_pan
    # holding_tilt_by_omega_pan
    gx[3, 2] = (-accel_pan_by_omega_pan * mass_pan_tilt
        + coriolis_by_omega_pan * force_tilt_by_coriolis + half_coriolis)
    # forward_tilt_by_omega_pan
    gx[4, 2] = forward_tilt_by_theta_pan_factor * load_torque_tilt_by_omega_pan
    # backward_tilt_by_omega_pan
    gx[5, 2] = backward_tilt_by_theta_pan_factor * load_torque_tilt_by_omega_pan
    gx[8, 2] = -d_shaft_pan  # upper_pan_by_omega_pan
    gx[9, 2] = -d_shaft_pan  # lower_pan_by_omega_pan
    gx[3, 3] = (-accel_pan_by_omega_tilt * mass_pan_tilt
        - b_tilt_plus_carried_tilt_by_omega_tilt_factor)  # holding_tilt_by_omega_tilt
    # forward_tilt_by_omega_tilt
    gx[4, 3] = forward_tilt_by_theta_pan_factor * load_torque_tilt_by_omega_tilt
    # backward_tilt_by_omega_tilt
    gx[5, 3] = backward_tilt_by_theta_pan_factor * load_torque_tilt_by_omega_tilt
    gx[0, 4] = -holding_pan_by_theta_pan  # holding_pan_by_theta_gear_pan
    gx[3, 4] = -accel_pan_by_theta_gear_pan * mass_pan_tilt  # holding_tilt_by_theta_gear_pan
    gx[4, 4] = forward_tilt_by_theta_gear_pan
    gx[5, 4] = backward_tilt_by_theta_gear_pan
    gx[6, 4] = 1.0  # separation_pan_by_theta_gear_pan
    gx[8, 4] = k_shaft_pan  # upper_pan_by_theta_gear_pan
    gx[9, 4] = k_shaft_pan  # lower_pan_by_theta_gear_pan
    gx[0, 5] = -follower_torque_tilt_by_omega_gear_pan  # holding_pan_by_omega_gear_pan
    gx[3, 5] = -accel_pan_by_omega_gear_pan * mass_pan_tilt  # holding_tilt_by_omega_gear_pan
    # forward_tilt_by_omega_gear_pan
    gx[4, 5] = forward_tilt_by_theta_pan_factor * load_torque_tilt_by_omega_gear_pan
    # backward_tilt_by_omega_gear_pan
    gx[5, 5] = backward_tilt_by_theta_pan_factor * load_torque_tilt_by_omega_gear_pan
    gx[8, 5] = d_shaft_pan  # upper_pan_by_omega_gear_pan
    gx[9, 5] = d_shaft_pan  # lower_pan_by_omega_gear_pan
    gx[0, 6] = balance_gear_pan_by_i_pan  # holding_pan_by_i_pan
    # holding_tilt_by_i_tilt
    gx[3, 7] = -accel_pan_by_i_tilt * mass_pan_tilt + driving_torque_tilt_by_i_tilt
    gp[3, 0] = -accel_pan_by_inertia_pan * mass_pan_tilt  # holding_tilt_by_J_pan
    forward_tilt_by_J_pan = (forward_tilt_by_theta_pan_factor
        * load_torque_tilt_by_follower_inertia_tilt)
    gp[4, 0] = forward_tilt_by_J_pan
    backward_tilt_by_J_pan = (backward_tilt_by_theta_pan_factor
        * load_torque_tilt_by_follower_inertia_tilt)
    gp[5, 0] = backward_tilt_by_J_pan
    holding_tilt_by_J_x_tilt = (-accel_pan_by_inertia_pan_sin_sq_tilt * mass_pan_tilt
        + load_torque_tilt_by_inertia_pan_sin_sq_tilt_term)
    gp[3, 1] = holding_tilt_by_J_x_tilt
    forward_tilt_by_J_x_tilt = (forward_tilt_by_theta_pan_factor
        * load_torque_tilt_by_inertia_pan_sin_sq_tilt)
    gp[4, 1] = forward_tilt_by_J_x_tilt
    backward_tilt_by_J_x_tilt = (backward_tilt_by_theta_pan_factor
        * load_torque_tilt_by_inertia_pan_sin_sq_tilt)
    gp[5, 1] = backward_tilt_by_J_x_tilt
    holding_tilt_by_J_y_tilt = -accel_pan_by_inertia_tilt * mass_pan_tilt
    gp[3, 2] = holding_tilt_by_J_y_tilt
    holding_tilt_by_J_z_tilt = (-accel_pan_by_J_z_tilt * mass_pan_tilt
        - load_torque_tilt_by_inertia_pan_sin_sq_tilt_term)
    gp[3, 3] = holding_tilt_by_J_z_tilt
    forward_tilt_by_J_z_tilt = (-forward_tilt_by_J_x_tilt
        + forward_tilt_by_theta_pan_factor * load_torque_tilt_by_follower_inertia_tilt)
    gp[4, 3] = forward_tilt_by_J_z_tilt
    backward_tilt_by_J_z_tilt = (-backward_tilt_by_J_x_tilt
        + backward_tilt_by_theta_pan_factor * load_torque_tilt_by_follower_inertia_tilt)
    gp[5, 3] = backward_tilt_by_J_z_tilt
    # holding_tilt_by_m_payload
    gp[3, 4] = (-accel_pan * (-cos_tilt * coupling_cos_tilt_by_m_payload
        + coupling_sin_tilt_by_m_payload * sin_tilt) - accel_pan_by_m_payload * mass_pan_tilt
        + cos_tilt * gravity_cos_tilt_by_m_payload + gravity_sin_tilt_by_m_payload * sin_tilt
        + inertia_pan_sin_cos_tilt_by_m_payload * load_torque_tilt_by_inertia_pan_sin_cos_tilt_term
        + inertia_pan_sin_sq_tilt_by_m_payload * load_torque_tilt_by_inertia_pan_sin_sq_tilt_term)
    cos_tilt_gravity_cos_tilt_by_m_payload = cos_tilt * gravity_cos_tilt_by_m_payload
    forward_tilt_by_m_payload_factor = (coupling_cos_tilt_by_m_payload
        * load_torque_tilt_by_coupling_cos_tilt)
    forward_tilt_by_m_payload_factor_2 = (coupling_sin_tilt_by_m_payload
        * load_torque_tilt_by_coupling_sin_tilt)
    gravity_sin_tilt_by_m_payload_sin_tilt = gravity_sin_tilt_by_m_payload * sin_tilt
    forward_tilt_by_m_payload_factor_3 = (inertia_pan_sin_cos_tilt_by_m_payload
        * load_torque_tilt_by_inertia_pan_sin_cos_tilt)
    # forward_tilt_by_m_payload
    gp[4, 4] = (cos_tilt_gravity_cos_tilt_by_m_payload * forward_tilt_by_theta_pan_factor
        + forward_tilt_by_J_pan * inertia_pan_by_m_payload
        + forward_tilt_by_J_x_tilt * inertia_pan_sin_sq_tilt_by_m_payload
        + forward_tilt_by_m_payload_factor * forward_tilt_by_theta_pan_factor
        + forward_tilt_by_m_payload_factor_2 * forward_tilt_by_theta_pan_factor
        + forward_tilt_by_m_payload_factor_3 * forward_tilt_by_theta_pan_factor
        + forward_tilt_by_theta_pan_factor * gravity_sin_tilt_by_m_payload_sin_tilt)
    # backward_tilt_by_m_payload
    gp[5, 4] = (backward_tilt_by_J_pan * inertia_pan_by_m_payload
        + backward_tilt_by_J_x_tilt * inertia_pan_sin_sq_tilt_by_m_payload
        + backward_tilt_by_theta_pan_factor * cos_tilt_gravity_cos_tilt_by_m_payload
        + backward_tilt_by_theta_pan_factor * forward_tilt_by_m_payload_factor
        + backward_tilt_by_theta_pan_factor * forward_tilt_by_m_payload_factor_2
        + backward_tilt_by_theta_pan_factor * forward_tilt_by_m_payload_factor_3
        + backward_tilt_by_theta_pan_factor * gravity_sin_tilt_by_m_payload_sin_tilt)
    gp[3, 5] = holding_tilt_by_J_x_tilt  # holding_tilt_by_J_x_payload
    gp[4, 5] = forward_tilt_by_J_x_tilt  # forward_tilt_by_J_x_payload
    gp[5, 5] = backward_tilt_by_J_x_tilt  # backward_tilt_by_J_x_payload
    gp[3, 6] = holding_tilt_by_J_y_tilt  # holding_tilt_by_J_y_payload
    gp[3, 7] = holding_tilt_by_J_z_tilt  # holding_tilt_by_J_z_payload
    gp[4, 7] = forward_tilt_by_J_z_tilt  # forward_tilt_by_J_z_payload
    gp[5, 7] = backward_tilt_by_J_z_tilt  # backward_tilt_by_J_z_payload
    # holding_tilt_by_c_x_payload
    gp[3, 8] = (-accel_pan_by_c_x_payload * mass_pan_tilt
        - accel_pan_sin_tilt * coupling_sin_tilt_by_c_x_payload
        + 0.5 * coriolis_by_inertia_pan_sin_cos_tilt * inertia_tilt_by_c_z_payload * omega_pan
        + cos_tilt * gravity_cos_tilt_by_c_x_payload
        - inertia_pan_by_c_x_payload * load_torque_tilt_by_inertia_pan_sin_sq_tilt_term)
    cos_tilt_gravity_cos_tilt_by_c_x_payload = cos_tilt * gravity_cos_tilt_by_c_x_payload
    forward_tilt_by_c_x_payload_factor = (coupling_sin_tilt_by_c_x_payload
        * load_torque_tilt_by_coupling_sin_tilt)
    forward_tilt_by_c_x_payload_factor_2 = (inertia_tilt_by_c_z_payload
        * load_torque_tilt_by_inertia_pan_sin_cos_tilt)
    # forward_tilt_by_c_x_payload
    gp[4, 8] = (cos_tilt_gravity_cos_tilt_by_c_x_payload * forward_tilt_by_theta_pan_factor
        + forward_tilt_by_J_pan * inertia_pan_by_c_x_payload
        - forward_tilt_by_J_x_tilt * inertia_pan_by_c_x_payload
        + forward_tilt_by_c_x_payload_factor * forward_tilt_by_theta_pan_factor
        + forward_tilt_by_c_x_payload_factor_2 * forward_tilt_by_theta_pan_factor)
    # backward_tilt_by_c_x_payload
    gp[5, 8] = (backward_tilt_by_J_pan * inertia_pan_by_c_x_payload
        - backward_tilt_by_J_x_tilt * inertia_pan_by_c_x_payload
        + backward_tilt_by_theta_pan_factor * cos_tilt_gravity_cos_tilt_by_c_x_payload
        + backward_tilt_by_theta_pan_factor * forward_tilt_by_c_x_payload_factor
        + backward_tilt_by_theta_pan_factor * forward_tilt_by_c_x_payload_factor_2)
    # holding_tilt_by_c_y_payload
    gp[3, 9] = (-accel_pan * (-cos_tilt * gravity_sin_tilt_by_gravity
        + gravity_cos_tilt_by_gravity * sin_tilt) - accel_pan_by_c_y_payload * mass_pan_tilt)
    forward_tilt_by_c_y_payload_factor = (gravity_cos_tilt_by_gravity
        * load_torque_tilt_by_coupling_sin_tilt)
    forward_tilt_by_c_y_payload_factor_2 = (gravity_sin_tilt_by_gravity
        * load_torque_tilt_by_coupling_cos_tilt)
    # forward_tilt_by_c_y_payload
    gp[4, 9] = (forward_tilt_by_J_pan * inertia_pan_by_c_y_payload
        + forward_tilt_by_c_y_payload_factor * forward_tilt_by_theta_pan_factor
        + forward_tilt_by_c_y_payload_factor_2 * forward_tilt_by_theta_pan_factor)
    # backward_tilt_by_c_y_payload
    gp[5, 9] = (backward_tilt_by_J_pan * inertia_pan_by_c_y_payload
        + backward_tilt_by_theta_pan_factor * forward_tilt_by_c_y_payload_factor
        + backward_tilt_by_theta_pan_factor * forward_tilt_by_c_y_payload_factor_2)
    # holding_tilt_by_c_z_payload
    gp[3, 10] = (-accel_pan_by_c_z_payload * mass_pan_tilt
        + accel_pan_cos_tilt * coupling_sin_tilt_by_c_x_payload
        + gravity_cos_tilt_by_c_x_payload * sin_tilt
        + inertia_pan_by_c_x_payload * load_torque_tilt_by_inertia_pan_sin_cos_tilt_term
        + inertia_tilt_by_c_z_payload * load_torque_tilt_by_inertia_pan_sin_sq_tilt_term)
    forward_tilt_by_c_z_payload_factor = (coupling_sin_tilt_by_c_x_payload
        * load_torque_tilt_by_coupling_cos_tilt)
    gravity_cos_tilt_by_c_x_payload_sin_tilt = gravity_cos_tilt_by_c_x_payload * sin_tilt
    forward_tilt_by_c_z_payload_factor_2 = (inertia_pan_by_c_x_payload
        * load_torque_tilt_by_inertia_pan_sin_cos_tilt)
    # forward_tilt_by_c_z_payload
    gp[4, 10] = (forward_tilt_by_J_x_tilt * inertia_tilt_by_c_z_payload
        + forward_tilt_by_c_z_payload_factor * forward_tilt_by_theta_pan_factor
        + forward_tilt_by_c_z_payload_factor_2 * forward_tilt_by_theta_pan_factor
        + forward_tilt_by_theta_pan_factor * gravity_cos_tilt_by_c_x_payload_sin_tilt)
    # backward_tilt_by_c_z_payload
    gp[5, 10] = (backward_tilt_by_J_x_tilt * inertia_tilt_by_c_z_payload
        + backward_tilt_by_theta_pan_factor * forward_tilt_by_c_z_payload_factor
        + backward_tilt_by_theta_pan_factor * forward_tilt_by_c_z_payload_factor_2
        + backward_tilt_by_theta_pan_factor * gravity_cos_tilt_by_c_x_payload_sin_tilt)
    gp[3, 11] = -accel_pan_by_b_pan * mass_pan_tilt  # holding_tilt_by_b_pan
    # forward_tilt_by_b_pan
    gp[4, 11] = forward_tilt_by_theta_pan_factor * load_torque_tilt_by_b_pan
    # backward_tilt_by_b_pan
    gp[5, 11] = backward_tilt_by_theta_pan_factor * load_torque_tilt_by_b_pan
    gp[3, 12] = -accel_pan_by_b_tilt * mass_pan_tilt - omega_tilt  # holding_tilt_by_b_tilt
    gp[4, 12] = -forward_tilt_by_theta_pan_factor * omega_tilt  # forward_tilt_by_b_tilt
    gp[5, 12] = -backward_tilt_by_theta_pan_factor * omega_tilt  # backward_tilt_by_b_tilt
    gp[1, 14] = a_F_s_pan + 1.0  # forward_pan_by_F_s_pan
    gp[2, 14] = 1.0 - a_F_s_pan  # backward_pan_by_F_s_pan
    gp[1, 18] = F_s_pan  # forward_pan_by_a_F_s_pan
    gp[2, 18] = -F_s_pan  # backward_pan_by_a_F_s_pan
    gp[0, 21] = balance_gear_pan_by_gap_pan  # holding_pan_by_gap_pan
    gp[3, 21] = -accel_pan_by_gap_pan * mass_pan_tilt  # holding_tilt_by_gap_pan
    # forward_tilt_by_gap_pan
    gp[4, 21] = forward_tilt_by_theta_pan_factor * load_torque_tilt_by_gap_pan
    # backward_tilt_by_gap_pan
    gp[5, 21] = backward_tilt_by_theta_pan_factor * load_torque_tilt_by_gap_pan
    gp[7, 21] = 0.5  # half_gap_pan_by_gap_pan
    lower_pan_by_gap_pan = 0.5 * k_shaft_pan
    gp[8, 21] = -lower_pan_by_gap_pan  # upper_pan_by_gap_pan
    gp[9, 21] = lower_pan_by_gap_pan
    gp[0, 22] = balance_gear_pan_by_k_shaft_pan  # holding_pan_by_k_shaft_pan
    gp[3, 22] = -accel_pan_by_k_shaft_pan * mass_pan_tilt  # holding_tilt_by_k_shaft_pan
    # forward_tilt_by_k_shaft_pan
    gp[4, 22] = forward_tilt_by_theta_pan_factor * load_torque_tilt_by_k_shaft_pan
    # backward_tilt_by_k_shaft_pan
    gp[5, 22] = backward_tilt_by_theta_pan_factor * load_torque_tilt_by_k_shaft_pan
    gp[8, 22] = -half_gap_pan - theta_pan_minus_theta_gear_pan  # upper_pan_by_k_shaft_pan
    gp[9, 22] = half_gap_pan + theta_gear_pan - theta_pan  # lower_pan_by_k_shaft_pan
    gp[0, 23] = balance_gear_pan_by_d_shaft_pan  # holding_pan_by_d_shaft_pan
    gp[3, 23] = -accel_pan_by_d_shaft_pan * mass_pan_tilt  # holding_tilt_by_d_shaft_pan
    # forward_tilt_by_d_shaft_pan
    gp[4, 23] = forward_tilt_by_theta_pan_factor * load_torque_tilt_by_d_shaft_pan
    # backward_tilt_by_d_shaft_pan
    gp[5, 23] = backward_tilt_by_theta_pan_factor * load_torque_tilt_by_d_shaft_pan
    gp[8, 23] = upper_pan_by_d_shaft_pan
    gp[9, 23] = upper_pan_by_d_shaft_pan  # lower_pan_by_d_shaft_pan
    gp[0, 26] = balance_gear_pan_by_K_t_pan  # holding_pan_by_K_t_pan
    gp[0, 28] = K_t_pan * i_pan  # holding_pan_by_N_pan
    # holding_tilt_by_K_t_tilt
    gp[3, 31] = -accel_pan_by_K_t_tilt * mass_pan_tilt + i_tilt * ratio_tilt
    # holding_tilt_by_J_motor_tilt
    gp[3, 32] = -accel_pan_by_J_motor_tilt * mass_pan_tilt - driving_torque_tilt_factor
    # holding_tilt_by_b_motor_tilt
    gp[3, 33] = -accel_pan_by_b_motor_tilt * mass_pan_tilt - omega_tilt_ratio_tilt_sq
    # holding_tilt_by_N_tilt
    gp[3, 34] = (-J_motor_tilt_ratio_tilt_omega_tilt_sq * ratio_tilt_by_theta_tilt_by_N_tilt
        - accel_pan_by_N_tilt * mass_pan_tilt + force_tilt_by_ratio_tilt * ratio_tilt_by_N_tilt)
    gp[3, 35] = (-J_motor_tilt_ratio_tilt_omega_tilt_sq * ratio_tilt_by_theta_tilt_by_lead_tilt
        - accel_pan_by_lead_tilt * mass_pan_tilt
        + force_tilt_by_ratio_tilt * ratio_tilt_by_lead_tilt)  # holding_tilt_by_lead_tilt
    half_load_torque_tilt = 0.5 * load_torque_tilt
    half_abs_load_torque_tilt = 0.5 * abs(load_torque_tilt)
    forward_tilt_by_lead_tilt_factor = -half_abs_load_torque_tilt - half_load_torque_tilt
    forward_tilt_by_lead_tilt_factor_2 = half_abs_load_torque_tilt - half_load_torque_tilt
    # forward_tilt_by_lead_tilt
    gp[4, 35] = (forward_tilt_by_lead_tilt_factor * lowered_tilt_by_lead_tilt
        + forward_tilt_by_lead_tilt_factor_2 * raised_tilt_by_lead_tilt)
    # backward_tilt_by_lead_tilt
    gp[5, 35] = (-forward_tilt_by_lead_tilt_factor * raised_tilt_by_lead_tilt
        - forward_tilt_by_lead_tilt_factor_2 * lowered_tilt_by_lead_tilt)
    gp[3, 36] = -accel_pan_by_d_screw_tilt * mass_pan_tilt  # holding_tilt_by_d_screw_tilt
    # forward_tilt_by_d_screw_tilt
    gp[4, 36] = (forward_tilt_by_lead_tilt_factor * lowered_tilt_by_d_screw_tilt
        + forward_tilt_by_lead_tilt_factor_2 * raised_tilt_by_d_screw_tilt)
    # backward_tilt_by_d_screw_tilt
    gp[5, 36] = (-forward_tilt_by_lead_tilt_factor * raised_tilt_by_d_screw_tilt
        - forward_tilt_by_lead_tilt_factor_2 * lowered_tilt_by_d_screw_tilt)
    gp[3, 37] = -accel_pan_by_f_screw_tilt * mass_pan_tilt  # holding_tilt_by_f_screw_tilt
    # forward_tilt_by_f_screw_tilt
    gp[4, 37] = (forward_tilt_by_lead_tilt_factor * lowered_tilt_by_f_screw_tilt
        + forward_tilt_by_lead_tilt_factor_2 * raised_tilt_by_f_screw_tilt)
    # backward_tilt_by_f_screw_tilt
    gp[5, 37] = (-forward_tilt_by_lead_tilt_factor * raised_tilt_by_f_screw_tilt
        - forward_tilt_by_lead_tilt_factor_2 * lowered_tilt_by_f_screw_tilt)
    gp[3, 38] = (-J_motor_tilt_ratio_tilt_omega_tilt_sq * ratio_tilt_by_theta_tilt_by_l_ground_tilt
        - accel_pan_by_l_ground_tilt * mass_pan_tilt
        + driving_torque_tilt_by_linkage_cos_tilt * linkage_cos_tilt_by_l_ground_tilt
        + driving_torque_tilt_by_linkage_sin_tilt * linkage_sin_tilt_by_l_ground_tilt
        + force_tilt_by_ratio_tilt * ratio_tilt_by_l_ground_tilt)  # holding_tilt_by_l_ground_tilt
    holding_tilt_by_l_min_tilt = (-accel_pan_by_l_min_tilt * mass_pan_tilt
        + driving_torque_tilt_by_linkage_cos_tilt * linkage_cos_tilt_by_l_min_tilt
        + driving_torque_tilt_by_linkage_sin_tilt * linkage_sin_tilt_by_l_min_tilt)
    gp[3, 39] = holding_tilt_by_l_min_tilt
    gp[3, 40] = (-J_motor_tilt_ratio_tilt_omega_tilt_sq * ratio_tilt_by_theta_tilt_by_r_arm_tilt
        - accel_pan_by_r_arm_tilt * mass_pan_tilt
        + driving_torque_tilt_by_linkage_cos_tilt * linkage_cos_tilt_by_r_arm_tilt
        + driving_torque_tilt_by_linkage_sin_tilt * linkage_sin_tilt_by_r_arm_tilt
        + force_tilt_by_ratio_tilt * ratio_tilt_by_r_arm_tilt)  # holding_tilt_by_r_arm_tilt
    gp[3, 41] = holding_tilt_by_l_min_tilt  # holding_tilt_by_s_start_tilt
    gp[3, 43] = (-accel_pan_by_gravity * mass_pan_tilt + cos_tilt * gravity_cos_tilt_by_gravity
        + gravity_sin_tilt_by_gravity * sin_tilt)  # holding_tilt_by_gravity
    cos_tilt_gravity_cos_tilt_by_gravity = cos_tilt * gravity_cos_tilt_by_gravity
    gravity_sin_tilt_by_gravity_sin_tilt = gravity_sin_tilt_by_gravity * sin_tilt
    # forward_tilt_by_gravity
    gp[4, 43] = (cos_tilt_gravity_cos_tilt_by_gravity * forward_tilt_by_theta_pan_factor
        + forward_tilt_by_theta_pan_factor * gravity_sin_tilt_by_gravity_sin_tilt)
    # backward_tilt_by_gravity
    gp[5, 43] = (backward_tilt_by_theta_pan_factor * cos_tilt_gravity_cos_tilt_by_gravity
        + backward_tilt_by_theta_pan_factor * gravity_sin_tilt_by_gravity_sin_tilt)


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def outputs(t, x, u, p, y):
    """Write the measured signals into y.

    t, x [8], u [2], p [44]; y [4] in OUTPUT_UNITS.
    """
    theta_pan, theta_tilt, i_pan, i_tilt = x[0], x[1], x[6], x[7]
    y[0] = theta_pan  # reading_theta_pan
    y[1] = theta_tilt  # reading_theta_tilt
    y[2] = i_pan  # reading_i_pan
    y[3] = i_tilt  # reading_i_tilt


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def output_jacobian(t, x, u, p, yx, yp):
    """Write the non-zero derivatives of outputs by state and parameter.

    t, x [8], u [2], p [44]; yx [4, 8]; yp [4, 44].
    """
    yx[0, 0] = 1.0  # reading_theta_pan_by_theta_pan
    yx[1, 1] = 1.0  # reading_theta_tilt_by_theta_tilt
    yx[2, 6] = 1.0  # reading_i_pan_by_i_pan
    yx[3, 7] = 1.0  # reading_i_tilt_by_i_tilt


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def domain(p, bounds):
    """Write lower and upper bound of the state of every row of DOMAIN into bounds.

    p [44]; bounds [2, 2] in STATE_UNITS: lower, upper.
    """
    l_ground_tilt, l_min_tilt, r_arm_tilt, s_start_tilt = p[38], p[39], p[40], p[41]
    s_max_tilt = p[42]
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

    p [44]; margin [4] in units of what is compared.
    """
    F_c_pan, F_s_pan, lead_tilt, d_screw_tilt, f_screw_tilt = p[13], p[14], p[35], p[36], p[37]
    l_ground_tilt, l_min_tilt, r_arm_tilt, s_start_tilt = p[38], p[39], p[40], p[41]
    s_max_tilt = p[42]
    margin[0] = -F_c_pan + F_s_pan  # requirement_0
    # requirement_1
    margin[1] = (2.0 * l_ground_tilt * r_arm_tilt - abs((l_ground_tilt * l_ground_tilt)
        + (r_arm_tilt * r_arm_tilt) - ((l_min_tilt + s_start_tilt) * (l_min_tilt + s_start_tilt))))
    margin[2] = s_max_tilt - s_start_tilt  # requirement_2
    margin[3] = math.pi * d_screw_tilt - f_screw_tilt * lead_tilt  # requirement_3


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
    omega_tilt, omega_gear_pan = x[3], x[5]
    g = guard_values(t, x, u, p, 0.0, 0.0, 0.0, 0.0)
    side_pan, active_pan = touching(g[6], g[7], g[8], g[9])
    slide_pan, slide_tilt = np.sign(omega_gear_pan), np.sign(omega_tilt)
    g = guard_values(t, x, u, p, slide_pan, slide_tilt, side_pan, active_pan)
    slide_pan = breaking_away(slide_pan, g[0], g[1], g[2])
    slide_tilt = breaking_away(slide_tilt, g[3], g[4], g[5])
    return slide_pan, slide_tilt, side_pan, active_pan


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def initial_modes(t, x, u, p, m):
    """Write the modes that a state implies into m; see MODE_NAMES."""
    m[0], m[1], m[2], m[3] = implied_modes(t, x, u, p)


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
    (("F_c_pan", "F_s_pan"), "F_s is at least F_c; raise F_s or lower F_c", False),
    (("l_ground_tilt", "l_min_tilt", "r_arm_tilt", "s_start_tilt"),
     "the linkage closes, off its dead centres; change a length", True),
    (("s_start_tilt", "s_max_tilt"), "s_start is at most s_max; change one of them", False),
    (("lead_tilt", "d_screw_tilt", "f_screw_tilt"),
     "the screw wedges unless f < pi d / lead; lower f_screw", True),
)
# Searching them: name, value at which the effect vanishes (None: any), starts,
# period, what a frequency is locked to.
SEARCH = (
    ("b_pan", 0.0, (0.1,), None, None),
    ("b_tilt", 0.0, (0.1,), None, None),
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
    ("linear_actuator", "tilt", ("L_tilt", "R_tilt", "K_t_tilt", "J_motor_tilt", "b_motor_tilt",
     "N_tilt", "lead_tilt", "d_screw_tilt", "f_screw_tilt", "l_ground_tilt", "l_min_tilt",
     "r_arm_tilt", "s_start_tilt", "s_max_tilt"), (), (),
     "linear actuator with lead screw and linkage",
     "thesis Eq. 3.10, 3.12 and 3.2.3.2 with errata 9 and 10, Tables 5.5, 5.6", "", False),
)
# END sha256 6db363fff21320604458ce63c6ffa294b0ac8fd7bc83e02d983cd74b810e2494
