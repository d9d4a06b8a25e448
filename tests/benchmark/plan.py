"""Which effects are planted where: the tables that the catalogue is made from.

A place is (machine, axis); effects of the whole platform have the axis None. Places where an effect
stays invisible at every sane size are left out; the reasons stand in `ABSENT`.
"""

import math

Place = tuple[str, str | None]

_PAN: Place = ("pan_drive", "pan")
_DC: Place = ("pan_drive_dc", "pan")
_SERVO: Place = ("tilt_servo", "tilt")
_DIRECT: Place = ("direct_drive", "pan")
_TWO_PAN: Place = ("two_axis", "pan")
_TWO_TILT: Place = ("two_axis", "tilt")
_ALL = (_PAN, _SERVO, _TWO_PAN, _DIRECT, _DC, _TWO_TILT)


def _whole(*machines: str) -> tuple[Place, ...]:
    """Places of an effect of the whole platform."""
    return tuple((machine, None) for machine in machines)


LEVELS = (1.0, 2.0, 5.0, 0.6, 0.3)  # thresholds, in the order in which the sets of an effect take
WIDE, NARROW = 8, 7  # sets of an effect on many machines, and on few
SINGLES: dict[str, tuple[int, tuple[Place, ...]]] = {
    "base_tilt": (
        WIDE,
        _whole("pan_drive", "two_axis", "direct_drive", "pan_drive_dc", "tilt_servo"),
    ),
    "base_motion": (
        WIDE,
        _whole("two_axis", "pan_drive", "tilt_servo", "direct_drive", "pan_drive_dc"),
    ),
    "cable_spring": (WIDE, _ALL),
    "constant_torque": (WIDE, _ALL),
    "viscous_friction": (NARROW, (_DIRECT, _TWO_PAN, _SERVO, _TWO_TILT)),
    "csvs_friction": (NARROW, (_TWO_PAN, _DIRECT, _TWO_TILT)),
    "direction_dependent_friction": (WIDE, (_DC, _SERVO, _DIRECT, _TWO_PAN, _PAN, _TWO_TILT)),
    "position_dependent_friction": (WIDE, (_SERVO, _DC, _DIRECT, _TWO_TILT, _PAN, _TWO_PAN)),
    "load_dependent_friction": (NARROW, (_SERVO, _TWO_TILT, _DIRECT)),
    "rate_dependent_breakaway": (NARROW, (_DC, _SERVO, _DIRECT)),
    "quadratic_drag": (WIDE, (_DIRECT, _DC, _TWO_TILT, _SERVO, _PAN, _TWO_PAN)),
    "cogging": (WIDE, (_PAN, _DC, _SERVO, _DIRECT, _TWO_PAN)),
    "gear_eccentricity": (NARROW, (_PAN, _DC)),
    "encoder_eccentricity": (WIDE, _ALL),
    "voltage_offset": (NARROW, (_SERVO, _PAN, _DC)),
    "drive_deadband": (NARROW, (_PAN, _DC, _SERVO)),
    "voltage_saturation": (NARROW, (_DC, _SERVO, _PAN)),
    "input_delay": (WIDE, (_PAN, _SERVO, _DIRECT, _DC, _TWO_PAN)),
    "winding_heating": (NARROW, (_DC, _SERVO, _PAN)),
    "payload_com_offset": (NARROW, _whole("two_axis", "tilt_servo")),
    "product_of_inertia": (5, _whole("two_axis")),
}
ABSENT = {
    "load_dependent_friction on pan_drive and pan_drive_dc": "the level pan axis carries no load: "
    "at a coefficient of 0.6 the response is a tenth of the threshold",
    "rate_dependent_breakaway on pan_drive": "breakaway is 1 % of what the motor can push: "
    "1.5 per e-fold of rest leave a tenth of the threshold",
    "viscous_friction and csvs_friction on pan_drive": "they add to the declared ones exactly",
    "rate_dependent_breakaway on two_axis": "the reference never rests",
}
# Visible at sane sizes with a fine encoder alone: the motor is much stronger than the effect.
FAINT: dict[str, tuple[str, ...]] = {
    "pan_drive": (
        "base_motion",
        "position_dependent_friction",
        "quadratic_drag",
        "cogging",
        "drive_deadband",
        "winding_heating",
        "viscous_by_angle",
        "torque_by_angle_and_rate",
    ),
    "pan_drive_dc": ("quadratic_drag", "winding_heating", "declared_value:N_pan"),
    "two_axis": ("product_of_inertia",),
    "two_axis_servo": ("position_dependent_friction",),
}
MOST_LEVEL = {"product_of_inertia": 3.0}  # no body has larger products beside these moments

PAIRS: tuple[tuple[str, str, str], ...] = (
    ("pan_drive", "base_tilt", "direction_dependent_friction"),
    ("pan_drive", "cable_spring", "base_tilt"),
    ("pan_drive", "cogging", "constant_torque"),
    ("pan_drive", "encoder_eccentricity", "voltage_offset"),
    ("pan_drive", "gear_eccentricity", "base_tilt"),
    ("pan_drive", "input_delay", "cable_spring"),
    ("pan_drive", "drive_deadband", "cogging"),
    ("pan_drive_dc", "base_tilt", "direction_dependent_friction"),
    ("pan_drive_dc", "position_dependent_friction", "cable_spring"),
    ("pan_drive_dc", "rate_dependent_breakaway", "base_tilt"),
    ("pan_drive_dc", "winding_heating", "constant_torque"),
    ("pan_drive_dc", "direction_dependent_friction", "cogging"),
    ("pan_drive_dc", "voltage_saturation", "position_dependent_friction"),
    ("tilt_servo", "payload_com_offset", "direction_dependent_friction"),
    ("tilt_servo", "cable_spring", "cogging"),
    ("tilt_servo", "load_dependent_friction", "voltage_offset"),
    ("tilt_servo", "winding_heating", "encoder_eccentricity"),
    ("tilt_servo", "drive_deadband", "constant_torque"),
    ("tilt_servo", "cable_spring", "position_dependent_friction"),
    ("direct_drive", "cable_spring", "base_tilt"),
    ("direct_drive", "base_tilt", "direction_dependent_friction"),
    ("direct_drive", "cogging", "quadratic_drag"),
    ("direct_drive", "input_delay", "position_dependent_friction"),
    ("direct_drive", "load_dependent_friction", "constant_torque"),
    ("two_axis", "base_tilt", "cable_spring@pan"),
    ("two_axis", "direction_dependent_friction@pan", "encoder_eccentricity@tilt"),
    ("two_axis", "payload_com_offset", "constant_torque@pan"),
    ("two_axis", "position_dependent_friction@pan", "quadratic_drag@tilt"),
)
TRIPLES: tuple[tuple[str, str, str, str], ...] = (
    ("pan_drive", "base_tilt", "direction_dependent_friction", "cogging"),
    ("pan_drive", "cable_spring", "voltage_offset", "encoder_eccentricity"),
    ("pan_drive", "gear_eccentricity", "constant_torque", "input_delay"),
    ("pan_drive", "base_motion", "drive_deadband", "cable_spring"),
    ("pan_drive_dc", "base_tilt", "position_dependent_friction", "winding_heating"),
    ("pan_drive_dc", "cable_spring", "direction_dependent_friction", "cogging"),
    ("pan_drive_dc", "rate_dependent_breakaway", "constant_torque", "encoder_eccentricity"),
    ("pan_drive_dc", "base_tilt", "cable_spring", "voltage_saturation"),
    ("tilt_servo", "payload_com_offset", "direction_dependent_friction", "cogging"),
    ("tilt_servo", "cable_spring", "load_dependent_friction", "drive_deadband"),
    ("tilt_servo", "winding_heating", "position_dependent_friction", "input_delay"),
    ("direct_drive", "base_tilt", "direction_dependent_friction", "cogging"),
    ("direct_drive", "cable_spring", "quadratic_drag", "encoder_eccentricity"),
    ("direct_drive", "constant_torque", "rate_dependent_breakaway", "input_delay"),
    ("two_axis", "base_tilt", "direction_dependent_friction@pan", "quadratic_drag@tilt"),
    ("two_axis", "payload_com_offset", "cable_spring@pan", "cogging@pan"),
)
DECLARED_VALUES: tuple[tuple[str, str], ...] = (
    ("pan_drive", "gap_pan"),
    ("pan_drive_dc", "R_pan"),
    ("tilt_servo", "m_payload"),
    ("two_axis", "m_payload"),
    ("pan_drive", "K_t_pan"),
    ("pan_drive_dc", "gap_pan"),
    ("tilt_servo", "R_tilt"),
    ("two_axis", "c_x_payload"),
    ("pan_drive", "N_pan"),
    ("pan_drive_dc", "K_t_pan"),
    ("tilt_servo", "K_t_tilt"),
    ("two_axis", "J_pan"),
    ("pan_drive_dc", "N_pan"),
    ("tilt_servo", "N_tilt"),
)
# The second name, where there is one, is a listed effect beside the unlisted torque.
UNLISTED: tuple[tuple[str, str, str], ...] = (
    ("pan_drive", "wind_gust", ""),
    ("tilt_servo", "wind_gust", ""),
    ("direct_drive", "wind_gust", "cogging"),
    ("two_axis", "wind_gust@pan", ""),
    ("pan_drive_dc", "decaying_friction", ""),
    ("tilt_servo", "decaying_friction", ""),
    ("direct_drive", "decaying_friction", ""),
    ("two_axis", "decaying_friction@tilt", ""),
    ("pan_drive", "hysteretic_cable", "encoder_eccentricity"),
    ("tilt_servo", "hysteretic_cable", ""),
    ("pan_drive_dc", "hysteretic_cable", ""),
    ("direct_drive", "hysteretic_cable", ""),
    ("pan_drive", "switched_torque", ""),
    ("tilt_servo", "switched_torque", "cable_spring"),
    ("direct_drive", "switched_torque", ""),
    ("two_axis", "switched_torque@pan", ""),
    ("pan_drive", "viscous_by_angle", "base_tilt"),
    ("direct_drive", "viscous_by_angle", ""),
    ("tilt_servo", "viscous_by_angle", ""),
    ("pan_drive", "torque_by_angle_and_rate", ""),
    ("two_axis", "torque_by_angle_and_rate@pan", "direction_dependent_friction@tilt"),
    ("direct_drive", "torque_by_angle_and_rate", ""),
)
SHORT_ARCS: tuple[tuple[str, str], ...] = (
    ("pan_drive", "cable_spring"),
    ("pan_drive_dc", "base_tilt"),
    ("tilt_servo", "constant_torque"),
    ("tilt_servo", "cable_spring"),
    ("direct_drive", "base_tilt"),
    ("direct_drive", "cable_spring"),
)
MACHINE_AXIS = {
    "pan_drive": "pan",
    "pan_drive_dc": "pan",
    "tilt_servo": "tilt",
    "direct_drive": "pan",
    "rigid_pan": "pan",
    "rigid_pan_dc": "pan",
}
PERFECT_PER_MACHINE = 6
FAR_EVERY = 3  # one perfect machine in three starts far from its values
SLIGHTLY_WRONG = {
    "pan_drive": 6,
    "pan_drive_dc": 5,
    "tilt_servo": 5,
    "direct_drive": 3,
    "two_axis": 3,
}
# Both axes with their motors, which came last so that all others keep their numbers and seeds.
BOTH_DRIVEN = "two_axis_servo"
OF_BOTH_DRIVEN: tuple[tuple[str, ...], ...] = (
    ("perfect",),
    ("single", "base_tilt"),
    ("perfect",),
    ("single", "cable_spring@pan"),
    ("single", "direction_dependent_friction@tilt"),
    ("single", "position_dependent_friction@pan"),
    ("single", "voltage_offset@tilt"),
    ("single", "input_delay@pan"),
    ("single", "cogging@tilt"),
    ("single", "encoder_eccentricity@pan"),
    ("single", "payload_com_offset"),
    ("single", "drive_deadband@pan"),
    ("single", "constant_torque@tilt"),
    ("perfect",),
    ("perfect",),
    ("single", "load_dependent_friction@tilt"),
    ("pair", "base_tilt", "direction_dependent_friction@pan"),
    ("triple", "base_tilt", "cogging@pan", "voltage_offset@tilt"),
    ("pair", "payload_com_offset", "cable_spring@pan"),
    ("triple", "payload_com_offset", "cable_spring@pan", "direction_dependent_friction@tilt"),
    ("declared_value", "R_pan"),
    ("unlisted", "wind_gust@pan"),
    ("declared_value", "m_payload"),
    ("unlisted", "switched_torque@tilt"),
    ("perfect",),
    ("slightly_wrong",),
    ("perfect",),
    ("slightly_wrong",),
)

# Machines that are declared rigid. Of every structure: its least and largest size, in its own unit
# (N m/rad, rad, restitution) or in thresholds; then the places with the terms beside it.
Places = tuple[tuple[str, ...], ...]
_RIGID, _RIGID_DC = ("rigid_pan", "pan"), ("rigid_pan_dc", "pan")
STRUCTURES: dict[str, tuple[tuple[float, float], Places]] = {
    "shaft_compliance": (
        (30.0, 2e4),
        (
            _RIGID,
            _RIGID_DC,
            (*_RIGID, "base_tilt"),
            (*_RIGID_DC, "cable_spring"),
            _RIGID,
            _RIGID_DC,
            ("tilt_servo", "tilt"),
            ("two_axis_servo", "tilt"),
            ("two_axis_servo", "pan"),
            (*_RIGID, "direction_dependent_friction"),
            _RIGID,
            _RIGID_DC,
            (*_RIGID, "voltage_offset"),
            ("tilt_servo", "tilt", "constant_torque"),
        ),
    ),
    "backlash": (
        (math.pi / 7200, math.radians(3.0)),
        (
            _RIGID,
            _RIGID_DC,
            _RIGID,
            (*_RIGID_DC, "direction_dependent_friction"),
            (*_RIGID, "base_tilt"),
            _RIGID_DC,
            ("tilt_servo", "tilt"),
            _RIGID,
            (*_RIGID, "constant_torque"),
            _RIGID_DC,
        ),
    ),
    "shaft_and_gap": (
        (math.radians(0.1), math.radians(3.0)),
        (
            _RIGID,
            _RIGID_DC,
            (*_RIGID, "cogging"),
            (*_RIGID_DC, "base_tilt"),
            _RIGID,
            ("tilt_servo", "tilt"),
        ),
    ),
    "elastic_impact": (
        (0.2, 0.9),
        (_RIGID, _RIGID_DC, (*_RIGID, "cable_spring"), _RIGID_DC, _RIGID),
    ),
    "lugre_friction": (
        (3e-4, 1e-2),
        (_RIGID, _RIGID_DC, (*_RIGID_DC, "base_tilt"), _RIGID, _RIGID_DC),
    ),
    "measurement_lag": (
        (0.6, 8.0),
        (_RIGID, ("tilt_servo", "tilt"), ("direct_drive", "pan", "base_tilt")),
    ),
    "actuator_lag": (
        (0.8, 8.0),
        (
            ("direct_drive", "pan"),
            ("two_axis", "tilt"),
            ("two_axis", "pan", "base_tilt"),
            _RIGID,
        ),
    ),
    "voltage_ceiling": ((1.0, 6.0), (_RIGID, (*_RIGID_DC, "cable_spring"))),
    "torque_saturation": (
        (0.8, 6.0),
        (("direct_drive", "pan"), ("two_axis", "tilt"), ("direct_drive", "pan", "cable_spring")),
    ),
    "torque_proportional_loss": (
        (0.8, 6.0),
        (
            ("tilt_servo", "tilt"),
            ("tilt_servo", "tilt", "voltage_offset"),
            ("tilt_servo", "tilt"),
        ),
    ),
    "end_stop": (
        (0.02, 0.4),
        (
            ("direct_drive", "pan"),
            ("two_axis", "tilt"),
            ("direct_drive", "pan", "base_tilt"),
            ("two_axis", "pan"),
            ("two_axis", "tilt", "constant_torque@pan"),
        ),
    ),
}
# Perfect, with small deviations, with a shaft so stiff that it does not show.
STRUCTURE_NULLS: dict[str, tuple[int, int, int]] = {
    "rigid_pan": (6, 4, 3),
    "rigid_pan_dc": (5, 3, 3),
    "tilt_servo": (4, 2, 0),
    "direct_drive": (3, 1, 0),
    "two_axis": (2, 1, 0),
    "two_axis_servo": (2, 1, 0),
}
STIFF = 1e6  # N m/rad
RIGID_PERIOD = 0.005  # s
MOST_COUNTS = 65_536
# Sizes of structures above (True) or below which a fine encoder with little noise is needed.
FINE_BEYOND = {
    "shaft_compliance": (250.0, True),
    "backlash": (4e-3, False),
    "lugre_friction": (4e-3, False),
}
