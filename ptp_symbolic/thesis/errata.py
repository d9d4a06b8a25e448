"""The errata of the thesis, each with the check that settles it."""

from collections.abc import Callable, Mapping
from functools import cache

from ptp_symbolic.thesis import (
    errata_drives,
    errata_equations,
    errata_estimation,
    errata_friction,
    errata_listings,
    errata_shaft,
)
from ptp_symbolic.thesis.items import Item

ERRATA: Mapping[int, Callable[[], Item]] = {
    1: errata_friction.signum,
    2: errata_friction.branches,
    3: errata_friction.csvs_sign,
    4: errata_shaft.shaft_damping,
    5: errata_equations.euler_sign,
    6: errata_equations.damping_names,
    7: errata_equations.euler_rate_names,
    8: errata_equations.gear_torques,
    9: errata_equations.actuator_force,
    10: errata_drives.self_locking,
    11: errata_equations.symmetric_row,
    12: errata_estimation.averages_forward,
    13: errata_estimation.averages_backward,
    14: errata_estimation.start_outside,
    15: errata_estimation.precedence,
    16: errata_estimation.inertia_bounds,
    17: errata_equations.friction_unit,
    18: errata_equations.payload_offset,
    19: errata_drives.initial_stroke,
    20: errata_drives.step_table,
    21: errata_friction.pwm_torque,
    22: errata_friction.gear_ratio,
    23: errata_friction.counted_twice,
    24: errata_drives.com_direction,
    25: errata_drives.ringing,
    26: errata_drives.plastic_impact,
    27: errata_equations.coupling_rows,
    28: errata_friction.stribeck_sign,
    29: errata_drives.contact_condition,
    30: errata_equations.euler_singularity,
    31: errata_listings.ramp_listing,
    32: errata_listings.map_listing,
}


@cache
def _settled() -> tuple[Item, ...]:
    return tuple(check() for check in ERRATA.values())


def items() -> list[Item]:
    """One item per erratum, in their order."""
    return list(_settled())
