"""The catalogue of effects: one file each, listed here in the order of the catalogue."""

from ptp_symbolic.effects.backlash import BACKLASH
from ptp_symbolic.effects.base_tilt import BASE_TILT
from ptp_symbolic.effects.cable_spring import CABLE_SPRING
from ptp_symbolic.effects.constant_torque import CONSTANT_TORQUE
from ptp_symbolic.effects.csvs_friction import CSVS_FRICTION
from ptp_symbolic.effects.dc_motor import DC_MOTOR
from ptp_symbolic.effects.direction_dependent_friction import DIRECTION_DEPENDENT_FRICTION
from ptp_symbolic.effects.effect import Effect
from ptp_symbolic.effects.payload import PAYLOAD
from ptp_symbolic.effects.payload_com_offset import PAYLOAD_COM_OFFSET
from ptp_symbolic.effects.rigid_bodies import RIGID_BODIES
from ptp_symbolic.effects.shaft_compliance import SHAFT_COMPLIANCE
from ptp_symbolic.effects.viscous_friction import VISCOUS_FRICTION

EFFECTS: tuple[Effect, ...] = (
    RIGID_BODIES,
    PAYLOAD,
    PAYLOAD_COM_OFFSET,
    BASE_TILT,
    VISCOUS_FRICTION,
    CSVS_FRICTION,
    DIRECTION_DEPENDENT_FRICTION,
    BACKLASH,
    SHAFT_COMPLIANCE,
    DC_MOTOR,
    CABLE_SPRING,
    CONSTANT_TORQUE,
)
