"""The catalogue of effects: one file each, listed here in the order of the catalogue.

Effects of other packages follow: those that they name as entry points of the group
``ptp_symbolic.effects``, each an `Effect`.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from importlib.metadata import entry_points

from ptp_symbolic.errors import InputError, wrong_type
from ptp_symbolic.symbolic.effect_interface.effect import Effect
from ptp_symbolic.symbolic.effects.actuator_lag import ACTUATOR_LAG
from ptp_symbolic.symbolic.effects.axis_offset import AXIS_OFFSET
from ptp_symbolic.symbolic.effects.backlash import BACKLASH
from ptp_symbolic.symbolic.effects.base_acceleration import BASE_ACCELERATION
from ptp_symbolic.symbolic.effects.base_motion import BASE_MOTION
from ptp_symbolic.symbolic.effects.base_rotation import BASE_ROTATION
from ptp_symbolic.symbolic.effects.base_tilt import BASE_TILT
from ptp_symbolic.symbolic.effects.cable_spring import CABLE_SPRING
from ptp_symbolic.symbolic.effects.cogging import COGGING
from ptp_symbolic.symbolic.effects.constant_torque import CONSTANT_TORQUE
from ptp_symbolic.symbolic.effects.controller_delay import CONTROLLER_DELAY
from ptp_symbolic.symbolic.effects.csvs_friction import CSVS_FRICTION
from ptp_symbolic.symbolic.effects.dc_motor import DC_MOTOR
from ptp_symbolic.symbolic.effects.direction_dependent_friction import DIRECTION_DEPENDENT_FRICTION
from ptp_symbolic.symbolic.effects.directional_load_friction import DIRECTIONAL_LOAD_FRICTION
from ptp_symbolic.symbolic.effects.drive_deadband import DRIVE_DEADBAND
from ptp_symbolic.symbolic.effects.encoder_eccentricity import ENCODER_ECCENTRICITY
from ptp_symbolic.symbolic.effects.encoder_quantization import ENCODER_QUANTIZATION
from ptp_symbolic.symbolic.effects.end_stop import END_STOP
from ptp_symbolic.symbolic.effects.friction_drift import FRICTION_DRIFT
from ptp_symbolic.symbolic.effects.gear_eccentricity import GEAR_ECCENTRICITY
from ptp_symbolic.symbolic.effects.harmonic_drive import HARMONIC_DRIVE
from ptp_symbolic.symbolic.effects.imu import IMU
from ptp_symbolic.symbolic.effects.input_delay import INPUT_DELAY
from ptp_symbolic.symbolic.effects.linear_actuator import LINEAR_ACTUATOR
from ptp_symbolic.symbolic.effects.load_dependent_friction import LOAD_DEPENDENT_FRICTION
from ptp_symbolic.symbolic.effects.lugre_friction import LUGRE_FRICTION
from ptp_symbolic.symbolic.effects.magnetic_detent import MAGNETIC_DETENT
from ptp_symbolic.symbolic.effects.maxwell_slip_friction import MAXWELL_SLIP_FRICTION
from ptp_symbolic.symbolic.effects.measurement_lag import MEASUREMENT_LAG
from ptp_symbolic.symbolic.effects.motor_encoder import MOTOR_ENCODER
from ptp_symbolic.symbolic.effects.pan_com_offset import PAN_COM_OFFSET
from ptp_symbolic.symbolic.effects.payload import PAYLOAD
from ptp_symbolic.symbolic.effects.payload_com_offset import PAYLOAD_COM_OFFSET
from ptp_symbolic.symbolic.effects.pid_controller import PID_CONTROLLER
from ptp_symbolic.symbolic.effects.position_dependent_friction import POSITION_DEPENDENT_FRICTION
from ptp_symbolic.symbolic.effects.prescribed_motion import PRESCRIBED_MOTION
from ptp_symbolic.symbolic.effects.product_of_inertia import PRODUCT_OF_INERTIA
from ptp_symbolic.symbolic.effects.pwm_drive import PWM_DRIVE
from ptp_symbolic.symbolic.effects.quadratic_drag import QUADRATIC_DRAG
from ptp_symbolic.symbolic.effects.rate_dependent_breakaway import RATE_DEPENDENT_BREAKAWAY
from ptp_symbolic.symbolic.effects.rigid_bodies import RIGID_BODIES
from ptp_symbolic.symbolic.effects.rotor_inertia import ROTOR_INERTIA
from ptp_symbolic.symbolic.effects.shaft_compliance import SHAFT_COMPLIANCE
from ptp_symbolic.symbolic.effects.shear_thinning_friction import SHEAR_THINNING_FRICTION
from ptp_symbolic.symbolic.effects.stribeck_exponent import STRIBECK_EXPONENT
from ptp_symbolic.symbolic.effects.temperature_dependent_friction import (
    TEMPERATURE_DEPENDENT_FRICTION,
)
from ptp_symbolic.symbolic.effects.torque_proportional_loss import TORQUE_PROPORTIONAL_LOSS
from ptp_symbolic.symbolic.effects.torque_saturation import TORQUE_SATURATION
from ptp_symbolic.symbolic.effects.viscous_friction import VISCOUS_FRICTION
from ptp_symbolic.symbolic.effects.voltage_offset import VOLTAGE_OFFSET
from ptp_symbolic.symbolic.effects.voltage_saturation import VOLTAGE_SATURATION
from ptp_symbolic.symbolic.effects.winding_heating import WINDING_HEATING

PACKAGED: tuple[Effect, ...] = (
    RIGID_BODIES,
    PAYLOAD,
    PAYLOAD_COM_OFFSET,
    PRODUCT_OF_INERTIA,
    AXIS_OFFSET,
    PAN_COM_OFFSET,
    BASE_TILT,
    BASE_MOTION,
    BASE_ACCELERATION,
    BASE_ROTATION,
    VISCOUS_FRICTION,
    CSVS_FRICTION,
    LUGRE_FRICTION,
    MAXWELL_SLIP_FRICTION,
    DIRECTION_DEPENDENT_FRICTION,
    LOAD_DEPENDENT_FRICTION,
    DIRECTIONAL_LOAD_FRICTION,
    TORQUE_PROPORTIONAL_LOSS,
    POSITION_DEPENDENT_FRICTION,
    RATE_DEPENDENT_BREAKAWAY,
    STRIBECK_EXPONENT,
    FRICTION_DRIFT,
    SHEAR_THINNING_FRICTION,
    TEMPERATURE_DEPENDENT_FRICTION,
    QUADRATIC_DRAG,
    BACKLASH,
    SHAFT_COMPLIANCE,
    HARMONIC_DRIVE,
    COGGING,
    MAGNETIC_DETENT,
    GEAR_ECCENTRICITY,
    DC_MOTOR,
    LINEAR_ACTUATOR,
    ROTOR_INERTIA,
    PID_CONTROLLER,
    CONTROLLER_DELAY,
    PWM_DRIVE,
    PRESCRIBED_MOTION,
    DRIVE_DEADBAND,
    VOLTAGE_OFFSET,
    VOLTAGE_SATURATION,
    WINDING_HEATING,
    TORQUE_SATURATION,
    ACTUATOR_LAG,
    CABLE_SPRING,
    END_STOP,
    CONSTANT_TORQUE,
    INPUT_DELAY,
    IMU,
    MOTOR_ENCODER,
    ENCODER_ECCENTRICITY,
    MEASUREMENT_LAG,
    ENCODER_QUANTIZATION,
)

GROUP = "ptp_symbolic.effects"


def effects_of_others() -> tuple[Effect, ...]:
    """The effects that installed packages name, by the names of their entry points.

    Raises InputError for one that cannot be imported, is no effect, or has an id that is taken.
    """
    found: list[Effect] = []
    for point in sorted(entry_points(group=GROUP), key=lambda p: p.name):
        where = f"Effect '{point.name}' of the entry point {point.value}"
        try:
            effect = point.load()
        except Exception as error:  # what another package raises when it is imported
            raise InputError(f"{where} cannot be loaded: {error}; mend or uninstall it.") from error
        if not isinstance(effect, Effect):
            raise wrong_type(where, effect, "an Effect")
        if effect.id in {e.id for e in (*PACKAGED, *found)}:
            raise InputError(f"{where} has the id '{effect.id}', which is taken; choose another.")
        found.append(effect)
    return tuple(found)


EFFECTS: tuple[Effect, ...] = (*PACKAGED, *effects_of_others())

_ON_TRIAL: ContextVar[tuple[Effect, ...]] = ContextVar("effects on trial", default=())


def catalogue() -> tuple[Effect, ...]:
    """All effects that a platform may name: those of the catalogue, and those on trial."""
    own = _ON_TRIAL.get()
    ids = {effect.id for effect in own}
    return (*(effect for effect in EFFECTS if effect.id not in ids), *own) if own else EFFECTS


@contextmanager
def on_trial(effect: Effect) -> Iterator[None]:
    """Let platforms name `effect` inside, in place of one of its id in the catalogue, if any."""
    token = _ON_TRIAL.set(() if effect in EFFECTS else (effect,))
    try:
        yield
    finally:
        _ON_TRIAL.reset(token)
