"""Both axes of the thesis, all drives: equations of motion, emitted; do not edit.

M(q) q'' = forcing - friction, with the lower triangle of M by symmetry:

  M[0, 0] = J_pan + J_x_payload*sin(theta_tilt)**2 + J_x_tilt*sin(theta_tilt)**2 +
      J_z_payload*cos(theta_tilt)**2 + J_z_tilt*cos(theta_tilt)**2 +
      c_x_payload**2*m_payload*cos(theta_tilt)**2 +
      2*c_x_payload*c_z_payload*m_payload*sin(theta_tilt)*cos(theta_tilt) +
      c_y_payload**2*m_payload*sin(theta_tilt)**2 + c_y_payload**2*m_payload*cos(theta_tilt)**2
      + c_z_payload**2*m_payload*sin(theta_tilt)**2
  M[0, 1] = c_x_payload*c_y_payload*m_payload*sin(theta_tilt) -
      c_y_payload*c_z_payload*m_payload*cos(theta_tilt)
  M[1, 1] = J_motor_tilt*ratio_tilt**2 + J_y_payload + J_y_tilt + c_x_payload**2*m_payload +
      c_z_payload**2*m_payload
  M[2, 2] = J_motor_pan*N_pan**2
  forcing[omega_pan] = -2*J_x_payload*omega_pan*omega_tilt*sin(theta_tilt)*cos(theta_tilt) -
      2*J_x_tilt*omega_pan*omega_tilt*sin(theta_tilt)*cos(theta_tilt) +
      2*J_z_payload*omega_pan*omega_tilt*sin(theta_tilt)*cos(theta_tilt) +
      2*J_z_tilt*omega_pan*omega_tilt*sin(theta_tilt)*cos(theta_tilt) +
      active_pan*(d_shaft_pan*(omega_gear_pan - omega_pan) + k_shaft_pan*(-gap_pan*side_pan/2 +
      theta_gear_pan - theta_pan)) - b_pan*omega_pan +
      2*c_x_payload**2*m_payload*omega_pan*omega_tilt*sin(theta_tilt)*cos(theta_tilt) -
      c_x_payload*c_y_payload*m_payload*omega_tilt**2*cos(theta_tilt) +
      2*c_x_payload*c_z_payload*m_payload*omega_pan*omega_tilt*sin(theta_tilt)**2 -
      2*c_x_payload*c_z_payload*m_payload*omega_pan*omega_tilt*cos(theta_tilt)**2 -
      c_y_payload*c_z_payload*m_payload*omega_tilt**2*sin(theta_tilt) -
      2*c_z_payload**2*m_payload*omega_pan*omega_tilt*sin(theta_tilt)*cos(theta_tilt)
  forcing[omega_tilt] = -J_motor_tilt*omega_tilt**2*ratio_tilt*ratio_tilt_by_theta_tilt +
      J_x_payload*omega_pan**2*sin(theta_tilt)*cos(theta_tilt) +
      J_x_tilt*omega_pan**2*sin(theta_tilt)*cos(theta_tilt) -
      J_z_payload*omega_pan**2*sin(theta_tilt)*cos(theta_tilt) -
      J_z_tilt*omega_pan**2*sin(theta_tilt)*cos(theta_tilt) - b_tilt*omega_tilt -
      c_x_payload**2*m_payload*omega_pan**2*sin(theta_tilt)*cos(theta_tilt) -
      c_x_payload*c_z_payload*m_payload*omega_pan**2*sin(theta_tilt)**2 +
      c_x_payload*c_z_payload*m_payload*omega_pan**2*cos(theta_tilt)**2 +
      981*c_x_payload*m_payload*cos(theta_tilt)/100 +
      c_z_payload**2*m_payload*omega_pan**2*sin(theta_tilt)*cos(theta_tilt) +
      981*c_z_payload*m_payload*sin(theta_tilt)/100 + ratio_tilt*(K_t_tilt*i_tilt -
      b_motor_tilt*omega_tilt*ratio_tilt)
  forcing[omega_gear_pan] = K_t_pan*N_pan*i_pan - active_pan*(d_shaft_pan*(omega_gear_pan -
      omega_pan) + k_shaft_pan*(-gap_pan*side_pan/2 + theta_gear_pan - theta_pan))
  linkage_cos_tilt = l_ground_tilt**2 + r_arm_tilt**2 - (l_min_tilt + s_start_tilt)**2
  linkage_sin_tilt = sqrt(4*l_ground_tilt**2*r_arm_tilt**2 - linkage_cos_tilt**2)
  length_tilt = sqrt(l_ground_tilt**2 - linkage_cos_tilt*cos(theta_tilt) -
      linkage_sin_tilt*sin(theta_tilt) + r_arm_tilt**2)
  length_tilt_by_theta_tilt = (linkage_cos_tilt*sin(theta_tilt)/2 -
      linkage_sin_tilt*cos(theta_tilt)/2)/sqrt(l_ground_tilt**2 -
      linkage_cos_tilt*cos(theta_tilt) - linkage_sin_tilt*sin(theta_tilt) + r_arm_tilt**2)
  ratio_tilt = pi*N_tilt*(linkage_cos_tilt*sin(theta_tilt) -
      linkage_sin_tilt*cos(theta_tilt))/(lead_tilt*length_tilt)
  ratio_tilt_by_theta_tilt = pi*N_tilt*(linkage_cos_tilt*cos(theta_tilt) +
      linkage_sin_tilt*sin(theta_tilt))/(lead_tilt*length_tilt) -
      pi*N_tilt*length_tilt_by_theta_tilt*(linkage_cos_tilt*sin(theta_tilt) -
      linkage_sin_tilt*cos(theta_tilt))/(lead_tilt*length_tilt**2)
  follower_coupling_tilt = c_x_payload*c_y_payload*m_payload*sin(theta_tilt) -
      c_y_payload*c_z_payload*m_payload*cos(theta_tilt)
  follower_inertia_tilt = J_pan + J_x_payload*sin(theta_tilt)**2 + J_x_tilt*sin(theta_tilt)**2 +
      J_z_payload*cos(theta_tilt)**2 + J_z_tilt*cos(theta_tilt)**2 +
      c_x_payload**2*m_payload*cos(theta_tilt)**2 +
      2*c_x_payload*c_z_payload*m_payload*sin(theta_tilt)*cos(theta_tilt) +
      c_y_payload**2*m_payload*sin(theta_tilt)**2 + c_y_payload**2*m_payload*cos(theta_tilt)**2
      + c_z_payload**2*m_payload*sin(theta_tilt)**2
  follower_torque_tilt = -2*J_x_payload*omega_pan*omega_tilt*sin(theta_tilt)*cos(theta_tilt) -
      2*J_x_tilt*omega_pan*omega_tilt*sin(theta_tilt)*cos(theta_tilt) +
      2*J_z_payload*omega_pan*omega_tilt*sin(theta_tilt)*cos(theta_tilt) +
      2*J_z_tilt*omega_pan*omega_tilt*sin(theta_tilt)*cos(theta_tilt) +
      active_pan*(d_shaft_pan*(omega_gear_pan - omega_pan) + k_shaft_pan*(-gap_pan*side_pan/2 +
      theta_gear_pan - theta_pan)) - b_pan*omega_pan +
      2*c_x_payload**2*m_payload*omega_pan*omega_tilt*sin(theta_tilt)*cos(theta_tilt) -
      c_x_payload*c_y_payload*m_payload*omega_tilt**2*cos(theta_tilt) +
      2*c_x_payload*c_z_payload*m_payload*omega_pan*omega_tilt*sin(theta_tilt)**2 -
      2*c_x_payload*c_z_payload*m_payload*omega_pan*omega_tilt*cos(theta_tilt)**2 -
      c_y_payload*c_z_payload*m_payload*omega_tilt**2*sin(theta_tilt) -
      2*c_z_payload**2*m_payload*omega_pan*omega_tilt*sin(theta_tilt)*cos(theta_tilt)
  driving_torque_tilt = -J_motor_tilt*omega_tilt**2*ratio_tilt*ratio_tilt_by_theta_tilt +
      ratio_tilt*(K_t_tilt*i_tilt - b_motor_tilt*omega_tilt*ratio_tilt)
  load_torque_tilt = J_x_payload*omega_pan**2*sin(theta_tilt)*cos(theta_tilt) +
      J_x_tilt*omega_pan**2*sin(theta_tilt)*cos(theta_tilt) -
      J_z_payload*omega_pan**2*sin(theta_tilt)*cos(theta_tilt) -
      J_z_tilt*omega_pan**2*sin(theta_tilt)*cos(theta_tilt) - b_tilt*omega_tilt -
      c_x_payload**2*m_payload*omega_pan**2*sin(theta_tilt)*cos(theta_tilt) -
      c_x_payload*c_z_payload*m_payload*omega_pan**2*sin(theta_tilt)**2 +
      c_x_payload*c_z_payload*m_payload*omega_pan**2*cos(theta_tilt)**2 +
      981*c_x_payload*m_payload*cos(theta_tilt)/100 +
      c_z_payload**2*m_payload*omega_pan**2*sin(theta_tilt)*cos(theta_tilt) +
      981*c_z_payload*m_payload*sin(theta_tilt)/100 -
      follower_coupling_tilt*follower_torque_tilt/follower_inertia_tilt
  load_inertia_tilt = J_y_payload + J_y_tilt + c_x_payload**2*m_payload +
      c_z_payload**2*m_payload - follower_coupling_tilt**2/follower_inertia_tilt
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

Operations of the state derivative: 701 as derived, 323 as written.

Effects:
- rigid_bodies: thesis Eq. 3.8, Table 5.1
- payload: thesis section 3.2.2, Table 5.3 with erratum 18
- viscous_friction (pan): thesis Eq. 2.8, Eq. 3.8 (b_p, b_t)
- dc_motor (pan): thesis Eq. 3.10, Eq. 3.11 with erratum 8
- shaft_compliance (pan): thesis Eq. 2.15 with erratum 4, Table 5.7
- backlash (pan): thesis Eq. 2.16 (dead zone), Table 5.7; contact that cannot pull
- csvs_friction (pan): thesis Eq. 2.10, 2.11 with errata 2 and 3, Eq. 4.1, exponent 2
- direction_dependent_friction (pan): thesis Tables 4.1 and 4.2 (omega > 0, omega < 0)
- viscous_friction (tilt): thesis Eq. 2.8, Eq. 3.8 (b_p, b_t)
- linear_actuator (tilt): thesis Eq. 3.10, 3.12 and 3.2.3.2 with errata 9 and 10, Tables 5.5, 5.6
"""

import math

import numpy as np
from numba import njit

MODEL_HASH = "77602c671e6cc439"
NAME = "full"
TITLE = "Both axes of the thesis, all drives"
AXES = ("pan", "tilt")
STATE_NAMES = (
    "theta_pan",
    "theta_tilt",
    "omega_pan",
    "omega_tilt",
    "theta_gear_pan",
    "omega_gear_pan",
    "i_pan",
    "i_tilt",
)
STATE_UNITS = ("rad", "rad", "rad/s", "rad/s", "rad", "rad/s", "A", "A")
STATE_INITIAL = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
INPUT_NAMES = ("u_pan", "u_tilt")
INPUT_UNITS = ("V", "V")
# Per input: index of the parameter by which it is late, or -1.
INPUT_DELAYS = (-1, -1)
OUTPUT_NAMES = ("theta_pan", "theta_tilt", "i_pan", "i_tilt")
OUTPUT_UNITS = ("rad", "rad", "A", "A")
MODE_NAMES = ("slide_pan", "slide_tilt", "side_pan", "active_pan")
FRICTION_RATES = np.array([5, 3], dtype=np.int64)
# Per state: the friction that sets it to zero when it comes to rest, or -1.
ZERO_AT_REST = (-1, -1, -1, -1, -1, -1, -1, -1)
# Per contact: state index of the angle at the gear output and at the joint.
CONTACT_ANGLES = ((4, 0),)
# Limits of the equations: state, meaning; `domain` gives the bounds.
DOMAIN = (
    ("theta_tilt", "dead centre of the tilt linkage"),
    ("theta_tilt", "stroke end of the tilt actuator"),
)
# Relations: parameters, rule, strict; `margins` gives what is at least zero.
REQUIREMENTS = (
    (("F_c_pan", "F_s_pan"), "F_s is at least F_c; raise F_s or lower F_c", False),
    (
        ("l_ground_tilt", "l_min_tilt", "r_arm_tilt", "s_start_tilt"),
        "the linkage closes, off its dead centres; change a length",
        True,
    ),
    (("s_start_tilt", "s_max_tilt"), "s_start is at most s_max; change one of them", False),
    (
        ("lead_tilt", "d_screw_tilt", "f_screw_tilt"),
        "the screw wedges unless f < pi d / lead; lower f_screw",
        True,
    ),
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
    ("L_pan", "H", 0.0069, 1e-09, 1000.0, "winding inductance"),
    ("R_pan", "ohm", 12.9, 1e-06, 1000000.0, "winding resistance"),
    ("K_t_pan", "N m/A", 0.0724, 1e-09, 10000.0, "torque constant"),
    ("J_motor_pan", "kg m^2", 1.1e-05, 1e-12, 1000.0, "rotor inertia"),
    ("N_pan", "1", 500.0, 0.001, 1000000.0, "gear ratio"),
    ("k_shaft_pan", "N m/rad", 5000.0, 0.001, 1000000000.0, "shaft stiffness"),
    ("d_shaft_pan", "N m s/rad", 1.0, 0.0, 1000000.0, "shaft damping"),
    ("gap_pan", "rad", 0.02600540585471551, 0.0, 1.0, "whole gap between the two faces"),
    ("F_c_pan", "N m", 0.2401, 0.0, 10000.0, "Coulomb friction torque"),
    ("F_s_pan", "N m", 0.675, 0.0, 10000.0, "static (breakaway) friction torque"),
    ("v_s_pan", "rad/s", 0.016, 1e-06, 1000.0, "Stribeck speed"),
    ("F_v_pan", "N m s/rad", 13.9424, 0.0, 10000.0, "viscous part"),
    (
        "a_F_c_pan",
        "1",
        -0.05581007913369427,
        -0.95,
        0.95,
        "relative half difference of Coulomb friction",
    ),
    (
        "a_F_s_pan",
        "1",
        -0.17362962962962966,
        -0.95,
        0.95,
        "relative half difference of static friction",
    ),
    (
        "a_v_s_pan",
        "1",
        -0.006249999999999962,
        -0.95,
        0.95,
        "relative half difference of Stribeck speed",
    ),
    (
        "a_F_v_pan",
        "1",
        -0.025677071379389464,
        -0.95,
        0.95,
        "relative half difference of viscous friction",
    ),
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
)
# Searching them: name, value at which the effect vanishes (None: any), starts,
# period, what a frequency is locked to.
SEARCH = (
    ("b_pan", 0.0, (0.1,), None, None),
    ("gap_pan", 0.0, (0.005, 0.02), None, None),
    ("F_c_pan", 0.0, (0.05,), None, None),
    ("F_s_pan", 0.0, (0.05,), None, None),
    ("v_s_pan", None, (0.05,), None, None),
    ("F_v_pan", 0.0, (0.0,), None, None),
    ("a_F_c_pan", 0.0, (-0.1, 0.1), None, None),
    ("a_F_s_pan", 0.0, (0.0,), None, None),
    ("a_v_s_pan", 0.0, (0.0,), None, None),
    ("a_F_v_pan", 0.0, (0.0,), None, None),
    ("b_tilt", 0.0, (0.1,), None, None),
)
# Effects: id, axis, parameters, title, reference, separating experiment.
EFFECTS = (
    (
        "rigid_bodies",
        None,
        ("J_pan", "J_x_tilt", "J_y_tilt", "J_z_tilt"),
        "pan body and tilt body",
        "thesis Eq. 3.8, Table 5.1",
        "",
    ),
    (
        "payload",
        None,
        (
            "m_payload",
            "J_x_payload",
            "J_y_payload",
            "J_z_payload",
            "c_x_payload",
            "c_y_payload",
            "c_z_payload",
        ),
        "payload",
        "thesis section 3.2.2, Table 5.3 with erratum 18",
        "",
    ),
    (
        "viscous_friction",
        "pan",
        ("b_pan",),
        "viscous friction in the joint",
        "thesis Eq. 2.8, Eq. 3.8 (b_p, b_t)",
        "Run at six or more steady speeds, the slowest near the Stribeck speed.",
    ),
    (
        "dc_motor",
        "pan",
        ("L_pan", "R_pan", "K_t_pan", "J_motor_pan", "N_pan"),
        "geared DC motor",
        "thesis Eq. 3.10, Eq. 3.11 with erratum 8",
        "",
    ),
    (
        "shaft_compliance",
        "pan",
        ("k_shaft_pan", "d_shaft_pan"),
        "flexible shaft",
        "thesis Eq. 2.15 with erratum 4, Table 5.7",
        "",
    ),
    (
        "backlash",
        "pan",
        ("gap_pan",),
        "backlash",
        "thesis Eq. 2.16 (dead zone), Table 5.7; contact that cannot pull",
        "Reverse slowly with and without a known preload torque on the joint: backlash "
        "disappears under preload, presliding does not.",
    ),
    (
        "csvs_friction",
        "pan",
        ("F_c_pan", "F_s_pan", "v_s_pan", "F_v_pan"),
        "Coulomb, static, viscous and Stribeck friction",
        "thesis Eq. 2.10, 2.11 with errata 2 and 3, Eq. 4.1, exponent 2",
        "Crawl through standstill in both directions at several slow speeds.",
    ),
    (
        "direction_dependent_friction",
        "pan",
        ("a_F_c_pan", "a_F_s_pan", "a_v_s_pan", "a_F_v_pan"),
        "friction that differs by direction",
        "thesis Tables 4.1 and 4.2 (omega > 0, omega < 0)",
        "Run the same speeds both ways at two supply polarities, or back-drive the joint "
        "without power: friction follows the motion, an offset does not.",
    ),
    (
        "viscous_friction",
        "tilt",
        ("b_tilt",),
        "viscous friction in the joint",
        "thesis Eq. 2.8, Eq. 3.8 (b_p, b_t)",
        "Run at six or more steady speeds, the slowest near the Stribeck speed.",
    ),
    (
        "linear_actuator",
        "tilt",
        (
            "L_tilt",
            "R_tilt",
            "K_t_tilt",
            "J_motor_tilt",
            "b_motor_tilt",
            "N_tilt",
            "lead_tilt",
            "d_screw_tilt",
            "f_screw_tilt",
            "l_ground_tilt",
            "l_min_tilt",
            "r_arm_tilt",
            "s_start_tilt",
            "s_max_tilt",
        ),
        "linear actuator with lead screw and linkage",
        "thesis Eq. 3.10, 3.12 and 3.2.3.2 with errata 9 and 10, Tables 5.5, 5.6",
        "",
    ),
)


@njit(cache=True, error_model="numpy", nogil=True)
def mode_derivative(t, x, u, p, m, dx):
    """Write the time derivative of the state into dx in the modes m."""
    theta_pan = x[0]
    theta_tilt = x[1]
    omega_pan = x[2]
    omega_tilt = x[3]
    theta_gear_pan = x[4]
    omega_gear_pan = x[5]
    i_pan = x[6]
    i_tilt = x[7]
    u_pan = u[0]
    u_tilt = u[1]
    J_pan = p[0]
    J_x_tilt = p[1]
    J_y_tilt = p[2]
    J_z_tilt = p[3]
    m_payload = p[4]
    J_x_payload = p[5]
    J_y_payload = p[6]
    J_z_payload = p[7]
    c_x_payload = p[8]
    c_y_payload = p[9]
    c_z_payload = p[10]
    b_pan = p[11]
    L_pan = p[12]
    R_pan = p[13]
    K_t_pan = p[14]
    J_motor_pan = p[15]
    N_pan = p[16]
    k_shaft_pan = p[17]
    d_shaft_pan = p[18]
    gap_pan = p[19]
    F_c_pan = p[20]
    F_s_pan = p[21]
    v_s_pan = p[22]
    F_v_pan = p[23]
    a_F_c_pan = p[24]
    a_F_s_pan = p[25]
    a_v_s_pan = p[26]
    a_F_v_pan = p[27]
    b_tilt = p[28]
    L_tilt = p[29]
    R_tilt = p[30]
    K_t_tilt = p[31]
    J_motor_tilt = p[32]
    b_motor_tilt = p[33]
    N_tilt = p[34]
    lead_tilt = p[35]
    d_screw_tilt = p[36]
    f_screw_tilt = p[37]
    l_ground_tilt = p[38]
    l_min_tilt = p[39]
    r_arm_tilt = p[40]
    s_start_tilt = p[41]
    slide_pan = m[0]
    slide_tilt = m[1]
    side_pan = m[2]
    active_pan = m[3]
    dx[0] = omega_pan
    dx[1] = omega_tilt
    part_of_inertia_pan_sin_cos_tilt = c_x_payload * c_z_payload * m_payload
    part_of_inertia_pan_sin_cos_tilt_2 = 2.0 * part_of_inertia_pan_sin_cos_tilt
    inertia_pan_sin_cos_tilt = part_of_inertia_pan_sin_cos_tilt_2
    c_x_payload_sq = c_x_payload * c_x_payload
    c_x_payload_sq_m_payload = c_x_payload_sq * m_payload
    part_of_inertia_pan_sin_sq_tilt = (c_z_payload * c_z_payload) * m_payload
    inertia_pan_sin_sq_tilt = (
        J_x_payload
        + J_x_tilt
        - J_z_payload
        - J_z_tilt
        - c_x_payload_sq_m_payload
        + part_of_inertia_pan_sin_sq_tilt
    )
    cos_tilt = math.cos(theta_tilt)
    sin_tilt = math.sin(theta_tilt)
    inertia_pan_per_sin_tilt = (
        cos_tilt * inertia_pan_sin_cos_tilt + inertia_pan_sin_sq_tilt * sin_tilt
    )
    part_of_coriolis = 2.0 * cos_tilt
    coriolis = omega_pan * (inertia_pan_per_sin_tilt * part_of_coriolis - inertia_pan_sin_cos_tilt)
    c_y_payload_m_payload = c_y_payload * m_payload
    part_of_coupling_cos_tilt = c_y_payload_m_payload * c_z_payload
    coupling_cos_tilt = part_of_coupling_cos_tilt
    part_of_coupling_sin_tilt = c_x_payload * c_y_payload_m_payload
    coupling_sin_tilt = part_of_coupling_sin_tilt
    part_of_force_pan = (active_pan) * (
        d_shaft_pan * (omega_gear_pan - omega_pan)
        + k_shaft_pan * (-0.5 * gap_pan * side_pan + theta_gear_pan - theta_pan)
    )
    part_of_force_pan_2 = b_pan * omega_pan - part_of_force_pan
    force_pan = (
        -omega_tilt
        * (coriolis + omega_tilt * (cos_tilt * coupling_sin_tilt + coupling_cos_tilt * sin_tilt))
        - part_of_force_pan_2
    )
    part_of_gravity_cos_tilt = (9.81) * m_payload
    part_of_gravity_cos_tilt_2 = c_x_payload * part_of_gravity_cos_tilt
    gravity_cos_tilt = part_of_gravity_cos_tilt_2
    part_of_gravity_sin_tilt = c_z_payload * part_of_gravity_cos_tilt
    gravity_sin_tilt = part_of_gravity_sin_tilt
    follower_coupling_tilt = (
        -cos_tilt * part_of_coupling_cos_tilt + part_of_coupling_sin_tilt * sin_tilt
    )
    part_of_load_inertia_tilt = (
        J_y_payload + J_y_tilt + c_x_payload_sq_m_payload + part_of_inertia_pan_sin_sq_tilt
    )
    part_of_follower_inertia_tilt = (c_y_payload * c_y_payload) * m_payload
    sin_tilt_sq = sin_tilt * sin_tilt
    cos_tilt_sq = cos_tilt * cos_tilt
    part_of_coriolis_sin_tilt = part_of_coriolis * sin_tilt
    follower_inertia_tilt = (
        J_pan
        + J_x_payload * sin_tilt_sq
        + J_x_tilt * sin_tilt_sq
        + J_z_payload * cos_tilt_sq
        + J_z_tilt * cos_tilt_sq
        + c_x_payload_sq_m_payload * cos_tilt_sq
        + cos_tilt_sq * part_of_follower_inertia_tilt
        + part_of_coriolis_sin_tilt * part_of_inertia_pan_sin_cos_tilt
        + part_of_follower_inertia_tilt * sin_tilt_sq
        + part_of_inertia_pan_sin_sq_tilt * sin_tilt_sq
    )
    follower_inertia_tilt_inverse = 1.0 / follower_inertia_tilt
    load_inertia_tilt = (
        -(follower_coupling_tilt * follower_coupling_tilt) * follower_inertia_tilt_inverse
        + part_of_load_inertia_tilt
    )
    part_of_lowered_tilt = math.pi * d_screw_tilt
    f_screw_tilt_lead_tilt = f_screw_tilt * lead_tilt
    part_of_lowered_tilt_2 = f_screw_tilt * part_of_lowered_tilt
    lead_tilt_inverse = 1.0 / lead_tilt
    part_of_lowered_tilt_3 = lead_tilt_inverse * part_of_lowered_tilt
    lowered_tilt = (
        (-1.0)
        * (part_of_lowered_tilt_3)
        * (1.0 / (f_screw_tilt_lead_tilt + part_of_lowered_tilt))
        * (-lead_tilt + part_of_lowered_tilt_2)
    )
    l_ground_tilt_sq = l_ground_tilt * l_ground_tilt
    r_arm_tilt_sq = r_arm_tilt * r_arm_tilt
    part_of_linkage_cos_tilt = l_ground_tilt_sq + r_arm_tilt_sq
    linkage_cos_tilt = part_of_linkage_cos_tilt - (
        (l_min_tilt + s_start_tilt) * (l_min_tilt + s_start_tilt)
    )
    linkage_cos_tilt_sin_tilt = linkage_cos_tilt * sin_tilt
    linkage_sin_tilt = math.sqrt(
        4.0 * l_ground_tilt_sq * r_arm_tilt_sq - (linkage_cos_tilt * linkage_cos_tilt)
    )
    cos_tilt_linkage_sin_tilt = cos_tilt * linkage_sin_tilt
    part_of_ratio_tilt = -cos_tilt_linkage_sin_tilt + linkage_cos_tilt_sin_tilt
    cos_tilt_linkage_cos_tilt = cos_tilt * linkage_cos_tilt
    linkage_sin_tilt_sin_tilt = linkage_sin_tilt * sin_tilt
    part_of_length_tilt = math.sqrt(
        -cos_tilt_linkage_cos_tilt - linkage_sin_tilt_sin_tilt + part_of_linkage_cos_tilt
    )
    length_tilt = part_of_length_tilt
    part_of_ratio_tilt_2 = math.pi * N_tilt * lead_tilt_inverse / length_tilt
    ratio_tilt = part_of_ratio_tilt * part_of_ratio_tilt_2
    part_of_lost_lowering_tilt = J_motor_tilt * (ratio_tilt * ratio_tilt)
    lost_lowering_tilt = (1.0 - lowered_tilt) * (
        1.0 / (abs(load_inertia_tilt * lowered_tilt + part_of_lost_lowering_tilt))
    )
    raised_tilt = (
        (part_of_lowered_tilt_3)
        * (1.0 / (-f_screw_tilt_lead_tilt + part_of_lowered_tilt))
        * (lead_tilt + part_of_lowered_tilt_2)
    )
    lost_raising_tilt = (raised_tilt - 1.0) * (
        1.0 / (load_inertia_tilt * raised_tilt + part_of_lost_lowering_tilt)
    )
    length_tilt_by_theta_tilt = (1.0 / part_of_length_tilt) * (
        -0.5 * cos_tilt_linkage_sin_tilt + (0.5) * linkage_cos_tilt_sin_tilt
    )
    ratio_tilt_by_theta_tilt = (
        -math.pi * N_tilt * lead_tilt_inverse * length_tilt_by_theta_tilt * part_of_ratio_tilt
    ) / (length_tilt * length_tilt) + part_of_ratio_tilt_2 * (
        cos_tilt_linkage_cos_tilt + linkage_sin_tilt_sin_tilt
    )
    omega_tilt_sq = omega_tilt * omega_tilt
    part_of_driving_torque_tilt = (
        J_motor_tilt * omega_tilt_sq * ratio_tilt * ratio_tilt_by_theta_tilt
    )
    omega_tilt_ratio_tilt = omega_tilt * ratio_tilt
    part_of_driving_torque_tilt_2 = K_t_tilt * i_tilt - b_motor_tilt * omega_tilt_ratio_tilt
    minus_b_tilt_omega_tilt = -b_tilt * omega_tilt
    driving_torque_tilt = -part_of_driving_torque_tilt + part_of_driving_torque_tilt_2 * ratio_tilt
    J_x_payload_sin_tilt = J_x_payload * sin_tilt
    omega_pan_omega_tilt = omega_pan * omega_tilt
    part_of_follower_torque_tilt = omega_pan_omega_tilt * part_of_coriolis_sin_tilt
    follower_torque_tilt = (
        -J_x_payload_sin_tilt * omega_pan_omega_tilt * part_of_coriolis
        - J_x_tilt * part_of_follower_torque_tilt
        + 2.0 * J_z_payload * cos_tilt * omega_pan * omega_tilt * sin_tilt
        + 2.0 * J_z_tilt * cos_tilt * omega_pan * omega_tilt * sin_tilt
        + 2.0 * c_x_payload * c_z_payload * m_payload * omega_pan * omega_tilt * sin_tilt_sq
        + 2.0 * c_x_payload_sq * cos_tilt * m_payload * omega_pan * omega_tilt * sin_tilt
        - cos_tilt * omega_tilt_sq * part_of_coupling_sin_tilt
        - cos_tilt_sq * omega_pan_omega_tilt * part_of_inertia_pan_sin_cos_tilt_2
        - omega_tilt_sq * part_of_coupling_cos_tilt * sin_tilt
        - part_of_follower_torque_tilt * part_of_inertia_pan_sin_sq_tilt
        - part_of_force_pan_2
    )
    omega_pan_sq = omega_pan * omega_pan
    cos_tilt_omega_pan_sq = cos_tilt * omega_pan_sq
    cos_tilt_omega_pan_sq_sin_tilt = cos_tilt_omega_pan_sq * sin_tilt
    part_of_load_torque_tilt = omega_pan_sq * part_of_inertia_pan_sin_cos_tilt
    load_torque_tilt = (
        J_x_payload_sin_tilt * cos_tilt_omega_pan_sq
        + J_x_tilt * cos_tilt_omega_pan_sq_sin_tilt
        - J_z_payload * cos_tilt_omega_pan_sq_sin_tilt
        - J_z_tilt * cos_tilt_omega_pan_sq_sin_tilt
        - c_x_payload_sq_m_payload * cos_tilt_omega_pan_sq_sin_tilt
        + cos_tilt * part_of_gravity_cos_tilt_2
        + cos_tilt_omega_pan_sq_sin_tilt * part_of_inertia_pan_sin_sq_tilt
        + cos_tilt_sq * part_of_load_torque_tilt
        - follower_coupling_tilt * follower_inertia_tilt_inverse * follower_torque_tilt
        + minus_b_tilt_omega_tilt
        + part_of_gravity_sin_tilt * sin_tilt
        - part_of_load_torque_tilt * sin_tilt_sq
    )
    carried_tilt = (
        driving_torque_tilt * load_inertia_tilt - load_torque_tilt * part_of_lost_lowering_tilt
    )
    carried_tilt_slide_tilt = carried_tilt * slide_tilt
    force_tilt = (
        (0.5) * coriolis * omega_pan
        + cos_tilt * gravity_cos_tilt
        + gravity_sin_tilt * sin_tilt
        + minus_b_tilt_omega_tilt
        - part_of_driving_torque_tilt
        + part_of_driving_torque_tilt_2 * ratio_tilt
        - slide_tilt
        * (
            (0.5) * carried_tilt_slide_tilt * (-lost_lowering_tilt + lost_raising_tilt)
            + (0.5) * (lost_lowering_tilt + lost_raising_tilt) * abs(carried_tilt_slide_tilt)
        )
    )
    inertia_pan = (
        J_pan + J_z_payload + J_z_tilt + c_x_payload_sq_m_payload + part_of_follower_inertia_tilt
    )
    mass_pan = inertia_pan + inertia_pan_per_sin_tilt * sin_tilt
    mass_pan_tilt = -cos_tilt * coupling_cos_tilt + coupling_sin_tilt * sin_tilt
    inertia_tilt = part_of_load_inertia_tilt
    mass_tilt = inertia_tilt + part_of_lost_lowering_tilt
    inverse_determinant = 1.0 / (
        mass_pan * mass_tilt
        - (mass_pan_tilt * mass_pan_tilt) * (slide_tilt * slide_tilt * slide_tilt * slide_tilt)
    )
    slide_tilt_sq = slide_tilt * slide_tilt
    mass_pan_tilt_slide_tilt_sq = mass_pan_tilt * slide_tilt_sq
    accel_pan = inverse_determinant * (
        force_pan * mass_tilt - force_tilt * mass_pan_tilt_slide_tilt_sq
    )
    dx[2] = accel_pan
    accel_tilt = (
        (inverse_determinant)
        * (slide_tilt_sq)
        * (-force_pan * mass_pan_tilt_slide_tilt_sq + force_tilt * mass_pan)
    )
    dx[3] = accel_tilt
    dx[4] = omega_gear_pan
    part_of_force_gear_pan = F_c_pan * (a_F_c_pan * slide_pan + 1.0)
    force_gear_pan = (
        K_t_pan * N_pan * i_pan
        - part_of_force_pan
        - slide_pan
        * (
            F_v_pan * omega_gear_pan * slide_pan * (a_F_v_pan * slide_pan + 1.0)
            + part_of_force_gear_pan
            + (F_s_pan * (a_F_s_pan * slide_pan + 1.0) - part_of_force_gear_pan)
            * math.exp(
                (-(omega_gear_pan * omega_gear_pan))
                / (
                    (v_s_pan * v_s_pan)
                    * ((a_v_s_pan * slide_pan + 1.0) * (a_v_s_pan * slide_pan + 1.0))
                )
            )
        )
    )
    mass_gear_pan = J_motor_pan * (N_pan * N_pan)
    inverse_mass_gear_pan = 1.0 / mass_gear_pan
    accel_gear_pan = force_gear_pan * inverse_mass_gear_pan * (slide_pan * slide_pan)
    dx[5] = accel_gear_pan
    dx[6] = (-K_t_pan * N_pan * omega_gear_pan - R_pan * i_pan + u_pan) / L_pan
    dx[7] = (-K_t_tilt * omega_tilt_ratio_tilt - R_tilt * i_tilt + u_tilt) / L_tilt


@njit(cache=True, error_model="numpy", nogil=True)
def jacobian(t, x, u, p, m, fx, fu, fp):
    """Write the non-zero derivatives of mode_derivative by state, input and parameter."""
    theta_pan = x[0]
    theta_tilt = x[1]
    omega_pan = x[2]
    omega_tilt = x[3]
    theta_gear_pan = x[4]
    omega_gear_pan = x[5]
    i_pan = x[6]
    i_tilt = x[7]
    u_pan = u[0]
    u_tilt = u[1]
    J_pan = p[0]
    J_x_tilt = p[1]
    J_y_tilt = p[2]
    J_z_tilt = p[3]
    m_payload = p[4]
    J_x_payload = p[5]
    J_y_payload = p[6]
    J_z_payload = p[7]
    c_x_payload = p[8]
    c_y_payload = p[9]
    c_z_payload = p[10]
    b_pan = p[11]
    L_pan = p[12]
    R_pan = p[13]
    K_t_pan = p[14]
    J_motor_pan = p[15]
    N_pan = p[16]
    k_shaft_pan = p[17]
    d_shaft_pan = p[18]
    gap_pan = p[19]
    F_c_pan = p[20]
    F_s_pan = p[21]
    v_s_pan = p[22]
    F_v_pan = p[23]
    a_F_c_pan = p[24]
    a_F_s_pan = p[25]
    a_v_s_pan = p[26]
    a_F_v_pan = p[27]
    b_tilt = p[28]
    L_tilt = p[29]
    R_tilt = p[30]
    K_t_tilt = p[31]
    J_motor_tilt = p[32]
    b_motor_tilt = p[33]
    N_tilt = p[34]
    lead_tilt = p[35]
    d_screw_tilt = p[36]
    f_screw_tilt = p[37]
    l_ground_tilt = p[38]
    l_min_tilt = p[39]
    r_arm_tilt = p[40]
    s_start_tilt = p[41]
    slide_pan = m[0]
    slide_tilt = m[1]
    side_pan = m[2]
    active_pan = m[3]
    active_pan_k_shaft_pan = active_pan * k_shaft_pan
    follower_torque_tilt_by_theta_pan = -active_pan_k_shaft_pan
    sin_tilt = math.sin(theta_tilt)
    c_y_payload_sin_tilt = c_y_payload * sin_tilt
    c_x_payload_c_y_payload_sin_tilt = c_x_payload * c_y_payload_sin_tilt
    part_of_follower_coupling_tilt = c_x_payload_c_y_payload_sin_tilt * m_payload
    cos_tilt = math.cos(theta_tilt)
    c_z_payload_cos_tilt = c_z_payload * cos_tilt
    c_y_payload_c_z_payload_cos_tilt = c_y_payload * c_z_payload_cos_tilt
    part_of_follower_coupling_tilt_2 = c_y_payload_c_z_payload_cos_tilt * m_payload
    part_of_follower_coupling_tilt_3 = (
        part_of_follower_coupling_tilt - part_of_follower_coupling_tilt_2
    )
    follower_coupling_tilt = part_of_follower_coupling_tilt_3
    sin_tilt_sq = sin_tilt * sin_tilt
    J_x_payload_sin_tilt_sq = J_x_payload * sin_tilt_sq
    J_x_tilt_sin_tilt_sq = J_x_tilt * sin_tilt_sq
    cos_tilt_sq = cos_tilt * cos_tilt
    J_z_payload_cos_tilt_sq = J_z_payload * cos_tilt_sq
    J_z_tilt_cos_tilt_sq = J_z_tilt * cos_tilt_sq
    c_x_payload_sq = c_x_payload * c_x_payload
    c_x_payload_sq_m_payload = c_x_payload_sq * m_payload
    part_of_follower_inertia_tilt = c_x_payload_sq_m_payload * cos_tilt_sq
    c_y_payload_sq = c_y_payload * c_y_payload
    c_y_payload_sq_sin_tilt_sq = c_y_payload_sq * sin_tilt_sq
    c_y_payload_sq_cos_tilt_sq = c_y_payload_sq * cos_tilt_sq
    c_z_payload_sq = c_z_payload * c_z_payload
    c_z_payload_sq_m_payload = c_z_payload_sq * m_payload
    part_of_follower_inertia_tilt_2 = c_z_payload_sq_m_payload * sin_tilt_sq
    m_payload_sin_tilt = m_payload * sin_tilt
    c_x_payload_m_payload_sin_tilt = c_x_payload * m_payload_sin_tilt
    part_of_follower_inertia_tilt_3 = 2.0 * c_z_payload_cos_tilt
    part_of_follower_inertia_tilt_4 = (
        J_pan
        + J_x_payload_sin_tilt_sq
        + J_x_tilt_sin_tilt_sq
        + J_z_payload_cos_tilt_sq
        + J_z_tilt_cos_tilt_sq
        + c_x_payload_m_payload_sin_tilt * part_of_follower_inertia_tilt_3
        + c_y_payload_sq_cos_tilt_sq * m_payload
        + c_y_payload_sq_sin_tilt_sq * m_payload
        + part_of_follower_inertia_tilt
        + part_of_follower_inertia_tilt_2
    )
    follower_inertia_tilt = part_of_follower_inertia_tilt_4
    follower_inertia_tilt_inverse = 1.0 / follower_inertia_tilt
    part_of_load_torque_tilt_by_theta_pan = follower_coupling_tilt * follower_inertia_tilt_inverse
    load_torque_tilt_by_theta_pan = (
        (-1.0) * (follower_torque_tilt_by_theta_pan) * (part_of_load_torque_tilt_by_theta_pan)
    )
    l_ground_tilt_sq = l_ground_tilt * l_ground_tilt
    r_arm_tilt_sq = r_arm_tilt * r_arm_tilt
    part_of_linkage_cos_tilt = l_ground_tilt_sq + r_arm_tilt_sq
    linkage_cos_tilt = part_of_linkage_cos_tilt - (
        (l_min_tilt + s_start_tilt) * (l_min_tilt + s_start_tilt)
    )
    linkage_cos_tilt_sin_tilt = linkage_cos_tilt * sin_tilt
    part_of_linkage_sin_tilt = 4.0 * r_arm_tilt_sq
    part_of_linkage_sin_tilt_2 = math.sqrt(
        l_ground_tilt_sq * part_of_linkage_sin_tilt - (linkage_cos_tilt * linkage_cos_tilt)
    )
    linkage_sin_tilt = part_of_linkage_sin_tilt_2
    cos_tilt_linkage_sin_tilt = cos_tilt * linkage_sin_tilt
    part_of_ratio_tilt = -cos_tilt_linkage_sin_tilt + linkage_cos_tilt_sin_tilt
    cos_tilt_linkage_cos_tilt = cos_tilt * linkage_cos_tilt
    linkage_sin_tilt_sin_tilt = linkage_sin_tilt * sin_tilt
    part_of_length_tilt = (
        -cos_tilt_linkage_cos_tilt - linkage_sin_tilt_sin_tilt + part_of_linkage_cos_tilt
    )
    part_of_length_tilt_2 = math.sqrt(part_of_length_tilt)
    length_tilt = part_of_length_tilt_2
    length_tilt_inverse = 1.0 / length_tilt
    lead_tilt_inverse = 1.0 / lead_tilt
    part_of_ratio_tilt_2 = math.pi * lead_tilt_inverse
    part_of_ratio_tilt_3 = length_tilt_inverse * part_of_ratio_tilt_2
    part_of_ratio_tilt_4 = part_of_ratio_tilt * part_of_ratio_tilt_3
    ratio_tilt = N_tilt * part_of_ratio_tilt_4
    ratio_tilt_sq = ratio_tilt * ratio_tilt
    J_motor_tilt_ratio_tilt_sq = J_motor_tilt * ratio_tilt_sq
    carried_tilt_by_theta_pan = -J_motor_tilt_ratio_tilt_sq * load_torque_tilt_by_theta_pan
    mass_pan = part_of_follower_inertia_tilt_4
    mass_pan_tilt = part_of_follower_coupling_tilt_3
    part_of_mass_tilt = J_y_payload + J_y_tilt + c_x_payload_sq_m_payload + c_z_payload_sq_m_payload
    mass_tilt = J_motor_tilt_ratio_tilt_sq + part_of_mass_tilt
    inverse_determinant = 1.0 / (
        mass_pan * mass_tilt
        - (mass_pan_tilt * mass_pan_tilt) * (slide_tilt * slide_tilt * slide_tilt * slide_tilt)
    )
    active_pan_k_shaft_pan_mass_tilt = active_pan_k_shaft_pan * mass_tilt
    slide_tilt_cubed = slide_tilt * slide_tilt * slide_tilt
    part_of_lowered_tilt = math.pi * d_screw_tilt
    part_of_lowered_tilt_2 = f_screw_tilt * part_of_lowered_tilt
    part_of_lowered_tilt_3 = -lead_tilt + part_of_lowered_tilt_2
    f_screw_tilt_lead_tilt = f_screw_tilt * lead_tilt
    part_of_lowered_tilt_4 = f_screw_tilt_lead_tilt + part_of_lowered_tilt
    part_of_lowered_tilt_4_inverse = 1.0 / part_of_lowered_tilt_4
    part_of_lowered_tilt_5 = lead_tilt_inverse * part_of_lowered_tilt_4_inverse
    part_of_lowered_tilt_6 = part_of_lowered_tilt * part_of_lowered_tilt_5
    lowered_tilt = -part_of_lowered_tilt_3 * part_of_lowered_tilt_6
    part_of_lost_lowering_tilt = 1.0 - lowered_tilt
    follower_coupling_tilt_sq = follower_coupling_tilt * follower_coupling_tilt
    load_inertia_tilt = (
        -follower_coupling_tilt_sq * follower_inertia_tilt_inverse + part_of_mass_tilt
    )
    part_of_lost_lowering_tilt_2 = J_motor_tilt_ratio_tilt_sq + load_inertia_tilt * lowered_tilt
    part_of_lost_lowering_tilt_3 = 1.0 / (abs(part_of_lost_lowering_tilt_2))
    lost_lowering_tilt = part_of_lost_lowering_tilt * part_of_lost_lowering_tilt_3
    part_of_raised_tilt = lead_tilt + part_of_lowered_tilt_2
    part_of_raised_tilt_2 = -f_screw_tilt_lead_tilt + part_of_lowered_tilt
    part_of_raised_tilt_2_inverse = 1.0 / part_of_raised_tilt_2
    part_of_raised_tilt_3 = lead_tilt_inverse * part_of_raised_tilt_2_inverse
    part_of_raised_tilt_4 = part_of_lowered_tilt * part_of_raised_tilt_3
    raised_tilt = part_of_raised_tilt * part_of_raised_tilt_4
    part_of_lost_raising_tilt = raised_tilt - 1.0
    part_of_lost_raising_tilt_2 = J_motor_tilt_ratio_tilt_sq + load_inertia_tilt * raised_tilt
    part_of_lost_raising_tilt_2_inverse = 1.0 / part_of_lost_raising_tilt_2
    lost_raising_tilt = part_of_lost_raising_tilt * part_of_lost_raising_tilt_2_inverse
    part_of_fx_2_0 = lost_lowering_tilt + lost_raising_tilt
    part_of_ratio_tilt_by_theta_tilt = cos_tilt_linkage_cos_tilt + linkage_sin_tilt_sin_tilt
    part_of_ratio_tilt_by_theta_tilt_2 = part_of_ratio_tilt_3 * part_of_ratio_tilt_by_theta_tilt
    N_tilt_part_of_ratio_tilt = N_tilt * part_of_ratio_tilt
    part_of_length_tilt_by_theta_tilt = (
        -0.5 * cos_tilt_linkage_sin_tilt + (0.5) * linkage_cos_tilt_sin_tilt
    )
    part_of_length_tilt_2_inverse = 1.0 / part_of_length_tilt_2
    length_tilt_by_theta_tilt = part_of_length_tilt_2_inverse * part_of_length_tilt_by_theta_tilt
    part_of_ratio_tilt_by_theta_tilt_3 = 1.0 / (length_tilt * length_tilt)
    part_of_ratio_tilt_by_theta_tilt_4 = part_of_ratio_tilt_2 * part_of_ratio_tilt_by_theta_tilt_3
    part_of_ratio_tilt_by_theta_tilt_5 = (length_tilt_by_theta_tilt) * (
        part_of_ratio_tilt_by_theta_tilt_4
    )
    ratio_tilt_by_theta_tilt = (
        N_tilt * part_of_ratio_tilt_by_theta_tilt_2
        - N_tilt_part_of_ratio_tilt * part_of_ratio_tilt_by_theta_tilt_5
    )
    omega_tilt_sq = omega_tilt * omega_tilt
    part_of_driving_torque_tilt = omega_tilt_sq * ratio_tilt_by_theta_tilt
    part_of_driving_torque_tilt_2 = J_motor_tilt * part_of_driving_torque_tilt
    omega_tilt_ratio_tilt = omega_tilt * ratio_tilt
    part_of_driving_torque_tilt_3 = b_motor_tilt * omega_tilt_ratio_tilt
    part_of_driving_torque_tilt_4 = part_of_driving_torque_tilt_2 * ratio_tilt - ratio_tilt * (
        K_t_tilt * i_tilt - part_of_driving_torque_tilt_3
    )
    driving_torque_tilt = -part_of_driving_torque_tilt_4
    cos_tilt_sin_tilt = cos_tilt * sin_tilt
    part_of_follower_torque_tilt = 2.0 * cos_tilt_sin_tilt
    part_of_follower_torque_tilt_2 = J_x_payload * part_of_follower_torque_tilt
    omega_pan_omega_tilt = omega_pan * omega_tilt
    part_of_follower_torque_tilt_3 = J_x_tilt * part_of_follower_torque_tilt
    cos_tilt_m_payload = cos_tilt * m_payload
    c_y_payload_cos_tilt_m_payload = c_y_payload * cos_tilt_m_payload
    part_of_follower_torque_tilt_4 = c_x_payload * c_y_payload_cos_tilt_m_payload
    c_y_payload_sin_tilt_m_payload = c_y_payload_sin_tilt * m_payload
    part_of_follower_torque_tilt_5 = c_y_payload_sin_tilt_m_payload * c_z_payload
    part_of_follower_torque_tilt_6 = 2.0 * m_payload
    part_of_follower_torque_tilt_7 = c_x_payload * part_of_follower_torque_tilt_6
    part_of_follower_torque_tilt_8 = cos_tilt_sq * part_of_follower_torque_tilt_7
    part_of_follower_torque_tilt_9 = c_z_payload * part_of_follower_torque_tilt_8
    part_of_follower_torque_tilt_10 = c_z_payload_sq_m_payload * part_of_follower_torque_tilt
    minus_omega_pan = -omega_pan
    part_of_follower_torque_tilt_11 = minus_omega_pan + omega_gear_pan
    part_of_follower_torque_tilt_12 = (0.5) * side_pan
    part_of_follower_torque_tilt_13 = (
        -gap_pan * part_of_follower_torque_tilt_12 + theta_gear_pan - theta_pan
    )
    part_of_follower_torque_tilt_14 = (active_pan) * (
        d_shaft_pan * part_of_follower_torque_tilt_11
        + k_shaft_pan * part_of_follower_torque_tilt_13
    )
    part_of_follower_torque_tilt_15 = (
        2.0 * J_z_payload * cos_tilt * omega_pan * omega_tilt * sin_tilt
        + 2.0 * J_z_tilt * cos_tilt * omega_pan * omega_tilt * sin_tilt
        - b_pan * omega_pan
        + 2.0 * c_x_payload * c_z_payload * m_payload * omega_pan * omega_tilt * sin_tilt_sq
        + 2.0 * c_x_payload_sq * cos_tilt * m_payload * omega_pan * omega_tilt * sin_tilt
        - omega_pan_omega_tilt * part_of_follower_torque_tilt_10
        - omega_pan_omega_tilt * part_of_follower_torque_tilt_2
        - omega_pan_omega_tilt * part_of_follower_torque_tilt_3
        - omega_pan_omega_tilt * part_of_follower_torque_tilt_9
        - omega_tilt_sq * part_of_follower_torque_tilt_4
        - omega_tilt_sq * part_of_follower_torque_tilt_5
        + part_of_follower_torque_tilt_14
    )
    follower_torque_tilt = part_of_follower_torque_tilt_15
    b_tilt_omega_tilt = b_tilt * omega_tilt
    part_of_load_torque_tilt = (9.81) * c_x_payload
    part_of_load_torque_tilt_2 = (9.81) * c_z_payload
    omega_pan_sq = omega_pan * omega_pan
    cos_tilt_sin_tilt_omega_pan_sq = cos_tilt_sin_tilt * omega_pan_sq
    part_of_load_torque_tilt_3 = J_z_payload * cos_tilt_sin_tilt_omega_pan_sq
    part_of_load_torque_tilt_4 = J_z_tilt * cos_tilt_sin_tilt_omega_pan_sq
    cos_tilt_sq_omega_pan_sq = cos_tilt_sq * omega_pan_sq
    c_x_payload_c_z_payload = c_x_payload * c_z_payload
    part_of_load_torque_tilt_5 = c_x_payload_c_z_payload * cos_tilt_sq_omega_pan_sq
    omega_pan_sq_sin_tilt_sq = omega_pan_sq * sin_tilt_sq
    part_of_load_torque_tilt_6 = c_x_payload_c_z_payload * omega_pan_sq_sin_tilt_sq
    part_of_load_torque_tilt_7 = m_payload * part_of_load_torque_tilt_6
    part_of_load_torque_tilt_8 = c_x_payload_sq_m_payload * cos_tilt_sin_tilt_omega_pan_sq
    load_torque_tilt = (
        J_x_payload * cos_tilt_sin_tilt_omega_pan_sq
        + J_x_tilt * cos_tilt_sin_tilt_omega_pan_sq
        - b_tilt_omega_tilt
        + c_z_payload_sq_m_payload * cos_tilt_sin_tilt_omega_pan_sq
        + cos_tilt_m_payload * part_of_load_torque_tilt
        - follower_torque_tilt * part_of_load_torque_tilt_by_theta_pan
        + m_payload * part_of_load_torque_tilt_5
        + m_payload_sin_tilt * part_of_load_torque_tilt_2
        - part_of_load_torque_tilt_3
        - part_of_load_torque_tilt_4
        - part_of_load_torque_tilt_7
        - part_of_load_torque_tilt_8
    )
    carried_tilt = (
        -J_motor_tilt_ratio_tilt_sq * load_torque_tilt + driving_torque_tilt * load_inertia_tilt
    )
    carried_tilt_slide_tilt = carried_tilt * slide_tilt
    part_of_fx_2_0_2 = -0.5 * lost_lowering_tilt + (0.5) * lost_raising_tilt
    part_of_fx_2_0_3 = (0.5) * part_of_fx_2_0 * slide_tilt * (
        0.0 if carried_tilt_slide_tilt == 0 else math.copysign(1, carried_tilt_slide_tilt)
    ) + part_of_fx_2_0_2 * slide_tilt
    fx[2, 0] = (inverse_determinant) * (
        -active_pan_k_shaft_pan_mass_tilt
        + carried_tilt_by_theta_pan * mass_pan_tilt * part_of_fx_2_0_3 * slide_tilt_cubed
    )
    slide_tilt_sq = slide_tilt * slide_tilt
    part_of_fx_3_0 = inverse_determinant * slide_tilt_sq
    mass_pan_tilt_slide_tilt_sq = mass_pan_tilt * slide_tilt_sq
    part_of_fx_3_0_2 = active_pan_k_shaft_pan * mass_pan_tilt_slide_tilt_sq
    part_of_fx_2_0_3_slide_tilt = part_of_fx_2_0_3 * slide_tilt
    part_of_fx_3_0_3 = mass_pan * part_of_fx_2_0_3_slide_tilt
    fx[3, 0] = part_of_fx_3_0 * (-carried_tilt_by_theta_pan * part_of_fx_3_0_3 + part_of_fx_3_0_2)
    N_pan_sq = N_pan * N_pan
    mass_gear_pan = J_motor_pan * N_pan_sq
    inverse_mass_gear_pan = 1.0 / mass_gear_pan
    part_of_fx_5_0 = inverse_mass_gear_pan * (slide_pan * slide_pan)
    part_of_fx_5_0_2 = active_pan_k_shaft_pan * part_of_fx_5_0
    fx[5, 0] = part_of_fx_5_0_2
    force_pan = part_of_follower_torque_tilt_15
    part_of_force_tilt = abs(carried_tilt_slide_tilt)
    part_of_force_tilt_2 = (0.5) * part_of_force_tilt
    force_tilt = (
        J_x_payload * cos_tilt * omega_pan_sq * sin_tilt
        + J_x_tilt * cos_tilt * omega_pan_sq * sin_tilt
        - b_tilt_omega_tilt
        + c_x_payload * c_z_payload * cos_tilt_sq * m_payload * omega_pan_sq
        + (9.81) * c_x_payload * cos_tilt * m_payload
        + (9.81) * c_z_payload * m_payload * sin_tilt
        + c_z_payload_sq * cos_tilt * m_payload * omega_pan_sq * sin_tilt
        - part_of_driving_torque_tilt_4
        - part_of_load_torque_tilt_3
        - part_of_load_torque_tilt_4
        - part_of_load_torque_tilt_7
        - part_of_load_torque_tilt_8
        - slide_tilt
        * (carried_tilt_slide_tilt * part_of_fx_2_0_2 + part_of_force_tilt_2 * part_of_fx_2_0)
    )
    accel_pan = inverse_determinant * (
        force_pan * mass_tilt - force_tilt * mass_pan_tilt_slide_tilt_sq
    )
    accel_tilt = part_of_fx_3_0 * (-force_pan * mass_pan_tilt_slide_tilt_sq + force_tilt * mass_pan)
    part_of_fx_2_1 = part_of_follower_torque_tilt_4 + part_of_follower_torque_tilt_5
    part_of_fx_2_1_2 = J_z_payload * part_of_follower_torque_tilt
    part_of_fx_2_1_3 = J_z_tilt * part_of_follower_torque_tilt
    part_of_fx_2_1_4 = c_z_payload * part_of_follower_torque_tilt_7 * sin_tilt_sq
    part_of_fx_2_1_5 = c_x_payload_sq_m_payload * part_of_follower_torque_tilt
    part_of_fx_2_1_6 = (
        part_of_follower_torque_tilt_10
        + part_of_follower_torque_tilt_2
        + part_of_follower_torque_tilt_3
        + part_of_follower_torque_tilt_9
        - part_of_fx_2_1_2
        - part_of_fx_2_1_3
        - part_of_fx_2_1_4
        - part_of_fx_2_1_5
    )
    part_of_fx_2_1_7 = 2.0 * omega_pan_omega_tilt
    cos_tilt_sq_part_of_fx_2_1_7 = cos_tilt_sq * part_of_fx_2_1_7
    part_of_fx_2_1_8 = J_x_payload * cos_tilt_sq_part_of_fx_2_1_7
    part_of_fx_2_1_9 = J_x_tilt * cos_tilt_sq_part_of_fx_2_1_7
    part_of_fx_2_1_7_sin_tilt_sq = part_of_fx_2_1_7 * sin_tilt_sq
    part_of_fx_2_1_10 = J_z_payload * part_of_fx_2_1_7_sin_tilt_sq
    part_of_fx_2_1_11 = J_z_tilt * part_of_fx_2_1_7_sin_tilt_sq
    part_of_fx_2_1_12 = omega_tilt_sq * part_of_follower_coupling_tilt_2
    part_of_fx_2_1_13 = c_x_payload_sq_m_payload * part_of_fx_2_1_7_sin_tilt_sq
    part_of_fx_2_1_14 = c_z_payload_sq_m_payload * cos_tilt_sq_part_of_fx_2_1_7
    part_of_fx_2_1_15 = (
        2.0 * J_x_payload * omega_pan * omega_tilt * sin_tilt_sq
        + 2.0 * J_x_tilt * omega_pan * omega_tilt * sin_tilt_sq
        + 2.0 * J_z_payload * cos_tilt_sq * omega_pan * omega_tilt
        + 2.0 * J_z_tilt * cos_tilt_sq * omega_pan * omega_tilt
        - accel_pan * part_of_fx_2_1_6
        - accel_tilt * part_of_fx_2_1
        + c_x_payload * c_y_payload * m_payload * omega_tilt_sq * sin_tilt
        + 8.0 * c_x_payload * c_z_payload * cos_tilt * m_payload * omega_pan * omega_tilt * sin_tilt
        + 2.0 * c_x_payload_sq * cos_tilt_sq * m_payload * omega_pan * omega_tilt
        + 2.0 * c_z_payload_sq * m_payload * omega_pan * omega_tilt * sin_tilt_sq
        - part_of_fx_2_1_10
        - part_of_fx_2_1_11
        - part_of_fx_2_1_12
        - part_of_fx_2_1_13
        - part_of_fx_2_1_14
        - part_of_fx_2_1_8
        - part_of_fx_2_1_9
    )
    part_of_length_tilt_by_theta_tilt_by_theta_tilt = (part_of_length_tilt ** (-1.5)) * (
        part_of_length_tilt_by_theta_tilt
    )
    length_tilt_by_theta_tilt_by_theta_tilt = (
        part_of_length_tilt_2_inverse
        * ((0.5) * cos_tilt_linkage_cos_tilt + (0.5) * linkage_sin_tilt_sin_tilt)
        - part_of_length_tilt_by_theta_tilt * part_of_length_tilt_by_theta_tilt_by_theta_tilt
    )
    N_tilt_part_of_ratio_tilt_3 = N_tilt * part_of_ratio_tilt_3
    part_of_ratio_tilt_by_theta_tilt_by_theta_tilt = (N_tilt_part_of_ratio_tilt) * (
        part_of_ratio_tilt_by_theta_tilt_4
    )
    part_of_ratio_tilt_by_theta_tilt_by_theta_tilt_2 = N_tilt * part_of_ratio_tilt_by_theta_tilt
    part_of_ratio_tilt_by_theta_tilt_by_theta_tilt_3 = (part_of_ratio_tilt_by_theta_tilt_4) * (
        part_of_ratio_tilt_by_theta_tilt_by_theta_tilt_2
    )
    part_of_ratio_tilt_by_theta_tilt_by_theta_tilt_4 = (
        2.0
        * math.pi
        * N_tilt
        * lead_tilt_inverse
        * length_tilt_by_theta_tilt
        * part_of_ratio_tilt
        / (length_tilt * length_tilt * length_tilt)
        - part_of_ratio_tilt_by_theta_tilt_by_theta_tilt_3
    )
    ratio_tilt_by_theta_tilt_by_theta_tilt = (
        -N_tilt_part_of_ratio_tilt_3 * part_of_ratio_tilt
        - length_tilt_by_theta_tilt * part_of_ratio_tilt_by_theta_tilt_by_theta_tilt_3
        + length_tilt_by_theta_tilt * part_of_ratio_tilt_by_theta_tilt_by_theta_tilt_4
        - length_tilt_by_theta_tilt_by_theta_tilt * part_of_ratio_tilt_by_theta_tilt_by_theta_tilt
    )
    J_motor_tilt_ratio_tilt = J_motor_tilt * ratio_tilt
    part_of_driving_torque_tilt_by_theta_tilt = J_motor_tilt_ratio_tilt * omega_tilt_sq
    part_of_driving_torque_tilt_by_theta_tilt_2 = (
        K_t_tilt * i_tilt - part_of_driving_torque_tilt_2 - 2.0 * part_of_driving_torque_tilt_3
    )
    part_of_driving_torque_tilt_by_theta_tilt_3 = (
        part_of_driving_torque_tilt_by_theta_tilt * ratio_tilt_by_theta_tilt_by_theta_tilt
        - part_of_driving_torque_tilt_by_theta_tilt_2 * ratio_tilt_by_theta_tilt
    )
    driving_torque_tilt_by_theta_tilt = -part_of_driving_torque_tilt_by_theta_tilt_3
    follower_coupling_tilt_by_theta_tilt = part_of_fx_2_1
    follower_inertia_tilt_by_theta_tilt = part_of_fx_2_1_6
    part_of_load_inertia_tilt_by_theta_tilt = 2.0 * part_of_load_torque_tilt_by_theta_pan
    part_of_load_inertia_tilt_by_theta_tilt_2 = 1.0 / (
        follower_inertia_tilt * follower_inertia_tilt
    )
    part_of_load_inertia_tilt_by_theta_tilt_3 = (follower_coupling_tilt_sq) * (
        part_of_load_inertia_tilt_by_theta_tilt_2
    )
    load_inertia_tilt_by_theta_tilt = (
        -follower_coupling_tilt_by_theta_tilt * part_of_load_inertia_tilt_by_theta_tilt
        + follower_inertia_tilt_by_theta_tilt * part_of_load_inertia_tilt_by_theta_tilt_3
    )
    part_of_follower_torque_tilt_by_theta_tilt = (
        c_x_payload_m_payload_sin_tilt * c_z_payload_cos_tilt
    )
    follower_torque_tilt_by_theta_tilt = (
        J_x_payload_sin_tilt_sq * part_of_fx_2_1_7
        + J_x_tilt_sin_tilt_sq * part_of_fx_2_1_7
        + J_z_payload_cos_tilt_sq * part_of_fx_2_1_7
        + J_z_tilt_cos_tilt_sq * part_of_fx_2_1_7
        + 8.0 * omega_pan_omega_tilt * part_of_follower_torque_tilt_by_theta_tilt
        + omega_tilt_sq * part_of_follower_coupling_tilt
        + part_of_follower_inertia_tilt * part_of_fx_2_1_7
        + part_of_follower_inertia_tilt_2 * part_of_fx_2_1_7
        - part_of_fx_2_1_10
        - part_of_fx_2_1_11
        - part_of_fx_2_1_12
        - part_of_fx_2_1_13
        - part_of_fx_2_1_14
        - part_of_fx_2_1_8
        - part_of_fx_2_1_9
    )
    part_of_load_torque_tilt_by_theta_tilt = follower_inertia_tilt_inverse * follower_torque_tilt
    part_of_load_torque_tilt_by_theta_tilt_2 = (
        -J_x_payload * cos_tilt_sq * omega_pan_sq
        + J_x_payload_sin_tilt_sq * omega_pan_sq
        - J_x_tilt * cos_tilt_sq * omega_pan_sq
        + J_x_tilt_sin_tilt_sq * omega_pan_sq
        - J_z_payload * omega_pan_sq * sin_tilt_sq
        + J_z_payload_cos_tilt_sq * omega_pan_sq
        - J_z_tilt * omega_pan_sq * sin_tilt_sq
        + J_z_tilt_cos_tilt_sq * omega_pan_sq
        + (9.81) * c_x_payload_m_payload_sin_tilt
        - c_x_payload_sq * m_payload * omega_pan_sq * sin_tilt_sq
        - 9.81 * c_z_payload * cos_tilt * m_payload
        - c_z_payload_sq * cos_tilt_sq * m_payload * omega_pan_sq
        + omega_pan_sq * part_of_follower_inertia_tilt
        + omega_pan_sq * part_of_follower_inertia_tilt_2
        + 4.0 * omega_pan_sq * part_of_follower_torque_tilt_by_theta_tilt
    )
    load_torque_tilt_by_theta_tilt = (
        follower_coupling_tilt
        * follower_inertia_tilt_by_theta_tilt
        * follower_torque_tilt
        * part_of_load_inertia_tilt_by_theta_tilt_2
        - follower_coupling_tilt_by_theta_tilt * part_of_load_torque_tilt_by_theta_tilt
        - follower_torque_tilt_by_theta_tilt * part_of_load_torque_tilt_by_theta_pan
        - part_of_load_torque_tilt_by_theta_tilt_2
    )
    part_of_carried_tilt_by_theta_tilt = 2.0 * ratio_tilt_by_theta_tilt
    part_of_carried_tilt_by_theta_tilt_2 = J_motor_tilt_ratio_tilt * load_torque_tilt
    carried_tilt_by_theta_tilt = (
        -J_motor_tilt_ratio_tilt_sq * load_torque_tilt_by_theta_tilt
        + driving_torque_tilt * load_inertia_tilt_by_theta_tilt
        + driving_torque_tilt_by_theta_tilt * load_inertia_tilt
        - part_of_carried_tilt_by_theta_tilt * part_of_carried_tilt_by_theta_tilt_2
    )
    part_of_lost_lowering_tilt_by_theta_tilt = (
        (part_of_lost_lowering_tilt)
        * (1.0 / (part_of_lost_lowering_tilt_2 * part_of_lost_lowering_tilt_2))
        * (
            0.0
            if part_of_lost_lowering_tilt_2 == 0
            else math.copysign(1, part_of_lost_lowering_tilt_2)
        )
    )
    part_of_lost_lowering_tilt_by_theta_tilt_2 = (lowered_tilt) * (
        part_of_lost_lowering_tilt_by_theta_tilt
    )
    part_of_lost_lowering_tilt_by_theta_tilt_3 = (J_motor_tilt_ratio_tilt) * (
        part_of_lost_lowering_tilt_by_theta_tilt
    )
    lost_lowering_tilt_by_theta_tilt = (
        -load_inertia_tilt_by_theta_tilt * part_of_lost_lowering_tilt_by_theta_tilt_2
        - part_of_carried_tilt_by_theta_tilt * part_of_lost_lowering_tilt_by_theta_tilt_3
    )
    part_of_lost_raising_tilt_by_theta_tilt = (part_of_lost_raising_tilt) * (
        1.0 / (part_of_lost_raising_tilt_2 * part_of_lost_raising_tilt_2)
    )
    part_of_lost_raising_tilt_by_theta_tilt_2 = (
        part_of_lost_raising_tilt_by_theta_tilt * raised_tilt
    )
    part_of_lost_raising_tilt_by_theta_tilt_3 = (J_motor_tilt_ratio_tilt) * (
        part_of_lost_raising_tilt_by_theta_tilt
    )
    lost_raising_tilt_by_theta_tilt = (
        -load_inertia_tilt_by_theta_tilt * part_of_lost_raising_tilt_by_theta_tilt_2
        - part_of_carried_tilt_by_theta_tilt * part_of_lost_raising_tilt_by_theta_tilt_3
    )
    part_of_fx_2_1_16 = (0.5) * carried_tilt_slide_tilt
    part_of_fx_2_1_17 = slide_tilt * ((0.5) * part_of_force_tilt - part_of_fx_2_1_16)
    part_of_fx_2_1_18 = slide_tilt * (part_of_force_tilt_2 + part_of_fx_2_1_16)
    part_of_fx_2_1_19 = J_motor_tilt_ratio_tilt * accel_tilt
    part_of_fx_2_1_20 = (
        -accel_pan * part_of_fx_2_1
        - carried_tilt_by_theta_tilt * part_of_fx_2_0_3_slide_tilt
        - lost_lowering_tilt_by_theta_tilt * part_of_fx_2_1_17
        - lost_raising_tilt_by_theta_tilt * part_of_fx_2_1_18
        - part_of_carried_tilt_by_theta_tilt * part_of_fx_2_1_19
        - part_of_driving_torque_tilt_by_theta_tilt_3
        - part_of_load_torque_tilt_by_theta_tilt_2
    )
    fx[2, 1] = (inverse_determinant) * (
        -mass_pan_tilt_slide_tilt_sq * part_of_fx_2_1_20 + mass_tilt * part_of_fx_2_1_15
    )
    fx[3, 1] = (part_of_fx_3_0) * (
        mass_pan * part_of_fx_2_1_20 - mass_pan_tilt_slide_tilt_sq * part_of_fx_2_1_15
    )
    L_tilt_inverse = 1.0 / L_tilt
    part_of_fx_7_1 = K_t_tilt * L_tilt_inverse * omega_tilt
    fx[7, 1] = -part_of_fx_7_1 * ratio_tilt_by_theta_tilt
    fx[0, 2] = 1.0
    active_pan_d_shaft_pan = active_pan * d_shaft_pan
    part_of_follower_torque_tilt_by_omega_pan = (
        2.0 * J_z_payload * cos_tilt * omega_tilt * sin_tilt
        + 2.0 * J_z_tilt * cos_tilt * omega_tilt * sin_tilt
        - active_pan_d_shaft_pan
        - b_pan
        + 2.0 * c_x_payload * c_z_payload * m_payload * omega_tilt * sin_tilt_sq
        + 2.0 * c_x_payload_sq * cos_tilt * m_payload * omega_tilt * sin_tilt
        - omega_tilt * part_of_follower_torque_tilt_10
        - omega_tilt * part_of_follower_torque_tilt_2
        - omega_tilt * part_of_follower_torque_tilt_3
        - omega_tilt * part_of_follower_torque_tilt_9
    )
    follower_torque_tilt_by_omega_pan = part_of_follower_torque_tilt_by_omega_pan
    part_of_load_torque_tilt_by_omega_pan = omega_pan * part_of_follower_torque_tilt_2
    part_of_load_torque_tilt_by_omega_pan_2 = omega_pan * part_of_follower_torque_tilt_3
    omega_pan_part_of_fx_2_1_2 = omega_pan * part_of_fx_2_1_2
    omega_pan_part_of_fx_2_1_3 = omega_pan * part_of_fx_2_1_3
    omega_pan_part_of_fx_2_1_4 = omega_pan * part_of_fx_2_1_4
    part_of_load_torque_tilt_by_omega_pan_3 = omega_pan * part_of_follower_torque_tilt_9
    omega_pan_part_of_fx_2_1_5 = omega_pan * part_of_fx_2_1_5
    part_of_load_torque_tilt_by_omega_pan_4 = omega_pan * part_of_follower_torque_tilt_10
    part_of_load_torque_tilt_by_omega_pan_5 = (
        omega_pan_part_of_fx_2_1_2
        + omega_pan_part_of_fx_2_1_3
        + omega_pan_part_of_fx_2_1_4
        + omega_pan_part_of_fx_2_1_5
        - part_of_load_torque_tilt_by_omega_pan
        - part_of_load_torque_tilt_by_omega_pan_2
        - part_of_load_torque_tilt_by_omega_pan_3
        - part_of_load_torque_tilt_by_omega_pan_4
    )
    load_torque_tilt_by_omega_pan = (
        -follower_torque_tilt_by_omega_pan * part_of_load_torque_tilt_by_theta_pan
        - part_of_load_torque_tilt_by_omega_pan_5
    )
    carried_tilt_by_omega_pan = -J_motor_tilt_ratio_tilt_sq * load_torque_tilt_by_omega_pan
    part_of_fx_2_2 = (
        -carried_tilt_by_omega_pan * part_of_fx_2_0_3_slide_tilt
        - part_of_load_torque_tilt_by_omega_pan_5
    )
    fx[2, 2] = (inverse_determinant) * (
        -mass_pan_tilt_slide_tilt_sq * part_of_fx_2_2
        + mass_tilt * part_of_follower_torque_tilt_by_omega_pan
    )
    fx[3, 2] = (part_of_fx_3_0) * (
        mass_pan * part_of_fx_2_2
        - mass_pan_tilt_slide_tilt_sq * part_of_follower_torque_tilt_by_omega_pan
    )
    fx[5, 2] = active_pan_d_shaft_pan * part_of_fx_5_0
    fx[1, 3] = 1.0
    part_of_follower_torque_tilt_by_omega_tilt = 2.0 * omega_tilt
    part_of_follower_torque_tilt_by_omega_tilt_2 = (
        omega_pan_part_of_fx_2_1_2
        + omega_pan_part_of_fx_2_1_3
        + omega_pan_part_of_fx_2_1_4
        + omega_pan_part_of_fx_2_1_5
        - part_of_follower_torque_tilt_4 * part_of_follower_torque_tilt_by_omega_tilt
        - part_of_follower_torque_tilt_5 * part_of_follower_torque_tilt_by_omega_tilt
        - part_of_load_torque_tilt_by_omega_pan
        - part_of_load_torque_tilt_by_omega_pan_2
        - part_of_load_torque_tilt_by_omega_pan_3
        - part_of_load_torque_tilt_by_omega_pan_4
    )
    part_of_driving_torque_tilt_by_omega_tilt = (
        J_motor_tilt * omega_tilt_ratio_tilt * part_of_carried_tilt_by_theta_tilt
        + b_motor_tilt * ratio_tilt_sq
    )
    driving_torque_tilt_by_omega_tilt = -part_of_driving_torque_tilt_by_omega_tilt
    follower_torque_tilt_by_omega_tilt = part_of_follower_torque_tilt_by_omega_tilt_2
    load_torque_tilt_by_omega_tilt = (
        -b_tilt - follower_torque_tilt_by_omega_tilt * part_of_load_torque_tilt_by_theta_pan
    )
    carried_tilt_by_omega_tilt = (
        -J_motor_tilt_ratio_tilt_sq * load_torque_tilt_by_omega_tilt
        + driving_torque_tilt_by_omega_tilt * load_inertia_tilt
    )
    part_of_fx_2_3 = (
        -b_tilt
        - carried_tilt_by_omega_tilt * part_of_fx_2_0_3_slide_tilt
        - part_of_driving_torque_tilt_by_omega_tilt
    )
    fx[2, 3] = (inverse_determinant) * (
        -mass_pan_tilt_slide_tilt_sq * part_of_fx_2_3
        + mass_tilt * part_of_follower_torque_tilt_by_omega_tilt_2
    )
    fx[3, 3] = (part_of_fx_3_0) * (
        mass_pan * part_of_fx_2_3
        - mass_pan_tilt_slide_tilt_sq * part_of_follower_torque_tilt_by_omega_tilt_2
    )
    K_t_tilt_ratio_tilt = K_t_tilt * ratio_tilt
    fx[7, 3] = -K_t_tilt_ratio_tilt * L_tilt_inverse
    follower_torque_tilt_by_theta_gear_pan = active_pan_k_shaft_pan
    load_torque_tilt_by_theta_gear_pan = (
        (-1.0) * (follower_torque_tilt_by_theta_gear_pan) * (part_of_load_torque_tilt_by_theta_pan)
    )
    carried_tilt_by_theta_gear_pan = (
        -J_motor_tilt_ratio_tilt_sq * load_torque_tilt_by_theta_gear_pan
    )
    part_of_fx_2_4 = mass_pan_tilt * part_of_fx_2_0_3 * slide_tilt_cubed
    fx[2, 4] = (inverse_determinant) * (
        active_pan_k_shaft_pan_mass_tilt + carried_tilt_by_theta_gear_pan * part_of_fx_2_4
    )
    fx[3, 4] = part_of_fx_3_0 * (
        -carried_tilt_by_theta_gear_pan * part_of_fx_3_0_3 - part_of_fx_3_0_2
    )
    fx[5, 4] = -part_of_fx_5_0_2
    follower_torque_tilt_by_omega_gear_pan = active_pan_d_shaft_pan
    load_torque_tilt_by_omega_gear_pan = (
        (-1.0) * (follower_torque_tilt_by_omega_gear_pan) * (part_of_load_torque_tilt_by_theta_pan)
    )
    carried_tilt_by_omega_gear_pan = (
        -J_motor_tilt_ratio_tilt_sq * load_torque_tilt_by_omega_gear_pan
    )
    fx[2, 5] = (inverse_determinant) * (
        active_pan_d_shaft_pan * mass_tilt + carried_tilt_by_omega_gear_pan * part_of_fx_2_4
    )
    fx[3, 5] = (part_of_fx_3_0) * (
        -active_pan_d_shaft_pan * mass_pan_tilt_slide_tilt_sq
        - carried_tilt_by_omega_gear_pan * part_of_fx_3_0_3
    )
    fx[4, 5] = 1.0
    part_of_fx_5_5 = a_F_v_pan * slide_pan + 1.0
    F_v_pan_part_of_fx_5_5_slide_pan = F_v_pan * part_of_fx_5_5 * slide_pan
    part_of_fx_5_5_2 = 1.0 / (v_s_pan * v_s_pan)
    part_of_fx_5_5_3 = a_v_s_pan * slide_pan + 1.0
    part_of_fx_5_5_4 = 1.0 / (part_of_fx_5_5_3 * part_of_fx_5_5_3)
    part_of_fx_5_5_5 = part_of_fx_5_5_2 * part_of_fx_5_5_4
    part_of_fx_5_5_6 = a_F_c_pan * slide_pan + 1.0
    F_c_pan_part_of_fx_5_5_6 = F_c_pan * part_of_fx_5_5_6
    part_of_fx_5_5_7 = a_F_s_pan * slide_pan + 1.0
    omega_gear_pan_sq = omega_gear_pan * omega_gear_pan
    part_of_fx_5_5_8 = math.exp(-omega_gear_pan_sq * part_of_fx_5_5_5)
    part_of_fx_5_5_9 = part_of_fx_5_5_8 * (-F_c_pan_part_of_fx_5_5_6 + F_s_pan * part_of_fx_5_5_7)
    part_of_fx_5_5_10 = 2.0 * part_of_fx_5_5_9
    fx[5, 5] = (part_of_fx_5_0) * (
        -active_pan_d_shaft_pan
        - slide_pan
        * (F_v_pan_part_of_fx_5_5_slide_pan - omega_gear_pan * part_of_fx_5_5_10 * part_of_fx_5_5_5)
    )
    L_pan_inverse = 1.0 / L_pan
    K_t_pan_N_pan = K_t_pan * N_pan
    fx[6, 5] = -K_t_pan_N_pan * L_pan_inverse
    fx[5, 6] = K_t_pan_N_pan * part_of_fx_5_0
    fx[6, 6] = -L_pan_inverse * R_pan
    driving_torque_tilt_by_i_tilt = K_t_tilt_ratio_tilt
    carried_tilt_by_i_tilt = driving_torque_tilt_by_i_tilt * load_inertia_tilt
    part_of_fx_2_7 = K_t_tilt_ratio_tilt - carried_tilt_by_i_tilt * part_of_fx_2_0_3_slide_tilt
    part_of_fx_2_7_2 = inverse_determinant * mass_pan_tilt_slide_tilt_sq
    fx[2, 7] = -part_of_fx_2_7 * part_of_fx_2_7_2
    mass_pan_part_of_fx_3_0 = mass_pan * part_of_fx_3_0
    fx[3, 7] = mass_pan_part_of_fx_3_0 * part_of_fx_2_7
    fx[7, 7] = -L_tilt_inverse * R_tilt
    fu[6, 0] = L_pan_inverse
    fu[7, 1] = L_tilt_inverse
    follower_inertia_tilt_by_J_pan = 1.0
    load_inertia_tilt_by_J_pan = (follower_inertia_tilt_by_J_pan) * (
        part_of_load_inertia_tilt_by_theta_tilt_3
    )
    part_of_load_torque_tilt_by_J_pan = (
        (follower_coupling_tilt)
        * (follower_torque_tilt)
        * (part_of_load_inertia_tilt_by_theta_tilt_2)
    )
    load_torque_tilt_by_J_pan = follower_inertia_tilt_by_J_pan * part_of_load_torque_tilt_by_J_pan
    carried_tilt_by_J_pan = (
        -J_motor_tilt_ratio_tilt_sq * load_torque_tilt_by_J_pan
        + driving_torque_tilt * load_inertia_tilt_by_J_pan
    )
    lost_lowering_tilt_by_J_pan = (
        (-1.0) * (load_inertia_tilt_by_J_pan) * (part_of_lost_lowering_tilt_by_theta_tilt_2)
    )
    lost_raising_tilt_by_J_pan = (
        (-1.0) * (load_inertia_tilt_by_J_pan) * (part_of_lost_raising_tilt_by_theta_tilt_2)
    )
    part_of_fp_2_0 = (
        -carried_tilt_by_J_pan * part_of_fx_2_0_3_slide_tilt
        - lost_lowering_tilt_by_J_pan * part_of_fx_2_1_17
        - lost_raising_tilt_by_J_pan * part_of_fx_2_1_18
    )
    fp[2, 0] = (inverse_determinant) * (
        -accel_pan * mass_tilt - mass_pan_tilt_slide_tilt_sq * part_of_fp_2_0
    )
    fp[3, 0] = part_of_fx_3_0 * (
        accel_pan * mass_pan_tilt_slide_tilt_sq + mass_pan * part_of_fp_2_0
    )
    part_of_fp_2_1 = omega_pan_omega_tilt * part_of_follower_torque_tilt
    part_of_fp_2_1_2 = -accel_pan * sin_tilt_sq - part_of_fp_2_1
    minus_mass_tilt_part_of_fp_2_1_2 = -mass_tilt * part_of_fp_2_1_2
    follower_inertia_tilt_by_J_x_tilt = sin_tilt_sq
    load_inertia_tilt_by_J_x_tilt = (follower_inertia_tilt_by_J_x_tilt) * (
        part_of_load_inertia_tilt_by_theta_tilt_3
    )
    minus_part_of_fp_2_1 = -part_of_fp_2_1
    follower_torque_tilt_by_J_x_tilt = minus_part_of_fp_2_1
    load_torque_tilt_by_J_x_tilt = (
        cos_tilt_sin_tilt_omega_pan_sq
        + follower_inertia_tilt_by_J_x_tilt * part_of_load_torque_tilt_by_J_pan
        - follower_torque_tilt_by_J_x_tilt * part_of_load_torque_tilt_by_theta_pan
    )
    carried_tilt_by_J_x_tilt = (
        -J_motor_tilt_ratio_tilt_sq * load_torque_tilt_by_J_x_tilt
        + driving_torque_tilt * load_inertia_tilt_by_J_x_tilt
    )
    lost_lowering_tilt_by_J_x_tilt = (
        (-1.0) * (load_inertia_tilt_by_J_x_tilt) * (part_of_lost_lowering_tilt_by_theta_tilt_2)
    )
    lost_raising_tilt_by_J_x_tilt = (
        (-1.0) * (load_inertia_tilt_by_J_x_tilt) * (part_of_lost_raising_tilt_by_theta_tilt_2)
    )
    part_of_fp_2_1_3 = -cos_tilt_sin_tilt_omega_pan_sq
    part_of_fp_2_1_4 = (
        -carried_tilt_by_J_x_tilt * part_of_fx_2_0_3_slide_tilt
        - lost_lowering_tilt_by_J_x_tilt * part_of_fx_2_1_17
        - lost_raising_tilt_by_J_x_tilt * part_of_fx_2_1_18
        - part_of_fp_2_1_3
    )
    fp[2, 1] = (inverse_determinant) * (
        -mass_pan_tilt_slide_tilt_sq * part_of_fp_2_1_4 - minus_mass_tilt_part_of_fp_2_1_2
    )
    part_of_fp_3_1 = -mass_pan_tilt_slide_tilt_sq * part_of_fp_2_1_2
    fp[3, 1] = part_of_fx_3_0 * (mass_pan * part_of_fp_2_1_4 + part_of_fp_3_1)
    load_inertia_tilt_by_J_y_tilt = 1.0
    carried_tilt_by_J_y_tilt = driving_torque_tilt * load_inertia_tilt_by_J_y_tilt
    lost_lowering_tilt_by_J_y_tilt = (
        (-1.0) * (load_inertia_tilt_by_J_y_tilt) * (part_of_lost_lowering_tilt_by_theta_tilt_2)
    )
    lost_raising_tilt_by_J_y_tilt = (
        (-1.0) * (load_inertia_tilt_by_J_y_tilt) * (part_of_lost_raising_tilt_by_theta_tilt_2)
    )
    part_of_fp_2_2 = (
        -accel_tilt
        - carried_tilt_by_J_y_tilt * part_of_fx_2_0_3_slide_tilt
        - lost_lowering_tilt_by_J_y_tilt * part_of_fx_2_1_17
        - lost_raising_tilt_by_J_y_tilt * part_of_fx_2_1_18
    )
    fp[2, 2] = -part_of_fp_2_2 * part_of_fx_2_7_2
    fp[3, 2] = mass_pan_part_of_fx_3_0 * part_of_fp_2_2
    part_of_fp_2_3 = -accel_pan * cos_tilt_sq - minus_part_of_fp_2_1
    minus_mass_tilt_part_of_fp_2_3 = -mass_tilt * part_of_fp_2_3
    follower_inertia_tilt_by_J_z_tilt = cos_tilt_sq
    load_inertia_tilt_by_J_z_tilt = (follower_inertia_tilt_by_J_z_tilt) * (
        part_of_load_inertia_tilt_by_theta_tilt_3
    )
    follower_torque_tilt_by_J_z_tilt = part_of_fp_2_1
    load_torque_tilt_by_J_z_tilt = (
        -cos_tilt_sin_tilt_omega_pan_sq
        + follower_coupling_tilt
        * follower_inertia_tilt_by_J_z_tilt
        * follower_torque_tilt
        * part_of_load_inertia_tilt_by_theta_tilt_2
        - follower_torque_tilt_by_J_z_tilt * part_of_load_torque_tilt_by_theta_pan
    )
    carried_tilt_by_J_z_tilt = (
        -J_motor_tilt_ratio_tilt_sq * load_torque_tilt_by_J_z_tilt
        + driving_torque_tilt * load_inertia_tilt_by_J_z_tilt
    )
    lost_lowering_tilt_by_J_z_tilt = (
        (-1.0) * (load_inertia_tilt_by_J_z_tilt) * (part_of_lost_lowering_tilt_by_theta_tilt_2)
    )
    lost_raising_tilt_by_J_z_tilt = (
        (-1.0) * (load_inertia_tilt_by_J_z_tilt) * (part_of_lost_raising_tilt_by_theta_tilt_2)
    )
    part_of_fp_2_3_2 = (
        -carried_tilt_by_J_z_tilt * part_of_fx_2_0_3_slide_tilt
        - cos_tilt_sin_tilt_omega_pan_sq
        - lost_lowering_tilt_by_J_z_tilt * part_of_fx_2_1_17
        - lost_raising_tilt_by_J_z_tilt * part_of_fx_2_1_18
    )
    fp[2, 3] = (inverse_determinant) * (
        -mass_pan_tilt_slide_tilt_sq * part_of_fp_2_3_2 - minus_mass_tilt_part_of_fp_2_3
    )
    part_of_fp_3_3 = -mass_pan_tilt_slide_tilt_sq * part_of_fp_2_3
    fp[3, 3] = part_of_fx_3_0 * (mass_pan * part_of_fp_2_3_2 + part_of_fp_3_3)
    part_of_fp_2_4 = c_x_payload_c_y_payload_sin_tilt - c_y_payload_c_z_payload_cos_tilt
    part_of_fp_2_4_2 = (
        c_x_payload * part_of_follower_inertia_tilt_3 * sin_tilt
        + c_x_payload_sq * cos_tilt_sq
        + c_y_payload_sq_cos_tilt_sq
        + c_y_payload_sq_sin_tilt_sq
        + c_z_payload_sq * sin_tilt_sq
    )
    c_x_payload_omega_tilt_sq = c_x_payload * omega_tilt_sq
    c_z_payload_omega_tilt_sq = c_z_payload * omega_tilt_sq
    part_of_fp_2_4_3 = (
        -2.0 * c_x_payload * c_z_payload * omega_pan * omega_tilt * sin_tilt_sq
        + c_x_payload_c_z_payload * cos_tilt_sq_part_of_fx_2_1_7
        + c_x_payload_omega_tilt_sq * c_y_payload * cos_tilt
        - 2.0 * c_x_payload_sq * cos_tilt * omega_pan * omega_tilt * sin_tilt
        + c_y_payload_sin_tilt * c_z_payload_omega_tilt_sq
        + c_z_payload_sq * part_of_fp_2_1
    )
    part_of_fp_2_4_4 = (
        -accel_pan * part_of_fp_2_4_2 - accel_tilt * part_of_fp_2_4 - part_of_fp_2_4_3
    )
    follower_coupling_tilt_by_m_payload = part_of_fp_2_4
    follower_inertia_tilt_by_m_payload = part_of_fp_2_4_2
    part_of_load_inertia_tilt_by_m_payload = c_x_payload_sq + c_z_payload_sq
    load_inertia_tilt_by_m_payload = (
        -follower_coupling_tilt_by_m_payload * part_of_load_inertia_tilt_by_theta_tilt
        + follower_inertia_tilt_by_m_payload * part_of_load_inertia_tilt_by_theta_tilt_3
        + part_of_load_inertia_tilt_by_m_payload
    )
    follower_torque_tilt_by_m_payload = -part_of_fp_2_4_3
    part_of_load_torque_tilt_by_m_payload = c_x_payload_sq * cos_tilt_sin_tilt_omega_pan_sq
    load_torque_tilt_by_m_payload = (
        c_z_payload_sq * cos_tilt_sin_tilt_omega_pan_sq
        + cos_tilt * part_of_load_torque_tilt
        - follower_coupling_tilt_by_m_payload * part_of_load_torque_tilt_by_theta_tilt
        + follower_inertia_tilt_by_m_payload * part_of_load_torque_tilt_by_J_pan
        - follower_torque_tilt_by_m_payload * part_of_load_torque_tilt_by_theta_pan
        + part_of_load_torque_tilt_2 * sin_tilt
        + part_of_load_torque_tilt_5
        - part_of_load_torque_tilt_6
        - part_of_load_torque_tilt_by_m_payload
    )
    carried_tilt_by_m_payload = (
        -J_motor_tilt_ratio_tilt_sq * load_torque_tilt_by_m_payload
        + driving_torque_tilt * load_inertia_tilt_by_m_payload
    )
    lost_lowering_tilt_by_m_payload = (
        (-1.0) * (load_inertia_tilt_by_m_payload) * (part_of_lost_lowering_tilt_by_theta_tilt_2)
    )
    lost_raising_tilt_by_m_payload = (
        (-1.0) * (load_inertia_tilt_by_m_payload) * (part_of_lost_raising_tilt_by_theta_tilt_2)
    )
    part_of_fp_2_4_5 = (
        -accel_pan * part_of_fp_2_4
        - accel_tilt * part_of_load_inertia_tilt_by_m_payload
        + c_x_payload * c_z_payload * cos_tilt_sq * omega_pan_sq
        + (9.81) * c_x_payload * cos_tilt
        + (9.81) * c_z_payload * sin_tilt
        + c_z_payload_sq * cos_tilt * omega_pan_sq * sin_tilt
        - carried_tilt_by_m_payload * part_of_fx_2_0_3_slide_tilt
        - lost_lowering_tilt_by_m_payload * part_of_fx_2_1_17
        - lost_raising_tilt_by_m_payload * part_of_fx_2_1_18
        - part_of_load_torque_tilt_6
        - part_of_load_torque_tilt_by_m_payload
    )
    fp[2, 4] = (inverse_determinant) * (
        -mass_pan_tilt_slide_tilt_sq * part_of_fp_2_4_5 + mass_tilt * part_of_fp_2_4_4
    )
    fp[3, 4] = (part_of_fx_3_0) * (
        mass_pan * part_of_fp_2_4_5 - mass_pan_tilt_slide_tilt_sq * part_of_fp_2_4_4
    )
    follower_inertia_tilt_by_J_x_payload = sin_tilt_sq
    load_inertia_tilt_by_J_x_payload = (follower_inertia_tilt_by_J_x_payload) * (
        part_of_load_inertia_tilt_by_theta_tilt_3
    )
    follower_torque_tilt_by_J_x_payload = minus_part_of_fp_2_1
    load_torque_tilt_by_J_x_payload = (
        cos_tilt_sin_tilt_omega_pan_sq
        + follower_inertia_tilt_by_J_x_payload * part_of_load_torque_tilt_by_J_pan
        - follower_torque_tilt_by_J_x_payload * part_of_load_torque_tilt_by_theta_pan
    )
    carried_tilt_by_J_x_payload = (
        -J_motor_tilt_ratio_tilt_sq * load_torque_tilt_by_J_x_payload
        + driving_torque_tilt * load_inertia_tilt_by_J_x_payload
    )
    lost_lowering_tilt_by_J_x_payload = (
        (-1.0) * (load_inertia_tilt_by_J_x_payload) * (part_of_lost_lowering_tilt_by_theta_tilt_2)
    )
    lost_raising_tilt_by_J_x_payload = (
        (-1.0) * (load_inertia_tilt_by_J_x_payload) * (part_of_lost_raising_tilt_by_theta_tilt_2)
    )
    part_of_fp_2_5 = (
        -carried_tilt_by_J_x_payload * part_of_fx_2_0_3_slide_tilt
        - lost_lowering_tilt_by_J_x_payload * part_of_fx_2_1_17
        - lost_raising_tilt_by_J_x_payload * part_of_fx_2_1_18
        - part_of_fp_2_1_3
    )
    fp[2, 5] = (inverse_determinant) * (
        -mass_pan_tilt_slide_tilt_sq * part_of_fp_2_5 - minus_mass_tilt_part_of_fp_2_1_2
    )
    fp[3, 5] = part_of_fx_3_0 * (mass_pan * part_of_fp_2_5 + part_of_fp_3_1)
    load_inertia_tilt_by_J_y_payload = 1.0
    carried_tilt_by_J_y_payload = driving_torque_tilt * load_inertia_tilt_by_J_y_payload
    lost_lowering_tilt_by_J_y_payload = (
        (-1.0) * (load_inertia_tilt_by_J_y_payload) * (part_of_lost_lowering_tilt_by_theta_tilt_2)
    )
    lost_raising_tilt_by_J_y_payload = (
        (-1.0) * (load_inertia_tilt_by_J_y_payload) * (part_of_lost_raising_tilt_by_theta_tilt_2)
    )
    part_of_fp_2_6 = (
        -accel_tilt
        - carried_tilt_by_J_y_payload * part_of_fx_2_0_3_slide_tilt
        - lost_lowering_tilt_by_J_y_payload * part_of_fx_2_1_17
        - lost_raising_tilt_by_J_y_payload * part_of_fx_2_1_18
    )
    fp[2, 6] = -part_of_fp_2_6 * part_of_fx_2_7_2
    fp[3, 6] = mass_pan_part_of_fx_3_0 * part_of_fp_2_6
    follower_inertia_tilt_by_J_z_payload = cos_tilt_sq
    load_inertia_tilt_by_J_z_payload = (follower_inertia_tilt_by_J_z_payload) * (
        part_of_load_inertia_tilt_by_theta_tilt_3
    )
    follower_torque_tilt_by_J_z_payload = part_of_fp_2_1
    load_torque_tilt_by_J_z_payload = (
        -cos_tilt_sin_tilt_omega_pan_sq
        + follower_coupling_tilt
        * follower_inertia_tilt_by_J_z_payload
        * follower_torque_tilt
        * part_of_load_inertia_tilt_by_theta_tilt_2
        - follower_torque_tilt_by_J_z_payload * part_of_load_torque_tilt_by_theta_pan
    )
    carried_tilt_by_J_z_payload = (
        -J_motor_tilt_ratio_tilt_sq * load_torque_tilt_by_J_z_payload
        + driving_torque_tilt * load_inertia_tilt_by_J_z_payload
    )
    lost_lowering_tilt_by_J_z_payload = (
        (-1.0) * (load_inertia_tilt_by_J_z_payload) * (part_of_lost_lowering_tilt_by_theta_tilt_2)
    )
    lost_raising_tilt_by_J_z_payload = (
        (-1.0) * (load_inertia_tilt_by_J_z_payload) * (part_of_lost_raising_tilt_by_theta_tilt_2)
    )
    part_of_fp_2_7 = (
        -carried_tilt_by_J_z_payload * part_of_fx_2_0_3_slide_tilt
        - cos_tilt_sin_tilt_omega_pan_sq
        - lost_lowering_tilt_by_J_z_payload * part_of_fx_2_1_17
        - lost_raising_tilt_by_J_z_payload * part_of_fx_2_1_18
    )
    fp[2, 7] = (inverse_determinant) * (
        -mass_pan_tilt_slide_tilt_sq * part_of_fp_2_7 - minus_mass_tilt_part_of_fp_2_3
    )
    fp[3, 7] = part_of_fx_3_0 * (mass_pan * part_of_fp_2_7 + part_of_fp_3_3)
    part_of_fp_2_8 = m_payload_sin_tilt * part_of_follower_inertia_tilt_3
    part_of_fp_2_8_2 = part_of_follower_torque_tilt_8 + part_of_fp_2_8
    part_of_fp_2_8_3 = c_y_payload_cos_tilt_m_payload * omega_tilt_sq
    part_of_fp_2_8_4 = c_z_payload * part_of_follower_torque_tilt_6
    part_of_fp_2_8_5 = cos_tilt_sq * omega_pan_omega_tilt * part_of_fp_2_8_4
    part_of_fp_2_8_6 = (
        -accel_pan * part_of_fp_2_8_2
        - accel_tilt * c_y_payload_sin_tilt_m_payload
        + 4.0 * c_x_payload * cos_tilt * m_payload * omega_pan * omega_tilt * sin_tilt
        + 2.0 * c_z_payload * m_payload * omega_pan * omega_tilt * sin_tilt_sq
        - part_of_fp_2_8_3
        - part_of_fp_2_8_5
    )
    follower_coupling_tilt_by_c_x_payload = c_y_payload_sin_tilt_m_payload
    follower_inertia_tilt_by_c_x_payload = part_of_fp_2_8_2
    load_inertia_tilt_by_c_x_payload = (
        -follower_coupling_tilt_by_c_x_payload * part_of_load_inertia_tilt_by_theta_tilt
        + follower_inertia_tilt_by_c_x_payload * part_of_load_inertia_tilt_by_theta_tilt_3
        + part_of_follower_torque_tilt_7
    )
    part_of_fp_2_8_4_sin_tilt_sq = part_of_fp_2_8_4 * sin_tilt_sq
    part_of_follower_torque_tilt_by_c_x_payload = c_x_payload_m_payload_sin_tilt * cos_tilt
    part_of_follower_torque_tilt_by_c_x_payload_2 = 4.0 * omega_pan_omega_tilt
    follower_torque_tilt_by_c_x_payload = (
        omega_pan_omega_tilt * part_of_fp_2_8_4_sin_tilt_sq
        + part_of_follower_torque_tilt_by_c_x_payload
        * part_of_follower_torque_tilt_by_c_x_payload_2
        - part_of_fp_2_8_3
        - part_of_fp_2_8_5
    )
    part_of_load_torque_tilt_by_c_x_payload = 2.0 * part_of_follower_torque_tilt_by_c_x_payload
    part_of_load_torque_tilt_by_c_x_payload_2 = (
        -c_z_payload * cos_tilt_sq * m_payload * omega_pan_sq
        + c_z_payload * m_payload * omega_pan_sq_sin_tilt_sq
        - 9.81 * cos_tilt * m_payload
        + omega_pan_sq * part_of_load_torque_tilt_by_c_x_payload
    )
    load_torque_tilt_by_c_x_payload = (
        follower_coupling_tilt
        * follower_inertia_tilt_by_c_x_payload
        * follower_torque_tilt
        * part_of_load_inertia_tilt_by_theta_tilt_2
        - follower_coupling_tilt_by_c_x_payload * part_of_load_torque_tilt_by_theta_tilt
        - follower_torque_tilt_by_c_x_payload * part_of_load_torque_tilt_by_theta_pan
        - part_of_load_torque_tilt_by_c_x_payload_2
    )
    carried_tilt_by_c_x_payload = (
        -J_motor_tilt_ratio_tilt_sq * load_torque_tilt_by_c_x_payload
        + driving_torque_tilt * load_inertia_tilt_by_c_x_payload
    )
    lost_lowering_tilt_by_c_x_payload = (
        (-1.0) * (load_inertia_tilt_by_c_x_payload) * (part_of_lost_lowering_tilt_by_theta_tilt_2)
    )
    lost_raising_tilt_by_c_x_payload = (
        (-1.0) * (load_inertia_tilt_by_c_x_payload) * (part_of_lost_raising_tilt_by_theta_tilt_2)
    )
    part_of_fp_2_8_7 = (
        -accel_pan * c_y_payload_sin_tilt_m_payload
        - accel_tilt * part_of_follower_torque_tilt_7
        - carried_tilt_by_c_x_payload * part_of_fx_2_0_3_slide_tilt
        - lost_lowering_tilt_by_c_x_payload * part_of_fx_2_1_17
        - lost_raising_tilt_by_c_x_payload * part_of_fx_2_1_18
        - part_of_load_torque_tilt_by_c_x_payload_2
    )
    fp[2, 8] = (inverse_determinant) * (
        -mass_pan_tilt_slide_tilt_sq * part_of_fp_2_8_7 + mass_tilt * part_of_fp_2_8_6
    )
    fp[3, 8] = (part_of_fx_3_0) * (
        mass_pan * part_of_fp_2_8_7 - mass_pan_tilt_slide_tilt_sq * part_of_fp_2_8_6
    )
    part_of_fp_2_9 = c_x_payload_m_payload_sin_tilt - c_z_payload_cos_tilt * m_payload
    part_of_fp_2_9_2 = c_y_payload * part_of_follower_torque_tilt_6
    part_of_fp_2_9_3 = cos_tilt_sq * part_of_fp_2_9_2 + part_of_fp_2_9_2 * sin_tilt_sq
    part_of_fp_2_9_4 = (
        c_x_payload_omega_tilt_sq * cos_tilt_m_payload
        + c_z_payload_omega_tilt_sq * m_payload_sin_tilt
    )
    part_of_fp_2_9_5 = (
        -accel_pan * part_of_fp_2_9_3 - accel_tilt * part_of_fp_2_9 - part_of_fp_2_9_4
    )
    follower_coupling_tilt_by_c_y_payload = part_of_fp_2_9
    follower_inertia_tilt_by_c_y_payload = part_of_fp_2_9_3
    load_inertia_tilt_by_c_y_payload = (
        -follower_coupling_tilt_by_c_y_payload * part_of_load_inertia_tilt_by_theta_tilt
        + follower_inertia_tilt_by_c_y_payload * part_of_load_inertia_tilt_by_theta_tilt_3
    )
    follower_torque_tilt_by_c_y_payload = -part_of_fp_2_9_4
    load_torque_tilt_by_c_y_payload = (
        follower_coupling_tilt
        * follower_inertia_tilt_by_c_y_payload
        * follower_torque_tilt
        * part_of_load_inertia_tilt_by_theta_tilt_2
        - follower_coupling_tilt_by_c_y_payload * part_of_load_torque_tilt_by_theta_tilt
        - follower_torque_tilt_by_c_y_payload * part_of_load_torque_tilt_by_theta_pan
    )
    carried_tilt_by_c_y_payload = (
        -J_motor_tilt_ratio_tilt_sq * load_torque_tilt_by_c_y_payload
        + driving_torque_tilt * load_inertia_tilt_by_c_y_payload
    )
    lost_lowering_tilt_by_c_y_payload = (
        (-1.0) * (load_inertia_tilt_by_c_y_payload) * (part_of_lost_lowering_tilt_by_theta_tilt_2)
    )
    lost_raising_tilt_by_c_y_payload = (
        (-1.0) * (load_inertia_tilt_by_c_y_payload) * (part_of_lost_raising_tilt_by_theta_tilt_2)
    )
    part_of_fp_2_9_6 = (
        -accel_pan * part_of_fp_2_9
        - carried_tilt_by_c_y_payload * part_of_fx_2_0_3_slide_tilt
        - lost_lowering_tilt_by_c_y_payload * part_of_fx_2_1_17
        - lost_raising_tilt_by_c_y_payload * part_of_fx_2_1_18
    )
    fp[2, 9] = (inverse_determinant) * (
        -mass_pan_tilt_slide_tilt_sq * part_of_fp_2_9_6 + mass_tilt * part_of_fp_2_9_5
    )
    fp[3, 9] = (part_of_fx_3_0) * (
        mass_pan * part_of_fp_2_9_6 - mass_pan_tilt_slide_tilt_sq * part_of_fp_2_9_5
    )
    part_of_fp_2_10 = part_of_fp_2_8_4_sin_tilt_sq + part_of_load_torque_tilt_by_c_x_payload
    part_of_fp_2_10_2 = (
        -2.0 * c_x_payload * m_payload * omega_pan * omega_tilt * sin_tilt_sq
        + c_y_payload_sin_tilt_m_payload * omega_tilt_sq
        + c_z_payload_cos_tilt * m_payload_sin_tilt * part_of_follower_torque_tilt_by_c_x_payload_2
        + omega_pan_omega_tilt * part_of_follower_torque_tilt_8
    )
    part_of_fp_2_10_3 = (
        -accel_pan * part_of_fp_2_10
        + accel_tilt * c_y_payload * cos_tilt * m_payload
        - part_of_fp_2_10_2
    )
    follower_coupling_tilt_by_c_z_payload = -c_y_payload_cos_tilt_m_payload
    follower_inertia_tilt_by_c_z_payload = part_of_fp_2_10
    load_inertia_tilt_by_c_z_payload = (
        -follower_coupling_tilt_by_c_z_payload * part_of_load_inertia_tilt_by_theta_tilt
        + follower_inertia_tilt_by_c_z_payload * part_of_load_inertia_tilt_by_theta_tilt_3
        + part_of_fp_2_8_4
    )
    follower_torque_tilt_by_c_z_payload = -part_of_fp_2_10_2
    c_x_payload_m_payload = c_x_payload * m_payload
    part_of_load_torque_tilt_by_c_z_payload = c_x_payload_m_payload * omega_pan_sq_sin_tilt_sq
    load_torque_tilt_by_c_z_payload = (
        c_x_payload_m_payload * cos_tilt_sq_omega_pan_sq
        - follower_coupling_tilt_by_c_z_payload * part_of_load_torque_tilt_by_theta_tilt
        + follower_inertia_tilt_by_c_z_payload * part_of_load_torque_tilt_by_J_pan
        - follower_torque_tilt_by_c_z_payload * part_of_load_torque_tilt_by_theta_pan
        + (9.81) * m_payload_sin_tilt
        + omega_pan_sq * part_of_fp_2_8
        - part_of_load_torque_tilt_by_c_z_payload
    )
    carried_tilt_by_c_z_payload = (
        -J_motor_tilt_ratio_tilt_sq * load_torque_tilt_by_c_z_payload
        + driving_torque_tilt * load_inertia_tilt_by_c_z_payload
    )
    lost_lowering_tilt_by_c_z_payload = (
        (-1.0) * (load_inertia_tilt_by_c_z_payload) * (part_of_lost_lowering_tilt_by_theta_tilt_2)
    )
    lost_raising_tilt_by_c_z_payload = (
        (-1.0) * (load_inertia_tilt_by_c_z_payload) * (part_of_lost_raising_tilt_by_theta_tilt_2)
    )
    part_of_fp_2_10_4 = (
        accel_pan * c_y_payload * cos_tilt * m_payload
        - accel_tilt * part_of_fp_2_8_4
        + c_x_payload * cos_tilt_sq * m_payload * omega_pan_sq
        + 2.0 * c_z_payload * cos_tilt * m_payload * omega_pan_sq * sin_tilt
        - carried_tilt_by_c_z_payload * part_of_fx_2_0_3_slide_tilt
        - lost_lowering_tilt_by_c_z_payload * part_of_fx_2_1_17
        - lost_raising_tilt_by_c_z_payload * part_of_fx_2_1_18
        + (9.81) * m_payload * sin_tilt
        - part_of_load_torque_tilt_by_c_z_payload
    )
    fp[2, 10] = (inverse_determinant) * (
        -mass_pan_tilt_slide_tilt_sq * part_of_fp_2_10_4 + mass_tilt * part_of_fp_2_10_3
    )
    fp[3, 10] = (part_of_fx_3_0) * (
        mass_pan * part_of_fp_2_10_4 - mass_pan_tilt_slide_tilt_sq * part_of_fp_2_10_3
    )
    follower_torque_tilt_by_b_pan = minus_omega_pan
    load_torque_tilt_by_b_pan = (
        -follower_torque_tilt_by_b_pan * part_of_load_torque_tilt_by_theta_pan
    )
    carried_tilt_by_b_pan = -J_motor_tilt_ratio_tilt_sq * load_torque_tilt_by_b_pan
    fp[2, 11] = inverse_determinant * (
        carried_tilt_by_b_pan * part_of_fx_2_4 - mass_tilt * omega_pan
    )
    fp[3, 11] = (part_of_fx_3_0) * (
        -carried_tilt_by_b_pan * part_of_fx_3_0_3 + mass_pan_tilt * omega_pan * slide_tilt_sq
    )
    fp[6, 12] = (K_t_pan_N_pan * omega_gear_pan + R_pan * i_pan - u_pan) / (L_pan * L_pan)
    fp[6, 13] = -L_pan_inverse * i_pan
    fp[5, 14] = N_pan * i_pan * part_of_fx_5_0
    L_pan_inverse_omega_gear_pan = L_pan_inverse * omega_gear_pan
    fp[6, 14] = -L_pan_inverse_omega_gear_pan * N_pan
    force_gear_pan = (
        K_t_pan * N_pan * i_pan
        - part_of_follower_torque_tilt_14
        - slide_pan
        * (
            F_c_pan_part_of_fx_5_5_6
            + F_v_pan_part_of_fx_5_5_slide_pan * omega_gear_pan
            + part_of_fx_5_5_9
        )
    )
    accel_gear_pan = force_gear_pan * part_of_fx_5_0
    fp[5, 15] = -N_pan_sq * accel_gear_pan * part_of_fx_5_0
    fp[5, 16] = part_of_fx_5_0 * (-2.0 * J_motor_pan * N_pan * accel_gear_pan + K_t_pan * i_pan)
    fp[6, 16] = -K_t_pan * L_pan_inverse_omega_gear_pan
    part_of_follower_torque_tilt_by_k_shaft_pan = active_pan * part_of_follower_torque_tilt_13
    follower_torque_tilt_by_k_shaft_pan = part_of_follower_torque_tilt_by_k_shaft_pan
    load_torque_tilt_by_k_shaft_pan = (
        (-1.0) * (follower_torque_tilt_by_k_shaft_pan) * (part_of_load_torque_tilt_by_theta_pan)
    )
    carried_tilt_by_k_shaft_pan = -J_motor_tilt_ratio_tilt_sq * load_torque_tilt_by_k_shaft_pan
    fp[2, 17] = (inverse_determinant) * (
        carried_tilt_by_k_shaft_pan * part_of_fx_2_4
        + mass_tilt * part_of_follower_torque_tilt_by_k_shaft_pan
    )
    fp[3, 17] = (part_of_fx_3_0) * (
        -carried_tilt_by_k_shaft_pan * part_of_fx_3_0_3
        - mass_pan_tilt_slide_tilt_sq * part_of_follower_torque_tilt_by_k_shaft_pan
    )
    fp[5, 17] = -part_of_follower_torque_tilt_by_k_shaft_pan * part_of_fx_5_0
    part_of_follower_torque_tilt_by_d_shaft_pan = active_pan * part_of_follower_torque_tilt_11
    follower_torque_tilt_by_d_shaft_pan = part_of_follower_torque_tilt_by_d_shaft_pan
    load_torque_tilt_by_d_shaft_pan = (
        (-1.0) * (follower_torque_tilt_by_d_shaft_pan) * (part_of_load_torque_tilt_by_theta_pan)
    )
    carried_tilt_by_d_shaft_pan = -J_motor_tilt_ratio_tilt_sq * load_torque_tilt_by_d_shaft_pan
    fp[2, 18] = (inverse_determinant) * (
        carried_tilt_by_d_shaft_pan * part_of_fx_2_4
        + mass_tilt * part_of_follower_torque_tilt_by_d_shaft_pan
    )
    fp[3, 18] = (part_of_fx_3_0) * (
        -carried_tilt_by_d_shaft_pan * part_of_fx_3_0_3
        - mass_pan_tilt_slide_tilt_sq * part_of_follower_torque_tilt_by_d_shaft_pan
    )
    fp[5, 18] = -part_of_follower_torque_tilt_by_d_shaft_pan * part_of_fx_5_0
    part_of_follower_torque_tilt_by_gap_pan = (
        active_pan_k_shaft_pan * part_of_follower_torque_tilt_12
    )
    follower_torque_tilt_by_gap_pan = -part_of_follower_torque_tilt_by_gap_pan
    load_torque_tilt_by_gap_pan = (
        (-1.0) * (follower_torque_tilt_by_gap_pan) * (part_of_load_torque_tilt_by_theta_pan)
    )
    carried_tilt_by_gap_pan = -J_motor_tilt_ratio_tilt_sq * load_torque_tilt_by_gap_pan
    fp[2, 19] = (inverse_determinant) * (
        -active_pan_k_shaft_pan_mass_tilt * part_of_follower_torque_tilt_12
        + carried_tilt_by_gap_pan * mass_pan_tilt * part_of_fx_2_0_3 * slide_tilt_cubed
    )
    fp[3, 19] = (part_of_fx_3_0) * (
        -carried_tilt_by_gap_pan * part_of_fx_3_0_3
        + mass_pan_tilt_slide_tilt_sq * part_of_follower_torque_tilt_by_gap_pan
    )
    fp[5, 19] = part_of_follower_torque_tilt_by_gap_pan * part_of_fx_5_0
    part_of_fp_5_20 = inverse_mass_gear_pan * (slide_pan * slide_pan * slide_pan)
    fp[5, 20] = -part_of_fp_5_20 * (-part_of_fx_5_5_6 * part_of_fx_5_5_8 + part_of_fx_5_5_6)
    fp[5, 21] = -part_of_fp_5_20 * part_of_fx_5_5_7 * part_of_fx_5_5_8
    part_of_fp_5_22 = omega_gear_pan_sq * part_of_fx_5_5_10
    fp[5, 22] = (
        (-1.0)
        * (part_of_fp_5_20)
        * (part_of_fp_5_22)
        * (part_of_fx_5_5_4)
        * (1.0 / (v_s_pan * v_s_pan * v_s_pan))
    )
    part_of_fp_5_23 = inverse_mass_gear_pan * (slide_pan * slide_pan * slide_pan * slide_pan)
    fp[5, 23] = -omega_gear_pan * part_of_fp_5_23 * part_of_fx_5_5
    F_c_pan_slide_pan = F_c_pan * slide_pan
    fp[5, 24] = -part_of_fp_5_20 * (-F_c_pan_slide_pan * part_of_fx_5_5_8 + F_c_pan_slide_pan)
    fp[5, 25] = -F_s_pan * part_of_fp_5_23 * part_of_fx_5_5_8
    fp[5, 26] = (
        (-1.0)
        * (part_of_fp_5_22)
        * (part_of_fp_5_23)
        * (part_of_fx_5_5_2)
        * (1.0 / (part_of_fx_5_5_3 * part_of_fx_5_5_3 * part_of_fx_5_5_3))
    )
    fp[5, 27] = -F_v_pan * inverse_mass_gear_pan * omega_gear_pan * slide_pan**5.0
    load_torque_tilt_by_b_tilt = -omega_tilt
    carried_tilt_by_b_tilt = -J_motor_tilt_ratio_tilt_sq * load_torque_tilt_by_b_tilt
    part_of_fp_2_28 = -carried_tilt_by_b_tilt * part_of_fx_2_0_3_slide_tilt - omega_tilt
    fp[2, 28] = -part_of_fp_2_28 * part_of_fx_2_7_2
    fp[3, 28] = mass_pan_part_of_fx_3_0 * part_of_fp_2_28
    fp[7, 29] = (K_t_tilt_ratio_tilt * omega_tilt + R_tilt * i_tilt - u_tilt) / (L_tilt * L_tilt)
    fp[7, 30] = -L_tilt_inverse * i_tilt
    driving_torque_tilt_by_K_t_tilt = i_tilt * ratio_tilt
    carried_tilt_by_K_t_tilt = driving_torque_tilt_by_K_t_tilt * load_inertia_tilt
    part_of_fp_2_31 = -carried_tilt_by_K_t_tilt * part_of_fx_2_0_3_slide_tilt + i_tilt * ratio_tilt
    fp[2, 31] = -part_of_fp_2_31 * part_of_fx_2_7_2
    fp[3, 31] = mass_pan_part_of_fx_3_0 * part_of_fp_2_31
    fp[7, 31] = -L_tilt_inverse * omega_tilt_ratio_tilt
    part_of_driving_torque_tilt_by_J_motor_tilt = part_of_driving_torque_tilt * ratio_tilt
    driving_torque_tilt_by_J_motor_tilt = -part_of_driving_torque_tilt_by_J_motor_tilt
    carried_tilt_by_J_motor_tilt = (
        driving_torque_tilt_by_J_motor_tilt * load_inertia_tilt - load_torque_tilt * ratio_tilt_sq
    )
    lost_lowering_tilt_by_J_motor_tilt = -part_of_lost_lowering_tilt_by_theta_tilt * ratio_tilt_sq
    lost_raising_tilt_by_J_motor_tilt = -part_of_lost_raising_tilt_by_theta_tilt * ratio_tilt_sq
    part_of_fp_2_32 = (
        -accel_tilt * ratio_tilt_sq
        - carried_tilt_by_J_motor_tilt * part_of_fx_2_0_3_slide_tilt
        - lost_lowering_tilt_by_J_motor_tilt * part_of_fx_2_1_17
        - lost_raising_tilt_by_J_motor_tilt * part_of_fx_2_1_18
        - part_of_driving_torque_tilt_by_J_motor_tilt
    )
    fp[2, 32] = -part_of_fp_2_32 * part_of_fx_2_7_2
    fp[3, 32] = mass_pan_part_of_fx_3_0 * part_of_fp_2_32
    omega_tilt_ratio_tilt_sq = omega_tilt * ratio_tilt_sq
    driving_torque_tilt_by_b_motor_tilt = -omega_tilt_ratio_tilt_sq
    carried_tilt_by_b_motor_tilt = driving_torque_tilt_by_b_motor_tilt * load_inertia_tilt
    part_of_fp_2_33 = (
        -carried_tilt_by_b_motor_tilt * part_of_fx_2_0_3_slide_tilt - omega_tilt_ratio_tilt_sq
    )
    fp[2, 33] = -part_of_fp_2_33 * part_of_fx_2_7_2
    fp[3, 33] = mass_pan_part_of_fx_3_0 * part_of_fp_2_33
    ratio_tilt_by_N_tilt = part_of_ratio_tilt_4
    ratio_tilt_by_theta_tilt_by_N_tilt = (
        -part_of_ratio_tilt * part_of_ratio_tilt_by_theta_tilt_5
        + part_of_ratio_tilt_by_theta_tilt_2
    )
    part_of_driving_torque_tilt_by_N_tilt = (
        part_of_driving_torque_tilt_by_theta_tilt * ratio_tilt_by_theta_tilt_by_N_tilt
        - part_of_driving_torque_tilt_by_theta_tilt_2 * ratio_tilt_by_N_tilt
    )
    driving_torque_tilt_by_N_tilt = -part_of_driving_torque_tilt_by_N_tilt
    part_of_carried_tilt_by_N_tilt = 2.0 * part_of_carried_tilt_by_theta_tilt_2
    carried_tilt_by_N_tilt = (
        driving_torque_tilt_by_N_tilt * load_inertia_tilt
        - part_of_carried_tilt_by_N_tilt * ratio_tilt_by_N_tilt
    )
    part_of_lost_lowering_tilt_by_N_tilt = 2.0 * part_of_lost_lowering_tilt_by_theta_tilt_3
    lost_lowering_tilt_by_N_tilt = -part_of_lost_lowering_tilt_by_N_tilt * ratio_tilt_by_N_tilt
    part_of_lost_raising_tilt_by_N_tilt = 2.0 * part_of_lost_raising_tilt_by_theta_tilt_3
    lost_raising_tilt_by_N_tilt = -part_of_lost_raising_tilt_by_N_tilt * ratio_tilt_by_N_tilt
    part_of_fp_2_34 = 2.0 * part_of_fx_2_1_19
    part_of_fp_2_34_2 = (
        -carried_tilt_by_N_tilt * part_of_fx_2_0_3_slide_tilt
        - lost_lowering_tilt_by_N_tilt * part_of_fx_2_1_17
        - lost_raising_tilt_by_N_tilt * part_of_fx_2_1_18
        - part_of_driving_torque_tilt_by_N_tilt
        - part_of_fp_2_34 * ratio_tilt_by_N_tilt
    )
    fp[2, 34] = -part_of_fp_2_34_2 * part_of_fx_2_7_2
    fp[3, 34] = mass_pan_part_of_fx_3_0 * part_of_fp_2_34_2
    fp[7, 34] = -part_of_fx_7_1 * ratio_tilt_by_N_tilt
    part_of_ratio_tilt_by_lead_tilt = 1.0 / (lead_tilt * lead_tilt)
    part_of_ratio_tilt_by_lead_tilt_2 = (
        math.pi * length_tilt_inverse * part_of_ratio_tilt_by_lead_tilt
    )
    ratio_tilt_by_lead_tilt = -N_tilt_part_of_ratio_tilt * part_of_ratio_tilt_by_lead_tilt_2
    ratio_tilt_by_theta_tilt_by_lead_tilt = (
        math.pi
        * N_tilt
        * length_tilt_by_theta_tilt
        * part_of_ratio_tilt
        * part_of_ratio_tilt_by_lead_tilt
        * part_of_ratio_tilt_by_theta_tilt_3
        - part_of_ratio_tilt_by_lead_tilt_2 * part_of_ratio_tilt_by_theta_tilt_by_theta_tilt_2
    )
    part_of_driving_torque_tilt_by_lead_tilt = (
        part_of_driving_torque_tilt_by_theta_tilt * ratio_tilt_by_theta_tilt_by_lead_tilt
        - part_of_driving_torque_tilt_by_theta_tilt_2 * ratio_tilt_by_lead_tilt
    )
    driving_torque_tilt_by_lead_tilt = -part_of_driving_torque_tilt_by_lead_tilt
    carried_tilt_by_lead_tilt = (
        driving_torque_tilt_by_lead_tilt * load_inertia_tilt
        - part_of_carried_tilt_by_N_tilt * ratio_tilt_by_lead_tilt
    )
    part_of_lowered_tilt_by_lead_tilt = part_of_lowered_tilt * part_of_ratio_tilt_by_lead_tilt
    part_of_lowered_tilt_by_lead_tilt_2 = lead_tilt_inverse * part_of_lowered_tilt_2
    part_of_lowered_tilt_by_lead_tilt_3 = part_of_lowered_tilt_3 * part_of_lowered_tilt_4_inverse
    part_of_lowered_tilt_by_lead_tilt_4 = 1.0 / (part_of_lowered_tilt_4 * part_of_lowered_tilt_4)
    lowered_tilt_by_lead_tilt = (
        part_of_lowered_tilt_3
        * part_of_lowered_tilt_by_lead_tilt_2
        * part_of_lowered_tilt_by_lead_tilt_4
        + part_of_lowered_tilt_6
        + part_of_lowered_tilt_by_lead_tilt * part_of_lowered_tilt_by_lead_tilt_3
    )
    part_of_lost_lowering_tilt_by_lead_tilt = (
        -load_inertia_tilt * part_of_lost_lowering_tilt_by_theta_tilt - part_of_lost_lowering_tilt_3
    )
    lost_lowering_tilt_by_lead_tilt = (
        lowered_tilt_by_lead_tilt * part_of_lost_lowering_tilt_by_lead_tilt
        - part_of_lost_lowering_tilt_by_N_tilt * ratio_tilt_by_lead_tilt
    )
    part_of_raised_tilt_by_lead_tilt = part_of_raised_tilt * part_of_raised_tilt_2_inverse
    part_of_raised_tilt_by_lead_tilt_2 = (part_of_raised_tilt) * (
        1.0 / (part_of_raised_tilt_2 * part_of_raised_tilt_2)
    )
    raised_tilt_by_lead_tilt = (
        -part_of_lowered_tilt_by_lead_tilt * part_of_raised_tilt_by_lead_tilt
        + part_of_lowered_tilt_by_lead_tilt_2 * part_of_raised_tilt_by_lead_tilt_2
        + part_of_raised_tilt_4
    )
    part_of_lost_raising_tilt_by_lead_tilt = (
        -load_inertia_tilt * part_of_lost_raising_tilt_by_theta_tilt
        + part_of_lost_raising_tilt_2_inverse
    )
    lost_raising_tilt_by_lead_tilt = (
        -part_of_lost_raising_tilt_by_N_tilt * ratio_tilt_by_lead_tilt
        + part_of_lost_raising_tilt_by_lead_tilt * raised_tilt_by_lead_tilt
    )
    part_of_fp_2_35 = (
        -carried_tilt_by_lead_tilt * part_of_fx_2_0_3_slide_tilt
        - lost_lowering_tilt_by_lead_tilt * part_of_fx_2_1_17
        - lost_raising_tilt_by_lead_tilt * part_of_fx_2_1_18
        - part_of_driving_torque_tilt_by_lead_tilt
        - part_of_fp_2_34 * ratio_tilt_by_lead_tilt
    )
    fp[2, 35] = -part_of_fp_2_35 * part_of_fx_2_7_2
    fp[3, 35] = mass_pan_part_of_fx_3_0 * part_of_fp_2_35
    fp[7, 35] = -part_of_fx_7_1 * ratio_tilt_by_lead_tilt
    part_of_lowered_tilt_by_d_screw_tilt = math.pi * math.pi
    part_of_lowered_tilt_by_d_screw_tilt_2 = d_screw_tilt * part_of_lowered_tilt_by_d_screw_tilt
    part_of_lowered_tilt_by_d_screw_tilt_3 = f_screw_tilt * part_of_lowered_tilt_by_d_screw_tilt_2
    lowered_tilt_by_d_screw_tilt = (
        d_screw_tilt
        * lead_tilt_inverse
        * part_of_lowered_tilt_3
        * part_of_lowered_tilt_by_d_screw_tilt
        * part_of_lowered_tilt_by_lead_tilt_4
        - part_of_lowered_tilt_5 * part_of_lowered_tilt_by_d_screw_tilt_3
        - part_of_lowered_tilt_by_lead_tilt_3 * part_of_ratio_tilt_2
    )
    lost_lowering_tilt_by_d_screw_tilt = (lowered_tilt_by_d_screw_tilt) * (
        part_of_lost_lowering_tilt_by_lead_tilt
    )
    raised_tilt_by_d_screw_tilt = (
        -lead_tilt_inverse
        * part_of_lowered_tilt_by_d_screw_tilt_2
        * part_of_raised_tilt_by_lead_tilt_2
        + part_of_lowered_tilt_by_d_screw_tilt_3 * part_of_raised_tilt_3
        + part_of_raised_tilt_by_lead_tilt * part_of_ratio_tilt_2
    )
    lost_raising_tilt_by_d_screw_tilt = (part_of_lost_raising_tilt_by_lead_tilt) * (
        raised_tilt_by_d_screw_tilt
    )
    part_of_fp_2_36 = (
        -lost_lowering_tilt_by_d_screw_tilt * part_of_fx_2_1_17
        - lost_raising_tilt_by_d_screw_tilt * part_of_fx_2_1_18
    )
    fp[2, 36] = -part_of_fp_2_36 * part_of_fx_2_7_2
    fp[3, 36] = mass_pan_part_of_fx_3_0 * part_of_fp_2_36
    part_of_lowered_tilt_by_f_screw_tilt = (d_screw_tilt * d_screw_tilt) * (
        part_of_lowered_tilt_by_d_screw_tilt
    )
    lowered_tilt_by_f_screw_tilt = (
        math.pi * d_screw_tilt * part_of_lowered_tilt_3 * part_of_lowered_tilt_by_lead_tilt_4
        - part_of_lowered_tilt_5 * part_of_lowered_tilt_by_f_screw_tilt
    )
    lost_lowering_tilt_by_f_screw_tilt = (lowered_tilt_by_f_screw_tilt) * (
        part_of_lost_lowering_tilt_by_lead_tilt
    )
    raised_tilt_by_f_screw_tilt = (
        part_of_lowered_tilt * part_of_raised_tilt_by_lead_tilt_2
        + part_of_lowered_tilt_by_f_screw_tilt * part_of_raised_tilt_3
    )
    lost_raising_tilt_by_f_screw_tilt = (part_of_lost_raising_tilt_by_lead_tilt) * (
        raised_tilt_by_f_screw_tilt
    )
    part_of_fp_2_37 = (
        -lost_lowering_tilt_by_f_screw_tilt * part_of_fx_2_1_17
        - lost_raising_tilt_by_f_screw_tilt * part_of_fx_2_1_18
    )
    fp[2, 37] = -part_of_fp_2_37 * part_of_fx_2_7_2
    fp[3, 37] = mass_pan_part_of_fx_3_0 * part_of_fp_2_37
    linkage_cos_tilt_by_l_ground_tilt = 2.0 * l_ground_tilt
    part_of_linkage_sin_tilt_2_inverse = 1.0 / part_of_linkage_sin_tilt_2
    part_of_linkage_sin_tilt_by_l_ground_tilt = (
        linkage_cos_tilt * part_of_linkage_sin_tilt_2_inverse
    )
    linkage_sin_tilt_by_l_ground_tilt = (
        l_ground_tilt * part_of_linkage_sin_tilt * part_of_linkage_sin_tilt_2_inverse
        - linkage_cos_tilt_by_l_ground_tilt * part_of_linkage_sin_tilt_by_l_ground_tilt
    )
    part_of_length_tilt_by_l_ground_tilt = (0.5) * part_of_length_tilt_2_inverse
    part_of_length_tilt_by_l_ground_tilt_2 = cos_tilt * part_of_length_tilt_by_l_ground_tilt
    part_of_length_tilt_by_l_ground_tilt_3 = part_of_length_tilt_by_l_ground_tilt * sin_tilt
    length_tilt_by_l_ground_tilt = (
        l_ground_tilt * part_of_length_tilt_2_inverse
        - linkage_cos_tilt_by_l_ground_tilt * part_of_length_tilt_by_l_ground_tilt_2
        - linkage_sin_tilt_by_l_ground_tilt * part_of_length_tilt_by_l_ground_tilt_3
    )
    part_of_ratio_tilt_by_l_ground_tilt = N_tilt_part_of_ratio_tilt_3 * cos_tilt
    ratio_tilt_by_l_ground_tilt = (
        math.pi
        * N_tilt
        * lead_tilt_inverse
        * length_tilt_inverse
        * linkage_cos_tilt_by_l_ground_tilt
        * sin_tilt
        - length_tilt_by_l_ground_tilt * part_of_ratio_tilt_by_theta_tilt_by_theta_tilt
        - linkage_sin_tilt_by_l_ground_tilt * part_of_ratio_tilt_by_l_ground_tilt
    )
    part_of_length_tilt_by_theta_tilt_by_l_ground_tilt = (0.5) * (
        part_of_length_tilt_by_theta_tilt_by_theta_tilt
    )
    part_of_length_tilt_by_theta_tilt_by_l_ground_tilt_2 = (
        cos_tilt * part_of_length_tilt_by_theta_tilt_by_l_ground_tilt
        + part_of_length_tilt_by_l_ground_tilt_3
    )
    part_of_length_tilt_by_theta_tilt_by_l_ground_tilt_3 = (
        -part_of_length_tilt_by_l_ground_tilt_2
        + part_of_length_tilt_by_theta_tilt_by_l_ground_tilt * sin_tilt
    )
    length_tilt_by_theta_tilt_by_l_ground_tilt = (
        -l_ground_tilt * part_of_length_tilt_by_theta_tilt_by_theta_tilt
        + linkage_cos_tilt_by_l_ground_tilt * part_of_length_tilt_by_theta_tilt_by_l_ground_tilt_2
        + linkage_sin_tilt_by_l_ground_tilt * part_of_length_tilt_by_theta_tilt_by_l_ground_tilt_3
    )
    part_of_ratio_tilt_by_theta_tilt_by_l_ground_tilt = N_tilt * part_of_ratio_tilt_by_theta_tilt_5
    part_of_ratio_tilt_by_theta_tilt_by_l_ground_tilt_2 = (
        N_tilt_part_of_ratio_tilt_3 * sin_tilt
        + cos_tilt * part_of_ratio_tilt_by_theta_tilt_by_l_ground_tilt
    )
    part_of_ratio_tilt_by_theta_tilt_by_l_ground_tilt_3 = (
        part_of_ratio_tilt_by_l_ground_tilt
        - part_of_ratio_tilt_by_theta_tilt_by_l_ground_tilt * sin_tilt
    )
    ratio_tilt_by_theta_tilt_by_l_ground_tilt = (
        length_tilt_by_l_ground_tilt * part_of_ratio_tilt_by_theta_tilt_by_theta_tilt_4
        - length_tilt_by_theta_tilt_by_l_ground_tilt
        * part_of_ratio_tilt_by_theta_tilt_by_theta_tilt
        + linkage_cos_tilt_by_l_ground_tilt * part_of_ratio_tilt_by_theta_tilt_by_l_ground_tilt_3
        + linkage_sin_tilt_by_l_ground_tilt * part_of_ratio_tilt_by_theta_tilt_by_l_ground_tilt_2
    )
    part_of_driving_torque_tilt_by_l_ground_tilt = (
        part_of_driving_torque_tilt_by_theta_tilt * ratio_tilt_by_theta_tilt_by_l_ground_tilt
        - part_of_driving_torque_tilt_by_theta_tilt_2 * ratio_tilt_by_l_ground_tilt
    )
    driving_torque_tilt_by_l_ground_tilt = -part_of_driving_torque_tilt_by_l_ground_tilt
    carried_tilt_by_l_ground_tilt = (
        driving_torque_tilt_by_l_ground_tilt * load_inertia_tilt
        - part_of_carried_tilt_by_N_tilt * ratio_tilt_by_l_ground_tilt
    )
    lost_lowering_tilt_by_l_ground_tilt = (
        (-1.0) * (part_of_lost_lowering_tilt_by_N_tilt) * (ratio_tilt_by_l_ground_tilt)
    )
    lost_raising_tilt_by_l_ground_tilt = (
        (-1.0) * (part_of_lost_raising_tilt_by_N_tilt) * (ratio_tilt_by_l_ground_tilt)
    )
    part_of_fp_2_38 = (
        -carried_tilt_by_l_ground_tilt * part_of_fx_2_0_3_slide_tilt
        - lost_lowering_tilt_by_l_ground_tilt * part_of_fx_2_1_17
        - lost_raising_tilt_by_l_ground_tilt * part_of_fx_2_1_18
        - part_of_driving_torque_tilt_by_l_ground_tilt
        - part_of_fp_2_34 * ratio_tilt_by_l_ground_tilt
    )
    fp[2, 38] = -part_of_fp_2_38 * part_of_fx_2_7_2
    fp[3, 38] = mass_pan_part_of_fx_3_0 * part_of_fp_2_38
    fp[7, 38] = -part_of_fx_7_1 * ratio_tilt_by_l_ground_tilt
    part_of_linkage_cos_tilt_by_l_min_tilt = -2.0 * l_min_tilt - 2.0 * s_start_tilt
    linkage_cos_tilt_by_l_min_tilt = part_of_linkage_cos_tilt_by_l_min_tilt
    linkage_sin_tilt_by_l_min_tilt = (
        (-1.0) * (linkage_cos_tilt_by_l_min_tilt) * (part_of_linkage_sin_tilt_by_l_ground_tilt)
    )
    length_tilt_by_l_min_tilt = (
        -linkage_cos_tilt_by_l_min_tilt * part_of_length_tilt_by_l_ground_tilt_2
        - linkage_sin_tilt_by_l_min_tilt * part_of_length_tilt_by_l_ground_tilt_3
    )
    ratio_tilt_by_l_min_tilt = (
        math.pi
        * N_tilt
        * lead_tilt_inverse
        * length_tilt_inverse
        * linkage_cos_tilt_by_l_min_tilt
        * sin_tilt
        - length_tilt_by_l_min_tilt * part_of_ratio_tilt_by_theta_tilt_by_theta_tilt
        - linkage_sin_tilt_by_l_min_tilt * part_of_ratio_tilt_by_l_ground_tilt
    )
    length_tilt_by_theta_tilt_by_l_min_tilt = (
        linkage_cos_tilt_by_l_min_tilt * part_of_length_tilt_by_theta_tilt_by_l_ground_tilt_2
        + linkage_sin_tilt_by_l_min_tilt * part_of_length_tilt_by_theta_tilt_by_l_ground_tilt_3
    )
    ratio_tilt_by_theta_tilt_by_l_min_tilt = (
        length_tilt_by_l_min_tilt * part_of_ratio_tilt_by_theta_tilt_by_theta_tilt_4
        - length_tilt_by_theta_tilt_by_l_min_tilt * part_of_ratio_tilt_by_theta_tilt_by_theta_tilt
        + linkage_cos_tilt_by_l_min_tilt * part_of_ratio_tilt_by_theta_tilt_by_l_ground_tilt_3
        + linkage_sin_tilt_by_l_min_tilt * part_of_ratio_tilt_by_theta_tilt_by_l_ground_tilt_2
    )
    part_of_driving_torque_tilt_by_l_min_tilt = (
        part_of_driving_torque_tilt_by_theta_tilt * ratio_tilt_by_theta_tilt_by_l_min_tilt
        - part_of_driving_torque_tilt_by_theta_tilt_2 * ratio_tilt_by_l_min_tilt
    )
    driving_torque_tilt_by_l_min_tilt = -part_of_driving_torque_tilt_by_l_min_tilt
    carried_tilt_by_l_min_tilt = (
        driving_torque_tilt_by_l_min_tilt * load_inertia_tilt
        - part_of_carried_tilt_by_N_tilt * ratio_tilt_by_l_min_tilt
    )
    lost_lowering_tilt_by_l_min_tilt = (
        (-1.0) * (part_of_lost_lowering_tilt_by_N_tilt) * (ratio_tilt_by_l_min_tilt)
    )
    lost_raising_tilt_by_l_min_tilt = (
        -part_of_lost_raising_tilt_by_N_tilt * ratio_tilt_by_l_min_tilt
    )
    part_of_fp_2_39 = (
        -carried_tilt_by_l_min_tilt * part_of_fx_2_0_3_slide_tilt
        - lost_lowering_tilt_by_l_min_tilt * part_of_fx_2_1_17
        - lost_raising_tilt_by_l_min_tilt * part_of_fx_2_1_18
        - part_of_driving_torque_tilt_by_l_min_tilt
        - part_of_fp_2_34 * ratio_tilt_by_l_min_tilt
    )
    fp[2, 39] = -part_of_fp_2_39 * part_of_fx_2_7_2
    fp[3, 39] = mass_pan_part_of_fx_3_0 * part_of_fp_2_39
    fp[7, 39] = -part_of_fx_7_1 * ratio_tilt_by_l_min_tilt
    linkage_cos_tilt_by_r_arm_tilt = 2.0 * r_arm_tilt
    linkage_sin_tilt_by_r_arm_tilt = (
        4.0 * l_ground_tilt_sq * part_of_linkage_sin_tilt_2_inverse * r_arm_tilt
        - linkage_cos_tilt_by_r_arm_tilt * part_of_linkage_sin_tilt_by_l_ground_tilt
    )
    length_tilt_by_r_arm_tilt = (
        -linkage_cos_tilt_by_r_arm_tilt * part_of_length_tilt_by_l_ground_tilt_2
        - linkage_sin_tilt_by_r_arm_tilt * part_of_length_tilt_by_l_ground_tilt_3
        + part_of_length_tilt_2_inverse * r_arm_tilt
    )
    ratio_tilt_by_r_arm_tilt = (
        math.pi
        * N_tilt
        * lead_tilt_inverse
        * length_tilt_inverse
        * linkage_cos_tilt_by_r_arm_tilt
        * sin_tilt
        - length_tilt_by_r_arm_tilt * part_of_ratio_tilt_by_theta_tilt_by_theta_tilt
        - linkage_sin_tilt_by_r_arm_tilt * part_of_ratio_tilt_by_l_ground_tilt
    )
    length_tilt_by_theta_tilt_by_r_arm_tilt = (
        linkage_cos_tilt_by_r_arm_tilt * part_of_length_tilt_by_theta_tilt_by_l_ground_tilt_2
        + linkage_sin_tilt_by_r_arm_tilt * part_of_length_tilt_by_theta_tilt_by_l_ground_tilt_3
        - part_of_length_tilt_by_theta_tilt_by_theta_tilt * r_arm_tilt
    )
    ratio_tilt_by_theta_tilt_by_r_arm_tilt = (
        length_tilt_by_r_arm_tilt * part_of_ratio_tilt_by_theta_tilt_by_theta_tilt_4
        - length_tilt_by_theta_tilt_by_r_arm_tilt * part_of_ratio_tilt_by_theta_tilt_by_theta_tilt
        + linkage_cos_tilt_by_r_arm_tilt * part_of_ratio_tilt_by_theta_tilt_by_l_ground_tilt_3
        + linkage_sin_tilt_by_r_arm_tilt * part_of_ratio_tilt_by_theta_tilt_by_l_ground_tilt_2
    )
    part_of_driving_torque_tilt_by_r_arm_tilt = (
        part_of_driving_torque_tilt_by_theta_tilt * ratio_tilt_by_theta_tilt_by_r_arm_tilt
        - part_of_driving_torque_tilt_by_theta_tilt_2 * ratio_tilt_by_r_arm_tilt
    )
    driving_torque_tilt_by_r_arm_tilt = -part_of_driving_torque_tilt_by_r_arm_tilt
    carried_tilt_by_r_arm_tilt = (
        driving_torque_tilt_by_r_arm_tilt * load_inertia_tilt
        - part_of_carried_tilt_by_N_tilt * ratio_tilt_by_r_arm_tilt
    )
    lost_lowering_tilt_by_r_arm_tilt = (
        (-1.0) * (part_of_lost_lowering_tilt_by_N_tilt) * (ratio_tilt_by_r_arm_tilt)
    )
    lost_raising_tilt_by_r_arm_tilt = (
        -part_of_lost_raising_tilt_by_N_tilt * ratio_tilt_by_r_arm_tilt
    )
    part_of_fp_2_40 = (
        -carried_tilt_by_r_arm_tilt * part_of_fx_2_0_3_slide_tilt
        - lost_lowering_tilt_by_r_arm_tilt * part_of_fx_2_1_17
        - lost_raising_tilt_by_r_arm_tilt * part_of_fx_2_1_18
        - part_of_driving_torque_tilt_by_r_arm_tilt
        - part_of_fp_2_34 * ratio_tilt_by_r_arm_tilt
    )
    fp[2, 40] = -part_of_fp_2_40 * part_of_fx_2_7_2
    fp[3, 40] = mass_pan_part_of_fx_3_0 * part_of_fp_2_40
    fp[7, 40] = -part_of_fx_7_1 * ratio_tilt_by_r_arm_tilt
    linkage_cos_tilt_by_s_start_tilt = part_of_linkage_cos_tilt_by_l_min_tilt
    linkage_sin_tilt_by_s_start_tilt = (
        (-1.0) * (linkage_cos_tilt_by_s_start_tilt) * (part_of_linkage_sin_tilt_by_l_ground_tilt)
    )
    length_tilt_by_s_start_tilt = (
        -linkage_cos_tilt_by_s_start_tilt * part_of_length_tilt_by_l_ground_tilt_2
        - linkage_sin_tilt_by_s_start_tilt * part_of_length_tilt_by_l_ground_tilt_3
    )
    ratio_tilt_by_s_start_tilt = (
        math.pi
        * N_tilt
        * lead_tilt_inverse
        * length_tilt_inverse
        * linkage_cos_tilt_by_s_start_tilt
        * sin_tilt
        - length_tilt_by_s_start_tilt * part_of_ratio_tilt_by_theta_tilt_by_theta_tilt
        - linkage_sin_tilt_by_s_start_tilt * part_of_ratio_tilt_by_l_ground_tilt
    )
    length_tilt_by_theta_tilt_by_s_start_tilt = (
        linkage_cos_tilt_by_s_start_tilt * part_of_length_tilt_by_theta_tilt_by_l_ground_tilt_2
        + linkage_sin_tilt_by_s_start_tilt * part_of_length_tilt_by_theta_tilt_by_l_ground_tilt_3
    )
    ratio_tilt_by_theta_tilt_by_s_start_tilt = (
        length_tilt_by_s_start_tilt * part_of_ratio_tilt_by_theta_tilt_by_theta_tilt_4
        - length_tilt_by_theta_tilt_by_s_start_tilt * part_of_ratio_tilt_by_theta_tilt_by_theta_tilt
        + linkage_cos_tilt_by_s_start_tilt * part_of_ratio_tilt_by_theta_tilt_by_l_ground_tilt_3
        + linkage_sin_tilt_by_s_start_tilt * part_of_ratio_tilt_by_theta_tilt_by_l_ground_tilt_2
    )
    part_of_driving_torque_tilt_by_s_start_tilt = (
        part_of_driving_torque_tilt_by_theta_tilt * ratio_tilt_by_theta_tilt_by_s_start_tilt
        - part_of_driving_torque_tilt_by_theta_tilt_2 * ratio_tilt_by_s_start_tilt
    )
    driving_torque_tilt_by_s_start_tilt = -part_of_driving_torque_tilt_by_s_start_tilt
    carried_tilt_by_s_start_tilt = (
        driving_torque_tilt_by_s_start_tilt * load_inertia_tilt
        - part_of_carried_tilt_by_N_tilt * ratio_tilt_by_s_start_tilt
    )
    lost_lowering_tilt_by_s_start_tilt = (
        (-1.0) * (part_of_lost_lowering_tilt_by_N_tilt) * (ratio_tilt_by_s_start_tilt)
    )
    lost_raising_tilt_by_s_start_tilt = (
        (-1.0) * (part_of_lost_raising_tilt_by_N_tilt) * (ratio_tilt_by_s_start_tilt)
    )
    part_of_fp_2_41 = (
        -carried_tilt_by_s_start_tilt * part_of_fx_2_0_3_slide_tilt
        - lost_lowering_tilt_by_s_start_tilt * part_of_fx_2_1_17
        - lost_raising_tilt_by_s_start_tilt * part_of_fx_2_1_18
        - part_of_driving_torque_tilt_by_s_start_tilt
        - part_of_fp_2_34 * ratio_tilt_by_s_start_tilt
    )
    fp[2, 41] = -part_of_fp_2_41 * part_of_fx_2_7_2
    fp[3, 41] = mass_pan_part_of_fx_3_0 * part_of_fp_2_41
    fp[7, 41] = -part_of_fx_7_1 * ratio_tilt_by_s_start_tilt


@njit(cache=True, error_model="numpy", nogil=True)
def guards(t, x, u, p, m, g):
    """Write holding and breakaway torques, gap separations and contact torques into g."""
    theta_pan = x[0]
    theta_tilt = x[1]
    omega_pan = x[2]
    omega_tilt = x[3]
    theta_gear_pan = x[4]
    omega_gear_pan = x[5]
    i_pan = x[6]
    i_tilt = x[7]
    J_pan = p[0]
    J_x_tilt = p[1]
    J_y_tilt = p[2]
    J_z_tilt = p[3]
    m_payload = p[4]
    J_x_payload = p[5]
    J_y_payload = p[6]
    J_z_payload = p[7]
    c_x_payload = p[8]
    c_y_payload = p[9]
    c_z_payload = p[10]
    b_pan = p[11]
    K_t_pan = p[14]
    N_pan = p[16]
    k_shaft_pan = p[17]
    d_shaft_pan = p[18]
    gap_pan = p[19]
    F_s_pan = p[21]
    a_F_s_pan = p[25]
    b_tilt = p[28]
    K_t_tilt = p[31]
    J_motor_tilt = p[32]
    b_motor_tilt = p[33]
    N_tilt = p[34]
    lead_tilt = p[35]
    d_screw_tilt = p[36]
    f_screw_tilt = p[37]
    l_ground_tilt = p[38]
    l_min_tilt = p[39]
    r_arm_tilt = p[40]
    s_start_tilt = p[41]
    slide_tilt = m[1]
    side_pan = m[2]
    active_pan = m[3]
    part_of_g_0 = d_shaft_pan * (omega_gear_pan - omega_pan)
    part_of_g_0_2 = (0.5) * gap_pan
    part_of_g_0_3 = -theta_gear_pan + theta_pan
    part_of_g_0_4 = active_pan * (
        k_shaft_pan * (-part_of_g_0_2 * side_pan - part_of_g_0_3) + part_of_g_0
    )
    minus_part_of_g_0_4 = -part_of_g_0_4
    g[0] = K_t_pan * N_pan * i_pan + minus_part_of_g_0_4
    g[1] = F_s_pan * (a_F_s_pan + 1.0)
    g[2] = F_s_pan * (1.0 - a_F_s_pan)
    cos_tilt = math.cos(theta_tilt)
    sin_tilt = math.sin(theta_tilt)
    c_y_payload_m_payload = c_y_payload * m_payload
    part_of_force_pan = c_x_payload * c_y_payload_m_payload
    part_of_force_pan_2 = c_y_payload_m_payload * c_z_payload
    sin_tilt_sq = sin_tilt * sin_tilt
    cos_tilt_sq = cos_tilt * cos_tilt
    c_x_payload_sq = c_x_payload * c_x_payload
    c_z_payload_sq = c_z_payload * c_z_payload
    c_z_payload_sq_m_payload = c_z_payload_sq * m_payload
    part_of_force_pan_3 = 2.0 * omega_pan * omega_tilt
    cos_tilt_sin_tilt = cos_tilt * sin_tilt
    part_of_force_pan_4 = cos_tilt_sin_tilt * part_of_force_pan_3
    omega_tilt_sq = omega_tilt * omega_tilt
    part_of_force_pan_5 = c_x_payload * c_z_payload * m_payload
    part_of_force_pan_6 = (
        -J_x_payload * part_of_force_pan_4
        - J_x_tilt * part_of_force_pan_4
        + 2.0 * J_z_payload * cos_tilt * omega_pan * omega_tilt * sin_tilt
        + 2.0 * J_z_tilt * cos_tilt * omega_pan * omega_tilt * sin_tilt
        - b_pan * omega_pan
        + 2.0 * c_x_payload * c_z_payload * m_payload * omega_pan * omega_tilt * sin_tilt_sq
        + 2.0 * c_x_payload_sq * cos_tilt * m_payload * omega_pan * omega_tilt * sin_tilt
        - c_z_payload_sq_m_payload * part_of_force_pan_4
        - cos_tilt * omega_tilt_sq * part_of_force_pan
        - cos_tilt_sq * part_of_force_pan_3 * part_of_force_pan_5
        - minus_part_of_g_0_4
        - omega_tilt_sq * part_of_force_pan_2 * sin_tilt
    )
    force_pan = part_of_force_pan_6
    part_of_follower_coupling_tilt = -cos_tilt * part_of_force_pan_2 + part_of_force_pan * sin_tilt
    follower_coupling_tilt = part_of_follower_coupling_tilt
    c_x_payload_sq_m_payload = c_x_payload_sq * m_payload
    part_of_follower_inertia_tilt = (c_y_payload * c_y_payload) * m_payload
    c_x_payload_cos_tilt = c_x_payload * cos_tilt
    c_z_payload_sin_tilt = c_z_payload * sin_tilt
    part_of_follower_inertia_tilt_2 = (
        J_pan
        + J_x_payload * sin_tilt_sq
        + J_x_tilt * sin_tilt_sq
        + J_z_payload * cos_tilt_sq
        + J_z_tilt * cos_tilt_sq
        + 2.0 * c_x_payload_cos_tilt * c_z_payload_sin_tilt * m_payload
        + c_x_payload_sq_m_payload * cos_tilt_sq
        + c_z_payload_sq_m_payload * sin_tilt_sq
        + cos_tilt_sq * part_of_follower_inertia_tilt
        + part_of_follower_inertia_tilt * sin_tilt_sq
    )
    follower_inertia_tilt = part_of_follower_inertia_tilt_2
    follower_inertia_tilt_inverse = 1.0 / follower_inertia_tilt
    part_of_load_inertia_tilt = (
        J_y_payload + J_y_tilt + c_x_payload_sq_m_payload + c_z_payload_sq_m_payload
    )
    load_inertia_tilt = (
        -(follower_coupling_tilt * follower_coupling_tilt) * follower_inertia_tilt_inverse
        + part_of_load_inertia_tilt
    )
    part_of_lowered_tilt = math.pi * d_screw_tilt
    f_screw_tilt_lead_tilt = f_screw_tilt * lead_tilt
    part_of_lowered_tilt_2 = f_screw_tilt * part_of_lowered_tilt
    lead_tilt_inverse = 1.0 / lead_tilt
    part_of_lowered_tilt_3 = lead_tilt_inverse * part_of_lowered_tilt
    lowered_tilt = (
        (-1.0)
        * (part_of_lowered_tilt_3)
        * (1.0 / (f_screw_tilt_lead_tilt + part_of_lowered_tilt))
        * (-lead_tilt + part_of_lowered_tilt_2)
    )
    l_ground_tilt_sq = l_ground_tilt * l_ground_tilt
    r_arm_tilt_sq = r_arm_tilt * r_arm_tilt
    part_of_linkage_cos_tilt = l_ground_tilt_sq + r_arm_tilt_sq
    linkage_cos_tilt = part_of_linkage_cos_tilt - (
        (l_min_tilt + s_start_tilt) * (l_min_tilt + s_start_tilt)
    )
    linkage_cos_tilt_sin_tilt = linkage_cos_tilt * sin_tilt
    linkage_sin_tilt = math.sqrt(
        4.0 * l_ground_tilt_sq * r_arm_tilt_sq - (linkage_cos_tilt * linkage_cos_tilt)
    )
    cos_tilt_linkage_sin_tilt = cos_tilt * linkage_sin_tilt
    part_of_ratio_tilt = -cos_tilt_linkage_sin_tilt + linkage_cos_tilt_sin_tilt
    cos_tilt_linkage_cos_tilt = cos_tilt * linkage_cos_tilt
    linkage_sin_tilt_sin_tilt = linkage_sin_tilt * sin_tilt
    part_of_length_tilt = math.sqrt(
        -cos_tilt_linkage_cos_tilt - linkage_sin_tilt_sin_tilt + part_of_linkage_cos_tilt
    )
    length_tilt = part_of_length_tilt
    part_of_ratio_tilt_2 = math.pi * N_tilt * lead_tilt_inverse / length_tilt
    ratio_tilt = part_of_ratio_tilt * part_of_ratio_tilt_2
    part_of_lost_lowering_tilt = J_motor_tilt * (ratio_tilt * ratio_tilt)
    lost_lowering_tilt = (1.0 - lowered_tilt) * (
        1.0 / (abs(load_inertia_tilt * lowered_tilt + part_of_lost_lowering_tilt))
    )
    raised_tilt = (
        (part_of_lowered_tilt_3)
        * (1.0 / (-f_screw_tilt_lead_tilt + part_of_lowered_tilt))
        * (lead_tilt + part_of_lowered_tilt_2)
    )
    lost_raising_tilt = (raised_tilt - 1.0) * (
        1.0 / (load_inertia_tilt * raised_tilt + part_of_lost_lowering_tilt)
    )
    length_tilt_by_theta_tilt = (1.0 / part_of_length_tilt) * (
        -0.5 * cos_tilt_linkage_sin_tilt + (0.5) * linkage_cos_tilt_sin_tilt
    )
    ratio_tilt_by_theta_tilt = (
        -math.pi * N_tilt * lead_tilt_inverse * length_tilt_by_theta_tilt * part_of_ratio_tilt
    ) / (length_tilt * length_tilt) + part_of_ratio_tilt_2 * (
        cos_tilt_linkage_cos_tilt + linkage_sin_tilt_sin_tilt
    )
    part_of_driving_torque_tilt = (
        J_motor_tilt * omega_tilt_sq * ratio_tilt * ratio_tilt_by_theta_tilt
        - ratio_tilt * (K_t_tilt * i_tilt - b_motor_tilt * omega_tilt * ratio_tilt)
    )
    driving_torque_tilt = -part_of_driving_torque_tilt
    follower_torque_tilt = part_of_force_pan_6
    b_tilt_omega_tilt = b_tilt * omega_tilt
    part_of_load_torque_tilt = (9.81) * m_payload
    omega_pan_sq = omega_pan * omega_pan
    cos_tilt_sin_tilt_omega_pan_sq = cos_tilt_sin_tilt * omega_pan_sq
    part_of_load_torque_tilt_2 = J_z_payload * cos_tilt_sin_tilt_omega_pan_sq
    part_of_load_torque_tilt_3 = J_z_tilt * cos_tilt_sin_tilt_omega_pan_sq
    omega_pan_sq_part_of_force_pan_5 = omega_pan_sq * part_of_force_pan_5
    part_of_load_torque_tilt_4 = omega_pan_sq_part_of_force_pan_5 * sin_tilt_sq
    part_of_load_torque_tilt_5 = c_x_payload_sq_m_payload * cos_tilt_sin_tilt_omega_pan_sq
    load_torque_tilt = (
        J_x_payload * cos_tilt_sin_tilt_omega_pan_sq
        + J_x_tilt * cos_tilt_sin_tilt_omega_pan_sq
        - b_tilt_omega_tilt
        + c_x_payload_cos_tilt * part_of_load_torque_tilt
        + c_z_payload_sin_tilt * part_of_load_torque_tilt
        + c_z_payload_sq_m_payload * cos_tilt_sin_tilt_omega_pan_sq
        + cos_tilt_sq * omega_pan_sq_part_of_force_pan_5
        - follower_coupling_tilt * follower_inertia_tilt_inverse * follower_torque_tilt
        - part_of_load_torque_tilt_2
        - part_of_load_torque_tilt_3
        - part_of_load_torque_tilt_4
        - part_of_load_torque_tilt_5
    )
    carried_tilt = (
        driving_torque_tilt * load_inertia_tilt - load_torque_tilt * part_of_lost_lowering_tilt
    )
    carried_tilt_slide_tilt = carried_tilt * slide_tilt
    part_of_force_tilt = (
        -J_x_payload * cos_tilt * omega_pan_sq * sin_tilt
        - J_x_tilt * cos_tilt * omega_pan_sq * sin_tilt
        + b_tilt_omega_tilt
        - c_x_payload * c_z_payload * cos_tilt_sq * m_payload * omega_pan_sq
        - 9.81 * c_x_payload * cos_tilt * m_payload
        - 9.81 * c_z_payload * m_payload * sin_tilt
        - c_z_payload_sq * cos_tilt * m_payload * omega_pan_sq * sin_tilt
        + part_of_driving_torque_tilt
        + part_of_load_torque_tilt_2
        + part_of_load_torque_tilt_3
        + part_of_load_torque_tilt_4
        + part_of_load_torque_tilt_5
    )
    force_tilt = -part_of_force_tilt - slide_tilt * (
        (0.5) * carried_tilt_slide_tilt * (-lost_lowering_tilt + lost_raising_tilt)
        + (0.5) * (lost_lowering_tilt + lost_raising_tilt) * abs(carried_tilt_slide_tilt)
    )
    mass_pan = part_of_follower_inertia_tilt_2
    mass_pan_tilt = part_of_follower_coupling_tilt
    mass_tilt = part_of_load_inertia_tilt + part_of_lost_lowering_tilt
    inverse_determinant = 1.0 / (
        mass_pan * mass_tilt
        - (mass_pan_tilt * mass_pan_tilt) * (slide_tilt * slide_tilt * slide_tilt * slide_tilt)
    )
    slide_tilt_sq = slide_tilt * slide_tilt
    mass_pan_tilt_slide_tilt_sq = mass_pan_tilt * slide_tilt_sq
    accel_pan = inverse_determinant * (
        force_pan * mass_tilt - force_tilt * mass_pan_tilt_slide_tilt_sq
    )
    g[3] = -accel_pan * mass_pan_tilt - part_of_force_tilt
    part_of_g_4 = (0.5) * load_torque_tilt * (lowered_tilt + raised_tilt - 2.0)
    part_of_g_4_2 = abs(load_torque_tilt)
    part_of_g_4_3 = -lowered_tilt + raised_tilt
    g[4] = -part_of_g_4 + (0.5) * part_of_g_4_2 * part_of_g_4_3
    g[5] = part_of_g_4 + (0.5) * part_of_g_4_2 * part_of_g_4_3
    part_of_g_6 = theta_gear_pan - theta_pan
    g[6] = part_of_g_6
    g[7] = part_of_g_0_2
    g[8] = k_shaft_pan * (-part_of_g_0_2 - part_of_g_0_3) + part_of_g_0
    g[9] = k_shaft_pan * (part_of_g_0_2 + part_of_g_6) + part_of_g_0


@njit(cache=True, error_model="numpy", nogil=True)
def guard_jacobian(t, x, u, p, m, gx, gp):
    """Write the non-zero derivatives of guards by state and parameter."""
    theta_pan = x[0]
    theta_tilt = x[1]
    omega_pan = x[2]
    omega_tilt = x[3]
    theta_gear_pan = x[4]
    omega_gear_pan = x[5]
    i_pan = x[6]
    i_tilt = x[7]
    J_pan = p[0]
    J_x_tilt = p[1]
    J_y_tilt = p[2]
    J_z_tilt = p[3]
    m_payload = p[4]
    J_x_payload = p[5]
    J_y_payload = p[6]
    J_z_payload = p[7]
    c_x_payload = p[8]
    c_y_payload = p[9]
    c_z_payload = p[10]
    b_pan = p[11]
    K_t_pan = p[14]
    N_pan = p[16]
    k_shaft_pan = p[17]
    d_shaft_pan = p[18]
    gap_pan = p[19]
    F_s_pan = p[21]
    a_F_s_pan = p[25]
    b_tilt = p[28]
    K_t_tilt = p[31]
    J_motor_tilt = p[32]
    b_motor_tilt = p[33]
    N_tilt = p[34]
    lead_tilt = p[35]
    d_screw_tilt = p[36]
    f_screw_tilt = p[37]
    l_ground_tilt = p[38]
    l_min_tilt = p[39]
    r_arm_tilt = p[40]
    s_start_tilt = p[41]
    slide_tilt = m[1]
    side_pan = m[2]
    active_pan = m[3]
    active_pan_k_shaft_pan = active_pan * k_shaft_pan
    gx[0, 0] = active_pan_k_shaft_pan
    minus_active_pan_k_shaft_pan = -active_pan_k_shaft_pan
    follower_torque_tilt_by_theta_pan = minus_active_pan_k_shaft_pan
    sin_tilt = math.sin(theta_tilt)
    c_y_payload_sin_tilt = c_y_payload * sin_tilt
    c_x_payload_c_y_payload_sin_tilt = c_x_payload * c_y_payload_sin_tilt
    part_of_follower_coupling_tilt = c_x_payload_c_y_payload_sin_tilt * m_payload
    cos_tilt = math.cos(theta_tilt)
    c_z_payload_cos_tilt = c_z_payload * cos_tilt
    c_y_payload_c_z_payload_cos_tilt = c_y_payload * c_z_payload_cos_tilt
    part_of_follower_coupling_tilt_2 = c_y_payload_c_z_payload_cos_tilt * m_payload
    part_of_follower_coupling_tilt_3 = (
        part_of_follower_coupling_tilt - part_of_follower_coupling_tilt_2
    )
    follower_coupling_tilt = part_of_follower_coupling_tilt_3
    sin_tilt_sq = sin_tilt * sin_tilt
    J_x_payload_sin_tilt_sq = J_x_payload * sin_tilt_sq
    J_x_tilt_sin_tilt_sq = J_x_tilt * sin_tilt_sq
    cos_tilt_sq = cos_tilt * cos_tilt
    J_z_payload_cos_tilt_sq = J_z_payload * cos_tilt_sq
    J_z_tilt_cos_tilt_sq = J_z_tilt * cos_tilt_sq
    c_x_payload_sq = c_x_payload * c_x_payload
    c_x_payload_sq_m_payload = c_x_payload_sq * m_payload
    part_of_follower_inertia_tilt = c_x_payload_sq_m_payload * cos_tilt_sq
    c_y_payload_sq = c_y_payload * c_y_payload
    c_y_payload_sq_sin_tilt_sq = c_y_payload_sq * sin_tilt_sq
    c_y_payload_sq_cos_tilt_sq = c_y_payload_sq * cos_tilt_sq
    c_z_payload_sq = c_z_payload * c_z_payload
    c_z_payload_sq_m_payload = c_z_payload_sq * m_payload
    part_of_follower_inertia_tilt_2 = c_z_payload_sq_m_payload * sin_tilt_sq
    m_payload_sin_tilt = m_payload * sin_tilt
    c_x_payload_m_payload_sin_tilt = c_x_payload * m_payload_sin_tilt
    part_of_follower_inertia_tilt_3 = 2.0 * c_z_payload_cos_tilt
    part_of_follower_inertia_tilt_4 = (
        J_pan
        + J_x_payload_sin_tilt_sq
        + J_x_tilt_sin_tilt_sq
        + J_z_payload_cos_tilt_sq
        + J_z_tilt_cos_tilt_sq
        + c_x_payload_m_payload_sin_tilt * part_of_follower_inertia_tilt_3
        + c_y_payload_sq_cos_tilt_sq * m_payload
        + c_y_payload_sq_sin_tilt_sq * m_payload
        + part_of_follower_inertia_tilt
        + part_of_follower_inertia_tilt_2
    )
    follower_inertia_tilt = part_of_follower_inertia_tilt_4
    follower_inertia_tilt_inverse = 1.0 / follower_inertia_tilt
    part_of_load_torque_tilt_by_theta_pan = follower_coupling_tilt * follower_inertia_tilt_inverse
    load_torque_tilt_by_theta_pan = (
        (-1.0) * (follower_torque_tilt_by_theta_pan) * (part_of_load_torque_tilt_by_theta_pan)
    )
    l_ground_tilt_sq = l_ground_tilt * l_ground_tilt
    r_arm_tilt_sq = r_arm_tilt * r_arm_tilt
    part_of_linkage_cos_tilt = l_ground_tilt_sq + r_arm_tilt_sq
    linkage_cos_tilt = part_of_linkage_cos_tilt - (
        (l_min_tilt + s_start_tilt) * (l_min_tilt + s_start_tilt)
    )
    linkage_cos_tilt_sin_tilt = linkage_cos_tilt * sin_tilt
    part_of_linkage_sin_tilt = 4.0 * r_arm_tilt_sq
    part_of_linkage_sin_tilt_2 = math.sqrt(
        l_ground_tilt_sq * part_of_linkage_sin_tilt - (linkage_cos_tilt * linkage_cos_tilt)
    )
    linkage_sin_tilt = part_of_linkage_sin_tilt_2
    cos_tilt_linkage_sin_tilt = cos_tilt * linkage_sin_tilt
    part_of_ratio_tilt = -cos_tilt_linkage_sin_tilt + linkage_cos_tilt_sin_tilt
    cos_tilt_linkage_cos_tilt = cos_tilt * linkage_cos_tilt
    linkage_sin_tilt_sin_tilt = linkage_sin_tilt * sin_tilt
    part_of_length_tilt = (
        -cos_tilt_linkage_cos_tilt - linkage_sin_tilt_sin_tilt + part_of_linkage_cos_tilt
    )
    part_of_length_tilt_2 = math.sqrt(part_of_length_tilt)
    length_tilt = part_of_length_tilt_2
    length_tilt_inverse = 1.0 / length_tilt
    lead_tilt_inverse = 1.0 / lead_tilt
    part_of_ratio_tilt_2 = math.pi * lead_tilt_inverse
    part_of_ratio_tilt_3 = length_tilt_inverse * part_of_ratio_tilt_2
    part_of_ratio_tilt_4 = part_of_ratio_tilt * part_of_ratio_tilt_3
    ratio_tilt = N_tilt * part_of_ratio_tilt_4
    ratio_tilt_sq = ratio_tilt * ratio_tilt
    J_motor_tilt_ratio_tilt_sq = J_motor_tilt * ratio_tilt_sq
    carried_tilt_by_theta_pan = -J_motor_tilt_ratio_tilt_sq * load_torque_tilt_by_theta_pan
    mass_pan_tilt = part_of_follower_coupling_tilt_3
    part_of_mass_tilt = J_y_payload + J_y_tilt + c_x_payload_sq_m_payload + c_z_payload_sq_m_payload
    mass_tilt = J_motor_tilt_ratio_tilt_sq + part_of_mass_tilt
    active_pan_k_shaft_pan_mass_tilt = active_pan_k_shaft_pan * mass_tilt
    slide_tilt_cubed = slide_tilt * slide_tilt * slide_tilt
    part_of_lowered_tilt = math.pi * d_screw_tilt
    part_of_lowered_tilt_2 = f_screw_tilt * part_of_lowered_tilt
    part_of_lowered_tilt_3 = -lead_tilt + part_of_lowered_tilt_2
    f_screw_tilt_lead_tilt = f_screw_tilt * lead_tilt
    part_of_lowered_tilt_4 = f_screw_tilt_lead_tilt + part_of_lowered_tilt
    part_of_lowered_tilt_4_inverse = 1.0 / part_of_lowered_tilt_4
    part_of_lowered_tilt_5 = lead_tilt_inverse * part_of_lowered_tilt_4_inverse
    part_of_lowered_tilt_6 = part_of_lowered_tilt * part_of_lowered_tilt_5
    lowered_tilt = -part_of_lowered_tilt_3 * part_of_lowered_tilt_6
    part_of_lost_lowering_tilt = 1.0 - lowered_tilt
    follower_coupling_tilt_sq = follower_coupling_tilt * follower_coupling_tilt
    load_inertia_tilt = (
        -follower_coupling_tilt_sq * follower_inertia_tilt_inverse + part_of_mass_tilt
    )
    part_of_lost_lowering_tilt_2 = J_motor_tilt_ratio_tilt_sq + load_inertia_tilt * lowered_tilt
    part_of_lost_lowering_tilt_3 = 1.0 / (abs(part_of_lost_lowering_tilt_2))
    lost_lowering_tilt = part_of_lost_lowering_tilt * part_of_lost_lowering_tilt_3
    part_of_raised_tilt = lead_tilt + part_of_lowered_tilt_2
    part_of_raised_tilt_2 = -f_screw_tilt_lead_tilt + part_of_lowered_tilt
    part_of_raised_tilt_2_inverse = 1.0 / part_of_raised_tilt_2
    part_of_raised_tilt_3 = lead_tilt_inverse * part_of_raised_tilt_2_inverse
    part_of_raised_tilt_4 = part_of_lowered_tilt * part_of_raised_tilt_3
    raised_tilt = part_of_raised_tilt * part_of_raised_tilt_4
    part_of_lost_raising_tilt = raised_tilt - 1.0
    part_of_lost_raising_tilt_2 = J_motor_tilt_ratio_tilt_sq + load_inertia_tilt * raised_tilt
    part_of_lost_raising_tilt_2_inverse = 1.0 / part_of_lost_raising_tilt_2
    lost_raising_tilt = part_of_lost_raising_tilt * part_of_lost_raising_tilt_2_inverse
    part_of_gx_3_0 = lost_lowering_tilt + lost_raising_tilt
    part_of_ratio_tilt_by_theta_tilt = cos_tilt_linkage_cos_tilt + linkage_sin_tilt_sin_tilt
    part_of_ratio_tilt_by_theta_tilt_2 = part_of_ratio_tilt_3 * part_of_ratio_tilt_by_theta_tilt
    N_tilt_part_of_ratio_tilt = N_tilt * part_of_ratio_tilt
    part_of_length_tilt_by_theta_tilt = (
        -0.5 * cos_tilt_linkage_sin_tilt + (0.5) * linkage_cos_tilt_sin_tilt
    )
    part_of_length_tilt_2_inverse = 1.0 / part_of_length_tilt_2
    length_tilt_by_theta_tilt = part_of_length_tilt_2_inverse * part_of_length_tilt_by_theta_tilt
    part_of_ratio_tilt_by_theta_tilt_3 = 1.0 / (length_tilt * length_tilt)
    part_of_ratio_tilt_by_theta_tilt_4 = part_of_ratio_tilt_2 * part_of_ratio_tilt_by_theta_tilt_3
    part_of_ratio_tilt_by_theta_tilt_5 = (length_tilt_by_theta_tilt) * (
        part_of_ratio_tilt_by_theta_tilt_4
    )
    ratio_tilt_by_theta_tilt = (
        N_tilt * part_of_ratio_tilt_by_theta_tilt_2
        - N_tilt_part_of_ratio_tilt * part_of_ratio_tilt_by_theta_tilt_5
    )
    omega_tilt_sq = omega_tilt * omega_tilt
    part_of_driving_torque_tilt = omega_tilt_sq * ratio_tilt_by_theta_tilt
    part_of_driving_torque_tilt_2 = J_motor_tilt * part_of_driving_torque_tilt
    omega_tilt_ratio_tilt = omega_tilt * ratio_tilt
    part_of_driving_torque_tilt_3 = b_motor_tilt * omega_tilt_ratio_tilt
    part_of_driving_torque_tilt_4 = part_of_driving_torque_tilt_2 * ratio_tilt - ratio_tilt * (
        K_t_tilt * i_tilt - part_of_driving_torque_tilt_3
    )
    driving_torque_tilt = -part_of_driving_torque_tilt_4
    cos_tilt_sin_tilt = cos_tilt * sin_tilt
    part_of_follower_torque_tilt = 2.0 * cos_tilt_sin_tilt
    part_of_follower_torque_tilt_2 = J_x_payload * part_of_follower_torque_tilt
    omega_pan_omega_tilt = omega_pan * omega_tilt
    part_of_follower_torque_tilt_3 = J_x_tilt * part_of_follower_torque_tilt
    cos_tilt_m_payload = cos_tilt * m_payload
    c_y_payload_cos_tilt_m_payload = c_y_payload * cos_tilt_m_payload
    part_of_follower_torque_tilt_4 = c_x_payload * c_y_payload_cos_tilt_m_payload
    c_y_payload_sin_tilt_m_payload = c_y_payload_sin_tilt * m_payload
    part_of_follower_torque_tilt_5 = c_y_payload_sin_tilt_m_payload * c_z_payload
    part_of_follower_torque_tilt_6 = 2.0 * m_payload
    part_of_follower_torque_tilt_7 = c_x_payload * part_of_follower_torque_tilt_6
    part_of_follower_torque_tilt_8 = cos_tilt_sq * part_of_follower_torque_tilt_7
    part_of_follower_torque_tilt_9 = c_z_payload * part_of_follower_torque_tilt_8
    part_of_follower_torque_tilt_10 = c_z_payload_sq_m_payload * part_of_follower_torque_tilt
    minus_omega_pan = -omega_pan
    part_of_follower_torque_tilt_11 = minus_omega_pan + omega_gear_pan
    part_of_follower_torque_tilt_12 = (0.5) * gap_pan
    part_of_follower_torque_tilt_13 = -theta_gear_pan + theta_pan
    part_of_follower_torque_tilt_14 = (
        -part_of_follower_torque_tilt_12 * side_pan - part_of_follower_torque_tilt_13
    )
    part_of_follower_torque_tilt_15 = (active_pan) * (
        d_shaft_pan * part_of_follower_torque_tilt_11
        + k_shaft_pan * part_of_follower_torque_tilt_14
    )
    part_of_follower_torque_tilt_16 = (
        2.0 * J_z_payload * cos_tilt * omega_pan * omega_tilt * sin_tilt
        + 2.0 * J_z_tilt * cos_tilt * omega_pan * omega_tilt * sin_tilt
        - b_pan * omega_pan
        + 2.0 * c_x_payload * c_z_payload * m_payload * omega_pan * omega_tilt * sin_tilt_sq
        + 2.0 * c_x_payload_sq * cos_tilt * m_payload * omega_pan * omega_tilt * sin_tilt
        - omega_pan_omega_tilt * part_of_follower_torque_tilt_10
        - omega_pan_omega_tilt * part_of_follower_torque_tilt_2
        - omega_pan_omega_tilt * part_of_follower_torque_tilt_3
        - omega_pan_omega_tilt * part_of_follower_torque_tilt_9
        - omega_tilt_sq * part_of_follower_torque_tilt_4
        - omega_tilt_sq * part_of_follower_torque_tilt_5
        + part_of_follower_torque_tilt_15
    )
    follower_torque_tilt = part_of_follower_torque_tilt_16
    b_tilt_omega_tilt = b_tilt * omega_tilt
    part_of_load_torque_tilt = (9.81) * c_x_payload
    part_of_load_torque_tilt_2 = (9.81) * c_z_payload
    omega_pan_sq = omega_pan * omega_pan
    cos_tilt_sin_tilt_omega_pan_sq = cos_tilt_sin_tilt * omega_pan_sq
    part_of_load_torque_tilt_3 = J_z_payload * cos_tilt_sin_tilt_omega_pan_sq
    part_of_load_torque_tilt_4 = J_z_tilt * cos_tilt_sin_tilt_omega_pan_sq
    cos_tilt_sq_omega_pan_sq = cos_tilt_sq * omega_pan_sq
    c_x_payload_c_z_payload = c_x_payload * c_z_payload
    part_of_load_torque_tilt_5 = c_x_payload_c_z_payload * cos_tilt_sq_omega_pan_sq
    omega_pan_sq_sin_tilt_sq = omega_pan_sq * sin_tilt_sq
    part_of_load_torque_tilt_6 = c_x_payload_c_z_payload * omega_pan_sq_sin_tilt_sq
    part_of_load_torque_tilt_7 = m_payload * part_of_load_torque_tilt_6
    part_of_load_torque_tilt_8 = c_x_payload_sq_m_payload * cos_tilt_sin_tilt_omega_pan_sq
    load_torque_tilt = (
        J_x_payload * cos_tilt_sin_tilt_omega_pan_sq
        + J_x_tilt * cos_tilt_sin_tilt_omega_pan_sq
        - b_tilt_omega_tilt
        + c_z_payload_sq_m_payload * cos_tilt_sin_tilt_omega_pan_sq
        + cos_tilt_m_payload * part_of_load_torque_tilt
        - follower_torque_tilt * part_of_load_torque_tilt_by_theta_pan
        + m_payload * part_of_load_torque_tilt_5
        + m_payload_sin_tilt * part_of_load_torque_tilt_2
        - part_of_load_torque_tilt_3
        - part_of_load_torque_tilt_4
        - part_of_load_torque_tilt_7
        - part_of_load_torque_tilt_8
    )
    carried_tilt = (
        -J_motor_tilt_ratio_tilt_sq * load_torque_tilt + driving_torque_tilt * load_inertia_tilt
    )
    carried_tilt_slide_tilt = carried_tilt * slide_tilt
    part_of_gx_3_0_2 = -0.5 * lost_lowering_tilt + (0.5) * lost_raising_tilt
    part_of_gx_3_0_3 = (0.5) * part_of_gx_3_0 * slide_tilt * (
        0.0 if carried_tilt_slide_tilt == 0 else math.copysign(1, carried_tilt_slide_tilt)
    ) + part_of_gx_3_0_2 * slide_tilt
    mass_pan = part_of_follower_inertia_tilt_4
    mass_pan_tilt_sq = mass_pan_tilt * mass_pan_tilt
    inverse_determinant = 1.0 / (
        mass_pan * mass_tilt
        - mass_pan_tilt_sq * (slide_tilt * slide_tilt * slide_tilt * slide_tilt)
    )
    part_of_gx_3_0_4 = inverse_determinant * mass_pan_tilt
    gx[3, 0] = (
        (-1.0)
        * (part_of_gx_3_0_4)
        * (
            -active_pan_k_shaft_pan_mass_tilt
            + carried_tilt_by_theta_pan * mass_pan_tilt * part_of_gx_3_0_3 * slide_tilt_cubed
        )
    )
    part_of_gx_4_0 = 0.0 if load_torque_tilt == 0 else math.copysign(1, load_torque_tilt)
    part_of_gx_4_0_2 = -lowered_tilt + raised_tilt
    part_of_gx_4_0_3 = (0.5) * lowered_tilt + (0.5) * raised_tilt - 1.0
    part_of_gx_4_0_4 = (0.5) * part_of_gx_4_0 * part_of_gx_4_0_2 - part_of_gx_4_0_3
    gx[4, 0] = load_torque_tilt_by_theta_pan * part_of_gx_4_0_4
    part_of_gx_5_0 = (0.5) * part_of_gx_4_0 * part_of_gx_4_0_2 + part_of_gx_4_0_3
    gx[5, 0] = load_torque_tilt_by_theta_pan * part_of_gx_5_0
    gx[6, 0] = -1.0
    minus_k_shaft_pan = -k_shaft_pan
    gx[8, 0] = minus_k_shaft_pan
    gx[9, 0] = minus_k_shaft_pan
    force_pan = part_of_follower_torque_tilt_16
    part_of_force_tilt = abs(carried_tilt_slide_tilt)
    part_of_force_tilt_2 = (0.5) * part_of_force_tilt
    force_tilt = (
        J_x_payload * cos_tilt * omega_pan_sq * sin_tilt
        + J_x_tilt * cos_tilt * omega_pan_sq * sin_tilt
        - b_tilt_omega_tilt
        + c_x_payload * c_z_payload * cos_tilt_sq * m_payload * omega_pan_sq
        + (9.81) * c_x_payload * cos_tilt * m_payload
        + (9.81) * c_z_payload * m_payload * sin_tilt
        + c_z_payload_sq * cos_tilt * m_payload * omega_pan_sq * sin_tilt
        - part_of_driving_torque_tilt_4
        - part_of_load_torque_tilt_3
        - part_of_load_torque_tilt_4
        - part_of_load_torque_tilt_7
        - part_of_load_torque_tilt_8
        - slide_tilt
        * (carried_tilt_slide_tilt * part_of_gx_3_0_2 + part_of_force_tilt_2 * part_of_gx_3_0)
    )
    slide_tilt_sq = slide_tilt * slide_tilt
    mass_pan_tilt_slide_tilt_sq = mass_pan_tilt * slide_tilt_sq
    accel_pan = inverse_determinant * (
        force_pan * mass_tilt - force_tilt * mass_pan_tilt_slide_tilt_sq
    )
    part_of_accel_tilt = inverse_determinant * slide_tilt_sq
    accel_tilt = part_of_accel_tilt * (
        -force_pan * mass_pan_tilt_slide_tilt_sq + force_tilt * mass_pan
    )
    part_of_length_tilt_by_theta_tilt_by_theta_tilt = (part_of_length_tilt ** (-1.5)) * (
        part_of_length_tilt_by_theta_tilt
    )
    length_tilt_by_theta_tilt_by_theta_tilt = (
        part_of_length_tilt_2_inverse
        * ((0.5) * cos_tilt_linkage_cos_tilt + (0.5) * linkage_sin_tilt_sin_tilt)
        - part_of_length_tilt_by_theta_tilt * part_of_length_tilt_by_theta_tilt_by_theta_tilt
    )
    N_tilt_part_of_ratio_tilt_3 = N_tilt * part_of_ratio_tilt_3
    part_of_ratio_tilt_by_theta_tilt_by_theta_tilt = (N_tilt_part_of_ratio_tilt) * (
        part_of_ratio_tilt_by_theta_tilt_4
    )
    part_of_ratio_tilt_by_theta_tilt_by_theta_tilt_2 = N_tilt * part_of_ratio_tilt_by_theta_tilt
    part_of_ratio_tilt_by_theta_tilt_by_theta_tilt_3 = (part_of_ratio_tilt_by_theta_tilt_4) * (
        part_of_ratio_tilt_by_theta_tilt_by_theta_tilt_2
    )
    part_of_ratio_tilt_by_theta_tilt_by_theta_tilt_4 = (
        2.0
        * math.pi
        * N_tilt
        * lead_tilt_inverse
        * length_tilt_by_theta_tilt
        * part_of_ratio_tilt
        / (length_tilt * length_tilt * length_tilt)
        - part_of_ratio_tilt_by_theta_tilt_by_theta_tilt_3
    )
    ratio_tilt_by_theta_tilt_by_theta_tilt = (
        -N_tilt_part_of_ratio_tilt_3 * part_of_ratio_tilt
        - length_tilt_by_theta_tilt * part_of_ratio_tilt_by_theta_tilt_by_theta_tilt_3
        + length_tilt_by_theta_tilt * part_of_ratio_tilt_by_theta_tilt_by_theta_tilt_4
        - length_tilt_by_theta_tilt_by_theta_tilt * part_of_ratio_tilt_by_theta_tilt_by_theta_tilt
    )
    J_motor_tilt_ratio_tilt = J_motor_tilt * ratio_tilt
    part_of_driving_torque_tilt_by_theta_tilt = J_motor_tilt_ratio_tilt * omega_tilt_sq
    part_of_driving_torque_tilt_by_theta_tilt_2 = (
        K_t_tilt * i_tilt - part_of_driving_torque_tilt_2 - 2.0 * part_of_driving_torque_tilt_3
    )
    part_of_driving_torque_tilt_by_theta_tilt_3 = (
        part_of_driving_torque_tilt_by_theta_tilt * ratio_tilt_by_theta_tilt_by_theta_tilt
        - part_of_driving_torque_tilt_by_theta_tilt_2 * ratio_tilt_by_theta_tilt
    )
    driving_torque_tilt_by_theta_tilt = -part_of_driving_torque_tilt_by_theta_tilt_3
    part_of_follower_coupling_tilt_by_theta_tilt = (
        part_of_follower_torque_tilt_4 + part_of_follower_torque_tilt_5
    )
    follower_coupling_tilt_by_theta_tilt = part_of_follower_coupling_tilt_by_theta_tilt
    part_of_follower_inertia_tilt_by_theta_tilt = J_z_payload * part_of_follower_torque_tilt
    part_of_follower_inertia_tilt_by_theta_tilt_2 = J_z_tilt * part_of_follower_torque_tilt
    part_of_follower_inertia_tilt_by_theta_tilt_3 = (
        (c_z_payload) * (part_of_follower_torque_tilt_7) * (sin_tilt_sq)
    )
    part_of_follower_inertia_tilt_by_theta_tilt_4 = (c_x_payload_sq_m_payload) * (
        part_of_follower_torque_tilt
    )
    part_of_follower_inertia_tilt_by_theta_tilt_5 = (
        -part_of_follower_inertia_tilt_by_theta_tilt
        - part_of_follower_inertia_tilt_by_theta_tilt_2
        - part_of_follower_inertia_tilt_by_theta_tilt_3
        - part_of_follower_inertia_tilt_by_theta_tilt_4
        + part_of_follower_torque_tilt_10
        + part_of_follower_torque_tilt_2
        + part_of_follower_torque_tilt_3
        + part_of_follower_torque_tilt_9
    )
    follower_inertia_tilt_by_theta_tilt = part_of_follower_inertia_tilt_by_theta_tilt_5
    part_of_load_inertia_tilt_by_theta_tilt = 2.0 * part_of_load_torque_tilt_by_theta_pan
    part_of_load_inertia_tilt_by_theta_tilt_2 = 1.0 / (
        follower_inertia_tilt * follower_inertia_tilt
    )
    part_of_load_inertia_tilt_by_theta_tilt_3 = (follower_coupling_tilt_sq) * (
        part_of_load_inertia_tilt_by_theta_tilt_2
    )
    load_inertia_tilt_by_theta_tilt = (
        -follower_coupling_tilt_by_theta_tilt * part_of_load_inertia_tilt_by_theta_tilt
        + follower_inertia_tilt_by_theta_tilt * part_of_load_inertia_tilt_by_theta_tilt_3
    )
    part_of_follower_torque_tilt_by_theta_tilt = 2.0 * omega_pan_omega_tilt
    part_of_follower_torque_tilt_by_theta_tilt_2 = (cos_tilt_sq) * (
        part_of_follower_torque_tilt_by_theta_tilt
    )
    part_of_follower_torque_tilt_by_theta_tilt_3 = (J_x_payload) * (
        part_of_follower_torque_tilt_by_theta_tilt_2
    )
    part_of_follower_torque_tilt_by_theta_tilt_4 = (J_x_tilt) * (
        part_of_follower_torque_tilt_by_theta_tilt_2
    )
    part_of_follower_torque_tilt_by_theta_tilt_5 = (part_of_follower_torque_tilt_by_theta_tilt) * (
        sin_tilt_sq
    )
    part_of_follower_torque_tilt_by_theta_tilt_6 = (J_z_payload) * (
        part_of_follower_torque_tilt_by_theta_tilt_5
    )
    part_of_follower_torque_tilt_by_theta_tilt_7 = (J_z_tilt) * (
        part_of_follower_torque_tilt_by_theta_tilt_5
    )
    part_of_follower_torque_tilt_by_theta_tilt_8 = omega_tilt_sq * part_of_follower_coupling_tilt_2
    part_of_follower_torque_tilt_by_theta_tilt_9 = (c_x_payload_m_payload_sin_tilt) * (
        c_z_payload_cos_tilt
    )
    part_of_follower_torque_tilt_by_theta_tilt_10 = (c_x_payload_sq_m_payload) * (
        part_of_follower_torque_tilt_by_theta_tilt_5
    )
    part_of_follower_torque_tilt_by_theta_tilt_11 = (c_z_payload_sq_m_payload) * (
        part_of_follower_torque_tilt_by_theta_tilt_2
    )
    follower_torque_tilt_by_theta_tilt = (
        J_x_payload_sin_tilt_sq * part_of_follower_torque_tilt_by_theta_tilt
        + J_x_tilt_sin_tilt_sq * part_of_follower_torque_tilt_by_theta_tilt
        + J_z_payload_cos_tilt_sq * part_of_follower_torque_tilt_by_theta_tilt
        + J_z_tilt_cos_tilt_sq * part_of_follower_torque_tilt_by_theta_tilt
        + 8.0 * omega_pan_omega_tilt * part_of_follower_torque_tilt_by_theta_tilt_9
        + omega_tilt_sq * part_of_follower_coupling_tilt
        + part_of_follower_inertia_tilt * part_of_follower_torque_tilt_by_theta_tilt
        + part_of_follower_inertia_tilt_2 * part_of_follower_torque_tilt_by_theta_tilt
        - part_of_follower_torque_tilt_by_theta_tilt_10
        - part_of_follower_torque_tilt_by_theta_tilt_11
        - part_of_follower_torque_tilt_by_theta_tilt_3
        - part_of_follower_torque_tilt_by_theta_tilt_4
        - part_of_follower_torque_tilt_by_theta_tilt_6
        - part_of_follower_torque_tilt_by_theta_tilt_7
        - part_of_follower_torque_tilt_by_theta_tilt_8
    )
    part_of_load_torque_tilt_by_theta_tilt = follower_inertia_tilt_inverse * follower_torque_tilt
    part_of_load_torque_tilt_by_theta_tilt_2 = (
        -J_x_payload * cos_tilt_sq * omega_pan_sq
        + J_x_payload_sin_tilt_sq * omega_pan_sq
        - J_x_tilt * cos_tilt_sq * omega_pan_sq
        + J_x_tilt_sin_tilt_sq * omega_pan_sq
        - J_z_payload * omega_pan_sq * sin_tilt_sq
        + J_z_payload_cos_tilt_sq * omega_pan_sq
        - J_z_tilt * omega_pan_sq * sin_tilt_sq
        + J_z_tilt_cos_tilt_sq * omega_pan_sq
        + (9.81) * c_x_payload_m_payload_sin_tilt
        - c_x_payload_sq * m_payload * omega_pan_sq * sin_tilt_sq
        - 9.81 * c_z_payload * cos_tilt * m_payload
        - c_z_payload_sq * cos_tilt_sq * m_payload * omega_pan_sq
        + omega_pan_sq * part_of_follower_inertia_tilt
        + omega_pan_sq * part_of_follower_inertia_tilt_2
        + 4.0 * omega_pan_sq * part_of_follower_torque_tilt_by_theta_tilt_9
    )
    load_torque_tilt_by_theta_tilt = (
        follower_coupling_tilt
        * follower_inertia_tilt_by_theta_tilt
        * follower_torque_tilt
        * part_of_load_inertia_tilt_by_theta_tilt_2
        - follower_coupling_tilt_by_theta_tilt * part_of_load_torque_tilt_by_theta_tilt
        - follower_torque_tilt_by_theta_tilt * part_of_load_torque_tilt_by_theta_pan
        - part_of_load_torque_tilt_by_theta_tilt_2
    )
    part_of_carried_tilt_by_theta_tilt = 2.0 * ratio_tilt_by_theta_tilt
    part_of_carried_tilt_by_theta_tilt_2 = J_motor_tilt_ratio_tilt * load_torque_tilt
    carried_tilt_by_theta_tilt = (
        -J_motor_tilt_ratio_tilt_sq * load_torque_tilt_by_theta_tilt
        + driving_torque_tilt * load_inertia_tilt_by_theta_tilt
        + driving_torque_tilt_by_theta_tilt * load_inertia_tilt
        - part_of_carried_tilt_by_theta_tilt * part_of_carried_tilt_by_theta_tilt_2
    )
    part_of_lost_lowering_tilt_by_theta_tilt = (
        (part_of_lost_lowering_tilt)
        * (1.0 / (part_of_lost_lowering_tilt_2 * part_of_lost_lowering_tilt_2))
        * (
            0.0
            if part_of_lost_lowering_tilt_2 == 0
            else math.copysign(1, part_of_lost_lowering_tilt_2)
        )
    )
    part_of_lost_lowering_tilt_by_theta_tilt_2 = (lowered_tilt) * (
        part_of_lost_lowering_tilt_by_theta_tilt
    )
    part_of_lost_lowering_tilt_by_theta_tilt_3 = (J_motor_tilt_ratio_tilt) * (
        part_of_lost_lowering_tilt_by_theta_tilt
    )
    lost_lowering_tilt_by_theta_tilt = (
        -load_inertia_tilt_by_theta_tilt * part_of_lost_lowering_tilt_by_theta_tilt_2
        - part_of_carried_tilt_by_theta_tilt * part_of_lost_lowering_tilt_by_theta_tilt_3
    )
    part_of_lost_raising_tilt_by_theta_tilt = (part_of_lost_raising_tilt) * (
        1.0 / (part_of_lost_raising_tilt_2 * part_of_lost_raising_tilt_2)
    )
    part_of_lost_raising_tilt_by_theta_tilt_2 = (
        part_of_lost_raising_tilt_by_theta_tilt * raised_tilt
    )
    part_of_lost_raising_tilt_by_theta_tilt_3 = (J_motor_tilt_ratio_tilt) * (
        part_of_lost_raising_tilt_by_theta_tilt
    )
    lost_raising_tilt_by_theta_tilt = (
        -load_inertia_tilt_by_theta_tilt * part_of_lost_raising_tilt_by_theta_tilt_2
        - part_of_carried_tilt_by_theta_tilt * part_of_lost_raising_tilt_by_theta_tilt_3
    )
    part_of_gx_3_0_3_slide_tilt = part_of_gx_3_0_3 * slide_tilt
    part_of_gx_3_1 = (0.5) * carried_tilt_slide_tilt
    part_of_gx_3_1_2 = slide_tilt * ((0.5) * part_of_force_tilt - part_of_gx_3_1)
    part_of_gx_3_1_3 = slide_tilt * (part_of_force_tilt_2 + part_of_gx_3_1)
    part_of_gx_3_1_4 = J_motor_tilt_ratio_tilt * accel_tilt
    part_of_gx_3_1_5 = (
        accel_pan * part_of_follower_coupling_tilt_by_theta_tilt
        + part_of_driving_torque_tilt_by_theta_tilt_3
        + part_of_load_torque_tilt_by_theta_tilt_2
    )
    gx[3, 1] = (
        -part_of_gx_3_0_4
        * (
            -mass_pan_tilt_slide_tilt_sq
            * (
                -carried_tilt_by_theta_tilt * part_of_gx_3_0_3_slide_tilt
                - lost_lowering_tilt_by_theta_tilt * part_of_gx_3_1_2
                - lost_raising_tilt_by_theta_tilt * part_of_gx_3_1_3
                - part_of_carried_tilt_by_theta_tilt * part_of_gx_3_1_4
                - part_of_gx_3_1_5
            )
            + mass_tilt
            * (
                2.0 * J_x_payload * omega_pan * omega_tilt * sin_tilt_sq
                + 2.0 * J_x_tilt * omega_pan * omega_tilt * sin_tilt_sq
                + 2.0 * J_z_payload * cos_tilt_sq * omega_pan * omega_tilt
                + 2.0 * J_z_tilt * cos_tilt_sq * omega_pan * omega_tilt
                - accel_pan * part_of_follower_inertia_tilt_by_theta_tilt_5
                - accel_tilt * part_of_follower_coupling_tilt_by_theta_tilt
                + c_x_payload * c_y_payload * m_payload * omega_tilt_sq * sin_tilt
                + 8.0
                * c_x_payload
                * c_z_payload
                * cos_tilt
                * m_payload
                * omega_pan
                * omega_tilt
                * sin_tilt
                + 2.0 * c_x_payload_sq * cos_tilt_sq * m_payload * omega_pan * omega_tilt
                + 2.0 * c_z_payload_sq * m_payload * omega_pan * omega_tilt * sin_tilt_sq
                - part_of_follower_torque_tilt_by_theta_tilt_10
                - part_of_follower_torque_tilt_by_theta_tilt_11
                - part_of_follower_torque_tilt_by_theta_tilt_3
                - part_of_follower_torque_tilt_by_theta_tilt_4
                - part_of_follower_torque_tilt_by_theta_tilt_6
                - part_of_follower_torque_tilt_by_theta_tilt_7
                - part_of_follower_torque_tilt_by_theta_tilt_8
            )
        )
        - part_of_gx_3_1_5
    )
    gx[4, 1] = load_torque_tilt_by_theta_tilt * part_of_gx_4_0_4
    gx[5, 1] = load_torque_tilt_by_theta_tilt * part_of_gx_5_0
    active_pan_d_shaft_pan = active_pan * d_shaft_pan
    gx[0, 2] = active_pan_d_shaft_pan
    part_of_follower_torque_tilt_by_omega_pan = (
        2.0 * J_z_payload * cos_tilt * omega_tilt * sin_tilt
        + 2.0 * J_z_tilt * cos_tilt * omega_tilt * sin_tilt
        - active_pan_d_shaft_pan
        - b_pan
        + 2.0 * c_x_payload * c_z_payload * m_payload * omega_tilt * sin_tilt_sq
        + 2.0 * c_x_payload_sq * cos_tilt * m_payload * omega_tilt * sin_tilt
        - omega_tilt * part_of_follower_torque_tilt_10
        - omega_tilt * part_of_follower_torque_tilt_2
        - omega_tilt * part_of_follower_torque_tilt_3
        - omega_tilt * part_of_follower_torque_tilt_9
    )
    follower_torque_tilt_by_omega_pan = part_of_follower_torque_tilt_by_omega_pan
    part_of_load_torque_tilt_by_omega_pan = omega_pan * part_of_follower_torque_tilt_2
    part_of_load_torque_tilt_by_omega_pan_2 = omega_pan * part_of_follower_torque_tilt_3
    part_of_load_torque_tilt_by_omega_pan_3 = (
        omega_pan * part_of_follower_inertia_tilt_by_theta_tilt
    )
    part_of_load_torque_tilt_by_omega_pan_4 = (omega_pan) * (
        part_of_follower_inertia_tilt_by_theta_tilt_2
    )
    part_of_load_torque_tilt_by_omega_pan_5 = (omega_pan) * (
        part_of_follower_inertia_tilt_by_theta_tilt_3
    )
    part_of_load_torque_tilt_by_omega_pan_6 = omega_pan * part_of_follower_torque_tilt_9
    part_of_load_torque_tilt_by_omega_pan_7 = (omega_pan) * (
        part_of_follower_inertia_tilt_by_theta_tilt_4
    )
    part_of_load_torque_tilt_by_omega_pan_8 = omega_pan * part_of_follower_torque_tilt_10
    part_of_load_torque_tilt_by_omega_pan_9 = (
        -part_of_load_torque_tilt_by_omega_pan
        - part_of_load_torque_tilt_by_omega_pan_2
        + part_of_load_torque_tilt_by_omega_pan_3
        + part_of_load_torque_tilt_by_omega_pan_4
        + part_of_load_torque_tilt_by_omega_pan_5
        - part_of_load_torque_tilt_by_omega_pan_6
        + part_of_load_torque_tilt_by_omega_pan_7
        - part_of_load_torque_tilt_by_omega_pan_8
    )
    load_torque_tilt_by_omega_pan = (
        -follower_torque_tilt_by_omega_pan * part_of_load_torque_tilt_by_theta_pan
        - part_of_load_torque_tilt_by_omega_pan_9
    )
    carried_tilt_by_omega_pan = -J_motor_tilt_ratio_tilt_sq * load_torque_tilt_by_omega_pan
    gx[3, 2] = (
        -part_of_gx_3_0_4
        * (
            -mass_pan_tilt_slide_tilt_sq
            * (
                -carried_tilt_by_omega_pan * part_of_gx_3_0_3_slide_tilt
                - part_of_load_torque_tilt_by_omega_pan_9
            )
            + mass_tilt * part_of_follower_torque_tilt_by_omega_pan
        )
        - part_of_load_torque_tilt_by_omega_pan_9
    )
    gx[4, 2] = load_torque_tilt_by_omega_pan * part_of_gx_4_0_4
    gx[5, 2] = load_torque_tilt_by_omega_pan * part_of_gx_5_0
    minus_d_shaft_pan = -d_shaft_pan
    gx[8, 2] = minus_d_shaft_pan
    gx[9, 2] = minus_d_shaft_pan
    part_of_driving_torque_tilt_by_omega_tilt = (
        J_motor_tilt * omega_tilt_ratio_tilt * part_of_carried_tilt_by_theta_tilt
        + b_motor_tilt * ratio_tilt_sq
    )
    driving_torque_tilt_by_omega_tilt = -part_of_driving_torque_tilt_by_omega_tilt
    part_of_follower_torque_tilt_by_omega_tilt = 2.0 * omega_tilt
    part_of_follower_torque_tilt_by_omega_tilt_2 = (
        -part_of_follower_torque_tilt_4 * part_of_follower_torque_tilt_by_omega_tilt
        - part_of_follower_torque_tilt_5 * part_of_follower_torque_tilt_by_omega_tilt
        - part_of_load_torque_tilt_by_omega_pan
        - part_of_load_torque_tilt_by_omega_pan_2
        + part_of_load_torque_tilt_by_omega_pan_3
        + part_of_load_torque_tilt_by_omega_pan_4
        + part_of_load_torque_tilt_by_omega_pan_5
        - part_of_load_torque_tilt_by_omega_pan_6
        + part_of_load_torque_tilt_by_omega_pan_7
        - part_of_load_torque_tilt_by_omega_pan_8
    )
    follower_torque_tilt_by_omega_tilt = part_of_follower_torque_tilt_by_omega_tilt_2
    load_torque_tilt_by_omega_tilt = (
        -b_tilt - follower_torque_tilt_by_omega_tilt * part_of_load_torque_tilt_by_theta_pan
    )
    carried_tilt_by_omega_tilt = (
        -J_motor_tilt_ratio_tilt_sq * load_torque_tilt_by_omega_tilt
        + driving_torque_tilt_by_omega_tilt * load_inertia_tilt
    )
    part_of_gx_3_3 = b_tilt + part_of_driving_torque_tilt_by_omega_tilt
    gx[3, 3] = (
        -part_of_gx_3_0_4
        * (
            -mass_pan_tilt_slide_tilt_sq
            * (-carried_tilt_by_omega_tilt * part_of_gx_3_0_3_slide_tilt - part_of_gx_3_3)
            + mass_tilt * part_of_follower_torque_tilt_by_omega_tilt_2
        )
        - part_of_gx_3_3
    )
    gx[4, 3] = load_torque_tilt_by_omega_tilt * part_of_gx_4_0_4
    gx[5, 3] = load_torque_tilt_by_omega_tilt * part_of_gx_5_0
    gx[0, 4] = minus_active_pan_k_shaft_pan
    follower_torque_tilt_by_theta_gear_pan = active_pan_k_shaft_pan
    load_torque_tilt_by_theta_gear_pan = (
        (-1.0) * (follower_torque_tilt_by_theta_gear_pan) * (part_of_load_torque_tilt_by_theta_pan)
    )
    carried_tilt_by_theta_gear_pan = (
        -J_motor_tilt_ratio_tilt_sq * load_torque_tilt_by_theta_gear_pan
    )
    part_of_gx_3_4 = mass_pan_tilt * part_of_gx_3_0_3 * slide_tilt_cubed
    gx[3, 4] = (
        (-1.0)
        * (part_of_gx_3_0_4)
        * (active_pan_k_shaft_pan_mass_tilt + carried_tilt_by_theta_gear_pan * part_of_gx_3_4)
    )
    gx[4, 4] = load_torque_tilt_by_theta_gear_pan * part_of_gx_4_0_4
    gx[5, 4] = load_torque_tilt_by_theta_gear_pan * part_of_gx_5_0
    gx[6, 4] = 1.0
    gx[8, 4] = k_shaft_pan
    gx[9, 4] = k_shaft_pan
    gx[0, 5] = -active_pan_d_shaft_pan
    follower_torque_tilt_by_omega_gear_pan = active_pan_d_shaft_pan
    load_torque_tilt_by_omega_gear_pan = (
        (-1.0) * (follower_torque_tilt_by_omega_gear_pan) * (part_of_load_torque_tilt_by_theta_pan)
    )
    carried_tilt_by_omega_gear_pan = (
        -J_motor_tilt_ratio_tilt_sq * load_torque_tilt_by_omega_gear_pan
    )
    gx[3, 5] = (
        (-1.0)
        * (part_of_gx_3_0_4)
        * (active_pan_d_shaft_pan * mass_tilt + carried_tilt_by_omega_gear_pan * part_of_gx_3_4)
    )
    gx[4, 5] = load_torque_tilt_by_omega_gear_pan * part_of_gx_4_0_4
    gx[5, 5] = load_torque_tilt_by_omega_gear_pan * part_of_gx_5_0
    gx[8, 5] = d_shaft_pan
    gx[9, 5] = d_shaft_pan
    gx[0, 6] = K_t_pan * N_pan
    K_t_tilt_ratio_tilt = K_t_tilt * ratio_tilt
    driving_torque_tilt_by_i_tilt = K_t_tilt_ratio_tilt
    carried_tilt_by_i_tilt = driving_torque_tilt_by_i_tilt * load_inertia_tilt
    part_of_gx_3_7 = mass_pan_tilt_sq * part_of_accel_tilt
    gx[3, 7] = K_t_tilt_ratio_tilt + part_of_gx_3_7 * (
        K_t_tilt_ratio_tilt - carried_tilt_by_i_tilt * part_of_gx_3_0_3_slide_tilt
    )
    follower_inertia_tilt_by_J_pan = 1.0
    load_inertia_tilt_by_J_pan = (follower_inertia_tilt_by_J_pan) * (
        part_of_load_inertia_tilt_by_theta_tilt_3
    )
    part_of_load_torque_tilt_by_J_pan = (
        (follower_coupling_tilt)
        * (follower_torque_tilt)
        * (part_of_load_inertia_tilt_by_theta_tilt_2)
    )
    load_torque_tilt_by_J_pan = follower_inertia_tilt_by_J_pan * part_of_load_torque_tilt_by_J_pan
    carried_tilt_by_J_pan = (
        -J_motor_tilt_ratio_tilt_sq * load_torque_tilt_by_J_pan
        + driving_torque_tilt * load_inertia_tilt_by_J_pan
    )
    lost_lowering_tilt_by_J_pan = (
        (-1.0) * (load_inertia_tilt_by_J_pan) * (part_of_lost_lowering_tilt_by_theta_tilt_2)
    )
    lost_raising_tilt_by_J_pan = (
        (-1.0) * (load_inertia_tilt_by_J_pan) * (part_of_lost_raising_tilt_by_theta_tilt_2)
    )
    gp[3, 0] = (
        (-1.0)
        * (part_of_gx_3_0_4)
        * (
            -accel_pan * mass_tilt
            - mass_pan_tilt_slide_tilt_sq
            * (
                -carried_tilt_by_J_pan * part_of_gx_3_0_3_slide_tilt
                - lost_lowering_tilt_by_J_pan * part_of_gx_3_1_2
                - lost_raising_tilt_by_J_pan * part_of_gx_3_1_3
            )
        )
    )
    gp[4, 0] = load_torque_tilt_by_J_pan * part_of_gx_4_0_4
    gp[5, 0] = load_torque_tilt_by_J_pan * part_of_gx_5_0
    follower_inertia_tilt_by_J_x_tilt = sin_tilt_sq
    load_inertia_tilt_by_J_x_tilt = (follower_inertia_tilt_by_J_x_tilt) * (
        part_of_load_inertia_tilt_by_theta_tilt_3
    )
    part_of_follower_torque_tilt_by_J_x_tilt = omega_pan_omega_tilt * part_of_follower_torque_tilt
    part_of_follower_torque_tilt_by_J_x_tilt_2 = -part_of_follower_torque_tilt_by_J_x_tilt
    follower_torque_tilt_by_J_x_tilt = part_of_follower_torque_tilt_by_J_x_tilt_2
    load_torque_tilt_by_J_x_tilt = (
        cos_tilt_sin_tilt_omega_pan_sq
        + follower_inertia_tilt_by_J_x_tilt * part_of_load_torque_tilt_by_J_pan
        - follower_torque_tilt_by_J_x_tilt * part_of_load_torque_tilt_by_theta_pan
    )
    carried_tilt_by_J_x_tilt = (
        -J_motor_tilt_ratio_tilt_sq * load_torque_tilt_by_J_x_tilt
        + driving_torque_tilt * load_inertia_tilt_by_J_x_tilt
    )
    lost_lowering_tilt_by_J_x_tilt = (
        (-1.0) * (load_inertia_tilt_by_J_x_tilt) * (part_of_lost_lowering_tilt_by_theta_tilt_2)
    )
    lost_raising_tilt_by_J_x_tilt = (
        (-1.0) * (load_inertia_tilt_by_J_x_tilt) * (part_of_lost_raising_tilt_by_theta_tilt_2)
    )
    part_of_gp_3_1 = -cos_tilt_sin_tilt_omega_pan_sq
    part_of_gp_3_1_2 = (
        (-1.0) * (mass_tilt) * (-accel_pan * sin_tilt_sq - part_of_follower_torque_tilt_by_J_x_tilt)
    )
    gp[3, 1] = -part_of_gp_3_1 - part_of_gx_3_0_4 * (
        -mass_pan_tilt_slide_tilt_sq
        * (
            -carried_tilt_by_J_x_tilt * part_of_gx_3_0_3_slide_tilt
            - lost_lowering_tilt_by_J_x_tilt * part_of_gx_3_1_2
            - lost_raising_tilt_by_J_x_tilt * part_of_gx_3_1_3
            - part_of_gp_3_1
        )
        - part_of_gp_3_1_2
    )
    gp[4, 1] = load_torque_tilt_by_J_x_tilt * part_of_gx_4_0_4
    gp[5, 1] = load_torque_tilt_by_J_x_tilt * part_of_gx_5_0
    load_inertia_tilt_by_J_y_tilt = 1.0
    carried_tilt_by_J_y_tilt = driving_torque_tilt * load_inertia_tilt_by_J_y_tilt
    lost_lowering_tilt_by_J_y_tilt = (
        (-1.0) * (load_inertia_tilt_by_J_y_tilt) * (part_of_lost_lowering_tilt_by_theta_tilt_2)
    )
    lost_raising_tilt_by_J_y_tilt = (
        (-1.0) * (load_inertia_tilt_by_J_y_tilt) * (part_of_lost_raising_tilt_by_theta_tilt_2)
    )
    gp[3, 2] = (part_of_gx_3_7) * (
        -accel_tilt
        - carried_tilt_by_J_y_tilt * part_of_gx_3_0_3_slide_tilt
        - lost_lowering_tilt_by_J_y_tilt * part_of_gx_3_1_2
        - lost_raising_tilt_by_J_y_tilt * part_of_gx_3_1_3
    )
    follower_inertia_tilt_by_J_z_tilt = cos_tilt_sq
    load_inertia_tilt_by_J_z_tilt = (follower_inertia_tilt_by_J_z_tilt) * (
        part_of_load_inertia_tilt_by_theta_tilt_3
    )
    follower_torque_tilt_by_J_z_tilt = part_of_follower_torque_tilt_by_J_x_tilt
    load_torque_tilt_by_J_z_tilt = (
        -cos_tilt_sin_tilt_omega_pan_sq
        + follower_coupling_tilt
        * follower_inertia_tilt_by_J_z_tilt
        * follower_torque_tilt
        * part_of_load_inertia_tilt_by_theta_tilt_2
        - follower_torque_tilt_by_J_z_tilt * part_of_load_torque_tilt_by_theta_pan
    )
    carried_tilt_by_J_z_tilt = (
        -J_motor_tilt_ratio_tilt_sq * load_torque_tilt_by_J_z_tilt
        + driving_torque_tilt * load_inertia_tilt_by_J_z_tilt
    )
    lost_lowering_tilt_by_J_z_tilt = (
        (-1.0) * (load_inertia_tilt_by_J_z_tilt) * (part_of_lost_lowering_tilt_by_theta_tilt_2)
    )
    lost_raising_tilt_by_J_z_tilt = (
        (-1.0) * (load_inertia_tilt_by_J_z_tilt) * (part_of_lost_raising_tilt_by_theta_tilt_2)
    )
    part_of_gp_3_3 = (
        (-1.0)
        * (mass_tilt)
        * (-accel_pan * cos_tilt_sq - part_of_follower_torque_tilt_by_J_x_tilt_2)
    )
    gp[3, 3] = -cos_tilt_sin_tilt_omega_pan_sq - part_of_gx_3_0_4 * (
        -mass_pan_tilt_slide_tilt_sq
        * (
            -carried_tilt_by_J_z_tilt * part_of_gx_3_0_3_slide_tilt
            - cos_tilt_sin_tilt_omega_pan_sq
            - lost_lowering_tilt_by_J_z_tilt * part_of_gx_3_1_2
            - lost_raising_tilt_by_J_z_tilt * part_of_gx_3_1_3
        )
        - part_of_gp_3_3
    )
    gp[4, 3] = load_torque_tilt_by_J_z_tilt * part_of_gx_4_0_4
    gp[5, 3] = load_torque_tilt_by_J_z_tilt * part_of_gx_5_0
    part_of_follower_coupling_tilt_by_m_payload = (
        c_x_payload_c_y_payload_sin_tilt - c_y_payload_c_z_payload_cos_tilt
    )
    follower_coupling_tilt_by_m_payload = part_of_follower_coupling_tilt_by_m_payload
    part_of_follower_inertia_tilt_by_m_payload = (
        c_x_payload * part_of_follower_inertia_tilt_3 * sin_tilt
        + c_x_payload_sq * cos_tilt_sq
        + c_y_payload_sq_cos_tilt_sq
        + c_y_payload_sq_sin_tilt_sq
        + c_z_payload_sq * sin_tilt_sq
    )
    follower_inertia_tilt_by_m_payload = part_of_follower_inertia_tilt_by_m_payload
    part_of_load_inertia_tilt_by_m_payload = c_x_payload_sq + c_z_payload_sq
    load_inertia_tilt_by_m_payload = (
        -follower_coupling_tilt_by_m_payload * part_of_load_inertia_tilt_by_theta_tilt
        + follower_inertia_tilt_by_m_payload * part_of_load_inertia_tilt_by_theta_tilt_3
        + part_of_load_inertia_tilt_by_m_payload
    )
    c_x_payload_omega_tilt_sq = c_x_payload * omega_tilt_sq
    c_z_payload_omega_tilt_sq = c_z_payload * omega_tilt_sq
    part_of_follower_torque_tilt_by_m_payload = (
        -2.0 * c_x_payload * c_z_payload * omega_pan * omega_tilt * sin_tilt_sq
        + c_x_payload_c_z_payload * part_of_follower_torque_tilt_by_theta_tilt_2
        + c_x_payload_omega_tilt_sq * c_y_payload * cos_tilt
        - 2.0 * c_x_payload_sq * cos_tilt * omega_pan * omega_tilt * sin_tilt
        + c_y_payload_sin_tilt * c_z_payload_omega_tilt_sq
        + c_z_payload_sq * part_of_follower_torque_tilt_by_J_x_tilt
    )
    follower_torque_tilt_by_m_payload = -part_of_follower_torque_tilt_by_m_payload
    part_of_load_torque_tilt_by_m_payload = c_x_payload_sq * cos_tilt_sin_tilt_omega_pan_sq
    load_torque_tilt_by_m_payload = (
        c_z_payload_sq * cos_tilt_sin_tilt_omega_pan_sq
        + cos_tilt * part_of_load_torque_tilt
        - follower_coupling_tilt_by_m_payload * part_of_load_torque_tilt_by_theta_tilt
        + follower_inertia_tilt_by_m_payload * part_of_load_torque_tilt_by_J_pan
        - follower_torque_tilt_by_m_payload * part_of_load_torque_tilt_by_theta_pan
        + part_of_load_torque_tilt_2 * sin_tilt
        + part_of_load_torque_tilt_5
        - part_of_load_torque_tilt_6
        - part_of_load_torque_tilt_by_m_payload
    )
    carried_tilt_by_m_payload = (
        -J_motor_tilt_ratio_tilt_sq * load_torque_tilt_by_m_payload
        + driving_torque_tilt * load_inertia_tilt_by_m_payload
    )
    lost_lowering_tilt_by_m_payload = (
        (-1.0) * (load_inertia_tilt_by_m_payload) * (part_of_lost_lowering_tilt_by_theta_tilt_2)
    )
    lost_raising_tilt_by_m_payload = (
        (-1.0) * (load_inertia_tilt_by_m_payload) * (part_of_lost_raising_tilt_by_theta_tilt_2)
    )
    part_of_gp_3_4 = (
        accel_pan * part_of_follower_coupling_tilt_by_m_payload
        - c_x_payload * c_z_payload * cos_tilt_sq * omega_pan_sq
        - 9.81 * c_x_payload * cos_tilt
        - 9.81 * c_z_payload * sin_tilt
        - c_z_payload_sq * cos_tilt * omega_pan_sq * sin_tilt
        + part_of_load_torque_tilt_6
        + part_of_load_torque_tilt_by_m_payload
    )
    gp[3, 4] = -part_of_gp_3_4 - part_of_gx_3_0_4 * (
        -mass_pan_tilt_slide_tilt_sq
        * (
            -accel_tilt * part_of_load_inertia_tilt_by_m_payload
            - carried_tilt_by_m_payload * part_of_gx_3_0_3_slide_tilt
            - lost_lowering_tilt_by_m_payload * part_of_gx_3_1_2
            - lost_raising_tilt_by_m_payload * part_of_gx_3_1_3
            - part_of_gp_3_4
        )
        + mass_tilt
        * (
            -accel_pan * part_of_follower_inertia_tilt_by_m_payload
            - accel_tilt * part_of_follower_coupling_tilt_by_m_payload
            - part_of_follower_torque_tilt_by_m_payload
        )
    )
    gp[4, 4] = load_torque_tilt_by_m_payload * part_of_gx_4_0_4
    gp[5, 4] = load_torque_tilt_by_m_payload * part_of_gx_5_0
    follower_inertia_tilt_by_J_x_payload = sin_tilt_sq
    load_inertia_tilt_by_J_x_payload = (follower_inertia_tilt_by_J_x_payload) * (
        part_of_load_inertia_tilt_by_theta_tilt_3
    )
    follower_torque_tilt_by_J_x_payload = part_of_follower_torque_tilt_by_J_x_tilt_2
    load_torque_tilt_by_J_x_payload = (
        cos_tilt_sin_tilt_omega_pan_sq
        + follower_inertia_tilt_by_J_x_payload * part_of_load_torque_tilt_by_J_pan
        - follower_torque_tilt_by_J_x_payload * part_of_load_torque_tilt_by_theta_pan
    )
    carried_tilt_by_J_x_payload = (
        -J_motor_tilt_ratio_tilt_sq * load_torque_tilt_by_J_x_payload
        + driving_torque_tilt * load_inertia_tilt_by_J_x_payload
    )
    lost_lowering_tilt_by_J_x_payload = (
        (-1.0) * (load_inertia_tilt_by_J_x_payload) * (part_of_lost_lowering_tilt_by_theta_tilt_2)
    )
    lost_raising_tilt_by_J_x_payload = (
        (-1.0) * (load_inertia_tilt_by_J_x_payload) * (part_of_lost_raising_tilt_by_theta_tilt_2)
    )
    gp[3, 5] = -part_of_gp_3_1 - part_of_gx_3_0_4 * (
        -mass_pan_tilt_slide_tilt_sq
        * (
            -carried_tilt_by_J_x_payload * part_of_gx_3_0_3_slide_tilt
            - lost_lowering_tilt_by_J_x_payload * part_of_gx_3_1_2
            - lost_raising_tilt_by_J_x_payload * part_of_gx_3_1_3
            - part_of_gp_3_1
        )
        - part_of_gp_3_1_2
    )
    gp[4, 5] = load_torque_tilt_by_J_x_payload * part_of_gx_4_0_4
    gp[5, 5] = load_torque_tilt_by_J_x_payload * part_of_gx_5_0
    load_inertia_tilt_by_J_y_payload = 1.0
    carried_tilt_by_J_y_payload = driving_torque_tilt * load_inertia_tilt_by_J_y_payload
    lost_lowering_tilt_by_J_y_payload = (
        (-1.0) * (load_inertia_tilt_by_J_y_payload) * (part_of_lost_lowering_tilt_by_theta_tilt_2)
    )
    lost_raising_tilt_by_J_y_payload = (
        (-1.0) * (load_inertia_tilt_by_J_y_payload) * (part_of_lost_raising_tilt_by_theta_tilt_2)
    )
    gp[3, 6] = (part_of_gx_3_7) * (
        -accel_tilt
        - carried_tilt_by_J_y_payload * part_of_gx_3_0_3_slide_tilt
        - lost_lowering_tilt_by_J_y_payload * part_of_gx_3_1_2
        - lost_raising_tilt_by_J_y_payload * part_of_gx_3_1_3
    )
    follower_inertia_tilt_by_J_z_payload = cos_tilt_sq
    load_inertia_tilt_by_J_z_payload = (follower_inertia_tilt_by_J_z_payload) * (
        part_of_load_inertia_tilt_by_theta_tilt_3
    )
    follower_torque_tilt_by_J_z_payload = part_of_follower_torque_tilt_by_J_x_tilt
    load_torque_tilt_by_J_z_payload = (
        -cos_tilt_sin_tilt_omega_pan_sq
        + follower_coupling_tilt
        * follower_inertia_tilt_by_J_z_payload
        * follower_torque_tilt
        * part_of_load_inertia_tilt_by_theta_tilt_2
        - follower_torque_tilt_by_J_z_payload * part_of_load_torque_tilt_by_theta_pan
    )
    carried_tilt_by_J_z_payload = (
        -J_motor_tilt_ratio_tilt_sq * load_torque_tilt_by_J_z_payload
        + driving_torque_tilt * load_inertia_tilt_by_J_z_payload
    )
    lost_lowering_tilt_by_J_z_payload = (
        (-1.0) * (load_inertia_tilt_by_J_z_payload) * (part_of_lost_lowering_tilt_by_theta_tilt_2)
    )
    lost_raising_tilt_by_J_z_payload = (
        (-1.0) * (load_inertia_tilt_by_J_z_payload) * (part_of_lost_raising_tilt_by_theta_tilt_2)
    )
    gp[3, 7] = -cos_tilt_sin_tilt_omega_pan_sq - part_of_gx_3_0_4 * (
        -mass_pan_tilt_slide_tilt_sq
        * (
            -carried_tilt_by_J_z_payload * part_of_gx_3_0_3_slide_tilt
            - cos_tilt_sin_tilt_omega_pan_sq
            - lost_lowering_tilt_by_J_z_payload * part_of_gx_3_1_2
            - lost_raising_tilt_by_J_z_payload * part_of_gx_3_1_3
        )
        - part_of_gp_3_3
    )
    gp[4, 7] = load_torque_tilt_by_J_z_payload * part_of_gx_4_0_4
    gp[5, 7] = load_torque_tilt_by_J_z_payload * part_of_gx_5_0
    follower_coupling_tilt_by_c_x_payload = c_y_payload_sin_tilt_m_payload
    part_of_follower_inertia_tilt_by_c_x_payload = (m_payload_sin_tilt) * (
        part_of_follower_inertia_tilt_3
    )
    part_of_follower_inertia_tilt_by_c_x_payload_2 = (
        part_of_follower_inertia_tilt_by_c_x_payload + part_of_follower_torque_tilt_8
    )
    follower_inertia_tilt_by_c_x_payload = part_of_follower_inertia_tilt_by_c_x_payload_2
    load_inertia_tilt_by_c_x_payload = (
        -follower_coupling_tilt_by_c_x_payload * part_of_load_inertia_tilt_by_theta_tilt
        + follower_inertia_tilt_by_c_x_payload * part_of_load_inertia_tilt_by_theta_tilt_3
        + part_of_follower_torque_tilt_7
    )
    part_of_follower_torque_tilt_by_c_x_payload = c_z_payload * part_of_follower_torque_tilt_6
    part_of_follower_torque_tilt_by_c_x_payload_2 = (
        part_of_follower_torque_tilt_by_c_x_payload
    ) * (sin_tilt_sq)
    part_of_follower_torque_tilt_by_c_x_payload_3 = c_x_payload_m_payload_sin_tilt * cos_tilt
    part_of_follower_torque_tilt_by_c_x_payload_4 = c_y_payload_cos_tilt_m_payload * omega_tilt_sq
    part_of_follower_torque_tilt_by_c_x_payload_5 = (
        (cos_tilt_sq) * (omega_pan_omega_tilt) * (part_of_follower_torque_tilt_by_c_x_payload)
    )
    part_of_follower_torque_tilt_by_c_x_payload_6 = 4.0 * omega_pan_omega_tilt
    follower_torque_tilt_by_c_x_payload = (
        omega_pan_omega_tilt * part_of_follower_torque_tilt_by_c_x_payload_2
        + part_of_follower_torque_tilt_by_c_x_payload_3
        * part_of_follower_torque_tilt_by_c_x_payload_6
        - part_of_follower_torque_tilt_by_c_x_payload_4
        - part_of_follower_torque_tilt_by_c_x_payload_5
    )
    part_of_load_torque_tilt_by_c_x_payload = 2.0 * part_of_follower_torque_tilt_by_c_x_payload_3
    part_of_load_torque_tilt_by_c_x_payload_2 = (
        -c_z_payload * cos_tilt_sq * m_payload * omega_pan_sq
        + c_z_payload * m_payload * omega_pan_sq_sin_tilt_sq
        - 9.81 * cos_tilt * m_payload
        + omega_pan_sq * part_of_load_torque_tilt_by_c_x_payload
    )
    load_torque_tilt_by_c_x_payload = (
        follower_coupling_tilt
        * follower_inertia_tilt_by_c_x_payload
        * follower_torque_tilt
        * part_of_load_inertia_tilt_by_theta_tilt_2
        - follower_coupling_tilt_by_c_x_payload * part_of_load_torque_tilt_by_theta_tilt
        - follower_torque_tilt_by_c_x_payload * part_of_load_torque_tilt_by_theta_pan
        - part_of_load_torque_tilt_by_c_x_payload_2
    )
    carried_tilt_by_c_x_payload = (
        -J_motor_tilt_ratio_tilt_sq * load_torque_tilt_by_c_x_payload
        + driving_torque_tilt * load_inertia_tilt_by_c_x_payload
    )
    lost_lowering_tilt_by_c_x_payload = (
        (-1.0) * (load_inertia_tilt_by_c_x_payload) * (part_of_lost_lowering_tilt_by_theta_tilt_2)
    )
    lost_raising_tilt_by_c_x_payload = (
        (-1.0) * (load_inertia_tilt_by_c_x_payload) * (part_of_lost_raising_tilt_by_theta_tilt_2)
    )
    part_of_gp_3_8 = (
        accel_pan * c_y_payload_sin_tilt_m_payload + part_of_load_torque_tilt_by_c_x_payload_2
    )
    gp[3, 8] = -part_of_gp_3_8 - part_of_gx_3_0_4 * (
        -mass_pan_tilt_slide_tilt_sq
        * (
            -accel_tilt * part_of_follower_torque_tilt_7
            - carried_tilt_by_c_x_payload * part_of_gx_3_0_3_slide_tilt
            - lost_lowering_tilt_by_c_x_payload * part_of_gx_3_1_2
            - lost_raising_tilt_by_c_x_payload * part_of_gx_3_1_3
            - part_of_gp_3_8
        )
        + mass_tilt
        * (
            -accel_pan * part_of_follower_inertia_tilt_by_c_x_payload_2
            - accel_tilt * c_y_payload_sin_tilt_m_payload
            + 4.0 * c_x_payload * cos_tilt * m_payload * omega_pan * omega_tilt * sin_tilt
            + 2.0 * c_z_payload * m_payload * omega_pan * omega_tilt * sin_tilt_sq
            - part_of_follower_torque_tilt_by_c_x_payload_4
            - part_of_follower_torque_tilt_by_c_x_payload_5
        )
    )
    gp[4, 8] = load_torque_tilt_by_c_x_payload * part_of_gx_4_0_4
    gp[5, 8] = load_torque_tilt_by_c_x_payload * part_of_gx_5_0
    part_of_follower_coupling_tilt_by_c_y_payload = (
        c_x_payload_m_payload_sin_tilt - c_z_payload_cos_tilt * m_payload
    )
    follower_coupling_tilt_by_c_y_payload = part_of_follower_coupling_tilt_by_c_y_payload
    part_of_follower_inertia_tilt_by_c_y_payload = c_y_payload * part_of_follower_torque_tilt_6
    part_of_follower_inertia_tilt_by_c_y_payload_2 = (
        cos_tilt_sq * part_of_follower_inertia_tilt_by_c_y_payload
        + part_of_follower_inertia_tilt_by_c_y_payload * sin_tilt_sq
    )
    follower_inertia_tilt_by_c_y_payload = part_of_follower_inertia_tilt_by_c_y_payload_2
    load_inertia_tilt_by_c_y_payload = (
        -follower_coupling_tilt_by_c_y_payload * part_of_load_inertia_tilt_by_theta_tilt
        + follower_inertia_tilt_by_c_y_payload * part_of_load_inertia_tilt_by_theta_tilt_3
    )
    part_of_follower_torque_tilt_by_c_y_payload = (
        c_x_payload_omega_tilt_sq * cos_tilt_m_payload
        + c_z_payload_omega_tilt_sq * m_payload_sin_tilt
    )
    follower_torque_tilt_by_c_y_payload = -part_of_follower_torque_tilt_by_c_y_payload
    load_torque_tilt_by_c_y_payload = (
        follower_coupling_tilt
        * follower_inertia_tilt_by_c_y_payload
        * follower_torque_tilt
        * part_of_load_inertia_tilt_by_theta_tilt_2
        - follower_coupling_tilt_by_c_y_payload * part_of_load_torque_tilt_by_theta_tilt
        - follower_torque_tilt_by_c_y_payload * part_of_load_torque_tilt_by_theta_pan
    )
    carried_tilt_by_c_y_payload = (
        -J_motor_tilt_ratio_tilt_sq * load_torque_tilt_by_c_y_payload
        + driving_torque_tilt * load_inertia_tilt_by_c_y_payload
    )
    lost_lowering_tilt_by_c_y_payload = (
        (-1.0) * (load_inertia_tilt_by_c_y_payload) * (part_of_lost_lowering_tilt_by_theta_tilt_2)
    )
    lost_raising_tilt_by_c_y_payload = (
        (-1.0) * (load_inertia_tilt_by_c_y_payload) * (part_of_lost_raising_tilt_by_theta_tilt_2)
    )
    part_of_gp_3_9 = accel_pan * part_of_follower_coupling_tilt_by_c_y_payload
    gp[3, 9] = -part_of_gp_3_9 - part_of_gx_3_0_4 * (
        -mass_pan_tilt_slide_tilt_sq
        * (
            -carried_tilt_by_c_y_payload * part_of_gx_3_0_3_slide_tilt
            - lost_lowering_tilt_by_c_y_payload * part_of_gx_3_1_2
            - lost_raising_tilt_by_c_y_payload * part_of_gx_3_1_3
            - part_of_gp_3_9
        )
        + mass_tilt
        * (
            -accel_pan * part_of_follower_inertia_tilt_by_c_y_payload_2
            - accel_tilt * part_of_follower_coupling_tilt_by_c_y_payload
            - part_of_follower_torque_tilt_by_c_y_payload
        )
    )
    gp[4, 9] = load_torque_tilt_by_c_y_payload * part_of_gx_4_0_4
    gp[5, 9] = load_torque_tilt_by_c_y_payload * part_of_gx_5_0
    follower_coupling_tilt_by_c_z_payload = -c_y_payload_cos_tilt_m_payload
    part_of_follower_inertia_tilt_by_c_z_payload = (
        part_of_follower_torque_tilt_by_c_x_payload_2 + part_of_load_torque_tilt_by_c_x_payload
    )
    follower_inertia_tilt_by_c_z_payload = part_of_follower_inertia_tilt_by_c_z_payload
    load_inertia_tilt_by_c_z_payload = (
        -follower_coupling_tilt_by_c_z_payload * part_of_load_inertia_tilt_by_theta_tilt
        + follower_inertia_tilt_by_c_z_payload * part_of_load_inertia_tilt_by_theta_tilt_3
        + part_of_follower_torque_tilt_by_c_x_payload
    )
    part_of_follower_torque_tilt_by_c_z_payload = (
        -2.0 * c_x_payload * m_payload * omega_pan * omega_tilt * sin_tilt_sq
        + c_y_payload_sin_tilt_m_payload * omega_tilt_sq
        + c_z_payload_cos_tilt * m_payload_sin_tilt * part_of_follower_torque_tilt_by_c_x_payload_6
        + omega_pan_omega_tilt * part_of_follower_torque_tilt_8
    )
    follower_torque_tilt_by_c_z_payload = -part_of_follower_torque_tilt_by_c_z_payload
    c_x_payload_m_payload = c_x_payload * m_payload
    part_of_load_torque_tilt_by_c_z_payload = c_x_payload_m_payload * omega_pan_sq_sin_tilt_sq
    part_of_load_torque_tilt_by_c_z_payload_2 = (
        c_x_payload_m_payload * cos_tilt_sq_omega_pan_sq
        + (9.81) * m_payload_sin_tilt
        + omega_pan_sq * part_of_follower_inertia_tilt_by_c_x_payload
        - part_of_load_torque_tilt_by_c_z_payload
    )
    load_torque_tilt_by_c_z_payload = (
        -follower_coupling_tilt_by_c_z_payload * part_of_load_torque_tilt_by_theta_tilt
        + follower_inertia_tilt_by_c_z_payload * part_of_load_torque_tilt_by_J_pan
        - follower_torque_tilt_by_c_z_payload * part_of_load_torque_tilt_by_theta_pan
        + part_of_load_torque_tilt_by_c_z_payload_2
    )
    carried_tilt_by_c_z_payload = (
        -J_motor_tilt_ratio_tilt_sq * load_torque_tilt_by_c_z_payload
        + driving_torque_tilt * load_inertia_tilt_by_c_z_payload
    )
    lost_lowering_tilt_by_c_z_payload = (
        (-1.0) * (load_inertia_tilt_by_c_z_payload) * (part_of_lost_lowering_tilt_by_theta_tilt_2)
    )
    lost_raising_tilt_by_c_z_payload = (
        (-1.0) * (load_inertia_tilt_by_c_z_payload) * (part_of_lost_raising_tilt_by_theta_tilt_2)
    )
    gp[3, 10] = (
        accel_pan * c_y_payload_cos_tilt_m_payload
        - part_of_gx_3_0_4
        * (
            -mass_pan_tilt_slide_tilt_sq
            * (
                accel_pan * c_y_payload * cos_tilt * m_payload
                - accel_tilt * part_of_follower_torque_tilt_by_c_x_payload
                + c_x_payload * cos_tilt_sq * m_payload * omega_pan_sq
                + 2.0 * c_z_payload * cos_tilt * m_payload * omega_pan_sq * sin_tilt
                - carried_tilt_by_c_z_payload * part_of_gx_3_0_3_slide_tilt
                - lost_lowering_tilt_by_c_z_payload * part_of_gx_3_1_2
                - lost_raising_tilt_by_c_z_payload * part_of_gx_3_1_3
                + (9.81) * m_payload * sin_tilt
                - part_of_load_torque_tilt_by_c_z_payload
            )
            + mass_tilt
            * (
                -accel_pan * part_of_follower_inertia_tilt_by_c_z_payload
                + accel_tilt * c_y_payload * cos_tilt * m_payload
                - part_of_follower_torque_tilt_by_c_z_payload
            )
        )
        + part_of_load_torque_tilt_by_c_z_payload_2
    )
    gp[4, 10] = load_torque_tilt_by_c_z_payload * part_of_gx_4_0_4
    gp[5, 10] = load_torque_tilt_by_c_z_payload * part_of_gx_5_0
    follower_torque_tilt_by_b_pan = minus_omega_pan
    load_torque_tilt_by_b_pan = (
        -follower_torque_tilt_by_b_pan * part_of_load_torque_tilt_by_theta_pan
    )
    carried_tilt_by_b_pan = -J_motor_tilt_ratio_tilt_sq * load_torque_tilt_by_b_pan
    gp[3, 11] = -part_of_gx_3_0_4 * (carried_tilt_by_b_pan * part_of_gx_3_4 - mass_tilt * omega_pan)
    gp[4, 11] = load_torque_tilt_by_b_pan * part_of_gx_4_0_4
    gp[5, 11] = load_torque_tilt_by_b_pan * part_of_gx_5_0
    gp[0, 14] = N_pan * i_pan
    gp[0, 16] = K_t_pan * i_pan
    part_of_gp_0_17 = active_pan * part_of_follower_torque_tilt_14
    gp[0, 17] = -part_of_gp_0_17
    follower_torque_tilt_by_k_shaft_pan = part_of_gp_0_17
    load_torque_tilt_by_k_shaft_pan = (
        (-1.0) * (follower_torque_tilt_by_k_shaft_pan) * (part_of_load_torque_tilt_by_theta_pan)
    )
    carried_tilt_by_k_shaft_pan = -J_motor_tilt_ratio_tilt_sq * load_torque_tilt_by_k_shaft_pan
    gp[3, 17] = (
        (-1.0)
        * (part_of_gx_3_0_4)
        * (carried_tilt_by_k_shaft_pan * part_of_gx_3_4 + mass_tilt * part_of_gp_0_17)
    )
    gp[4, 17] = load_torque_tilt_by_k_shaft_pan * part_of_gx_4_0_4
    gp[5, 17] = load_torque_tilt_by_k_shaft_pan * part_of_gx_5_0
    gp[8, 17] = -part_of_follower_torque_tilt_12 - part_of_follower_torque_tilt_13
    gp[9, 17] = part_of_follower_torque_tilt_12 + theta_gear_pan - theta_pan
    part_of_gp_0_18 = active_pan * part_of_follower_torque_tilt_11
    gp[0, 18] = -part_of_gp_0_18
    follower_torque_tilt_by_d_shaft_pan = part_of_gp_0_18
    load_torque_tilt_by_d_shaft_pan = (
        (-1.0) * (follower_torque_tilt_by_d_shaft_pan) * (part_of_load_torque_tilt_by_theta_pan)
    )
    carried_tilt_by_d_shaft_pan = -J_motor_tilt_ratio_tilt_sq * load_torque_tilt_by_d_shaft_pan
    gp[3, 18] = (
        (-1.0)
        * (part_of_gx_3_0_4)
        * (carried_tilt_by_d_shaft_pan * part_of_gx_3_4 + mass_tilt * part_of_gp_0_18)
    )
    gp[4, 18] = load_torque_tilt_by_d_shaft_pan * part_of_gx_4_0_4
    gp[5, 18] = load_torque_tilt_by_d_shaft_pan * part_of_gx_5_0
    gp[8, 18] = part_of_follower_torque_tilt_11
    gp[9, 18] = part_of_follower_torque_tilt_11
    part_of_gp_0_19 = (0.5) * side_pan
    part_of_gp_0_19_2 = active_pan_k_shaft_pan * part_of_gp_0_19
    gp[0, 19] = part_of_gp_0_19_2
    follower_torque_tilt_by_gap_pan = -part_of_gp_0_19_2
    load_torque_tilt_by_gap_pan = (
        (-1.0) * (follower_torque_tilt_by_gap_pan) * (part_of_load_torque_tilt_by_theta_pan)
    )
    carried_tilt_by_gap_pan = -J_motor_tilt_ratio_tilt_sq * load_torque_tilt_by_gap_pan
    gp[3, 19] = (
        (-1.0)
        * (part_of_gx_3_0_4)
        * (
            -active_pan_k_shaft_pan_mass_tilt * part_of_gp_0_19
            + carried_tilt_by_gap_pan * mass_pan_tilt * part_of_gx_3_0_3 * slide_tilt_cubed
        )
    )
    gp[4, 19] = load_torque_tilt_by_gap_pan * part_of_gx_4_0_4
    gp[5, 19] = load_torque_tilt_by_gap_pan * part_of_gx_5_0
    gp[7, 19] = 0.5
    part_of_gp_8_19 = (0.5) * k_shaft_pan
    gp[8, 19] = -part_of_gp_8_19
    gp[9, 19] = part_of_gp_8_19
    gp[1, 21] = a_F_s_pan + 1.0
    gp[2, 21] = 1.0 - a_F_s_pan
    gp[1, 25] = F_s_pan
    gp[2, 25] = -F_s_pan
    minus_omega_tilt = -omega_tilt
    load_torque_tilt_by_b_tilt = minus_omega_tilt
    carried_tilt_by_b_tilt = -J_motor_tilt_ratio_tilt_sq * load_torque_tilt_by_b_tilt
    gp[3, 28] = minus_omega_tilt + part_of_gx_3_7 * (
        -carried_tilt_by_b_tilt * part_of_gx_3_0_3_slide_tilt - omega_tilt
    )
    gp[4, 28] = load_torque_tilt_by_b_tilt * part_of_gx_4_0_4
    gp[5, 28] = load_torque_tilt_by_b_tilt * part_of_gx_5_0
    i_tilt_ratio_tilt = i_tilt * ratio_tilt
    driving_torque_tilt_by_K_t_tilt = i_tilt_ratio_tilt
    carried_tilt_by_K_t_tilt = driving_torque_tilt_by_K_t_tilt * load_inertia_tilt
    gp[3, 31] = i_tilt_ratio_tilt + part_of_gx_3_7 * (
        -carried_tilt_by_K_t_tilt * part_of_gx_3_0_3_slide_tilt + i_tilt * ratio_tilt
    )
    part_of_driving_torque_tilt_by_J_motor_tilt = part_of_driving_torque_tilt * ratio_tilt
    part_of_driving_torque_tilt_by_J_motor_tilt_2 = -part_of_driving_torque_tilt_by_J_motor_tilt
    driving_torque_tilt_by_J_motor_tilt = part_of_driving_torque_tilt_by_J_motor_tilt_2
    carried_tilt_by_J_motor_tilt = (
        driving_torque_tilt_by_J_motor_tilt * load_inertia_tilt - load_torque_tilt * ratio_tilt_sq
    )
    lost_lowering_tilt_by_J_motor_tilt = -part_of_lost_lowering_tilt_by_theta_tilt * ratio_tilt_sq
    lost_raising_tilt_by_J_motor_tilt = -part_of_lost_raising_tilt_by_theta_tilt * ratio_tilt_sq
    gp[3, 32] = part_of_driving_torque_tilt_by_J_motor_tilt_2 + part_of_gx_3_7 * (
        -accel_tilt * ratio_tilt_sq
        - carried_tilt_by_J_motor_tilt * part_of_gx_3_0_3_slide_tilt
        - lost_lowering_tilt_by_J_motor_tilt * part_of_gx_3_1_2
        - lost_raising_tilt_by_J_motor_tilt * part_of_gx_3_1_3
        - part_of_driving_torque_tilt_by_J_motor_tilt
    )
    omega_tilt_ratio_tilt_sq = omega_tilt * ratio_tilt_sq
    minus_omega_tilt_ratio_tilt_sq = -omega_tilt_ratio_tilt_sq
    driving_torque_tilt_by_b_motor_tilt = minus_omega_tilt_ratio_tilt_sq
    carried_tilt_by_b_motor_tilt = driving_torque_tilt_by_b_motor_tilt * load_inertia_tilt
    gp[3, 33] = minus_omega_tilt_ratio_tilt_sq + part_of_gx_3_7 * (
        -carried_tilt_by_b_motor_tilt * part_of_gx_3_0_3_slide_tilt - omega_tilt_ratio_tilt_sq
    )
    ratio_tilt_by_N_tilt = part_of_ratio_tilt_4
    ratio_tilt_by_theta_tilt_by_N_tilt = (
        -part_of_ratio_tilt * part_of_ratio_tilt_by_theta_tilt_5
        + part_of_ratio_tilt_by_theta_tilt_2
    )
    part_of_driving_torque_tilt_by_N_tilt = (part_of_driving_torque_tilt_by_theta_tilt) * (
        ratio_tilt_by_theta_tilt_by_N_tilt
    )
    part_of_driving_torque_tilt_by_N_tilt_2 = (
        part_of_driving_torque_tilt_by_N_tilt
        - part_of_driving_torque_tilt_by_theta_tilt_2 * ratio_tilt_by_N_tilt
    )
    driving_torque_tilt_by_N_tilt = -part_of_driving_torque_tilt_by_N_tilt_2
    part_of_carried_tilt_by_N_tilt = 2.0 * part_of_carried_tilt_by_theta_tilt_2
    carried_tilt_by_N_tilt = (
        driving_torque_tilt_by_N_tilt * load_inertia_tilt
        - part_of_carried_tilt_by_N_tilt * ratio_tilt_by_N_tilt
    )
    part_of_lost_lowering_tilt_by_N_tilt = 2.0 * part_of_lost_lowering_tilt_by_theta_tilt_3
    lost_lowering_tilt_by_N_tilt = -part_of_lost_lowering_tilt_by_N_tilt * ratio_tilt_by_N_tilt
    part_of_lost_raising_tilt_by_N_tilt = 2.0 * part_of_lost_raising_tilt_by_theta_tilt_3
    lost_raising_tilt_by_N_tilt = -part_of_lost_raising_tilt_by_N_tilt * ratio_tilt_by_N_tilt
    part_of_gp_3_34 = 2.0 * part_of_gx_3_1_4
    gp[3, 34] = (
        -part_of_driving_torque_tilt_by_N_tilt
        + part_of_driving_torque_tilt_by_theta_tilt_2 * ratio_tilt_by_N_tilt
        + part_of_gx_3_7
        * (
            -carried_tilt_by_N_tilt * part_of_gx_3_0_3_slide_tilt
            - lost_lowering_tilt_by_N_tilt * part_of_gx_3_1_2
            - lost_raising_tilt_by_N_tilt * part_of_gx_3_1_3
            - part_of_driving_torque_tilt_by_N_tilt_2
            - part_of_gp_3_34 * ratio_tilt_by_N_tilt
        )
    )
    part_of_ratio_tilt_by_lead_tilt = 1.0 / (lead_tilt * lead_tilt)
    part_of_ratio_tilt_by_lead_tilt_2 = (
        math.pi * length_tilt_inverse * part_of_ratio_tilt_by_lead_tilt
    )
    ratio_tilt_by_lead_tilt = -N_tilt_part_of_ratio_tilt * part_of_ratio_tilt_by_lead_tilt_2
    ratio_tilt_by_theta_tilt_by_lead_tilt = (
        math.pi
        * N_tilt
        * length_tilt_by_theta_tilt
        * part_of_ratio_tilt
        * part_of_ratio_tilt_by_lead_tilt
        * part_of_ratio_tilt_by_theta_tilt_3
        - part_of_ratio_tilt_by_lead_tilt_2 * part_of_ratio_tilt_by_theta_tilt_by_theta_tilt_2
    )
    part_of_driving_torque_tilt_by_lead_tilt = (part_of_driving_torque_tilt_by_theta_tilt) * (
        ratio_tilt_by_theta_tilt_by_lead_tilt
    )
    part_of_driving_torque_tilt_by_lead_tilt_2 = (
        part_of_driving_torque_tilt_by_lead_tilt
        - part_of_driving_torque_tilt_by_theta_tilt_2 * ratio_tilt_by_lead_tilt
    )
    driving_torque_tilt_by_lead_tilt = -part_of_driving_torque_tilt_by_lead_tilt_2
    carried_tilt_by_lead_tilt = (
        driving_torque_tilt_by_lead_tilt * load_inertia_tilt
        - part_of_carried_tilt_by_N_tilt * ratio_tilt_by_lead_tilt
    )
    part_of_lowered_tilt_by_lead_tilt = part_of_lowered_tilt * part_of_ratio_tilt_by_lead_tilt
    part_of_lowered_tilt_by_lead_tilt_2 = lead_tilt_inverse * part_of_lowered_tilt_2
    part_of_lowered_tilt_by_lead_tilt_3 = part_of_lowered_tilt_3 * part_of_lowered_tilt_4_inverse
    part_of_lowered_tilt_by_lead_tilt_4 = 1.0 / (part_of_lowered_tilt_4 * part_of_lowered_tilt_4)
    lowered_tilt_by_lead_tilt = (
        part_of_lowered_tilt_3
        * part_of_lowered_tilt_by_lead_tilt_2
        * part_of_lowered_tilt_by_lead_tilt_4
        + part_of_lowered_tilt_6
        + part_of_lowered_tilt_by_lead_tilt * part_of_lowered_tilt_by_lead_tilt_3
    )
    part_of_lost_lowering_tilt_by_lead_tilt = (
        -load_inertia_tilt * part_of_lost_lowering_tilt_by_theta_tilt - part_of_lost_lowering_tilt_3
    )
    lost_lowering_tilt_by_lead_tilt = (
        lowered_tilt_by_lead_tilt * part_of_lost_lowering_tilt_by_lead_tilt
        - part_of_lost_lowering_tilt_by_N_tilt * ratio_tilt_by_lead_tilt
    )
    part_of_raised_tilt_by_lead_tilt = part_of_raised_tilt * part_of_raised_tilt_2_inverse
    part_of_raised_tilt_by_lead_tilt_2 = (part_of_raised_tilt) * (
        1.0 / (part_of_raised_tilt_2 * part_of_raised_tilt_2)
    )
    raised_tilt_by_lead_tilt = (
        -part_of_lowered_tilt_by_lead_tilt * part_of_raised_tilt_by_lead_tilt
        + part_of_lowered_tilt_by_lead_tilt_2 * part_of_raised_tilt_by_lead_tilt_2
        + part_of_raised_tilt_4
    )
    part_of_lost_raising_tilt_by_lead_tilt = (
        -load_inertia_tilt * part_of_lost_raising_tilt_by_theta_tilt
        + part_of_lost_raising_tilt_2_inverse
    )
    lost_raising_tilt_by_lead_tilt = (
        -part_of_lost_raising_tilt_by_N_tilt * ratio_tilt_by_lead_tilt
        + part_of_lost_raising_tilt_by_lead_tilt * raised_tilt_by_lead_tilt
    )
    gp[3, 35] = (
        -part_of_driving_torque_tilt_by_lead_tilt
        + part_of_driving_torque_tilt_by_theta_tilt_2 * ratio_tilt_by_lead_tilt
        + part_of_gx_3_7
        * (
            -carried_tilt_by_lead_tilt * part_of_gx_3_0_3_slide_tilt
            - lost_lowering_tilt_by_lead_tilt * part_of_gx_3_1_2
            - lost_raising_tilt_by_lead_tilt * part_of_gx_3_1_3
            - part_of_driving_torque_tilt_by_lead_tilt_2
            - part_of_gp_3_34 * ratio_tilt_by_lead_tilt
        )
    )
    part_of_gp_4_35 = (0.5) * load_torque_tilt
    part_of_gp_4_35_2 = (0.5) * abs(load_torque_tilt)
    part_of_gp_4_35_3 = part_of_gp_4_35 + part_of_gp_4_35_2
    minus_part_of_gp_4_35_3 = -part_of_gp_4_35_3
    part_of_gp_4_35_4 = part_of_gp_4_35 - part_of_gp_4_35_2
    minus_part_of_gp_4_35_4 = -part_of_gp_4_35_4
    gp[4, 35] = (
        lowered_tilt_by_lead_tilt * minus_part_of_gp_4_35_3
        + minus_part_of_gp_4_35_4 * raised_tilt_by_lead_tilt
    )
    gp[5, 35] = (
        lowered_tilt_by_lead_tilt * part_of_gp_4_35_4 + part_of_gp_4_35_3 * raised_tilt_by_lead_tilt
    )
    part_of_lowered_tilt_by_d_screw_tilt = math.pi * math.pi
    part_of_lowered_tilt_by_d_screw_tilt_2 = d_screw_tilt * part_of_lowered_tilt_by_d_screw_tilt
    part_of_lowered_tilt_by_d_screw_tilt_3 = f_screw_tilt * part_of_lowered_tilt_by_d_screw_tilt_2
    lowered_tilt_by_d_screw_tilt = (
        d_screw_tilt
        * lead_tilt_inverse
        * part_of_lowered_tilt_3
        * part_of_lowered_tilt_by_d_screw_tilt
        * part_of_lowered_tilt_by_lead_tilt_4
        - part_of_lowered_tilt_5 * part_of_lowered_tilt_by_d_screw_tilt_3
        - part_of_lowered_tilt_by_lead_tilt_3 * part_of_ratio_tilt_2
    )
    lost_lowering_tilt_by_d_screw_tilt = (lowered_tilt_by_d_screw_tilt) * (
        part_of_lost_lowering_tilt_by_lead_tilt
    )
    raised_tilt_by_d_screw_tilt = (
        -lead_tilt_inverse
        * part_of_lowered_tilt_by_d_screw_tilt_2
        * part_of_raised_tilt_by_lead_tilt_2
        + part_of_lowered_tilt_by_d_screw_tilt_3 * part_of_raised_tilt_3
        + part_of_raised_tilt_by_lead_tilt * part_of_ratio_tilt_2
    )
    lost_raising_tilt_by_d_screw_tilt = (part_of_lost_raising_tilt_by_lead_tilt) * (
        raised_tilt_by_d_screw_tilt
    )
    gp[3, 36] = (part_of_gx_3_7) * (
        -lost_lowering_tilt_by_d_screw_tilt * part_of_gx_3_1_2
        - lost_raising_tilt_by_d_screw_tilt * part_of_gx_3_1_3
    )
    gp[4, 36] = (
        lowered_tilt_by_d_screw_tilt * minus_part_of_gp_4_35_3
        + minus_part_of_gp_4_35_4 * raised_tilt_by_d_screw_tilt
    )
    gp[5, 36] = (
        lowered_tilt_by_d_screw_tilt * part_of_gp_4_35_4
        + part_of_gp_4_35_3 * raised_tilt_by_d_screw_tilt
    )
    part_of_lowered_tilt_by_f_screw_tilt = (d_screw_tilt * d_screw_tilt) * (
        part_of_lowered_tilt_by_d_screw_tilt
    )
    lowered_tilt_by_f_screw_tilt = (
        math.pi * d_screw_tilt * part_of_lowered_tilt_3 * part_of_lowered_tilt_by_lead_tilt_4
        - part_of_lowered_tilt_5 * part_of_lowered_tilt_by_f_screw_tilt
    )
    lost_lowering_tilt_by_f_screw_tilt = (lowered_tilt_by_f_screw_tilt) * (
        part_of_lost_lowering_tilt_by_lead_tilt
    )
    raised_tilt_by_f_screw_tilt = (
        part_of_lowered_tilt * part_of_raised_tilt_by_lead_tilt_2
        + part_of_lowered_tilt_by_f_screw_tilt * part_of_raised_tilt_3
    )
    lost_raising_tilt_by_f_screw_tilt = (part_of_lost_raising_tilt_by_lead_tilt) * (
        raised_tilt_by_f_screw_tilt
    )
    gp[3, 37] = (part_of_gx_3_7) * (
        -lost_lowering_tilt_by_f_screw_tilt * part_of_gx_3_1_2
        - lost_raising_tilt_by_f_screw_tilt * part_of_gx_3_1_3
    )
    gp[4, 37] = (
        lowered_tilt_by_f_screw_tilt * minus_part_of_gp_4_35_3
        + minus_part_of_gp_4_35_4 * raised_tilt_by_f_screw_tilt
    )
    gp[5, 37] = (
        lowered_tilt_by_f_screw_tilt * part_of_gp_4_35_4
        + part_of_gp_4_35_3 * raised_tilt_by_f_screw_tilt
    )
    linkage_cos_tilt_by_l_ground_tilt = 2.0 * l_ground_tilt
    part_of_linkage_sin_tilt_2_inverse = 1.0 / part_of_linkage_sin_tilt_2
    part_of_linkage_sin_tilt_by_l_ground_tilt = (
        linkage_cos_tilt * part_of_linkage_sin_tilt_2_inverse
    )
    linkage_sin_tilt_by_l_ground_tilt = (
        l_ground_tilt * part_of_linkage_sin_tilt * part_of_linkage_sin_tilt_2_inverse
        - linkage_cos_tilt_by_l_ground_tilt * part_of_linkage_sin_tilt_by_l_ground_tilt
    )
    part_of_length_tilt_by_l_ground_tilt = (0.5) * part_of_length_tilt_2_inverse
    part_of_length_tilt_by_l_ground_tilt_2 = cos_tilt * part_of_length_tilt_by_l_ground_tilt
    part_of_length_tilt_by_l_ground_tilt_3 = part_of_length_tilt_by_l_ground_tilt * sin_tilt
    length_tilt_by_l_ground_tilt = (
        l_ground_tilt * part_of_length_tilt_2_inverse
        - linkage_cos_tilt_by_l_ground_tilt * part_of_length_tilt_by_l_ground_tilt_2
        - linkage_sin_tilt_by_l_ground_tilt * part_of_length_tilt_by_l_ground_tilt_3
    )
    part_of_ratio_tilt_by_l_ground_tilt = N_tilt_part_of_ratio_tilt_3 * cos_tilt
    ratio_tilt_by_l_ground_tilt = (
        math.pi
        * N_tilt
        * lead_tilt_inverse
        * length_tilt_inverse
        * linkage_cos_tilt_by_l_ground_tilt
        * sin_tilt
        - length_tilt_by_l_ground_tilt * part_of_ratio_tilt_by_theta_tilt_by_theta_tilt
        - linkage_sin_tilt_by_l_ground_tilt * part_of_ratio_tilt_by_l_ground_tilt
    )
    part_of_length_tilt_by_theta_tilt_by_l_ground_tilt = (0.5) * (
        part_of_length_tilt_by_theta_tilt_by_theta_tilt
    )
    part_of_length_tilt_by_theta_tilt_by_l_ground_tilt_2 = (
        cos_tilt * part_of_length_tilt_by_theta_tilt_by_l_ground_tilt
        + part_of_length_tilt_by_l_ground_tilt_3
    )
    part_of_length_tilt_by_theta_tilt_by_l_ground_tilt_3 = (
        -part_of_length_tilt_by_l_ground_tilt_2
        + part_of_length_tilt_by_theta_tilt_by_l_ground_tilt * sin_tilt
    )
    length_tilt_by_theta_tilt_by_l_ground_tilt = (
        -l_ground_tilt * part_of_length_tilt_by_theta_tilt_by_theta_tilt
        + linkage_cos_tilt_by_l_ground_tilt * part_of_length_tilt_by_theta_tilt_by_l_ground_tilt_2
        + linkage_sin_tilt_by_l_ground_tilt * part_of_length_tilt_by_theta_tilt_by_l_ground_tilt_3
    )
    part_of_ratio_tilt_by_theta_tilt_by_l_ground_tilt = N_tilt * part_of_ratio_tilt_by_theta_tilt_5
    part_of_ratio_tilt_by_theta_tilt_by_l_ground_tilt_2 = (
        N_tilt_part_of_ratio_tilt_3 * sin_tilt
        + cos_tilt * part_of_ratio_tilt_by_theta_tilt_by_l_ground_tilt
    )
    part_of_ratio_tilt_by_theta_tilt_by_l_ground_tilt_3 = (
        part_of_ratio_tilt_by_l_ground_tilt
        - part_of_ratio_tilt_by_theta_tilt_by_l_ground_tilt * sin_tilt
    )
    ratio_tilt_by_theta_tilt_by_l_ground_tilt = (
        length_tilt_by_l_ground_tilt * part_of_ratio_tilt_by_theta_tilt_by_theta_tilt_4
        - length_tilt_by_theta_tilt_by_l_ground_tilt
        * part_of_ratio_tilt_by_theta_tilt_by_theta_tilt
        + linkage_cos_tilt_by_l_ground_tilt * part_of_ratio_tilt_by_theta_tilt_by_l_ground_tilt_3
        + linkage_sin_tilt_by_l_ground_tilt * part_of_ratio_tilt_by_theta_tilt_by_l_ground_tilt_2
    )
    part_of_driving_torque_tilt_by_l_ground_tilt = (part_of_driving_torque_tilt_by_theta_tilt) * (
        ratio_tilt_by_theta_tilt_by_l_ground_tilt
    )
    part_of_driving_torque_tilt_by_l_ground_tilt_2 = (
        part_of_driving_torque_tilt_by_l_ground_tilt
        - part_of_driving_torque_tilt_by_theta_tilt_2 * ratio_tilt_by_l_ground_tilt
    )
    driving_torque_tilt_by_l_ground_tilt = -part_of_driving_torque_tilt_by_l_ground_tilt_2
    carried_tilt_by_l_ground_tilt = (
        driving_torque_tilt_by_l_ground_tilt * load_inertia_tilt
        - part_of_carried_tilt_by_N_tilt * ratio_tilt_by_l_ground_tilt
    )
    lost_lowering_tilt_by_l_ground_tilt = (
        (-1.0) * (part_of_lost_lowering_tilt_by_N_tilt) * (ratio_tilt_by_l_ground_tilt)
    )
    lost_raising_tilt_by_l_ground_tilt = (
        (-1.0) * (part_of_lost_raising_tilt_by_N_tilt) * (ratio_tilt_by_l_ground_tilt)
    )
    gp[3, 38] = (
        -part_of_driving_torque_tilt_by_l_ground_tilt
        + part_of_driving_torque_tilt_by_theta_tilt_2 * ratio_tilt_by_l_ground_tilt
        + part_of_gx_3_7
        * (
            -carried_tilt_by_l_ground_tilt * part_of_gx_3_0_3_slide_tilt
            - lost_lowering_tilt_by_l_ground_tilt * part_of_gx_3_1_2
            - lost_raising_tilt_by_l_ground_tilt * part_of_gx_3_1_3
            - part_of_driving_torque_tilt_by_l_ground_tilt_2
            - part_of_gp_3_34 * ratio_tilt_by_l_ground_tilt
        )
    )
    part_of_linkage_cos_tilt_by_l_min_tilt = -2.0 * l_min_tilt - 2.0 * s_start_tilt
    linkage_cos_tilt_by_l_min_tilt = part_of_linkage_cos_tilt_by_l_min_tilt
    linkage_sin_tilt_by_l_min_tilt = (
        (-1.0) * (linkage_cos_tilt_by_l_min_tilt) * (part_of_linkage_sin_tilt_by_l_ground_tilt)
    )
    length_tilt_by_l_min_tilt = (
        -linkage_cos_tilt_by_l_min_tilt * part_of_length_tilt_by_l_ground_tilt_2
        - linkage_sin_tilt_by_l_min_tilt * part_of_length_tilt_by_l_ground_tilt_3
    )
    ratio_tilt_by_l_min_tilt = (
        math.pi
        * N_tilt
        * lead_tilt_inverse
        * length_tilt_inverse
        * linkage_cos_tilt_by_l_min_tilt
        * sin_tilt
        - length_tilt_by_l_min_tilt * part_of_ratio_tilt_by_theta_tilt_by_theta_tilt
        - linkage_sin_tilt_by_l_min_tilt * part_of_ratio_tilt_by_l_ground_tilt
    )
    length_tilt_by_theta_tilt_by_l_min_tilt = (
        linkage_cos_tilt_by_l_min_tilt * part_of_length_tilt_by_theta_tilt_by_l_ground_tilt_2
        + linkage_sin_tilt_by_l_min_tilt * part_of_length_tilt_by_theta_tilt_by_l_ground_tilt_3
    )
    ratio_tilt_by_theta_tilt_by_l_min_tilt = (
        length_tilt_by_l_min_tilt * part_of_ratio_tilt_by_theta_tilt_by_theta_tilt_4
        - length_tilt_by_theta_tilt_by_l_min_tilt * part_of_ratio_tilt_by_theta_tilt_by_theta_tilt
        + linkage_cos_tilt_by_l_min_tilt * part_of_ratio_tilt_by_theta_tilt_by_l_ground_tilt_3
        + linkage_sin_tilt_by_l_min_tilt * part_of_ratio_tilt_by_theta_tilt_by_l_ground_tilt_2
    )
    part_of_driving_torque_tilt_by_l_min_tilt = (part_of_driving_torque_tilt_by_theta_tilt) * (
        ratio_tilt_by_theta_tilt_by_l_min_tilt
    )
    part_of_driving_torque_tilt_by_l_min_tilt_2 = (
        part_of_driving_torque_tilt_by_l_min_tilt
        - part_of_driving_torque_tilt_by_theta_tilt_2 * ratio_tilt_by_l_min_tilt
    )
    driving_torque_tilt_by_l_min_tilt = -part_of_driving_torque_tilt_by_l_min_tilt_2
    carried_tilt_by_l_min_tilt = (
        driving_torque_tilt_by_l_min_tilt * load_inertia_tilt
        - part_of_carried_tilt_by_N_tilt * ratio_tilt_by_l_min_tilt
    )
    lost_lowering_tilt_by_l_min_tilt = (
        (-1.0) * (part_of_lost_lowering_tilt_by_N_tilt) * (ratio_tilt_by_l_min_tilt)
    )
    lost_raising_tilt_by_l_min_tilt = (
        -part_of_lost_raising_tilt_by_N_tilt * ratio_tilt_by_l_min_tilt
    )
    gp[3, 39] = (
        -part_of_driving_torque_tilt_by_l_min_tilt
        + part_of_driving_torque_tilt_by_theta_tilt_2 * ratio_tilt_by_l_min_tilt
        + part_of_gx_3_7
        * (
            -carried_tilt_by_l_min_tilt * part_of_gx_3_0_3_slide_tilt
            - lost_lowering_tilt_by_l_min_tilt * part_of_gx_3_1_2
            - lost_raising_tilt_by_l_min_tilt * part_of_gx_3_1_3
            - part_of_driving_torque_tilt_by_l_min_tilt_2
            - part_of_gp_3_34 * ratio_tilt_by_l_min_tilt
        )
    )
    linkage_cos_tilt_by_r_arm_tilt = 2.0 * r_arm_tilt
    linkage_sin_tilt_by_r_arm_tilt = (
        4.0 * l_ground_tilt_sq * part_of_linkage_sin_tilt_2_inverse * r_arm_tilt
        - linkage_cos_tilt_by_r_arm_tilt * part_of_linkage_sin_tilt_by_l_ground_tilt
    )
    length_tilt_by_r_arm_tilt = (
        -linkage_cos_tilt_by_r_arm_tilt * part_of_length_tilt_by_l_ground_tilt_2
        - linkage_sin_tilt_by_r_arm_tilt * part_of_length_tilt_by_l_ground_tilt_3
        + part_of_length_tilt_2_inverse * r_arm_tilt
    )
    ratio_tilt_by_r_arm_tilt = (
        math.pi
        * N_tilt
        * lead_tilt_inverse
        * length_tilt_inverse
        * linkage_cos_tilt_by_r_arm_tilt
        * sin_tilt
        - length_tilt_by_r_arm_tilt * part_of_ratio_tilt_by_theta_tilt_by_theta_tilt
        - linkage_sin_tilt_by_r_arm_tilt * part_of_ratio_tilt_by_l_ground_tilt
    )
    length_tilt_by_theta_tilt_by_r_arm_tilt = (
        linkage_cos_tilt_by_r_arm_tilt * part_of_length_tilt_by_theta_tilt_by_l_ground_tilt_2
        + linkage_sin_tilt_by_r_arm_tilt * part_of_length_tilt_by_theta_tilt_by_l_ground_tilt_3
        - part_of_length_tilt_by_theta_tilt_by_theta_tilt * r_arm_tilt
    )
    ratio_tilt_by_theta_tilt_by_r_arm_tilt = (
        length_tilt_by_r_arm_tilt * part_of_ratio_tilt_by_theta_tilt_by_theta_tilt_4
        - length_tilt_by_theta_tilt_by_r_arm_tilt * part_of_ratio_tilt_by_theta_tilt_by_theta_tilt
        + linkage_cos_tilt_by_r_arm_tilt * part_of_ratio_tilt_by_theta_tilt_by_l_ground_tilt_3
        + linkage_sin_tilt_by_r_arm_tilt * part_of_ratio_tilt_by_theta_tilt_by_l_ground_tilt_2
    )
    part_of_driving_torque_tilt_by_r_arm_tilt = (part_of_driving_torque_tilt_by_theta_tilt) * (
        ratio_tilt_by_theta_tilt_by_r_arm_tilt
    )
    part_of_driving_torque_tilt_by_r_arm_tilt_2 = (
        part_of_driving_torque_tilt_by_r_arm_tilt
        - part_of_driving_torque_tilt_by_theta_tilt_2 * ratio_tilt_by_r_arm_tilt
    )
    driving_torque_tilt_by_r_arm_tilt = -part_of_driving_torque_tilt_by_r_arm_tilt_2
    carried_tilt_by_r_arm_tilt = (
        driving_torque_tilt_by_r_arm_tilt * load_inertia_tilt
        - part_of_carried_tilt_by_N_tilt * ratio_tilt_by_r_arm_tilt
    )
    lost_lowering_tilt_by_r_arm_tilt = (
        (-1.0) * (part_of_lost_lowering_tilt_by_N_tilt) * (ratio_tilt_by_r_arm_tilt)
    )
    lost_raising_tilt_by_r_arm_tilt = (
        -part_of_lost_raising_tilt_by_N_tilt * ratio_tilt_by_r_arm_tilt
    )
    gp[3, 40] = (
        -part_of_driving_torque_tilt_by_r_arm_tilt
        + part_of_driving_torque_tilt_by_theta_tilt_2 * ratio_tilt_by_r_arm_tilt
        + part_of_gx_3_7
        * (
            -carried_tilt_by_r_arm_tilt * part_of_gx_3_0_3_slide_tilt
            - lost_lowering_tilt_by_r_arm_tilt * part_of_gx_3_1_2
            - lost_raising_tilt_by_r_arm_tilt * part_of_gx_3_1_3
            - part_of_driving_torque_tilt_by_r_arm_tilt_2
            - part_of_gp_3_34 * ratio_tilt_by_r_arm_tilt
        )
    )
    linkage_cos_tilt_by_s_start_tilt = part_of_linkage_cos_tilt_by_l_min_tilt
    linkage_sin_tilt_by_s_start_tilt = (
        (-1.0) * (linkage_cos_tilt_by_s_start_tilt) * (part_of_linkage_sin_tilt_by_l_ground_tilt)
    )
    length_tilt_by_s_start_tilt = (
        -linkage_cos_tilt_by_s_start_tilt * part_of_length_tilt_by_l_ground_tilt_2
        - linkage_sin_tilt_by_s_start_tilt * part_of_length_tilt_by_l_ground_tilt_3
    )
    ratio_tilt_by_s_start_tilt = (
        math.pi
        * N_tilt
        * lead_tilt_inverse
        * length_tilt_inverse
        * linkage_cos_tilt_by_s_start_tilt
        * sin_tilt
        - length_tilt_by_s_start_tilt * part_of_ratio_tilt_by_theta_tilt_by_theta_tilt
        - linkage_sin_tilt_by_s_start_tilt * part_of_ratio_tilt_by_l_ground_tilt
    )
    length_tilt_by_theta_tilt_by_s_start_tilt = (
        linkage_cos_tilt_by_s_start_tilt * part_of_length_tilt_by_theta_tilt_by_l_ground_tilt_2
        + linkage_sin_tilt_by_s_start_tilt * part_of_length_tilt_by_theta_tilt_by_l_ground_tilt_3
    )
    ratio_tilt_by_theta_tilt_by_s_start_tilt = (
        length_tilt_by_s_start_tilt * part_of_ratio_tilt_by_theta_tilt_by_theta_tilt_4
        - length_tilt_by_theta_tilt_by_s_start_tilt * part_of_ratio_tilt_by_theta_tilt_by_theta_tilt
        + linkage_cos_tilt_by_s_start_tilt * part_of_ratio_tilt_by_theta_tilt_by_l_ground_tilt_3
        + linkage_sin_tilt_by_s_start_tilt * part_of_ratio_tilt_by_theta_tilt_by_l_ground_tilt_2
    )
    part_of_driving_torque_tilt_by_s_start_tilt = (part_of_driving_torque_tilt_by_theta_tilt) * (
        ratio_tilt_by_theta_tilt_by_s_start_tilt
    )
    part_of_driving_torque_tilt_by_s_start_tilt_2 = (
        part_of_driving_torque_tilt_by_s_start_tilt
        - part_of_driving_torque_tilt_by_theta_tilt_2 * ratio_tilt_by_s_start_tilt
    )
    driving_torque_tilt_by_s_start_tilt = -part_of_driving_torque_tilt_by_s_start_tilt_2
    carried_tilt_by_s_start_tilt = (
        driving_torque_tilt_by_s_start_tilt * load_inertia_tilt
        - part_of_carried_tilt_by_N_tilt * ratio_tilt_by_s_start_tilt
    )
    lost_lowering_tilt_by_s_start_tilt = (
        (-1.0) * (part_of_lost_lowering_tilt_by_N_tilt) * (ratio_tilt_by_s_start_tilt)
    )
    lost_raising_tilt_by_s_start_tilt = (
        (-1.0) * (part_of_lost_raising_tilt_by_N_tilt) * (ratio_tilt_by_s_start_tilt)
    )
    gp[3, 41] = (
        -part_of_driving_torque_tilt_by_s_start_tilt
        + part_of_driving_torque_tilt_by_theta_tilt_2 * ratio_tilt_by_s_start_tilt
        + part_of_gx_3_7
        * (
            -carried_tilt_by_s_start_tilt * part_of_gx_3_0_3_slide_tilt
            - lost_lowering_tilt_by_s_start_tilt * part_of_gx_3_1_2
            - lost_raising_tilt_by_s_start_tilt * part_of_gx_3_1_3
            - part_of_driving_torque_tilt_by_s_start_tilt_2
            - part_of_gp_3_34 * ratio_tilt_by_s_start_tilt
        )
    )


@njit(cache=True, error_model="numpy", nogil=True)
def outputs(t, x, u, p, y):
    """Write the measured signals into y."""
    theta_pan = x[0]
    theta_tilt = x[1]
    i_pan = x[6]
    i_tilt = x[7]
    y[0] = theta_pan
    y[1] = theta_tilt
    y[2] = i_pan
    y[3] = i_tilt


@njit(cache=True, error_model="numpy", nogil=True)
def output_jacobian(t, x, u, p, yx, yp):
    """Write the non-zero derivatives of outputs by state and parameter."""
    yx[0, 0] = 1.0
    yx[1, 1] = 1.0
    yx[2, 6] = 1.0
    yx[3, 7] = 1.0


@njit(cache=True, error_model="numpy", nogil=True)
def energy(t, x, u, p, m, e):
    """Write stored energy in J, power in and dissipated power in W into e."""
    theta_pan = x[0]
    theta_tilt = x[1]
    omega_pan = x[2]
    omega_tilt = x[3]
    theta_gear_pan = x[4]
    omega_gear_pan = x[5]
    i_pan = x[6]
    i_tilt = x[7]
    u_pan = u[0]
    u_tilt = u[1]
    J_pan = p[0]
    J_x_tilt = p[1]
    J_y_tilt = p[2]
    J_z_tilt = p[3]
    m_payload = p[4]
    J_x_payload = p[5]
    J_y_payload = p[6]
    J_z_payload = p[7]
    c_x_payload = p[8]
    c_y_payload = p[9]
    c_z_payload = p[10]
    b_pan = p[11]
    L_pan = p[12]
    R_pan = p[13]
    J_motor_pan = p[15]
    N_pan = p[16]
    k_shaft_pan = p[17]
    d_shaft_pan = p[18]
    gap_pan = p[19]
    F_c_pan = p[20]
    F_s_pan = p[21]
    v_s_pan = p[22]
    F_v_pan = p[23]
    a_F_c_pan = p[24]
    a_F_s_pan = p[25]
    a_v_s_pan = p[26]
    a_F_v_pan = p[27]
    b_tilt = p[28]
    L_tilt = p[29]
    R_tilt = p[30]
    K_t_tilt = p[31]
    J_motor_tilt = p[32]
    b_motor_tilt = p[33]
    N_tilt = p[34]
    lead_tilt = p[35]
    d_screw_tilt = p[36]
    f_screw_tilt = p[37]
    l_ground_tilt = p[38]
    l_min_tilt = p[39]
    r_arm_tilt = p[40]
    s_start_tilt = p[41]
    slide_pan = m[0]
    slide_tilt = m[1]
    side_pan = m[2]
    active_pan = m[3]
    sin_tilt = math.sin(theta_tilt)
    c_x_payload_sin_tilt = c_x_payload * sin_tilt
    c_y_payload_m_payload = c_y_payload * m_payload
    part_of_e_0 = c_x_payload_sin_tilt * c_y_payload_m_payload
    cos_tilt = math.cos(theta_tilt)
    c_z_payload_cos_tilt = c_z_payload * cos_tilt
    part_of_e_0_2 = c_y_payload_m_payload * c_z_payload_cos_tilt
    sin_tilt_sq = sin_tilt * sin_tilt
    J_x_payload_sin_tilt_sq = J_x_payload * sin_tilt_sq
    J_x_tilt_sin_tilt_sq = J_x_tilt * sin_tilt_sq
    cos_tilt_sq = cos_tilt * cos_tilt
    J_z_payload_cos_tilt_sq = J_z_payload * cos_tilt_sq
    J_z_tilt_cos_tilt_sq = J_z_tilt * cos_tilt_sq
    c_x_payload_sq = c_x_payload * c_x_payload
    c_x_payload_sq_m_payload = c_x_payload_sq * m_payload
    part_of_e_0_3 = c_x_payload_sq_m_payload * cos_tilt_sq
    part_of_e_0_4 = (c_y_payload * c_y_payload) * m_payload
    part_of_e_0_4_sin_tilt_sq = part_of_e_0_4 * sin_tilt_sq
    cos_tilt_sq_part_of_e_0_4 = cos_tilt_sq * part_of_e_0_4
    part_of_e_0_5 = (c_z_payload * c_z_payload) * m_payload
    part_of_e_0_5_sin_tilt_sq = part_of_e_0_5 * sin_tilt_sq
    part_of_e_0_6 = c_x_payload_sin_tilt * c_z_payload_cos_tilt
    omega_pan_omega_tilt = omega_pan * omega_tilt
    part_of_e_0_7 = -0.5 * gap_pan * side_pan + theta_gear_pan - theta_pan
    part_of_e_0_8 = (9.81) * m_payload
    omega_pan_sq = omega_pan * omega_pan
    m_payload_omega_pan_sq = m_payload * omega_pan_sq
    l_ground_tilt_sq = l_ground_tilt * l_ground_tilt
    r_arm_tilt_sq = r_arm_tilt * r_arm_tilt
    part_of_linkage_cos_tilt = l_ground_tilt_sq + r_arm_tilt_sq
    linkage_cos_tilt = part_of_linkage_cos_tilt - (
        (l_min_tilt + s_start_tilt) * (l_min_tilt + s_start_tilt)
    )
    linkage_cos_tilt_sin_tilt = linkage_cos_tilt * sin_tilt
    linkage_sin_tilt = math.sqrt(
        4.0 * l_ground_tilt_sq * r_arm_tilt_sq - (linkage_cos_tilt * linkage_cos_tilt)
    )
    cos_tilt_linkage_sin_tilt = cos_tilt * linkage_sin_tilt
    part_of_ratio_tilt = -cos_tilt_linkage_sin_tilt + linkage_cos_tilt_sin_tilt
    cos_tilt_linkage_cos_tilt = cos_tilt * linkage_cos_tilt
    linkage_sin_tilt_sin_tilt = linkage_sin_tilt * sin_tilt
    part_of_length_tilt = math.sqrt(
        -cos_tilt_linkage_cos_tilt - linkage_sin_tilt_sin_tilt + part_of_linkage_cos_tilt
    )
    length_tilt = part_of_length_tilt
    lead_tilt_inverse = 1.0 / lead_tilt
    part_of_ratio_tilt_2 = math.pi * N_tilt * lead_tilt_inverse / length_tilt
    ratio_tilt = part_of_ratio_tilt * part_of_ratio_tilt_2
    ratio_tilt_sq = ratio_tilt * ratio_tilt
    J_motor_tilt_ratio_tilt_sq = J_motor_tilt * ratio_tilt_sq
    part_of_e_0_9 = (0.5) * omega_pan_sq
    omega_tilt_sq = omega_tilt * omega_tilt
    part_of_e_0_10 = (0.5) * omega_tilt_sq
    i_pan_sq = i_pan * i_pan
    i_tilt_sq = i_tilt * i_tilt
    omega_gear_pan_sq = omega_gear_pan * omega_gear_pan
    side_pan_sq = side_pan * side_pan
    e[0] = (
        (0.5) * J_motor_pan * (N_pan * N_pan) * omega_gear_pan_sq
        + J_motor_tilt_ratio_tilt_sq * part_of_e_0_10
        + J_pan * part_of_e_0_9
        + J_x_payload_sin_tilt_sq * part_of_e_0_9
        + J_x_tilt_sin_tilt_sq * part_of_e_0_9
        + J_y_payload * part_of_e_0_10
        + J_y_tilt * part_of_e_0_10
        + J_z_payload_cos_tilt_sq * part_of_e_0_9
        + J_z_tilt_cos_tilt_sq * part_of_e_0_9
        + (0.5) * L_pan * i_pan_sq
        + (0.5) * L_tilt * i_tilt_sq
        - c_x_payload_sin_tilt * part_of_e_0_8
        + c_x_payload_sq_m_payload * part_of_e_0_10
        + c_z_payload_cos_tilt * part_of_e_0_8
        + cos_tilt_sq_part_of_e_0_4 * part_of_e_0_9
        + (0.5) * k_shaft_pan * (part_of_e_0_7 * part_of_e_0_7) * side_pan_sq
        + m_payload_omega_pan_sq * part_of_e_0_6
        + omega_pan_omega_tilt * part_of_e_0
        - omega_pan_omega_tilt * part_of_e_0_2
        + part_of_e_0_10 * part_of_e_0_5
        + part_of_e_0_3 * part_of_e_0_9
        + part_of_e_0_4_sin_tilt_sq * part_of_e_0_9
        + part_of_e_0_5_sin_tilt_sq * part_of_e_0_9
    )
    e[1] = i_pan * u_pan + i_tilt * u_tilt
    follower_coupling_tilt = part_of_e_0 - part_of_e_0_2
    part_of_follower_inertia_tilt = 2.0 * m_payload
    follower_inertia_tilt = (
        J_pan
        + J_x_payload_sin_tilt_sq
        + J_x_tilt_sin_tilt_sq
        + J_z_payload_cos_tilt_sq
        + J_z_tilt_cos_tilt_sq
        + cos_tilt_sq_part_of_e_0_4
        + part_of_e_0_3
        + part_of_e_0_4_sin_tilt_sq
        + part_of_e_0_5_sin_tilt_sq
        + part_of_e_0_6 * part_of_follower_inertia_tilt
    )
    follower_inertia_tilt_inverse = 1.0 / follower_inertia_tilt
    load_inertia_tilt = (
        J_y_payload
        + J_y_tilt
        + c_x_payload_sq_m_payload
        - (follower_coupling_tilt * follower_coupling_tilt) * follower_inertia_tilt_inverse
        + part_of_e_0_5
    )
    part_of_lowered_tilt = math.pi * d_screw_tilt
    f_screw_tilt_lead_tilt = f_screw_tilt * lead_tilt
    part_of_lowered_tilt_2 = f_screw_tilt * part_of_lowered_tilt
    part_of_lowered_tilt_3 = lead_tilt_inverse * part_of_lowered_tilt
    lowered_tilt = (
        (-1.0)
        * (part_of_lowered_tilt_3)
        * (1.0 / (f_screw_tilt_lead_tilt + part_of_lowered_tilt))
        * (-lead_tilt + part_of_lowered_tilt_2)
    )
    lost_lowering_tilt = (1.0 - lowered_tilt) * (
        1.0 / (abs(J_motor_tilt_ratio_tilt_sq + load_inertia_tilt * lowered_tilt))
    )
    raised_tilt = (
        (part_of_lowered_tilt_3)
        * (1.0 / (-f_screw_tilt_lead_tilt + part_of_lowered_tilt))
        * (lead_tilt + part_of_lowered_tilt_2)
    )
    lost_raising_tilt = (1.0 / (J_motor_tilt_ratio_tilt_sq + load_inertia_tilt * raised_tilt)) * (
        raised_tilt - 1.0
    )
    part_of_follower_torque_tilt = omega_gear_pan - omega_pan
    part_of_follower_torque_tilt_2 = d_shaft_pan * part_of_follower_torque_tilt
    k_shaft_pan_part_of_e_0_7 = k_shaft_pan * part_of_e_0_7
    length_tilt_by_theta_tilt = (1.0 / part_of_length_tilt) * (
        -0.5 * cos_tilt_linkage_sin_tilt + (0.5) * linkage_cos_tilt_sin_tilt
    )
    ratio_tilt_by_theta_tilt = (
        -math.pi * N_tilt * lead_tilt_inverse * length_tilt_by_theta_tilt * part_of_ratio_tilt
    ) / (length_tilt * length_tilt) + part_of_ratio_tilt_2 * (
        cos_tilt_linkage_cos_tilt + linkage_sin_tilt_sin_tilt
    )
    driving_torque_tilt = (
        -J_motor_tilt * omega_tilt_sq * ratio_tilt * ratio_tilt_by_theta_tilt
        + ratio_tilt * (K_t_tilt * i_tilt - b_motor_tilt * omega_tilt * ratio_tilt)
    )
    cos_tilt_sin_tilt = cos_tilt * sin_tilt
    part_of_follower_torque_tilt_3 = 2.0 * cos_tilt_sin_tilt * omega_pan_omega_tilt
    c_x_payload_cos_tilt = c_x_payload * cos_tilt
    part_of_follower_torque_tilt_4 = c_y_payload_m_payload * omega_tilt_sq
    c_z_payload_sin_tilt = c_z_payload * sin_tilt
    c_x_payload_c_z_payload = c_x_payload * c_z_payload
    follower_torque_tilt = (
        -J_x_payload * part_of_follower_torque_tilt_3
        - J_x_tilt * part_of_follower_torque_tilt_3
        + 2.0 * J_z_payload * cos_tilt * omega_pan * omega_tilt * sin_tilt
        + 2.0 * J_z_tilt * cos_tilt * omega_pan * omega_tilt * sin_tilt
        + active_pan * (k_shaft_pan_part_of_e_0_7 + part_of_follower_torque_tilt_2)
        - b_pan * omega_pan
        + 2.0 * c_x_payload * c_z_payload * m_payload * omega_pan * omega_tilt * sin_tilt_sq
        - c_x_payload_c_z_payload
        * cos_tilt_sq
        * omega_pan_omega_tilt
        * part_of_follower_inertia_tilt
        - c_x_payload_cos_tilt * part_of_follower_torque_tilt_4
        + 2.0 * c_x_payload_sq * cos_tilt * m_payload * omega_pan * omega_tilt * sin_tilt
        - c_z_payload_sin_tilt * part_of_follower_torque_tilt_4
        - part_of_e_0_5 * part_of_follower_torque_tilt_3
    )
    cos_tilt_sin_tilt_omega_pan_sq = cos_tilt_sin_tilt * omega_pan_sq
    part_of_load_torque_tilt = c_x_payload_c_z_payload * m_payload_omega_pan_sq
    load_torque_tilt = (
        J_x_payload * cos_tilt_sin_tilt_omega_pan_sq
        + J_x_tilt * cos_tilt_sin_tilt_omega_pan_sq
        - J_z_payload * cos_tilt_sin_tilt_omega_pan_sq
        - J_z_tilt * cos_tilt_sin_tilt_omega_pan_sq
        - b_tilt * omega_tilt
        + c_x_payload_cos_tilt * part_of_e_0_8
        - c_x_payload_sq_m_payload * cos_tilt_sin_tilt_omega_pan_sq
        + c_z_payload_sin_tilt * part_of_e_0_8
        + cos_tilt_sin_tilt_omega_pan_sq * part_of_e_0_5
        + cos_tilt_sq * part_of_load_torque_tilt
        - follower_coupling_tilt * follower_inertia_tilt_inverse * follower_torque_tilt
        - part_of_load_torque_tilt * sin_tilt_sq
    )
    carried_tilt = (
        -J_motor_tilt_ratio_tilt_sq * load_torque_tilt + driving_torque_tilt * load_inertia_tilt
    )
    carried_tilt_slide_tilt = carried_tilt * slide_tilt
    part_of_e_2 = F_c_pan * (a_F_c_pan * slide_pan + 1.0)
    omega_gear_pan_slide_pan = omega_gear_pan * slide_pan
    e[2] = (
        R_pan * i_pan_sq
        + R_tilt * i_tilt_sq
        + b_motor_tilt * omega_tilt_sq * ratio_tilt_sq
        + b_pan * omega_pan_sq
        + b_tilt * omega_tilt_sq
        + omega_gear_pan_slide_pan
        * (
            F_v_pan * omega_gear_pan_slide_pan * (a_F_v_pan * slide_pan + 1.0)
            + part_of_e_2
            + (F_s_pan * (a_F_s_pan * slide_pan + 1.0) - part_of_e_2)
            * math.exp(
                (-omega_gear_pan_sq)
                / (
                    (v_s_pan * v_s_pan)
                    * ((a_v_s_pan * slide_pan + 1.0) * (a_v_s_pan * slide_pan + 1.0))
                )
            )
        )
        + omega_tilt
        * slide_tilt
        * (
            (0.5) * carried_tilt_slide_tilt * (-lost_lowering_tilt + lost_raising_tilt)
            + (0.5) * (lost_lowering_tilt + lost_raising_tilt) * abs(carried_tilt_slide_tilt)
        )
        + part_of_follower_torque_tilt
        * side_pan_sq
        * (
            active_pan * part_of_follower_torque_tilt_2
            - k_shaft_pan_part_of_e_0_7 * (1.0 - active_pan)
        )
    )


@njit(cache=True, error_model="numpy", nogil=True)
def domain(p, bounds):
    """Write lower and upper bound of the state of every row of DOMAIN into bounds."""
    l_ground_tilt = p[38]
    l_min_tilt = p[39]
    r_arm_tilt = p[40]
    s_start_tilt = p[41]
    s_max_tilt = p[42]
    part_of_bounds_0_0 = (l_ground_tilt * l_ground_tilt) + (r_arm_tilt * r_arm_tilt)
    part_of_bounds_0_0_2 = 0.5 / (l_ground_tilt * r_arm_tilt)
    part_of_bounds_0_0_3 = math.acos(
        part_of_bounds_0_0_2
        * (part_of_bounds_0_0 - ((l_min_tilt + s_start_tilt) * (l_min_tilt + s_start_tilt)))
    )
    bounds[0, 0] = part_of_bounds_0_0_3 - math.pi
    bounds[0, 1] = part_of_bounds_0_0_3
    bounds[1, 0] = part_of_bounds_0_0_3 - math.acos(
        max(
            -1.0,
            min(
                1.0,
                part_of_bounds_0_0_2
                * (part_of_bounds_0_0 - ((l_min_tilt + s_max_tilt) * (l_min_tilt + s_max_tilt))),
            ),
        )
    )
    bounds[1, 1] = part_of_bounds_0_0_3 - math.acos(
        max(
            -1.0, min(1.0, part_of_bounds_0_0_2 * (-(l_min_tilt * l_min_tilt) + part_of_bounds_0_0))
        )
    )


@njit(cache=True, error_model="numpy", nogil=True)
def margins(p, margin):
    """Write by how much the parameters meet every row of REQUIREMENTS into margin."""
    F_c_pan = p[20]
    F_s_pan = p[21]
    lead_tilt = p[35]
    d_screw_tilt = p[36]
    f_screw_tilt = p[37]
    l_ground_tilt = p[38]
    l_min_tilt = p[39]
    r_arm_tilt = p[40]
    s_start_tilt = p[41]
    s_max_tilt = p[42]
    margin[0] = -F_c_pan + F_s_pan
    margin[1] = 2.0 * l_ground_tilt * r_arm_tilt - abs(
        (l_ground_tilt * l_ground_tilt)
        + (r_arm_tilt * r_arm_tilt)
        - ((l_min_tilt + s_start_tilt) * (l_min_tilt + s_start_tilt))
    )
    margin[2] = s_max_tilt - s_start_tilt
    margin[3] = math.pi * d_screw_tilt - f_screw_tilt * lead_tilt


@njit(cache=True, error_model="numpy", nogil=True)
def initial_modes(t, x, u, p, m):
    """Find the modes of a state: contact from the separation, sticking from the holding torque."""
    frictions = len(FRICTION_RATES)
    contacts = (len(m) - frictions) // 2
    g = np.empty(3 * frictions + 4 * contacts)
    m[:] = 0.0
    guards(t, x, u, p, m, g)
    for k in range(contacts):
        at = 3 * frictions + 4 * k
        side = 1.0 if g[at] > 0.0 else -1.0
        if side * g[at] > g[at + 1]:
            torque = g[at + 2] if side > 0.0 else g[at + 3]
            m[frictions + 2 * k] = side
            m[frictions + 2 * k + 1] = 1.0 if side * torque > 0.0 else 0.0
    for k in range(frictions):
        m[k] = np.sign(x[FRICTION_RATES[k]])
    guards(t, x, u, p, m, g)
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
    mode_derivative(t, x, u, p, m, dx)


# END sha256 5096cd94499a409e34029ea843b273b3c4d3c4fdc6e812dda08483687500a1df
