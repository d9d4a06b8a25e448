"""The letters of symbols whose names are words: ``half_gap_pan`` is set as h with an index."""

WORDS = {
    "accel": "alpha",
    "active": "iota",
    "asked": "u_asked",
    "base_acceleration": "a_base",
    "base_pull": "g_base",
    "base_rate": "omega_base",
    "base_slope": "alpha_base",
    "bridge": "u_bridge",
    "bristle": "z_bristle",
    "carried": "lambda_carried",
    "command": "u_command",
    "coriolis": "kappa_coriolis",
    "coupling": "C",
    "derivative": "D_error",
    "deviation": "epsilon",
    "drive": "nu",
    "driving_torque": "T_driving",
    "duty": "delta_duty",
    "error": "epsilon_error",
    "follower_coupling": "J_coupling",
    "follower_inertia": "J_follower",
    "follower_torque": "T_follower",
    "force": "f",
    "gap": "delta_gap",
    "gravity_azimuth": "alpha_gravity",
    "gravity_cos": "G_cos",
    "gravity_sin": "G_sin",
    "gravity_tilt": "beta_gravity",
    "half_gap": "h_gap",
    "heat": "xi_winding",
    "inertia": "I",
    "input": "u_input",
    "integral": "I_error",
    "inverse_determinant": "mu_determinant",
    "inverse_mass": "mu",
    "lag": "epsilon_lag",
    "last_error": "epsilon_last",
    "lead": "p_lead",
    "length": "l_actuator",
    "linkage_cos": "kappa_cos",
    "linkage_sin": "kappa_sin",
    "load_inertia": "J_load",
    "load_torque": "T_load",
    "lost_lowering": "zeta_lowering",
    "lost_raising": "zeta_raising",
    "lowered": "eta_lowered",
    "mass": "M",
    "raised": "eta_raised",
    "ratio": "rho",
    "rest_time": "t_resting",
    "separation": "phi_gap",
    "setpoint": "theta_setpoint",
    "side": "chi",
    "slide": "varsigma",
    "sum": "S_error",
    "temperature": "vartheta",
    "threshold": "epsilon_threshold",
    "tilt_axis_offset": "a_offset",
    "tilt_body_mass": "m_tilt_body",
    "tilt_product": "J_product",
    "transmission_error": "epsilon_gear",
    "transmitted_torque": "T_transmitted",
    "twist": "phi_twist",
    "twist_rate": "omega_twist",
}
SLOPE = "_by_"  # in the name of a derivative of a named function


def lettered(name: str) -> str:
    """`name` with a letter in front where it starts with words, the longest that are known.

    A derivative has what it is taken by, less its place, as the last part of its index.
    """
    term, by, variable = name.partition(SLOPE)
    if by:
        return f"{lettered(term)}_\\{variable.split('_')[0]}"
    parts = name.split("_")
    for count in range(len(parts), 0, -1):
        if letter := WORDS.get("_".join(parts[:count])):
            return "_".join([letter, *parts[count:]])
    return name
